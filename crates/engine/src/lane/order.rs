//! The degree of all series.

/// Degree at which every series is cut.
pub const ORDER: usize = 16;

/// Coefficients of the powers 0..=ORDER of the time since the step began.
pub type Series<L> = [L; ORDER + 1];
