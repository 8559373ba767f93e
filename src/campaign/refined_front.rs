//! From the best cases of a file to the best motions between and beside them: the refined front of a trade-off.

use serde_json::{Value, json};

use crate::capsule::{
    AsPrinted, CapsuleSystem, Case, Filippov, Output, Outputs, Parameter, Parameters, Reading,
    Section, State, Switching, settle_case,
};
use crate::orbit::{Outcome, Protocol};
use crate::run::{Machine, on_all_threads};
use crate::store::Archive;
use crate::store::catalogue::SECTION;
use crate::study::{Coordinate, Study};
use crate::tradeoff::{
    Best, Candidate, Direction, Family, Goal, MOST_FREE, OperatingPoint, Optima, best, left,
    sensitivity,
};

use super::conditions::Conditions;
use super::conditions_of_draws::OfDraws;
use super::error::CampaignError;
use super::kept_searches::KeptSearches;
use super::motion_row::Row;
use super::refined_motion::{RefinedMotion, Slopes, distinct, words};
use super::replay::Replay;
use super::report::silent;

/// Cases from which each optimum is sought, the best first.
const STARTS: usize = 8;
/// As many more are drawn from all that move.
const DRAWN: usize = 24;

/// A motion that is better by less than this share is the case from which it was sought.
const LEAST_GAIN: f64 = 1e-9;

/// A search for a better motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// The case that it begins with.
    from: usize,
    goal: Goal,
}

/// A periodic motion: its parameters, and a point of its orbit.
#[derive(Debug, Clone, PartialEq)]
pub struct Whereabouts {
    /// Its parameters.
    pub parameters: Parameters,
    /// Its section point (SI).
    pub section: Section,
    /// Phase of the drive at the section [rad].
    pub phase: f64,
    /// Period [cycles].
    pub period: u64,
}

/// What a search for better motions needs.
#[derive(Debug)]
pub struct Refinement<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its file of results.
    pub archive: &'a Archive,
    /// The period of each case; zero where it does not repeat.
    pub periods: Vec<f64>,
    /// The output that is to be small.
    pub of: Output,
    /// The direction in which speed counts.
    pub direction: Direction,
    /// What is asked of motions between the cases.
    pub conditions: Conditions,
    /// What is asked of motions under tolerances.
    pub asked: OfDraws,
    /// The most of the output that may be spent, if that is given (SI).
    pub budget: Option<f64>,
    /// Number of the drawing of starts.
    pub seed: u64,
    /// Searches that are done already, and where further ones are kept.
    pub kept: &'a KeptSearches,
}

impl Search {
    /// What it begins with.
    pub fn from(&self) -> usize {
        self.from
    }
}

