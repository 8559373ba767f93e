//! The door to the engine: what the program may ask of a model, without type parameters.

use std::any::Any;
use std::fmt::{self, Debug, Formatter};
use std::sync::Arc;

use capsulemap_engine::attractor::{Attractor, Bridge, Executor, FinalMotion, Links, Met, Table};
use capsulemap_engine::branch::{Linearised, Segment};
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::matrix::Complex;
use capsulemap_engine::orbit::{Machine, Protocol};

use crate::capsule::{Case, EventKind, Orbit, Section, Sensitivity};
use crate::description::{Outputs, Parameter, Parameters};

/// What a motion depends on beside its start.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// The parameters.
    pub parameters: Parameters,
    /// Phase of the drive at the section [rad].
    pub phase: f64,
}

impl Setting {
    /// That of a case.
    pub fn of(case: &Case) -> Setting {
        Setting { parameters: case.parameters.clone(), phase: case.section_phase }
    }
}

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
    pub at: &'a (dyn Fn(usize) -> (usize, Option<FinalMotion<3>>) + Sync),
}

impl Debug for Motions<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Motions").field("count", &self.count).finish_non_exhaustive()
    }
}

/// What is held while one parameter varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Along {
    /// The phase, and the values of the other parameters.
    pub setting: Setting,
    /// The parameter that varies.
    pub parameter: Parameter,
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
    pub table: Arc<Table<3>>,
}

/// The attractors of a cell by place with their derivatives; none where they do not repeat.
pub type LinearOrbits = Vec<Option<Linearised<EventKind, 3>>>;

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
    pub cells: [Arc<Table<3>>; 2],
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
    pub linear: [Arc<LinearOrbits>; 2],
}

/// Which of some known attractors of one setting motions lead to.
pub trait Leads {
    /// The attractors that some section points lead to, by their numbers; none where it is no known one. Of those that do not
    /// repeat one is told only where it is the only one of its kind.
    fn of(&self, points: &[Section]) -> Vec<Option<u32>>;

    /// The attractor of a motion, told in the same manner.
    fn number(&self, motion: &FinalMotion<3>) -> Option<u32>;

    /// The saddle on a boundary between two section points that lead to different attractors, see
    /// [`EdgeSearch`](capsulemap_engine::attractor::EdgeSearch).
    fn saddle(&self, points: [Section; 2]) -> Option<Met<3>>;
}

/// A stable periodic orbit that is closed to rounding.
#[derive(Debug, Clone, PartialEq)]
pub struct StableOrbit {
    /// Its section point (SI).
    pub section: Section,
    /// Its multipliers, the largest magnitude first [-].
    pub multipliers: [Complex; 3],
    /// Its cyclic sequence of events.
    pub events: Vec<EventKind>,
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
    /// What a case settles to, followed by itself and no further than into a neighbourhood of a `known` orbit of its setting.
    fn settle(&self, case: &Case, protocol: &Protocol, known: Option<&Known>) -> Orbit;

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
        motion: &FinalMotion<3>,
        protocol: &Protocol,
    ) -> Option<Attractor<3>>;

    /// Sorts cases of one setting by attractor, see [`Table::sort`].
    fn table(
        &self,
        setting: &Setting,
        motions: Motions<'_>,
        protocol: &Protocol,
        executor: &dyn Executor,
    ) -> Table<3>;

    /// Sorts more cases of the setting of a table, see [`Table::extend`].
    fn extend_table(
        &self,
        table: &mut Table<3>,
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
    ) -> Vec<(usize, Links<3>)>;

    /// The attractors of a line of cells that no case of some cells shows, see [`bridges`](capsulemap_engine::attractor::bridges);
    /// `between` gives a cell and the next.
    fn bridges(
        &self,
        cells: &[Arc<Table<3>>],
        links: &[Links<3>],
        between: &(dyn Fn(usize) -> Option<Neighbours> + Sync),
        executor: &dyn Executor,
    ) -> Vec<Bridge<3>>;

    /// What tells to which of the attractors that are `known` by their numbers motions of a setting lead.
    fn leads<'a>(
        &self,
        setting: &Setting,
        protocol: &Protocol,
        machine: Machine,
        known: Vec<(u32, &'a Attractor<3>)>,
    ) -> Box<dyn Leads + 'a>;

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

    /// The segment of a branch from a periodic orbit, by the value of the parameter there and its section points, to another
    /// value; see [`segment`](capsulemap_engine::branch::segment).
    fn segment(&self, along: &Along, from: (f64, &[Section]), to: f64) -> Option<Segment<3>>;

    /// The outputs per cycle of batches of cycles from a section point on; none where it cannot be followed.
    fn batches(
        &self,
        setting: &Setting,
        from: Section,
        batches: Batches,
        tolerance: f64,
    ) -> Option<Vec<Outputs>>;
}
