//! How far a capsule slides that slows down under the Coulomb-Stribeck law.

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

fn integrand(u: f64) -> f64 {
    u / (1.0 + u.exp())
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
}
