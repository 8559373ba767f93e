//! What a figure says of the cases of a refined grid that are inferred.

use super::outcome::Outcomes;
use super::ticks::significant;
use super::view::View;
use crate::store::catalogue::{Entry, INFERRED_ELSEWHERE, INFERRED_SAMPLE, OUTCOME};

/// The name of the outcome of an inferred case.
pub const NAME: &str = "inferred";

/// What is read beside the outcomes.
pub const READS: [Entry; 2] = [INFERRED_SAMPLE, INFERRED_ELSEWHERE];

/// Whether the results are those of a refined grid.
pub fn has_inferred(view: &View<'_>) -> bool {
    let outcome = view.dataset.variable(OUTCOME.name);
    outcome.is_some_and(|variable| variable.flags.iter().any(|(_, name)| name == NAME))
}

/// Whether each of so many cases is inferred.
pub fn inferred(outcomes: &Outcomes<'_>, cases: usize) -> Vec<bool> {
    (0..cases).map(|case| outcomes.name(case) == Some(NAME)).collect()
}

/// Which part of some `cases`, in a word such as starts, is inferred, if any is, and how many of those computed as a check are
/// `differ` says.
pub fn told(view: &View<'_>, inferred: &[bool], cases: &str, differ: &str) -> Vec<String> {
    let count = inferred.iter().filter(|it| **it).count();
    if count == 0 {
        return Vec::new();
    }
    let share = significant(100.0 * (1.0 - count as f64 / inferred.len() as f64), 2);
    let mut told = vec![format!("{share} % of the {cases} computed, the others inferred")];
    let [all, elsewhere] = READS.map(|it| view.column(it));
    if let (Some(all), Some(elsewhere)) = (all.first(), elsewhere.first()) {
        told.push(format!("of {all} inferred {cases} as a check, {elsewhere} {differ}"));
    }
    told
}
