//! The door to the engine: what the program may ask of a model, without type parameters.

use std::any::Any;
use std::fmt::{self, Debug, Formatter};
use std::sync::Arc;

use capsulemap_engine::attractor::{
    Attractor, Bridge, Executor, FinalMotion, Links, Manifolds, Met, Plane, Saddle, Table,
};
use capsulemap_engine::branch::{NotFollowed, Segment};
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::matrix::Complex;
use capsulemap_engine::orbit::{Machine, Protocol, Varied};

use crate::description::{Description, Outputs, Parameter, Parameters, Section};
use crate::motion::branch::{Found, Request};
pub use crate::motion::{
    Case, Failure, Orbit, Sensitivity, Setting, Simulation, SimulationSize, Stretch,
};

/// Orbits that are known of one setting before other cases are followed, with their neighbourhoods.
#[derive(Clone)]
pub struct Known(pub(crate) Arc<dyn Any + Send + Sync>);

impl Debug for Known {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Known").finish_non_exhaustive()
    }
}

/// The cases that a thread settles in its lanes.
pub trait CaseQueue {
    /// Takes what the case of a number has settled to, if one has, and yields a case with its number to follow in its place.
    fn next(&mut self, done: Option<(usize, Orbit)>) -> Option<(usize, Case)>;
}

/// A case that has left the lanes unfinished, as there were too few others.
pub trait Unfinished: Send {
    /// Its number in its queue.
    fn number(&self) -> usize;

    /// Follows it by itself, on any thread, until it settles.
    fn finish(self: Box<Self>, protocol: &Protocol) -> Orbit;
}

/// The final motions of some cases of one setting.
#[derive(Clone, Copy)]
pub struct Motions<'a> {
    /// How many there are.
    pub count: usize,
    /// The index of the case at a place and what it has settled to; none where it has not been computed.
    pub at: &'a (dyn Fn(usize) -> (usize, Option<FinalMotion<Section>>) + Sync),
}

impl Debug for Motions<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Motions").field("count", &self.count).finish_non_exhaustive()
    }
}

/// What is held while one parameter varies, or several in step.
#[derive(Debug, Clone, PartialEq)]
pub struct Along {
    /// The phase, and the values of the other parameters.
    pub setting: Setting,
    /// What varies; what is called the value of a parameter is the number of this.
    pub varied: Varied<Parameter>,
    /// Relative local error of a step of the integrator.
    pub tolerance: f64,
}

/// The attractors at one value of a parameter.
#[derive(Debug, Clone)]
pub struct Cell {
    /// What is held, and the parameter.
    pub along: Along,
    /// Its value.
    pub value: f64,
    /// The attractors.
    pub table: Arc<Table<Section>>,
}

/// The attractors of a cell by place with their derivatives.
#[derive(Clone)]
pub struct LinearOrbits(pub(crate) Arc<dyn Any + Send + Sync>);

impl Debug for LinearOrbits {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("LinearOrbits").finish_non_exhaustive()
    }
}

/// Two neighbouring cells along a parameter, see [`Neighbours`](capsulemap_engine::attractor::Neighbours) of the engine.
#[derive(Debug, Clone)]
pub struct Neighbours {
    /// What is held, and the parameter.
    pub along: Along,
    /// How closely orbits are computed.
    pub protocol: Protocol,
    /// The two values of the parameter.
    pub values: [f64; 2],
    /// The cells.
    pub cells: [Arc<Table<Section>>; 2],
    /// Pairs of places between which cases lead that inherit their start from the first cell, and from the second; none where no
    /// case does.
    pub inherited: [Option<Vec<[usize; 2]>>; 2],
}

/// Two neighbouring cells that are to be linked.
#[derive(Debug, Clone)]
pub struct Unlinked {
    /// The cells.
    pub neighbours: Neighbours,
    /// The attractors of each with their derivatives.
    pub linear: [LinearOrbits; 2],
}

/// Which of some known attractors of one setting motions lead to.
pub trait Leads {
    /// The attractors that some section points lead to, by their numbers; none where it is no known one. Of those that do not
    /// repeat one is told only where it is the only one of its kind.
    fn of(&self, points: &[Section]) -> Vec<Option<u32>>;

