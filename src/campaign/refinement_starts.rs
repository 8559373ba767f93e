//! What the searches of a refinement begin with: cases of the file, and points drawn over the ranges of its parameters.

use std::collections::{BTreeMap, BTreeSet};

use super::error::CampaignError;
use super::refined_front::{Refinement, Search};
use super::refined_motion::{DrawnMotion, Start};
use crate::description::State;
use crate::motion::Case;
use crate::of::settle_case;
use crate::orbit::Outcome;
use crate::run::on_all_threads;
use crate::store::catalogue::{ATTRACTOR, PERIOD};
use crate::store::{CaseTable, StoreError};
use crate::study::{Coordinate, DrawKind, Draws, Range, Spacing};
use crate::tradeoff::{Candidate, Goal, Optima, optima};

/// Cases from which each optimum is sought, the best first.
const STARTS: usize = 8;
/// As many more are drawn from all that move.
const DRAWN: usize = 24;
/// Cases of the fronts that remain where the better ones are left out, at most.
const BEHIND_THE_FRONT: usize = 32;
/// Cases that gain the most of their kind in a part of the range of prices, at most.
const OF_EACH_KIND: usize = 32;
/// Parts of the range of prices, each as many times dearer than the one before.
const PARTS: usize = 8;

/// An odd number that spreads the bits of a product.
const MIXES: u64 = 0x9e37_79b9_7f4a_7c15;

