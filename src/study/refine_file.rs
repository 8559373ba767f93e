//! What a study file says of cases that need not be followed to the end, or not at all: `[basin]` and `[map]`.

use super::document::{Entry, Table, unknown};
use super::refinement::AXES;
use super::start_file::Start;
use super::{Axis, CaseSet, Coordinate, Refine};
use crate::description::Output;

/// What `[basin]` says, which only a study has whose cases differ in their starts alone.
pub(super) struct Basin {
    /// Whether starts that enter a neighbourhood of a known orbit are followed no further.
    pub(super) early_decision: bool,
    /// Whether a grid is refined between starts that lead to different attractors.
    pub(super) refine: bool,
    /// Whether the manifolds of saddles are followed.
    pub(super) manifolds: bool,
}

/// Reads `[basin]`.
pub(super) fn read_basin(top: &Table<'_, '_>, case_set: &CaseSet, start: &Start) -> Basin {
    let Some(table) = top.table("basin") else {
        return Basin { early_decision: true, refine: false, manifolds: false };
    };
    let of_starts = case_set.varies_starts_alone();
    let early_decision = read_truth_for(&table, "early_decision", of_starts, "studies");
    let is_grid = matches!(case_set, CaseSet::Grid(_));
    let refine = read_truth_for(&table, "refine", of_starts && is_grid, "grids (not [draws])");
    let manifolds = table.entry("manifolds").and_then(|entry| {
        let asked = entry.truth();
        if let Some(why) = without_manifolds(case_set, start).filter(|_| asked == Some(true)) {
            entry.fault(why);
        }
        asked
    });
    table.finish();
    Basin {
        early_decision: early_decision.unwrap_or(true),
        refine: refine.unwrap_or(false),
        manifolds: manifolds.unwrap_or(false),
    }
}

/// Why manifolds cannot be followed in the plane of the starts, if they cannot.
fn without_manifolds(case_set: &CaseSet, start: &Start) -> Option<String> {
    let model = start.state.model();
    let known: Vec<Coordinate> = Coordinate::of_section(model).collect();
    let axes = case_set.axes();
    let names = known.iter().map(|it| it.name()).collect::<Vec<_>>().join(", ");
    if axes.len() != 2 || axes.iter().any(|it| !known.contains(&it.coordinate)) {
        return Some(format!("manifolds are for grids over two of {names}"));
    }
    if !model.has_drive() || start.start_phase != start.section_phase {
        return Some(
            "manifolds are for starts on the section: of models with a drive, where `start_phase` is \
             `section_phase`"
                .to_owned(),
        );
    }
    let is_ordered = |axis: &&Axis| {
        let pairs = || axis.values.windows(2);
        axis.values.len() > 1
            && (pairs().all(|it| it[0] < it[1]) || pairs().all(|it| it[0] > it[1]))
    };
    let other = axes.iter().find(|axis| !is_ordered(axis))?;
    let name = other.coordinate.name();
    Some(format!("manifolds need two or more values of {name} that all rise or all fall"))
}

/// Whether something is done, where it is told; a fault where it does not apply, as it is for `which` studies alone.
fn read_truth_for(table: &Table<'_, '_>, key: &str, applies: bool, which: &str) -> Option<bool> {
    let entry = table.entry(key)?;
    if !applies {
        let given = entry.shown();
        entry.fault(format!("{given} is for {which} whose cases differ in their starts alone"));
    }
    entry.truth()
}

/// Reads `[map]`: the outputs by which a grid of parameters is refined, with the most by which they may differ in a cell.
pub(super) fn read_map(
    top: &Table<'_, '_>,
    case_set: &CaseSet,
    outputs: &[Output],
) -> Option<Refine> {
    let map = top.table("map")?;
    let refine = map.entry("refine");
    if refine.is_none() {
        map.missing("refine", "a table of outputs, each with the most by which it may differ");
    }
    let within = refine.as_ref().and_then(|entry| {
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
        Some(within)
    });
    map.finish();
    within.filter(|it| !it.is_empty()).map(Refine::Outputs)
}

/// Why the cases cannot be refined by their outputs, if they cannot.
fn unfit(case_set: &CaseSet) -> Option<String> {
    let varied = case_set.varied();
    let of_parameters = varied.iter().all(|it| matches!(it, Coordinate::Parameter(_)));
    match case_set {
        CaseSet::Grid(grid)
            if of_parameters && grid.inherit.is_none() && (2..=AXES).contains(&varied.len()) =>
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
