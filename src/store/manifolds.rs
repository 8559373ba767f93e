//! The variables of the manifolds of saddles in a file of results.

use super::catalogue::*;
use super::columns::Columns;
use super::{Dataset, Values};
use crate::attractor::{Manifolds, StableCurve, UnstableBranch};
use crate::description::Section;
use crate::study::{Axis, Coordinate, Study};

/// A point of a curve among all.
struct CurvePoint<'a> {
    curve: usize,
    at: [f64; 2],
    divided: bool,
    /// The axes of the study, in whose order its values are.
    axes: &'a [Coordinate],
}

/// A point of a half of an unstable manifold among all.
struct BranchPoint {
    branch: usize,
    section: Section,
}

/// Adds the manifolds of the saddles of a study.
pub(super) fn add(dataset: &mut Dataset, study: &Study, found: &Manifolds<Section>) {
    let coverage = found.coverage;
    let counts = [
        (BOUNDARY_CROSSINGS, coverage.crossings),
        (BOUNDARY_UNCOVERED, coverage.uncovered),
        (BOUNDARY_SEEDS, coverage.seeds),
        (BOUNDARY_FAILED, coverage.failed),
        (BOUNDARY_STOPPED, usize::from(coverage.stopped)),
    ];
    for (entry, count) in counts {
        dataset.put(entry, &[], Values::integer(count as i64));
    }
    if !found.stable.is_empty() {
        add_curves(dataset, &found.stable);
        add_curve_points(dataset, study, &found.stable);
    }
    if !found.unstable.is_empty() {
        add_branches(dataset, &found.unstable);
    }
}

fn add_curves(dataset: &mut Dataset, curves: &[StableCurve]) {
    dataset.put_coordinate(STABLE_CURVE, Values::count(curves.len()));
    let mut columns = Columns { dataset, rows: curves };
    columns.integers(STABLE_EDGE, |curve| curve.saddle.map_or(-1, |place| place as i64));
    columns.integers(STABLE_LEFT, |curve| i64::from(curve.sides[0]));
    columns.integers(STABLE_RIGHT, |curve| i64::from(curve.sides[1]));
    columns.integers(STABLE_BEGIN, |curve| curve.ends[0] as i64);
    columns.integers(STABLE_END, |curve| curve.ends[1] as i64);
    columns.reals(STABLE_LENGTH, |curve| curve.length);
    columns.reals(STABLE_ERROR, |curve| curve.error);
}

/// The points of the curves, by all coordinates of the section: those that are no axis are held.
fn add_curve_points(dataset: &mut Dataset, study: &Study, curves: &[StableCurve]) {
    let model = dataset.model();
    let axes: Vec<Coordinate> = study.axes().iter().flat_map(Axis::coordinates).collect();
    let axes = &axes[..];
    let rows: Vec<CurvePoint<'_>> = curves
        .iter()
        .enumerate()
        .flat_map(|(curve, it)| {
            let points = it.points.iter().zip(&it.divided);
            points.map(move |(at, divided)| CurvePoint { curve, at: *at, divided: *divided, axes })
        })
        .collect();
    let held = study.case(0).start.section();
    dataset.put_coordinate(STABLE_POINT, Values::count(rows.len()));
    let mut columns = Columns { dataset, rows: &rows };
    columns.integers(STABLE_POINT_CURVE, |point| point.curve as i64);
    columns.integers(STABLE_POINT_DIVIDED, |point| i64::from(point.divided));
    for (place, coordinate) in Coordinate::of_section(model).enumerate() {
        columns.reals(Place::Stable.of(Entry::of_coordinate(coordinate)), |point| {
            let axis = point.axes.iter().position(|it| *it == coordinate);
            axis.map_or(held[place], |axis| point.at[axis])
        });
    }
}

fn add_branches(dataset: &mut Dataset, branches: &[UnstableBranch<Section>]) {
    let model = dataset.model();
    dataset.put_coordinate(UNSTABLE_BRANCH, Values::count(branches.len()));
    let mut columns = Columns { dataset, rows: branches };
    columns.integers(UNSTABLE_EDGE, |branch| branch.saddle as i64);
    columns.integers(UNSTABLE_CYCLE, |branch| branch.cycle as i64);
    columns.integers(UNSTABLE_ATTRACTOR, |branch| i64::from(branch.side));
    columns.integers(UNSTABLE_END, |branch| branch.end as i64);
    columns.integers(UNSTABLE_TEARS, |branch| branch.tears as i64);
    let rows: Vec<BranchPoint> = branches
        .iter()
        .enumerate()
        .flat_map(|(branch, it)| {
            it.points.iter().map(move |section| BranchPoint { branch, section: *section })
        })
        .collect();
    dataset.put_coordinate(UNSTABLE_POINT, Values::count(rows.len()));
    let mut columns = Columns { dataset, rows: &rows };
    columns.integers(UNSTABLE_POINT_BRANCH, |point| point.branch as i64);
    for (place, entry) in section(model).into_iter().enumerate() {
        columns.reals(Place::Unstable.of(entry), |point| point.section[place]);
    }
}
