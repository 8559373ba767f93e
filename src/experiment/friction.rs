//! Friction coefficients from pull tests and coasting tests.

pub use super::coast_down::coast_down;
use super::estimate::{Estimate, reach, student};
use super::line::{Outlier, chance_of_parabola, line, outliers};
use super::profile::{Verdict, least, merged};

/// The static friction coefficient from the masses that just moved a rig of mass `rig` [kg], one per test: the mean of their
/// ratios, with the standard error of the mean.
pub fn static_friction(pulled: &[f64], rig: f64) -> Estimate {
    let ratios: Vec<f64> = pulled.iter().map(|mass| mass / rig).collect();
    Estimate::mean(&ratios)
}

/// Tests in which the capsule was given a speed [m/s] and slid a distance [m] until it rested.
#[derive(Debug, Clone, Copy)]
pub struct CoastingTests<'a> {
    /// The initial speed of each [m/s].
    pub speeds: &'a [f64],
    /// The distance of each [m].
    pub distances: &'a [f64],
    /// Acceleration of gravity [m/s^2].
    pub g: f64,
}

impl CoastingTests<'_> {
    /// `v^2/(2 g d)` of each, Eq. (2) of the paper.
    fn coefficients(&self) -> Vec<f64> {
        let pairs = self.speeds.iter().zip(self.distances);
        pairs.map(|(v, d)| v * v / (2.0 * self.g * d)).collect()
    }
}

/// The dynamic friction coefficient and the Stribeck velocity by one method.
#[derive(Debug, Clone, PartialEq)]
pub struct Stribeck {
    /// The dynamic friction coefficient; without a standard error where it is not determined.
    pub mu_d: Estimate,
    /// The Stribeck velocity [m/s]; without a standard error where it is not determined.
    pub v_s: Estimate,
    /// Whether the tests determine either.
    pub verdicts: [Verdict; 2],
    /// The separate ranges of either that agree with the tests, rising: mu_d, and v_s [m/s]. An interval is their hull.
    pub ranges: [Vec<[f64; 2]>; 2],
    /// Relative residuals, by test.
    pub residuals: Vec<f64>,
    /// Standard deviation of the relative residuals.
    pub scatter: f64,
}

/// What the coasting tests say.
#[derive(Debug, Clone, PartialEq)]
pub struct Coasting {
    /// `v^2/(2 g d)` of each test, Eq. (2) of the paper.
    pub coefficients: Vec<f64>,
    /// By the law at the initial speeds, through those coefficients: the paper's method.
    pub by_initial_speed: Stribeck,
    /// By the distances of a capsule that slows down under the law: without the first one's bias.
    pub by_coast_down: Stribeck,
    /// How the tests contradict the law, a sentence each.
    pub misfits: Vec<String>,
}

/// The Stribeck velocities among which it is looked for [m/s].
pub const V_S: [f64; 2] = [1e-4, 100.0];

/// The Coulomb-Stribeck law `mu_d (1 + exp(-|v|/v_s))` from coasting tests, in two methods.
///
/// # Method
///
/// Eq. (2) of the paper, `mu_d (m1 + m2) g d = (m1 + m2) v^2/2`, gives a coefficient for each test, as if friction did not
/// depend on speed. The first method fits the law at the initial speeds to these coefficients. As a capsule that slows down
/// meets more friction than at its initial speed, that is biased. The second method fits the distance that it slides,
/// `d = v_s^2/(mu_d g) G(v/v_s)` with `G(z)` the integral of `u/(1 + exp(-u))` from 0 to z. Both fit logarithms, so errors of
/// speed and distance are taken to be relative and equal. With v_s given, mu_d is the geometric mean of what each test gives;
/// v_s is looked for over all of [`V_S`]. The ranges are those of the profile likelihood, see `ScaleFit`.
///
/// # Breaks
///
/// An error says so where there are fewer than four tests. Friction that hardly changes over the tested speeds is described by
/// a small v_s with `mu_d` as well as by a large v_s with half of it: then the ranges are several and no value is determined.
pub fn coasting(tests: &CoastingTests<'_>) -> Result<Coasting, String> {
    let count = tests.speeds.len();
    if count < 4 {
        return Err(format!(
            "{count} coasting tests; at least 4 are needed for two parameters and their uncertainty"
        ));
    }
    let by_initial_speed = ScaleFit { tests, method: Method::InitialSpeed }.law();
    let by_coast_down = ScaleFit { tests, method: Method::CoastDown }.law();
    let coefficients = tests.coefficients();
    let misfits = misfits(tests.speeds, &coefficients, &by_coast_down.residuals);
    Ok(Coasting { by_initial_speed, by_coast_down, coefficients, misfits })
}

