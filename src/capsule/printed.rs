//! Eq. (1) of the paper to the letter: the capsule freezes while |F| <= f_s, even at speed.
//!
//! The printed switch multiplies x2' and y2' by H = 1 where |F| > f_s and 0 elsewhere, so r' = y1 - H y2
//! while F still contains c (y1 - y2). Where both fields push F towards f_s the printed rule chatters;
//! it is then followed in Filippov's sense along |F| = f_s with the share of H that holds F there.

use crate::lane::{Lane, ORDER, Series, elementary::not_finite, series};

use super::drive::reduced;
use super::regime::{PrintedMode, Regime};
use super::resistance::Drag;
use super::switched::{Field, Locomotion, Stroboscopic, Switched, Zeros};
use super::{Contact, Drive, EventKind, Jet, Parameter, Parameters, Resistance, State, StickSlip};

/// Guard of the contact, `r - delta` while closed and `delta - r` while open.
pub(super) const CONTACT: usize = 0;

/// The capsule with the switching as printed; its modes branch on data, so one case at a time.
#[derive(Debug, Clone, Copy)]
pub struct PrintedCapsule<L> {
    k1: L,
    pub(super) c: L,
    k2: L,
    delta: L,
    pub(super) m1: L,
    pub(super) m2: L,
    pub(super) drive: Drive<L>,
    pub(super) drag: Drag<L>,
}

impl PrintedCapsule<f64> {
    /// One capsule whose drive starts at `phase` [rad].
    pub fn single(parameters: &Parameters, phase: f64) -> Self {
        PrintedCapsule::new(|parameter| parameters[parameter], parameters.resistance, phase)
    }
}

impl<L: Lane<Mask = bool>> PrintedCapsule<L> {
    /// The capsule with these parameters under one law, whose drive starts at `phase` [rad].
    pub fn new(of: impl Fn(Parameter) -> L, law: Resistance, phase: f64) -> Self {
        PrintedCapsule {
            k1: of(Parameter::K1),
            c: of(Parameter::C),
            k2: of(Parameter::K2),
            delta: of(Parameter::Delta),
            m1: of(Parameter::M1),
            m2: of(Parameter::M2),
            drive: Drive::new(&of, L::splat(reduced(phase))),
            drag: Drag::new(&of, law),
        }
    }

    pub(super) fn stiffness(&self, closed: bool) -> L {
        if closed { self.k1 + self.k2 } else { self.k1 }
    }

    /// The force of the mass on the capsule, F [N].
    pub(super) fn force(&self, closed: bool, state: &State<L>) -> L {
        let contact = if closed { self.k2 * (state.r - self.delta) } else { L::splat(0.0) };
        self.k1 * state.r + contact + self.c * (state.y1 - state.y2)
    }

    /// The series while H is a share: F stays at the limit and H follows from F' = 0.
    fn creep(&self, jet: &mut Jet<L>, closed: bool, slip: L, side: L) -> Series<L> {
        let stiffness = self.stiffness(closed);
        let mut share = series::zero();
        let mut full = series::zero(); // acceleration of the moving field
        let mut excess = series::zero(); // frozen minus moving rate of F
        jet.force[0] = side * self.drag.static_limit;
        for k in 0..ORDER {
            let per = L::splat(series::INVERSE[k + 1]);
            let push = (self.drive.amplitude * jet.cos[k] - jet.force[k]) / self.m1;
            let friction = self.drag.force_term(slip, &jet.decay, &jet.y2, k);
            full[k] = (jet.force[k] - friction) / self.m2;
            excess[k] = stiffness * jet.y2[k] + self.c * full[k];
            let frozen_rate = stiffness * jet.y1[k] + self.c * push;
            let mut known = L::splat(0.0);
            for j in 1..=k {
                known = known + excess[j] * share[k - j];
            }
            share[k] = (frozen_rate - known) / excess[0];
            jet.acceleration[k] = series::product_term(&share, &full, k);
            let advance = series::product_term(&share, &jet.y2, k);
            jet.y1[k + 1] = push * per;
            jet.y2[k + 1] = jet.acceleration[k] * per;
            jet.x2[k + 1] = advance * per;
            jet.r[k + 1] = (jet.y1[k] - advance) * per;
            jet.decay[k + 1] = self.drag.decay_term(slip, &jet.decay, &jet.acceleration, k);
        }
        share
    }