    /// The attractor of a motion, told in the same manner.
    fn number(&self, motion: &FinalMotion<Section>) -> Option<u32>;

    /// The saddle on a boundary between two section points that lead to different attractors, see
    /// [`EdgeSearch`](capsulemap_engine::attractor::EdgeSearch).
    fn saddle(&self, points: [Section; 2]) -> Option<Met<Section>>;

    /// The curves on which basins meet in a plane of starts, each of whose starts leads to one of the `attractors` by its number,
    /// the first side of the plane the slower, and the unstable manifolds of their saddles, of which some are known; see
    /// [`ManifoldSearch`](capsulemap_engine::attractor::ManifoldSearch).
    fn manifolds(
        &self,
        plane: &Plane<Section>,
        attractors: &[Option<u32>],
        known: &[Saddle<Section>],
    ) -> Manifolds<Section>;

    /// The size of the smallest disturbance at the points of an attractor that leads to another known one [units of the metric],
    /// sought first towards a section point; none where none is found, see
    /// [`minimal_critical_shock`](capsulemap_engine::attractor::minimal_critical_shock).
    fn shock(&self, number: u32, points: &[Section], towards: &Section) -> Option<f64>;
}

/// A stable periodic orbit that is closed to rounding.
#[derive(Debug, Clone, PartialEq)]
pub struct StableOrbit {
    /// Its section point (SI).
    pub section: Section,
    /// Its multipliers, the largest magnitude first [-].
    pub multipliers: Vec<Complex>,
    /// Its cyclic sequence of events, by their numbers.
    pub events: Vec<u8>,
    /// How many of them are impacts.
    pub impacts: usize,
}

/// Batches of cycles, the one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Batches {
    /// How many.
    pub count: u64,
    /// Cycles of each.
    pub cycles: u64,
}

/// A system with what a study may ask of it; the only door to the engine for the program.
///
/// What a case gives does not depend on the instructions, the threads or the cases beside it.
pub trait Model: Debug + Send + Sync {
    /// What it says of itself.
    fn description(&self) -> &'static Description;

    /// What does not fit together in what it says of itself, or between that and the system, each in a sentence.
    fn faults(&self) -> Vec<String>;

    /// What is to be said of an orbit beside its numbers, in sentences.
    fn remarks(&self, parameters: &Parameters, orbit: &Orbit) -> Vec<String>;

    /// What the coordinates of section points are multiplied by to be compared with each other.
    fn scales(&self, setting: &Setting) -> Section;

    /// What a case settles to, followed by itself and no further than into a neighbourhood of a `known` orbit of its setting.
    fn settle(&self, case: &Case, protocol: &Protocol, known: Option<&Known>) -> Orbit;

    /// What each of some cases settles to, in their order; see [`settle_all`](capsulemap_engine::orbit::settle_all).
    fn settle_all(&self, cases: &[Case], protocol: &Protocol, machine: Machine) -> Vec<Orbit>;

    /// Settles the cases of a queue by these instructions, as many side by side as there are lanes, until there are no more; returns
    /// the last few unfinished. All cases have the setting of the `known` orbits, if there are any.
    fn settle_queue(
        &self,
        instructions: Instructions,
        protocol: &Protocol,
        known: Option<&Known>,
        queue: &mut dyn CaseQueue,
    ) -> Vec<Box<dyn Unfinished>>;

    /// The orbits that a sample of cases of one setting settles to, with their neighbourhoods; none without a case.
    fn known_orbits(&self, sample: &[Case], protocol: &Protocol, machine: Machine)
    -> Option<Known>;

    /// The attractor that the case of this index has settled to, followed once more; none where it has none.
    fn attractor(
        &self,
        setting: &Setting,
        case: usize,
        motion: &FinalMotion<Section>,
        protocol: &Protocol,
    ) -> Option<Attractor<Section>>;

    /// The place of the section point of a periodic orbit at which it is told to begin, see [`Attractor::least_point`].
    fn least_point(&self, setting: &Setting, attractor: &Attractor<Section>) -> usize;

