//! Eq. (1) of the paper to the letter: the capsule freezes while |F| <= f_s, even at speed.
//!
//! The printed switch multiplies x2' and y2' by H = 1 where |F| > f_s and 0 elsewhere, so r' = y1 - H y2
//! while F still contains c (y1 - y2). Where both fields push F towards f_s the printed rule chatters;
//! it is then followed in Filippov's sense along |F| = f_s with the share of H that holds F there.

use crate::lane::{ORDER, Series, series};

use super::resistance::Drag;
use super::switched::{Locomotion, Switched, Zeros};
use super::drive::reduced;
use super::{Contact, Drive, EventKind, Jet, Parameter, Parameters, State, StickSlip};

/// Guard of the contact, `r - delta` while closed and `delta - r` while open.
const CONTACT: usize = 0;

/// The capsule with the switching as printed.
#[derive(Debug, Clone, Copy)]
pub struct PrintedCapsule {
    k1: f64,
    c: f64,
    k2: f64,
    delta: f64,
    m1: f64,
    m2: f64,
    drive: Drive<f64>,
    drag: Drag<f64>,
}

/// Which field acts on the capsule; `side` is the sign of F, `slip` that of y2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Regime {
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
    closed: bool,
    regime: Regime,
}

impl PrintedCapsule {
    /// One capsule whose drive starts at `phase` [rad].
    pub fn single(parameters: &Parameters, phase: f64) -> Self {
        PrintedCapsule {
            k1: parameters[Parameter::K1],
            c: parameters[Parameter::C],
            k2: parameters[Parameter::K2],
            delta: parameters[Parameter::Delta],
            m1: parameters[Parameter::M1],
            m2: parameters[Parameter::M2],
            drive: Drive::new(|parameter| parameters[parameter], reduced(phase)),
            drag: parameters.drag(),
        }
    }

    fn stiffness(&self, closed: bool) -> f64 {
        if closed { self.k1 + self.k2 } else { self.k1 }
    }

    fn force(&self, closed: bool, state: &State<f64>) -> f64 {
        let contact = if closed { self.k2 * (state.r - self.delta) } else { 0.0 };
        self.k1 * state.r + contact + self.c * (state.y1 - state.y2)
    }

    /// What follows on |F| = f_s, from the rates of |F| in the frozen and in the moving field.
    fn on_limit(&self, closed: bool, state: &State<f64>, side: f64, time: f64) -> Regime {
        let limit = side * self.drag.static_limit;
        let at_rest = state.y2 == 0.0;
        let slip = if at_rest { side } else { state.y2.signum() };
        let stiffness = self.stiffness(closed);
        let mut cos = series::zero();
        self.drive.cos(time, &mut cos);
        let push = self.drive.amplitude * cos[0] - limit;
        let frozen_rate = side * (stiffness * state.y1 + self.c * push / self.m1);
        if frozen_rate <= 0.0 {
            return Regime::Frozen;
        }
        if at_rest && self.drag.static_limit < self.drag.at_onset {
            return Regime::Held { side };
        }
        let (mut decay, mut y2) = (series::zero(), series::zero());
        (decay[0], y2[0]) = (self.drag.decay_start(state.y2), state.y2);
        let friction = self.drag.force_term(slip, &decay, &y2, 0);
        let acceleration = (limit - friction) / self.m2;
        let moving_rate = frozen_rate - side * (stiffness * state.y2 + self.c * acceleration);
        if moving_rate < 0.0 {
            Regime::Creeping { slip, side }
        } else {
            Regime::Moving { slip, side }
        }
    }

    /// Which guards of `regime` start at zero when it begins on |F| = f_s, and with what power.
    fn zeros_on_limit(&self, regime: Regime, side: f64, at_rest: bool, power: f64) -> Zeros<f64> {
        match regime {
            Regime::Frozen if side > 0.0 => [0.0, power, 0.0, 0.0],
            Regime::Frozen => [0.0, 0.0, power, 0.0],
            Regime::Held { .. } => [0.0, power, 0.0, 0.0],
            Regime::Moving { .. } if at_rest => [0.0, self.drag.onset_zeros(), power, 0.0],
            Regime::Moving { .. } => [0.0, 0.0, power, 0.0],
            Regime::Creeping { .. } if at_rest => [0.0, 0.0, 0.0, 1.0],
            Regime::Creeping { .. } => [0.0; 4],
        }
    }

