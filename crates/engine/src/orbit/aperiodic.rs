//! What a motion does that does not repeat: whether neighbours part, or time averages settle all the same.

use crate::flow::{Metric, Motion, Reason, STEPS_PER_CYCLE, Stroboscopic, System};
use crate::lane::{Dual, Instructions, Lane, SideBySide, Work};

use super::exponent::{Exponent, Stretching};
use super::lanes::{EndedCycle, Lanes, Task};
use super::occupancy::Kernel;
use super::recurrence::Settled;
use super::{Outcome, Protocol};

/// A positive exponent counts from so many of its uncertainties.
const CERTAINTY: f64 = 5.0;
/// Neighbours that part steadily are e to this power farther apart in the end; where the motion is regular
/// the distance grows no faster than time, and never gets so far.
const GROWTH: f64 = 12.0;
/// The rate [1/s] at which neighbours part at most in so long a time [s] where a motion is regular.
pub(super) fn regular_rate(time: f64) -> f64 {
    GROWTH / time
}

/// Whether neighbours part is looked at after each so many cycles.
const LOOK: usize = 128;
/// Averages over the two halves of a regular motion agree this well, relative to the motion.
const REGULAR: f64 = 1e-6;
/// A point that comes so near to an earlier one, relative to the motion, may belong to an orbit that is approached.
const RECURS: f64 = 1e-5;
/// Periods up to this are looked at for that.
const LONGEST: usize = 1024;

/// A motion followed for many cycles with its linearised flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aperiodic<const D: usize> {
    /// The largest Lyapunov exponent.
    pub exponent: Exponent,
    /// Logarithm of how much farther apart neighbours are in the end.
    pub growth: f64,
    /// How far the averages over its two halves differ, relative to the motion [-].
    pub irregularity: f64,
    /// The number of cycles after which its last point recurs, the least such number, if it does: a period
    /// is proposed.
    pub recurs: Option<Settled>,
    /// No shorter period is left: the last point is away from all those within so many cycles before it.
    pub excluded: usize,
    /// Its last point.
    pub last: [f64; D],
    /// Cycles followed.
    pub cycles: u64,
    /// Steps taken.
    pub steps: u64,
}

impl<const D: usize> Aperiodic<D> {
    /// What the motion is: chaotic, quasi-periodic, or undecided.
    ///
    /// Chaotic: the exponent is positive by five of its uncertainties, and neighbours have parted by more
    /// than a regular motion could part them. Quasi-periodic: they have not parted, the averages of the
    /// section over two stretches of time agree as only those of a regular motion do, and no point recurs.
    pub fn outcome(&self) -> Outcome {
        let Exponent { value, uncertainty } = self.exponent;
        if value > CERTAINTY * uncertainty && self.growth > GROWTH {
            return Outcome::Chaotic;
        }
        let regular = self.growth.abs() <= GROWTH && self.irregularity <= REGULAR;
        if regular && self.recurs.is_none() { Outcome::QuasiPeriodic } else { Outcome::Undecided }
    }
}

/// Where a motion begins that is followed.
#[derive(Debug, Clone, Copy)]
pub struct Departure<'a, M, const D: usize> {
    /// Its system.
    pub system: &'a M,
    /// The point of the section.
    pub point: [f64; D],
    /// Steps that it may take.
    pub max_steps: u64,
}

/// How long a motion is followed.
#[derive(Debug, Clone, Copy)]
struct Goal {
    /// Cycles at most.
    cycles: u64,
    /// The standard error of an exponent above zero, relative to it, at which the motion is followed no further [-].
    error: f64,
}

/// Follows motions for as many cycles as `protocol` gives the exponent, or until it is clear that neighbours part and the
/// exponent is known as well as wanted; as many at a time as there are lanes.
///
/// Guarantees: the same bits by any instructions, and whatever the other motions.
///
/// # Panics
/// Where two systems are not alike, or the processor does not have the instructions.
pub fn follow_aperiodic<M: System<D>, const D: usize>(
    instructions: Instructions,
    starts: &[Departure<'_, M, D>],
    protocol: &Protocol,
) -> Vec<Result<Aperiodic<D>, Reason>> {
    instructions.run_on_a_vector(Departures { starts, protocol })
}

struct Departures<'a, M, const D: usize> {
    starts: &'a [Departure<'a, M, D>],
    protocol: &'a Protocol,
}

