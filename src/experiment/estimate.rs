//! An estimated quantity: its value, its standard error and its interval of confidence.

use statrs::distribution::{ContinuousCDF, FisherSnedecor, StudentsT};

/// The share of intervals that hold the true value.
pub const CONFIDENCE: f64 = 0.95;

/// A value with its uncertainty (SI).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The best value.
    pub value: f64,
    /// Its standard error; infinite where the data do not determine it.
    pub standard_error: f64,
    /// The interval that holds the true value in 95 of 100 experiments; infinite where the data set no limit.
    pub interval: [f64; 2],
}

impl Estimate {
    /// With the interval of Student's distribution for so many degrees of freedom.
    pub fn of_student(value: f64, standard_error: f64, degrees_of_freedom: usize) -> Estimate {
        let reach = student(degrees_of_freedom) * standard_error;
        Estimate { value, standard_error, interval: [value - reach, value + reach] }
    }

    /// The mean of at least two values.
    pub fn mean(values: &[f64]) -> Estimate {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|it| (it - mean) * (it - mean)).sum();
        let error = (squares / (count - 1.0) / count).sqrt();
        Estimate::of_student(mean, error, values.len() - 1)
    }

    /// A function of the value that rises or falls all over the interval, with its slope at the value.
    pub fn map(self, function: impl Fn(f64) -> f64, slope: f64) -> Estimate {
        let mut interval = self.interval.map(&function);
        interval.sort_by(f64::total_cmp);
        let standard_error = self.standard_error * slope.abs();
        Estimate { value: function(self.value), standard_error, interval }
    }

    /// Whether the interval holds a value.
    pub fn holds(&self, value: f64) -> bool {
        (self.interval[0]..=self.interval[1]).contains(&value)
    }
}

/// How many standard errors an interval of [`CONFIDENCE`] reaches to either side.
pub fn student(degrees_of_freedom: usize) -> f64 {
    reach(degrees_of_freedom, CONFIDENCE)
}

/// The same of another confidence.
pub fn reach(degrees_of_freedom: usize, confidence: f64) -> f64 {
    let freedom = degrees_of_freedom.max(1) as f64;
    let distribution = StudentsT::new(0.0, 1.0, freedom).expect("positive degrees of freedom");
    distribution.inverse_cdf(0.5 + 0.5 * confidence)
}

/// The probability that chance alone gives a ratio of variances of at least this size, with so many degrees of freedom.
pub fn chance_of_ratio(ratio: f64, freedom: [usize; 2]) -> f64 {
    // Without any scatter on either side nothing speaks against chance; without any below, no chance gives the ratio.
    if ratio.is_nan() || ratio <= 0.0 {
        return 1.0;
    }
    if ratio == f64::INFINITY {
        return 0.0;
    }
    let [above, below] = freedom.map(|it| it.max(1) as f64);
    let distribution = FisherSnedecor::new(above, below).expect("positive degrees of freedom");
    distribution.sf(ratio)
}

/// A number with so many significant digits, without zeros that say nothing.
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-5..7).contains(&exponent) {
        return format!("{:.*e}", (digits - 1).max(0) as usize, value);
    }
    let decimals = (digits - 1 - exponent).max(0) as usize;
    format!("{value:.decimals$}")
}

/// Decimals that show two significant digits of a standard error; none where it is not a number above zero.
pub fn decimals(standard_error: f64) -> Option<usize> {
    let is_told = standard_error.is_finite() && standard_error > 0.0;
    is_told.then(|| (1.0 - standard_error.log10().floor()).clamp(0.0, 15.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_say_something() {
        let shown = [0.0075312, 829.3, 8.29e29, 2419.0, 0.0].map(|it| significant(it, 3));
        assert_eq!(shown, ["0.00753", "829", "8.29e29", "2419", "0"]);
        let digits = [1.499, 0.0123, 12.3, 0.0, f64::INFINITY].map(decimals);
        assert_eq!(digits, [Some(1), Some(3), Some(0), None, None]);
    }

    #[test]
    fn ratios_without_scatter_have_a_chance() {
        for (ratio, chance) in [(f64::NAN, 1.0), (-1.0, 1.0), (0.0, 1.0), (f64::INFINITY, 0.0)] {
            assert_eq!(chance_of_ratio(ratio, [1, 5]), chance, "{ratio}");
        }
    }

    #[test]
    fn intervals_are_those_of_tables() {
        for (freedom, reach) in [(1, 12.706_205), (4, 2.776_445), (10, 2.228_139), (100, 1.983_972)]
        {
            assert!((student(freedom) - reach).abs() < 1e-6, "{freedom}: {}", student(freedom));
        }
        assert!((chance_of_ratio(4.964_603, [1, 10]) - 0.05).abs() < 1e-6);
        let mean = Estimate::mean(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!(mean.value, 2.5);
        assert!((mean.standard_error - 0.645_497).abs() < 1e-6);
        assert!(mean.holds(1.0) && !mean.holds(0.3));
    }
}
