//! What joined results have beside the cases that were computed: attractors, and what is inferred.

use super::error::CampaignError;
use super::report::{Event, Reports, Stage};
use crate::run::{self, Machine, has_attractors};
use crate::store::{Blocks, Dataset, add_attractors, add_sample};
use crate::study::{Refine, Study};

/// How the blocks of a study are joined.
#[derive(Clone, Copy)]
pub(super) struct Joining<'a> {
    /// The study.
    pub study: &'a Study,
    /// What to compute on.
    pub machine: Machine,
    /// Who is told.
    pub reports: &'a Reports<'a>,
}

impl Joining<'_> {
    /// All that the results have beside the variables over the cases; the cases that refined blocks lack are computed first and
    /// added to them, unless the results are to be partial.
    ///
    /// Fails if the blocks cannot be read, or the listener asks to stop.
    pub fn frame(
        &self,
        blocks: &mut Blocks<'_>,
        is_partial: bool,
    ) -> Result<Dataset, CampaignError> {
        let mut frame = blocks.frame();
        match self.study.refine {
            Some(Refine::Attractors) if !is_partial => {
                let known = blocks.final_motions()?;
                blocks.add(run::complete_basin(self.study, &known, self.machine)?);
            }
            Some(Refine::Outputs(_)) => self.infer(&mut frame, blocks, is_partial)?,
            _ => {}
        }
        self.add_attractors(&mut frame, blocks)?;
        Ok(frame)
    }

    /// Infers the cases of a refined map that have not been computed, after those that the tiles lack have been, unless it is
    /// partial; then a sample of them is computed as a check, too.
    fn infer(
        &self,
        frame: &mut Dataset,
        blocks: &mut Blocks<'_>,
        is_partial: bool,
    ) -> Result<(), CampaignError> {
        if !is_partial {
            let known = blocks.map_points()?;
            blocks.add(run::complete_map(self.study, &known, self.machine)?);
        }
        let inferred = run::infer_cases(self.study, &blocks.map_points()?);
        if !is_partial && let Some(sample) = run::check_cases(self.study, &inferred, self.machine)?
        {
            add_sample(frame, sample);
        }
        blocks.infer(inferred);
        Ok(())
    }

    /// Searches for the attractors that the cases of `blocks` have ended on, if there are any.
    fn add_attractors(
        &self,
        frame: &mut Dataset,
        blocks: &Blocks<'_>,
    ) -> Result<(), CampaignError> {
        let reports = self.reports;
        if !has_attractors(self.study) {
            return Ok(());
        }
        reports.send(Event::Begun(Stage::Linking, run::links(self.study)))?;
        let states = blocks.final_motions()?;
        let attractors =
            run::attractors(self.study, &states, self.machine, || reports.step(Stage::Linking))?;
        reports.send(Event::Ended(Stage::Linking))?;
        // A request to stop takes effect below, as for every stage that cannot be interrupted.
        let begins = |saddles| {
            let _ = reports.note(Event::Begun(Stage::Tracing, saddles));
        };
        let mut table =
            run::attractor_table(self.study, &attractors, &states, self.machine, begins)?;
        drop(states);
        // Those of a refined study that are followed lie near the boundaries, and take longer than the others would.
        if !table.rows.is_empty() && self.study.refine.is_none() {
            let cycles = blocks.verdicts()?.into_iter().map(|(case, _, cycles)| (case, cycles));
            table.note_cycles(&attractors, cycles);
        }
        reports.send(Event::Ended(Stage::Tracing))?;
        add_attractors(frame, self.study, &attractors, &table);
        Ok(())
    }
}
