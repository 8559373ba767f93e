//! Cases of a queue in lanes.

use std::collections::BTreeMap;
use std::sync::Arc;

use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{
    self, KnownOrbits, OrbitOf, Protocol, Queue, Underway, settle_side_by_side,
};

use crate::face::{Face, engine_case, orbit_of};
use crate::model::{CaseQueue, Unfinished};
use crate::motion::{Case, Orbit};

/// Orbits that are known of the setting of all cases.
type Known<M, const D: usize> = Arc<KnownOrbits<M, D>>;

/// Settles the cases of a queue, see [`settle_queue`](crate::model::Model::settle_queue).
pub(super) fn settle<M: Face<D>, const D: usize>(
    instructions: Instructions,
    protocol: &Protocol,
    known: Option<Known<M, D>>,
    queue: &mut dyn CaseQueue,
) -> Vec<Box<dyn Unfinished>> {
    let mut filled = Filled::<M, D> { queue, protocol, known, cases: BTreeMap::new() };
    let left = settle_side_by_side::<M, D>(instructions, protocol, &mut filled);
    let mut unfinished: Vec<Box<dyn Unfinished>> = Vec::new();
    for underway in left {
        let case = filled.taken(underway.number());
        unfinished.push(Box::new(Left::<M, D> { underway, case }));
    }
    unfinished
}

/// A queue with the cases of it that are in lanes, by their numbers.
struct Filled<'a, M: Face<D>, const D: usize> {
    queue: &'a mut dyn CaseQueue,
    protocol: &'a Protocol,
    known: Option<Known<M, D>>,
    cases: BTreeMap<usize, Case>,
}

impl<M: Face<D>, const D: usize> Filled<'_, M, D> {
    /// The case of a number, which is in no lane any more.
    fn taken(&mut self, number: usize) -> Case {
        self.cases.remove(&number).expect("the case was in a lane")
    }
}

impl<M: Face<D>, const D: usize> Queue<M, D> for Filled<'_, M, D> {
    fn next(&mut self, done: Option<(usize, OrbitOf<M, D>)>) -> Option<(usize, orbit::Case<M, D>)> {
        let done = done.map(|(number, orbit)| {
            let case = self.taken(number);
            (number, orbit_of::<M, D>(orbit, &case, self.protocol))
        });
        let (number, case) = self.queue.next(done)?;
        let read = engine_case(&case);
        self.cases.insert(number, case);
        Some((number, read))
    }

    fn known(&self) -> Option<Known<M, D>> {
        self.known.clone()
    }
}

/// A case that has left its lane unfinished.
struct Left<M: Face<D>, const D: usize> {
    underway: Underway<M, D>,
    case: Case,
}

impl<M: Face<D>, const D: usize> Unfinished for Left<M, D> {
    fn number(&self) -> usize {
        self.underway.number()
    }

    fn finish(self: Box<Self>, protocol: &Protocol) -> Orbit {
        let Left { underway, case } = *self;
        let (_, orbit) = underway.finish(protocol);
        orbit_of::<M, D>(orbit, &case, protocol)
    }
}
