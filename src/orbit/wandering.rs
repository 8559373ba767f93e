//! What a motion does that does not repeat: whether neighbours part, or time averages settle all the same.

use crate::capsule::{Capsule, Parameter, Parameters, Stroboscopic};
use crate::flow::{Motion, Step};
use crate::lane::{Dual, Instructions, Lane, Mask, SideBySide, Work};

use super::exponent::{Exponent, Stretching};
use super::newton::relative;
use super::recurrence::Settled;
use super::trajectory::STEPS_PER_CYCLE;
use super::{Outcome, Protocol, Reason, Section};

/// A positive exponent counts from so many of its uncertainties.
const CERTAINTY: f64 = 5.0;
/// Neighbours that part steadily are e to this power farther apart in the end; where the motion is regular
/// the distance grows no faster than time, and never gets so far.
const GROWTH: f64 = 12.0;
/// Whether neighbours part is looked at after each so many cycles.
const LOOK: usize = 128;
/// Averages over the two halves of a regular motion agree this well, relative to the motion.
const REGULAR: f64 = 1e-6;
/// A point that comes so near to an earlier one, relative to the motion, may be on its way to a period.
const RECURS: f64 = 1e-5;
/// Periods up to this are looked at for that.
const LONGEST: usize = 1024;

/// A motion followed for many cycles with its linearised flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wandering {
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
    pub last: Section,
    /// Cycles followed.
    pub cycles: u64,
}

impl Wandering {
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

/// One motion on the way.
struct Wanderer {
    stretching: Stretching<3, 1>,
    points: Vec<Section>,
    steps: u64,
    done: Option<Result<(), Reason>>,
}

/// Follows motions from `starts`, one in each lane of `system` and no more than there are lanes, for so many
/// `cycles` or until it is clear that neighbours part.
///
/// The bits of each do not depend on the others.
#[inline(always)]
pub fn wander<L, S>(
    system: &S,
    starts: &[Section],
    (drive_periods, omegas): (L, L),
    cycles: u64,
    tolerance: f64,
) -> Vec<Result<Wandering, Reason>>
where
    L: Lane,
    S: Stroboscopic<Dual<L, 1>, 3>,
{
    let mut wanderers: Vec<Wanderer> = (0..starts.len())
        .map(|lane| Wanderer {
            stretching: Stretching::new([omegas.lane(lane), 1.0, 1.0]),
            points: Vec::new(),
            steps: 0,
            done: (cycles == 0).then_some(Ok(())),
        })
        .collect();
    let start = |i: usize| Dual {
        value: L::from_fn(|lane| starts[lane.min(starts.len() - 1)][i]),
        gradient: [L::from_fn(|lane| match wanderers.get(lane) {
            Some(wanderer) => wanderer.stretching.first()[i][0],
            None => 0.0,
        })],
    };
    let mut motion =
        Motion::new(system, Dual::splat(0.0), S::state([start(0), start(1), start(2)]));
    let mut step = Step::default();
    let until = Dual::constant(drive_periods);
    while wanderers.iter().any(|wanderer| wanderer.done.is_none()) {
        motion.step(system, until, tolerance, &mut step);
        let ended = until.le(motion.time);
        let broken = motion.broken(system);
        let mut point = S::point(&motion.state);
        for (lane, wanderer) in wanderers.iter_mut().enumerate() {
            wanderer.steps += 1;
            if wanderer.done.is_some() {
                continue;
            }
            if broken.lane(lane) || wanderer.steps >= STEPS_PER_CYCLE {
                let why = motion.breakdown(system, lane).map_or(Reason::TooManySteps, Reason::from);
                wanderer.done = Some(Err(why));
            } else if ended.lane(lane) {
                wanderer.steps = 0;
                wanderer.meet(lane, &mut point, cycles, drive_periods.lane(lane));
            }
        }
        if ended.any() {
            motion.begin_cycle(ended);
            motion.state = S::state(point);
        }
    }
    let told = wanderers.iter().enumerate();
    told.map(|(lane, wanderer)| wanderer.tell(drive_periods.lane(lane), omegas.lane(lane)))
        .collect()
}

/// A capsule to be followed with its linearised flow.
#[derive(Debug, Clone, Copy)]
pub struct Wanders<'a> {
    /// The capsule.
    pub system: &'a Capsule<f64>,
    /// Its point of the section.
    pub start: Section,
    /// Its parameters.
    pub parameters: &'a Parameters,
}

