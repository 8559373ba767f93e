//! What a study file says of a map of parameters: `[map]`, how it is refined, and whether the boundaries of its regions are followed.

use super::boundaries::{Boundaries, parameters_of_map};
use super::branch_file::read_steps;
use super::document::{Entry, Table, unknown};
use super::refinement::AXES;
use super::{CaseSet, Coordinate, Refine};
use crate::description::Output;

/// Longest step of the boundaries of a map unless another is asked for, as a share of its ranges: between two points of a smooth
/// curve it deviates from the straight line by about a ten-thousandth.
const LONGEST_STEP: f64 = 0.01;
/// Pairs of cases between which boundaries are looked for, unless another number is given.
const USUAL_TRIES: usize = 256;
/// More tries than this are taken for a slip of the pen.
const MOST_TRIES: u64 = 1_000_000;

/// What `[map]` says.
#[derive(Default)]
pub(super) struct Map {
    /// What tells neighbouring cases apart where it is refined.
    pub(super) refine: Option<Refine>,
    /// How the boundaries of its regions are followed, if they are.
    pub(super) boundaries: Option<Boundaries>,
}

/// Reads `[map]`.
pub(super) fn read_map(top: &Table<'_, '_>, case_set: &CaseSet, outputs: &[Output]) -> Map {
    let Some(map) = top.table("map") else { return Map::default() };
    let (refine, boundaries) = (map.entry("refine"), map.entry("boundaries"));
    if refine.is_none() && boundaries.is_none() {
        let expected =
            "a table of outputs, each with the most by which it may differ, or `boundaries = true`";
        map.missing("refine", expected);
    }
    let read = Map {
        refine: refine.and_then(|entry| read_refine(&entry, case_set, outputs)),
        boundaries: boundaries.and_then(|entry| read_boundaries(&entry, case_set)),
    };
    map.finish();
    read
}

/// Reads `refine`: the outputs by which a grid of parameters is refined, with the most by which they may differ in a cell.
fn read_refine(entry: &Entry<'_, '_>, case_set: &CaseSet, outputs: &[Output]) -> Option<Refine> {
    if let Some(why) = unfit(case_set) {
        entry.fault(why);
    }
    let table = entry.table()?;
    let names: Vec<(&str, Output)> = outputs.iter().map(|&it| (it.name(), it)).collect();
    let entries = table.entries();
    let each = entries.iter().filter_map(|(name, entry)| read_most(name, entry, &names));
    let mut within: Vec<(Output, f64)> = each.collect();
    within.sort_by_key(|(output, _)| output.index());
    if entries.is_empty() {
        entry.fault("expected at least one output with the most by which it may differ");
    }
    Some(within).filter(|it| !it.is_empty()).map(Refine::Outputs)
}

/// Reads `boundaries`, which is `true` or a table that says how they are followed.
fn read_boundaries(entry: &Entry<'_, '_>, case_set: &CaseSet) -> Option<Boundaries> {
    let is_map = matches!(case_set, CaseSet::Grid(grid) if parameters_of_map(grid).is_some());
    if !entry.is_table() {
        let is_wanted = entry.truth()?;
        refuse_without_map(entry, is_map || !is_wanted);
        let (longest_step, most_points) = (LONGEST_STEP, super::branch_file::USUAL_POINTS);
        let usual = Boundaries { longest_step, most_points, most_tries: USUAL_TRIES };
        return is_wanted.then_some(usual);
    }
    refuse_without_map(entry, is_map);
    let table = entry.table()?;
    let (longest_step, most_points) = read_steps(&table, LONGEST_STEP);
    let tries = table.entry("most_tries").and_then(|entry| entry.whole(1, MOST_TRIES));
    table.finish();
    let most_tries = tries.map_or(USUAL_TRIES, |tries| tries as usize);
    Some(Boundaries { longest_step, most_points, most_tries })
}

/// Notes that boundaries are asked for of what is no map.
fn refuse_without_map(entry: &Entry<'_, '_>, fits: bool) {
    if !fits {
        entry.fault(
            "is for grids of two axes, both of parameters, each with values that rise or fall",
        );
    }
}

/// Why the cases cannot be refined by their outputs, if they cannot.
fn unfit(case_set: &CaseSet) -> Option<String> {
    let varied = case_set.varied();
    let of_parameters = varied.iter().all(|it| matches!(it, Coordinate::Parameter(_)));
    match case_set {
        CaseSet::Grid(grid)
            if of_parameters && grid.inherit.is_none() && (2..=AXES).contains(&grid.axes.len()) =>
        {
            None
        }
        _ => Some(format!(
            "is for grids of 2 to {AXES} axes of parameters whose cases do not inherit their starts"
        )),
    }
}

/// The most by which an output may differ.
fn read_most(name: &str, entry: &Entry<'_, '_>, known: &[(&str, Output)]) -> Option<(Output, f64)> {
    let Some(&(_, output)) = known.iter().find(|(other, _)| *other == name) else {
        entry.fault(unknown("output of this study", name, known.iter().map(|(name, _)| *name)));
        return None;
    };
    let most = entry.quantity(output.dimension())?;
    if !(most > 0.0 && most.is_finite()) {
        entry.fault(format!("{most} {} must be above 0", output.unit()));
        return None;
    }
    Some((output, most))
}
