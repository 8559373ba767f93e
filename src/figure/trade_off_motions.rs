//! The motions that a trade-off shows: those of the cases, those found between them, and the best in each direction.

use super::error::FigureError;
use super::outcome::Outcomes;
use super::view::View;
use crate::campaign::{KeptFront, RefinedMotion, Searched};
use crate::store::catalogue::DRAW;
use crate::store::takes_part;
use crate::study::Coordinate;
use crate::tradeoff::{Candidate, Direction, GainAndCost, Optima, cost_per_gain, optima};

/// The directions, each with a front and optima of its own.
pub const DIRECTIONS: [Direction; 2] = [Direction::Forward, Direction::Backward];

/// The motions of a figure.
pub struct Motions<'a> {
    /// What they gain and cost.
    pub of: GainAndCost,
    /// The cases that have both outputs, each with its place over the free axes, and then the refined motions, numbered after all
    /// cases (SI).
    all: Vec<Candidate>,
    /// How many of them are cases.
    of_cases: usize,
    /// Number of cases, with or without outputs.
    pub count: usize,
    /// The outcome of each case.
    outcomes: Outcomes<'a>,
    /// What is shown of the motions between the cases, and the conditions of the front; none where nothing was sought.
    sought: Option<&'a KeptFront>,
    refined: &'a [RefinedMotion],
    /// How many cases have no outputs, those aside that are not computed yet.
    pub left_out: usize,
    /// How many cases are not computed yet.
    pub not_yet: usize,
    /// The gain up to which a motion is one without gain, as at rest (SI).
    pub at_rest: f64,
}

/// The best of the motions in a direction.
pub struct Best {
    /// The direction.
    pub direction: Direction,
    /// The best of all motions, by their places.
    pub of_all: Optima,
    /// The front of the cases alone, as prices and gains (SI).
    pub front_of_cases: Vec<(f64, f64)>,
    /// The front of all motions, as prices and gains (SI).
    pub front: Vec<(f64, f64)>,
}

impl Best {
    /// No motion at all.
    pub fn none(direction: Direction) -> Best {
        let (front_of_cases, front) = (Vec::new(), Vec::new());
        Best { direction, of_all: Optima::default(), front_of_cases, front }
    }

    /// Without what the request hides.
    pub fn shown(mut self, view: &View<'_>) -> Best {
        if !view.shows("fronts") {
            self.front.clear();
            self.front_of_cases.clear();
            self.of_all.front.clear();
        }
        if !view.shows("optima") {
            let (knee, most_gain, least_per_gain) = (None, None, None);
            self.of_all = Optima { knee, most_gain, least_per_gain, ..self.of_all };
        }
        self
    }
}

