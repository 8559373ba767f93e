//! Many cases side by side in the lanes of one thread, each lane refilled the moment its case settles.

use crate::flow::{Motion, Step, Stroboscopic, Switched, System};
use crate::lane::{Instructions, Lane, Mask, SideBySide, Work};

use super::aperiodic::follow_aperiodic_side_by_side;
use super::batch::Batch;
use super::measure::{Found, conclude};
use super::passage::{Integrator, OneByOne};
use super::settle::find_period;
use super::settling::{Settling, Verdict};
use super::trajectory::{Progress, leap};
use super::{Case, Failure, OrbitOf, Protocol, Trajectory};

/// What a case has settled to, if it has, or why it could not be followed.
type Finding<M, const D: usize> = Result<Found<D>, Failure<<M as System<D>>::State<f64>>>;

/// A case by its number with what it has settled to.
type Done<M, const D: usize> = (usize, OrbitOf<M, D>);

/// With no more than one lane in so many at work, cases are followed faster one by one.
const WORTHWHILE: usize = 4;

/// A case between its departure and its settling, under the number that its owner knows it by.
pub struct Underway<M: System<D>, const D: usize> {
    number: usize,
    case: Case<M, D>,
    system: M::Single,
    motion: Motion<f64, M::Single>,
    settling: Settling<D>,
    progress: Progress,
}

impl<M: System<D>, const D: usize> Underway<M, D> {
    /// A case about to depart.
    pub fn new(number: usize, case: Case<M, D>, protocol: &Protocol) -> Self {
        let mut settling = Settling::new(protocol, case.system.metric());
        let system = case.system.single();
        let motion = Motion::new(&system, case.begins, case.start);
        if case.begins == 0.0 {
            settling.meet(M::Single::point(&motion.state));
        }
        let progress = Progress::begun(case.begins);
        Underway { number, case, system, motion, settling, progress }
    }

    /// The number that its owner knows it by.
    pub fn number(&self) -> usize {
        self.number
    }

    /// Follows the case by itself until it settles, and measures it.
    pub fn finish(self, protocol: &Protocol) -> (usize, OrbitOf<M, D>) {
        let found = |trajectory: &mut Trajectory<'_, _, D>, settling: &mut Settling<D>| {
            find_period::<M, D>(trajectory, settling, protocol).map(Found::from)
        };
        self.conclude(protocol, found, &OneByOne)
    }

    /// Measures the case, going on from where it is with what it is found to have settled to.
    fn conclude(
        mut self,
        protocol: &Protocol,
        found: impl FnOnce(&mut Trajectory<'_, M::Single, D>, &mut Settling<D>) -> Finding<M, D>,
        integrator: &dyn Integrator<M, D>,
    ) -> (usize, OrbitOf<M, D>) {
        let mut trajectory =
            Trajectory::resume(&self.system, self.motion, self.progress, protocol.tolerance)
                .limited(protocol.max_steps);
        let found = found(&mut trajectory, &mut self.settling);
        (self.number, conclude(&mut trajectory, &self.case, found, protocol, integrator))
    }
}

/// Where cases come from and where they go when they have settled.
pub trait Queue<M: System<D>, const D: usize> {
    /// Takes the case of a number that has been `done`, if one has, and yields one to follow in its place.
    fn next(&mut self, done: Option<(usize, OrbitOf<M, D>)>) -> Option<(usize, Case<M, D>)>;
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
    let (aperiodic, ready) = (Vec::new(), Vec::new());
    let concluding = Batch::new(instructions);
    instructions.run(Supply { instructions, protocol, queue, aperiodic, concluding, ready })
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
    concluding: Batch<M, Done<M, D>, D>,
    /// Cases that could depart, had they a lane.
    ready: Vec<Underway<M, D>>,
}

impl<M: System<D>, const D: usize> Work for Supply<'_, M, D> {
    type Output = Vec<Underway<M, D>>;

    #[inline(always)]
    fn run<L: Lane>(mut self) -> Self::Output {
        let cases: Vec<_> = (0..L::WIDTH).map(|_| self.next(None)).collect();
        let Some(first) = cases.iter().flatten().next() else {
            return Vec::new();
        };
        let spare = Underway::new(0, first.case.clone(), self.protocol);
        let mut lanes = Lanes::<L, M, D>::new(spare, self);
        for (lane, case) in cases.into_iter().enumerate() {
            lanes.fill_lane(lane, case);
        }
        let mut step = Step::default();
        let worthwhile = |cases: usize| cases * WORTHWHILE > L::WIDTH;
        loop {
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
                return lanes.unfinished();
            }
        }
    }
}

impl<M: System<D>, const D: usize> Supply<'_, M, D> {
    fn next(&mut self, done: Option<(usize, OrbitOf<M, D>)>) -> Option<Underway<M, D>> {
        if done.is_none()
            && let Some(ready) = self.ready.pop()
        {
            return Some(ready);
        }
        let (number, case) = self.queue.next(done)?;
        Some(Underway::new(number, case, self.protocol))
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
                followed.map(Found::Followed).map_err(|reason| trajectory.failure(reason))
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

    /// Hands on cases that are done, and takes those that follow them.
    fn pass_on(&mut self, done: impl IntoIterator<Item = Done<M, D>>) {
        for done in done {
            let next = self.next(Some(done));
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
    /// Steps taken, and how many had been when the cycle of each lane began.
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
            steps: 0,
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
        match case.settling.meet(M::Single::point(state)) {
            Verdict::Settled(settled) => {
                self.replace(lane, move |_, _| Ok(Found::Repeats(settled)))
            }
            // At the end of the budget the motion is measured where it is.
            _ if exhausted => {
                let case = self.take(lane).expect("the lane is occupied");
                self.cases.aperiodic.push(case);
                let next = self.cases.next(None);
                self.fill_lane(lane, next);
            }
            Verdict::Leap(section) => self.motion.put(lane, &leap(&case.system, state, section)),
            Verdict::Unsettled => {}
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
        self.cycle_began[lane] = self.steps;
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
    fn unfinished(mut self) -> Vec<Underway<M, D>> {
        let mut cases: Vec<_> = (0..L::WIDTH).filter_map(|lane| self.take(lane)).collect();
        cases.append(&mut self.cases.aperiodic);
        cases.append(&mut self.cases.ready);
        cases
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
