//! Eq. (1) of the paper to the letter: the capsule freezes while |F| <= f_s, even at speed.
//!
//! The printed switch multiplies x2' and y2' by H = 1 where |F| > f_s and 0 elsewhere, so r' = y1 - H y2
//! while F still contains c (y1 - y2). Where both fields push F towards f_s the printed rule chatters;
//! it is then followed in Filippov's sense along |F| = f_s with the share of H that holds F there.

use capsulemap_engine::flow::{Event, Field, Stroboscopic, Switched, Zeros};
use capsulemap_engine::lane::{Lane, Mask, ORDER, Series, elementary, series, side_by_side};

use super::drag::Drag;
use super::drive::Drive;
use super::locomotion::{DriveSeries, Locomotion};
use super::regime::{CONTACT, GuardTerms, MassForce, PrintedMode, Regime, Rules, sign};
use super::shape::Shape;
use super::state::{EventKind, Jet, State};
use super::{CapsuleParameters as _, Parameter};
use crate::{description::Parameters, motion};

/// The capsule with the switching as printed, one set of parameters per lane.
#[derive(Debug, Clone, Copy)]
pub struct PrintedCapsule<L> {
    k1: L,
    c: L,
    k2: L,
    delta: L,
    m1: L,
    m2: L,
    drive: Drive<L>,
    drag: Drag<L>,
}

side_by_side!(PrintedCapsule { k1, c, k2, delta, m1, m2 } with { drive, drag });

impl PrintedCapsule<f64> {
    /// One capsule whose drive is at `phase` at the section [rad].
    pub fn single(parameters: &Parameters, phase: f64) -> Self {
        PrintedCapsule::new(|parameter| parameters[parameter], parameters.shape(), phase)
    }
}

