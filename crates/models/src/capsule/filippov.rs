//! The vibro-impact capsule, its friction read in Filippov's sense.

use capsulemap_engine::flow::{Event, Field, Stroboscopic, Switched, Zeros};
use capsulemap_engine::lane::elementary::not_finite;
use capsulemap_engine::lane::{Lane, Mask, ORDER, Series, series, side_by_side};

use super::drag::Drag;
use super::drive::Drive;
use super::locomotion::{DriveSeries, Locomotion, direction};
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::shape::Shape;
use super::state::{EventKind, Jet, State};
use crate::description::Parameters;
use crate::motion::reduced;

/// Guard of the contact, `r - delta` while closed and `delta - r` while open.
const CONTACT: usize = 0;
/// Guard of sliding, the speed; at rest, how far F is below the break-away force.
const FORWARD: usize = 1;
/// At rest, how far F is above minus the break-away force.
const BACKWARD: usize = 2;

/// The capsule with one set of parameters per lane.
#[derive(Debug, Clone, Copy)]
pub struct Capsule<L> {
    k1: L,
    c: L,
    k2: L,
    delta: L,
    inverse_m1: L,
    inverse_m2: L,
    drive: Drive<L>,
    drag: Drag<L>,
}

side_by_side!(Capsule { k1, c, k2, delta, inverse_m1, inverse_m2 } with { drive, drag });

/// Which field acts in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Mode<L: Lane> {
    /// Whether the mass touches the stop.
    closed: L::Mask,
    /// Direction of sliding, +1 or -1; 0 at rest.
    slip: L,
}

side_by_side!(Mode { slip } masks { closed });

impl<L: Lane> Default for Mode<L> {
    fn default() -> Self {
        Mode { closed: L::Mask::splat(false), slip: L::splat(0.0) }
    }
}

impl Capsule<f64> {
    /// One capsule whose drive starts at `phase` [rad].
    pub fn single(parameters: &Parameters, phase: f64) -> Self {
        Capsule::new(|parameter| parameters[parameter], parameters.shape(), phase)
    }
}

impl<L: Lane> Capsule<L> {
    /// The capsule with these parameters and of this shape, whose drive starts at `phase` [rad].
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape, phase: f64) -> Self {
        Capsule {
            k1: of(Parameter::K1),
            c: of(Parameter::C),
            k2: of(Parameter::K2),
            delta: of(Parameter::Delta),
            inverse_m1: L::splat(1.0) / of(Parameter::M1),
            inverse_m2: L::splat(1.0) / of(Parameter::M2),
            drive: Drive::new(&of, shape, L::splat(reduced(phase))),
            drag: Drag::new(&of, shape.law),
        }
    }

    #[inline(always)]
    fn contact_stiffness(&self, mode: &Mode<L>) -> L {
        L::select(mode.closed, self.k2, L::splat(0.0))
    }

    /// The force of the mass on the capsule, F [N].
    #[inline(always)]
    fn force(&self, mode: &Mode<L>, state: &State<L>) -> L {
        let contact = self.contact_stiffness(mode) * (state.r - self.delta);
        self.k1 * state.r + contact + self.c * (state.y1 - state.y2)
    }

    /// Writes guard `which` in numbers of another kind, `of` those here.
    #[inline(always)]
    fn write_guard<G: Lane<Mask = L::Mask, Plain = L::Plain>>(
        &self,
        which: usize,
        mode: &Mode<L>,
        jet: &Jet<L>,
        of: impl Fn(L) -> G,
        guard: &mut Series<G>,
    ) {
        let (zero, one) = (L::Plain::splat(0.0), L::Plain::splat(1.0));
        if which == CONTACT {
            let side = L::Plain::select(mode.closed, one, -one);
            for (term, r) in guard.iter_mut().zip(&jet.r) {
                *term = of(*r).scaled(side);
            }
            guard[0] = (of(jet.r[0]) - of(self.delta)).scaled(side);
            return;
        }
        let side = if which == FORWARD { -one } else { one };
        let slip = mode.slip.plain();
        let resting = (slip * slip).lt(L::Plain::splat(0.5));
        let factor = L::Plain::select(resting, side, slip);
        for (term, (force, y2)) in guard.iter_mut().zip(jet.force.iter().zip(&jet.y2)) {
            *term = G::select(resting, of(*force), of(*y2)).scaled(factor);
        }
        guard[0] = guard[0] + G::select(resting, of(self.drag.break_away), G::from_plain(zero));
    }

    /// Closes or opens contact where `due`; returns the event there.
    #[inline(always)]
    fn switch_contact(
        &self,
        due: L::Mask,
        mode: &mut Mode<L>,
        state: &mut State<L>,
        zeros: &mut Zeros<L>,
    ) -> L {
        let code = L::select(
            mode.closed,
            EventKind::ContactOpened.code(),
            EventKind::ContactClosed.code(),
        );
        mode.closed = (mode.closed & !due) | (!mode.closed & due);
        state.r = L::select(due, self.delta, state.r);
        zeros[CONTACT] = L::select(due, L::splat(1.0), zeros[CONTACT]);
        L::select(due, code, L::splat(0.0))
    }
}