    /// The series while H is a share: F stays at the limit and H follows from F' = 0.
    fn creep(&self, jet: &mut Jet<f64>, closed: bool, slip: f64, side: f64) -> Series<f64> {
        let stiffness = self.stiffness(closed);
        let mut share = series::zero();
        let mut full = series::zero(); // acceleration of the moving field
        let mut excess = series::zero(); // frozen minus moving rate of F
        jet.force[0] = side * self.drag.static_limit;
        for k in 0..ORDER {
            let per = series::INVERSE[k + 1];
            let push = (self.drive.amplitude * jet.cos[k] - jet.force[k]) / self.m1;
            let friction = self.drag.force_term(slip, &jet.decay, &jet.y2, k);
            full[k] = (jet.force[k] - friction) / self.m2;
            excess[k] = stiffness * jet.y2[k] + self.c * full[k];
            let frozen_rate = stiffness * jet.y1[k] + self.c * push;
            let known: f64 = (1..=k).map(|j| excess[j] * share[k - j]).sum();
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
    fn glide(&self, jet: &mut Jet<f64>, closed: bool, slip: Option<f64>) {
        let stiffness = self.stiffness(closed);
        for k in 0..ORDER {
            let per = series::INVERSE[k + 1];
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
#[derive(Debug, Clone, Default)]
pub struct PrintedJet {
    /// The motion.
    pub motion: Jet<f64>,
    /// The share of H while creeping.
    share: Series<f64>,
}

impl Switched<f64> for PrintedCapsule {
    type State = State<f64>;
    type Mode = PrintedMode;
    type Jet = PrintedJet;

    const GUARDS: usize = 4;

    fn start(&self, _time: f64, state: &mut State<f64>) -> PrintedMode {
        let closed = state.r > self.delta;
        let force = self.force(closed, state);
        let side = force.signum();
        let regime = if force.abs() <= self.drag.static_limit {
            Regime::Frozen
        } else if state.y2 != 0.0 {
            Regime::Moving { slip: state.y2.signum(), side }
        } else if force.abs() > self.drag.at_onset {
            Regime::Moving { slip: side, side }
        } else {
            Regime::Held { side }
        };
        PrintedMode { closed, regime }
    }

    fn expand(&self, mode: &PrintedMode, time: f64, state: &State<f64>, whole: &mut PrintedJet) {
        *whole = PrintedJet::default();
        let PrintedJet { motion: jet, share } = whole;
        self.drive.cos(time, &mut jet.cos);
        (jet.r[0], jet.y1[0], jet.x2[0], jet.y2[0]) = (state.r, state.y1, state.x2, state.y2);
        jet.force[0] = self.force(mode.closed, state);
        jet.decay[0] = self.drag.decay_start(state.y2);
        match mode.regime {
            Regime::Frozen | Regime::Held { .. } => self.glide(jet, mode.closed, None),
            Regime::Moving { slip, .. } => self.glide(jet, mode.closed, Some(slip)),
            Regime::Creeping { slip, side } => {
                *share = self.creep(jet, mode.closed, slip, side);
            }
        }
    }

    fn pace<'a>(&self, jet: &'a PrintedJet) -> [&'a Series<f64>; 2] {
        [&jet.motion.y1, &jet.motion.y2]
    }

    fn watched(&self, which: usize, mode: &PrintedMode) -> bool {
        which < 3 || matches!(mode.regime, Regime::Creeping { .. })
    }

    fn guard(&self, which: usize, mode: &PrintedMode, jet: &PrintedJet, guard: &mut Series<f64>) {
        let PrintedJet { motion: Jet { r, y2, force, .. }, share } = jet;
        let line = |constant: f64, factor: f64, series: &Series<f64>| {
            let mut guard = series.map(|a| factor * a);
            guard[0] += constant;
            guard
        };
        let (limit, onset) = (self.drag.static_limit, self.drag.at_onset);
        *guard = match (which, mode.regime) {
            (CONTACT, _) => {
                let side = if mode.closed { 1.0 } else { -1.0 };
                let mut gap = line(0.0, side, r);
                gap[0] = side * (r[0] - self.delta);
                gap
            }
            (1, Regime::Frozen) => line(limit, -1.0, force),
            (_, Regime::Frozen) => line(limit, 1.0, force),
            (1, Regime::Moving { slip, .. }) => line(0.0, slip, y2),
            (_, Regime::Moving { side, .. }) => line(-limit, side, force),
            (1, Regime::Held { side }) => line(-limit, side, force),
            (_, Regime::Held { side }) => line(onset, -side, force),
            (1, Regime::Creeping { .. }) => line(0.0, 1.0, share),
            (2, Regime::Creeping { .. }) => line(1.0, -1.0, share),
            (_, Regime::Creeping { slip, .. }) => line(0.0, slip, y2),
        };
    }

    fn at(&self, jet: &PrintedJet, h: f64) -> State<f64> {
        jet.motion.state(h)
    }

    fn switch(
        &self,
        which: usize,
        due: bool,
        mode: &mut PrintedMode,
        state: &mut State<f64>,
        zeros: &mut Zeros<f64>,
        time: f64,
    ) -> f64 {
        if !due {
            return 0.0;
        }
        let before = mode.regime;
        if which == CONTACT {
            mode.closed = !mode.closed;
            state.r = self.delta;
            if let Regime::Creeping { side, .. } = before {
                mode.regime = self.on_limit(mode.closed, state, side, time);
                *zeros = self.zeros_on_limit(mode.regime, side, state.y2 == 0.0, 1.0);
            }
            zeros[CONTACT] = 1.0;
            return if mode.closed {
                EventKind::ContactClosed.code()
            } else {
                EventKind::ContactOpened.code()
            };
        }
        self.switch_motion(which, mode, state, zeros, time);
        event_between(before, mode.regime).map_or(0.0, EventKind::code)
    }

    fn lost(&self, state: &State<f64>) -> bool {
        !(state.y1 + state.y2).is_finite()
    }
}

impl PrintedCapsule {
    /// What follows a guard other than the contact's.
    fn switch_motion(
        &self,
        which: usize,
        mode: &mut PrintedMode,
        state: &mut State<f64>,
        zeros: &mut Zeros<f64>,
        time: f64,
    ) {
        let contact_zero = zeros[CONTACT];
        let before = mode.regime;
        let limit_reached = |regime: Regime, side: f64, power: f64| {
            (regime, self.zeros_on_limit(regime, side, state.y2 == 0.0, power))
        };
        (mode.regime, *zeros) = match (which, before) {
            (_, Regime::Frozen) => {
                let side = if which == 1 { 1.0 } else { -1.0 };
                limit_reached(self.on_limit(mode.closed, state, side, time), side, 1.0)
            }
            (2, Regime::Moving { side, .. }) => {
                limit_reached(self.on_limit(mode.closed, state, side, time), side, 1.0)
            }
            (1, Regime::Held { side }) => limit_reached(Regime::Frozen, side, 1.0),
            (_, Regime::Held { side }) => {
                (Regime::Moving { slip: side, side }, [0.0, 2.0, 0.0, 0.0])
            }
            (1, Regime::Creeping { side, .. }) => limit_reached(Regime::Frozen, side, 2.0),
            (2, Regime::Creeping { slip, side }) => {
                limit_reached(Regime::Moving { slip, side }, side, 2.0)
            }
            (_, Regime::Moving { side, .. }) => {
                state.y2 = 0.0;
                let force = self.force(mode.closed, state).abs();
                if force > self.drag.at_onset {
                    (Regime::Moving { slip: side, side }, [0.0, 1.0, 0.0, 0.0])
                } else {
                    (Regime::Held { side }, [0.0; 4])
                }
            }
            (_, Regime::Creeping { side, .. }) => {
                state.y2 = 0.0;
                let regime = self.on_limit(mode.closed, state, side, time);
                (regime, self.zeros_on_limit(regime, side, true, 1.0))
            }
        };
        zeros[CONTACT] = contact_zero;
    }
}

/// The event that a change of motion amounts to.
fn event_between(before: Regime, after: Regime) -> Option<EventKind> {
    let slip_of = |regime| match regime {
        Regime::Moving { slip, .. } | Regime::Creeping { slip, .. } => Some(slip),
        Regime::Frozen | Regime::Held { .. } => None,
    };
    match (slip_of(before), slip_of(after)) {
        (None, Some(slip)) if slip > 0.0 => Some(EventKind::SlipForward),
        (None, Some(_)) => Some(EventKind::SlipBackward),
        (Some(_), None) => Some(EventKind::Stick),
        (Some(old), Some(new)) if old != new => Some(EventKind::Reversal),
        _ => None,
    }
}

impl Locomotion for PrintedCapsule {
    fn motion<'a>(&self, jet: &'a PrintedJet) -> &'a Jet<f64> {
        &jet.motion
    }

    fn friction(&self, _mode: &PrintedMode, jet: &PrintedJet) -> Series<f64> {
        // Whatever F does not spend on m2 y2' is friction, in every motion.
        let acceleration = series::derivative(&jet.motion.y2);
        std::array::from_fn(|k| jet.motion.force[k] - self.m2 * acceleration[k])
    }

    fn slip_rate(&self, _mode: &PrintedMode, jet: &PrintedJet) -> Series<f64> {
        series::derivative(&jet.motion.x2)
    }

    fn contact(&self, mode: &PrintedMode) -> Contact {
        if mode.closed { Contact::Closed } else { Contact::Open }
    }

    fn stick_slip(&self, mode: &PrintedMode) -> StickSlip {
        match mode.regime {
            Regime::Frozen | Regime::Held { .. } => StickSlip::Stick,
            Regime::Moving { slip, .. } | Regime::Creeping { slip, .. } if slip > 0.0 => {
                StickSlip::Forward
            }
            _ => StickSlip::Backward,
        }
    }
}