impl<L: Lane> PrintedCapsule<L> {
    /// The capsule with these parameters and of this shape, whose drive is at `phase` at the section [rad].
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape, phase: f64) -> Self {
        PrintedCapsule {
            k1: of(Parameter::K1),
            c: of(Parameter::C),
            k2: of(Parameter::K2),
            delta: of(Parameter::Delta),
            m1: of(Parameter::M1),
            m2: of(Parameter::M2),
            drive: Drive::new(&of, shape, L::splat(motion::reduced(phase))),
            drag: Drag::new(&of, shape.law),
        }
    }

    #[inline(always)]
    fn stiffness(&self, closed: L::Mask) -> L {
        L::select(closed, self.k1 + self.k2, self.k1)
    }

    #[inline(always)]
    fn mass_force(&self, closed: L::Mask) -> MassForce<L> {
        let PrintedCapsule { k1, c, k2, delta, .. } = *self;
        MassForce { k1, c, k2, delta, closed }
    }

    /// The force of the mass on the capsule, F [N].
    #[inline(always)]
    fn force(&self, closed: L::Mask, state: &State<L>) -> L {
        self.mass_force(closed).at(state)
    }

    #[inline(always)]
    fn rules(&self, closed: L::Mask) -> Rules<'_, L> {
        let PrintedCapsule { c, m1, m2, drive, drag, .. } = self;
        let (force, stiffness) = (self.mass_force(closed), self.stiffness(closed));
        Rules { drive, drag, force, stiffness, c: *c, m1: *m1, m2: *m2 }
    }

    /// The series where H is 0, 1, or the share that holds F at the limit, which follows from F' = 0.
    #[inline(always)]
    fn advance(&self, mode: &PrintedMode<L>, jet: &mut Jet<L>, share: &mut Series<L>) {
        let zero = L::splat(0.0);
        let stiffness = self.stiffness(mode.closed);
        let creeps = mode.is(Regime::Creeping);
        let moves = mode.is(Regime::Moving);
        let slides = moves | creeps;
        let mut full = series::zero(); // acceleration of the moving field
        let mut excess = series::zero(); // frozen minus moving rate of F
        for k in 0..ORDER {
            let per = L::Plain::splat(series::INVERSE[k + 1]);
            if k > 0 {
                let force = stiffness * jet.r[k] + self.c * (jet.y1[k] - jet.y2[k]);
                jet.force[k] = L::select(creeps, zero, force);
            }
            let push = (self.drive.amplitude * jet.cos[k] - jet.force[k]) / self.m1;
            let (mut advance, mut acceleration) = (zero, zero);
            if slides.any() {
                let friction = self.drag.force_term(mode.slip, &jet.decay, &jet.y2, k);
                full[k] = (jet.force[k] - friction) / self.m2;
                acceleration = L::select(moves, full[k], zero);
                advance = L::select(moves, jet.y2[k], zero);
            }
            if creeps.any() {
                excess[k] = stiffness * jet.y2[k] + self.c * full[k];
                let frozen_rate = stiffness * jet.y1[k] + self.c * push;
                let mut known = zero;
                for j in 1..=k {
                    known = known + excess[j] * share[k - j];
                }
                share[k] = L::select(creeps, (frozen_rate - known) / excess[0], zero);
                let creeping = series::product_term(share, &full, k);
                acceleration = L::select(creeps, creeping, acceleration);
                advance = L::select(creeps, series::product_term(share, &jet.y2, k), advance);
            }
            jet.acceleration[k] = acceleration;
            jet.y1[k + 1] = push.scaled(per);
            jet.y2[k + 1] = acceleration.scaled(per);
            jet.x2[k + 1] = advance.scaled(per);
            jet.r[k + 1] = (jet.y1[k] - advance).scaled(per);
            if slides.any() {
                self.drag.write_exponent_term(mode.slip, jet, k + 1);
                let decay = self.drag.decay_term(mode.slip, jet, k);
                jet.decay[k + 1] = L::select(slides, decay, zero);
            }
        }
        let force = stiffness * jet.r[ORDER] + self.c * (jet.y1[ORDER] - jet.y2[ORDER]);
        jet.force[ORDER] = L::select(creeps, zero, force);
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

side_by_side!(PrintedJet {} with { motion, share });

impl<L: Lane> Default for PrintedJet<L> {
    #[inline(always)]
    fn default() -> Self {
        PrintedJet { motion: Jet::default(), share: series::zero() }
    }
}

impl<L: Lane> Switched<L> for PrintedCapsule<L> {
    type State = State<L>;
    type Mode = PrintedMode<L>;
    type Jet = PrintedJet<L>;
    type Event = EventKind;

    const GUARDS: usize = 4;

    #[inline(always)]
    fn period(&self) -> L {
        self.drive.period()
    }

    fn start(&self, _time: L, state: &mut State<L>) -> PrintedMode<L> {
        let zero = L::splat(0.0);
        let closed = self.delta.lt(state.r);
        let force = self.force(closed, state);
        let (side, slip) = (sign(force), sign(state.y2));
        let breaks = self.drag.at_onset.lt(force.abs());
        let leaves = PrintedMode::new(closed, Regime::Moving, side, side);
        let held = PrintedMode::new(closed, Regime::Held, zero, side);
        let at_rest = PrintedMode::select(breaks, leaves, held);
        let rests = state.y2.abs().le(zero);
        let slides = PrintedMode::new(closed, Regime::Moving, slip, side);
        let moves = PrintedMode::select(rests, at_rest, slides);
        let freezes = force.abs().le(self.drag.static_limit);
        PrintedMode::select(freezes, PrintedMode::new(closed, Regime::Frozen, zero, zero), moves)
    }

    #[inline(always)]
    fn expand(&self, mode: &PrintedMode<L>, time: L, state: &State<L>, whole: &mut PrintedJet<L>) {
        *whole = PrintedJet::default();
        let PrintedJet { motion: jet, share } = whole;
        self.drive.cos(time, &mut jet.cos);
        (jet.r[0], jet.y1[0], jet.x2[0], jet.y2[0]) = (state.r, state.y1, state.x2, state.y2);
        let force = self.force(mode.closed, state);
        let limit = mode.side * self.drag.static_limit;
        jet.force[0] = L::select(mode.is(Regime::Creeping), limit, force);
        jet.decay[0] = self.drag.decay_start(mode.slip, state.y2);
        self.drag.write_exponent_term(mode.slip, jet, 0);
        self.advance(mode, jet, share);
    }

    #[inline(always)]
    fn pace<'a>(&self, jet: &'a PrintedJet<L>) -> [&'a Series<L>; 2] {
        [&jet.motion.y1, &jet.motion.y2]
    }

    #[inline(always)]
    fn step_bound(
        &self,
        mode: &PrintedMode<L>,
        jet: &PrintedJet<L>,
        length: L::Plain,
        tolerance: f64,
    ) -> L::Plain {
        self.drag.step_bound(mode.slip, &jet.motion.decay, &jet.motion.y2, length, tolerance)
    }

    #[inline(always)]
    fn watched(&self, which: usize, mode: &PrintedMode<L>) -> L::Mask {
        if which < 3 { L::Mask::splat(true) } else { mode.is(Regime::Creeping) }
    }

    #[inline(always)]
    fn guard(
        &self,
        which: usize,
        mode: &PrintedMode<L>,
        jet: &PrintedJet<L>,
        guard: &mut Series<L>,
    ) {
        let PrintedJet { motion: Jet { r, y2, force, .. }, share } = jet;
        if which == CONTACT {
            let side = L::select(mode.closed, L::splat(1.0), L::splat(-1.0));
            for (term, r) in guard.iter_mut().zip(r) {
                *term = side * *r;
            }
            guard[0] = side * (r[0] - self.delta);
            return;
        }
        let GuardTerms { of_force, of_share, factor, constant } = mode.guard(which, &self.drag);
        for (k, term) in guard.iter_mut().enumerate() {
            let other = L::select(of_share, share[k], y2[k]);
            *term = factor * L::select(of_force, force[k], other);
        }
        guard[0] = guard[0] + constant;
    }

    #[inline(always)]
    fn at(&self, jet: &PrintedJet<L>, h: L) -> State<L> {
        jet.motion.state(h)
    }

    #[inline(always)]
    fn motion(&self, jet: &PrintedJet<L>, h: L) -> (State<L>, State<L>) {
        jet.motion.motion(h)
    }

    #[inline(always)]
    fn beginning(&self, jet: &PrintedJet<L>) -> State<L> {
        jet.motion.beginning()
    }

    #[inline(always)]
    fn layered<'a>(
        &self,
        mode: &PrintedMode<L>,
        jet: &'a PrintedJet<L>,
    ) -> Option<(&'a Series<L>, L::Mask)> {
        let slides = L::splat(0.0).lt(mode.slip * mode.slip);
        Some((&jet.motion.y2, slides & self.drag.layer()?))
    }

    #[inline(always)]
    fn switch(
        &self,
        which: usize,
        due: L::Mask,
        mode: &mut PrintedMode<L>,
        state: &mut State<L>,
        zeros: &mut Zeros<L>,
        time: L,
    ) -> L {
        let zero = L::splat(0.0);
        if which == CONTACT {
            let closes = !mode.closed;
            state.r = L::select(due, self.delta, state.r);
            let after = (mode.closed & !due) | (closes & due);
            self.rules(after).switch_contact(due, mode, state, zeros, time);
            let code =
                L::select(closes, EventKind::ContactClosed.code(), EventKind::ContactOpened.code());
            return L::select(due, code, zero);
        }
        let before = *mode;
        self.rules(before.closed).switch_motion(which, due, mode, state, zeros, time);
        // The event that a change to another regime amounts to.
        let (slid, slides) = (before.slip, mode.slip);
        let onset = L::select(
            zero.lt(slides),
            EventKind::SlipForward.code(),
            EventKind::SlipBackward.code(),
        );
        let (rested, rests) = ((slid * slid).le(zero), (slides * slides).le(zero));
        let code = L::select(rested & !rests, onset, zero);
        let code = L::select(rests & !rested, EventKind::Stick.code(), code);
        let code = L::select((slid * slides).lt(zero), EventKind::Reversal.code(), code);
        L::select(due, code, zero)
    }

    #[inline(always)]
    fn lost(&self, state: &State<L>) -> L::Mask {
        elementary::not_finite(state.y1 + state.y2)
    }

    #[inline(always)]
    fn touching<'a>(&self, jet: &'a PrintedJet<L>) -> Option<(&'a Series<L>, [L; 2])> {
        Some((&jet.motion.r, [self.delta; 2]))
    }
}

