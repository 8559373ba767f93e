//! Motions under tolerances of the parameters: each draw is followed from the orbit to where it settles.

use super::answer::{Answer, Named};
use super::error::CampaignError;
use super::motion_row::Row;
use super::refined_front::{Refinement, Whereabouts};
use super::report::{Event, Reports, Stage};
use super::robustness::{Draw, Robustness, Tolerances};
use crate::description::{Outputs, Parameter, State};
use crate::motion::Case;
use crate::of::settle_case;
use crate::orbit::Outcome;
use crate::run::on_all_threads;
use crate::store::takes_part;
use crate::tradeoff::{Optimum, front};

impl Refinement<'_> {
    /// What tolerances leave of each of some motions, none where it does not repeat; calls `done` after each motion.
    ///
    /// # Method
    ///
    /// The parameters of every draw are those of the motion times factors that are the same for all motions. The draw starts at
    /// the section point of the orbit, as a device does that runs while its parameters drift, and is settled like a case; it
    /// keeps the motion if it settles to the same period. Chaotic and quasi-periodic motions count by their means.
    ///
    /// # Breaks
    ///
    /// Another attractor of the same period is taken for the same motion.
    ///
    /// Fails if the file cannot be read or a case cannot be computed again.
    pub fn robustness(
        &self,
        rows: &[&Row],
        tolerances: &Tolerances,
        threads: Option<usize>,
        done: impl Fn() + Sync,
    ) -> Result<Vec<Option<Robustness>>, CampaignError> {
        let draws = tolerances.factors();
        let found = on_all_threads(threads, rows.len(), |number| {
            let whereabouts = self.whereabouts(rows[number]);
            let found = whereabouts.map(|it| it.map(|it| self.under(&it, &draws)));
            done();
            found
        })?;
        found.into_iter().collect()
    }

    /// What is left of a motion in draws with these factors of its parameters.
    fn under(&self, motion: &Whereabouts, draws: &[Vec<(Parameter, f64)>]) -> Robustness {
        let draws: Vec<Draw> = draws.iter().map(|factors| self.draw(motion, factors)).collect();
        Robustness::of(&draws)
    }

    /// A draw of a motion with these factors of its parameters.
    fn draw(&self, motion: &Whereabouts, factors: &[(Parameter, f64)]) -> Draw {
        let mut parameters = motion.parameters.clone();
        for (parameter, factor) in factors {
            parameters[*parameter] *= factor;
        }
        let start = State::at_section(self.study.base.model(), &motion.section);
        let case = Case::at_section(parameters, start, motion.phase);
        let orbit = settle_case(&case, &self.protocol());
        let counts = takes_part(orbit.outcome.name());
        let outputs =
            if counts { orbit.outputs.clone() } else { Outputs::unknown(self.study.base.model()) };
        let price = outputs[self.of.cost];
        let meets = self.asked.met(&case.parameters, &orbit);
        Draw {
            gain: self.direction.of(outputs[self.of.gain]),
            price,
            is_kept: orbit.outcome == Outcome::Periodic && orbit.period == motion.period,
            meets_conditions: meets.map(|it| it && counts),
            is_within_budget: self.budget.map(|most| price <= most),
        }
    }
}

/// Adds what tolerances leave of the optima and the front, and which motions of the front are best then.
pub(super) fn judge(
    answer: &mut Answer,
    refinement: &Refinement<'_>,
    tolerances: &Tolerances,
    threads: Option<usize>,
    reports: &Reports<'_>,
) -> Result<(), CampaignError> {
    let rows: Vec<&Row> = answer.rows().collect();
    reports.send(Event::Begun(Stage::Drawing, rows.len()))?;
    let found =
        refinement.robustness(&rows, tolerances, threads, || reports.step(Stage::Drawing))?;
    reports.send(Event::Ended(Stage::Drawing))?;
    answer.rows_mut().zip(found).for_each(|(row, robustness)| row.robustness = robustness);
    let (mut places, mut prices, mut gains) = (Vec::new(), Vec::new(), Vec::new());
    for (place, row) in answer.front.iter().enumerate() {
        let robustness = row.robustness.filter(|it| it.gain > answer.at_rest.0);
        if let Some(Robustness { price, gain, .. }) = robustness.filter(|it| it.price.is_finite()) {
            places.push(place);
            prices.push(price);
            gains.push(gain);
        }
    }
    answer.robust_front = front(&prices, &gains).into_iter().map(|at| places[at]).collect();
    // The front of rising prices ends with the most gain.
    let most = answer.robust_front.last().map(|&place| answer.front[place].clone());
    let name = Optimum::MostUnderTolerances.name(answer.of);
    answer.named.push(Named { name, row: most });
    Ok(())
}
