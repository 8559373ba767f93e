//! The noise of a record, as its samples tell it.

use super::recording::median;

/// Steps of less than this share of the largest value are those of rounding.
const ROUNDING: f64 = 1e-9;

/// The standard deviation of the noise of a record: that of its third differences, which a smooth motion hardly has, and no less than that
/// of rounding to its resolution, which third differences do not show where neighbouring samples are equal.
pub fn noise(values: &[f64]) -> f64 {
    let third: Vec<f64> =
        values.windows(4).map(|it| (it[3] - 3.0 * it[2] + 3.0 * it[1] - it[0]).abs()).collect();
    if third.is_empty() {
        return 0.0;
    }
    // Third differences of independent noise have 20 times its variance; 0.6745 is the median of |x| of a normal x.
    (median(&third) / (0.674_489_75 * 20.0_f64.sqrt())).max(of_rounding(values))
}

/// The standard deviation of what values are off that are rounded to the resolution which these have: that over the root of 12.
pub fn of_rounding(values: &[f64]) -> f64 {
    resolution(values) / 12.0_f64.sqrt()
}

/// The step of which all differences of values are multiples; zero where none is seen above rounding.
///
/// Method: the greatest common divisor of the differences by Euclid's algorithm.
fn resolution(values: &[f64]) -> f64 {
    let largest = values.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    let least = ROUNDING * largest;
    let mut step = 0.0;
    for pair in values.windows(2) {
        step = common_divisor(step, (pair[1] - pair[0]).abs(), least);
        if step > 0.0 && step < 100.0 * least {
            return 0.0;
        }
    }
    step
}

/// The greatest number of which both are multiples, as far as remainders of up to `least` are none.
fn common_divisor(a: f64, b: f64, least: f64) -> f64 {
    let (mut a, mut b) = (a.max(b), a.min(b));
    while b > least {
        // To the nearest multiple: below a multiple that is a little too small it would be almost the divisor.
        let remainder = a - (a / b).round() * b;
        (a, b) = (b, remainder.abs());
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_resolution_is_the_step_between_values() {
        let near = |values: &[f64], step: f64| {
            let found = resolution(values);
            assert!((found - step).abs() <= 1e-12 * step.max(1e-300), "{found}, not {step}");
        };
        near(&[0.00012, 0.00015, 0.00021, -0.00006], 3e-5);
        near(&[1.25, 1.0, 1.75, 1.25], 0.25);
        near(&[2.0, 2.0, 2.0], 0.0);
        near(&[], 0.0);
        // An offset that is no multiple changes nothing.
        let shifted: Vec<f64> = [3.0, 5.0, 9.0, 4.0].map(|it| 1e-5 * it + 1.234_567e-3).to_vec();
        assert!((resolution(&shifted) - 1e-5).abs() < 1e-10);
        // What is not rounded has none.
        let smooth: Vec<f64> = (0..100).map(|it| (0.37 * f64::from(it)).sin()).collect();
        assert_eq!(resolution(&smooth), 0.0);
    }

    #[test]
    fn the_noise_of_what_is_rounded_is_that_of_rounding() {
        // A slow wave in steps of a tenth, most of whose samples equal their neighbours.
        let wave = (0..4000).map(|it| (10.0 * (1e-3 * f64::from(it)).sin()).round() / 10.0);
        let found = noise(&wave.collect::<Vec<f64>>());
        assert!((found - 0.1 / 12.0_f64.sqrt()).abs() < 1e-9, "{found}");
    }
}