    /// Sorts cases of one setting by attractor, see [`Table::sort`].
    fn table(
        &self,
        setting: &Setting,
        motions: Motions<'_>,
        protocol: &Protocol,
        executor: &dyn Executor,
    ) -> Table<Section>;

    /// Sorts more cases of the setting of a table, see [`Table::extend`].
    fn extend_table(
        &self,
        table: &mut Table<Section>,
        setting: &Setting,
        motions: Motions<'_>,
        protocol: &Protocol,
        executor: &dyn Executor,
    );

    /// The attractors of the cells that `next` yields, each with its place, with their derivatives, computed side by side on this
    /// thread.
    fn linear_orbits(
        &self,
        instructions: Instructions,
        next: &mut dyn FnMut() -> Option<(usize, Cell)>,
    ) -> Vec<(usize, LinearOrbits)>;

    /// How the attractors go on between the neighbours that `next` yields, each with its place, computed side by side on this
    /// thread; calls `done` after each.
    fn links(
        &self,
        instructions: Instructions,
        next: &mut dyn FnMut() -> Option<(usize, Unlinked)>,
        done: &mut dyn FnMut(),
    ) -> Vec<(usize, Links<Section>)>;

    /// The attractors of a line of cells that no case of some cells shows, see [`bridges`](capsulemap_engine::attractor::bridges);
    /// `between` gives a cell and the next.
    fn bridges(
        &self,
        cells: &[Arc<Table<Section>>],
        links: &[Links<Section>],
        between: &(dyn Fn(usize) -> Option<Neighbours> + Sync),
        executor: &dyn Executor,
    ) -> Vec<Bridge<Section>>;

    /// What tells to which of the attractors that are `known` by their numbers motions of a setting lead.
    fn leads(
        &self,
        setting: &Setting,
        protocol: &Protocol,
        machine: Machine,
        known: &[(u32, &Attractor<Section>)],
    ) -> Box<dyn Leads>;

    /// Follows a case from its start to the first section, and for cycles from there, no further than to the last section before
    /// which it has no more events than `most` says. Times and sums are counted from the start.
    fn simulate(&self, case: &Case, most: SimulationSize, tolerance: f64) -> Simulation;

    /// The motion of a case from its start to the next section: both ends, at so many even times after the start, of which the end
    /// is the last, and at every event between.
    ///
    /// # Errors
    /// Where the motion cannot be followed.
    fn arc(&self, case: &Case, count: u32, tolerance: f64) -> Result<Stretch, Failure>;

    /// The section points of so many cycles from a point on, that among them; none where it cannot be followed.
    fn section_points(
        &self,
        setting: &Setting,
        from: Section,
        cycles: u64,
        tolerance: f64,
    ) -> Option<Vec<Section>>;

    /// The stable orbit of this period [cycles] near a section point, closed to rounding by Newton's method on the return map; none
    /// where there is none.
    fn stable_orbit(
        &self,
        setting: &Setting,
        guess: &Section,
        period: u64,
        tolerance: f64,
    ) -> Option<StableOrbit>;

    /// The outputs of the periodic orbit through a section point and their derivatives in a parameter, see
    /// [`sensitivity`](crate::capsule::sensitivity()).
    fn sensitivity(
        &self,
        setting: &Setting,
        section: &Section,
        period: u64,
        tolerance: f64,
        parameter: Parameter,
    ) -> Option<Sensitivity>;

    /// Follows a branch of periodic orbits both ways from the one that is given, and what leaves it.
    ///
    /// # Errors
    /// Where no periodic orbit is found near the point that is given, or none that a branch goes through.
    fn follow(&self, request: &Request) -> Result<Found, NotFollowed>;

    /// The segment of a branch from a periodic orbit, by the value of the parameter there and its section points, to another
    /// value; see [`segment`](capsulemap_engine::branch::segment).
    fn segment(&self, along: &Along, from: (f64, &[Section]), to: f64) -> Option<Segment<Section>>;

    /// The outputs per cycle of batches of cycles from a section point on; none where it cannot be followed.
    fn batches(
        &self,
        setting: &Setting,
        from: Section,
        batches: Batches,
        tolerance: f64,
    ) -> Option<Vec<Outputs>>;
}
