//! From the best cases of a file to the best motions between and beside them: the refined front of a trade-off.

use serde_json::{Value, json};

use super::conditions::Conditions;
use super::conditions_of_draws::OfDraws;
use super::error::CampaignError;
use super::kept_searches::{FOR, KeptSearches};
use super::motion_row::Row;
use super::refined_motion::{DrawnMotion, Led, RefinedMotion, Slopes, Start, distinct, words};
use super::replay::Replay;
use super::report::silent;
use crate::description::{Outputs, Parameter, Parameters, Section, State};
use crate::model::Setting;
use crate::motion::Case;
use crate::of::settle_case;
use crate::orbit::{Outcome, Protocol};
use crate::run::{Machine, on_all_threads};
use crate::store::Archive;
use crate::study::{Coordinate, Study};
use crate::tradeoff::{
    Best, Candidate, Direction, Family, GainAndCost, Goal, MOST_FREE, OperatingPoint, best, left,
};

/// An orbit that is settled to has the gain and the price of the one that was found to this share.
const AGREES: f64 = 1e-6;
/// A motion that is better by less than this share is the case from which it was sought.
const LEAST_GAIN: f64 = 1e-9;

/// A search for a better motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// What it begins with.
    pub from: Start,
    /// What it makes small or large.
    pub goal: Goal,
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
    /// The outputs that are to be large and small.
    pub of: GainAndCost,
    /// The direction in which the gain counts.
    pub direction: Direction,
    /// A number for each case that differs between kinds of motions; empty where nothing is sought.
    pub kinds: Vec<u64>,
    /// Gain up to which a motion is one without gain, as at rest (SI).
    pub at_rest: f64,
    /// What is asked of motions between the cases.
    pub conditions: Conditions,
    /// What is asked of motions under tolerances.
    pub asked: OfDraws,
    /// The most of the cost that may be spent, if that is given (SI).
    pub budget: Option<f64>,
    /// Number of the drawing of starts.
    pub seed: u64,
    /// Searches that are done already, and where further ones are kept.
    pub kept: &'a KeptSearches,
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

    /// What searches lead to, in their order, each motion once, from cases and from `drawn` motions; calls `done` after each search.
    ///
    /// # Method
    ///
    /// See [`best`] and `settled`. Every search is by itself: neither threads nor order matter.
    ///
    /// Fails if the file cannot be read or a case cannot be computed again.
    pub fn run(
        &self,
        searches: &[Search],
        drawn: &[DrawnMotion],
        threads: Option<usize>,
        done: impl Fn() + Sync,
    ) -> Result<Led, CampaignError> {
        let Led { motions, unsettled } = self.each(threads, searches.len(), done, |number| {
            let search = &searches[number];
            self.kept.kept_or_found(&self.described(search), || self.search(search, drawn))
        })?;
        Ok(Led { motions: distinct(motions), unsettled })
    }

    /// What a search depends on, beside the results.
    fn described(&self, Search { from, goal }: &Search) -> Value {
        let of = self.of.cost.name();
        self.keyed(match goal {
            Goal::Most { direction, budget, .. } => {
                let most = budget.map(|(_, most)| most);
                json!({ "from": from, "moving": direction.name(), "of": of, "most": most })
            }
            Goal::Least(output) => {
                let moving = self.direction.name();
                json!({ "from": from, "moving": moving, "least": output.name(), "of": of })
            }
        })
    }

    /// The goal of the most gain, for no more than a price if one is given.
    pub(super) fn most(&self, price: Option<f64>) -> Goal {
        let budget = price.map(|most| (self.of.cost, most));
        Goal::Most { gain: self.of.gain, direction: self.direction, budget }
    }

    /// What a search depends on, with the gain if it is not the one that the model names, and with the conditions if there are any.
    pub(super) fn keyed(&self, mut search: Value) -> Value {
        if !self.of.has_own_gain() {
            search[FOR] = json!(self.of.gain.name());
        }
        if let Some(conditions) = self.conditions.described() {
            search["where"] = conditions;
        }
        search
    }

    /// What each of some searches leads to, in the order of the searches; calls `done` after each.
    pub(super) fn each(
        &self,
        threads: Option<usize>,
        count: usize,
        done: impl Fn() + Sync,
        search: impl Fn(usize) -> Result<Led, CampaignError> + Sync,
    ) -> Result<Led, CampaignError> {
        let found = on_all_threads(threads, count, |number| {
            let found = search(number);
            done();
            found
        })?;
        let mut all = Led::default();
        for led in found {
            let Led { motions, unsettled } = led?;
            all.motions.extend(motions);
            all.unsettled += unsettled;
        }
        Ok(all)
    }

    /// What a search leads to.
    fn search(&self, search: &Search, drawn: &[DrawnMotion]) -> Result<Led, CampaignError> {
        let begun = match search.from {
            Start::Case(case) => self.family(case)?,
            Start::Drawn { drawn: number, .. } => self.drawn_family(drawn, number),
        };
        let Some((family, first)) = begun else { return Ok(Led::default()) };
        let before = first.outputs.clone();
        let is_drawn = matches!(search.from, Start::Drawn { .. });
        let found = best(&family, first, search.goal);
        // A case that is the best already is among the motions as it is.
        let found = found.filter(|it| {
            is_drawn || self.gain(search.goal, [&before, &it.at.outputs]) >= LEAST_GAIN
        });
        let mut led = Led::default();
        found.into_iter().for_each(|it| led.add(self.settled(&family, &it, search.from)));
        Ok(led)
    }

    /// The family of the orbit of a drawn motion, with the orbit; none where there is none.
    fn drawn_family(
        &self,
        drawn: &[DrawnMotion],
        number: usize,
    ) -> Option<(Family, OperatingPoint)> {
        let motion = drawn.iter().find(|it| it.number == number)?;
        let phase = self.study.section_phase;
        let setting = Setting { parameters: motion.parameters.clone(), phase };
        let family = self.family_of(setting, motion.period);
        let first = family.orbit(&family.shares(), &motion.section)?;
        Some((family, first))
    }

    /// The best orbit of a family as a motion; none where plain integration from its section point does not lead to it, or it does
    /// not keep the conditions.
    ///
    /// # Method
    ///
    /// The motion that starts at the section point is settled twice: as cases are by default, whose outputs are told, and without
    /// leaps, so that every cycle is integrated. Both must be periodic with the period of the family, and have the gain and the price
    /// of the orbit to 1e-6. Near the loss of its stability an orbit may be too slow for that.
    pub(super) fn settled(
        &self,
        family: &Family,
        found: &Best,
        from: Start,
    ) -> Option<RefinedMotion> {
        let setting = family.at(&found.at.shares);
        let start = State::at_section(self.study.base.model(), &found.at.section);
        let again = Case::at_section(setting.parameters.clone(), start, setting.phase);
        let protocol = self.protocol();
        let orbit = settle_case(&again, &protocol);
        let plain = settle_case(&again, &Protocol { accelerate: false, ..protocol });
        let is_same = [&orbit, &plain].iter().all(|it| {
            it.outcome == Outcome::Periodic
                && it.period == family.period
                && self.agree(&it.outputs, &found.at.outputs)
        });
        let slopes = Slopes {
            sensitivity: self.sensitivity(&setting, &found.at, family.period),
            stationarity: Some(found.stationarity),
            held_by: words(&found.held_by, family),
        };
        let counts = is_same && self.conditions.allow(&orbit.outputs);
        counts.then_some(RefinedMotion {
            from,
            parameters: setting.parameters,
            section: found.at.section,
            phase: setting.phase,
            period: family.period,
            outputs: orbit.outputs,
            slopes,
        })
    }

    /// Whether a motion that is settled to has the gain and the price of the one that is known.
    fn agree(&self, told: &Outputs, known: &Outputs) -> bool {
        let mut both = self.of.both().into_iter();
        both.all(|of| (told[of] - known[of]).abs() <= AGREES * known[of].abs())
    }

    /// The relative gain from one motion to another.
    fn gain(&self, goal: Goal, [from, to]: [&Outputs; 2]) -> f64 {
        match goal {
            Goal::Most { gain, .. } => to[gain] / from[gain] - 1.0,
            Goal::Least(output) => 1.0 - to[output] / from[output],
        }
    }

    /// How a motion that is found is computed again.
    pub fn protocol(&self) -> Protocol {
        let Protocol { tolerance, max_cycles, .. } = self.study.protocol;
        Protocol { max_cycles, ..Protocol::with_tolerance(tolerance) }
    }

    /// How gain and price of a case change with the parameters; nothing where it does not repeat, or where no output of the model has
    /// derivatives.
    ///
    /// Fails if the file cannot be read or the case cannot be computed again.
    pub fn slopes(&self, candidate: &Candidate) -> Result<Slopes, CampaignError> {
        let has_slopes = self.study.base.model().outputs().any(|it| it.is_smooth());
        let found = if has_slopes { self.family(candidate.case)? } else { None };
        let Some((family, at)) = found else { return Ok(Slopes::default()) };
        let goal = self.most(Some(candidate.price));
        let known = (!family.free.is_empty()).then(|| left(&family, &at, goal)).flatten();
        let (stationarity, held_by) = known.unzip();
        Ok(Slopes {
            sensitivity: self.sensitivity(&family.setting, &at, family.period),
            stationarity,
            held_by: words(&held_by.unwrap_or_default(), &family),
        })
    }

    /// The family of the orbit of a case, with the orbit; none where it does not repeat or is not stable.
    fn family(&self, case: usize) -> Result<Option<(Family, OperatingPoint)>, CampaignError> {
        let Some(period) = Some(self.periods[case]).filter(|period| *period > 0.0) else {
            return Ok(None);
        };
        let setting = Setting::of(&self.study.case(case));
        let Some(section) = self.section(case)? else { return Ok(None) };
        let family = self.family_of(setting, period as u64);
        let first = family.orbit(&family.shares(), &section);
        Ok(first.map(|first| (family, first)))
    }

    /// Percent of gain and of price per percent of each parameter.
    fn sensitivity(
        &self,
        setting: &Setting,
        at: &OperatingPoint,
        period: u64,
    ) -> Vec<(Parameter, [f64; 2])> {
        let each = setting.parameters.stated().filter(|(_, value)| *value != 0.0);
        let (model, tolerance) = (self.study.model(), self.study.protocol.tolerance);
        each.filter_map(|(parameter, value)| {
            let found = model.sensitivity(setting, &at.section, period, tolerance, parameter)?;
            let relative =
                self.of.both().map(|output| value * found.slopes[output] / found.outputs[output]);
            Some((parameter, relative))
        })
        .collect()
    }

    /// The family of orbits over the free parameters that a motion belongs to.
    pub(super) fn family_of(&self, setting: Setting, period: u64) -> Family {
        let mut free = self.free();
        if free.len() > MOST_FREE {
            free.clear();
        }
        let (model, tolerance) = (self.study.model(), self.study.protocol.tolerance);
        let limits = self.conditions.limits.clone();
        Family { model, setting, free, limits, period, tolerance }
    }

    /// Where a motion is, a case of the file or one between them; none where it does not repeat.
    ///
    /// Fails if the file cannot be read or the case cannot be computed again.
    pub fn whereabouts(&self, row: &Row) -> Result<Option<Whereabouts>, CampaignError> {
        let Some(period) = row.period else { return Ok(None) };
        let section = match row.case {
            Some(case) => self.section(case)?,
            None => Some(row.start(self.study.base.model())),
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
        if let Some(kept) = self.archive.section_point(&self.study.case_set.position(case))? {
            return Ok(Some(kept));
        }
        let replay = Replay::new(self.study, case)?;
        let orbit = settle_case(&replay.as_run(Machine::single(), &silent)?, replay.protocol());
        Ok((orbit.outcome == Outcome::Periodic).then(|| orbit.end.section()))
    }
}
