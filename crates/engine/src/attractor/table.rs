//! The table of the attractors at one set of parameters, and which of them each case has ended on.

use std::ops::Range;
use std::sync::Mutex;

use super::final_motion::FinalMotion;
use super::identity::Attractor;
use crate::flow::{Metric, Stroboscopic, System};
use crate::orbit::{OrbitOf, Outcome, Protocol};

/// So many cases at most are followed before they are sorted in turn, as there may be millions.
const TOGETHER: usize = 4096;
/// So many are at first, when no attractor is known, and each time as many times more.
const AT_FIRST: usize = 16;

/// Calls a function for each of many numbers, perhaps on several threads.
pub trait Executor: Sync {
    /// Calls `each` once for every number below `count`, in any order.
    fn each(&self, count: usize, each: &(dyn Fn(usize) + Sync));
}

/// One thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Serial;

impl Executor for Serial {
    fn each(&self, count: usize, each: &(dyn Fn(usize) + Sync)) {
        (0..count).for_each(each);
    }
}

/// The results of a function for every number of a range, in their order.
pub(super) fn results<T: Send>(
    executor: &dyn Executor,
    range: Range<usize>,
    function: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    let results: Vec<Mutex<Option<T>>> = range.clone().map(|_| Mutex::new(None)).collect();
    executor.each(results.len(), &|place| {
        let result = function(range.start + place);
        *results[place].lock().expect("no thread has panicked") = Some(result);
    });
    let results = results.into_iter().map(|it| it.into_inner().expect("no thread has panicked"));
    results.map(|it| it.expect("it was called for each")).collect()
}

/// The attractors at one set of parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Table<P> {
    /// The attractor of each case, by its place in the list below; none where the case has none.
    pub of_case: Vec<Option<u32>>,
    /// The attractors in the order in which the cases show them.
    pub attractors: Vec<Attractor<P>>,
    /// Their places in the order of their numbers, which does not depend on the order of the cases.
    ///
    /// First periodic orbits, then quasi-periodic and chaotic motions; orbits by their periods; then by the coordinates of a
    /// point, of an orbit its [`Attractor::least_point`], of another motion the mean of its sample, rounded to a millionth of
    /// the largest of these motions.
    pub order: Vec<usize>,
}

/// To this share of the largest motion marks of attractors are rounded before they are compared.
const ROUNDED: f64 = 1e-6;

impl<P> Default for Table<P> {
    fn default() -> Self {
        Table { of_case: Vec::new(), attractors: Vec::new(), order: Vec::new() }
    }
}

impl<P> Table<P> {
    /// The periods of the attractors that repeat, together [cycles].
    pub fn cycles(&self) -> usize {
        let periodic = self.attractors.iter().filter(|it| it.outcome == Outcome::Periodic);
        periodic.map(|it| it.points.len()).sum()
    }

    /// The same with section points held in another way.
    pub fn map<Q>(self, held: impl Fn(P) -> Q + Copy) -> Table<Q> {
        let Table { of_case, attractors, order } = self;
        let attractors = attractors.into_iter().map(|it| it.map(held)).collect();
        Table { of_case, attractors, order }
    }
}

impl<const D: usize> Table<[f64; D]> {
    /// Sorts so many cases of a `system` by attractor: `motion` tells the index and the motion of each.
    ///
    /// The executor follows many cases at a time and compares each with the attractors that are known by
    /// then; what is new is sorted in turn. A case belongs to the first attractor that it matches by the fewest points.
    /// How many cases are followed at a time does not depend on the executor.
    pub fn sort<M: System<D>>(
        cases: usize,
        motion: impl Fn(usize) -> (usize, Option<FinalMotion<[f64; D]>>) + Sync,
        system: &M,
        protocol: &Protocol,
        executor: &dyn Executor,
    ) -> Self {
        let mut table = Table { of_case: Vec::with_capacity(cases), ..Table::default() };
        table.extend(cases, motion, system, protocol, executor);
        table.order = table.ordered(&system.metric());
        for attractor in &mut table.attractors {
            if attractor.outcome != Outcome::Periodic {
                attractor.points = Vec::new();
            }
        }
        table
    }