    /// The series where H is 0 (no `slip`) or 1.
    fn glide(&self, jet: &mut Jet<L>, closed: bool, slip: Option<L>) {
        let stiffness = self.stiffness(closed);
        for k in 0..ORDER {
            let per = L::splat(series::INVERSE[k + 1]);
            if k > 0 {
                jet.force[k] = stiffness * jet.r[k] + self.c * (jet.y1[k] - jet.y2[k]);
            }
            let push = self.drive.amplitude * jet.cos[k] - jet.force[k];
            jet.y1[k + 1] = push / self.m1 * per;
            jet.r[k + 1] = jet.y1[k] * per;
            if let Some(slip) = slip {
                let friction = self.drag.force_term(slip, &jet.decay, &jet.y2, k);
                jet.acceleration[k] = (jet.force[k] - friction) / self.m2;
                jet.y2[k + 1] = jet.acceleration[k] * per;
                jet.x2[k + 1] = jet.y2[k] * per;
                jet.r[k + 1] = (jet.y1[k] - jet.y2[k]) * per;
                jet.decay[k + 1] = self.drag.decay_term(slip, &jet.decay, &jet.acceleration, k);
            }
        }
        jet.force[ORDER] = stiffness * jet.r[ORDER] + self.c * (jet.y1[ORDER] - jet.y2[ORDER]);
    }
}

/// The series of a step of the printed equation.
#[derive(Debug, Clone)]
pub struct PrintedJet<L> {
    /// The motion.
    pub motion: Jet<L>,
    /// The share of H while creeping.
    share: Series<L>,
}

impl<L: Lane> Default for PrintedJet<L> {
    fn default() -> Self {
        PrintedJet { motion: Jet::default(), share: series::zero() }
    }
}

impl<L: Lane<Mask = bool>> Switched<L> for PrintedCapsule<L> {
    type State = State<L>;
    type Mode = PrintedMode;
    type Jet = PrintedJet<L>;

    const GUARDS: usize = 4;

    fn start(&self, _time: L, state: &mut State<L>) -> PrintedMode {
        let closed = self.delta.lt(state.r);
        let force = self.force(closed, state);
        let (side, speed) = (force.lane(0).signum(), state.y2.lane(0));
        let regime = if force.abs().le(self.drag.static_limit) {
            Regime::Frozen
        } else if speed != 0.0 {
            Regime::Moving { slip: speed.signum(), side }
        } else if self.drag.at_onset.lt(force.abs()) {
            Regime::Moving { slip: side, side }
        } else {
            Regime::Held { side }
        };
        PrintedMode { closed, regime }
    }

    fn expand(&self, mode: &PrintedMode, time: L, state: &State<L>, whole: &mut PrintedJet<L>) {
        *whole = PrintedJet::default();
        let PrintedJet { motion: jet, share } = whole;
        self.drive.cos(time, &mut jet.cos);
        (jet.r[0], jet.y1[0], jet.x2[0], jet.y2[0]) = (state.r, state.y1, state.x2, state.y2);
        jet.force[0] = self.force(mode.closed, state);
        jet.decay[0] = self.drag.decay_start(state.y2);
        match mode.regime {
            Regime::Frozen | Regime::Held { .. } => self.glide(jet, mode.closed, None),
            Regime::Moving { slip, .. } => self.glide(jet, mode.closed, Some(L::splat(slip))),
            Regime::Creeping { slip, side } => {
                *share = self.creep(jet, mode.closed, L::splat(slip), L::splat(side));
            }
        }
    }

    fn pace<'a>(&self, jet: &'a PrintedJet<L>) -> [&'a Series<L>; 2] {
        [&jet.motion.y1, &jet.motion.y2]
    }

    fn step_bound(
        &self,
        mode: &PrintedMode,
        jet: &PrintedJet<L>,
        length: L::Plain,
        tolerance: f64,
    ) -> L::Plain {
        match mode.regime {
            Regime::Frozen | Regime::Held { .. } => length,
            Regime::Moving { slip, .. } | Regime::Creeping { slip, .. } => {
                let Jet { decay, y2, .. } = &jet.motion;
                self.drag.step_bound(L::splat(slip), decay, y2, length, tolerance)
            }
        }
    }

    fn watched(&self, which: usize, mode: &PrintedMode) -> bool {
        which < 3 || matches!(mode.regime, Regime::Creeping { .. })
    }

    fn guard(&self, which: usize, mode: &PrintedMode, jet: &PrintedJet<L>, guard: &mut Series<L>) {
        let PrintedJet { motion: Jet { r, y2, force, .. }, share } = jet;
        let line = |constant: L, factor: f64, series: &Series<L>| {
            let mut guard = series.map(|a| L::splat(factor) * a);
            guard[0] = guard[0] + constant;
            guard
        };
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let (limit, onset) = (self.drag.static_limit, self.drag.at_onset);
        *guard = match (which, mode.regime) {
            (CONTACT, _) => {
                let side = if mode.closed { 1.0 } else { -1.0 };
                let mut gap = line(zero, side, r);
                gap[0] = L::splat(side) * (r[0] - self.delta);
                gap
            }
            (1, Regime::Frozen) => line(limit, -1.0, force),
            (_, Regime::Frozen) => line(limit, 1.0, force),
            (1, Regime::Moving { slip, .. }) => line(zero, slip, y2),
            (_, Regime::Moving { side, .. }) => line(-limit, side, force),
            (1, Regime::Held { side }) => line(-limit, side, force),
            (_, Regime::Held { side }) => line(onset, -side, force),
            (1, Regime::Creeping { .. }) => line(zero, 1.0, share),
            (2, Regime::Creeping { .. }) => line(one, -1.0, share),
            (_, Regime::Creeping { slip, .. }) => line(zero, slip, y2),
        };
    }

    fn at(&self, jet: &PrintedJet<L>, h: L) -> State<L> {
        jet.motion.state(h)
    }

    fn switch(
        &self,
        which: usize,
        due: bool,
        mode: &mut PrintedMode,
        state: &mut State<L>,
        zeros: &mut Zeros<L>,
        time: L,
    ) -> L {
        if !due {
            return L::splat(0.0);
        }
        let before = mode.regime;
        if which == CONTACT {
            mode.closed = !mode.closed;
            state.r = self.delta;
            if let Regime::Creeping { side, .. } = before {
                (mode.regime, *zeros) = self.limit_met(mode.closed, state, side, time);
            }
            zeros[CONTACT] = L::splat(1.0);
            return if mode.closed {
                EventKind::ContactClosed.code()
            } else {
                EventKind::ContactOpened.code()
            };
        }
        self.switch_motion(which, mode, state, zeros, time);
        before.event_to(mode.regime).map_or(L::splat(0.0), EventKind::code)
    }

    fn lost(&self, state: &State<L>) -> bool {
        not_finite(state.y1 + state.y2)
    }
}

