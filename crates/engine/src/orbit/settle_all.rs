//! Many cases settled by one call, on all cores.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use crate::flow::System;

use super::case::{Case, OrbitOf};
use super::known_orbits::KnownOrbits;
use super::machine::Machine;
use super::protocol::Protocol;
use super::side_by_side::{Queue, settle_side_by_side};
use super::underway::Underway;

/// What each of the cases settles to, in their order.
///
/// Method: every thread fills its lanes from one list; the last cases, too few to fill a vector, are followed
/// one by one, by whichever thread is free. Cases that are not alike ([`System::is_alike`]) are settled
/// group after group. Guarantees: the bits of [`super::settle`], on any number of threads and by any
/// instructions. A case whose state or one of whose watched guards is no finite number is a record with its failure
/// ([`Reason::NotFinite`](crate::flow::Reason::NotFinite)), never a periodic motion.
///
/// # Panics
/// Where the processor does not have the instructions that `machine` asks for.
pub fn settle_all<M: System<D>, const D: usize>(
    cases: &[Case<M, D>],
    protocol: &Protocol,
    machine: Machine,
) -> Vec<OrbitOf<M, D>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (index, case) in cases.iter().enumerate() {
        let alike = |group: &&mut Vec<usize>| cases[group[0]].system.is_alike(&case.system);
        match groups.iter_mut().find(alike) {
            Some(group) => group.push(index),
            None => groups.push(vec![index]),
        }
    }
    let orbits = Mutex::new((0..cases.len()).map(|_| None).collect());
    for group in &groups {
        settle_group((cases, None), group, protocol, machine, &orbits);
    }
    all_of::<M, D>(orbits)
}

/// The same of cases of the one system whose orbits are known: each is followed no further than into a neighbourhood of one of
/// these.
pub fn settle_all_near<M: System<D>, const D: usize>(
    cases: &[Case<M, D>],
    known: &Arc<KnownOrbits<M, D>>,
    protocol: &Protocol,
    machine: Machine,
) -> Vec<OrbitOf<M, D>> {
    let group: Vec<usize> = (0..cases.len()).collect();
    let orbits = Mutex::new((0..cases.len()).map(|_| None).collect());
    settle_group((cases, Some(known)), &group, protocol, machine, &orbits);
    all_of::<M, D>(orbits)
}

fn all_of<M: System<D>, const D: usize>(orbits: Orbits<M, D>) -> Vec<OrbitOf<M, D>> {
    let orbits = orbits.into_inner().expect("no thread has panicked");
    orbits.into_iter().map(|orbit| orbit.expect("every case is settled")).collect()
}

/// The orbits of a list of cases, as far as they are known.
type Orbits<M, const D: usize> = Mutex<Vec<Option<OrbitOf<M, D>>>>;

fn settle_group<M: System<D>, const D: usize>(
    (cases, known): (&[Case<M, D>], Option<&Arc<KnownOrbits<M, D>>>),
    group: &[usize],
    protocol: &Protocol,
    machine: Machine,
    orbits: &Orbits<M, D>,
) {
    let (taken, last) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    machine.share_out(group.len(), |share, instructions| {
        let known = known.cloned();
        let mut list = List { cases, group, known, taken: &taken, left: share, orbits };
        let unfinished = settle_side_by_side(instructions, protocol, &mut list);
        let lock = || last.lock().expect("no thread has panicked");
        lock().extend(unfinished);
        loop {
            // In a statement of its own, so that the lock is free again.
            let case: Option<Underway<M, D>> = lock().pop();
            let Some(case) = case else { break };
            list.keep(case.finish(protocol));
        }
    });
}

/// A thread's view of the list.
struct List<'a, M: System<D>, const D: usize> {
    cases: &'a [Case<M, D>],
    group: &'a [usize],
    known: Option<Arc<KnownOrbits<M, D>>>,
    /// Cases that have been taken by any thread.
    taken: &'a AtomicUsize,
    /// Lanes that this thread may still fill at the beginning, so that a few cases are not all with one.
    left: usize,
    orbits: &'a Orbits<M, D>,
}

impl<M: System<D>, const D: usize> List<'_, M, D> {
    fn keep(&self, (index, orbit): (usize, OrbitOf<M, D>)) {
        self.orbits.lock().expect("no thread has panicked")[index] = Some(orbit);
    }
}

impl<M: System<D>, const D: usize> Queue<M, D> for List<'_, M, D> {
    fn next(&mut self, done: Option<(usize, OrbitOf<M, D>)>) -> Option<(usize, Case<M, D>)> {
        match done {
            Some(done) => self.keep(done),
            None => self.left = self.left.checked_sub(1)?,
        }
        let index = *self.group.get(self.taken.fetch_add(1, Ordering::Relaxed))?;
        Some((index, self.cases[index].clone()))
    }

    fn known(&self) -> Option<Arc<KnownOrbits<M, D>>> {
        self.known.clone()
    }
}
