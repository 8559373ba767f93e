//! How residuals are weighed: by their squares, or so that outliers count little.

/// How residuals are weighed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Loss {
    /// By their squares.
    #[default]
    Squares,
    /// By their squares up to about this size, and linearly beyond, so that outliers count little:
    /// `2 a^2 (sqrt(1 + (f/a)^2) - 1)`.
    SoftL1(f64),
}

impl Loss {
    /// What a residual adds to the sum that is made least.
    pub fn of(self, residual: f64) -> f64 {
        match self {
            Loss::Squares => residual * residual,
            Loss::SoftL1(size) => {
                let square = (residual / size).powi(2);
                // 2 (root - 1) without the difference of near numbers.
                size * size * 2.0 * square / ((1.0 + square).sqrt() + 1.0)
            }
        }
    }

    /// Half the slope of the loss in a residual, which is the residual itself for squares.
    pub fn influence(self, residual: f64) -> f64 {
        match self {
            Loss::Squares => residual,
            Loss::SoftL1(size) => residual / (1.0 + (residual / size).powi(2)).sqrt(),
        }
    }

    /// Half the curvature of the loss in a residual, which is one for squares.
    pub fn curvature(self, residual: f64) -> f64 {
        match self {
            Loss::Squares => 1.0,
            Loss::SoftL1(size) => (1.0 + (residual / size).powi(2)).powf(-1.5),
        }
    }
}