impl<L: Lane<Mask = bool>> Stroboscopic<L, 3> for PrintedCapsule<L> {
    fn point(state: &State<L>) -> [L; 3] {
        [state.r, state.y1, state.y2]
    }

    fn state([r, y1, y2]: [L; 3]) -> State<L> {
        State { r, y1, x2: L::splat(0.0), y2 }
    }

    /// A displacement r counts as the velocity omega r.
    fn scales(&self) -> [f64; 3] {
        [self.drive.omega.lane(0), 1.0, 1.0]
    }
}

impl Field<4> for PrintedCapsule<f64> {
    fn coordinates<'a>(&self, jet: &'a PrintedJet<f64>) -> [&'a Series<f64>; 4] {
        jet.motion.coordinates()
    }

    fn rates(&self, mode: &PrintedMode, time: f64, &[r, y1, x2, y2]: &[f64; 4]) -> [f64; 4] {
        let PrintedMode { closed, regime } = *mode;
        let force = self.force(closed, &State { r, y1, x2, y2 });
        let acceleration = (self.drive.force(time) - force) / self.m1;
        // The rate of y2 with H = 1.
        let moving = |slip| (force - self.drag.force(slip, y2)) / self.m2;
        match regime {
            Regime::Frozen | Regime::Held { .. } => [y1, acceleration, 0.0, 0.0],
            Regime::Moving { slip, .. } => [y1 - y2, acceleration, y2, moving(slip)],
            Regime::Creeping { slip, .. } => {
                // F' = k (y1 - H y2) + c (y1' - H y2') vanishes.
                let (k, full) = (self.stiffness(closed), moving(slip));
                let share = (k * y1 + self.c * acceleration) / (k * y2 + self.c * full);
                [y1 - share * y2, acceleration, share * y2, share * full]
            }
        }
    }

    /// A displacement r or x2 counts as the velocity omega r.
    fn weights(&self) -> [f64; 4] {
        [self.drive.omega, 1.0, self.drive.omega, 1.0]
    }

    fn layered<'a>(&self, mode: &PrintedMode, jet: &'a PrintedJet<f64>) -> Option<&'a Series<f64>> {
        let slides = matches!(mode.regime, Regime::Moving { .. } | Regime::Creeping { .. });
        (slides && self.drag.has_layer()).then_some(&jet.motion.y2)
    }
}

impl Locomotion for PrintedCapsule<f64> {
    type With<L: Lane<Mask = bool>> = PrintedCapsule<L>;

    fn with<L: Lane<Mask = bool>>(
        of: impl Fn(Parameter) -> L,
        law: Resistance,
        phase: f64,
    ) -> PrintedCapsule<L> {
        PrintedCapsule::new(of, law, phase)
    }

    fn motion<'a>(&self, jet: &'a PrintedJet<f64>) -> &'a Jet<f64> {
        &jet.motion
    }

    fn friction(&self, _mode: &PrintedMode, jet: &PrintedJet<f64>) -> Series<f64> {
        // Whatever F does not spend on m2 y2' is friction, in every motion.
        let acceleration = series::derivative(&jet.motion.y2);
        std::array::from_fn(|k| jet.motion.force[k] - self.m2 * acceleration[k])
    }

    fn slip_rate(&self, _mode: &PrintedMode, jet: &PrintedJet<f64>) -> Series<f64> {
        series::derivative(&jet.motion.x2)
    }

    fn contact(&self, mode: &PrintedMode) -> Contact {
        if mode.closed { Contact::Closed } else { Contact::Open }
    }

    fn stick_slip(&self, mode: &PrintedMode) -> StickSlip {
        mode.regime.stick_slip()
    }
}
