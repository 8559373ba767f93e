//! The regimes of the capsule as printed, and what follows each of them.

use crate::lane::{Lane, series};

use super::printed::{CONTACT, PrintedCapsule};
use super::{EventKind, State, StickSlip, Zeros};

/// Which field acts on the capsule; `side` is the sign of F, `slip` that of y2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) enum Regime {
    /// H = 0: x2 and y2 stand still, y2 not necessarily at zero. Guards 1, 2: f_s - F, f_s + F.
    #[default]
    Frozen,
    /// H = 1. Guards 1, 2: the speed, |F| - f_s.
    Moving { slip: f64, side: f64 },
    /// H = 1, held at y2 = 0 by f_d(0+) > |F|. Guards 1, 2: |F| - f_s, f_d(0+) - |F|.
    Held { side: f64 },
    /// 0 < H < 1 on |F| = f_s. Guards 1, 2, 3: H, 1 - H, the speed.
    Creeping { slip: f64, side: f64 },
}

/// The mode of the capsule as printed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PrintedMode {
    /// Whether the mass touches the stop.
    pub(super) closed: bool,
    /// Which field acts on the capsule.
    pub(super) regime: Regime,
}

impl Regime {
    /// Whether and where the capsule slides.
    pub(super) fn stick_slip(self) -> StickSlip {
        match self {
            Regime::Frozen | Regime::Held { .. } => StickSlip::Stick,
            Regime::Moving { slip, .. } | Regime::Creeping { slip, .. } if slip > 0.0 => {
                StickSlip::Forward
            }
            _ => StickSlip::Backward,
        }
    }

    /// The event that a change to another regime amounts to.
    pub(super) fn event_to(self, after: Regime) -> Option<EventKind> {
        use StickSlip::{Backward, Forward, Stick};
        match (self.stick_slip(), after.stick_slip()) {
            (Stick, Forward) => Some(EventKind::SlipForward),
            (Stick, Backward) => Some(EventKind::SlipBackward),
            (Forward | Backward, Stick) => Some(EventKind::Stick),
            (Forward, Backward) | (Backward, Forward) => Some(EventKind::Reversal),
            _ => None,
        }
    }
}

/// Whether y2 is zero: on the surface of rest it is so by the guard that led there, derivatives included.
fn at_rest<L: Lane<Mask = bool>>(state: &State<L>) -> bool {
    state.y2.lane(0) == 0.0
}

impl<L: Lane<Mask = bool>> PrintedCapsule<L> {
    /// What follows on |F| = f_s, from the rates of |F| in the frozen and in the moving field.
    fn on_limit(&self, closed: bool, state: &State<L>, side: f64, time: L) -> Regime {
        let limit = L::splat(side) * self.drag.static_limit;
        let at_rest = at_rest(state);
        let slip = if at_rest { side } else { state.y2.lane(0).signum() };
        let stiffness = self.stiffness(closed);
        let mut cos = series::zero();
        self.drive.cos(time, &mut cos);
        let push = self.drive.amplitude * cos[0] - limit;
        let frozen_rate = L::splat(side) * (stiffness * state.y1 + self.c * push / self.m1);
        if frozen_rate.le(L::splat(0.0)) {
            return Regime::Frozen;
        }
        if at_rest && self.drag.static_limit.lt(self.drag.at_onset) {
            return Regime::Held { side };
        }
        let (mut decay, mut y2) = (series::zero(), series::zero());
        (decay[0], y2[0]) = (self.drag.decay_start(state.y2), state.y2);
        let friction = self.drag.force_term(L::splat(slip), &decay, &y2, 0);
        let acceleration = (limit - friction) / self.m2;
        let moving_rate =
            frozen_rate - L::splat(side) * (stiffness * state.y2 + self.c * acceleration);
        if moving_rate.lt(L::splat(0.0)) {
            Regime::Creeping { slip, side }
        } else {
            Regime::Moving { slip, side }
        }
    }

    /// What follows where |F| = f_s is met at a first-order zero of its guard, and which guards start at
    /// zero.
    pub(super) fn limit_met(
        &self,
        closed: bool,
        state: &State<L>,
        side: f64,
        time: L,
    ) -> (Regime, Zeros<L>) {
        let regime = self.on_limit(closed, state, side, time);
        (regime, self.zeros_on_limit(regime, side, at_rest(state), 1.0))
    }

    /// Which guards of `regime` start at zero when it begins on |F| = f_s, and with what power.
    fn zeros_on_limit(&self, regime: Regime, side: f64, at_rest: bool, power: f64) -> Zeros<L> {
        let (none, power) = (L::splat(0.0), L::splat(power));
        match regime {
            Regime::Frozen if side > 0.0 => [none, power, none, none],
            Regime::Frozen => [none, none, power, none],
            Regime::Held { .. } => [none, power, none, none],
            Regime::Moving { .. } if at_rest => [none, self.drag.onset_zeros(), power, none],
            Regime::Moving { .. } => [none, none, power, none],
            Regime::Creeping { .. } if at_rest => [none, none, none, L::splat(1.0)],
            Regime::Creeping { .. } => [none; 4],
        }
    }

    /// What follows a guard other than the contact's.
    pub(super) fn switch_motion(
        &self,
        which: usize,
        mode: &mut PrintedMode,
        state: &mut State<L>,
        zeros: &mut Zeros<L>,
        time: L,
    ) {
        let zero = L::splat(0.0);
        let contact_zero = zeros[CONTACT];
        let before = mode.regime;
        let limit_reached = |regime: Regime, side: f64, power: f64| {
            (regime, self.zeros_on_limit(regime, side, at_rest(state), power))
        };
        (mode.regime, *zeros) = match (which, before) {
            (_, Regime::Frozen) => {
                let side = if which == 1 { 1.0 } else { -1.0 };
                self.limit_met(mode.closed, state, side, time)
            }
            (2, Regime::Moving { side, .. }) => self.limit_met(mode.closed, state, side, time),
            (1, Regime::Held { side }) => limit_reached(Regime::Frozen, side, 1.0),
            (_, Regime::Held { side }) => {
                (Regime::Moving { slip: side, side }, [zero, L::splat(2.0), zero, zero])
            }
            (1, Regime::Creeping { side, .. }) => limit_reached(Regime::Frozen, side, 2.0),
            (2, Regime::Creeping { slip, side }) => {
                limit_reached(Regime::Moving { slip, side }, side, 2.0)
            }
            (_, Regime::Moving { side, .. }) => {
                state.y2 = zero;
                let force = self.force(mode.closed, state).abs();
                if self.drag.at_onset.lt(force) {
                    (Regime::Moving { slip: side, side }, [zero, L::splat(1.0), zero, zero])
                } else {
                    (Regime::Held { side }, [zero; 4])
                }
            }
            (_, Regime::Creeping { side, .. }) => {
                state.y2 = zero;
                self.limit_met(mode.closed, state, side, time)
            }
        };
        zeros[CONTACT] = contact_zero;
    }
}
