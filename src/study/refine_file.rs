//! What a study file says of cases that need not be followed to the end, or not at all, as they differ in their starts alone: `[basin]`.

use super::CaseSet;
use super::document::Table;

/// What `[basin]` says, which only a study has whose cases differ in their starts alone.
pub(super) struct Basin {
    /// Whether starts that enter a neighbourhood of a known orbit are followed no further.
    pub(super) early_decision: bool,
    /// Whether a grid is refined between starts that lead to different attractors.
    pub(super) refine: bool,
}

/// Reads `[basin]`.
pub(super) fn read_basin(top: &Table<'_, '_>, case_set: &CaseSet) -> Basin {
    let Some(table) = top.table("basin") else {
        return Basin { early_decision: true, refine: false };
    };
    let of_starts = case_set.varies_starts_alone();
    let early_decision = read_truth_for(&table, "early_decision", of_starts, "studies");
    let is_grid = matches!(case_set, CaseSet::Grid(_));
    let refine = read_truth_for(&table, "refine", of_starts && is_grid, "grids (not [draws])");
    table.finish();
    Basin { early_decision: early_decision.unwrap_or(true), refine: refine.unwrap_or(false) }
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
