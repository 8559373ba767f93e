//! The table of the attractors of a study whose cases differ in their starts alone.

use super::cases::run_sample;
use super::edge::{Edge, edges};
use super::inferred_sample::{InferredSample, check_starts};
use super::manifold::manifolds;
use super::room::Room;
use super::settling::{Settling, SettlingTimes};
use super::shock::shocks;
use super::{Attractors, FinalMotions, Machine, Record, RunError, SharesAt, shares_along};
use crate::attractor::{
    Attractor, Entropy, Integrity, Label, Manifolds, Share, Uncertainty, Wada, entropy,
    shares_of_draws, shares_of_grid, uncertainty, wada,
};
use crate::description::Section;
use crate::model::Setting;
use crate::orbit::Outcome;
use crate::study::{CaseSet, Draws, Study};

/// An attractor that starts lead to.
#[derive(Debug, Clone, PartialEq)]
pub struct AttractorRow {
    /// What tells it from others; the section points of a periodic orbit begin with [`Attractor::least_point`].
    pub attractor: Attractor<Section>,
    /// The first of its cases, computed once more with all outputs.
    pub record: Record,
    /// The part of the starts that lead to it.
    pub share: Share,
    /// The room of its basin, of a grid of starts along coordinates of the section.
    pub integrity: Option<Integrity>,
    /// Its minimal critical shock, of a grid of starts along coordinates of the section [m/s]; NaN where none is known.
    pub shock: f64,
    /// How long its starts are followed, where that has been told.
    pub settling: Option<Settling>,
}

/// What a study tells of attractors and their basins whose cases differ in their starts alone, or in one parameter, too.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AttractorTable {
    /// The attractors by their numbers.
    pub rows: Vec<AttractorRow>,
    /// The shares along the parameter of a study of one parameter and of starts, for each of its values.
    pub along: Option<Vec<SharesAt>>,
    /// The entropy of the basins of a grid of two axes or more that no case is missing of, if several labels occur.
    pub entropy: Option<Entropy>,
    /// The uncertainty exponent of the same, where the grid is fine enough.
    pub uncertainty: Option<Uncertainty>,
    /// How far the boundaries of the basins of the same are from each other, where there are three or more.
    pub wada: Option<Wada>,
    /// After how many cycles the starts have settled, where that has been told.
    pub settling: Option<SettlingTimes>,
    /// The saddles between the basins of a grid.
    pub edges: Vec<Edge>,
    /// Their manifolds, where the study asks for them; some of the saddles are met by these alone.
    pub manifolds: Option<Manifolds<Section>>,
    /// How well the starts of a refined grid are inferred that have not been computed.
    pub inferred: Option<InferredSample>,
}

impl AttractorTable {
    /// Notes for how many cycles cases have been followed, each by its index.
    pub fn note_cycles(
        &mut self,
        attractors: &Attractors,
        cycles: impl Iterator<Item = (usize, u64)>,
    ) {
        let starts = cycles.map(|(case, cycles)| (attractors.of_case[case], cycles));
        let times = SettlingTimes::of(self.rows.len(), starts);
        for (number, row) in self.rows.iter_mut().enumerate() {
            row.settling = times.settling(number);
        }
        self.settling = Some(times);
    }
}

/// Starts along each side of a box of the basin entropy.
const BOX: usize = 6;

/// The table of a study whose cases differ in their starts alone, or the shares of one along a parameter; empty of any other.
///
/// `final_motions` are those of its cases; `begins` is called before the manifolds of so many saddles are followed, if they are.
pub fn attractor_table(
    study: &Study,
    attractors: &Attractors,
    final_motions: &FinalMotions,
    machine: Machine,
    begins: impl FnOnce(usize),
) -> Result<AttractorTable, RunError> {
    let found = &attractors.of_starts;
    if found.is_empty() {
        let along = shares_along(study, attractors, final_motions, machine);
        return Ok(AttractorTable { along, ..AttractorTable::default() });
    }
    let label = |case: usize| attractors.label(case, final_motions);
    let shares = match &study.case_set {
        CaseSet::Draws(draws) => shares_among(draws, label, found.len()),
        CaseSet::Grid(_) => shares_of_grid(&study.shape(), label, found.len()),
    };
    let mut rows = rows(study, found, shares, machine)?;
    if let Some(room) = Room::of(study, 0) {
        for (number, row) in (0..).zip(&mut rows) {
            row.integrity = Some(room.around(number, label));
        }
        let known: Vec<_> = (0..).zip(rows.iter().map(|row| &row.attractor)).collect();
        let shocks = shocks(study, 0, &known, machine);
        rows.iter_mut().zip(shocks).for_each(|(row, shock)| row.shock = shock);
    }
    let shape = study.shape();
    let is_grid = matches!(study.case_set, CaseSet::Grid(_)) && shape.len() > 1;
    let several = (0..study.cases()).any(|case| label(case) != label(0));
    let measured = is_grid && several;
    let entropy = measured.then(|| entropy(&shape, label, BOX)).flatten();
    let uncertainty = measured.then(|| uncertainty(&shape, label)).flatten();
    let wada = measured.then(|| wada(&shape, label, rows.len())).flatten();
    let mut edges = edges(study, attractors, machine);
    let manifolds = manifolds(study, attractors, &mut edges, machine, begins);
    let inferred = check_starts(study, attractors, final_motions, machine)?;
    let settling = None;
    Ok(AttractorTable {
        rows,
        along: None,
        entropy,
        uncertainty,
        wada,
        settling,
        edges,
        manifolds,
        inferred,
    })
}

/// The shares of so many attractors of draws. The cases of a row of a design have values in common, so that their shares have no
/// error as independent draws have.
fn shares_among(draws: &Draws, label: impl Fn(usize) -> Label, attractors: usize) -> Vec<Share> {
    let mut shares = shares_of_draws(draws.count, label, attractors);
    if draws.saltelli().is_some() {
        shares.iter_mut().for_each(|it| (it.error, it.interval) = (f64::NAN, None));
    }
    shares
}

/// The rows of the attractors that are `found`, each with its share, but for what a grid of starts tells of their basins.
fn rows(
    study: &Study,
    found: &[Attractor<Section>],
    shares: Vec<Share>,
    machine: Machine,
) -> Result<Vec<AttractorRow>, RunError> {
    // A chain of such a study is one case, as no start is inherited from the same parameters.
    let mut cases: Vec<usize> = found.iter().map(|it| it.case).collect();
    cases.sort_unstable();
    // Each with a certificate of its own.
    let followed = Study { early_decision: false, ..study.clone() };
    let records = run_sample(&followed, machine, &cases, || ())?;
    let rows = found.iter().zip(shares).map(|(attractor, share)| {
        let place = cases.binary_search(&attractor.case).expect("it is among them");
        let attractor = begun_at_least(study, attractor.clone());
        let record = records[place].clone();
        AttractorRow { attractor, record, share, integrity: None, shock: f64::NAN, settling: None }
    });
    Ok(rows.collect())
}

/// The same, a periodic orbit from its least section point on.
fn begun_at_least(study: &Study, mut attractor: Attractor<Section>) -> Attractor<Section> {
    if attractor.outcome == Outcome::Periodic {
        let setting = Setting::of(&study.case(attractor.case));
        let least = study.model().least_point(&setting, &attractor);
        attractor.points.rotate_left(least);
    }
    attractor
}
