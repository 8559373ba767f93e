//! Standard errors of speed and price of the motions of a trade-off that do not repeat.

use crate::capsule::mean_errors::standard_error;

/// Standard errors of the means of a motion that does not repeat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanErrors {
    /// That of the progression speed [m/s].
    pub speed: f64,
    /// That of the price (SI).
    pub price: f64,
}

impl MeanErrors {
    /// From speeds and prices of as many batches of cycles.
    pub fn of(speeds: &[f64], prices: &[f64]) -> MeanErrors {
        MeanErrors { speed: standard_error(speeds), price: standard_error(prices) }
    }
}
