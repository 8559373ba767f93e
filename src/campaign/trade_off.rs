//! What is best among the motions of a file of results, and between its cases: the answer of a trade-off.

use std::collections::BTreeMap;
use std::path::Path;

use super::answer::{Answer, Named, Refined};
use super::bounding::bound;
use super::conditions::{Conditions, along_path, normal};
use super::conditions_of_draws::OfDraws;
use super::error::CampaignError;
use super::kept_fronts::KeptFront;
use super::kept_searches::KeptSearches;
use super::motion_row::{Row, Rows};
use super::refined_front::Refinement;
use super::refined_motion::RefinedMotion;
use super::refinement_starts::kinds;
use super::report::{Report, Reports};
use super::robustness::Tolerances;
use super::sought::Sought;
use super::spread::add_errors;
use super::study_source::study_of;
use super::tolerance_draws::judge;
use crate::store::{Archive, CaseTable, Condition, Unread, candidates, conditions};
use crate::study::{Coordinate, Study};
use crate::tradeoff::{
    Candidate, Direction, GainAndCost, MOST_FREE, Optima, Optimum, hypervolume, most_first,
    optima as best_of,
};

/// What is asked of the motions of a file.
#[derive(Debug, Clone, Copy)]
pub struct TradeOff<'a> {
    /// The results.
    pub archive: &'a Archive,
    /// Their file, as it is shown.
    pub file: &'a Path,
    /// The outputs that should be large and small.
    pub of: GainAndCost,
    /// The motions that are compared.
    pub direction: Direction,
    /// Conditions on the cases.
    pub conditions: Option<&'a str>,
    /// Gain up to which a motion counts as one without gain, as at rest (SI); by default see [`GainAndCost::at_rest`].
    pub at_rest: Option<f64>,
    /// Most of the cost that may be spent.
    pub budget: Option<f64>,
    /// Least gain that is wanted (SI).
    pub least_gain: Option<f64>,
    /// How many of those with the most gain are told.
    pub top: usize,
    /// Whether the slopes of cases are told, too, for which their orbits are computed again.
    pub slopes: bool,
    /// Motions between the cases.
    pub between: Between<'a>,
    /// Tolerances under which the optima and the front are judged.
    pub under: Option<&'a Tolerances>,
    /// Whether it is told of the optima how far their parameters may change before they end.
    pub margins: bool,
    /// Worker threads; one per core by default.
    pub threads: Option<usize>,
}

/// Which motions between the cases take part.
#[derive(Debug, Clone, Copy)]
pub enum Between<'a> {
    /// None.
    Nothing,
    /// Those that searches under the same conditions have found.
    Known(&'a KeptFront),
    /// Those that searches find.
    Sought {
        /// The searches that are done, and where further ones are kept.
        kept: &'a KeptSearches,
        /// The number by which starts are drawn.
        seed: u64,
        /// How many points of the ranges are drawn as starts.
        points: usize,
    },
}

/// The cases of a file, and what is asked of them.
struct Asked<'a> {
    request: &'a TradeOff<'a>,
    /// Number of cases.
    cases: usize,
    /// The conditions on the cases.
    conditions: Vec<String>,
    rows: &'a Rows,
    /// Those that take part.
    candidates: &'a [Candidate],
    /// The best of them.
    optima: Optima,
    refinement: Option<Refinement<'a>>,
}

/// All motions that take part.
struct Motions<'a> {
    asked: &'a Asked<'a>,
    /// Those between the cases.
    between: &'a [RefinedMotion],
    /// The cases, and then those.
    all: Vec<Candidate>,
}

