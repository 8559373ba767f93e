//! The margins of the optima of a trade-off: how far their parameters may change.

use crate::capsule::Parameter;
use crate::model::{Along, Setting};
use crate::run::on_all_threads;

use super::answer::Answer;
use super::error::CampaignError;
use super::margins::{Margins, margin};
use super::motion_row::Row;
use super::refined_front::{Refinement, Whereabouts};
use super::report::{Event, Reports, Stage};

/// So far a parameter is followed down and up, as a share of its value.
const REACH: f64 = 0.5;

impl Refinement<'_> {
    /// The margins of each of some motions along each parameter that is above zero, whether the study varies it or not; none
    /// where a motion does not repeat or is not stable. Calls `done` after each motion.
    ///
    /// Each is followed by half the parameter's value each way, see [`margin`].
    ///
    /// Fails if the file cannot be read or a case cannot be computed again.
    pub fn margins(
        &self,
        rows: &[&Row],
        (threads, done): (Option<usize>, impl Fn() + Sync),
    ) -> Result<Vec<Vec<Margins>>, CampaignError> {
        let found = on_all_threads(threads, rows.len(), |number| {
            let whereabouts = self.whereabouts(rows[number]);
            let found = whereabouts.map(|it| it.map_or(Vec::new(), |motion| self.around(&motion)));
            done();
            found
        })?;
        found.into_iter().collect()
    }

    fn around(&self, motion: &Whereabouts) -> Vec<Margins> {
        let Whereabouts { parameters, section, phase, period } = motion;
        let (model, tolerance) = (self.study.model(), self.study.protocol.tolerance);
        let setting = Setting { parameters: parameters.clone(), phase: *phase };
        let Some(points) = model.section_points(&setting, *section, *period, tolerance) else {
            return Vec::new();
        };
        let both = |parameter: Parameter| {
            let along = Along { setting: setting.clone(), parameter, tolerance };
            let value = parameters[parameter];
            let [down, up] =
                [-REACH, REACH].map(|by| margin(model, &along, (value, &points), by * value));
            Margins { parameter, at: value, down, up }
        };
        let each = Parameter::ALL.iter().copied();
        each.filter(|parameter| parameters[*parameter] > 0.0).map(both).collect()
    }
}

/// Adds the margins of the optima.
pub(super) fn bound(
    answer: &mut Answer,
    refinement: &Refinement<'_>,
    threads: Option<usize>,
    reports: &Reports<'_>,
) -> Result<(), CampaignError> {
    let rows: Vec<&Row> = answer.named.iter().filter_map(|it| it.row.as_ref()).collect();
    reports.send(Event::Begun(Stage::Bounding, rows.len()))?;
    let step = || reports.step(Stage::Bounding);
    let found = refinement.margins(&rows, (threads, step))?;
    reports.send(Event::Ended(Stage::Bounding))?;
    let rows = answer.named.iter_mut().filter_map(|it| it.row.as_mut());
    rows.zip(found).for_each(|(row, margins)| row.margins = margins);
    Ok(())
}