impl Refinement<'_> {
    /// The periodic motions in the direction asked for that so many points settle to from rest, by their numbers; calls `done` after
    /// each point.
    ///
    /// # Method
    ///
    /// The points are the additive recurrence R_d over the ranges of the free parameters, shifted by the seed: the first of more points
    /// are the same. The capsule starts at rest at the section.
    ///
    /// Fails if the threads cannot be started.
    pub fn drawn_motions(
        &self,
        count: usize,
        threads: Option<usize>,
        done: impl Fn() + Sync,
    ) -> Result<Vec<DrawnMotion>, CampaignError> {
        let ranges = self.free().into_iter().map(|(parameter, ends)| {
            Range::even(Coordinate::Parameter(parameter), ends, Spacing::Linear)
        });
        let (kind, ranges) = (DrawKind::LowDiscrepancy, ranges.collect());
        let points = Draws { kind, count, seed: self.seed, ranges };
        let found = on_all_threads(threads, count, |number| {
            let found = self.drawn_motion(&points, number);
            done();
            found
        })?;
        Ok(found.into_iter().flatten().collect())
    }

    fn drawn_motion(&self, points: &Draws, number: usize) -> Option<DrawnMotion> {
        let mut parameters = self.study.base.clone();
        for (place, (parameter, _)) in self.free().into_iter().enumerate() {
            parameters[parameter] = points.value(number, place);
        }
        let phase = self.study.section_phase;
        let case = Case::at_section(parameters, State::origin(self.study.base.model()), phase);
        let orbit = settle_case(&case, &self.protocol());
        let gain = self.direction.of(orbit.outputs[self.of.gain]);
        let counts = orbit.outcome == Outcome::Periodic
            && gain > self.at_rest
            && self.conditions.may_begin(&case.parameters, orbit.period);
        counts.then_some(DrawnMotion {
            number,
            parameters: case.parameters,
            section: orbit.end.section(),
            period: orbit.period,
            outputs: orbit.outputs,
        })
    }

    /// The searches among the motions of the file and those of drawn points, each once.
    ///
    /// # Method
    ///
    /// From each periodic motion of the front, of the fronts behind it, of each kind in each part of the range of prices, and of the
    /// drawn points: the most gain for no more than its price. From those with the most gain, from those with the least cost per gain, and
    /// from some cases drawn by the seed: the most gain and, of a speed, the least energy per distance. Kinds differ in period, attractor
    /// or the counts of events per cycle.
    pub fn searches(
        &self,
        candidates: &[Candidate],
        optima: &Optima,
        drawn: &[DrawnMotion],
    ) -> Vec<Search> {
        let moving: Vec<usize> = (0..candidates.len())
            .filter(|at| {
                let it = &candidates[*at];
                self.is_periodic(it) && self.direction.of(it.gain) > optima.at_rest
            })
            .collect();
        let mut searches: Vec<Search> = Vec::new();
        let priced = self.for_prices(candidates, optima, drawn, &moving).into_iter();
        for search in priced.chain(self.for_extremes(candidates, drawn, &moving)) {
            if !searches.contains(&search) {
                searches.push(search);
            }
        }
        searches
    }

    /// Whether the motion of a case repeats.
    fn is_periodic(&self, candidate: &Candidate) -> bool {
        self.periods[candidate.case] > 0.0
    }

    /// The searches for the most gain at the prices of motions.
    fn for_prices(
        &self,
        candidates: &[Candidate],
        optima: &Optima,
        drawn: &[DrawnMotion],
        moving: &[usize],
    ) -> Vec<Search> {
        let mut behind = self.behind_the_front(candidates, optima);
        behind.retain(|at| self.is_periodic(&candidates[*at]));
        behind.truncate(BEHIND_THE_FRONT);
        let of_front = optima.front.iter().copied();
        let of_front = of_front.filter(|at| self.is_periodic(&candidates[*at]));
        let of_cases = of_front.chain(behind).chain(self.of_each_kind(candidates, moving));
        let of_cases = of_cases.map(|at| (self.start(&candidates[at]), candidates[at].price));
        let of_drawn = drawn.iter().map(|it| (self.drawn_start(it), it.outputs[self.of.cost]));
        let searches = of_cases
            .chain(of_drawn)
            .map(|(from, price)| Search { from, goal: self.most(Some(price)) });
        searches.collect()
    }

    /// The searches for the most gain, and for the least of what the model has as the cost per gain, whatever the price.
    fn for_extremes(
        &self,
        candidates: &[Candidate],
        drawn: &[DrawnMotion],
        moving: &[usize],
    ) -> Vec<Search> {
        let direction = self.direction;
        // Each start with its gain and its cost per gain.
        let mut known: Vec<(Start, f64, f64)> = Vec::new();
        known.extend(moving.iter().map(|&at| {
            let it = &candidates[at];
            (self.start(it), direction.of(it.gain), it.per_gain)
        }));
        known.extend(drawn.iter().map(|it| {
            let gain = direction.of(it.outputs[self.of.gain]);
            (self.drawn_start(it), gain, self.of.per_gain(&it.outputs))
        }));
        let by_seed: Vec<Start> =
            self.drawn_cases(moving).into_iter().map(|at| self.start(&candidates[at])).collect();
        known.sort_by(|a, b| b.1.total_cmp(&a.1));
        let most: Vec<Start> = known.iter().take(STARTS).map(|it| it.0).collect();
        known.sort_by(|a, b| a.2.total_cmp(&b.2));
        let cheapest: Vec<Start> = known.iter().take(STARTS).map(|it| it.0).collect();
        // A cost over a gain that is no output of the model is no goal: its least is on the front, along which others are sought.
        let least = self.of.told_per_gain().map(|output| (cheapest, Goal::Least(output)));
        let goals = [Some((most, self.most(None))), least].into_iter().flatten();
        let searches = goals.flat_map(|(best, goal)| {
            best.into_iter().chain(by_seed.clone()).map(move |from| Search { from, goal })
        });
        searches.collect()
    }

    fn start(&self, candidate: &Candidate) -> Start {
        Start::Case(candidate.case)
    }

    fn drawn_start(&self, motion: &DrawnMotion) -> Start {
        Start::Drawn { seed: self.seed, drawn: motion.number }
    }

    /// Some of the motions, by the seed.
    fn drawn_cases(&self, moving: &[usize]) -> Vec<usize> {
        let mut random = fastrand::Rng::with_seed(self.seed);
        let count = if moving.is_empty() { 0 } else { DRAWN };
        (0..count).map(|_| moving[random.usize(..moving.len())]).collect()
    }

    /// The front of what remains of the motions without the first front, that without both, and so on.
    fn behind_the_front(&self, candidates: &[Candidate], first: &Optima) -> Vec<usize> {
        let mut left: Vec<Candidate> = candidates.to_vec();
        let mut gone = first.front.clone();
        let mut found = Vec::new();
        while found.len() < BEHIND_THE_FRONT && !gone.is_empty() {
            gone.iter().for_each(|&at| left[at].gain = f64::NAN);
            gone = optima(&left, self.direction, Some(first.at_rest)).front;
            found.extend(&gone);
        }
        found
    }

    /// The motion with the most gain of each kind in each part of the range of prices: the best of each part first.
    fn of_each_kind(&self, candidates: &[Candidate], moving: &[usize]) -> Vec<usize> {
        let gains: Vec<f64> = candidates.iter().map(|it| self.direction.of(it.gain)).collect();
        // Each with the logarithm of its price.
        let priced = moving.iter().map(|&at| (at, candidates[at].price.ln()));
        let dear: Vec<(usize, f64)> = priced.filter(|(_, price)| price.is_finite()).collect();
        let [low, high] =
            dear.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, price)| {
                [low.min(*price), high.max(*price)]
            });
        let mut best: BTreeMap<(usize, u64), usize> = BTreeMap::new();
        for (at, price) in dear {
            let share = (price - low) / (high - low).max(f64::MIN_POSITIVE);
            let part = ((share * PARTS as f64) as usize).min(PARTS - 1);
            let kind = self.kinds.get(candidates[at].case).copied().unwrap_or_default();
            let known = best.entry((part, kind)).or_insert(at);
            if gains[at] > gains[*known] {
                *known = at;
            }
        }
        let mut found: Vec<(usize, usize)> = Vec::new();
        for part in 0..PARTS {
            let mut of_part: Vec<usize> =
                best.iter().filter(|it| it.0.0 == part).map(|it| *it.1).collect();
            of_part.sort_by(|&a, &b| gains[b].total_cmp(&gains[a]).then(a.cmp(&b)));
            found.extend(of_part.into_iter().enumerate());
        }
        // The best of all parts come first, then the second ones.
        found.sort_by_key(|it| it.0);
        found.truncate(OF_EACH_KIND);
        found.into_iter().map(|it| it.1).collect()
    }
}

/// A number for each case that differs, but for chance, between motions of another period, attractor or counts of events per cycle.
///
/// Fails if the file cannot be read.
pub(super) fn kinds(table: &CaseTable<'_>) -> Result<Vec<u64>, StoreError> {
    let mut kinds = vec![0_u64; table.cases()];
    let counts = table.model().event_counts();
    let names = [PERIOD.name, ATTRACTOR.name].into_iter().chain(counts.map(|it| it.name()));
    for name in names {
        let Some(column) = table.column(name)? else { continue };
        for (kind, value) in kinds.iter_mut().zip(&column.values) {
            *kind = (*kind ^ value.to_bits()).wrapping_mul(MIXES).rotate_left(29);
        }
    }
    Ok(kinds)
}

/// How many different motions and points searches begin with.
pub fn starts(searches: &[Search]) -> usize {
    searches.iter().map(|it| it.from).collect::<BTreeSet<_>>().len()
}
