//! Many cases side by side in the lanes of one thread, each lane refilled the moment its case settles.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::flow::{Motion, STEPS_PER_CYCLE, Step, Stroboscopic, Switched, System};
use crate::lane::{Instructions, Lane, Mask, SideBySide, Work};

use super::aperiodic::follow_aperiodic_side_by_side;
use super::batch::Batch;
use super::case_end::End;
use super::known_orbits::KnownOrbits;
use super::measure::Found;
use super::passage::Integrator;
use super::settling::Settling;
use super::trajectory::Progress;
use super::underway::{Conclusion, Finding, Underway};
use super::{Case, OrbitOf, Protocol, Trajectory};

/// With no more than one lane in so many at work, cases are followed faster one by one.
const WORTHWHILE: usize = 4;
/// With no more than one lane in so many at work, half of the lanes are as fast.
const HALF: usize = 2;

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
    let supply = Supply {
        instructions,
        protocol,
        queue,
        aperiodic: Vec::new(),
        concluding: Batch::new(instructions),
        ready: VecDeque::new(),
        least,
    };
    let mut left = instructions.run(supply);
    if halves {
        let Left { moving, aperiodic, queue } = left;
        let (concluding, least, ready) = (Batch::new(instructions), WORTHWHILE, moving.into());
        let supply = Supply { instructions, protocol, queue, aperiodic, concluding, ready, least };
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
}

impl<'a, M: System<D>, const D: usize> Work for Supply<'a, M, D> {
    type Output = Left<'a, M, D>;

    #[inline(always)]
    fn run<L: Lane>(mut self) -> Self::Output {
        let cases: Vec<_> = (0..L::WIDTH).map(|_| self.next(None)).collect();
        let Some(first) = cases.iter().flatten().next() else {
            return self.left(Vec::new());
        };
        let spare = Underway::new(0, first.case.clone(), self.protocol, None);
        let mut lanes = Lanes::<L, M, D>::new(spare, self);
        for (lane, case) in cases.into_iter().enumerate() {
            lanes.fill_lane(lane, case);
        }
        let mut step = Step::default();
        let least = lanes.cases.least;
        loop {
            let worthwhile = |cases: usize| cases * least > L::WIDTH;
            let occupied = lanes.occupied.count_ones() as usize;
            let (aperiodic, concluding) =
                (lanes.cases.aperiodic.len(), lanes.cases.concluding.waiting());
            let moving = worthwhile(occupied);
            // Of twice as many as a vector holds some are alike long; lanes that stay empty do not wait for them.
            let vector = lanes.cases.instructions.lanes_of_a_vector();
            let enough = if occupied < L::WIDTH { vector } else { 2 * vector };
            if aperiodic >= L::WIDTH || (!moving && worthwhile(aperiodic)) {
                lanes.cases.follow_aperiodic_cases();
                lanes.fill();
            } else if concluding >= enough || (!moving && concluding > 0) {
                lanes.cases.conclude_some();
                lanes.fill();
            } else if moving {
                lanes.advance(&mut step);
                lanes.attend(step.arrives);
            } else {
                return lanes.left();
            }
        }
    }
}

impl<'a, M: System<D>, const D: usize> Supply<'a, M, D> {
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
        let motions: Vec<_> = cases
            .iter()
            .map(|it| {
                let start = M::Single::point(&it.motion.state);
                (&it.case.system, start, it.progress.steps_left(max_steps))
            })
            .collect();
        let followed = follow_aperiodic_side_by_side(self.instructions, &motions, self.protocol);
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
        let done = self.concluding.begin(conclude);
        self.pass_on(done);
    }

    /// Goes on with cases that are being concluded, side by side.
    fn conclude_some(&mut self) {
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

/// The lanes and the cases in them.
struct Lanes<'a, L: Lane, M: System<D>, const D: usize> {
    cases: Supply<'a, M, D>,
    /// What moves to no purpose in an empty lane.
    spare: Underway<M, D>,
    system: M::In<L>,
    motion: Motion<L, M::In<L>>,
    periods: L,
    occupants: Vec<Option<Underway<M, D>>>,
    /// The lanes with a case, as bits.
    occupied: u64,
    /// Steps taken, and how many had been when the cycle of each lane began, from a number on that no cycle has taken.
    steps: u64,
    cycle_began: Vec<u64>,
    /// No case has taken too many steps before so many are taken.
    deadline: u64,
}

impl<'a, L: Lane, M: System<D>, const D: usize> Lanes<'a, L, M, D> {
    /// Empty lanes.
    fn new(spare: Underway<M, D>, cases: Supply<'a, M, D>) -> Self {
        Lanes {
            cases,
            motion: Motion::splat(&spare.motion),
            system: M::In::<L>::splat(&spare.system),
            periods: L::splat(spare.system.period()),
            spare,
            occupants: (0..L::WIDTH).map(|_| None).collect(),
            occupied: 0,
            steps: STEPS_PER_CYCLE,
            cycle_began: vec![0; L::WIDTH],
            deadline: 0,
        }
    }

    /// Moves every lane by a step.
    #[inline(always)]
    fn advance(&mut self, step: &mut Step<L, M::In<L>>) {
        let tolerance = self.cases.protocol.tolerance;
        self.motion.step(&self.system, self.periods, tolerance, step);
        self.steps += 1;
    }

