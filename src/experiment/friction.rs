//! Friction coefficients from pull tests and coasting tests.

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
    let pairs = || tests.speeds.iter().zip(tests.distances);
    let coefficients: Vec<f64> = pairs().map(|(v, d)| v * v / (2.0 * tests.g * d)).collect();
    let at_speed = |v_s: f64| {
        let alone = |(v, mu): (&f64, &f64)| {
            let decay = (-v / v_s).exp();
            [(mu / (1.0 + decay)).ln(), -decay * v / (v_s * v_s) / (1.0 + decay)]
        };
        tests.speeds.iter().zip(&coefficients).map(alone).collect()
    };
    let slid = |v_s: f64| {
        let alone = |(&v, d): (&f64, &f64)| {
            let (distance, slopes) = coast_down(v, 1.0, v_s, tests.g);
            [(distance / d).ln(), slopes[1] / distance]
        };
        pairs().map(alone).collect()
    };
    let by_initial_speed = ScaleFit { logarithms: &at_speed, count }.law();
    let by_coast_down = ScaleFit { logarithms: &slid, count }.law();
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
    all.extend(outliers(residuals, 2).iter().map(Outlier::to_string));
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
    /// The logarithm of the scale that each test alone gives at a shape, with its slope in the shape.
    logarithms: &'a dyn Fn(f64) -> Vec<[f64; 2]>,
    /// Tests.
    count: usize,
}

/// Grid points of the shape per decade.
const PER_DECADE: usize = 40;
/// Points of a range of shapes among which the ends of the scale are looked for.
const IN_RANGE: usize = 200;
/// Relative errors that rounding alone gives.
const ROUNDING: f64 = 1e-13;

