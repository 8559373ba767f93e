//! Cases of a queue in lanes.

use std::collections::BTreeMap;
use std::sync::Arc;

use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{
    self, KnownOrbits, OrbitOf, Protocol, Queue, Underway, settle_side_by_side,
};

use crate::capsule::{CapsuleSystem, Case, Orbit, Reading};
use crate::model::{CaseQueue, Unfinished};

/// Orbits that are known of the setting of all cases.
type Known<R> = Arc<KnownOrbits<CapsuleSystem<R>, 3>>;

/// Settles the cases of a queue, see [`settle_queue`](crate::model::Model::settle_queue).
pub(super) fn settle<R: Reading>(
    instructions: Instructions,
    protocol: &Protocol,
    known: Option<Known<R>>,
    queue: &mut dyn CaseQueue,
) -> Vec<Box<dyn Unfinished>> {
    let mut filled = Filled::<R> { queue, protocol, known, cases: BTreeMap::new() };
    let left = settle_side_by_side::<CapsuleSystem<R>, 3>(instructions, protocol, &mut filled);
    let part = |underway: Underway<CapsuleSystem<R>, 3>| -> Box<dyn Unfinished> {
        let case = filled.taken(underway.number());
        Box::new(Left::<R> { underway, case })
    };
    left.into_iter().map(part).collect()
}

/// A queue with the cases of it that are in lanes, by their numbers.
struct Filled<'a, R: Reading> {
    queue: &'a mut dyn CaseQueue,
    protocol: &'a Protocol,
    known: Option<Known<R>>,
    cases: BTreeMap<usize, Case>,
}

impl<R: Reading> Filled<'_, R> {
    /// The case of a number, which is in no lane any more.
    fn taken(&mut self, number: usize) -> Case {
        self.cases.remove(&number).expect("the case was in a lane")
    }
}

impl<R: Reading> Queue<CapsuleSystem<R>, 3> for Filled<'_, R> {
    fn next(
        &mut self,
        done: Option<(usize, OrbitOf<CapsuleSystem<R>, 3>)>,
    ) -> Option<(usize, orbit::Case<CapsuleSystem<R>, 3>)> {
        let done = done.map(|(number, orbit)| {
            let case = self.taken(number);
            (number, Orbit::of::<R>(orbit, &case, self.protocol))
        });
        let (number, case) = self.queue.next(done)?;
        let read = case.read();
        self.cases.insert(number, case);
        Some((number, read))
    }

    fn known(&self) -> Option<Known<R>> {
        self.known.clone()
    }
}

/// A case that has left its lane unfinished.
struct Left<R: Reading> {
    underway: Underway<CapsuleSystem<R>, 3>,
    case: Case,
}

impl<R: Reading> Unfinished for Left<R> {
    fn number(&self) -> usize {
        self.underway.number()
    }

    fn finish(self: Box<Self>, protocol: &Protocol) -> Orbit {
        let Left { underway, case } = *self;
        let (_, orbit) = underway.finish(protocol);
        Orbit::of::<R>(orbit, &case, protocol)
    }
}