impl<L: Lane> Switched<L> for Capsule<L> {
    type State = State<L>;
    type Mode = Mode<L>;
    type Jet = Jet<L>;
    type Event = EventKind;

    const GUARDS: usize = 3;

    #[inline(always)]
    fn period(&self) -> L {
        self.drive.period()
    }

    fn start(&self, _time: L, state: &mut State<L>) -> Mode<L> {
        let zero = L::splat(0.0);
        let mut mode = Mode { closed: self.delta.lt(state.r), slip: zero };
        let force = self.force(&mode, state);
        let breaks_away = self.drag.break_away.lt(force.abs());
        let from_rest = L::select(breaks_away, direction(force), zero);
        mode.slip = L::select(state.y2.abs().le(zero), from_rest, direction(state.y2));
        let resting = (mode.slip * mode.slip).lt(L::splat(0.5));
        state.y2 = L::select(resting, zero, state.y2);
        mode
    }

    #[inline(always)]
    fn expand(&self, mode: &Mode<L>, time: L, state: &State<L>, jet: &mut Jet<L>) {
        let zero = L::splat(0.0);
        let stiffness = self.k1 + self.contact_stiffness(mode);
        let slides = zero.lt(mode.slip * mode.slip);
        let any_slides = slides.any();
        self.drive.cos(time, &mut jet.cos);
        (jet.r[0], jet.y1[0], jet.x2[0], jet.y2[0]) = (state.r, state.y1, state.x2, state.y2);
        jet.force[0] = self.force(mode, state);
        jet.decay[0] = if any_slides { self.drag.decay_start(mode.slip, state.y2) } else { zero };
        self.drag.write_exponent_term(mode.slip, jet, 0);
        for k in 0..ORDER {
            let per = L::Plain::splat(series::INVERSE[k + 1]);
            let relative = jet.y1[k] - jet.y2[k];
            if k > 0 {
                jet.force[k] = stiffness * jet.r[k] + self.c * relative;
            }
            let drive = self.drive.amplitude * jet.cos[k];
            jet.r[k + 1] = relative.scaled(per);
            jet.y1[k + 1] = ((drive - jet.force[k]) * self.inverse_m1).scaled(per);
            if any_slides {
                let friction = self.drag.force_term(mode.slip, &jet.decay, &jet.y2, k);
                let push = (jet.force[k] - friction) * self.inverse_m2;
                jet.acceleration[k] = L::select(slides, push, zero);
                jet.y2[k + 1] = jet.acceleration[k].scaled(per);
                jet.x2[k + 1] = jet.y2[k].scaled(per);
                self.drag.write_exponent_term(mode.slip, jet, k + 1);
                jet.decay[k + 1] = self.drag.decay_term(mode.slip, jet, k);
            } else {
                jet.acceleration[k] = zero;
                (jet.y2[k + 1], jet.x2[k + 1], jet.decay[k + 1]) = (zero, zero, zero);
            }
        }
        jet.force[ORDER] = stiffness * jet.r[ORDER] + self.c * (jet.y1[ORDER] - jet.y2[ORDER]);
    }

