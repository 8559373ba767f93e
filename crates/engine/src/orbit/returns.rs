//! The section points of many cases after a number of cycles that are waited, without derivatives: as a bifurcation
//! diagram needs them where nothing is to be proven, and as the proof of a neighbourhood does.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::flow::{Event, Motion, Reason, STEPS_PER_CYCLE, Step, Stroboscopic, Switched, System};
use crate::lane::{Instructions, Lane, Mask, SideBySide, Work};

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
        let crowd = Crowd { cases, taken: &taken, share, waited, kept, events, tolerance };
        let own = instructions.run(crowd);
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
    let crowd = Crowd { cases, taken: &taken, share, waited, kept, events, tolerance };
    let mut found: PlainReturns<M::Event, D> = cases.iter().map(|_| None).collect();
    for (index, returns, events) in instructions.run(crowd) {
        let end = returns.points.last().filter(|_| returns.failure.is_none());
        found[index] = end.map(|end| PlainReturn { end: *end, events });
    }
    let mut found = found.into_iter();
    requests.iter().map(|it| found.by_ref().take(it.points.len()).collect()).collect()
}

/// The cases, and how many of them any thread has taken.
struct Crowd<'a, M: System<D>, const D: usize> {
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

/// A case in a lane: its index, the cycles met, the steps of the next, and the points and events noted.
struct Occupant<E, const D: usize> {
    index: usize,
    cycles: usize,
    steps: u64,
    points: Vec<[f64; D]>,
    events: Vec<E>,
}

/// The index of a case, its section points, and its events where they are noted.
type Followed<E, const D: usize> = (usize, Returns<D>, Vec<E>);

impl<M: System<D>, const D: usize> Crowd<'_, M, D> {
    /// The next case.
    fn next(&self) -> Option<(usize, &Case<M, D>)> {
        let index = self.taken.fetch_add(1, Ordering::Relaxed);
        Some((index, self.cases.get(index)?))
    }
}

impl<M: System<D>, const D: usize> Work for Crowd<'_, M, D> {
    type Output = Vec<Followed<M::Event, D>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        let mut done = Vec::new();
        let Some(first) = self.cases.first() else { return done };
        let system = first.system.single();
        let mut motion = Motion::<L, M::In<L>>::splat(&Motion::new(&system, 0.0, first.start));
        let mut system = M::In::<L>::splat(&system);
        let mut lanes: Vec<Option<Occupant<M::Event, D>>> = (0..L::WIDTH).map(|_| None).collect();
        let refill = |lane: usize, system: &mut M::In<L>, motion: &mut Motion<L, M::In<L>>| {
            let (index, case) = self.next()?;
            assert!(case.system.is_alike(&first.system), "cases side by side are alike");
            let one = case.system.single();
            system.put(lane, &one);
            motion.put(lane, &Motion::new(&one, case.begins, case.start));
            let (points, events) = (Vec::new(), Vec::new());
            Some(Occupant { index, cycles: 0, steps: 0, points, events })
        };
        for (lane, occupant) in lanes.iter_mut().enumerate().take(self.share) {
            *occupant = refill(lane, &mut system, &mut motion);
        }
        let mut periods = system.period();
        let mut step = Step::default();
        while lanes.iter().any(Option::is_some) {
            motion.step(&system, periods, self.tolerance, &mut step);
            let broken = motion.broken(&system);
            let (arrived, broken) = (step.arrives.bits(), broken.bits());
            if step.arrives.any() {
                motion.begin_cycle(step.arrives);
            }
            for (lane, place) in lanes.iter_mut().enumerate() {
                let Some(occupant) = place else { continue };
                occupant.steps += 1;
                if self.events {
                    occupant.events.extend(M::Event::from_code(step.event.lane(lane)));
                }
                let slow = occupant.steps >= STEPS_PER_CYCLE;
                if broken >> lane & 1 != 0 || slow {
                    let why = motion.breakdown(&system, lane);
                    let failure = Some(why.map_or(Reason::TooManySteps, Reason::from));
                    let points = std::mem::take(&mut occupant.points);
                    done.push((occupant.index, Returns { points, failure }, Vec::new()));
                } else if arrived >> lane & 1 != 0 {
                    occupant.steps = 0;
                    occupant.cycles += 1;
                    let waited = self.waited[occupant.index];
                    if occupant.cycles > waited {
                        occupant.points.push(M::Single::point(&motion.state.lane(lane)));
                    }
                    if occupant.cycles < waited + self.kept {
                        continue;
                    }
                    let points = std::mem::take(&mut occupant.points);
                    let events = std::mem::take(&mut occupant.events);
                    done.push((occupant.index, Returns { points, failure: None }, events));
                } else {
                    continue;
                }
                *place = refill(lane, &mut system, &mut motion);
                periods = system.period();
            }
        }
        done
    }
}
