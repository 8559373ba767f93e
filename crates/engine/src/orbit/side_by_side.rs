//! Many cases side by side in the lanes of one thread, each lane refilled the moment its case settles.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::flow::{Motion, Stroboscopic, System};
use crate::lane::{Instructions, Lane, SideBySide, Work};

use super::aperiodic::follow_aperiodic;
use super::batch::Batch;
use super::case_end::End;
use super::known_orbits::KnownOrbits;
use super::lanes::{EndedCycle, Lanes, Task};
use super::measure::Found;
use super::occupancy::Kernel;
use super::passage::Integrator;
use super::settling::Settling;
use super::trajectory::Progress;
use super::underway::{Conclusion, Finding, Underway};
use super::{Case, OrbitOf, Protocol, Trajectory};

/// With no more than one lane in so many at work, cases are followed faster one by one.
const WORTHWHILE: usize = 4;
/// With no more than one lane in so many at work, half of the lanes are as fast.
const HALF: usize = 2;

/// So many times as many aperiodic cases as lanes are followed together, so that few lanes are empty while the last end.
const APERIODIC: usize = 12;
/// Cases that wait to be concluded for each lane of a vector, while all lanes are taken: among many are some of equal length.
const CONCLUDING: usize = 8;

/// Where cases come from and where they go when they have settled.
pub trait Queue<M: System<D>, const D: usize> {
    /// Takes the case of a number that has been `done`, if one has, and yields one to follow in its place.
    fn next(&mut self, done: Option<(usize, OrbitOf<M, D>)>) -> Option<(usize, Case<M, D>)>;
    /// The orbits of the system of all cases that are known before, if there are any.
    fn known(&self) -> Option<Arc<KnownOrbits<M, D>>> {
        None
    }
}

/// Settles the cases of `queue`, which are alike ([`System::is_alike`]), as many at a time as there are lanes,
/// until there are no more.
///
/// The orbits have the bits that [`super::settle`] gives, whatever the instructions. Returns the last few
/// cases unfinished, each to be finished by itself and on any thread.
pub fn settle_side_by_side<M: System<D>, const D: usize>(
    instructions: Instructions,
    protocol: &Protocol,
    queue: &mut dyn Queue<M, D>,
) -> Vec<Underway<M, D>> {
    let halves = instructions.lanes_of_a_vector() > 1;
    let least = if halves { HALF } else { WORTHWHILE };
    let left = Left { moving: Vec::new(), aperiodic: Vec::new(), queue };
    let mut left = instructions.run(Supply::new(instructions, protocol, left, least));
    if halves {
        let supply = Supply::new(instructions, protocol, left, WORTHWHILE);
        left = instructions.run_on_a_vector(supply);
    }
    left.moving.extend(left.aperiodic);
    left.moving
}

/// Cases that have not settled when too few lanes are taken.
struct Left<'a, M: System<D>, const D: usize> {
    moving: Vec<Underway<M, D>>,
    /// Those whose budget of cycles is at its end.
    aperiodic: Vec<Underway<M, D>>,
    queue: &'a mut dyn Queue<M, D>,
}

/// Where the lanes take their cases from.
struct Supply<'a, M: System<D>, const D: usize> {
    instructions: Instructions,
    protocol: &'a Protocol,
    // Not generic over the queue: the lanes are compiled once for each kind, which takes long.
    queue: &'a mut dyn Queue<M, D>,
    /// Cases that have not settled, gathered until there are enough to follow their linearised flow side by
    /// side.
    aperiodic: Vec<Underway<M, D>>,
    /// Cases that are being certified and measured.
    concluding: Batch<M, Conclusion<M, D>, D>,
    /// Cases that could depart, or go on, had they a lane; the first has waited longest, so that none waits for ever.
    ready: VecDeque<Underway<M, D>>,
    /// With no more than one lane in so many at work, the lanes are left.
    least: usize,
    /// A system that all are like.
    like: Option<M>,
    /// Whether a lane has become free, or a case ready, since there was none to put into a lane.
    asks: bool,
}