/// A misfit is told where chance alone gives it with less than this probability.
const UNLIKELY: f64 = 0.01;
/// The same of a coefficient that rises with speed, where nothing else contradicts the law.
const RISING: f64 = 0.001;

/// How coasting tests contradict a law that falls with speed.
///
/// Method: a line through `v^2/(2 g d)` over v that rises; the F test of a parabola in ln v in what the law leaves; residuals
/// far beyond the others.
fn misfits(speeds: &[f64], coefficients: &[f64], residuals: &[f64]) -> Vec<String> {
    let mut all = Vec::new();
    let logarithms: Vec<f64> = speeds.iter().map(|v| v.ln()).collect();
    let chance = chance_of_parabola(&logarithms, residuals).filter(|chance| *chance < UNLIKELY);
    let confidence = 1.0 - if chance.is_some() { UNLIKELY } else { RISING };
    let far = reach(speeds.len() - 2, confidence);
    let rise = line(speeds, coefficients).map(|it| it.slope);
    let rise = rise.filter(|it| it.value > 0.0 && it.value > far * it.standard_error);
    if rise.is_some() {
        all.push(
            "friction rises with speed, but the Coulomb-Stribeck law can only fall: it does not describe these tests"
                .to_owned(),
        );
    } else if let Some(chance) = chance {
        all.push(format!(
            "the Coulomb-Stribeck law does not describe the change of friction with speed (chance {chance:.1e})"
        ));
    }
    all.extend(outliers(residuals, 2, 0.0).iter().map(Outlier::to_string));
    all
}

/// The fit of a law that is a scale times a function of one shape parameter, here mu_d and v_s.
///
/// # Method
///
/// With the shape given, each test alone gives a scale; the logarithm of the fitted scale is their mean m, and the sum of
/// squares S is that of their deviations. So S is a function of the shape alone. It is computed over a logarithmic grid of the
/// shape, each of its minima is refined by golden section, and the least is taken. A shape agrees with the tests where
/// S has grown by no more than `t^2 S/n`, with Student's t for the n degrees of freedom; a scale, where some shape has
/// `S + N (ln scale - m)^2` within the same limit, for N tests.
///
/// # Source
///
/// The separable problem: Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973). The profile likelihood: Raue and others,
/// Bioinformatics 25 (2009).
///
/// # Assumes
///
/// At least three tests, independent relative errors of equal scatter.
///
/// # Guarantees
///
/// All ranges that reach over a grid point or hold a minimum of S are found, their ends to 1e-12 of the shape.
///
/// # Breaks
///
/// Minima that are closer than the grid's 6 % are taken for one.
struct ScaleFit<'a> {
    tests: &'a CoastingTests<'a>,
    method: Method,
}

/// What a coasting test is taken to measure.
#[derive(Clone, Copy)]
enum Method {
    /// The friction at its initial speed.
    InitialSpeed,
    /// The distance of a capsule that slows down.
    CoastDown,
}

/// Grid points of the shape per decade.
const PER_DECADE: usize = 40;
/// Points of a range of shapes among which the ends of the scale are looked for.
const IN_RANGE: usize = 200;
/// Relative errors that rounding alone gives.
const ROUNDING: f64 = 1e-13;

