//! What a motion does that does not repeat: whether neighbours part, or time averages settle all the same.

use crate::flow::{
    MAX_GUARDS, Metric, Motion, Reason, STEPS_PER_CYCLE, Step, Stroboscopic, System,
};
use crate::lane::{Dual, Instructions, Lane, Mask, SideBySide, Work};

use super::exponent::{Exponent, Stretching};
use super::recurrence::Settled;
use super::{Outcome, Protocol};

/// A positive exponent counts from so many of its uncertainties.
const CERTAINTY: f64 = 5.0;
/// Neighbours that part steadily are e to this power farther apart in the end; where the motion is regular
/// the distance grows no faster than time, and never gets so far.
const GROWTH: f64 = 12.0;
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
pub struct Departure<const D: usize> {
    /// The point of the section.
    pub point: [f64; D],
    /// The metric of its system.
    pub metric: Metric<D>,
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

/// One motion that is followed.
struct Follower<const D: usize> {
    metric: Metric<D>,
    goal: Goal,
    stretching: Stretching<D, 1>,
    points: Vec<[f64; D]>,
    /// Steps taken in the cycle, and before it.
    steps: u64,
    steps_before: u64,
    max_steps: u64,
    /// Duration of the cycles met [s].
    elapsed: f64,
    done: Option<Result<(), Reason>>,
}

/// Follows motions from `starts`, one in each lane of `system` and no more than there are lanes, for as many cycles as
/// `protocol` gives the exponent, or until it is clear that neighbours part and the exponent is known as well as wanted.
///
/// The bits of each do not depend on the others.
#[inline(always)]
pub fn follow_aperiodic<L, S, const D: usize>(
    system: &S,
    starts: &[Departure<D>],
    protocol: &Protocol,
) -> Vec<Result<Aperiodic<D>, Reason>>
where
    L: Lane,
    S: Stroboscopic<Dual<L, 1>, D>,
{
    let Protocol { exponent_cycles, exponent_error, tolerance, .. } = *protocol;
    let goal = Goal { cycles: exponent_cycles, error: exponent_error };
    let mut followers: Vec<Follower<D>> =
        starts.iter().map(|start| Follower::new(start, goal)).collect();
    let start = |i: usize| Dual {
        value: L::from_fn(|lane| starts[lane.min(starts.len() - 1)].point[i]),
        gradient: [L::from_fn(|lane| match followers.get(lane) {
            Some(follower) => follower.stretching.first()[i][0],
            None => 0.0,
        })],
    };
    let from = std::array::from_fn(start);
    let mut motion = Motion::begun(system, Dual::splat(0.0), S::state(from));
    let mut step = Step::default();
    let until = system.period();
    let mut first_steps = MAX_GUARDS;
    while followers.iter().any(|follower| follower.done.is_none()) {
        let (to, tolerance) =
            if first_steps > 0 { (Dual::splat(0.0), 1.0) } else { (until, tolerance) };
        motion.step(system, to, tolerance, &mut step);
        if first_steps > 0 {
            first_steps -= 1;
            if first_steps == 0 {
                motion.face_section(system, &mut step);
            }
            continue;
        }
        let broken = motion.broken(system);
        let mut point = S::point(&motion.state);
        for (lane, follower) in followers.iter_mut().enumerate() {
            follower.steps += 1;
            if follower.done.is_some() {
                continue;
            }
            let out_of_steps = follower.out_of_steps();
            if broken.lane(lane) || out_of_steps.is_some() {
                let breakdown = motion.breakdown(system, lane).map(Reason::from);
                let why = breakdown.or(out_of_steps).unwrap_or(Reason::TooManySteps);
                follower.done = Some(Err(why));
            } else if step.arrives.lane(lane) {
                follower.steps_before += std::mem::take(&mut follower.steps);
                follower.elapsed += motion.time.lane(lane);
                let period = until.lane(lane);
                follower.meet(lane, &mut point, |it| it.duration::<S, _>(period));
            }
        }
        if step.arrives.any() {
            motion.begin_cycle(step.arrives);
            motion.state = S::state(point);
        }
    }
    let told = followers.iter().enumerate();
    told.map(|(lane, it)| it.tell(it.duration::<S, _>(until.lane(lane)))).collect()
}

/// Follows motions of systems from points of the section, each for so many steps at most, as [`follow_aperiodic`]
/// does, as many at a time as there are lanes.
pub fn follow_aperiodic_side_by_side<M: System<D>, const D: usize>(
    instructions: Instructions,
    starts: &[(&M, [f64; D], u64)],
    protocol: &Protocol,
) -> Vec<Result<Aperiodic<D>, Reason>> {
    instructions.run_on_a_vector(Crowd { starts, protocol })
}

struct Crowd<'a, M, const D: usize> {
    starts: &'a [(&'a M, [f64; D], u64)],
    protocol: &'a Protocol,
}

