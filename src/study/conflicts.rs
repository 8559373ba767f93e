//! What a study asks for that cannot be computed, as its model tells.

use super::axis::{range, set};
use super::document::Table;
use super::{Coordinate, Study};
use crate::description::{Parameter, Parameters, Remark};
use crate::motion::Case;

/// Refuses what the model cannot compute, at the values that the study holds and at those of its axes and draws.
pub(super) fn refuse(top: &Table<'_, '_>, study: &Study) {
    let mut told: Vec<String> = Vec::new();
    for (parameters, phase) in settings(study) {
        for Remark { about, text } in (study.base.model().rules.conflicts)(&parameters, phase) {
            if !told.contains(&text) {
                told.push(text.clone());
                top.conflict(&key(study, &about), &text);
            }
        }
        // More of the same kind would say the same of other values.
        if !told.is_empty() {
            return;
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

/// The settings of branches, and those of the study: each value that varies alone beside both ends of the others.
fn settings(study: &Study) -> Vec<(Parameters, f64)> {
    let of_branches = study.branches.iter().map(|it| (it.parameters.clone(), it.section_phase));
    let of_cases = cases(study).into_iter().map(|it| (it.parameters, it.section_phase));
    of_cases.chain(of_branches).collect()
}

/// Cases of the study on the corners of what varies, and on the edges between them at the values of axes.
fn cases(study: &Study) -> Vec<Case> {
    let base = Case {
        parameters: study.with_parts(),
        start: study.start.clone(),
        start_phase: study.start_phase,
        section_phase: study.section_phase,
    };
    let ends: Vec<(Coordinate, [f64; 2])> = study
        .case_set
        .varied()
        .into_iter()
        .filter(|it| matches!(it, Coordinate::Parameter(_) | Coordinate::SectionPhase))
        .filter_map(|it| Some((it, study.case_set.ends(it)?)))
        .collect();
    let mut corners = vec![base];
    for (coordinate, ends) in &ends {
        corners = both(&corners, *coordinate, ends);
    }
    let mut all = corners.clone();
    for axis in
        study.axes().iter().filter(|it| ends.iter().any(|(known, _)| *known == it.coordinate))
    {
        let inner = axis.values.iter().filter(|it| !range(&axis.values).contains(it));
        let inner: Vec<f64> = inner.copied().collect();
        all.extend(both(&corners, axis.coordinate, &inner));
    }
    all
}

/// These cases with each of some values in a coordinate.
fn both(cases: &[Case], coordinate: Coordinate, values: &[f64]) -> Vec<Case> {
    let with = |case: &Case, value: f64| {
        let mut case = case.clone();
        set(&mut case, coordinate, value);
        case
    };
    cases.iter().flat_map(|case| values.iter().map(move |value| with(case, *value))).collect()
}
