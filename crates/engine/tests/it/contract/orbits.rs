//! The law of certificates: an orbit that is proven closes, answers pushes as its multipliers say, and has the
//! least period.

use capsulemap_engine::flow::{Field, Metric, Reason, Step, Stroboscopic, Switched};
use capsulemap_engine::orbit::matrix::Complex;
use capsulemap_engine::orbit::return_map::{Cycles, returned};
use capsulemap_engine::orbit::{OrbitOf, Outcome, Proof, Protocol, settle};

use super::super::draws::Random;
use super::subject::{Subject, count};

/// Periods that an orbit is followed.
const PERIODS: usize = 50;
/// Sizes of pushes, relative to the motion: the answer is compared in the limit of small ones.
const PUSHES: [f64; 4] = [1e-5, 1e-6, 1e-7, 1e-8];

/// Multipliers foretell the answer to a push that misses what they allow by less.
const LINEAR: f64 = 1e-3;

/// A periodic orbit and what it is called.
struct Certified<'a, M, const D: usize> {
    system: &'a M,
    metric: Metric<D>,
    point: [f64; D],
    size: f64,
    period: u64,
    multipliers: [Complex; D],
}

/// The points of the orbit of `point` after every `every` cycles, so many of them and the point itself.
fn followed<M: Subject<D>, const D: usize>(
    system: &M,
    point: [f64; D],
    (every, times): (u64, usize),
) -> Vec<[f64; D]> {
    let cycles = Cycles { count: every, tolerance: 1e-13 };
    let system = system.single();
    let mut points = vec![point];
    for _ in 0..times {
        let last = points[points.len() - 1];
        points.push(returned(&system, last, &cycles, |_| ()).expect("a periodic orbit goes on"));
    }
    points
}

/// The coefficients of the polynomial whose roots these are, the highest power first.
fn polynomial<const D: usize>(roots: &[Complex; D]) -> Vec<f64> {
    let mut coefficients = vec![(1.0, 0.0)];
    for Complex { re, im } in roots {
        let mut next = coefficients.clone();
        next.push((0.0, 0.0));
        for (k, (a, b)) in coefficients.iter().enumerate() {
            next[k + 1].0 -= re * a - im * b;
            next[k + 1].1 -= re * b + im * a;
        }
        coefficients = next;
    }
    coefficients.into_iter().map(|(re, _)| re).collect()
}

impl<M: Subject<D>, const D: usize> Certified<'_, M, D> {
    fn stays(&self) {
        let slowest = 1.0 - self.multipliers[0].abs();
        let bound = 1e-10 * self.size / slowest;
        for point in followed(self.system, self.point, (self.period, PERIODS)) {
            let away = self.metric.distance(&point, &self.point);
            assert!(away <= bound, "{:e} {slowest:e}: {:?}", away / self.size, self.system);
        }
    }

    /// Whether the orbit is an equilibrium, whose section is where it is left to.
    fn stands_still(&self) -> bool {
        let system = self.system.single();
        let weights = system.weights();
        let begins = M::Single::coordinates(&M::Single::state(self.point));
        let mut away = 0.0_f64;
        let cycles = Cycles { count: 1, tolerance: 1e-12 };
        let see = |step: &Step<f64, M::Single>| {
            let now = M::Single::coordinates(&system.at(&step.jet, step.length));
            for ((a, b), weight) in now.as_ref().iter().zip(begins.as_ref()).zip(weights.as_ref()) {
                away = away.max((weight * (a - b)).abs());
            }
        };
        let ended = returned(&system, self.point, &cycles, see);
        let may_rest = M::Single::AUTONOMOUS && ended != Err(Reason::NotFinite);
        may_rest && away < 1e-9 * self.size
    }

    fn has_least_period(&self) {
        let points = followed(self.system, self.point, (1, self.period as usize));
        let gap = |cycles: u64| self.metric.distance(&points[cycles as usize], &self.point);
        let closes = gap(self.period);
        for divisor in (1..self.period).filter(|&j| self.period.is_multiple_of(j)) {
            let (open, system) = (gap(divisor), self.system);
            assert!(open > 100.0 * closes && open > 1e-9 * self.size, "{open:e}: {system:?}");
        }
    }

    /// A push of this size in a random direction in which there is something.
    fn direction(&self, random: &mut Random, push: f64) -> [f64; D] {
        let push = std::array::from_fn(|i| {
            random.uniform(-1.0, 1.0) * push * self.size / self.metric.scales[i]
        });
        if self.may_be_pushed(&push) { push } else { push.map(|x| -x) }
    }

    fn may_be_pushed(&self, push: &[f64; D]) -> bool {
        self.system.may_start(&self.pushed(push))
    }

    fn pushed(&self, push: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|i| self.point[i] + push[i])
    }

    /// How a push goes on: differences from the orbit, period by period.
    fn answers(&self, push: &[f64; D], periods: usize) -> Vec<[f64; D]> {
        let span = (self.period, periods);
        let [still, moved] =
            [self.point, self.pushed(push)].map(|point| followed(self.system, point, span));
        let differences = moved.iter().zip(&still);
        differences.map(|(a, b)| self.metric.difference(a, b)).collect()
    }

    /// How far the answer to each of the pushes is from one that the multipliers allow: after Cayley and Hamilton
    /// the differences satisfy the characteristic polynomial of the Jacobian.
    ///
    /// Each push is tried both both: a capsule that static friction alone holds at the section is let go by one of them.
    fn misses(&self, random: &mut Random) -> [f64; PUSHES.len()] {
        let coefficients = polynomial(&self.multipliers);
        PUSHES.map(|push| {
            let push = self.direction(random, push);
            let both = [push, push.map(|x| -x)].into_iter();
            let misses = both.filter(|push| self.may_be_pushed(push)).map(|push| {
                let answers = self.answers(&push, D);
                let sum = std::array::from_fn(|i| {
                    let terms = coefficients.iter().zip(answers.iter().rev());
                    terms.map(|(coefficient, answer)| coefficient * answer[i]).sum()
                });
                // A push that grows before it dies is told as closely as it is large.
                let sizes = answers.iter().map(|answer| self.metric.length(answer));
                self.metric.length(&sum) / sizes.fold(0.0, f64::max)
            });
            misses.fold(f64::INFINITY, f64::min)
        })
    }

    /// The rate at which a push dies out and the largest multiplier, where one is to be told from the other.
    fn rate(&self, random: &mut Random) -> Option<(f64, f64)> {
        let [first, second] = [0, 1].map(|i| self.multipliers.get(i).map_or(0.0, |it| it.abs()));
        if first < 1e-3 || second > 0.7 * first {
            return None;
        }
        // Far enough for the second multiplier to be gone, of which a push may have some times as much, and not so far that rounding is met.
        let settled =
            if second == 0.0 { 1.0 } else { (0.01_f64.ln() / (second / first).ln()).ceil() };
        let last = (1e-4_f64.ln() / first.ln()).floor().min(settled + 20.0);
        if last <= settled {
            return None;
        }
        // The middle one of three: a push may have next to nothing along the slowest direction, or let go a capsule that static
        // friction alone holds at the section.
        let rate_of = |push: &[f64; D]| {
            let answers = self.answers(push, last as usize);
            let sizes = [settled, last].map(|n| self.metric.length(&answers[n as usize]));
            (sizes[1] / sizes[0]).powf(1.0 / (last - settled))
        };
        // Where an orbit lies at the end of places at which the capsule rests, a push to one side stays.
        let mut rates = [(); 3].map(|()| {
            let push = self.direction(random, 1e-5);
            let both = [push, push.map(|x| -x)].into_iter();
            let rates = both.filter(|push| self.may_be_pushed(push)).map(|push| rate_of(&push));
            rates.fold(f64::INFINITY, |near, rate| {
                if (rate - first).abs() < (near - first).abs() { rate } else { near }
            })
        });
        rates.sort_by(f64::total_cmp);
        Some((rates[1], first))
    }
}

