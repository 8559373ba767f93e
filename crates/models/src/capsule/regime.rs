//! The regimes of the capsule as printed, and what follows each of them.

use capsulemap_engine::flow::{MAX_GUARDS, Zeros};
use capsulemap_engine::lane::{Lane, Mask, series, side_by_side};

use super::drag::Drag;
use super::drive::Drive;
use super::state::State;

/// Guard of the contact, `r - delta` while closed and `delta - r` while open.
pub(super) const CONTACT: usize = 0;

/// Which field acts on the capsule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Regime {
    /// H = 0: x2 and y2 stand still, y2 not necessarily at zero. Guards 1, 2: f_s - F, f_s + F.
    Frozen,
    /// H = 1. Guards 1, 2: the speed, |F| - f_s.
    Moving,
    /// H = 1, held at y2 = 0 by f_d(0+) > |F|. Guards 1, 2: |F| - f_s, f_d(0+) - |F|.
    Held,
    /// 0 < H < 1 on |F| = f_s. Guards 1, 2, 3: H, 1 - H, the speed.
    Creeping,
}

/// The mode of the capsule as printed, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct PrintedMode<L: Lane> {
    /// Whether the mass touches the stop.
    pub(super) closed: L::Mask,
    /// Number of the regime.
    regime: L,
    /// Direction of sliding, +1 or -1; 0 where the capsule does not slide.
    pub(super) slip: L,
    /// Sign of F where it matters, else 0.
    pub(super) side: L,
}

side_by_side!(PrintedMode { regime, slip, side } masks { closed });

impl<L: Lane> Default for PrintedMode<L> {
    fn default() -> Self {
        let zero = L::splat(0.0);
        PrintedMode { closed: L::Mask::splat(false), regime: zero, slip: zero, side: zero }
    }
}

impl<L: Lane> PrintedMode<L> {
    /// A regime with its signs in all lanes, and contact as given.
    #[inline(always)]
    pub(super) fn new(closed: L::Mask, regime: Regime, slip: L, side: L) -> Self {
        PrintedMode { closed, regime: L::splat(f64::from(regime as u8)), slip, side }
    }

    /// Where this regime rules.
    #[inline(always)]
    pub(super) fn is(&self, regime: Regime) -> L::Mask {
        (self.regime - L::splat(f64::from(regime as u8))).abs().lt(L::splat(0.5))
    }

    /// One mode where the mask is true, another elsewhere.
    #[inline(always)]
    pub(super) fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        PrintedMode {
            closed: (mask & yes.closed) | (!mask & no.closed),
            regime: L::select(mask, yes.regime, no.regime),
            slip: L::select(mask, yes.slip, no.slip),
            side: L::select(mask, yes.side, no.side),
        }
    }
}

/// A guard of the motion: a constant and a factor times F, the share of H or, elsewhere, y2.
pub(super) struct GuardTerms<L: Lane> {
    /// Where it is of F.
    pub(super) of_force: L::Mask,
    /// Where it is of the share of H.
    pub(super) of_share: L::Mask,
    pub(super) factor: L,
    pub(super) constant: L,
}

impl<L: Lane> PrintedMode<L> {
    /// Guard 1, 2 or 3 of each lane, see [`Regime`].
    #[inline(always)]
    pub(super) fn guard(&self, which: usize, drag: &Drag<L>) -> GuardTerms<L> {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let [frozen, moving, held, creeping] =
            [Regime::Frozen, Regime::Moving, Regime::Held, Regime::Creeping].map(|it| self.is(it));
        let (limit, onset) = (drag.static_limit, drag.at_onset);
        let PrintedMode { slip, side, .. } = *self;
        let none = L::Mask::splat(false);
        let (of_force, of_share, factor, constant) = match which {
            1 => {
                let factor = L::select(moving, slip, L::select(held, side, one));
                let factor = L::select(frozen, -one, factor);
                let constant = L::select(frozen, limit, L::select(held, -limit, zero));
                (frozen | held, creeping, factor, constant)
            }
            2 => {
                let factor = L::select(moving, side, L::select(held, -side, -one));
                let factor = L::select(frozen, one, factor);
                let constant = L::select(moving, -limit, L::select(held, onset, one));
                (frozen | held | moving, creeping, factor, L::select(frozen, limit, constant))
            }
            _ => (none, none, slip, zero),
        };
        GuardTerms { of_force, of_share, factor, constant }
    }
}

/// The force of the mass on the capsule, F [N], by the spring, the damper and the stop while contact is as given.
pub(super) struct MassForce<L: Lane> {
    pub(super) k1: L,
    pub(super) c: L,
    pub(super) k2: L,
    pub(super) delta: L,
    pub(super) closed: L::Mask,
}

impl<L: Lane> MassForce<L> {
    /// F in a state.
    #[inline(always)]
    pub(super) fn at(&self, state: &State<L>) -> L {
        let contact = L::select(self.closed, self.k2 * (state.r - self.delta), L::splat(0.0));
        self.k1 * state.r + contact + self.c * (state.y1 - state.y2)
    }
}

