//! What is known and inferred of the cases of a map that is refined by outputs.

use super::Record;
use crate::description::Output;
use crate::orbit::Outcome;
use crate::study::{Refine, Refining, Study};

/// What tells the computed cases of a refined map apart.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPoint {
    /// The period [cycles]; zero where the motion does not repeat, which is like no other then.
    pub period: u32,
    /// Whether it is always at rest.
    pub rests: bool,
    /// The outputs by which the map is refined, each as a multiple of the most by which it may differ.
    pub values: Box<[f64]>,
}

impl MapPoint {
    /// What is known of a case of a study with this outcome, period and outputs.
    pub fn of(
        study: &Study,
        (outcome, period): (Outcome, u32),
        output: impl Fn(Output) -> f64,
    ) -> MapPoint {
        MapPoint {
            period: if outcome == Outcome::Periodic { period } else { 0 },
            rests: study.base.model().rest_share().is_some_and(|share| output(share) >= 1.0),
            values: within(study).iter().map(|(of, most)| output(*of) / most).collect(),
        }
    }

    /// What is known of a computed case.
    pub fn of_record(study: &Study, record: &Record) -> MapPoint {
        let orbit = &record.orbit;
        MapPoint::of(study, (orbit.outcome, orbit.period as u32), |output| orbit.outputs[output])
    }

    /// Whether two cases may be corners of a cell inside which nothing is computed: two that are like a third differ by no
    /// more than the study allows.
    pub(super) fn is_like(&self, other: &MapPoint) -> bool {
        let mut both = self.values.iter().zip(&other.values);
        self.period > 0
            && (self.period, self.rests) == (other.period, other.rests)
            && both.all(|(a, b)| (a - b).abs() <= 0.5)
    }

    /// Whether a case is as was inferred, if no output is off by more than the study allows.
    pub(super) fn confirms(&self, inferred: &MapPoint) -> bool {
        let mut both = self.values.iter().zip(&inferred.values);
        (self.period, self.rests) == (inferred.period, inferred.rests)
            && both.all(|(a, b)| (a - b).abs() <= 1.0)
    }
}

/// The outputs by which a map is refined, each with the most by which it may differ [SI].
pub fn within(study: &Study) -> &[(Output, f64)] {
    match &study.refine {
        Some(Refine::Outputs(within)) => within,
        _ => &[],
    }
}

/// What is inferred of the cases of a refined map that have not been computed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct InferredCases {
    /// The cases, in rising order.
    pub cases: Vec<usize>,
    /// The period of each [cycles].
    pub periods: Vec<u32>,
    /// Whether the capsule never slides, of each.
    pub rests: Vec<bool>,
    /// For each output by which the map is refined its values at the cases [SI].
    pub values: Vec<Vec<f64>>,
}

impl InferredCases {
    /// The place of a case in the lists, if it is inferred.
    pub(super) fn place(&self, case: usize) -> Option<usize> {
        self.cases.binary_search(&case).ok()
    }

    /// What is known of the case at a place of the lists, as if it had been computed.
    pub(super) fn at(&self, study: &Study, place: usize) -> MapPoint {
        let values = self.values.iter().zip(within(study));
        MapPoint {
            period: self.periods[place],
            rests: self.rests[place],
            values: values.map(|(values, (_, most))| values[place] / most).collect(),
        }
    }
}

/// Infers the cases of a refined map that have not been computed from those that are `known`: the period of their cell, and
/// the outputs by linear interpolation between its corners over the places along the axes.
pub fn infer_cases(study: &Study, known: &[(usize, MapPoint)]) -> InferredCases {
    let Some(refinement) = study.refinement() else { return InferredCases::default() };
    let mut refining = Refining::whole(&refinement, MapPoint::is_like);
    for (case, point) in known {
        refining.note(*case, point.clone());
    }
    let mut all: Vec<(usize, u32, bool)> = Vec::new();
    let mut values = vec![Vec::new(); within(study).len()];
    refining.inferred(|case, corners| {
        let (_, first) = corners[0];
        all.push((case, first.period, first.rests));
        for (of, (values, (_, most))) in values.iter_mut().zip(within(study)).enumerate() {
            let sum: f64 = corners.iter().map(|(weight, corner)| weight * corner.values[of]).sum();
            values.push(sum * most);
        }
    });
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by_key(|&place| all[place].0);
    // A case on the boundary of two cells is met in both.
    order.dedup_by_key(|place| all[*place].0);
    InferredCases {
        cases: order.iter().map(|&place| all[place].0).collect(),
        periods: order.iter().map(|&place| all[place].1).collect(),
        rests: order.iter().map(|&place| all[place].2).collect(),
        values: values.iter().map(|it| order.iter().map(|&place| it[place]).collect()).collect(),
    }
}