impl ScaleFit<'_> {
    /// The mean logarithm of the scale and the sum of squares at the logarithm of a shape.
    fn at(&self, u: f64) -> (f64, f64) {
        let all = (self.logarithms)(u.exp());
        let mean = all.iter().map(|it| it[0]).sum::<f64>() / self.count as f64;
        (mean, all.iter().map(|it| (it[0] - mean).powi(2)).sum())
    }

    fn law(&self) -> Stribeck {
        let nodes = self.nodes();
        let best = nodes.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
        let (u, least) = best.expect("the grid is not empty");
        let freedom = self.count - 2;
        let floor = self.count as f64 * ROUNDING * ROUNDING;
        let t = student(freedom);
        let limit = least + (t * t * least / freedom as f64).max(floor);
        let shapes = self.shapes(&nodes, limit);
        let scales = merged(shapes.iter().map(|ends| self.scales(*ends, limit)).collect());
        let bounds = V_S.map(f64::ln);
        let v_s_ranges: Vec<[f64; 2]> =
            shapes.iter().map(|it| it.map(|u| u.exp().clamp(V_S[0], V_S[1]))).collect();
        let verdicts = verdicts(&shapes, &scales, bounds);
        let errors = self.errors(u, (least / freedom as f64).sqrt());
        let estimate = |value, ranges: &[[f64; 2]], verdict, error| Estimate {
            value,
            standard_error: if verdict == Verdict::Determined { error } else { f64::INFINITY },
            interval: [ranges[0][0], ranges[ranges.len() - 1][1]],
        };
        let mu_d = self.at(u).0.exp();
        // Where v_s has a limit on one side only, its error is infinite, and that of mu_d is told by its interval.
        let mu_d_error = match verdicts[1] {
            Verdict::Determined => mu_d * errors[0],
            _ => (scales[scales.len() - 1][1] - scales[0][0]) / (2.0 * t),
        };
        let mean = self.at(u).0;
        Stribeck {
            mu_d: estimate(mu_d, &scales, verdicts[0], mu_d_error),
            v_s: estimate(u.exp(), &v_s_ranges, verdicts[1], errors[1]),
            verdicts,
            ranges: [scales, v_s_ranges],
            residuals: (self.logarithms)(u.exp()).iter().map(|it| it[0] - mean).collect(),
            scatter: (least / freedom as f64).sqrt(),
        }
    }

    /// The grid with the refined minima: logarithms of shapes, rising, with their sums of squares.
    fn nodes(&self) -> Vec<(f64, f64)> {
        let [first, last] = V_S.map(f64::ln);
        let count = (PER_DECADE as f64 * (last - first) / std::f64::consts::LN_10).round() as usize;
        let node = |i: usize| first + (last - first) * i as f64 / count as f64;
        let grid: Vec<(f64, f64)> = (0..=count).map(node).map(|u| (u, self.at(u).1)).collect();
        let minima = grid.windows(3).filter(|it| it[1].1 <= it[0].1 && it[1].1 <= it[2].1);
        let sum = |u: f64| self.at(u).1;
        let refined: Vec<(f64, f64)> = minima.map(|it| least(&sum, [it[0].0, it[2].0])).collect();
        let mut nodes = [grid, refined].concat();
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        nodes
    }

    /// The ranges of the logarithm of the shape within the limit.
    fn shapes(&self, nodes: &[(f64, f64)], limit: f64) -> Vec<[f64; 2]> {
        let is_within = |sum: f64| sum <= limit;
        let mut ranges: Vec<[f64; 2]> = Vec::new();
        for (i, &(u, sum)) in nodes.iter().enumerate() {
            if !is_within(sum) {
                continue;
            }
            let joins = i > 0 && is_within(nodes[i - 1].1);
            let below = if i == 0 || joins { u } else { self.crossing(u, nodes[i - 1].0, limit) };
            let above = match nodes.get(i + 1) {
                Some(next) if !is_within(next.1) => self.crossing(u, next.0, limit),
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
    fn scales(&self, [first, last]: [f64; 2], limit: f64) -> [f64; 2] {
        let end = |sign: f64| {
            let depth = |u: f64| {
                let (mean, sum) = self.at(u);
                -sign * mean - ((limit - sum).max(0.0) / self.count as f64).sqrt()
            };
            let node = |i: usize| first + (last - first) * i as f64 / IN_RANGE as f64;
            let nodes = (0..=IN_RANGE).map(|i| (i, depth(node(i))));
            let (i, lowest) = nodes.min_by(|a, b| a.1.total_cmp(&b.1)).expect("nodes");
            let around = [node(i.saturating_sub(1)), node((i + 1).min(IN_RANGE))];
            (-sign * least(&depth, around).1.min(lowest)).exp()
        };
        [end(-1.0), end(1.0)]
    }

    /// The standard errors of the logarithm of the scale and of the shape, for this scatter, from the slopes.
    fn errors(&self, u: f64, scatter: f64) -> [f64; 2] {
        let all = (self.logarithms)(u.exp());
        let count = self.count as f64;
        let mean = all.iter().map(|it| it[1]).sum::<f64>() / count;
        let square: f64 = all.iter().map(|it| (it[1] - mean).powi(2)).sum();
        [scatter * (1.0 / count + mean * mean / square).sqrt(), scatter / square.sqrt()]
    }
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

/// The distance that a capsule slides from the speed `v` until it rests under the Coulomb-Stribeck law [m], and its slopes in
/// mu_d and v_s.
pub fn coast_down(v: f64, mu_d: f64, v_s: f64, g: f64) -> (f64, [f64; 2]) {
    let z = v / v_s;
    let distance = v_s * v_s / (mu_d * g) * slid(z);
    let by_speed = v / (mu_d * g * (1.0 + (-z).exp()));
    (distance, [-distance / mu_d, (2.0 * distance - v * by_speed) / v_s])
}

/// The integral of `u/(1 + exp(-u))` from 0 to z.
///
/// Method: `u/(1 + e^-u) = u - u/(1 + e^u)`. The second part is integrated by Gauss's rule of five points on panels of a
/// quarter up to 1; beyond, it is `pi^2/12` less the integral from z on, the sum over k from 1 of
/// `(-1)^(k+1) e^(-kz) (z/k + 1/k^2)`. Error: below 1e-13 relative.
fn slid(z: f64) -> f64 {
    if z < 0.05 {
        // The series about zero, as the difference would lose digits.
        return z * z / 4.0 + z.powi(3) / 12.0 - z.powi(5) / 240.0 + z.powi(7) / 3360.0;
    }
    if z < 1.0 {
        return 0.5 * z * z - quadrature(z);
    }
    let (mut beyond, decay) = (0.0, -(-z).exp());
    let mut power = -1.0;
    for k in 1..=(38.0 / z).ceil() as u32 {
        let k = f64::from(k);
        power *= decay;
        beyond += power * (z / k + 1.0 / (k * k));
    }
    0.5 * z * z - (std::f64::consts::PI.powi(2) / 12.0 - beyond)
}

/// The integral of `u/(1 + exp(u))` from 0 to z by Gauss's rule.
fn quadrature(z: f64) -> f64 {
    const RULE: [(f64, f64); 3] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let panels = (4.0 * z).ceil();
    let half = 0.5 * z / panels;
    let integrand = |u: f64| u / (1.0 + u.exp());
    let mut sum = 0.0;
    for panel in 0..panels as u32 {
        let centre = (2.0 * f64::from(panel) + 1.0) * half;
        for (node, weight) in RULE {
            let both = integrand(centre + node * half) + integrand(centre - node * half);
            sum += weight * half * if node == 0.0 { 0.5 * both } else { both };
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_small_steps() {
        for (v, v_s) in [(0.01, 0.3), (0.4, 0.3), (2.0, 0.05), (5.0, 0.1)] {
            let steps = 200_000;
            let h = v / f64::from(steps);
            let rate = |u: f64| u / (0.33 * 9.81 * (1.0 + (-u / v_s).exp()));
            // Simpson's rule.
            let sum: f64 = (0..steps)
                .map(|i| {
                    let u = f64::from(i) * h;
                    (rate(u) + 4.0 * rate(u + 0.5 * h) + rate(u + h)) * h / 6.0
                })
                .sum();
            let (found, slopes) = coast_down(v, 0.33, v_s, 9.81);
            assert!((found / sum - 1.0).abs() < 1e-12, "{v} {v_s}: {found} {sum}");
            let step = 1e-5 * v_s;
            let by = (coast_down(v, 0.33, v_s + step, 9.81).0
                - coast_down(v, 0.33, v_s - step, 9.81).0)
                / (2.0 * step);
            assert!((by - slopes[1]).abs() < 1e-7 * slopes[1].abs(), "{by} {}", slopes[1]);
        }
    }

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