impl TradeOff<'_> {
    /// What is best.
    ///
    /// Fails if the file cannot be read or has no cases, if what is asked has faults, or if a case cannot be computed again.
    pub fn answer(&self, report: &Report<'_>) -> Result<Answer, CampaignError> {
        let table = CaseTable::of(self.archive)?.ok_or_else(|| {
            self.fault("there are no cases; `capsulemap sweep` computes them".to_owned())
        })?;
        let conditions = self.conditions.map(|text| conditions(&table, text)).transpose();
        let conditions = conditions.map_err(|it| self.unread(it))?.unwrap_or_default();
        let found = candidates(&table, self.of, &conditions).map_err(|it| self.unread(it))?;
        let rows = Rows::of(&table, self.archive, &self.file.display().to_string())?;
        let study = self.needs_orbits().then(|| study_of(self.archive, self.file)).transpose()?;
        if let (Some(under), Some(study)) = (self.under, &study) {
            self.check_tolerances(under, study)?;
        }
        let none = KeptSearches::default();
        let between = self.between_cases(&conditions, study.as_ref())?;
        let gains = found.all.iter().map(|it| it.gain);
        let at_rest = self.at_rest.unwrap_or_else(|| self.of.at_rest(gains));
        let optima = best_of(&found.all, self.direction, Some(at_rest));
        let is_sought = matches!(self.between, Between::Sought { .. });
        let kinds = is_sought.then(|| kinds(&table)).transpose()?;
        let asked = Asked {
            request: self,
            cases: table.cases(),
            conditions: normal(&conditions),
            rows: &rows,
            candidates: &found.all,
            optima: optima.clone(),
            refinement: study.as_ref().map(|study| Refinement {
                asked: OfDraws::of(&conditions, study.base.model()),
                at_rest: optima.at_rest,
                kinds: kinds.unwrap_or_default(),
                ..self.refinement(study, &rows, between, &none)
            }),
        };
        let reports = Reports::new(report);
        let sought = asked.between(&reports)?;
        let between = sought.as_ref().map_or(&[][..], |it| &it.motions);
        let all = with_refined(asked.cases, &found.all, between, self.of);
        let motions = Motions { asked: &asked, between, all };
        let mut answer = Answer { left_out: found.left_out, ..motions.answer(sought.as_ref())? };
        if let Some(refinement) = &asked.refinement {
            self.add_of_orbits(&mut answer, refinement, &reports)?;
        }
        Ok(answer)
    }

    /// Adds what is told of motions that are computed again: errors of means, what tolerances leave, and margins.
    fn add_of_orbits(
        &self,
        answer: &mut Answer,
        refinement: &Refinement<'_>,
        reports: &Reports<'_>,
    ) -> Result<(), CampaignError> {
        add_errors(answer, refinement, self.threads)?;
        if let Some(under) = self.under {
            judge(answer, refinement, under, self.threads, reports)?;
        }
        if self.margins {
            bound(answer, refinement, self.threads, reports)?;
        }
        Ok(())
    }

    /// Refuses tolerances of parameters that have no value in the study, as a share of nothing is nothing.
    fn check_tolerances(&self, under: &Tolerances, study: &Study) -> Result<(), CampaignError> {
        let varied = study.case_set.varied();
        let without = under.each.iter().map(|it| it.0).filter(|it| {
            let has_value = study.base.states(*it) && study.base[*it] != 0.0;
            !has_value && !varied.contains(&Coordinate::Parameter(*it))
        });
        let faults: Vec<String> = without
            .map(|it| format!("--tolerances {}: the study gives it no value", it.symbol()))
            .collect();
        if faults.is_empty() {
            return Ok(());
        }
        Err(CampaignError::TradeOff { path: self.file.to_owned(), faults })
    }

    /// What is asked of motions between the cases, if they are sought.
    ///
    /// Fails if the conditions cannot be kept between the cases, or gain or price have no derivatives for a search to follow.
    fn between_cases(
        &self,
        conditions: &[Condition],
        study: Option<&Study>,
    ) -> Result<Conditions, CampaignError> {
        if !matches!(self.between, Between::Sought { .. }) {
            return Ok(Conditions::default());
        }
        if let Some(fault) = study.and_then(along_path) {
            return Err(self.fault(fault));
        }
        let found = Conditions::of(conditions, self.of.cost.model());
        let rough = self.of.both().into_iter().filter(|it| !it.is_smooth());
        let rough = rough.map(|it| {
            format!("`{}` has no derivatives in the parameters; `--refine` needs them", it.name())
        });
        let rough: Vec<String> = rough.collect();
        match found {
            Ok(found) if rough.is_empty() => Ok(found),
            found => {
                let faults = found.err().into_iter().flatten().chain(rough).collect();
                Err(CampaignError::TradeOff { path: self.file.to_owned(), faults })
            }
        }
    }

    /// Whether more is asked than what the file tells of its cases.
    fn needs_orbits(&self) -> bool {
        let seeks = !matches!(self.between, Between::Nothing);
        self.slopes || self.under.is_some() || self.margins || seeks
    }

    /// The optima that are asked for, each by its place among all motions.
    fn named(&self, best: &Optima, all: &[Candidate]) -> Vec<(&'static str, Option<usize>)> {
        let mut found = vec![
            (Optimum::MostGain, best.most_gain),
            (Optimum::Knee, best.knee),
            (Optimum::LeastPerGain, best.least_per_gain),
        ];
        if let Some(most) = self.budget {
            found.push((Optimum::MostWithinBudget, best.most_within(all, most)));
        }
        if let Some(least) = self.least_gain {
            found.push((Optimum::LeastForGain, best.least_for(all, self.direction, least)));
        }
        found.into_iter().map(|(optimum, at)| (optimum.name(self.of), at)).collect()
    }

    fn refinement<'r>(
        &'r self,
        study: &'r Study,
        rows: &Rows,
        conditions: Conditions,
        none: &'r KeptSearches,
    ) -> Refinement<'r> {
        let kept = match self.between {
            Between::Nothing | Between::Known(_) => none,
            Between::Sought { kept, .. } => kept,
        };
        Refinement {
            study,
            archive: self.archive,
            periods: rows.periods(study.cases()),
            of: self.of,
            direction: self.direction,
            kinds: Vec::new(),
            at_rest: 0.0,
            conditions,
            asked: OfDraws::default(),
            budget: self.budget,
            seed: self.seed().unwrap_or_default(),
            kept,
        }
    }

    /// The number by which starts are drawn; none where none are.
    fn seed(&self) -> Option<u64> {
        match self.between {
            Between::Sought { seed, .. } => Some(seed),
            _ => None,
        }
    }

    /// The areas that fronts dominate, up to the dearest price of them all.
    fn hypervolumes(&self, fronts: [(&Optima, &[Candidate]); 2]) -> [f64; 2] {
        let at_rest = fronts[0].0.at_rest;
        let fronts = fronts.map(|(optima, candidates)| optima.points(candidates, self.direction));
        let dearest = fronts.iter().flatten().fold(0.0, |most: f64, it| most.max(it.0));
        fronts.map(|front| hypervolume(&front, dearest, at_rest))
    }

    fn fault(&self, fault: String) -> CampaignError {
        CampaignError::TradeOff { path: self.file.to_owned(), faults: vec![fault] }
    }

    fn unread(&self, error: Unread) -> CampaignError {
        match error {
            Unread::Store(error) => CampaignError::Store(error),
            Unread::Faults(faults) => {
                CampaignError::TradeOff { path: self.file.to_owned(), faults }
            }
        }
    }
}