impl ScaleFit<'_> {
    /// Tests.
    fn count(&self) -> usize {
        self.tests.speeds.len()
    }

    /// The logarithm of mu_d that each test alone gives at a v_s, with its slope in v_s.
    fn logarithms(&self, v_s: f64) -> Vec<[f64; 2]> {
        let CoastingTests { speeds, distances, g } = *self.tests;
        match self.method {
            Method::InitialSpeed => {
                let coefficients = self.tests.coefficients();
                let pairs = speeds.iter().zip(&coefficients);
                let alone = pairs.map(|(v, mu)| {
                    let decay = (-v / v_s).exp();
                    [(mu / (1.0 + decay)).ln(), -decay * v / (v_s * v_s) / (1.0 + decay)]
                });
                alone.collect()
            }
            Method::CoastDown => {
                let alone = speeds.iter().zip(distances).map(|(&v, d)| {
                    let (distance, slopes) = coast_down(v, 1.0, v_s, g);
                    [(distance / d).ln(), slopes[1] / distance]
                });
                alone.collect()
            }
        }
    }

    /// The mean logarithm of the scale and the sum of squares at the logarithm of a shape.
    fn at(&self, u: f64) -> (f64, f64) {
        let all = self.logarithms(u.exp());
        let mean = all.iter().map(|it| it[0]).sum::<f64>() / self.count() as f64;
        (mean, all.iter().map(|it| (it[0] - mean).powi(2)).sum())
    }

    fn law(&self) -> Stribeck {
        let nodes = self.nodes();
        let best = nodes.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
        let (u, least) = best.expect("the grid is not empty");
        let freedom = self.count() - 2;
        let floor = self.count() as f64 * ROUNDING * ROUNDING;
        let t = student(freedom);
        let limit = least + (t * t * least / freedom as f64).max(floor);
        let shapes = self.shapes(&nodes, limit);
        let scales = merged(shapes.iter().map(|ends| self.scales(*ends, limit)).collect());
        let bounds = V_S.map(f64::ln);
        let v_s_ranges: Vec<[f64; 2]> =
            shapes.iter().map(|it| it.map(|u| u.exp().clamp(V_S[0], V_S[1]))).collect();
        let verdicts = verdicts(&shapes, &scales, bounds);
        let errors = self.errors(u, (least / freedom as f64).sqrt());
        let mu_d = self.at(u).0.exp();
        // Where v_s has a limit on one side only, its error is infinite, and that of mu_d is told by its interval.
        let mu_d_error = match verdicts[1] {
            Verdict::Determined => mu_d * errors[0],
            _ => (scales[scales.len() - 1][1] - scales[0][0]) / (2.0 * t),
        };
        let mean = self.at(u).0;
        Stribeck {
            mu_d: estimate(mu_d, mu_d_error, &scales, verdicts[0]),
            v_s: estimate(u.exp(), errors[1], &v_s_ranges, verdicts[1]),
            verdicts,
            ranges: [scales, v_s_ranges],
            residuals: self.logarithms(u.exp()).iter().map(|it| it[0] - mean).collect(),
            scatter: (least / freedom as f64).sqrt(),
        }
    }

    /// The grid with the refined minima: logarithms of shapes, rising, with their sums of squares.
    fn nodes(&self) -> Vec<(f64, f64)> {
        let ends = V_S.map(f64::ln);
        let count = PER_DECADE as f64 * (ends[1] - ends[0]) / std::f64::consts::LN_10;
        let count = count.round() as usize;
        let shapes = (0..=count).map(|i| node(ends, i, count));
        let grid: Vec<(f64, f64)> = shapes.map(|u| (u, self.at(u).1)).collect();
        let minima = grid.windows(3).filter(|it| it[1].1 <= it[0].1 && it[1].1 <= it[2].1);
        let refined = minima.map(|it| least(&|u| self.at(u).1, [it[0].0, it[2].0]));
        let refined: Vec<(f64, f64)> = refined.collect();
        let mut nodes = [grid, refined].concat();
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        nodes
    }

    /// The ranges of the logarithm of the shape within the limit.
    fn shapes(&self, nodes: &[(f64, f64)], limit: f64) -> Vec<[f64; 2]> {
        let is_within: Vec<bool> = nodes.iter().map(|(_, sum)| *sum <= limit).collect();
        let mut ranges: Vec<[f64; 2]> = Vec::new();
        for (i, &(u, _)) in nodes.iter().enumerate() {
            if !is_within[i] {
                continue;
            }
            let joins = i > 0 && is_within[i - 1];
            let below = if i == 0 || joins { u } else { self.crossing(u, nodes[i - 1].0, limit) };
            let above = match nodes.get(i + 1) {
                Some(next) if !is_within[i + 1] => self.crossing(u, next.0, limit),
                _ => u,
            };
            match ranges.last_mut() {
                Some(last) if joins => last[1] = above,
                _ => ranges.push([below, above]),
            }
        }
        ranges
    }

    /// Where the sum of squares passes the limit between a shape within it and one beyond.
    fn crossing(&self, mut within: f64, mut beyond: f64, limit: f64) -> f64 {
        for _ in 0..45 {
            let middle = 0.5 * (within + beyond);
            if self.at(middle).1 <= limit { within = middle } else { beyond = middle }
        }
        within
    }

    /// The range of the scale over a range of shapes.
    fn scales(&self, shapes: [f64; 2], limit: f64) -> [f64; 2] {
        [-1.0, 1.0].map(|sign| self.end_of_scale(shapes, limit, sign))
    }

    /// The least (for sign -1) or greatest scale over a range of shapes.
    fn end_of_scale(&self, shapes: [f64; 2], limit: f64, sign: f64) -> f64 {
        let nodes = (0..=IN_RANGE).map(|i| (i, self.depth(node(shapes, i, IN_RANGE), limit, sign)));
        let (i, lowest) = nodes.min_by(|a, b| a.1.total_cmp(&b.1)).expect("nodes");
        let around = [i.saturating_sub(1), (i + 1).min(IN_RANGE)];
        let around = around.map(|i| node(shapes, i, IN_RANGE));
        (-sign * least(&|u| self.depth(u, limit, sign), around).1.min(lowest)).exp()
    }

    /// What is least where the logarithm of the scale within the limit is greatest, or, for sign -1, least.
    fn depth(&self, u: f64, limit: f64, sign: f64) -> f64 {
        let (mean, sum) = self.at(u);
        -sign * mean - ((limit - sum).max(0.0) / self.count() as f64).sqrt()
    }

    /// The standard errors of the logarithm of the scale and of the shape, for this scatter, from the slopes.
    fn errors(&self, u: f64, scatter: f64) -> [f64; 2] {
        let all = self.logarithms(u.exp());
        let count = self.count() as f64;
        let mean = all.iter().map(|it| it[1]).sum::<f64>() / count;
        let square: f64 = all.iter().map(|it| (it[1] - mean).powi(2)).sum();
        [scatter * (1.0 / count + mean * mean / square).sqrt(), scatter / square.sqrt()]
    }
}

