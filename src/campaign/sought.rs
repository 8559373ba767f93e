//! The search for motions between the cases of a file: from its starts, to other prices, and along the front that they make.

use crate::tradeoff::{Candidate, Optima, optima as best_of};

use super::answer::Searched;
use super::error::CampaignError;
use super::refined_front::Refinement;
use super::refined_motion::{Led, RefinedMotion, distinct};
use super::refinement_starts::starts;
use super::report::{Event, Reports, Stage};

/// What was found between the cases.
pub(super) struct Sought {
    /// The searches.
    pub searched: Searched,
    /// How many points were drawn, and from how many of them searches began.
    pub drawn: Option<[usize; 2]>,
    /// The motions found, each once.
    pub motions: Vec<RefinedMotion>,
}

/// The front of the cases and of motions between them: prices and gains, and its motions where they are refined ones.
struct Front<'m> {
    points: Vec<(f64, f64)>,
    motions: Vec<Option<&'m RefinedMotion>>,
}

impl Refinement<'_> {
    /// The motions between the cases that searches from the cases, with these optima, and from so many drawn points lead to.
    ///
    /// # Method
    ///
    /// Rounds of searches: from the starts, see [`searches`](Self::searches); from what these led to, at prices over the whole
    /// range, see [`ladders`](Self::ladders); along the front, see [`gaps`](Self::gaps); and at the budget, if there is one, see
    /// [`at_budget`](Self::at_budget).
    ///
    /// # Breaks
    ///
    /// Each search is local: a family of orbits that no start belongs to is not found.
    ///
    /// Fails if the file cannot be read, a case cannot be computed again, or the listener has asked to stop.
    pub(super) fn sought(
        &self,
        cases: &[Candidate],
        optima: &Optima,
        points: usize,
        threads: Option<usize>,
        reports: &Reports<'_>,
    ) -> Result<Sought, CampaignError> {
        reports.send(Event::Begun(Stage::Starting, points))?;
        let drawn = self.drawn_motions(points, threads, || reports.step(Stage::Starting))?;
        reports.send(Event::Ended(Stage::Starting))?;
        let searches = self.searches(cases, optima, &drawn);
        reports.send(Event::Begun(Stage::Searching, searches.len()))?;
        let found = self.run(&searches, &drawn, threads, || reports.step(Stage::Searching))?;
        reports.send(Event::Ended(Stage::Searching))?;
        let ladders = self.ladders(&self.front(cases, &found.motions).points, &found.motions);
        reports.send(Event::Begun(Stage::Climbing, ladders.len()))?;
        let climbed = self.followed(&ladders, threads, || reports.step(Stage::Climbing))?;
        reports.send(Event::Ended(Stage::Climbing))?;
        let climbing = ladders.len();
        let both = distinct([found.motions, climbed.motions].concat());
        let front = self.front(cases, &both);
        let prices = front.points.iter().map(|it| it.0);
        let gaps = self.gaps(&prices.zip(front.motions).collect::<Vec<_>>());
        reports.send(Event::Begun(Stage::Following, gaps.len()))?;
        let Led { motions, unsettled } =
            self.followed(&gaps, threads, || reports.step(Stage::Following))?;
        reports.send(Event::Ended(Stage::Following))?;
        let followed = distinct([both.clone(), motions].concat());
        let last = self.at_budget(&followed);
        let at_budget = self.followed(&last, threads, || ())?;
        let searched = Searched {
            searches: searches.len() + climbing + gaps.len() + last.len(),
            starts: starts(&searches),
            unsettled: found.unsettled + climbed.unsettled + unsettled + at_budget.unsettled,
            directions: vec![self.direction],
        };
        let drawn = Some([points, drawn.len()]);
        let motions = distinct([followed.clone(), at_budget.motions].concat());
        Ok(Sought { searched, drawn, motions })
    }

    /// The front of cases and motions between them.
    fn front<'m>(&self, cases: &[Candidate], motions: &'m [RefinedMotion]) -> Front<'m> {
        let count = self.periods.len();
        let numbered = motions.iter().enumerate();
        let refined = numbered.map(|(place, motion)| motion.candidate(count + place, self.of));
        let all: Vec<Candidate> = cases.iter().copied().chain(refined).collect();
        let front = best_of(&all, self.direction, Some(self.at_rest));
        let refined = front.front.iter().map(|&at| all[at].case.checked_sub(count));
        Front {
            points: front.points(&all, self.direction),
            motions: refined.map(|place| Some(&motions[place?])).collect(),
        }
    }
}
