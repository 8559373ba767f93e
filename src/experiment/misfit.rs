//! How far a fit leaves recorded histories from their noise, and how many samples are outliers.

use super::noise::noise;
use super::recording::median;

/// An outlier is so many standard deviations of the noise from the fit.
const FAR: f64 = 5.0;
/// The median of the magnitude of a normal number of unit deviation.
const MEDIAN: f64 = 0.674_489_75;
/// Residuals below this share of what third differences of the record take for noise are no noise.
const COARSE: f64 = 0.5;

/// Residuals in units of the noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// Their standard deviation: one where the model describes the records.
    pub value: f64,
    /// The same from the medians of their magnitudes, which outliers hardly change.
    pub robust: f64,
    /// Samples that are more than five standard deviations of the noise from the fit.
    pub outliers: usize,
    /// Those of them whose neighbours are none: a wrong model gives outliers one after the other.
    pub lone: usize,
    /// Whether the records change too much from sample to sample for their noise to be told from the motion.
    pub is_coarse: bool,
}

/// The residuals of one signal.
pub struct SignalResiduals {
    /// Fitted less recorded [SI].
    pub values: Vec<f64>,
    /// The noise of the record by its own third differences [SI].
    pub record_noise: f64,
    /// The noise is not taken to be less [SI].
    pub least_noise: f64,
}

/// The standard deviation of numbers about zero, by the median of their magnitudes.
pub fn robust_deviation(values: &[f64]) -> f64 {
    let sizes: Vec<f64> = values.iter().map(|it| it.abs()).collect();
    median(&sizes) / MEDIAN
}

/// The misfit of some signals, of whose residuals so many are free.
///
/// # Method
///
/// The noise of each signal is that of the third differences of its residuals. Those of the record are too large where it has sharp
/// features (impacts, stick and slip), which the model takes out.
///
/// # Assumes
///
/// Independent noise.
///
/// # Guarantees
///
/// Its mean is one within a hundredth where the model describes records of some hundred samples.
///
/// # Breaks
///
/// Where the records have so few samples per cycle that the residuals of a wrong model change from sample to sample, it is too
/// small; [`Misfit::is_coarse`] tells records of which that is so.
pub fn misfit(signals: &[SignalResiduals], freedom: usize) -> Misfit {
    let (mut squares, mut medians, mut samples) = (0.0, 0.0, 0);
    let (mut outliers, mut lone) = (0, 0);
    let mut shares = 0.0;
    for SignalResiduals { values, record_noise, least_noise } in signals {
        let unit = noise(values).max(*least_noise);
        let sizes: Vec<f64> = values.iter().map(|it| it.abs() / unit).collect();
        let square: f64 = sizes.iter().map(|it| it * it).sum();
        squares += square;
        shares += square * (unit / record_noise).powi(2);
        medians += sizes.len() as f64 * robust_deviation(&sizes).powi(2);
        let far: Vec<usize> = (0..sizes.len()).filter(|&i| sizes[i] > FAR).collect();
        outliers += far.len();
        lone += far.chunk_by(|i, next| i + 1 == *next).filter(|run| run.len() == 1).count();
        samples += sizes.len();
    }
    let freedom = freedom as f64;
    Misfit {
        value: (squares / freedom).sqrt(),
        robust: (medians / freedom).sqrt(),
        outliers,
        lone,
        is_coarse: (shares / samples as f64).sqrt() < COARSE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::synthesis::Noise;

    #[test]
    fn noise_has_a_misfit_of_one_and_outliers_are_counted() {
        let (mut mean, mut robust, mut outliers) = (0.0, 0.0, 0);
        for seed in 0..400 {
            let mut noise = Noise::new(seed);
            let mut of = |deviation: f64| SignalResiduals {
                values: (0..484).map(|_| noise.normal(deviation)).collect(),
                record_noise: deviation,
                least_noise: 0.0,
            };
            let mut signals = [of(1e-5), of(2e-5), of(0.1)];
            mean += misfit(&signals, 3 * 484).value / 400.0;
            for place in [40, 240, 440] {
                signals[2].values[place] = 3.0;
            }
            let found = misfit(&signals, 3 * 484);
            outliers += found.outliers;
            assert!(found.lone >= 3 && found.lone <= found.outliers, "{found:?}");
            assert!(!found.is_coarse && found.value > 1.3, "{found:?}");
            robust += found.robust / 400.0;
        }
        // Of half a million normal numbers hardly any is beyond five standard deviations.
        assert!((1200..1206).contains(&outliers), "{outliers}");
        assert!((mean - 1.0).abs() < 0.01 && (robust - 1.0).abs() < 0.02, "{mean} {robust}");
    }
}
