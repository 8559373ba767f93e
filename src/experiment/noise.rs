//! The noise of a record, as its samples tell it.

use super::recording::median;

/// The standard deviation of the noise of a record: that of its third differences, which a smooth motion hardly has.
pub fn noise(values: &[f64]) -> f64 {
    let third: Vec<f64> =
        values.windows(4).map(|it| (it[3] - 3.0 * it[2] + 3.0 * it[1] - it[0]).abs()).collect();
    if third.is_empty() {
        return 0.0;
    }
    // Third differences of independent noise have 20 times its variance; 0.6745 is the median of |x| of a normal x.
    median(&third) / (0.674_489_75 * 20.0_f64.sqrt())
}