impl<M: System<D>, const D: usize> Work for Departures<'_, M, D> {
    const IS_INTERPRETED: bool = M::IS_INTERPRETED;
    type Output = Vec<Result<Aperiodic<D>, Reason>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        let Some(first) = self.starts.first() else { return Vec::new() };
        let Protocol { exponent_cycles, exponent_error, tolerance, .. } = *self.protocol;
        let goal = Goal { cycles: exponent_cycles, error: exponent_error };
        if goal.cycles == 0 {
            return self
                .starts
                .iter()
                .map(|it| Ok(Follower::new(0, it, goal).tell(f64::NAN)))
                .collect();
        }
        let alike = |it: &Departure<'_, M, D>| it.system.is_alike(first.system);
        assert!(self.starts.iter().all(alike), "motions side by side are alike");
        let system = M::In::<Dual<L, 1>>::splat(&first.system.single());
        // What moves to no purpose in a lane that is free.
        let from = first.point.map(Dual::splat);
        let motion = Motion::begun(&system, Dual::splat(0.0), M::In::<Dual<L, 1>>::state(from));
        let mut lanes = Lanes::new(system, motion, tolerance);
        let mut task = Parting {
            starts: self.starts,
            next: 0,
            goal,
            from,
            told: self.starts.iter().map(|_| Err(Reason::TooManySteps)).collect(),
        };
        lanes.follow(&mut task);
        task.told
    }
}

/// Follows motions with a neighbour each.
struct Parting<'a, L, M, const D: usize> {
    starts: &'a [Departure<'a, M, D>],
    /// How many have entered.
    next: usize,
    goal: Goal,
    /// Where the motion in each lane began.
    from: [Dual<L, 1>; D],
    told: Vec<Result<Aperiodic<D>, Reason>>,
}

impl<L: Lane, M: System<D>, const D: usize> Parting<'_, L, M, D> {
    /// Tells what is known of a motion that is followed no further.
    fn tell(&mut self, follower: &Follower<D>, period: f64) {
        let duration = follower.duration::<M::Single, _>(period);
        self.told[follower.number] = Ok(follower.tell(duration));
    }
}

impl<L: Lane, M: System<D>, const D: usize> Task<Dual<L, 1>, M, D> for Parting<'_, L, M, D> {
    type Kept = Follower<D>;
    const KERNEL: Kernel = Kernel::Exponents;

    #[inline(always)]
    fn fill(&mut self, lanes: &mut Lanes<Dual<L, 1>, M, Follower<D>, D>) -> bool {
        if self.next >= self.starts.len() || lanes.count() == L::WIDTH {
            return lanes.count() > 0;
        }
        let mut entrants = Vec::new();
        for (lane, start) in lanes.free().zip(&self.starts[self.next..]) {
            let follower = Follower::new(self.next + entrants.len(), start, self.goal);
            let direction = follower.stretching.first();
            for ((from, point), [along]) in self.from.iter_mut().zip(start.point).zip(direction) {
                from.value = from.value.with_lane(lane, point);
                from.gradient[0] = from.gradient[0].with_lane(lane, along);
            }
            lanes.system.put(lane, &start.system.single());
            entrants.push((lane, follower));
        }
        self.next += entrants.len();
        let state = M::In::<Dual<L, 1>>::state(self.from);
        lanes.enter(Motion::begun(&lanes.system, Dual::splat(0.0), state));
        for (lane, follower) in entrants {
            let steps_left = follower.steps_left();
            lanes.let_in(lane, follower);
            lanes.allow(lane, steps_left);
        }
        true
    }

    #[inline(always)]
    fn end_cycle(
        &mut self,
        lanes: &mut Lanes<Dual<L, 1>, M, Follower<D>, D>,
        lane: usize,
        cycle: EndedCycle,
    ) {
        let period = lanes.period(lane);
        let mut point = M::In::<Dual<L, 1>>::point(&lanes.motion.state);
        let Some(follower) = &mut lanes.kept[lane] else { return };
        follower.count(cycle);
        let direction = follower
            .meet(point.map(|it| it.value.lane(lane)), point.map(|it| it.gradient[0].lane(lane)));
        for (coordinate, along) in point.iter_mut().zip(direction) {
            coordinate.gradient[0] = coordinate.gradient[0].with_lane(lane, along);
        }
        let is_done = follower.is_done(follower.duration::<M::Single, _>(period));
        let steps_left = follower.steps_left();
        lanes.motion.state = M::In::<Dual<L, 1>>::state(point);
        if is_done {
            let follower = lanes.take(lane);
            self.tell(&follower, period);
        } else {
            lanes.allow(lane, steps_left);
        }
    }

    #[inline(always)]
    fn give_up(&mut self, lanes: &mut Lanes<Dual<L, 1>, M, Follower<D>, D>, lane: usize) {
        let breakdown = lanes.breakdown(lane).map(Reason::from);
        let out_of = match lanes.steps(lane) {
            STEPS_PER_CYCLE.. => Reason::TooManySteps,
            _ => Reason::OutOfSteps,
        };
        self.told[lanes.take(lane).number] = Err(breakdown.unwrap_or(out_of));
    }
}

/// One motion that is followed.
struct Follower<const D: usize> {
    /// Its place among those that are to be followed.
    number: usize,
    metric: Metric<D>,
    goal: Goal,
    stretching: Stretching<D, 1>,
    points: Vec<[f64; D]>,
    /// Steps of the cycles met, and how many it may take in all.
    steps: u64,
    max_steps: u64,
    /// Duration of the cycles met [s].
    elapsed: f64,
}

