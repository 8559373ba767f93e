//! The section points of many cases after a number of cycles that are waited, without derivatives: as a bifurcation
//! diagram needs them where nothing is to be proven, and as the proof of a neighbourhood does.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::flow::{Event, Motion, Reason, Stroboscopic, System};
use crate::lane::{Instructions, Lane, SideBySide, Work};

use super::lanes::{EndedCycle, Lanes, Task};
use super::occupancy::Kernel;
use super::passage::{PlainRequest, PlainReturn, PlainReturns};
use super::{Case, Machine};

/// The last section points of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Returns<const D: usize> {
    /// As many as were to be kept, or fewer where the motion could not be followed so far.
    pub points: Vec<[f64; D]>,
    /// Why it could not, if so.
    pub failure: Option<Reason>,
}

/// Follows each of the cases, which are alike ([`System::is_alike`]), for so many cycles and keeps the section
/// points of so many more; in the order of the cases.
///
/// Guarantees: the points of a case have the same bits on any number of threads and by any instructions.
///
/// # Panics
/// Where two cases are not alike, or the processor does not have the instructions that `machine` asks for.
pub fn returns<M: System<D>, const D: usize>(
    cases: &[Case<M, D>],
    (waited, kept): (u64, usize),
    tolerance: f64,
    machine: Machine,
) -> Vec<Returns<D>> {
    let nothing = Returns { points: Vec::new(), failure: None };
    let (taken, found) = (AtomicUsize::new(0), Mutex::new(vec![nothing; cases.len()]));
    let waited = &vec![waited as usize; cases.len()];
    machine.share_out(cases.len(), |share, instructions| {
        let events = false;
        let wanted = WantedReturns { cases, taken: &taken, share, waited, kept, events, tolerance };
        let own = instructions.run(wanted);
        let mut found = found.lock().expect("no thread has panicked");
        for (index, returns, _) in own {
            found[index] = returns;
        }
    });
    found.into_inner().expect("no thread has panicked")
}

/// The returns of each request of systems that are alike ([`System::is_alike`]), none where a motion cannot be followed
/// so far; as many motions at a time as there are lanes, whichever request they are of.
///
/// Guarantees: the same bits by any instructions, and whatever the other requests.
///
/// # Panics
/// Where two systems are not alike or two tolerances differ, or the processor does not have the instructions.
pub fn plain_returns<M: System<D>, const D: usize>(
    instructions: Instructions,
    requests: &[PlainRequest<M, D>],
) -> Vec<PlainReturns<M::Event, D>> {
    let Some(tolerance) = requests.first().map(|it| it.cycles.tolerance) else {
        return Vec::new();
    };
    let (mut cases, mut waited) = (Vec::new(), Vec::new());
    for PlainRequest { system, points, cycles } in requests {
        assert_eq!(cycles.tolerance, tolerance, "one tolerance serves all lanes");
        let case = |point: &[f64; D]| Case::new(system.clone(), M::Single::state(*point));
        cases.extend(points.iter().map(case));
        waited.resize(cases.len(), cycles.count.saturating_sub(1) as usize);
    }
    let (taken, share, kept, events) = (AtomicUsize::new(0), usize::MAX, 1, true);
    let (cases, waited) = (&cases, &waited);
    let wanted = WantedReturns { cases, taken: &taken, share, waited, kept, events, tolerance };
    let mut found: PlainReturns<M::Event, D> = cases.iter().map(|_| None).collect();
    for (index, returns, events) in instructions.run(wanted) {
        let end = returns.points.last().filter(|_| returns.failure.is_none());
        found[index] = end.map(|end| PlainReturn { end: *end, events });
    }
    let mut found = found.into_iter();
    requests.iter().map(|it| found.by_ref().take(it.points.len()).collect()).collect()
}

/// The cases, and how many of them any thread has taken.
struct WantedReturns<'a, M: System<D>, const D: usize> {
    cases: &'a [Case<M, D>],
    taken: &'a AtomicUsize,
    /// Lanes that are filled at the beginning, so that a few cases are not all with one thread.
    share: usize,
    /// Cycles that each case is followed before its points are kept.
    waited: &'a [usize],
    kept: usize,
    /// Whether events are noted.
    events: bool,
    tolerance: f64,
}

