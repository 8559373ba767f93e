//! Smooths a signal and differentiates it, by polynomials through moving windows.

use super::polynomial::Polynomial;
use super::wide_window;

/// Windows of more samples are fitted many at once: the time of a fit of each would grow with the window.
const WIDE: usize = 512;

/// A window of samples and the polynomial that is fitted in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// Samples in the window, an odd number.
    pub samples: usize,
    /// Order of the polynomial, below the number of samples.
    pub order: usize,
}

/// Why a signal cannot be smoothed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unsuitable {
    /// The window has an even number of samples, or none.
    EvenWindow,
    /// The order is not below the number of samples in the window.
    OrderTooHigh,
    /// The signal is shorter than the window.
    TooShort,
    /// The times do not increase from sample to sample, or are not as many as the values.
    Times,
}

impl std::fmt::Display for Unsuitable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Unsuitable::EvenWindow => "the window must have an odd number of samples",
            Unsuitable::OrderTooHigh => {
                "the order must be below the number of samples in the window"
            }
            Unsuitable::TooShort => "the signal has fewer samples than the window",
            Unsuitable::Times => "the times must increase from sample to sample",
        })
    }
}

/// The `derivative`-th derivative of the smoothed signal at its times (0 is the signal itself).
///
/// # Method
///
/// In the window around each sample a polynomial is fitted by least squares and evaluated at the sample; the samples of the
/// first and the last half window are read from the polynomial of the first and of the last whole window. The
/// polynomial is a sum of polynomials that are orthogonal over the times of the window, so that neither its order
/// nor uneven times cost digits. Wide windows share the sums over the samples that they have together, so that the time does not grow
/// with the window.
///
/// # Source
///
/// Savitzky and Golay, Analytical Chemistry 36 (1964); the orthogonal polynomials after Forsythe, J. SIAM 5 (1957).
///
/// # Guarantees
///
/// A polynomial of the window's order is kept as it is, edges included; on even times the result is that of
/// `scipy.signal.savgol_filter(..., mode="interp")`, to rounding.
///
/// # Breaks
///
/// Returns an error where the window, its order or the times are unsuitable.
pub fn smoothed(
    times: &[f64],
    values: &[f64],
    window: Window,
    derivative: usize,
) -> Result<Vec<f64>, Unsuitable> {
    check(times, values, window)?;
    let Window { samples, order } = window;
    let mut smooth =
        Smooth { times, samples, derivative, values: Vec::with_capacity(values.len()) };
    if samples > WIDE {
        wide_window::polynomials(times, values, samples, order, &mut |begins, polynomial| {
            smooth.read(begins, polynomial);
        });
        return Ok(smooth.values);
    }
    for begins in 0..=values.len() - samples {
        let range = begins..begins + samples;
        smooth.read(begins, &Polynomial::fit(&times[range.clone()], &values[range], order));
    }
    Ok(smooth.values)
}

/// A derivative of a smoothed signal, as it is read window by window.
struct Smooth<'t> {
    times: &'t [f64],
    /// Samples in a window.
    samples: usize,
    derivative: usize,
    values: Vec<f64>,
}

impl Smooth<'_> {
    /// Reads the polynomial of the window that begins at a sample: in its middle, and to the end in the first and the last.
    fn read(&mut self, begins: usize, polynomial: &Polynomial) {
        let (half, count) = (self.samples / 2, self.times.len());
        let from = if begins == 0 { 0 } else { begins + half };
        let to = if begins == count - self.samples { count } else { begins + half + 1 };
        let at = self.times[from..to].iter();
        self.values.extend(at.map(|&time| polynomial.derivative(self.derivative, time)));
    }
}