impl<'a, M: System<D>, const D: usize> Work for Supply<'a, M, D> {
    const IS_INTERPRETED: bool = M::IS_INTERPRETED;
    type Output = Left<'a, M, D>;

    #[inline(always)]
    fn run<L: Lane>(mut self) -> Self::Output {
        let Some(first) = self.next(None) else { return self.left(Vec::new()) };
        let system = M::In::<L>::splat(&first.system);
        let motion = Motion::<L, M::In<L>>::splat(&first.motion);
        let mut lanes = Lanes::new(system, motion, self.protocol.tolerance);
        self.ready.push_front(first);
        lanes.follow(&mut self);
        let moving = lanes.taken().map(|lane| taken_from(&mut lanes, lane)).collect();
        self.left(moving)
    }
}

/// Takes a case out of its lane as it is.
fn taken_from<L: Lane, M: System<D>, const D: usize>(
    lanes: &mut Lanes<L, M, Underway<M, D>, D>,
    lane: usize,
) -> Underway<M, D> {
    let (motion, steps) = (lanes.motion.lane(lane), lanes.steps(lane));
    let case = lanes.take(lane);
    let progress = Progress { steps, ..case.progress };
    Underway { motion, progress, ..case }
}

impl<'a, M: System<D>, const D: usize> Supply<'a, M, D> {
    /// Where cases that are left go on, and those of the queue begin.
    fn new(
        instructions: Instructions,
        protocol: &'a Protocol,
        left: Left<'a, M, D>,
        least: usize,
    ) -> Self {
        Supply {
            instructions,
            protocol,
            queue: left.queue,
            aperiodic: left.aperiodic,
            concluding: Batch::new(instructions),
            ready: left.moving.into(),
            least,
            like: None,
            asks: true,
        }
    }

    /// Whether it is worth to follow so many cases side by side.
    fn is_worthwhile<L: Lane>(&self, cases: usize) -> bool {
        cases * self.least > L::WIDTH
    }

    /// Puts cases into the free lanes, as far as there are any.
    #[inline(always)]
    fn fill_lanes<L: Lane>(&mut self, lanes: &mut Lanes<L, M, Underway<M, D>, D>) {
        while self.asks
            && let Some(lane) = lanes.free().next()
        {
            let Some(case) = self.next(None) else {
                self.asks = false;
                return;
            };
            let like = self.like.get_or_insert_with(|| case.case.system.clone());
            assert!(case.case.system.is_alike(like), "cases side by side are alike");
            // A case that goes on has taken some steps of its cycle, and of those that it may take.
            let Progress { steps, .. } = case.progress;
            let most = case.progress.deadline(self.protocol.max_steps) - steps;
            let (system, motion) = (case.case.system.single(), case.motion);
            lanes.put(lane, &system, &motion, case);
            lanes.has_taken(lane, steps);
            lanes.allow(lane, most);
        }
    }

