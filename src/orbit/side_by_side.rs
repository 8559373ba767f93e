//! Many cases side by side in the lanes of one thread, each lane refilled the moment its case settles.

use crate::capsule::{Capsule, Parameter, Parameters, Resistance, State};
use crate::flow::{Motion, Step};
use crate::lane::{Instructions, Lane, Mask, SideBySide, Work};

use super::measure::{Found, conclude};
use super::settle::find_period;
use super::settling::{Settling, Verdict};
use super::trajectory::{STEPS_PER_CYCLE, count_cycle, leap, section};
use super::wandering::{Wanders, wander_side_by_side};
use super::{Case, Failure, Orbit, Protocol, Trajectory};

/// What a case has settled to, if it has, or why it could not be followed.
type Finding = Result<Found, Failure>;

/// With no more than one lane in so many at work, cases are followed faster one by one.
const WORTHWHILE: usize = 4;

/// A case between its departure and its settling, under the number that its owner knows it by.
pub struct Underway {
    number: usize,
    case: Case,
    system: Capsule<f64>,
    motion: Motion<f64, Capsule<f64>>,
    settling: Settling,
    cycles: u64,
    /// As [`Trajectory`] has it.
    origin: f64,
    /// Steps taken in the cycle so far.
    steps: u64,
}

impl Underway {
    /// A case about to depart.
    pub fn new(number: usize, case: Case, protocol: &Protocol) -> Self {
        let mut settling = Settling::new(protocol, case.parameters[Parameter::Omega]);
        let system = Capsule::single(&case.parameters, case.section_phase);
        let time = case.start_time();
        let motion = Motion::new(&system, time, case.start);
        if time == 0.0 {
            settling.meet(section(&motion.state));
        }
        let origin = 0.0 - time;
        Underway { number, case, system, motion, settling, cycles: 0, origin, steps: 0 }
    }

    /// The number that its owner knows it by.
    pub fn number(&self) -> usize {
        self.number
    }

    /// Follows the case by itself until it settles, and measures it.
    pub fn finish(self, protocol: &Protocol) -> (usize, Orbit) {
        self.conclude(protocol, |trajectory, settling| {
            find_period(trajectory, settling, protocol).map(Found::from)
        })
    }

    /// Where and how it moves, for its linearised flow.
    fn wanders(&self) -> Wanders<'_> {
        let start = section(&self.motion.state);
        Wanders { system: &self.system, start, parameters: &self.case.parameters }
    }

    /// Measures the case, going on from where it is with what it is found to have settled to.
    fn conclude(
        mut self,
        protocol: &Protocol,
        found: impl FnOnce(&mut Trajectory<'_, Capsule<f64>>, &mut Settling) -> Finding,
    ) -> (usize, Orbit) {
        let drive_period = self.case.parameters.drive_period();
        let mut trajectory = Trajectory::resume(
            &self.system,
            self.motion,
            [self.cycles, self.steps],
            drive_period,
            protocol.tolerance,
        );
        trajectory.origin = self.origin;
        let found = found(&mut trajectory, &mut self.settling);
        (self.number, conclude(&mut trajectory, &self.case, found, protocol))
    }
}

/// Where cases come from and where they go when they have settled.
pub trait Queue {
    /// Takes the case of a number that has been `done`, if one has, and yields one to follow in its place.
    fn next(&mut self, done: Option<(usize, Orbit)>) -> Option<(usize, Case)>;
}

/// Settles the cases of `queue`, which share one law of resistance, as many at a time as there are lanes,
/// until there are no more.
///
/// The orbits have the bits that [`super::settle`] gives, whatever the instructions. Returns the last few
/// cases unfinished, each to be finished by itself and on any thread.
pub fn settle_side_by_side(
    instructions: Instructions,
    protocol: &Protocol,
    queue: &mut dyn Queue,
) -> Vec<Underway> {
    let (wandering, ready) = (Vec::new(), Vec::new());
    instructions.run(Supply { instructions, protocol, queue, wandering, ready })
}

/// Where the lanes take their cases from.
struct Supply<'a> {
    instructions: Instructions,
    protocol: &'a Protocol,
    // Not generic over the queue: the lanes are compiled once for each kind, which takes long.
    queue: &'a mut dyn Queue,
    /// Cases that have not settled, gathered until there are enough to follow their linearised flow side by
    /// side.
    wandering: Vec<Underway>,
    /// Cases that could depart, had they a lane.
    ready: Vec<Underway>,
}