/// A mode that follows another, and which of its guards start at zero.
#[derive(Clone, Copy)]
struct Next<L: Lane> {
    mode: PrintedMode<L>,
    zeros: Zeros<L>,
}

impl<L: Lane> Next<L> {
    #[inline(always)]
    fn new(mode: PrintedMode<L>, zeros: Zeros<L>) -> Self {
        Next { mode, zeros }
    }

    #[inline(always)]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Next {
            mode: PrintedMode::select(mask, yes.mode, no.mode),
            zeros: std::array::from_fn(|i| L::select(mask, yes.zeros[i], no.zeros[i])),
        }
    }
}

/// The zeros of a mode in which guard 1 alone starts at zero, with so many leading coefficients.
#[inline(always)]
fn zeros_of_slip<L: Lane>(power: f64) -> Zeros<L> {
    let mut zeros = [L::splat(0.0); MAX_GUARDS];
    zeros[1] = L::splat(power);
    zeros
}

/// What decides how the regimes follow each other: the constants of the capsule.
///
/// Its functions are called at events only. They are not inlined, as numbers with derivatives of derivatives
/// make much code of them.
pub(super) struct Rules<'a, L: Lane> {
    pub(super) drive: &'a Drive<L>,
    pub(super) drag: &'a Drag<L>,
    /// F while contact is as it is.
    pub(super) force: MassForce<L>,
    pub(super) stiffness: L,
    pub(super) c: L,
    pub(super) m1: L,
    pub(super) m2: L,
}

/// +1, or -1 for negative numbers.
#[inline(always)]
pub(super) fn sign<L: Lane>(x: L) -> L {
    L::select(x.lt(L::splat(0.0)), L::splat(-1.0), L::splat(1.0))
}

/// Whether y2 is zero; its derivatives are zero, too, where the capsule is held there.
#[inline(always)]
fn at_rest<L: Lane>(state: &State<L>) -> L::Mask {
    state.y2.abs().le(L::splat(0.0))
}

