//! The outcome of each case, as the figures distinguish cases.

use super::error::FigureError;
use super::view::View;
use crate::store::catalogue::{Entry, OUTCOME};

/// What is read of each case.
pub const READS: [Entry; 1] = [OUTCOME];

/// The outcome of a case whose block is not there yet.
const MISSING: &str = "missing";
/// What figures call such cases.
pub const NOT_YET: &str = "not yet computed";

/// What is said of so many cases that are not computed yet among all that are shown; nothing where there are none.
pub fn told_of_missing(missing: usize, all: usize) -> Option<String> {
    (missing > 0).then(|| format!("{NOT_YET}: {missing} of {all}"))
}

/// Stands for a case of which nothing is known.
const UNKNOWN: u8 = u8::MAX;

/// The outcome of every case of a view.
pub struct Outcomes<'a> {
    /// The names that outcomes have in the results.
    flags: &'a [(i64, String)],
    /// For each case its place among them, in the order of the axes; none where the results do not say.
    places: Vec<u8>,
}

impl<'a> Outcomes<'a> {
    /// The outcomes over the axes `free`; unknown where the results hold no `outcome`.
    pub fn over(view: &View<'a>, free: &[&str]) -> Result<Outcomes<'a>, FigureError> {
        if view.dataset.variable(OUTCOME.name).is_none() {
            return Ok(Outcomes { flags: &[], places: Vec::new() });
        }
        let flags = view.flags(OUTCOME.name);
        let mut places = Vec::new();
        for code in view.take(OUTCOME.name, free)? {
            let place = flags.iter().position(|(value, _)| *value as f64 == code);
            places.push(place.and_then(|place| u8::try_from(place).ok()).unwrap_or(UNKNOWN));
        }
        Ok(Outcomes { flags, places })
    }

    /// The outcome of a case, if it is known.
    pub fn name(&self, case: usize) -> Option<&'a str> {
        let place = usize::from(*self.places.get(case)?);
        self.flags.get(place).map(|(_, name)| name.as_str())
    }

    /// Whether a case is known to have failed.
    pub fn failed(&self, case: usize) -> bool {
        self.name(case) == Some("failed")
    }

    /// Whether a case is not computed yet.
    pub fn missing(&self, case: usize) -> bool {
        self.name(case) == Some(MISSING)
    }

    /// Whether a case is periodic, or nothing else is known of it.
    pub fn periodic(&self, case: usize) -> bool {
        self.name(case).is_none_or(|name| name == "periodic")
    }
}
