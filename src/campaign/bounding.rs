//! The margins of the optima of a trade-off: how far their parameters may change.

use super::answer::Answer;
use super::error::CampaignError;
use super::margins::{Margin, Margins, margin};
use super::refined_front::{Refinement, Whereabouts};
use super::report::{Event, Reports, Stage};
use crate::description::{Parameter, Section};
use crate::model::{Along, Model, Setting};
use crate::orbit::Varied;
use crate::run::on_all_threads;

/// So far a parameter is followed, down and up, as a share of its value.
const REACH: [f64; 2] = [-0.5, 0.5];

/// A motion and one of its parameters, whose margins are sought.
struct Bounded {
    parameter: Parameter,
    along: Along,
    /// The parameter's value (SI).
    value: f64,
    /// The section points of the motion.
    points: Vec<Section>,
}

impl Bounded {
    /// The margin while the parameter falls or rises by a share of its value.
    fn margin(&self, model: &dyn Model, reach: f64) -> Margin {
        margin(model, &self.along, self.value, &self.points, reach * self.value)
    }
}

impl Refinement<'_> {
    /// A motion with each of its parameters that is above zero, whether the study varies it or not; none where it is not stable.
    fn bounded(&self, motion: &Whereabouts) -> Vec<Bounded> {
        let Whereabouts { parameters, section, phase, period } = motion;
        let (model, tolerance) = (self.study.model(), self.study.protocol.tolerance);
        let setting = Setting { parameters: parameters.clone(), phase: *phase };
        let Some(points) = model.section_points(&setting, *section, *period, tolerance) else {
            return Vec::new();
        };
        let each = parameters.stated().filter(|(_, value)| *value > 0.0);
        let bounded = each.map(|(parameter, value)| Bounded {
            parameter,
            along: Along { setting: setting.clone(), varied: Varied::One(parameter), tolerance },
            value,
            points: points.clone(),
        });
        bounded.collect()
    }

    /// The margins of each of some motions, in their order, followed by half of each parameter's value down and up, see [`margin`].
    ///
    /// Fails if the reports tell to stop, or if the threads cannot be started.
    fn margins(
        &self,
        motions: &[Whereabouts],
        threads: Option<usize>,
        reports: &Reports<'_>,
    ) -> Result<Vec<Vec<Margins>>, CampaignError> {
        let bounded =
            on_all_threads(threads, motions.len(), |number| self.bounded(&motions[number]))?;
        let all: Vec<&Bounded> = bounded.iter().flatten().collect();
        // A capsule that impacts hundreds of times in a cycle takes a minute for all of them, so that each is a task of its own.
        let tasks = REACH.len() * all.len();
        reports.send(Event::Begun(Stage::Bounding, tasks))?;
        let found = on_all_threads(threads, tasks, |task| {
            reports.check()?;
            let margin =
                all[task / REACH.len()].margin(self.study.model(), REACH[task % REACH.len()]);
            reports.step(Stage::Bounding);
            Ok(margin)
        })?;
        reports.send(Event::Ended(Stage::Bounding))?;
        let found = found.into_iter().collect::<Result<Vec<Margin>, CampaignError>>()?;
        let both = found.chunks_exact(REACH.len());
        let mut margins = all.iter().zip(both).map(|(it, both)| Margins {
            parameter: it.parameter,
            at: it.value,
            down: both[0].clone(),
            up: both[1].clone(),
        });
        Ok(bounded.iter().map(|of| margins.by_ref().take(of.len()).collect()).collect())
    }
}

/// Adds the margins of the optima. One motion may be the best in several senses, and is followed once.
pub(super) fn bound(
    answer: &mut Answer,
    refinement: &Refinement<'_>,
    threads: Option<usize>,
    reports: &Reports<'_>,
) -> Result<(), CampaignError> {
    let mut motions: Vec<Whereabouts> = Vec::new();
    let mut numbers = Vec::new();
    for row in answer.named.iter().filter_map(|it| it.row.as_ref()) {
        let motion = refinement.whereabouts(row)?;
        numbers.push(motion.map(|motion| {
            motions.iter().position(|it| *it == motion).unwrap_or_else(|| {
                motions.push(motion);
                motions.len() - 1
            })
        }));
    }
    let found = refinement.margins(&motions, threads, reports)?;
    let rows = answer.named.iter_mut().filter_map(|it| it.row.as_mut());
    for (row, number) in rows.zip(numbers) {
        row.margins = number.map_or(Vec::new(), |number| found[number].clone());
    }
    Ok(())
}
