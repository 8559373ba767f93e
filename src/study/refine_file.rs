//! What a study file says of cases that need not be followed to the end, or not at all, as they differ in their starts alone: `[basin]`.

use super::document::Table;
use super::start_file::Start;
use super::{CaseSet, Coordinate, Varying};

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
    if axes.len() != 2
        || axes.iter().any(|it| !it.single().is_some_and(|it| known.contains(&it.coordinate)))
    {
        return Some(format!("manifolds are for grids over two of {names}"));
    }
    if !model.has_drive() || start.start_phase != start.section_phase {
        return Some(
            "manifolds are for starts on the section: of models with a drive, where `start_phase` is \
             `section_phase`"
                .to_owned(),
        );
    }
    let other = axes.iter().find(|axis| !axis.single().is_some_and(Varying::is_ordered))?;
    let name = other.name();
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
