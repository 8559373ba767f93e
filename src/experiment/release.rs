//! The free vibration of a mass that is held, and let go at rest: the decay from the moment of its release on.

use super::estimate::chance_of_ratio;
use super::least_squares::{Fit, Model, Residuals, Search, fit};

/// The model of a release does not describe a record where chance alone leaves as much of it with a lower probability.
const DOUBTFUL: f64 = 0.01;

/// A fitted decay that begins with a release.
pub(super) struct Released {
    /// Stiffness, damping, how far from rest the mass was held, when it was let go, and the rest position.
    pub fit: Fit,
    /// Amplitudes of cos and sin of the decay from its release on [m].
    pub amplitudes: [f64; 2],
}

/// A fit of a part of a record, after the mass has first passed its rest position.
pub(super) struct Later<'f> {
    /// Stiffness, damping, the amplitudes of cos and sin at the first sample of that part, and the rest position.
    pub fit: &'f Fit,
    /// The first sample of that part.
    pub first: usize,
}

/// The fit to a whole record of a mass that is held for a while, perhaps, and let go at rest; none where the record is not described so.
///
/// # Method
///
/// `r = rest + A` up to the time t0, and from there `rest + A exp(-gamma s) (cos(omega s) + gamma/omega sin(omega s))` with s = t - t0,
/// by least squares on all samples. The search begins with the last turning point before the part that `later` describes. It has as many
/// unknowns as `later`, and every sample before that part is one more datum.
///
/// # Guarantees
///
/// What the samples before that part leave of the model scatters no more than what the later ones leave, by an F-test of all of them and one
/// of those after the release: a mass that is pushed, or let go slowly, is told by it unless that is within the noise.
pub(super) fn released(times: &[f64], r: &[f64], m1: f64, later: Later<'_>) -> Option<Released> {
    let Later { fit: known, first } = later;
    let model = Release { times, r, m1 };
    let start = model.start(known, first)?;
    let fit = fit(&model, &start, &Search::free(5))?;
    let [k1, c, height, at] = [0, 1, 2, 3].map(|it| fit.parameters[it]);
    let gamma = c / (2.0 * m1);
    // Of a decay that does not oscillate this is no number.
    let omega = (k1 / m1 - gamma * gamma).sqrt();
    let residuals = model.residuals(&fit.parameters)?.values;
    let deviation = known.sum_of_squares / known.degrees_of_freedom.max(1) as f64;
    let after = times.partition_point(|time| *time < at).min(first);
    let is_likely = |left: f64, count: usize| {
        let ratio = left / count.max(1) as f64 / deviation;
        count == 0 || chance_of_ratio(ratio, [count, known.degrees_of_freedom]) >= DOUBTFUL
    };
    let squares: f64 = residuals[after..first].iter().map(|it| it * it).sum();
    let fits = is_likely(fit.sum_of_squares - known.sum_of_squares, first)
        && is_likely(squares, first - after);
    let amplitudes = [height, height * gamma / omega];
    (omega > 0.0 && fits).then_some(Released { fit, amplitudes })
}

/// A record with the release of a mass.
struct Release<'r> {
    times: &'r [f64],
    r: &'r [f64],
    m1: f64,
}

impl Release<'_> {
    /// The release that leads to a decay: its last turning point before its first sample.
    fn start(&self, known: &Fit, first: usize) -> Option<[f64; 5]> {
        let [k1, c, a, b, rest] = [0, 1, 2, 3, 4].map(|it| known.parameters[it]);
        let gamma = c / (2.0 * self.m1);
        let omega = (k1 / self.m1 - gamma * gamma).sqrt();
        if !omega.is_finite() {
            return None;
        }
        let pi = std::f64::consts::PI;
        let angle = (b * omega - a * gamma).atan2(b * gamma + a * omega);
        let angle = angle - pi * (angle / pi).ceil();
        let height = (-gamma * angle / omega).exp() * (a * angle.cos() + b * angle.sin());
        Some([k1, c, height, self.times[first] + angle / omega, rest])
    }
}

impl Model for Release<'_> {
    fn residuals(&self, parameters: &[f64]) -> Option<Residuals> {
        let rows = self.times.iter().zip(self.r).map(|(time, r)| {
            let (value, slopes) = displacement(self.m1, parameters, *time);
            (value - r, slopes.to_vec())
        });
        let (values, slopes) = rows.unzip();
        Some(Residuals { values, slopes })
    }
}

/// The displacement at a time, with its slopes in stiffness, damping, height, time of release and rest position.
fn displacement(m1: f64, parameters: &[f64], time: f64) -> (f64, [f64; 5]) {
    let [k1, c, height, at, rest] = [0, 1, 2, 3, 4].map(|i| parameters[i]);
    let since = time - at;
    if since <= 0.0 {
        return (rest + height, [0.0, 0.0, 1.0, 0.0, 1.0]);
    }
    let gamma = c / (2.0 * m1);
    // Where the search has left the oscillating decays, the least frequency stands for the others.
    let omega = (k1 / m1 - gamma * gamma).max(1e-12).sqrt();
    let (sin, cos) = (omega * since).sin_cos();
    let envelope = (-gamma * since).exp();
    let share = gamma / omega;
    let wave = cos + share * sin;
    let by_omega = since * (share * cos - sin) - share / omega * sin;
    let by_gamma = -since * wave + sin / omega;
    let by_k1 = by_omega / (2.0 * m1 * omega);
    let by_c = (by_gamma - by_omega * share) / (2.0 * m1);
    // The mass moves with this velocity, and is as far as it was that much earlier.
    let velocity = -height * envelope * (omega + gamma * share) * sin;
    let by_both = [by_k1, by_c].map(|it| height * envelope * it);
    (rest + height * envelope * wave, [by_both[0], by_both[1], envelope * wave, -velocity, 1.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRUTH: [f64; 5] = [1420.0, 3.89, 2e-3, 0.02, 1e-4];
    const M1: f64 = 0.11;

    #[test]
    fn slopes_are_those_of_differences() {
        for time in [0.0102, 0.0231, 0.0517] {
            let (_, slopes) = displacement(M1, &TRUTH, time);
            for i in 0..5 {
                let step = 1e-6 * TRUTH[i].abs();
                let [mut above, mut below] = [TRUTH, TRUTH];
                above[i] += step;
                below[i] -= step;
                let [above, below] = [above, below].map(|it| displacement(M1, &it, time).0);
                let by = (above - below) / (2.0 * step);
                let scale = slopes[i].abs().max(1e-9);
                assert!((by - slopes[i]).abs() <= 1e-5 * scale, "{time} {i}: {by} {}", slopes[i]);
            }
        }
    }
}
