//! From a value to its place along an axis.

/// How values are spread along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spacing {
    /// Equal differences take equal lengths.
    Linear,
    /// Equal ratios take equal lengths.
    Log,
    /// A value v stands at asinh(v/w) for this w.
    Symmetric(f64),
}

/// Numbers below this are zero to the eye, so near to the least that can be held that marks between them cannot.
const LEAST: f64 = 1e-290;
/// An axis ends here, so that its length can be held.
const GREATEST: f64 = f64::MAX / 16.0;

/// The range of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// How values are spread.
    pub spacing: Spacing,
    /// Smallest value shown.
    pub low: f64,
    /// Largest value shown.
    pub high: f64,
}

impl Scale {
    /// The range of the finite `values`, widened by the share `margin` on both sides; a range
    /// without extent is widened so that its value stands in the middle.
    pub fn around(values: impl IntoIterator<Item = f64>, margin: f64) -> Scale {
        let finite = values.into_iter().filter(|value| value.is_finite());
        let within = finite.map(|value| value.clamp(-GREATEST, GREATEST));
        let (low, high) = finite_range(within).unwrap_or((0.0, 1.0));
        let size = low.abs().max(high.abs());
        // Differences below rounding are no extent.
        let flat = high - low <= 1e-12 * size || high - low < LEAST;
        let pad = match (flat, size > LEAST) {
            (true, true) => 0.1 * size,
            (true, false) => 1.0,
            _ => margin * (high - low),
        };
        Scale { spacing: Spacing::Linear, low: low - pad, high: high + pad }
    }

    /// A linear range between two ends; values fall along the axis where the first is greater.
    pub fn over(low: f64, high: f64) -> Scale {
        Scale { spacing: Spacing::Linear, low, high }
    }

    /// The scale of an axis' own `values`: logarithmic where they are spaced so.
    pub fn of_axis(values: &[f64]) -> Scale {
        let scale = Scale::around(values.iter().copied(), 0.0);
        match log_spaced(values) {
            true => Scale { spacing: Spacing::Log, ..scale },
            false => scale,
        }
    }

    /// The range of the finite `values` as [`around`](Scale::around) has it, where differences up to `noise` are those of
    /// rounding: values that are no larger are zero to the eye.
    pub fn above(noise: f64, values: impl IntoIterator<Item = f64>, margin: f64) -> Scale {
        let finite: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        match finite_range(finite.iter().copied()) {
            Some((low, high)) if low.abs().max(high.abs()) <= noise => Scale::around([0.0], margin),
            Some((low, high)) if high - low <= noise => Scale::around([low], margin),
            _ => Scale::around(finite, margin),
        }
    }

    /// A logarithmic scale over the positive `values`.
    pub fn log_around(values: impl IntoIterator<Item = f64>, margin: f64) -> Scale {
        let logs =
            values.into_iter().filter(|value| *value > 0.0 && value.is_finite()).map(f64::log10);
        let scale = Scale::around(logs, margin);
        Scale { spacing: Spacing::Log, low: 10f64.powf(scale.low), high: 10f64.powf(scale.high) }
    }

    /// The same range, symmetrically logarithmic and linear within `width` of zero; without one, within the power of ten
    /// below a thousandth of its largest magnitude.
    pub fn symmetric(self, width: Option<f64>) -> Scale {
        let size = self.low.abs().max(self.high.abs());
        let width = width.unwrap_or_else(|| 10f64.powf((1e-3 * size).log10().floor()));
        Scale { spacing: Spacing::Symmetric(width), ..self }
    }

    /// Where `value` stands, as a share of the axis from its low end.
    pub fn share(&self, value: f64) -> f64 {
        match self.spacing {
            Spacing::Linear => (value - self.low) / (self.high - self.low),
            Spacing::Log => (value / self.low).ln() / (self.high / self.low).ln(),
            Spacing::Symmetric(width) => {
                let [low, value, high] =
                    [self.low, value, self.high].map(|it| (it / width).asinh());
                (value - low) / (high - low)
            }
        }
    }

    /// The value at `share` of the axis.
    pub fn value(&self, share: f64) -> f64 {
        match self.spacing {
            Spacing::Linear => self.low + share * (self.high - self.low),
            Spacing::Log => self.low * (self.high / self.low).powf(share),
            Spacing::Symmetric(width) => {
                let [low, high] = [self.low, self.high].map(|it| (it / width).asinh());
                width * (low + share * (high - low)).sinh()
            }
        }
    }

    /// Whether a value has a place on the axis or its continuation: on a logarithmic one, those above zero.
    pub fn can_hold(&self, value: f64) -> bool {
        self.spacing != Spacing::Log || value > 0.0
    }

    /// Whether `value` lies on the axis, its ends included up to rounding.
    pub fn holds(&self, value: f64) -> bool {
        (-1e-9..=1.0 + 1e-9).contains(&self.share(value))
    }
}

/// The smallest and largest of the finite `values`.
pub fn finite_range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values.into_iter().filter(|value| value.is_finite()).fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((f64::min(low, value), f64::max(high, value))),
    })
}

/// Whether `values` (three at least) grow by a constant factor and not by a constant step.
fn log_spaced(values: &[f64]) -> bool {
    if values.len() < 3 || values.iter().any(|value| !value.is_finite() || *value <= 0.0) {
        return false;
    }
    let first = values[1] / values[0];
    let mut pairs = values.windows(2);
    (first - 1.0).abs() > 1e-3 && pairs.all(|pair| (pair[1] / pair[0] / first - 1.0).abs() < 1e-6)
}