    /// What is left, with the cases that are `moving`.
    fn left(self, mut moving: Vec<Underway<M, D>>) -> Left<'a, M, D> {
        moving.extend(self.ready);
        Left { moving, aperiodic: self.aperiodic, queue: self.queue }
    }

    fn next(&mut self, done: Option<(usize, OrbitOf<M, D>)>) -> Option<Underway<M, D>> {
        if done.is_none()
            && let Some(ready) = self.ready.pop_front()
        {
            return Some(ready);
        }
        let (number, case) = self.queue.next(done)?;
        Some(Underway::new(number, case, self.protocol, self.queue.known()))
    }

    /// Follows the cases that have not settled with their linearised flow, side by side, and concludes them.
    fn follow_aperiodic_cases(&mut self) {
        let cases = std::mem::take(&mut self.aperiodic);
        let max_steps = self.protocol.max_steps;
        let departures: Vec<_> = cases.iter().map(|it| it.departure(max_steps)).collect();
        let followed = follow_aperiodic(self.instructions, &departures, self.protocol);
        for (case, followed) in cases.into_iter().zip(followed) {
            self.conclude(case, move |trajectory, _| {
                let followed = followed.map(|it| End::Found(Found::Followed(it)));
                followed.map_err(|reason| trajectory.failure(reason))
            });
        }
    }

    /// Begins to certify and measure a case that is `found` to do something.
    fn conclude(
        &mut self,
        case: Underway<M, D>,
        found: impl FnOnce(&mut Trajectory<'_, M::Single, D>, &mut Settling<D>) -> Finding<M, D>
        + 'static,
    ) {
        let protocol = *self.protocol;
        // A computation has little room for what it begins with.
        let case = Box::new(case);
        let conclude =
            move |integrator: &dyn Integrator<M, D>| case.conclude(&protocol, found, integrator);
        self.asks = true;
        let done = self.concluding.begin(conclude);
        self.pass_on(done);
    }

    /// Goes on with cases that are being concluded, side by side.
    fn conclude_some(&mut self) {
        self.asks = true;
        let done = self.concluding.advance();
        self.pass_on(done);
    }

    /// Hands on cases that are done and takes those that follow them; others go on.
    fn pass_on(&mut self, concluded: impl IntoIterator<Item = Conclusion<M, D>>) {
        for conclusion in concluded {
            let next = match conclusion {
                Conclusion::Done(number, orbit) => self.next(Some((number, orbit))),
                Conclusion::GoesOn(case) => Some(*case),
            };
            self.ready.extend(next);
        }
    }
}

impl<L: Lane, M: System<D>, const D: usize> Task<L, M, D> for Supply<'_, M, D> {
    type Kept = Underway<M, D>;
    const KERNEL: Kernel = Kernel::Cases;

    /// Fills the lanes unless what waits is worth more; nothing is left to follow in lanes when too few would be taken.
    #[inline(always)]
    fn fill(&mut self, lanes: &mut Lanes<L, M, Self::Kept, D>) -> bool {
        loop {
            self.fill_lanes(lanes);
            let moving = self.is_worthwhile::<L>(lanes.count());
            // Lanes that stay empty wait for no more than it takes to fill a vector.
            let vector = self.instructions.lanes_of_a_vector();
            let all_taken = lanes.count() == L::WIDTH;
            let enough = if all_taken { CONCLUDING * vector } else { vector };
            let many = if all_taken { APERIODIC * L::WIDTH } else { L::WIDTH };
            let (aperiodic, concluding) = (self.aperiodic.len(), self.concluding.waiting());
            if aperiodic >= many || (!moving && self.is_worthwhile::<L>(aperiodic)) {
                self.follow_aperiodic_cases();
            } else if concluding >= enough || (!moving && concluding > 0) {
                self.conclude_some();
            } else {
                return moving;
            }
        }
    }

    /// Takes note of the section point that the case has reached.
    fn end_cycle(
        &mut self,
        lanes: &mut Lanes<L, M, Self::Kept, D>,
        lane: usize,
        cycle: EndedCycle,
    ) {
        let point = M::Single::point(&lanes.motion.state.lane(lane));
        let Some(case) = &mut lanes.kept[lane] else { return };
        case.progress.steps = cycle.steps;
        case.progress.count(cycle.duration);
        let exhausted = case.progress.cycles >= self.protocol.max_cycles;
        let end = End::of(case.settling.meet(point), exhausted);
        if let Some(end) = end {
            let case = taken_from(lanes, lane);
            self.conclude(case, move |_, _| Ok(end));
        } else if exhausted {
            self.aperiodic.push(taken_from(lanes, lane));
            self.asks = true;
        } else {
            let most = case.progress.deadline(self.protocol.max_steps);
            lanes.allow(lane, most);
        }
    }

    fn give_up(&mut self, lanes: &mut Lanes<L, M, Self::Kept, D>, lane: usize) {
        let case = taken_from(lanes, lane);
        self.conclude(case, |trajectory, _| Err(trajectory.stuck()));
    }
}
