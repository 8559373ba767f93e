//! The capsule without the bound on its steps: a system that breaks the contract, for the checks to find.

use capsulemap_engine::flow::{Field, Metric, Stroboscopic, Switched, Zeros};
use capsulemap_engine::lane::{Lane, Series, SideBySide};
use capsulemap_models::capsule::{
    Capsule, CapsuleParameters, DriveSeries, EventKind, Jet, Locomotion, Parameter, Parameters,
    Reading, Shape, State, filippov,
};

/// A capsule whose steps are paced by its series alone, so that they can jump over the layer around rest.
#[derive(Debug, Clone, Copy)]
pub struct Unbounded<L>(Capsule<L>);

impl Unbounded<f64> {
    /// One capsule whose drive starts at `phase` [rad].
    pub fn single(parameters: &Parameters, phase: f64) -> Self {
        Unbounded(Capsule::single(parameters, phase))
    }
}

impl<L: Lane> SideBySide for Unbounded<L> {
    type One = Unbounded<f64>;

    fn splat(one: &Unbounded<f64>) -> Self {
        Unbounded(Capsule::splat(&one.0))
    }

    fn lane(&self, index: usize) -> Unbounded<f64> {
        Unbounded(self.0.lane(index))
    }

    fn put(&mut self, index: usize, one: &Unbounded<f64>) {
        self.0.put(index, &one.0);
    }

    fn take_lane(&mut self, index: usize, other: &Self) {
        self.0.take_lane(index, &other.0);
    }
}

impl<L: Lane> Switched<L> for Unbounded<L> {
    type State = State<L>;
    type Mode = <Capsule<L> as Switched<L>>::Mode;
    type Jet = Jet<L>;
    type Event = EventKind;

    const GUARDS: usize = <Capsule<L> as Switched<L>>::GUARDS;

    fn period(&self) -> L {
        self.0.period()
    }

    fn start(&self, time: L, state: &mut State<L>) -> Self::Mode {
        self.0.start(time, state)
    }

    fn expand(&self, mode: &Self::Mode, time: L, state: &State<L>, jet: &mut Jet<L>) {
        self.0.expand(mode, time, state, jet);
    }

    fn pace<'a>(&self, jet: &'a Jet<L>) -> [&'a Series<L>; 2] {
        self.0.pace(jet)
    }

    fn watched(&self, which: usize, mode: &Self::Mode) -> L::Mask {
        self.0.watched(which, mode)
    }

    fn guard(&self, which: usize, mode: &Self::Mode, jet: &Jet<L>, guard: &mut Series<L>) {
        self.0.guard(which, mode, jet, guard);
    }

    fn at(&self, jet: &Jet<L>, h: L) -> State<L> {
        self.0.at(jet, h)
    }

    fn motion(&self, jet: &Jet<L>, h: L) -> (State<L>, State<L>) {
        jet.motion(h)
    }

    fn layered<'a>(&self, mode: &Self::Mode, jet: &'a Jet<L>) -> Option<(&'a Series<L>, L::Mask)> {
        self.0.layered(mode, jet)
    }

    fn switch(
        &self,
        which: usize,
        due: L::Mask,
        mode: &mut Self::Mode,
        state: &mut State<L>,
        zeros: &mut Zeros<L>,
        time: L,
    ) -> L {
        self.0.switch(which, due, mode, state, zeros, time)
    }

    fn lost(&self, state: &State<L>) -> L::Mask {
        self.0.lost(state)
    }
}

impl<L: Lane> Stroboscopic<L, 3> for Unbounded<L> {
    fn point(state: &State<L>) -> [L; 3] {
        Capsule::point(state)
    }

    fn state(point: [L; 3]) -> State<L> {
        Capsule::state(point)
    }

    fn moved_to(from: State<L>, point: [L; 3]) -> State<L> {
        Capsule::moved_to(from, point)
    }
}

impl Field for Unbounded<f64> {
    type Coordinates = [f64; 4];

    fn coordinates(state: &State<f64>) -> [f64; 4] {
        state.coordinates()
    }

    fn rates(&self, mode: &Self::Mode, time: f64, state: &State<f64>) -> State<f64> {
        self.0.rates(mode, time, state)
    }

    fn weights(&self) -> [f64; 4] {
        self.0.weights()
    }
}

/// The reading that moves a capsule so.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Blind;

impl Reading for Blind {
    type Mode<L: Lane> = filippov::Mode<L>;
    type Single = Unbounded<f64>;
    type In<L: Lane> = Unbounded<L>;

    fn metric(parameters: &Parameters) -> Metric<3> {
        CapsuleParameters::metric(parameters)
    }

    fn single(parameters: &Parameters, phase: f64) -> Unbounded<f64> {
        Unbounded::single(parameters, phase)
    }

    fn capsule<L: Lane>(of: impl Fn(Parameter) -> L, shape: Shape, phase: f64) -> Unbounded<L> {
        Unbounded(Capsule::new(of, shape, phase))
    }
}

impl<L: Lane> Locomotion<L> for Unbounded<L> {
    fn jet<'a>(&self, jet: &'a Jet<L>) -> &'a Jet<L> {
        jet
    }

    fn drive<'a>(&self, jet: &'a Jet<L>) -> DriveSeries<'a, L> {
        self.0.drive(jet)
    }

    fn friction(&self, mode: &Self::Mode, jet: &Jet<L>) -> Series<L> {
        self.0.friction(mode, jet)
    }

    fn slip_rate(&self, mode: &Self::Mode, jet: &Jet<L>) -> Series<L> {
        self.0.slip_rate(mode, jet)
    }

    fn closed(&self, mode: &Self::Mode) -> L::Mask {
        self.0.closed(mode)
    }

    fn direction(&self, mode: &Self::Mode) -> L {
        self.0.direction(mode)
    }
}