impl Refinement<'_> {
    /// Parameters that vary, with the ends of their ranges as far as conditions allow.
    pub fn free(&self) -> Vec<(Parameter, [f64; 2])> {
        let varied = self.study.case_set.varied().into_iter();
        let free = varied.filter_map(|coordinate| match coordinate {
            Coordinate::Parameter(parameter) => {
                let ends = self.study.case_set.ends(coordinate)?;
                let [low, high] = self.conditions.within(parameter, ends);
                (high > low).then_some((parameter, [low, high]))
            }
            _ => None,
        });
        free.collect()
    }

    /// The searches among the motions of the file: from each periodic motion of the front, the most speed for no more than its
    /// price; from the fastest ones, from those with the least energy per metre, and from some drawn by the seed, the most
    /// speed and the least energy per metre. Each once.
    pub fn searches(&self, candidates: &[Candidate], optima: &Optima) -> Vec<Search> {
        let (direction, of) = (self.direction, self.of);
        let is_periodic = |at: &usize| self.periods[candidates[*at].case] > 0.0;
        let speed = |at: usize| direction.of(candidates[at].speed);
        let moving: Vec<usize> = (0..candidates.len())
            .filter(|at| is_periodic(at) && speed(*at) > optima.at_rest)
            .collect();
        let first = |key: &dyn Fn(usize) -> f64| -> Vec<usize> {
            let mut order = moving.clone();
            order.sort_by(|a, b| key(*a).total_cmp(&key(*b)));
            order.truncate(STARTS);
            order
        };
        let drawn = self.drawn(&moving);
        let fastest = Goal::Speed { direction, budget: None };
        let cheapest = Goal::Least(Output::EnergyPerMetre);
        let of_front = optima.front.iter().copied().filter(is_periodic).map(|at| {
            let most = candidates[at].price;
            (at, Goal::Speed { direction, budget: Some((of, most)) })
        });
        let faster = first(&|at| -speed(at)).into_iter().chain(drawn.iter().copied());
        let cheaper =
            first(&|at| candidates[at].energy_per_metre).into_iter().chain(drawn.iter().copied());
        let all =
            of_front.chain(faster.map(|at| (at, fastest))).chain(cheaper.map(|at| (at, cheapest)));
        let mut searches: Vec<Search> = Vec::new();
        for search in all.map(|(at, goal)| Search { from: candidates[at].case, goal }) {
            if !searches.contains(&search) {
                searches.push(search);
            }
        }
        searches
    }

    /// Some of the motions, by the seed.
    fn drawn(&self, moving: &[usize]) -> Vec<usize> {
        let mut random = fastrand::Rng::with_seed(self.seed);
        let count = if moving.is_empty() { 0 } else { DRAWN };
        (0..count).map(|_| moving[random.usize(..moving.len())]).collect()
    }

    /// The motions to which searches lead, in their order, each once; calls `done` after each search.
    ///
    /// # Method
    ///
    /// See [`best`]. The motion found is settled anew from its section point, as [`settle_case`] does, and counts if it is
    /// periodic with the same period, which near the loss of its stability it may be too slow for. Every search is by itself:
    /// neither threads nor order matter.
    ///
    /// Fails if the file cannot be read or a case cannot be computed again.
    pub fn run(
        &self,
        searches: &[Search],
        threads: Option<usize>,
        done: impl Fn() + Sync,
    ) -> Result<Vec<RefinedMotion>, CampaignError> {
        let found = self.each(threads, searches.len(), done, |number| {
            let search = &searches[number];
            self.kept.kept_or_found(&self.described(search), || match self.study.base.switching {
                Switching::Filippov => self.search::<Filippov>(search),
                Switching::AsPrinted => self.search::<AsPrinted>(search),
            })
        })?;
        Ok(distinct(found))
    }

    /// What a search depends on, beside the results.
    fn described(&self, Search { from, goal }: &Search) -> Value {
        let of = self.of.name();
        self.within_conditions(match goal {
            Goal::Speed { direction, budget } => {
                let most = budget.map(|(_, most)| most);
                json!({ "from": from, "moving": direction.name(), "of": of, "most": most })
            }
            Goal::Least(output) => {
                let moving = self.direction.name();
                json!({ "from": from, "moving": moving, "least": output.name(), "of": of })
            }
        })
    }

    /// What a search depends on, with the conditions if there are any.
    pub(super) fn within_conditions(&self, mut search: Value) -> Value {
        if let Some(conditions) = self.conditions.described() {
            search["where"] = conditions;
        }
        search
    }

    /// The motions that each of some searches leads to, in the order of the searches; calls `done` after each.
    pub(super) fn each(
        &self,
        threads: Option<usize>,
        count: usize,
        done: impl Fn() + Sync,
        search: impl Fn(usize) -> Result<Vec<RefinedMotion>, CampaignError> + Sync,
    ) -> Result<Vec<RefinedMotion>, CampaignError> {
        let found = on_all_threads(threads, count, |number| {
            let found = search(number);
            done();
            found
        })?;
        let found: Result<Vec<Vec<RefinedMotion>>, CampaignError> = found.into_iter().collect();
        Ok(found?.into_iter().flatten().collect())
    }

    /// The motion that a search leads to, if any.
    fn search<R: Reading>(&self, search: &Search) -> Result<Vec<RefinedMotion>, CampaignError> {
        let case = search.from;
        let Some((family, first)) = self.family::<R>(case)? else { return Ok(Vec::new()) };
        let before = first.outputs;
        let found = best(&family, first, search.goal);
        let gain = |it: &Best| self.gain(search.goal, [&before, &it.at.outputs]);
        let found = found.filter(|it| gain(it) >= LEAST_GAIN);
        Ok(found.and_then(|it| self.settled(&family, &it, case)).into_iter().collect())
    }

    /// The best orbit of a family, settled anew from its section point; none where it is not the same then or
    /// does not keep the conditions.
    pub(super) fn settled<R: Reading>(
        &self,
        family: &Family<R>,
        found: &Best,
        from: usize,
    ) -> Option<RefinedMotion> {
        let system = family.at(&found.at.shares);
        let [r, y1, y2] = found.at.section;
        let (start, phase) = (State { r, y1, x2: 0.0, y2 }, system.phase);
        let again = Case::at_section(system.parameters.clone(), start, phase);
        let orbit = settle_case(&again, &self.protocol());
        let is_same = orbit.outcome == Outcome::Periodic && orbit.period == family.period;
        let slopes = Slopes {
            sensitivity: self.sensitivity(&system, &found.at, family.period),
            stationarity: Some(found.stationarity),
            held_by: words(&found.held_by, family),
        };
        let counts = is_same && self.conditions.allow(&orbit.outputs);
        counts.then_some(RefinedMotion {
            from,
            parameters: system.parameters,
            section: found.at.section,
            phase,
            period: family.period,
            outputs: orbit.outputs,
            slopes,
        })
    }

    /// The relative gain from one motion to another.
    fn gain(&self, goal: Goal, [from, to]: [&Outputs; 2]) -> f64 {
        let ratio = |output: Output| to[output] / from[output];
        match goal {
            Goal::Speed { .. } => ratio(Output::ProgressionSpeed) - 1.0,
            Goal::Least(output) => 1.0 - ratio(output),
        }
    }

    /// How a motion that is found is computed again.
    pub fn protocol(&self) -> Protocol {
        let Protocol { tolerance, max_cycles, .. } = self.study.protocol;
        Protocol { max_cycles, ..Protocol::with_tolerance(tolerance) }
    }

    /// How speed and price of a case change with the parameters; nothing where it does not repeat.
    ///
    /// Fails if the file cannot be read or the case cannot be computed again.
    pub fn slopes(&self, candidate: &Candidate) -> Result<Slopes, CampaignError> {
        match self.study.base.switching {
            Switching::Filippov => self.slopes_as::<Filippov>(candidate),
            Switching::AsPrinted => self.slopes_as::<AsPrinted>(candidate),
        }
    }

    fn slopes_as<R: Reading>(&self, candidate: &Candidate) -> Result<Slopes, CampaignError> {
        let Some((family, at)) = self.family::<R>(candidate.case)? else {
            return Ok(Slopes::default());
        };
        let budget = Some((self.of, candidate.price));
        let goal = Goal::Speed { direction: self.direction, budget };
        let known = (!family.free.is_empty()).then(|| left(&family, &at, goal)).flatten();
        let (stationarity, held_by) = known.unzip();
        Ok(Slopes {
            sensitivity: self.sensitivity(&family.system, &at, family.period),
            stationarity,
            held_by: words(&held_by.unwrap_or_default(), &family),
        })
    }

    /// The family of the orbit of a case, with the orbit; none where it does not repeat or is not stable.
    fn family<R: Reading>(
        &self,
        case: usize,
    ) -> Result<Option<(Family<R>, OperatingPoint)>, CampaignError> {
        let Some(period) = Some(self.periods[case]).filter(|period| *period > 0.0) else {
            return Ok(None);
        };
        let Case { parameters, section_phase, .. } = self.study.case(case);
        let Some(section) = self.section(case)? else { return Ok(None) };
        let family = self.family_of((parameters, section_phase), period as u64);
        let first = family.orbit(&family.shares(), &section);
        Ok(first.map(|first| (family, first)))
    }

    /// Percent of speed and of price per percent of each parameter.
    fn sensitivity<R: Reading>(
        &self,
        system: &CapsuleSystem<R>,
        at: &OperatingPoint,
        period: u64,
    ) -> Vec<(Parameter, [f64; 2])> {
        let each = Parameter::ALL.iter().filter(|it| system.parameters[**it] != 0.0);
        let tolerance = self.study.protocol.tolerance;
        each.filter_map(|parameter| {
            let found = sensitivity(system, (&at.section, period), tolerance, *parameter)?;
            let value = system.parameters[*parameter];
            let relative = |output: Output| value * found.slopes[output] / found.outputs[output];
            Some((*parameter, [relative(Output::ProgressionSpeed), relative(self.of)]))
        })
        .collect()
    }

    /// The family of orbits over the free parameters that a motion belongs to.
    pub(super) fn family_of<R: Reading>(
        &self,
        (parameters, phase): (Parameters, f64),
        period: u64,
    ) -> Family<R> {
        let mut free = self.free();
        if free.len() > MOST_FREE {
            free.clear();
        }
        let system = CapsuleSystem::new(parameters, phase);
        let limits = self.conditions.limits.clone();
        Family { system, free, limits, period, tolerance: self.study.protocol.tolerance }
    }

    /// Where a motion is, a case of the file or one between them; none where it does not repeat.
    ///
    /// Fails if the file cannot be read or the case cannot be computed again.
    pub fn whereabouts(&self, row: &Row) -> Result<Option<Whereabouts>, CampaignError> {
        let Some(period) = row.period else { return Ok(None) };
        let section = match row.case {
            Some(case) => self.section(case)?,
            None => Some(row.start()),
        };
        let mut parameters = self.study.base.clone();
        let mut phase = self.study.section_phase;
        for (coordinate, value, _) in &row.coordinates {
            match coordinate {
                Coordinate::Parameter(parameter) => parameters[*parameter] = *value,
                Coordinate::SectionPhase => phase = *value,
                _ => {}
            }
        }
        Ok(section.map(|section| Whereabouts { parameters, section, phase, period }))
    }

    /// A section point of a periodic case: from the file, or computed again where that keeps none.
    fn section(&self, case: usize) -> Result<Option<Section>, CampaignError> {
        let at = [self.study.case_set.position(case)];
        let mut point = [f64::NAN; 3];
        for (coordinate, entry) in point.iter_mut().zip(SECTION) {
            let rows = self.archive.rows(entry.name, &at)?;
            let first = rows.first().and_then(|row| row.to_real().into_iter().next());
            *coordinate = first.unwrap_or(f64::NAN);
        }
        if point.iter().all(|it| it.is_finite()) {
            return Ok(Some(point));
        }
        let replay = Replay::new(self.study, case)?;
        let orbit = settle_case(&replay.as_run(Machine::single(), &silent)?, replay.protocol());
        let end = [orbit.end.r, orbit.end.y1, orbit.end.y2];
        Ok((orbit.outcome == Outcome::Periodic).then_some(end))
    }
}
