//! Frequency and phase of the drive, from a record of its force or of the motor's current.

use std::f64::consts::TAU;

use super::estimate::Estimate;
use super::least_squares::{Fit, Model, Residuals, Search, fit};
use super::periodogram::strongest;

/// A frequency is that of a study within so many standard errors.
const SAME: f64 = 4.0;

/// A harmonic `mean + amplitude cos(omega t + phase)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonic {
    /// Frequency [rad/s].
    pub omega: Estimate,
    /// Phase at t = 0 [rad], within -pi..pi.
    pub phase: Estimate,
    /// Amplitude, in the unit of the record.
    pub amplitude: Estimate,
    /// Mean, in the unit of the record.
    pub mean: f64,
    /// Standard deviation of what is left of the record.
    pub scatter: f64,
}

/// The frequency of a recorded drive beside that of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frequencies {
    /// That of the study lies within the interval of the recorded one.
    Same,
    /// It lies outside, but nearer than chance excludes, or so near that the phase is right over the record all the same.
    Apart,
    /// They differ.
    Differ,
}

impl Harmonic {
    /// Whether the frequency is `omega` [rad/s], as a phase over `span` [s] sees it.
    ///
    /// They differ where they are more than four standard errors apart, and the phase drifts by more than its standard error.
    pub fn beside(&self, omega: f64, span: f64) -> Frequencies {
        let apart = (self.omega.value - omega).abs();
        let drifts = apart * span > self.phase.standard_error;
        match self.omega.holds(omega) {
            true => Frequencies::Same,
            false if apart > SAME * self.omega.standard_error && drifts => Frequencies::Differ,
            false => Frequencies::Apart,
        }
    }
}

/// The harmonic that a record is nearest to.
///
/// # Method
///
/// From the strongest frequency (`strongest`), all constants are fitted by least squares.
///
/// # Breaks
///
/// An error says so where the record has fewer than sixteen samples, no variation, or less than a cycle and a half.
pub fn harmonic(times: &[f64], values: &[f64]) -> Result<Harmonic, String> {
    let count = times.len();
    if count < 16 {
        return Err(format!("{count} samples; at least 16 are needed to find the drive"));
    }
    let span = times[count - 1] - times[0];
    let mean = values.iter().sum::<f64>() / count as f64;
    let omega = strongest(times, values).ok_or("the record does not vary, so no drive is found")?;
    let fit = fit(&Driven { times, values }, &[omega, 0.0, 0.0, mean], &Search::free(4))
        .ok_or("the drive cannot be fitted")?;
    let [omega, a, b, mean] = [0, 1, 2, 3].map(|i| fit.parameters[i]);
    if omega * span < 1.5 * TAU {
        return Err("the record has less than a cycle and a half of the drive".to_owned());
    }
    // a cos + b sin = A cos(x + p), with A cos p = a and A sin p = -b; the slopes of p in (omega, a, b) at t = 0.
    let square = a * a + b * b;
    let by = [-times[0], b / square, -a / square];
    let amplitude = square.sqrt();
    let freedom = fit.degrees_of_freedom;
    let by_amplitude = [0.0, a / amplitude, b / amplitude];
    let phase = (-b).atan2(a) - omega * times[0];
    let phase = phase - TAU * (phase / TAU).round();
    Ok(Harmonic {
        omega: fit.estimate(0),
        phase: Estimate::of_student(phase, error(&fit, by), freedom),
        amplitude: Estimate::of_student(amplitude, error(&fit, by_amplitude), freedom),
        mean,
        scatter: fit.residual_deviation(),
    })
}

/// The standard error of a function of the first three parameters of a fit, by its slopes in them.
fn error(fit: &Fit, by: [f64; 3]) -> f64 {
    let covariance = &fit.covariance.covariance;
    let rows = (0..3).map(|i| (0..3).map(|j| by[i] * covariance[(i, j)] * by[j]).sum::<f64>());
    rows.sum::<f64>().max(0.0).sqrt()
}

/// A record as a harmonic, by its frequency, the amplitudes of cos and sin, and the mean.
struct Driven<'r> {
    times: &'r [f64],
    values: &'r [f64],
}

impl Model for Driven<'_> {
    fn residuals(&self, parameters: &[f64]) -> Option<Residuals> {
        let [omega, a, b, mean] = [0, 1, 2, 3].map(|i| parameters[i]);
        let rows = self.times.iter().zip(self.values).map(|(time, value)| {
            let (sin, cos) = (omega * (time - self.times[0])).sin_cos();
            let by_omega = (time - self.times[0]) * (b * cos - a * sin);
            (mean + a * cos + b * sin - value, vec![by_omega, cos, sin, 1.0])
        });
        let (values, slopes) = rows.unzip();
        Some(Residuals { values, slopes })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_harmonic_is_found_on_uneven_times() {
        for (omega, phase) in [(77.91, 0.3), (20.73, -2.9), (10.0, 3.1), (120.0, 1.0)] {
            let times: Vec<f64> = (0..1500)
                .map(|i| 0.2 + 1e-3 * (f64::from(i) + 0.3 * f64::from(i * i % 7) / 7.0))
                .collect();
            let noise = |i: usize| 0.05 * ((i * i * 31 % 101) as f64 / 50.0 - 1.0);
            let values: Vec<f64> = times
                .iter()
                .enumerate()
                .map(|(i, t)| 0.4 + 4.0 * (omega * t + phase).cos() + noise(i))
                .collect();
            let found = harmonic(&times, &values).expect("a harmonic");
            assert!(
                (found.omega.value - omega).abs() < 5.0 * found.omega.standard_error,
                "{found:?}"
            );
            assert!(
                (found.phase.value - phase).abs() < 5.0 * found.phase.standard_error,
                "{found:?}"
            );
            assert!((found.amplitude.value - 4.0).abs() < 0.02, "{found:?}");
            assert!(
                found.phase.standard_error < 0.01 && found.omega.standard_error < 0.02,
                "{found:?}"
            );
        }
        let times: Vec<f64> = (0..100).map(f64::from).collect();
        assert!(harmonic(&times, &[1.0; 100]).is_err());
        assert!(harmonic(&times[..9], &[1.0; 9]).is_err());
    }
}