impl<L: Lane> Stroboscopic<L, 3> for PrintedCapsule<L> {
    #[inline(always)]
    fn point(state: &State<L>) -> [L; 3] {
        [state.r, state.y1, state.y2]
    }

    #[inline(always)]
    fn state([r, y1, y2]: [L; 3]) -> State<L> {
        State::of([r, y1, L::splat(0.0), y2])
    }

    #[inline(always)]
    fn moved_to(from: State<L>, [r, y1, y2]: [L; 3]) -> State<L> {
        State { r, y1, y2, ..from }
    }
}

impl Field for PrintedCapsule<f64> {
    type Coordinates = [f64; 4];

    fn coordinates(state: &State<f64>) -> [f64; 4] {
        state.coordinates()
    }

    fn rates(&self, mode: &PrintedMode<f64>, time: f64, state: &State<f64>) -> State<f64> {
        let State { y1, y2, .. } = *state;
        let force = self.force(mode.closed, state);
        let acceleration = (self.drive.force(time) - force) / self.m1;
        if mode.slip == 0.0 {
            return State { r: y1, y1: acceleration, ..State::default() };
        }
        // The rate of y2 with H = 1.
        let full = (force - self.drag.force(mode.slip, y2)) / self.m2;
        let mut share = 1.0;
        if mode.is(Regime::Creeping) {
            // F' = k (y1 - H y2) + c (y1' - H y2') vanishes.
            let k = self.stiffness(mode.closed);
            share = (k * y1 + self.c * acceleration) / (k * y2 + self.c * full);
        }
        State::of([y1 - share * y2, acceleration, share * y2, share * full])
    }