impl<const D: usize> Follower<D> {
    fn new<M: System<D>>(number: usize, start: &Departure<'_, M, D>, goal: Goal) -> Self {
        let metric = start.system.metric();
        Follower {
            number,
            metric,
            goal,
            stretching: Stretching::new(metric),
            points: Vec::new(),
            steps: 0,
            max_steps: start.max_steps,
            elapsed: 0.0,
        }
    }

    /// Steps that the cycle which begins may take.
    fn steps_left(&self) -> u64 {
        STEPS_PER_CYCLE.min(self.max_steps.saturating_sub(self.steps))
    }

    /// Mean duration of the cycles, which is the period of the drive where there is one [s].
    fn duration<S: Stroboscopic<L, D>, L: Lane>(&self, period: f64) -> f64 {
        if S::AUTONOMOUS { self.elapsed / self.points.len() as f64 } else { period }
    }

    /// Counts a cycle.
    fn count(&mut self, cycle: EndedCycle) {
        self.steps += cycle.steps;
        self.elapsed += cycle.duration;
    }

    /// Takes note of the section point and of how far a neighbour is there; the same direction, of unit length again.
    fn meet(&mut self, point: [f64; D], direction: [f64; D]) -> [f64; D] {
        let mut direction = direction.map(|along| [along]);
        self.stretching.meet(&mut direction);
        self.points.push(point);
        direction.map(|[along]| along)
    }

    /// Whether it need not be followed further, in cycles of this mean duration [s].
    fn is_done(&self, duration: f64) -> bool {
        let met = self.points.len();
        met as u64 >= self.goal.cycles || (met.is_multiple_of(LOOK) && self.parts(duration))
    }

    /// Whether it is clear already that neighbours part, and the exponent is known as well as wanted, in cycles of this mean
    /// duration.
    fn parts(&self, duration: f64) -> bool {
        let [Exponent { value, uncertainty }] = self.stretching.exponents(duration);
        value > 1.0 / self.goal.error * uncertainty && self.stretching.total(0) > 2.0 * GROWTH
    }

    fn tell(&self, duration: f64) -> Aperiodic<D> {
        let metric = &self.metric;
        let size = metric.largest(&self.points);
        let [exponent] = self.stretching.exponents(duration);
        let recurs = recurrence(&self.points, metric, size);
        let longest = LONGEST.min(self.points.len().saturating_sub(1));
        Aperiodic {
            exponent,
            growth: self.stretching.total(0),
            irregularity: irregularity(&self.points, metric, size),
            excluded: recurs.map_or(longest, |recurs| recurs.repeats_after - 1),
            recurs,
            last: self.points.last().copied().unwrap_or([0.0; D]),
            cycles: self.points.len() as u64,
            steps: self.steps,
        }
    }
}

/// How far the means of two halves of a sequence differ, relative to `size`.
///
/// Method: the weighted Birkhoff average of Das, Saiki, Sander and Yorke (2017), whose weights
/// exp(-1/(t (1 - t))) vanish smoothly at both ends: on a quasi-periodic orbit it converges faster than
/// any power of the length, on a chaotic one with the inverse root of it.
pub fn irregularity<const D: usize>(points: &[[f64; D]], metric: &Metric<D>, size: f64) -> f64 {
    let (first, second) = points.split_at(points.len() / 2);
    let [a, b] = [first, second].map(smooth_mean);
    // The mean of a coordinate that repeats depends on where it is cut.
    let apart = std::array::from_fn(|i| if metric.repeats[i] { 0.0 } else { a[i] - b[i] });
    metric.relative(&apart, size)
}

fn smooth_mean<const D: usize>(points: &[[f64; D]]) -> [f64; D] {
    let mut sum = [0.0; D];
    let mut weights = 0.0;
    for (n, point) in points.iter().enumerate() {
        let t = (n as f64 + 1.0) / (points.len() as f64 + 1.0);
        let weight = libm::exp(-1.0 / (t * (1.0 - t)));
        weights += weight;
        for (sum, x) in sum.iter_mut().zip(point) {
            *sum += weight * x;
        }
    }
    sum.map(|sum| sum / weights)
}

/// The latest return of the last point to one before it, relative to `size`; none within [`LONGEST`] cycles.
fn recurrence<const D: usize>(
    points: &[[f64; D]],
    metric: &Metric<D>,
    size: f64,
) -> Option<Settled> {
    let (last, before) = points.split_last()?;
    let distance = |point: &[f64; D]| metric.relative(&metric.difference(point, last), size);
    let distances = before.iter().rev().take(LONGEST).map(distance);
    let (cycles, within) = (1..).zip(distances).find(|&(_, distance)| distance <= RECURS)?;
    Some(Settled { repeats_after: cycles, within, size })
}