impl<M: System<D>, const D: usize> Work for Crowd<'_, M, D> {
    type Output = Vec<Result<Aperiodic<D>, Reason>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        let mut followed = Vec::with_capacity(self.starts.len());
        for group in self.starts.chunks(L::WIDTH) {
            let mut system = M::In::<Dual<L, 1>>::splat(&group[0].0.single());
            for (lane, (one, ..)) in group.iter().enumerate() {
                system.put(lane, &one.single());
            }
            let depart = |&(system, point, max_steps): &(&M, _, _)| Departure {
                point,
                metric: system.metric(),
                max_steps,
            };
            let starts: Vec<_> = group.iter().map(depart).collect();
            followed.extend(follow_aperiodic(&system, &starts, self.protocol));
        }
        followed
    }
}

impl<const D: usize> Follower<D> {
    fn new(start: &Departure<D>, goal: Goal) -> Self {
        let Departure { metric, max_steps, .. } = *start;
        Follower {
            metric,
            goal,
            stretching: Stretching::new(metric),
            points: Vec::new(),
            steps: 0,
            steps_before: 0,
            max_steps,
            elapsed: 0.0,
            done: (goal.cycles == 0).then_some(Ok(())),
        }
    }

    /// Why it may take no more steps, if so.
    fn out_of_steps(&self) -> Option<Reason> {
        let cycle = (self.steps >= STEPS_PER_CYCLE).then_some(Reason::TooManySteps);
        let all = self.steps_before + self.steps >= self.max_steps;
        cycle.or(all.then_some(Reason::OutOfSteps))
    }

    /// Mean duration of the cycles, which is the period of the drive where there is one [s].
    fn duration<S: Stroboscopic<L, D>, L: Lane>(&self, period: f64) -> f64 {
        if S::AUTONOMOUS { self.elapsed / self.points.len() as f64 } else { period }
    }

    /// Takes note of the section point in a lane and makes its direction one of unit length again.
    fn meet<L: Lane>(
        &mut self,
        lane: usize,
        point: &mut [Dual<L, 1>; D],
        duration: impl Fn(&Self) -> f64,
    ) {
        let mut direction = point.map(|coordinate| [coordinate.gradient[0].lane(lane)]);
        self.stretching.meet(&mut direction);
        for (coordinate, [gradient]) in point.iter_mut().zip(direction) {
            coordinate.gradient[0] = coordinate.gradient[0].with_lane(lane, gradient);
        }
        self.points.push(point.map(|coordinate| coordinate.value.lane(lane)));
        let met = self.points.len();
        if met as u64 >= self.goal.cycles
            || (met.is_multiple_of(LOOK) && self.parts(duration(self)))
        {
            self.done = Some(Ok(()));
        }
    }

    /// Whether it is clear already that neighbours part, and the exponent is known as well as wanted, in cycles of this mean
    /// duration.
    fn parts(&self, duration: f64) -> bool {
        let [Exponent { value, uncertainty }] = self.stretching.exponents(duration);
        value > 1.0 / self.goal.error * uncertainty && self.stretching.total(0) > 2.0 * GROWTH
    }

    fn tell(&self, duration: f64) -> Result<Aperiodic<D>, Reason> {
        if let Some(Err(why)) = self.done {
            return Err(why);
        }
        let metric = &self.metric;
        let size = metric.largest(&self.points);
        let [exponent] = self.stretching.exponents(duration);
        let recurs = recurrence(&self.points, metric, size);
        let longest = LONGEST.min(self.points.len().saturating_sub(1));
        Ok(Aperiodic {
            exponent,
            growth: self.stretching.total(0),
            irregularity: irregularity(&self.points, metric, size),
            excluded: recurs.map_or(longest, |recurs| recurs.repeats_after - 1),
            recurs,
            last: self.points.last().copied().unwrap_or([0.0; D]),
            cycles: self.points.len() as u64,
            steps: self.steps_before,
        })
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
    metric.relative(&std::array::from_fn(|i| a[i] - b[i]), size)
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
    let distance =
        |point: &[f64; D]| metric.relative(&std::array::from_fn(|i| point[i] - last[i]), size);
    let distances = before.iter().rev().take(LONGEST).map(distance);
    let (cycles, within) = (1..).zip(distances).find(|&(_, distance)| distance <= RECURS)?;
    Some(Settled { repeats_after: cycles, within, size })
}
