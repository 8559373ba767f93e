//! How far the means of a motion that does not repeat may be from those of endlessly many cycles.

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

/// The standard error of the mean of some numbers.
fn standard_error(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / (count - 1.0) / count).sqrt()
}
