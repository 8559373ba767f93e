//! Smooths a signal and differentiates it, by polynomials through moving windows.

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
/// nor uneven times cost digits.
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
    let half = window.samples / 2;
    let last = values.len() - window.samples;
    let mut smooth = Vec::with_capacity(values.len());
    let mut fitted = None;
    for (i, &time) in times.iter().enumerate() {
        let begins = i.saturating_sub(half).min(last);
        if fitted.as_ref().is_none_or(|(at, _)| *at != begins) {
            let range = begins..begins + window.samples;
            fitted = Some((
                begins,
                Polynomial::fit(&times[range.clone()], &values[range], window.order),
            ));
        }
        let (_, polynomial) = fitted.as_ref().expect("a polynomial was fitted above");
        smooth.push(polynomial.derivative(derivative, time));
    }
    Ok(smooth)
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

/// A polynomial as a sum of polynomials `P` that are orthogonal over the samples that it was fitted to:
/// `P[k+1](u) = (u - shift[k]) P[k](u) - weight[k] P[k-1](u)`, with times `u` from -1 to 1.
struct Polynomial {
    centre: f64,
    scale: f64,
    shifts: Vec<f64>,
    weights: Vec<f64>,
    coefficients: Vec<f64>,
}

impl Polynomial {
    fn fit(times: &[f64], values: &[f64], order: usize) -> Self {
        let ends = [times[0], times[times.len() - 1]];
        let centre = 0.5 * (ends[0] + ends[1]);
        let scale = if ends[1] > ends[0] { 2.0 / (ends[1] - ends[0]) } else { 1.0 };
        let at: Vec<f64> = times.iter().map(|time| (time - centre) * scale).collect();
        let (mut before, mut this) = (vec![0.0; at.len()], vec![1.0; at.len()]);
        let mut rest = values.to_vec();
        let mut square_before = 1.0;
        let mut polynomial = Polynomial {
            centre,
            scale,
            shifts: Vec::new(),
            weights: Vec::new(),
            coefficients: Vec::new(),
        };
        for k in 0..=order {
            let square = sum(&this, &this);
            // What is left after the lower orders, rather than the values, loses fewer digits.
            let coefficient = sum(&rest, &this) / square;
            let shift = (0..at.len()).map(|i| at[i] * this[i] * this[i]).sum::<f64>() / square;
            let weight = if k == 0 { 0.0 } else { square / square_before };
            for i in 0..at.len() {
                rest[i] -= coefficient * this[i];
                let next = (at[i] - shift) * this[i] - weight * before[i];
                (before[i], this[i]) = (this[i], next);
            }
            square_before = square;
            polynomial.coefficients.push(coefficient);
            polynomial.shifts.push(shift);
            polynomial.weights.push(weight);
        }
        polynomial
    }

    /// Its derivative of this order (0 is its value) at `time`.
    fn derivative(&self, order: usize, time: f64) -> f64 {
        let u = (time - self.centre) * self.scale;
        // The derivatives of two neighbouring polynomials, from order zero up.
        let mut before = vec![0.0; order + 1];
        let mut this = before.clone();
        this[0] = 1.0;
        let mut total = 0.0;
        for (k, coefficient) in self.coefficients.iter().enumerate() {
            total += coefficient * this[order];
            let next = |d: usize| {
                let lower = if d == 0 { 0.0 } else { d as f64 * this[d - 1] };
                lower + (u - self.shifts[k]) * this[d] - self.weights[k] * before[d]
            };
            let after = (0..=order).map(next).collect();
            before = std::mem::replace(&mut this, after);
        }
        total * self.scale.powi(order as i32)
    }
}

fn sum(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
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
