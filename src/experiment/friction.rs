//! Friction coefficients from pull tests and coasting tests.

use super::estimate::Estimate;
use super::least_squares::{Bounds, Fit, Residuals, Search, fit};
use super::profile::{Verdict, profile};

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
    /// The dynamic friction coefficient.
    pub mu_d: Estimate,
    /// The Stribeck velocity [m/s].
    pub v_s: Estimate,
    /// Whether the tests determine either.
    pub verdicts: [Verdict; 2],
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
}

/// The bounds within which the coefficients are looked for.
const MU_D: Bounds = Bounds { least: 1e-4, greatest: 5.0 };
/// The same of the Stribeck velocity [m/s].
const V_S: Bounds = Bounds { least: 1e-4, greatest: 100.0 };

/// The Coulomb-Stribeck law `mu_d (1 + exp(-|v|/v_s))` from coasting tests, in two methods.
///
/// # Method
///
/// Eq. (2) of the paper, `mu_d (m1 + m2) g d = (m1 + m2) v^2/2`, gives a coefficient for each test, as if friction did not
/// depend on speed. The first method fits the law at the initial speeds to these coefficients. As a capsule that slows down
/// meets more friction than at its initial speed, that is biased. The second method fits the distance that it slides,
/// `d = v_s^2/(mu_d g) G(v/v_s)` with `G(z)` the integral of `u/(1 + exp(-u))` from 0 to z. Both fit logarithms, so errors of speed and distance
/// are taken to be relative and equal. The intervals are those of the profile likelihood.
///
/// # Breaks
///
/// An error says so where there are fewer than four tests.
pub fn coasting(tests: &CoastingTests<'_>) -> Result<Coasting, String> {
    if tests.speeds.len() < 4 {
        let count = tests.speeds.len();
        return Err(format!(
            "{count} coasting tests; at least 4 are needed for two parameters and their uncertainty"
        ));
    }
    let pairs = || tests.speeds.iter().zip(tests.distances);
    let coefficients: Vec<f64> = pairs().map(|(v, d)| v * v / (2.0 * tests.g * d)).collect();
    let at_speed = |p: &[f64]| {
        let rows = tests.speeds.iter().zip(&coefficients).map(|(v, mu)| {
            let (mu_d, v_s) = (p[0], p[1]);
            let decay = (-v / v_s).exp();
            let by_v_s = decay * v / (v_s * v_s) / (1.0 + decay);
            ((mu_d * (1.0 + decay) / mu).ln(), vec![1.0 / mu_d, by_v_s])
        });
        let (values, slopes) = rows.unzip();
        Some(Residuals { values, slopes })
    };
    let slid = |p: &[f64]| {
        let rows = pairs().map(|(&v, d)| {
            let (distance, slopes) = coast_down(v, p[0], p[1], tests.g);
            ((distance / d).ln(), slopes.map(|it| it / distance).to_vec())
        });
        let (values, slopes) = rows.unzip();
        Some(Residuals { values, slopes })
    };
    let by_initial_speed = stribeck(&at_speed, tests)?;
    let by_coast_down = stribeck(&slid, tests)?;
    Ok(Coasting { by_initial_speed, by_coast_down, coefficients })
}

fn stribeck(
    model: &impl Fn(&[f64]) -> Option<Residuals>,
    tests: &CoastingTests<'_>,
) -> Result<Stribeck, String> {
    let search = Search { bounds: vec![MU_D, V_S], ..Search::free(2) };
    let mean = tests.speeds.iter().sum::<f64>() / tests.speeds.len() as f64;
    let starts = [0.1, 0.5, 2.0].map(|share| fit(model, &[0.3, share * mean], &search));
    let best: Option<Fit> =
        starts.into_iter().flatten().min_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
    let fit = best.ok_or("the law cannot be fitted to the coasting tests")?;
    let profiles = [0, 1].map(|which| profile(model, &fit, &search, which));
    let estimate = |i: usize| Estimate {
        value: fit.parameters[i],
        standard_error: fit.standard_error(i),
        interval: profiles[i].interval,
    };
    Ok(Stribeck {
        mu_d: estimate(0),
        v_s: estimate(1),
        verdicts: profiles.map(|it| it.verdict()),
        scatter: fit.residual_deviation(),
    })
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
/// Method: `u/(1 + e^-u) = u - u/(1 + e^u)`; the second part is integrated by Gauss's rule of five points on panels of a
/// quarter, to where it ends in rounding. Error: below 1e-14 relative.
fn slid(z: f64) -> f64 {
    const RULE: [(f64, f64); 3] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    if z < 0.05 {
        // The series about zero, as the difference would lose digits.
        return z * z / 4.0 + z.powi(3) / 12.0 - z.powi(5) / 240.0 + z.powi(7) / 3360.0;
    }
    let end = z.min(45.0);
    let panels = (4.0 * end).ceil();
    let half = 0.5 * end / panels;
    let integrand = |u: f64| u / (1.0 + u.exp());
    let mut rest = 0.0;
    for panel in 0..panels as u32 {
        let centre = (2.0 * f64::from(panel) + 1.0) * half;
        for (node, weight) in RULE {
            let both = integrand(centre + node * half) + integrand(centre - node * half);
            rest += weight * half * if node == 0.0 { 0.5 * both } else { both };
        }
    }
    0.5 * z * z - rest
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
