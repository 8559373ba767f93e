//! What a study asks for that cannot be computed, as its model tells.

use super::axis::set;
use super::document::Table;
use super::{Axis, CaseSet, Coordinate, Study};
use crate::description::{Parameter, Parameters, Remark};
use crate::motion::Case;

/// Refuses what the model cannot compute, at the values that the study holds and at those of its axes and draws.
pub(super) fn refuse(top: &Table<'_, '_>, study: &Study) {
    if let Some(remarks) = first_conflicts(study) {
        for Remark { about, text } in remarks {
            top.conflict(&key(study, &about), &text);
        }
    }
}

/// The key that a conflict is told at: that of the first parameter that it is about.
fn key(study: &Study, about: &[Parameter]) -> String {
    let varied = study.case_set.varied();
    let varies = |it: &Parameter| varied.contains(&Coordinate::Parameter(*it));
    match about.first() {
        Some(it) if varies(it) => format!("axes.{}", it.symbol()),
        Some(it) => format!("parameters.{}", it.symbol()),
        None => "parameters".to_owned(),
    }
}

/// What the model says of the first setting that it cannot compute; others would say the same of other values.
fn first_conflicts(study: &Study) -> Option<Vec<Remark>> {
    let base = Case {
        parameters: study.with_parts(),
        start: study.start.clone(),
        start_phase: study.start_phase,
        section_phase: study.section_phase,
    };
    let of_branches =
        study.branches.iter().find_map(|it| conflicts(&it.parameters, it.section_phase));
    // What is optional alone can be in conflict; without it there may be millions of values to look at for nothing. Where it varies, what
    // it would be unless it did is no case.
    let of_ramps = || study.ramps.iter().find_map(|it| conflicts(&it.parameters, it.section_phase));
    of_branches.or_else(of_ramps).or_else(|| match base.parameters.have_optional_parts() {
        true => in_what_varies(study, base),
        false => conflicts(&base.parameters, base.section_phase),
    })
}

fn conflicts(parameters: &Parameters, phase: f64) -> Option<Vec<Remark>> {
    let found = (parameters.model().rules.conflicts)(parameters, phase);
    (!found.is_empty()).then_some(found)
}

/// Looks at the corners of what varies, and between them at the values of each axis.
fn in_what_varies(study: &Study, base: Case) -> Option<Vec<Remark>> {
    let axes: Vec<&Axis> = study.axes().iter().filter(|it| it.coordinates().any(is_set)).collect();
    let mut corners = vec![base];
    for axis in axes.iter().filter(|axis| axis.places() > 0) {
        corners = both(&corners, &axis.extremes(), |case, place| axis.set(case, *place));
    }
    if let CaseSet::Draws(draws) = &study.case_set {
        for range in draws.ranges.iter().filter(|range| is_set(range.coordinate)) {
            let Some(ends) = study.case_set.ends(range.coordinate) else { continue };
            corners = both(&corners, &ends, |case, value| set(case, range.coordinate, *value));
        }
    }
    let of_corners = corners.iter().find_map(|it| conflicts(&it.parameters, it.section_phase));
    of_corners.or_else(|| axes.iter().find_map(|it| along(it, &corners)))
}

/// Whether a coordinate is part of what a motion is judged by, wherever it starts.
fn is_set(coordinate: Coordinate) -> bool {
    matches!(coordinate, Coordinate::Parameter(_) | Coordinate::SectionPhase)
}

/// Looks at the places of an axis beside the ends of all others.
fn along(axis: &Axis, corners: &[Case]) -> Option<Vec<Remark>> {
    corners.iter().find_map(|corner| {
        let mut case = corner.clone();
        (0..axis.places()).find_map(|place| {
            axis.set(&mut case, place);
            conflicts(&case.parameters, case.section_phase)
        })
    })
}

/// These cases at each of some ends of what varies.
fn both<T>(cases: &[Case], ends: &[T], put: impl Fn(&mut Case, &T)) -> Vec<Case> {
    let mut at_ends = Vec::with_capacity(cases.len() * ends.len());
    for (case, end) in cases.iter().flat_map(|case| ends.iter().map(move |end| (case, end))) {
        let mut case = case.clone();
        put(&mut case, end);
        at_ends.push(case);
    }
    at_ends
}