    /// Looks after the lanes whose case cannot go on or whose cycle has ended.
    #[inline(always)]
    fn attend(&mut self, ended: L::Mask) {
        let mut broken = self.motion.broken(&self.system).bits() & self.occupied;
        let mut at_end = ended.bits() & self.occupied & !broken;
        while let Some(lane) = take_lowest(&mut broken) {
            self.give_up(lane);
        }
        if ended.any() {
            let durations = self.motion.time;
            self.motion.begin_cycle(ended);
            while let Some(lane) = take_lowest(&mut at_end) {
                let state = self.motion.state.lane(lane);
                self.end_cycle(lane, &state, durations.lane(lane));
            }
        }
        if self.steps >= self.deadline {
            self.give_up_the_slow();
        }
    }

    /// Takes note of the section point that the case in `lane` has reached.
    fn end_cycle(&mut self, lane: usize, state: &M::State<f64>, duration: f64) {
        let case = self.occupants[lane].as_mut().expect("the lane is occupied");
        case.progress.steps = self.steps - self.cycle_began[lane];
        case.progress.count(duration);
        self.cycle_began[lane] = self.steps;
        let exhausted = case.progress.cycles >= self.cases.protocol.max_cycles;
        let end = End::of(case.settling.meet(M::Single::point(state)), exhausted);
        if let Some(end) = end {
            self.replace(lane, move |_, _| Ok(end));
        } else if exhausted {
            let case = self.take(lane).expect("the lane is occupied");
            self.cases.aperiodic.push(case);
            let next = self.cases.next(None);
            self.fill_lane(lane, next);
        }
    }

    /// Concludes the case in `lane`, which cannot go on.
    fn give_up(&mut self, lane: usize) {
        self.replace(lane, |trajectory, _| Err(trajectory.stuck()));
    }

    /// Concludes the cases whose cycle has taken too many steps, or that have none left.
    fn give_up_the_slow(&mut self) {
        let mut occupied = self.occupied;
        let max_steps = self.cases.protocol.max_steps;
        self.deadline = u64::MAX;
        while let Some(lane) = take_lowest(&mut occupied) {
            let deadline = |it: &Self| {
                let case = it.occupants[lane].as_ref()?;
                Some(it.cycle_began[lane].saturating_add(case.progress.deadline(max_steps)))
            };
            if deadline(self).is_some_and(|deadline| self.steps >= deadline) {
                self.give_up(lane);
            }
            self.deadline = self.deadline.min(deadline(self).unwrap_or(u64::MAX));
        }
    }

    /// Concludes the case in `lane` as `found` says, and puts the next one there.
    fn replace(
        &mut self,
        lane: usize,
        found: impl FnOnce(&mut Trajectory<'_, M::Single, D>, &mut Settling<D>) -> Finding<M, D>
        + 'static,
    ) {
        let case = self.take(lane).expect("the lane is occupied");
        self.cases.conclude(case, found);
        let next = self.cases.next(None);
        self.fill_lane(lane, next);
    }

    /// Puts a case into `lane`, or leaves the lane empty.
    fn fill_lane(&mut self, lane: usize, case: Option<Underway<M, D>>) {
        let spare = &self.spare;
        let Underway { system, motion, case: Case { system: parameters, .. }, .. } =
            case.as_ref().unwrap_or(spare);
        assert!(parameters.is_alike(&spare.case.system), "cases side by side are alike");
        self.system.put(lane, system);
        self.motion.put(lane, motion);
        self.periods = self.periods.with_lane(lane, system.period());
        // A case that goes on has taken some steps of its cycle, and of those that it may take.
        let Progress { steps, steps_before, .. } =
            case.as_ref().map_or_else(Progress::default, |case| case.progress);
        self.cycle_began[lane] = self.steps - steps;
        self.deadline = if steps + steps_before > 0 { 0 } else { self.deadline };
        self.occupied &= !(1 << lane);
        self.occupied |= u64::from(case.is_some()) << lane;
        self.occupants[lane] = case;
    }

    /// Takes the case out of `lane`, as it is.
    fn take(&mut self, lane: usize) -> Option<Underway<M, D>> {
        let motion = self.motion.lane(lane);
        let steps = self.steps - self.cycle_began[lane];
        let case = self.occupants[lane].take()?;
        let progress = Progress { steps, ..case.progress };
        Some(Underway { motion, progress, ..case })
    }

    /// Puts cases into the empty lanes, as far as there are any.
    fn fill(&mut self) {
        for lane in 0..L::WIDTH {
            if self.occupied >> lane & 1 == 0 {
                let next = self.cases.next(None);
                self.fill_lane(lane, next);
            }
        }
    }

    /// The cases that have not settled yet.
    fn left(mut self) -> Left<'a, M, D> {
        let moving: Vec<_> = (0..L::WIDTH).filter_map(|lane| self.take(lane)).collect();
        self.cases.left(moving)
    }
}

/// The lowest bit that is set, which is cleared.
#[inline(always)]
fn take_lowest(bits: &mut u64) -> Option<usize> {
    if *bits == 0 {
        return None;
    }
    let lowest = bits.trailing_zeros() as usize;
    *bits &= *bits - 1;
    Some(lowest)
}
