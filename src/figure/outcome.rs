//! What became of each case, as the figures tell cases apart.

use super::error::FigureError;
use super::view::View;

/// The outcome of every case of a view.
pub struct Outcomes {
    /// One name per case, in the order of the axes; none where the results do not say.
    names: Vec<Option<String>>,
}

impl Outcomes {
    /// The outcomes over the axes `free`; unknown where the results hold no `outcome`.
    pub fn over(view: &View<'_>, free: &[&str]) -> Result<Outcomes, FigureError> {
        if view.dataset.variable("outcome").is_none() {
            return Ok(Outcomes { names: Vec::new() });
        }
        let flags = view.flags("outcome");
        let name = |code: &f64| {
            let flag = flags.iter().find(|(value, _)| *value as f64 == *code);
            flag.map(|(_, name)| name.clone())
        };
        Ok(Outcomes { names: view.take("outcome", free)?.iter().map(name).collect() })
    }

    /// The outcome of a case, if it is known.
    pub fn name(&self, case: usize) -> Option<&str> {
        self.names.get(case).and_then(|name| name.as_deref())
    }

    /// Whether a case is known to have failed.
    pub fn failed(&self, case: usize) -> bool {
        self.name(case) == Some("failed")
    }

    /// Whether a case is periodic, or nothing else is known of it.
    pub fn periodic(&self, case: usize) -> bool {
        self.name(case).is_none_or(|name| name == "periodic")
    }
}