impl Asked<'_> {
    /// The motions between the cases that take part, with the searches that have found them; none where none were sought.
    fn between(&self, reports: &Reports<'_>) -> Result<Option<Sought>, CampaignError> {
        match (&self.refinement, self.request.between) {
            (_, Between::Known(KeptFront { searched, motions, .. })) => {
                let (searched, motions) = (searched.clone(), motions.clone());
                Ok(Some(Sought { searched, drawn: None, motions }))
            }
            (Some(refinement), Between::Sought { points, .. }) => {
                let free = refinement.free().len();
                if !(1..=MOST_FREE).contains(&free) {
                    let fault =
                        format!("{free} parameters vary; 1 to {MOST_FREE} can be refined over");
                    return Err(self.request.fault(fault));
                }
                let threads = self.request.threads;
                let (cases, optima) = (self.candidates, &self.optima);
                refinement.sought(cases, optima, points, threads, reports).map(Some)
            }
            _ => Ok(None),
        }
    }
}

impl Motions<'_> {
    /// What is best among them, before tolerances; with what searches have brought, if there were any.
    fn answer(&self, sought: Option<&Sought>) -> Result<Answer, CampaignError> {
        let Motions { asked, all, .. } = self;
        let request = asked.request;
        let best = best_of(all, request.direction, Some(asked.optima.at_rest));
        let moving = most_first(all, request.direction, best.at_rest);
        Ok(Answer {
            file: request.file.display().to_string(),
            of: request.of,
            direction: request.direction,
            conditions: asked.conditions.clone(),
            limits: [request.budget, request.least_gain],
            cases: asked.cases,
            left_out: BTreeMap::new(),
            at_rest: (best.at_rest, all.len() - moving.len()),
            refined: sought.map(|sought| self.refined(sought, &best)),
            named: self.named(&best)?,
            front: self.rows(&best.front)?,
            top: self.rows(&moving[..moving.len().min(request.top)])?,
            tolerances: request.under.cloned(),
            not_judged: asked
                .refinement
                .as_ref()
                .map_or(Vec::new(), |it| it.asked.not_judged.clone()),
            robust_front: Vec::new(),
        })
    }

    /// What searches have brought, if these are the best of all motions.
    fn refined(&self, sought: &Sought, best: &Optima) -> Refined {
        let Motions { asked, between, all } = self;
        let fronts = [(&asked.optima, asked.candidates), (best, &all[..])];
        Refined {
            searched: sought.searched.clone(),
            drawn: sought.drawn,
            found: between.len(),
            seed: asked.request.seed(),
            hypervolumes: asked.request.hypervolumes(fronts),
        }
    }

    /// The optima that are asked for.
    fn named(&self, best: &Optima) -> Result<Vec<Named>, CampaignError> {
        let mut named = Vec::new();
        for (name, at) in self.asked.request.named(best, &self.all) {
            named.push(Named { name, row: at.map(|at| self.row(&self.all[at])).transpose()? });
        }
        Ok(named)
    }

    /// What is told of motions at these places.
    fn rows(&self, places: &[usize]) -> Result<Vec<Row>, CampaignError> {
        places.iter().map(|&at| self.row(&self.all[at])).collect()
    }

    /// What is told of a motion.
    fn row(&self, motion: &Candidate) -> Result<Row, CampaignError> {
        let Asked { request, rows, refinement, .. } = self.asked;
        match (refinement, motion.case.checked_sub(self.asked.cases)) {
            (Some(refinement), Some(place)) => {
                Ok(rows.refined(&self.between[place], request.of, &refinement.protocol()))
            }
            (Some(refinement), None) if request.slopes => {
                Ok(Row { slopes: refinement.slopes(motion)?, ..rows.row(motion) })
            }
            _ => Ok(rows.row(motion)),
        }
    }
}

/// The candidates of so many cases, and refined motions, numbered after them.
fn with_refined(
    cases: usize,
    candidates: &[Candidate],
    motions: &[RefinedMotion],
    of: GainAndCost,
) -> Vec<Candidate> {
    let numbered = motions.iter().enumerate();
    let refined = numbered.map(|(place, motion)| motion.candidate(cases + place, of));
    candidates.iter().copied().chain(refined).collect()
}