    #[inline(always)]
    fn pace<'a>(&self, jet: &'a Jet<L>) -> [&'a Series<L>; 2] {
        [&jet.y1, &jet.y2]
    }

    #[inline(always)]
    fn step_bound(
        &self,
        mode: &Mode<L>,
        jet: &Jet<L>,
        length: L::Plain,
        tolerance: f64,
    ) -> L::Plain {
        self.drag.step_bound(mode.slip, &jet.decay, &jet.y2, length, tolerance)
    }

    #[inline(always)]
    fn watched(&self, which: usize, mode: &Mode<L>) -> L::Mask {
        match which {
            BACKWARD => (mode.slip * mode.slip).lt(L::splat(0.5)),
            _ => L::Mask::splat(true),
        }
    }

    #[inline(always)]
    fn guard(&self, which: usize, mode: &Mode<L>, jet: &Jet<L>, guard: &mut Series<L>) {
        self.write_guard(which, mode, jet, |term| term, guard);
    }

    #[inline(always)]
    fn plain_guard(
        &self,
        which: usize,
        mode: &Mode<L>,
        jet: &Jet<L>,
        _room: &mut Series<L>,
        guard: &mut Series<L::Plain>,
    ) {
        self.write_guard(which, mode, jet, L::plain, guard);
    }

    #[inline(always)]
    fn at(&self, jet: &Jet<L>, h: L) -> State<L> {
        jet.state(h)
    }

    #[inline(always)]
    fn motion(&self, jet: &Jet<L>, h: L) -> (State<L>, State<L>) {
        jet.motion(h)
    }

    #[inline(always)]
    fn beginning(&self, jet: &Jet<L>) -> State<L> {
        jet.beginning()
    }

    #[inline(always)]
    fn layered<'a>(&self, mode: &Mode<L>, jet: &'a Jet<L>) -> Option<(&'a Series<L>, L::Mask)> {
        let slides = L::splat(0.0).lt(mode.slip * mode.slip);
        Some((&jet.y2, slides & self.drag.layer()?))
    }

    #[inline(always)]
    fn switch(
        &self,
        which: usize,
        due: L::Mask,
        mode: &mut Mode<L>,
        state: &mut State<L>,
        zeros: &mut Zeros<L>,
        _time: L,
    ) -> L {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        if which == CONTACT {
            return self.switch_contact(due, mode, state, zeros);
        }
        let side = if which == FORWARD { one } else { -one };
        let resting = (mode.slip * mode.slip).lt(L::splat(0.5));
        let (leaves, stops) = (due & resting, due & !resting);
        state.y2 = L::select(stops, zero, state.y2);
        // One stored force decides between rest and reversal; friction cannot push the capsule on in
        // the direction it was brought to rest from.
        let against = -(mode.slip * self.force(mode, state));
        let reverses = stops & self.drag.break_away.lt(against);
        let sticks = stops & !reverses;
        let onset = if which == FORWARD { EventKind::SlipForward } else { EventKind::SlipBackward };
        mode.slip = L::select(leaves, side, mode.slip);
        mode.slip = L::select(reverses, -mode.slip, L::select(sticks, zero, mode.slip));
        zeros[FORWARD] = L::select(
            leaves,
            self.drag.onset_zeros(),
            L::select(reverses, one, L::select(sticks, zero, zeros[FORWARD])),
        );
        let code = L::select(leaves, onset.code(), zero);
        let code = L::select(reverses, EventKind::Reversal.code(), code);
        L::select(sticks, EventKind::Stick.code(), code)
    }

    #[inline(always)]
    fn lost(&self, state: &State<L>) -> L::Mask {
        // Whatever goes wrong reaches the velocities through the forces.
        not_finite(state.y1 + state.y2)
    }

    #[inline(always)]
    fn touching<'a>(&self, jet: &'a Jet<L>) -> Option<(&'a Series<L>, [L; 2])> {
        Some((&jet.r, [self.delta; 2]))
    }
}

impl<L: Lane> Stroboscopic<L, 3> for Capsule<L> {
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

impl Field for Capsule<f64> {
    type Coordinates = [f64; 4];

    fn coordinates(state: &State<f64>) -> [f64; 4] {
        state.coordinates()
    }

    fn rates(&self, mode: &Mode<f64>, time: f64, state: &State<f64>) -> State<f64> {
        let State { y1, y2, .. } = *state;
        let force = self.force(mode, state);
        let acceleration = (self.drive.force(time) - force) * self.inverse_m1;
        if mode.slip == 0.0 {
            return State { r: y1, y1: acceleration, ..State::default() };
        }
        let push = force - self.drag.force(mode.slip, y2);
        State::of([y1 - y2, acceleration, y2, push * self.inverse_m2])
    }

    /// A displacement r or x2 counts as the velocity omega r.
    fn weights(&self) -> [f64; 4] {
        [self.drive.omega, 1.0, self.drive.omega, 1.0]
    }
}

impl<L: Lane> Locomotion<L> for Capsule<L> {
    #[inline(always)]
    fn jet<'a>(&self, jet: &'a Jet<L>) -> &'a Jet<L> {
        jet
    }

    #[inline(always)]
    fn drive<'a>(&self, jet: &'a Jet<L>) -> DriveSeries<'a, L> {
        DriveSeries { force: &jet.cos, unit: self.drive.amplitude, rate: &jet.y1, reacts: false }
    }

    #[inline(always)]
    fn friction(&self, mode: &Mode<L>, jet: &Jet<L>) -> Series<L> {
        let slides = L::splat(0.0).lt(mode.slip * mode.slip);
        let mut friction = jet.force;
        if slides.any() {
            for (k, term) in friction.iter_mut().enumerate() {
                let sliding = self.drag.force_term(mode.slip, &jet.decay, &jet.y2, k);
                *term = L::select(slides, sliding, *term);
            }
        }
        friction
    }

    #[inline(always)]
    fn slip_rate(&self, _mode: &Mode<L>, jet: &Jet<L>) -> Series<L> {
        jet.y2
    }

    #[inline(always)]
    fn closed(&self, mode: &Mode<L>) -> L::Mask {
        mode.closed
    }

    #[inline(always)]
    fn direction(&self, mode: &Mode<L>) -> L {
        mode.slip
    }
}