impl Work for Supply<'_> {
    type Output = Vec<Underway>;

    #[inline(always)]
    fn run<L: Lane>(mut self) -> Vec<Underway> {
        let cases: Vec<_> = (0..L::WIDTH).map(|_| self.next(None)).collect();
        let Some(first) = cases.iter().flatten().next() else {
            return Vec::new();
        };
        let mut convoy = Convoy::<L>::new(first.case.parameters.resistance, self);
        for (lane, case) in cases.into_iter().enumerate() {
            convoy.seat(lane, case);
        }
        let mut step = Step::default();
        let worthwhile = |cases: usize| cases * WORTHWHILE > L::WIDTH;
        loop {
            let moving = worthwhile(convoy.occupied.count_ones() as usize);
            let wandering = convoy.cases.wandering.len();
            if wandering >= L::WIDTH || (!moving && worthwhile(wandering)) {
                convoy.cases.follow_wandering();
                convoy.fill();
            } else if moving {
                convoy.advance(&mut step);
                convoy.attend();
            } else {
                return convoy.unfinished();
            }
        }
    }
}

impl Supply<'_> {
    fn next(&mut self, done: Option<(usize, Orbit)>) -> Option<Underway> {
        if done.is_none()
            && let Some(ready) = self.ready.pop()
        {
            return Some(ready);
        }
        let (number, case) = self.queue.next(done)?;
        Some(Underway::new(number, case, self.protocol))
    }

    /// Follows the cases that wander with their linearised flow, side by side, and concludes them.
    fn follow_wandering(&mut self) {
        let cases = std::mem::take(&mut self.wandering);
        let motions: Vec<_> = cases.iter().map(Underway::wanders).collect();
        let followed = wander_side_by_side(self.instructions, &motions, self.protocol);
        for (case, followed) in cases.into_iter().zip(followed) {
            let done = case.conclude(self.protocol, |trajectory, _| {
                followed.map(Found::Followed).map_err(|reason| trajectory.failure(reason))
            });
            let next = self.next(Some(done));
            self.ready.extend(next);
        }
    }
}

/// The lanes and who is in them.
struct Convoy<'a, L: Lane> {
    cases: Supply<'a>,
    /// What moves to no purpose in an empty lane.
    spare: Underway,
    system: Capsule<L>,
    motion: Motion<L, Capsule<L>>,
    drive_periods: L,
    seats: Vec<Option<Underway>>,
    /// The lanes with a case, as bits.
    occupied: u64,
    /// Steps taken, and how many had been when the cycle of each lane began.
    steps: u64,
    cycle_began: Vec<u64>,
    /// No cycle has taken too many steps before so many are taken.
    deadline: u64,
}

impl<'a, L: Lane> Convoy<'a, L> {
    /// Empty lanes, in which a capsule with the usual parameters moves.
    fn new(resistance: Resistance, cases: Supply<'a>) -> Self {
        let mut parameters = Parameters::default();
        parameters.resistance = resistance;
        let case = Case::at_section(parameters, State::default(), 0.0);
        let spare = Underway::new(0, case, cases.protocol);
        Convoy {
            cases,
            motion: Motion::splat(&spare.motion),
            system: Capsule::splat(&spare.system),
            drive_periods: L::splat(spare.case.parameters.drive_period()),
            spare,
            seats: (0..L::WIDTH).map(|_| None).collect(),
            occupied: 0,
            steps: 0,
            cycle_began: vec![0; L::WIDTH],
            deadline: STEPS_PER_CYCLE,
        }
    }

    /// Moves every lane by a step.
    #[inline(always)]
    fn advance(&mut self, step: &mut Step<L, Capsule<L>>) {
        let tolerance = self.cases.protocol.tolerance;
        self.motion.step(&self.system, self.drive_periods, tolerance, step);
        self.steps += 1;
    }