/// What is certified, of an orbit that is.
fn certified<'a, M: Subject<D>, const D: usize>(
    system: &'a M,
    orbit: &OrbitOf<M, D>,
) -> Option<Certified<'a, M, D>> {
    let is_one = orbit.outcome == Outcome::Periodic && orbit.certificate.proof == Proof::Newton;
    is_one.then(|| Certified {
        system,
        metric: system.metric(),
        point: orbit.section[0],
        size: orbit.size,
        period: orbit.period,
        multipliers: orbit.multipliers().try_into().expect("one for each coordinate"),
    })
}

/// What is certified by Newton's method is so by brute force.
pub fn certificates<M: Subject<D>, const D: usize>() {
    let cases = M::rich_draws(count(60), 1000);
    let protocol = Protocol::default();
    let mut random = Random::new(17);
    let (mut proven, mut rates, mut cornered) = (0, 0, 0);
    for case in &cases {
        let orbit = settle(case, &protocol);
        let Some(it) = certified(&case.system, &orbit) else { continue };
        let (system, period, multipliers) = (&case.system, it.period, &it.multipliers);
        assert!(orbit.certificate.is_stable(), "{multipliers:?}: {system:?}");
        // The return map of an autonomous system has no derivative at an equilibrium.
        if it.stands_still() {
            continue;
        }
        it.stays();
        it.has_least_period();
        let misses = it.misses(&mut random);
        let miss = misses.into_iter().fold(f64::INFINITY, f64::min);
        let has_corner = miss >= LINEAR && M::CORNERS > 0;
        cornered += usize::from(has_corner);
        assert!(miss < LINEAR || has_corner, "{miss:e} {period} {multipliers:?}: {system:?}");
        // Beside an orbit of a long period the push by which a rate is told may lead to another orbit.
        let rate = if misses[0] < LINEAR { it.rate(&mut random) } else { None };
        if let Some((rate, first)) = rate {
            let is_told = (rate / first - 1.0).abs() < 0.1;
            cornered += usize::from(!is_told);
            let is_allowed = is_told || M::CORNERS > 0;
            assert!(is_allowed, "{rate} {multipliers:?}: {system:?}");
            rates += 1;
        }
        proven += 1;
    }
    println!(
        "{proven} of {} are certified, {rates} rates compared, {cornered} at corners",
        cases.len()
    );
    assert!(100 * cornered <= M::CORNERS * proven, "{cornered} of {proven} lie at corners");
    // A cycle of one coordinate that sticks has no rate: one period removes a push, which the multiplier says.
    assert!(3 * proven >= cases.len(), "{proven} are certified");
    assert!(rates > 0 || D == 1, "no rate was compared");
}
