//! Standard errors of gain and price of the motions of a trade-off that do not repeat.

use crate::capsule::mean_errors::standard_error;

/// Standard errors of the means of a motion that does not repeat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanErrors {
    /// That of the gain (SI).
    pub gain: f64,
    /// That of the price (SI).
    pub price: f64,
}

impl MeanErrors {
    /// From gains and prices of as many batches of cycles.
    pub fn of(gains: &[f64], prices: &[f64]) -> MeanErrors {
        MeanErrors { gain: standard_error(gains), price: standard_error(prices) }
    }
}