fn check(times: &[f64], values: &[f64], window: Window) -> Result<(), Unsuitable> {
    if window.samples.is_multiple_of(2) {
        return Err(Unsuitable::EvenWindow);
    }
    if window.order >= window.samples {
        return Err(Unsuitable::OrderTooHigh);
    }
    if times.len() != values.len() || !times.is_sorted_by(|a, b| a < b) {
        return Err(Unsuitable::Times);
    }
    if values.len() < window.samples {
        return Err(Unsuitable::TooShort);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// sin of squares, an arbitrary smooth signal.
    fn signal(count: usize) -> Vec<f64> {
        (0..count).map(|i| (0.01 * (i * i) as f64).sin() + 0.1 * i as f64).collect()
    }

    #[test]
    fn is_that_of_scipy() {
        let times: Vec<f64> = (0..12).map(|i| 0.5 * i as f64).collect();
        for (derivative, expected) in SCIPY {
            let window = Window { samples: 7, order: 3 };
            let found = smoothed(&times, &signal(12), window, derivative).expect("suitable");
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{derivative}: {found} {expected}");
            }
        }
    }

    #[test]
    fn polynomials_are_kept_on_uneven_times() {
        let times: Vec<f64> = (0..40).map(|i| i as f64 + 0.4 * (1.7 * i as f64).sin()).collect();
        let cubic = |t: f64| 3.0 - t + 0.2 * t * t - 0.01 * t * t * t;
        let slope = |t: f64| -1.0 + 0.4 * t - 0.03 * t * t;
        let values: Vec<f64> = times.iter().map(|&t| cubic(t)).collect();
        for samples in [5, 9, 21] {
            let window = Window { samples, order: 3 };
            let smooth = smoothed(&times, &values, window, 0).expect("suitable");
            let slopes = smoothed(&times, &values, window, 1).expect("suitable");
            for (i, &t) in times.iter().enumerate() {
                assert!((smooth[i] - cubic(t)).abs() < 1e-10, "{samples} {i}");
                assert!((slopes[i] - slope(t)).abs() < 1e-9, "{samples} {i}");
            }
        }
    }

    #[test]
    fn unsuitable_windows_and_times_are_refused() {
        let window = |samples, order| Window { samples, order };
        let refused = |times: &[f64], window| {
            smoothed(times, &vec![0.0; times.len()], window, 0).expect_err("refused")
        };
        let times = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(refused(&times, window(2, 1)), Unsuitable::EvenWindow);
        assert_eq!(refused(&times, window(0, 0)), Unsuitable::EvenWindow);
        assert_eq!(refused(&times, window(3, 3)), Unsuitable::OrderTooHigh);
        assert_eq!(refused(&times, window(5, 2)), Unsuitable::TooShort);
        assert_eq!(refused(&[0.0, 1.0, 1.0], window(3, 2)), Unsuitable::Times);
    }

    #[test]
    fn wide_windows_give_what_each_fit_gives() {
        let uneven = |i: usize| 1e-3 * (i as f64 + 0.4 * (1.7 * i as f64).sin());
        let times: Vec<f64> = (0..9000).map(|i| 5.0 + uneven(i)).collect();
        let noise = |i: usize| (i * i * 31 % 101) as f64 / 50.0 - 1.0;
        let wave = |t: f64| 1e3 + 7.0 * t + (3.0 * t).sin();
        let values: Vec<f64> = times.iter().enumerate().map(|(i, t)| wave(*t) + noise(i)).collect();
        for (samples, order, derivative) in
            [(513, 3, 0), (1501, 0, 0), (1501, 3, 1), (2001, 6, 2), (4001, 12, 0), (8999, 5, 1)]
        {
            let window = Window { samples, order };
            let found = smoothed(&times, &values, window, derivative).expect("suitable");
            assert_eq!(found.len(), times.len());
            let (half, last) = (samples / 2, times.len() - samples);
            let per_time = 1.0 / (times[samples - 1] - times[0]);
            for (i, found) in found.iter().enumerate().step_by(37) {
                let begins = i.saturating_sub(half).min(last);
                let range = begins..begins + samples;
                let fit = Polynomial::fit(&times[range.clone()], &values[range], order);
                let direct = fit.derivative(derivative, times[i]);
                // Rounding of the values, as the polynomial has it at the ends of its window.
                let steepness = (2.0 * (order * order) as f64).max(1.0).powi(derivative as i32);
                let allowed = 1e-11 * 1e3 * steepness * per_time.powi(derivative as i32);
                assert!((found - direct).abs() < allowed, "{window:?} {i}: {found} {direct}");
            }
        }
    }

    #[test]
    fn polynomials_are_kept_in_wide_windows_where_samples_crowd() {
        // Of each ten samples nine lie within a thousandth of the tenth's distance.
        let time = |i: usize| (i / 10) as f64 + 1e-4 * (i % 10) as f64;
        let times: Vec<f64> = (0..6000).map(time).collect();
        let cubic = |t: f64| 3.0 - t + 2e-3 * t * t - 1e-6 * t * t * t;
        let values: Vec<f64> = times.iter().map(|&t| cubic(t)).collect();
        for samples in [601, 2001] {
            let window = Window { samples, order: 3 };
            let smooth = smoothed(&times, &values, window, 0).expect("suitable");
            for (found, t) in smooth.iter().zip(&times) {
                assert!((found - cubic(*t)).abs() < 1e-9, "{samples} {t}: {found}");
            }
        }
    }

    /// `savgol_filter(y, 7, 3, deriv=d, delta=0.5, mode="interp")` of SciPy 1.17.1, by derivative.
    const SCIPY: [(usize, [f64; 12]); 3] = [
        (
            0,
            [
                0.0001169692908789738,
                0.10974033017583586,
                0.2399912400655799,
                0.3901265714479645,
                0.5597362741137837,
                0.7480250531012925,
                0.9531099149653971,
                1.1716521087167966,
                1.398335342734177,
                1.6244864800616847,
                1.8401389717448011,
                2.036185151878039,
            ],
        ),
        (
            1,
            [
                0.19812375442369579,
                0.24012197994541634,
                0.2806339504428442,
                0.3196596659159793,
                0.35814118107770176,
                0.393991959521136,
                0.4248226734246329,
                0.4472162250916646,
                0.4567291430290806,
                0.44483951764578666,
                0.41473456045151696,
                0.3664142714462716,
            ],
        ),
        (
            2,
            [
                0.08548270606773381,
                0.08251019601914843,
                0.07953768597056306,
                0.07656517592197778,
                0.07181031006781347,
                0.0630029258151461,
                0.04834687071079691,
                0.026003179096537266,
                -0.005563918955611258,
                -0.041994582577563735,
                -0.07842524619951509,
                -0.11485590982146641,
            ],
        ),
    ];
}