    /// Sorts so many more cases, which follow those that are sorted already; the order of the attractors is not told.
    pub fn extend<M: System<D>>(
        &mut self,
        cases: usize,
        motion: impl Fn(usize) -> (usize, Option<FinalMotion<[f64; D]>>) + Sync,
        system: &M,
        protocol: &Protocol,
        executor: &dyn Executor,
    ) {
        let (mut first, mut together) = (0, AT_FIRST);
        while first < cases {
            let last = cases.min(first + together);
            let met = results(executor, first..last, |place| {
                let (index, motion) = motion(place);
                let mut found = Attractor::of(index, system, &motion?, protocol)?;
                let known = self.place(&mut found, system, protocol);
                found.shorten();
                Some(known.ok_or(found))
            });
            for met in met {
                let place =
                    met.map(|met| met.unwrap_or_else(|new| self.add(new, system, protocol)));
                self.of_case.push(place.map(|place| place as u32));
            }
            (first, together) = (last, TOGETHER.min(AT_FIRST * together));
        }
    }

    /// The places of the attractors in the order of their numbers.
    fn ordered(&self, metric: &Metric<D>) -> Vec<usize> {
        let size = self.attractors.iter().map(|it| it.size).fold(0.0, f64::max);
        let mut order: Vec<usize> = (0..self.attractors.len()).collect();
        order.sort_by_cached_key(|place| {
            let it = &self.attractors[*place];
            let kind = match it.outcome {
                Outcome::Periodic => 0,
                Outcome::QuasiPeriodic => 1,
                _ => 2,
            };
            let period = if kind == 0 { it.points.len() } else { 0 };
            (kind, period, metric.rounded(&it.mark(metric), ROUNDED * size))
        });
        order
    }

    /// The place of an attractor, if it is known by the points that the known ones have.
    fn place<M: System<D>>(
        &self,
        found: &mut Attractor<[f64; D]>,
        system: &M,
        protocol: &Protocol,
    ) -> Option<usize> {
        let (metric, outcome) = (system.metric(), found.outcome);
        (0..found.comparisons()).find_map(|comparison| {
            let compared =
                self.attractors.iter().enumerate().filter(|(_, known)| {
                    known.outcome == outcome && known.has_points_for(comparison)
                });
            let mut compared = compared.peekable();
            compared.peek()?;
            found.follow_for(comparison, system, protocol);
            let known = compared.find(|(_, known)| known.is(found, &metric));
            known.map(|(place, _)| place)
        })
    }

    /// The place of an attractor, which is added if it is not known; the known ones are followed as far as it takes.
    fn add<M: System<D>>(
        &mut self,
        mut found: Attractor<[f64; D]>,
        system: &M,
        protocol: &Protocol,
    ) -> usize {
        for comparison in 0..found.comparisons() {
            for known in self.attractors.iter_mut().filter(|it| it.outcome == found.outcome) {
                known.follow_for(comparison, system, protocol);
            }
            if let Some(place) = self.place(&mut found, system, protocol) {
                return place;
            }
        }
        found.shorten();
        self.attractors.push(found);
        self.attractors.len() - 1
    }
}

/// The attractors that cases of one system have settled to, which may differ in their starts only.
pub fn attractors_of<M: System<D>, const D: usize>(
    system: &M,
    orbits: &[OrbitOf<M, D>],
    protocol: &Protocol,
) -> Table<[f64; D]> {
    let motions = orbits.iter().map(|it| FinalMotion::of(it, M::Single::point(&it.end)));
    let motions: Vec<_> = motions.collect();
    Table::sort(orbits.len(), |place| (place, Some(motions[place])), system, protocol, &Serial)
}