/// A case in a lane, and what has been noted of it.
struct CaseInLane<E, const D: usize> {
    index: usize,
    cycles: usize,
    points: Vec<[f64; D]>,
    events: Vec<E>,
}

/// The index of a case, its section points, and its events where they are noted.
type Told<E, const D: usize> = (usize, Returns<D>, Vec<E>);

impl<E, const D: usize> CaseInLane<E, D> {
    fn tell(self, failure: Option<Reason>) -> Told<E, D> {
        (self.index, Returns { points: self.points, failure }, self.events)
    }
}

impl<M: System<D>, const D: usize> Work for WantedReturns<'_, M, D> {
    const IS_INTERPRETED: bool = M::IS_INTERPRETED;
    type Output = Vec<Told<M::Event, D>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        let Some(first) = self.cases.first() else { return Vec::new() };
        let system = first.system.single();
        let motion = Motion::<L, M::In<L>>::splat(&Motion::new(&system, 0.0, first.start));
        let mut lanes = Lanes::new(M::In::<L>::splat(&system), motion, self.tolerance);
        let mut task = Following { wanted: self, done: Vec::new() };
        lanes.follow(&mut task);
        task.done
    }
}

/// Follows the cases, and tells what is noted of those that are done.
struct Following<'a, M: System<D>, const D: usize> {
    wanted: WantedReturns<'a, M, D>,
    done: Vec<Told<M::Event, D>>,
}

impl<M: System<D>, const D: usize> Following<'_, M, D> {
    /// The next case.
    fn next(&self) -> Option<(usize, &Case<M, D>)> {
        let WantedReturns { cases, taken, .. } = self.wanted;
        if taken.load(Ordering::Relaxed) >= cases.len() {
            return None;
        }
        let index = taken.fetch_add(1, Ordering::Relaxed);
        Some((index, cases.get(index)?))
    }
}

impl<L: Lane, M: System<D>, const D: usize> Task<L, M, D> for Following<'_, M, D> {
    type Kept = CaseInLane<M::Event, D>;
    const KERNEL: Kernel = Kernel::PlainReturns;

    #[inline(always)]
    fn fill(&mut self, lanes: &mut Lanes<L, M, Self::Kept, D>) -> bool {
        while lanes.count() < self.wanted.share
            && let Some(lane) = lanes.free().next()
            && let Some((index, case)) = self.next()
        {
            let alike = case.system.is_alike(&self.wanted.cases[0].system);
            assert!(alike, "cases side by side are alike");
            let system = case.system.single();
            let motion = Motion::new(&system, case.begins, case.start);
            let (points, events) = (Vec::new(), Vec::new());
            lanes.put(lane, &system, &motion, CaseInLane { index, cycles: 0, points, events });
        }
        lanes.count() > 0
    }

    #[inline(always)]
    fn see(&mut self, lanes: &mut Lanes<L, M, Self::Kept, D>) {
        if !self.wanted.events {
            return;
        }
        for (lane, own) in lanes.kept.iter_mut().enumerate() {
            let event = M::Event::from_code(lanes.step.event.lane(lane));
            if let Some(own) = own {
                own.events.extend(event.filter(|it| !it.is_timed()));
            }
        }
    }

    #[inline(always)]
    fn end_cycle(
        &mut self,
        lanes: &mut Lanes<L, M, Self::Kept, D>,
        lane: usize,
        _cycle: EndedCycle,
    ) {
        let Some(own) = &mut lanes.kept[lane] else { return };
        own.cycles += 1;
        let waited = self.wanted.waited[own.index];
        if own.cycles > waited {
            own.points.push(M::Single::point(&lanes.motion.state.lane(lane)));
        }
        if own.cycles >= waited + self.wanted.kept {
            self.done.push(lanes.take(lane).tell(None));
        }
    }

    #[inline(always)]
    fn give_up(&mut self, lanes: &mut Lanes<L, M, Self::Kept, D>, lane: usize) {
        let why = lanes.breakdown(lane).map_or(Reason::TooManySteps, Reason::from);
        self.done.push(lanes.take(lane).tell(Some(why)));
    }
}