impl<'a> Motions<'a> {
    /// The motions of a view over the axes `free`, with a gain and a cost, that make fronts under the conditions of `sought`, or
    /// without any; those between the cases only where no axis is held, as they may lie anywhere along it.
    pub fn of(
        view: &View<'a>,
        of: GainAndCost,
        free: &[&str],
        sought: Option<&'a KeptFront>,
    ) -> Result<Motions<'a>, FigureError> {
        let (prices, gains) = (view.take(of.cost.name(), free)?, view.take(of.gain.name(), free)?);
        if prices.len() != gains.len() {
            let why = format!("`{}` does not have one value per case", of.cost.name());
            return Err(view.unfit(why));
        }
        let told = told_per_gain(view, of, free)?;
        let all = prices.iter().zip(&gains).enumerate().map(|(case, (price, gain))| Candidate {
            case,
            gain: *gain,
            price: *price,
            per_gain: told.get(case).copied().unwrap_or_else(|| cost_per_gain(*gain, *price)),
        });
        let count = gains.len();
        let mut all: Vec<Candidate> =
            all.filter(|it| it.price.is_finite() && it.gain.is_finite()).collect();
        let of_cases = all.len();
        let at_rest = of.at_rest(all.iter().map(|it| it.gain));
        let refined = sought.map_or(&[][..], |it| &it.motions);
        let numbered = refined.iter().enumerate();
        all.extend(numbered.map(|(place, motion)| motion.candidate(count + place, of)));
        let outcomes = Outcomes::over(view, free)?;
        let not_yet = (0..count).filter(|case| outcomes.missing(*case)).count();
        let left_out = count - of_cases - not_yet;
        Ok(Motions {
            of,
            all,
            of_cases,
            count,
            outcomes,
            sought,
            refined,
            left_out,
            not_yet,
            at_rest,
        })
    }

    /// The cases that have both outputs.
    pub fn cases(&self) -> &[Candidate] {
        &self.all[..self.of_cases]
    }

    /// The number of motions between the cases.
    pub fn between(&self) -> usize {
        self.refined.len()
    }

    /// The motion between the cases that a candidate is, if it is one.
    pub fn refined(&self, candidate: &Candidate) -> Option<&'a RefinedMotion> {
        candidate.case.checked_sub(self.count).map(|place| &self.refined[place])
    }

    /// The motion at a place among all.
    pub fn at(&self, place: usize) -> &Candidate {
        &self.all[place]
    }

    /// Whether a motion is periodic, or nothing else is known of it.
    pub fn is_periodic(&self, motion: &Candidate) -> bool {
        motion.case >= self.count || self.outcomes.periodic(motion.case)
    }

    /// Whether a motion may be among the best: it is no case that is undecided or failed, or does not keep the conditions.
    pub fn counts(&self, motion: &Candidate) -> bool {
        let is_case = motion.case < self.count;
        let keeps = self.sought.is_none_or(|it| !is_case || it.has(motion.case));
        keeps && self.outcome(motion).is_none_or(takes_part)
    }

    /// The conditions of the front, in one text; none where there are none.
    pub fn condition(&self) -> Option<String> {
        self.sought.map(KeptFront::condition).filter(|it| !it.is_empty())
    }

    /// The searches between the cases; none where there were none.
    pub fn searched(&self) -> Option<&'a Searched> {
        self.sought.map(|it| &it.searched)
    }

    /// The outcome of a motion that is a case, if it is known.
    pub fn outcome(&self, motion: &Candidate) -> Option<&'a str> {
        self.outcomes.name(motion.case).filter(|_| motion.case < self.count)
    }

    /// How many cases are shown that are not periodic: those whose means take part, and those that are undecided.
    pub fn aperiodic(&self) -> [usize; 2] {
        let aperiodic = self.cases().iter().filter(|it| !self.is_periodic(it));
        let (by_means, undecided): (Vec<&Candidate>, Vec<&Candidate>) =
            aperiodic.partition(|it| self.outcome(it).is_none_or(takes_part));
        [by_means.len(), undecided.len()]
    }

    /// The best in a direction; cases that are undecided or failed are not among them.
    pub fn best(&self, direction: Direction) -> Best {
        // What does not count is nowhere, so that places stay.
        let all = self.all.iter().map(|it| match self.counts(it) {
            true => *it,
            false => Candidate { gain: f64::NAN, ..*it },
        });
        let all: Vec<Candidate> = all.collect();
        let cases = &all[..self.of_cases];
        let of_all = optima(&all, direction, Some(self.at_rest));
        let of_cases = optima(cases, direction, Some(self.at_rest));
        let (front, front_of_cases) = (points(&of_all, &all), points(&of_cases, cases));
        Best { direction, of_all, front_of_cases, front }
    }

    /// A coordinate of a motion: of one between the cases its own, else from the values at the cases.
    pub fn coordinate(&self, motion: &Candidate, coordinate: Coordinate, of_case: &[f64]) -> f64 {
        let refined = self.refined(motion);
        refined.map_or_else(|| of_case[motion.case], |it| it.coordinate(coordinate))
    }
}

/// The front of some motions as prices and gains (SI).
fn points(optima: &Optima, motions: &[Candidate]) -> Vec<(f64, f64)> {
    optima.front.iter().map(|&at| (motions[at].price, motions[at].gain)).collect()
}

/// What is told as the cost per gain of each case (SI): of a speed the energy per metre, where the results have it; empty where it is the
/// price over the gain.
fn told_per_gain(view: &View<'_>, of: GainAndCost, free: &[&str]) -> Result<Vec<f64>, FigureError> {
    let Some(told) = of.told_per_gain() else { return Ok(Vec::new()) };
    let name = told.name();
    if view.dataset.variable(name).is_some() {
        return Ok(view.take(name, free)?.into_iter().collect());
    }
    match of.cost == view.model().power() {
        true => Ok(Vec::new()),
        false => Ok(vec![f64::NAN; view.take(of.cost.name(), free)?.len()]),
    }
}

/// The coordinates that vary among the cases over the axes `free`.
pub fn coordinates(view: &View<'_>, free: &[&str]) -> Vec<Coordinate> {
    let varying = Coordinate::all(view.model()).filter(|coordinate| {
        let name = coordinate.name();
        let is_axis = free.contains(&name) && view.coordinate_values(name).len() > 1;
        let variable = view.dataset.variable(name);
        let is_drawn = variable.is_some_and(|it| it.dimensions == [DRAW.name]);
        is_axis || is_drawn && free.contains(&DRAW.name)
    });
    varying.collect()
}
