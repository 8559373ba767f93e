//! A sample of the cases that are inferred is computed as a check.

use super::cases::spread;
use super::map_point::{InferredCases, MapPoint};
use super::refined::computed;
use super::{Attractors, FinalMotions, Machine, Record, RunError, final_motion};
use crate::model::Setting;
use crate::study::Study;

/// How many cases of a sample of those that are inferred are not as was inferred: lead to another attractor, or to none that is
/// known; of a map, differ by more than the study allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InferredSample {
    /// Cases of the sample.
    pub cases: usize,
    /// Those that are not as was inferred.
    pub elsewhere: usize,
}

/// Cases of the sample, if so many are inferred.
pub const SAMPLE: usize = 1000;

/// Computes a sample of the starts whose attractors are inferred, spread evenly over the grid; none where none is.
pub fn check_starts(
    study: &Study,
    attractors: &Attractors,
    final_motions: &FinalMotions,
    machine: Machine,
) -> Result<Option<InferredSample>, RunError> {
    let sample = sample(study.cases(), |case| {
        attractors.of_case[case].is_some() && final_motions.get(case).is_none()
    });
    if sample.is_empty() {
        return Ok(None);
    }
    let records = computed(study, &sample, machine)?;
    let elsewhere = elsewhere(study, &records, attractors, machine);
    Ok(Some(InferredSample { cases: sample.len(), elsewhere }))
}

/// How many of some starts do not lead to the attractor that they have.
fn elsewhere(
    study: &Study,
    records: &[Record],
    attractors: &Attractors,
    machine: Machine,
) -> usize {
    let known: Vec<_> = (0..).zip(&attractors.of_starts).collect();
    let setting = Setting::of(&study.case(0));
    let leads = study.model().leads(&setting, &study.protocol, machine, &known);
    let numbers = records.iter().map(|it| leads.number(&final_motion(&it.orbit)));
    numbers.zip(records).filter(|(number, it)| *number != attractors.of_case[it.index]).count()
}

/// Computes a sample of the cases of a refined map that are inferred, spread evenly over the grid; none where none is.
pub fn check_cases(
    study: &Study,
    inferred: &InferredCases,
    machine: Machine,
) -> Result<Option<InferredSample>, RunError> {
    let sample = sample(study.cases(), |case| inferred.place(case).is_some());
    if sample.is_empty() {
        return Ok(None);
    }
    let records = computed(study, &sample, machine)?;
    let confirmed = records.iter().filter(|record| {
        let inferred = inferred.place(record.index).map(|place| inferred.at(study, place));
        inferred.is_some_and(|it| MapPoint::of_record(study, record).confirms(&it))
    });
    let elsewhere = records.len() - confirmed.count();
    Ok(Some(InferredSample { cases: sample.len(), elsewhere }))
}

/// A sample of those of so many cases that are inferred, spread evenly over the grid.
fn sample(cases: usize, is_inferred: impl Fn(usize) -> bool) -> Vec<usize> {
    let places = (0..cases.min(64 * SAMPLE)).map(|place| spread(place, cases));
    let mut sample: Vec<usize> = places.filter(|case| is_inferred(*case)).take(SAMPLE).collect();
    sample.sort_unstable();
    sample.dedup();
    sample
}
