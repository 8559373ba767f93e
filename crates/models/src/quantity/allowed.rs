//! What values a parameter may take.

use std::f64::consts::FRAC_PI_2;
use std::fmt;

/// What values a parameter may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Allowed {
    /// Any finite number.
    Finite,
    /// Finite and at least zero.
    NonNegative,
    /// Finite and above zero.
    Positive,
    /// Above 0 and below 1.
    Share,
    /// From 0 to 1.
    UpToOne,
    /// From 0 to 10.
    UpToTen,
    /// Above -pi/2 and below pi/2, an angle.
    Slope,
    /// Within bounds of its own.
    Within(Bounds),
}

/// Bounds of a value; infinite where there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The least that it may be.
    pub least: f64,
    /// What it must be above.
    pub above: f64,
    /// The most that it may be.
    pub most: f64,
    /// What it must be below.
    pub below: f64,
}

impl Bounds {
    /// None.
    pub const NONE: Bounds = Bounds {
        least: f64::NEG_INFINITY,
        above: f64::NEG_INFINITY,
        most: f64::INFINITY,
        below: f64::INFINITY,
    };

    /// The least and the greatest number within them; infinite where there is none.
    pub fn ends(self) -> [f64; 2] {
        let Bounds { least, above, most, below } = self;
        let least = if above.is_finite() { least.max(above.next_up()) } else { least };
        let most = if below.is_finite() { most.min(below.next_down()) } else { most };
        [least, most]
    }

    /// Whether a finite value is within them.
    pub fn admit(self, value: f64) -> bool {
        let Bounds { least, above, most, below } = self;
        value >= least && value > above && value <= most && value < below
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all = [
            ("of at least", self.least),
            ("above", self.above),
            ("of at most", self.most),
            ("below", self.below),
        ];
        let all = all.into_iter().filter(|(_, bound)| bound.is_finite());
        let told: Vec<String> = all.map(|(word, bound)| format!("{word} {bound}")).collect();
        write!(f, "a finite number {}", told.join(" and "))
    }
}

impl Allowed {
    /// Whether `value` may be used.
    pub fn admits(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Allowed::Finite => true,
                Allowed::NonNegative => value >= 0.0,
                Allowed::Positive => value > 0.0,
                Allowed::Share => value > 0.0 && value < 1.0,
                Allowed::UpToOne => (0.0..=1.0).contains(&value),
                Allowed::UpToTen => (0.0..=10.0).contains(&value),
                Allowed::Slope => value.abs() < FRAC_PI_2,
                Allowed::Within(bounds) => bounds.admit(value),
            }
    }
}

impl Allowed {
    /// The least and the greatest number that may be used; infinite where there is none.
    pub fn ends(self) -> [f64; 2] {
        match self {
            Allowed::Finite => [f64::NEG_INFINITY, f64::INFINITY],
            Allowed::NonNegative => [0.0, f64::INFINITY],
            Allowed::Positive => [f64::MIN_POSITIVE, f64::INFINITY],
            Allowed::Share => [f64::MIN_POSITIVE, 1.0_f64.next_down()],
            Allowed::UpToOne => [0.0, 1.0],
            Allowed::UpToTen => [0.0, 10.0],
            Allowed::Slope => [-FRAC_PI_2.next_down(), FRAC_PI_2.next_down()],
            Allowed::Within(bounds) => bounds.ends(),
        }
    }
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Allowed::Finite => "a finite number",
            Allowed::NonNegative => "a finite number, zero or above",
            Allowed::Positive => "a finite number above zero",
            Allowed::Share => "a number above 0 and below 1",
            Allowed::UpToOne => "a number from 0 to 1",
            Allowed::UpToTen => "a number from 0 to 10",
            Allowed::Slope => "an angle above -90 deg and below 90 deg",
            Allowed::Within(bounds) => return bounds.fmt(f),
        })
    }
}
