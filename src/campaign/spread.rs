//! The motions of a trade-off that do not repeat, followed further: their spread tells the errors of their means.

use std::collections::BTreeSet;

use super::answer::Answer;
use super::error::CampaignError;
use super::mean_errors::MeanErrors;
use super::motion_row::Row;
use super::refined_front::Refinement;
use super::replay::Replay;
use super::report::silent;
use crate::experiment::settled_motion::outputs_of_batches;
use crate::of::settle_case;
use crate::run::{Machine, on_all_threads};

impl Refinement<'_> {
    /// The standard errors of gain and price of each of some cases that do not repeat; none of those that could not be followed.
    ///
    /// # Method
    ///
    /// The case is computed again and followed on from its end for as many cycles as it was measured over, in 16 batches; the error
    /// is the standard deviation of their means over the root of their number.
    ///
    /// # Assumes
    ///
    /// Batches are long against the memory of the motion; that of a quasi-periodic motion never fades, and its error is that of
    /// the batches all the same.
    ///
    /// Fails if a case cannot be computed again.
    pub fn mean_errors(
        &self,
        cases: &[usize],
        threads: Option<usize>,
    ) -> Result<Vec<Option<MeanErrors>>, CampaignError> {
        let found =
            on_all_threads(threads, cases.len(), |number| self.mean_errors_of(cases[number]))?;
        found.into_iter().collect()
    }

    fn mean_errors_of(&self, case: usize) -> Result<Option<MeanErrors>, CampaignError> {
        let replay = Replay::new(self.study, case)?;
        let (case, protocol) = (replay.as_run(Machine::single(), &silent)?, replay.protocol());
        let end = settle_case(&case, protocol).end;
        Ok(outputs_of_batches(&case, &end, protocol).map(|batches| {
            let [gains, prices] =
                self.of.both().map(|of| batches.iter().map(|it| it[of]).collect::<Vec<f64>>());
            MeanErrors::of(&gains, &prices)
        }))
    }
}

/// Adds the errors of the motions that do not repeat.
pub(super) fn add_errors(
    answer: &mut Answer,
    refinement: &Refinement<'_>,
    threads: Option<usize>,
) -> Result<(), CampaignError> {
    // A motion may be an optimum and on the front.
    let cases: BTreeSet<usize> = answer.rows().filter_map(aperiodic_case).collect();
    let cases: Vec<usize> = cases.into_iter().collect();
    let found = refinement.mean_errors(&cases, threads)?;
    for row in answer.rows_mut() {
        let place = aperiodic_case(row).and_then(|case| cases.binary_search(&case).ok());
        row.errors = place.and_then(|place| found[place]);
    }
    Ok(())
}

/// The case of a motion that does not repeat.
fn aperiodic_case(row: &Row) -> Option<usize> {
    row.case.filter(|_| row.period.is_none())
}