    /// Looks after the lanes whose case cannot go on or whose cycle has ended.
    #[inline(always)]
    fn attend(&mut self) {
        let mut broken = self.motion.broken(&self.system).bits() & self.occupied;
        let ended = self.drive_periods.le(self.motion.time);
        let mut at_end = ended.bits() & self.occupied & !broken;
        while let Some(lane) = take_lowest(&mut broken) {
            self.give_up(lane);
        }
        if ended.any() {
            self.motion.begin_cycle(ended);
        }
        while let Some(lane) = take_lowest(&mut at_end) {
            let state = self.motion.state.lane(lane);
            self.end_cycle(lane, &state);
        }
        if self.steps >= self.deadline {
            self.give_up_the_slow();
        }
    }

    /// Takes note of the section point that the case in `lane` has reached.
    fn end_cycle(&mut self, lane: usize, state: &State<f64>) {
        let case = self.seats[lane].as_mut().expect("the lane is occupied");
        count_cycle(&mut case.cycles, &mut case.origin, case.case.parameters.drive_period());
        self.cycle_began[lane] = self.steps;
        let exhausted = case.cycles >= self.cases.protocol.max_cycles;
        match case.settling.meet(section(state)) {
            Verdict::Settled(settled) => self.relieve(lane, |_, _| Ok(Found::Repeats(settled))),
            // At the end of the budget the motion is measured where it is.
            _ if exhausted => {
                let case = self.leave(lane).expect("the lane is occupied");
                self.cases.wandering.push(case);
                let next = self.cases.next(None);
                self.seat(lane, next);
            }
            Verdict::Leap(section) => self.motion.put(lane, &leap(&case.system, state, section)),
            Verdict::Unsettled => {}
        }
    }

    /// Concludes the case in `lane`, which cannot go on.
    fn give_up(&mut self, lane: usize) {
        self.relieve(lane, |trajectory, _| {
            Err(trajectory.look().expect_err("the lane cannot go on"))
        });
    }

    /// Concludes the cases whose cycle has taken too many steps.
    fn give_up_the_slow(&mut self) {
        let mut occupied = self.occupied;
        let mut earliest = self.steps;
        while let Some(lane) = take_lowest(&mut occupied) {
            if self.steps - self.cycle_began[lane] >= STEPS_PER_CYCLE {
                self.give_up(lane);
            }
            earliest = earliest.min(self.cycle_began[lane]);
        }
        self.deadline = earliest + STEPS_PER_CYCLE;
    }

    /// Concludes the case in `lane` as `found` says, and seats the next.
    fn relieve(
        &mut self,
        lane: usize,
        found: impl FnOnce(&mut Trajectory<'_, Capsule<f64>>, &mut Settling) -> Finding,
    ) {
        let case = self.leave(lane).expect("the lane is occupied");
        let done = case.conclude(self.cases.protocol, found);
        let next = self.cases.next(Some(done));
        self.seat(lane, next);
    }

    /// Seats a case in `lane`, or leaves the lane empty.
    fn seat(&mut self, lane: usize, case: Option<Underway>) {
        let spare = &self.spare;
        let seated = case.as_ref().map(|case| (&case.system, &case.motion, &case.case.parameters));
        let (system, motion, parameters) =
            seated.unwrap_or((&spare.system, &spare.motion, &spare.case.parameters));
        let law = spare.case.parameters.resistance;
        assert_eq!(law, parameters.resistance, "cases side by side share one law of resistance");
        self.system.put(lane, system);
        self.motion.put(lane, motion);
        self.drive_periods = self.drive_periods.with_lane(lane, parameters.drive_period());
        self.cycle_began[lane] = self.steps;
        self.occupied &= !(1 << lane);
        self.occupied |= u64::from(case.is_some()) << lane;
        self.seats[lane] = case;
    }

    /// Takes the case out of `lane`, as it is.
    fn leave(&mut self, lane: usize) -> Option<Underway> {
        let motion = self.motion.lane(lane);
        let steps = self.steps - self.cycle_began[lane];
        let case = self.seats[lane].take()?;
        Some(Underway { motion, steps, ..case })
    }

    /// Seats cases in the empty lanes, as far as there are any.
    fn fill(&mut self) {
        for lane in 0..L::WIDTH {
            if self.occupied >> lane & 1 == 0 {
                let next = self.cases.next(None);
                self.seat(lane, next);
            }
        }
    }

    /// The cases that are still under way.
    fn unfinished(mut self) -> Vec<Underway> {
        let mut cases: Vec<_> = (0..L::WIDTH).filter_map(|lane| self.leave(lane)).collect();
        cases.append(&mut self.cases.wandering);
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