/// Follows capsules under one law of resistance as [`wander`] does, as many at a time as there are lanes.
pub fn wander_side_by_side(
    instructions: Instructions,
    capsules: &[Wanders<'_>],
    protocol: &Protocol,
) -> Vec<Result<Wandering, Reason>> {
    instructions.run(Crowd { capsules, protocol })
}

struct Crowd<'a> {
    capsules: &'a [Wanders<'a>],
    protocol: &'a Protocol,
}

impl Work for Crowd<'_> {
    type Output = Vec<Result<Wandering, Reason>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        let Protocol { exponent_cycles, tolerance, .. } = *self.protocol;
        let mut followed = Vec::with_capacity(self.capsules.len());
        for group in self.capsules.chunks(L::WIDTH) {
            let of = |lane: usize| &group[lane.min(group.len() - 1)];
            let mut system = Capsule::<Dual<L, 1>>::splat(of(0).system);
            for (lane, capsule) in group.iter().enumerate() {
                system.put(lane, capsule.system);
            }
            let starts: Vec<_> = group.iter().map(|capsule| capsule.start).collect();
            let periods = L::from_fn(|lane| of(lane).parameters.drive_period());
            let omegas = L::from_fn(|lane| of(lane).parameters[Parameter::Omega]);
            let frame = (periods, omegas);
            followed.extend(wander(&system, &starts, frame, exponent_cycles, tolerance));
        }
        followed
    }
}

impl Wanderer {
    /// Takes note of the section point in a lane and makes its direction one of unit length again.
    fn meet<L: Lane>(
        &mut self,
        lane: usize,
        point: &mut [Dual<L, 1>; 3],
        cycles: u64,
        drive_period: f64,
    ) {
        let mut direction = point.map(|coordinate| [coordinate.gradient[0].lane(lane)]);
        self.stretching.meet(&mut direction);
        for (coordinate, [gradient]) in point.iter_mut().zip(direction) {
            coordinate.gradient[0] = coordinate.gradient[0].with_lane(lane, gradient);
        }
        self.points.push(point.map(|coordinate| coordinate.value.lane(lane)));
        let met = self.points.len();
        if met as u64 >= cycles || (met.is_multiple_of(LOOK) && self.parts(drive_period)) {
            self.done = Some(Ok(()));
        }
    }

    /// Whether it is clear already that neighbours part.
    fn parts(&self, drive_period: f64) -> bool {
        let [Exponent { value, uncertainty }] = self.stretching.exponents(drive_period);
        value > 2.0 * CERTAINTY * uncertainty && self.stretching.total(0) > 2.0 * GROWTH
    }

    fn tell(&self, drive_period: f64, omega: f64) -> Result<Wandering, Reason> {
        if let Some(Err(why)) = self.done {
            return Err(why);
        }
        let scales = [omega, 1.0, 1.0];
        let size =
            self.points.iter().map(|point| relative(point, &scales, 1.0)).fold(0.0, f64::max);
        let [exponent] = self.stretching.exponents(drive_period);
        let recurs = recurrence(&self.points, &scales, size);
        let longest = LONGEST.min(self.points.len().saturating_sub(1));
        Ok(Wandering {
            exponent,
            growth: self.stretching.total(0),
            irregularity: irregularity(&self.points, &scales, size),
            excluded: recurs.map_or(longest, |recurs| recurs.repeats_after - 1),
            recurs,
            last: self.points.last().copied().unwrap_or_default(),
            cycles: self.points.len() as u64,
        })
    }
}

/// How far the means of two halves of a sequence differ, relative to `size`.
///
/// Method: the weighted Birkhoff average of Das, Saiki, Sander and Yorke (2017), whose weights
/// exp(-1/(t (1 - t))) vanish smoothly at both ends: on a quasi-periodic orbit it converges faster than
/// any power of the length, on a chaotic one with the inverse root of it.
pub fn irregularity(points: &[Section], scales: &Section, size: f64) -> f64 {
    let (first, second) = points.split_at(points.len() / 2);
    let [a, b] = [first, second].map(smooth_mean);
    relative(&std::array::from_fn(|i| a[i] - b[i]), scales, size)
}

fn smooth_mean(points: &[Section]) -> Section {
    let mut sum = [0.0; 3];
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
fn recurrence(points: &[Section], scales: &Section, size: f64) -> Option<Settled> {
    let (last, before) = points.split_last()?;
    let distance =
        |point: &Section| relative(&std::array::from_fn(|i| point[i] - last[i]), scales, size);
    let distances = before.iter().rev().take(LONGEST).map(distance);
    let (cycles, within) = (1..).zip(distances).find(|&(_, distance)| distance <= RECURS)?;
    Some(Settled { repeats_after: cycles, within, size })
}