/// A value whose standard error is known where the tests determine it, with the hull of the ranges that agree with them.
fn estimate(value: f64, error: f64, ranges: &[[f64; 2]], verdict: Verdict) -> Estimate {
    Estimate {
        value,
        standard_error: if verdict == Verdict::Determined { error } else { f64::INFINITY },
        interval: [ranges[0][0], ranges[ranges.len() - 1][1]],
    }
}

/// Node `i` of `count` even steps from the first to the last.
fn node([first, last]: [f64; 2], i: usize, count: usize) -> f64 {
    first + (last - first) * i as f64 / count as f64
}

/// What the ranges of the shape and of the scale say of the scale and the shape.
fn verdicts(shapes: &[[f64; 2]], scales: &[[f64; 2]], bounds: [f64; 2]) -> [Verdict; 2] {
    let is_limited = [shapes[0][0] > bounds[0], shapes[shapes.len() - 1][1] < bounds[1]];
    let shape = match shapes.len() {
        1 => Verdict::of_limits(is_limited),
        _ => Verdict::Several,
    };
    // Where every shape agrees with the tests, the scale follows from a shape that is not known.
    let scale = match (scales.len(), is_limited) {
        (1, [false, false]) => Verdict::NotDetermined,
        (1, _) => Verdict::Determined,
        _ => Verdict::Several,
    };
    [scale, shape]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_tests_give_the_law_and_the_method_of_the_paper_is_biased() {
        let speeds = [0.1, 0.2, 0.4, 0.6, 0.9, 1.3];
        let distances = speeds.map(|v| coast_down(v, 0.33, 0.3, 9.81).0);
        let tests = CoastingTests { speeds: &speeds, distances: &distances, g: 9.81 };
        let found = coasting(&tests).expect("a law");
        assert!((found.by_coast_down.mu_d.value - 0.33).abs() < 1e-7, "{found:?}");
        assert!((found.by_coast_down.v_s.value - 0.3).abs() < 1e-6, "{found:?}");
        assert!(found.by_initial_speed.v_s.value > 0.35, "{found:?}");
    }
}