    /// A displacement r or x2 counts as the velocity omega r.
    fn weights(&self) -> [f64; 4] {
        [self.drive.omega, 1.0, self.drive.omega, 1.0]
    }
}

impl<L: Lane> Locomotion<L> for PrintedCapsule<L> {
    #[inline(always)]
    fn jet<'a>(&self, jet: &'a PrintedJet<L>) -> &'a Jet<L> {
        &jet.motion
    }

    #[inline(always)]
    fn drive<'a>(&self, jet: &'a PrintedJet<L>) -> DriveSeries<'a, L> {
        DriveSeries {
            force: &jet.motion.cos,
            unit: self.drive.amplitude,
            rate: &jet.motion.y1,
            reacts: false,
        }
    }

    #[inline(always)]
    fn friction(&self, _mode: &PrintedMode<L>, jet: &PrintedJet<L>) -> Series<L> {
        // Whatever F does not spend on m2 y2' is friction, in every motion.
        let mut friction = series::derivative(&jet.motion.y2);
        for (term, force) in friction.iter_mut().zip(&jet.motion.force) {
            *term = *force - self.m2 * *term;
        }
        friction
    }

    #[inline(always)]
    fn slip_rate(&self, _mode: &PrintedMode<L>, jet: &PrintedJet<L>) -> Series<L> {
        series::derivative(&jet.motion.x2)
    }

    #[inline(always)]
    fn closed(&self, mode: &PrintedMode<L>) -> L::Mask {
        mode.closed
    }

    #[inline(always)]
    fn direction(&self, mode: &PrintedMode<L>) -> L {
        mode.slip
    }
}