impl<L: Lane> Rules<'_, L> {
    /// What follows on |F| = f_s, from the rates of |F| in the frozen and in the moving field.
    fn on_limit(&self, closed: L::Mask, state: &State<L>, side: L, time: L) -> PrintedMode<L> {
        let zero = L::splat(0.0);
        let limit = side * self.drag.static_limit;
        let rests = at_rest(state);
        let slip = L::select(rests, side, sign(state.y2));
        let mut cos = series::zero();
        self.drive.cos(time, &mut cos);
        let push = self.drive.amplitude * cos[0] - limit;
        let frozen_rate = side * (self.stiffness * state.y1 + self.c * push / self.m1);
        let (mut decay, mut y2) = (series::zero(), series::zero());
        (decay[0], y2[0]) = (self.drag.decay_start(slip, state.y2), state.y2);
        let friction = self.drag.force_term(slip, &decay, &y2, 0);
        let acceleration = (limit - friction) / self.m2;
        let moving_rate = frozen_rate - side * (self.stiffness * state.y2 + self.c * acceleration);
        let slides = PrintedMode::select(
            moving_rate.lt(zero),
            PrintedMode::new(closed, Regime::Creeping, slip, side),
            PrintedMode::new(closed, Regime::Moving, slip, side),
        );
        let holds = rests & self.drag.static_limit.lt(self.drag.at_onset);
        let held = PrintedMode::new(closed, Regime::Held, zero, side);
        let leaves = PrintedMode::select(holds, held, slides);
        let frozen = PrintedMode::new(closed, Regime::Frozen, zero, zero);
        PrintedMode::select(frozen_rate.le(zero), frozen, leaves)
    }

    /// What follows where |F| = f_s is met at a first-order zero of its guard.
    fn limit_met(&self, closed: L::Mask, state: &State<L>, side: L, time: L) -> Next<L> {
        let mode = self.on_limit(closed, state, side, time);
        Next::new(mode, self.zeros_on_limit(&mode, side, at_rest(state), 1.0))
    }

    /// Which guards of a mode start at zero when it begins on |F| = f_s, and with what power.
    fn zeros_on_limit(
        &self,
        mode: &PrintedMode<L>,
        side: L,
        rests: L::Mask,
        power: f64,
    ) -> Zeros<L> {
        let (none, power) = (L::splat(0.0), L::splat(power));
        let forward = none.lt(side);
        let [frozen, moving, held, creeping] =
            [Regime::Frozen, Regime::Moving, Regime::Held, Regime::Creeping].map(|it| mode.is(it));
        let first = L::select((frozen & forward) | held, power, none);
        let first = L::select(moving & rests, self.drag.onset_zeros(), first);
        let second = L::select((frozen & !forward) | moving, power, none);
        let third = L::select(creeping & rests, L::splat(1.0), none);
        let mut zeros = [none; MAX_GUARDS];
        (zeros[1], zeros[2], zeros[3]) = (first, second, third);
        zeros
    }

    /// Obeys the guard of the contact where `due`.
    pub(super) fn switch_contact(
        &self,
        due: L::Mask,
        mode: &mut PrintedMode<L>,
        state: &State<L>,
        zeros: &mut Zeros<L>,
        time: L,
    ) {
        let creeps = due & mode.is(Regime::Creeping);
        mode.closed = (mode.closed & !due) | (!mode.closed & due);
        if creeps.any() {
            let next = self.limit_met(mode.closed, state, mode.side, time);
            let chosen = Next::select(creeps, next, Next::new(*mode, *zeros));
            (*mode, *zeros) = (chosen.mode, chosen.zeros);
        }
        zeros[CONTACT] = L::select(due, L::splat(1.0), zeros[CONTACT]);
    }

    /// Obeys another guard where `due`.
    pub(super) fn switch_motion(
        &self,
        which: usize,
        due: L::Mask,
        mode: &mut PrintedMode<L>,
        state: &mut State<L>,
        zeros: &mut Zeros<L>,
        time: L,
    ) {
        let zero = L::splat(0.0);
        let before = *mode;
        let stops = match which {
            1 => due & before.is(Regime::Moving),
            2 => L::Mask::splat(false),
            _ => due & before.is(Regime::Creeping),
        };
        state.y2 = L::select(stops, zero, state.y2);
        let beyond = if which == 1 { L::splat(1.0) } else { L::splat(-1.0) };
        let side = L::select(due & before.is(Regime::Frozen), beyond, before.side);
        // Frozen is left by what is met at the limit, and so is creeping whose speed has come to zero.
        let met = self.limit_met(before.closed, state, side, time);
        let next = match which {
            1 => self.first_obeyed(&before, due, state, met),
            2 => self.second_obeyed(&before, due, state, met),
            _ => met,
        };
        let contact = zeros[CONTACT];
        let next = Next::select(due, next, Next::new(before, *zeros));
        (*mode, *zeros) = (next.mode, next.zeros);
        zeros[CONTACT] = contact;
        // A capsule that is pushed off y2 = 0 while frozen slides here instead, and the friction at the onset of sliding, which is
        // above |F|, brings it back to rest: so pushes along y2 end, and what it has moved by then is of second order.
        state.y2 = L::select(due & mode.is(Regime::Held), zero, state.y2);
    }

    /// What follows where guard 1 of the mode `before` has come to zero; `met` is what follows on the limit.
    fn first_obeyed(
        &self,
        before: &PrintedMode<L>,
        due: L::Mask,
        state: &State<L>,
        met: Next<L>,
    ) -> Next<L> {
        let zero = L::splat(0.0);
        let PrintedMode { closed, side, .. } = *before;
        let [moving, held, creeping] =
            [Regime::Moving, Regime::Held, Regime::Creeping].map(|it| due & before.is(it));
        let breaks = self.drag.at_onset.lt(self.force.at(state).abs());
        let leaves = PrintedMode::new(closed, Regime::Moving, side, side);
        let leaves = Next::new(leaves, zeros_of_slip(1.0));
        let holds =
            Next::new(PrintedMode::new(closed, Regime::Held, zero, side), [zero; MAX_GUARDS]);
        let stopped = Next::select(breaks, leaves, holds);
        let freezes = PrintedMode::new(closed, Regime::Frozen, zero, zero);
        let next = Next::select(held, self.reached(freezes, before, state, 1.0), met);
        let next = Next::select(creeping, self.reached(freezes, before, state, 2.0), next);
        Next::select(moving, stopped, next)
    }

    /// The same of guard 2.
    fn second_obeyed(
        &self,
        before: &PrintedMode<L>,
        due: L::Mask,
        state: &State<L>,
        met: Next<L>,
    ) -> Next<L> {
        let PrintedMode { closed, slip, side, .. } = *before;
        let [held, creeping] = [Regime::Held, Regime::Creeping].map(|it| due & before.is(it));
        let leaves = PrintedMode::new(closed, Regime::Moving, side, side);
        let leaves = Next::new(leaves, zeros_of_slip(2.0));
        let slides = PrintedMode::new(closed, Regime::Moving, slip, side);
        let next = Next::select(held, leaves, met);
        Next::select(creeping, self.reached(slides, before, state, 2.0), next)
    }

    /// A mode that begins on the limit, on the side of the mode `before`.
    fn reached(
        &self,
        mode: PrintedMode<L>,
        before: &PrintedMode<L>,
        state: &State<L>,
        power: f64,
    ) -> Next<L> {
        Next::new(mode, self.zeros_on_limit(&mode, before.side, at_rest(state), power))
    }
}

impl PrintedMode<f64> {
    /// Whether the capsule creeps, with a share of H.
    pub fn creeps(&self) -> bool {
        self.is(Regime::Creeping)
    }
}
