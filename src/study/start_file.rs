//! The start in a study file: the state, the phases of the drive and what is followed from case to case.

use crate::capsule::{Allowed, State};

use super::document::Table;
use super::{Axis, CaseSet, Coordinate, Direction, Follow};

/// Where a motion starts, and where its section is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Start {
    /// The state.
    pub state: State<f64>,
    /// Phase of the drive at the start [rad].
    pub start_phase: f64,
    /// Phase of the drive at the section [rad].
    pub section_phase: f64,
}

/// Reads `[start]`, and what is followed into `case_set`; what is given there must not vary.
pub(super) fn read_start(top: &Table<'_, '_>, case_set: &mut CaseSet) -> Start {
    let Some(table) = top.table("start") else { return Start::default() };
    let start = read_state(&table, Start::default(), &case_set.varied());
    match case_set {
        CaseSet::Grid(grid) => grid.follow = read_follow(&table, &grid.axes),
        CaseSet::Draws(_) => {
            for entry in ["follow", "directions"].into_iter().filter_map(|key| table.entry(key)) {
                entry.fault("does not go with `[draws]`, whose cases have no neighbours to follow");
            }
        }
    }
    table.finish();
    start
}

/// The state and the phases in `table`; those of `usual` where they are not given.
///
/// `phase` is `start_phase` and `section_phase` at once.
pub(super) fn read_state(table: &Table<'_, '_>, usual: Start, varied: &[Coordinate]) -> Start {
    let quantity = |key: &str, coordinates: &[Coordinate]| {
        let entry = table.entry(key)?;
        if varied.iter().any(|coordinate| coordinates.contains(coordinate)) {
            entry.fault("is given here and on an axis");
        }
        entry.allowed_quantity(coordinates[0].dimension(), Allowed::Finite)
    };
    let mut start = usual;
    let both = [Coordinate::StartPhase, Coordinate::SectionPhase];
    if let Some(phase) = quantity(Coordinate::PHASE, &both) {
        (start.start_phase, start.section_phase) = (phase, phase);
    }
    for (key, coordinate, place) in [
        ("r", Coordinate::StartR, &mut start.state.r),
        ("y1", Coordinate::StartY1, &mut start.state.y1),
        ("y2", Coordinate::StartY2, &mut start.state.y2),
        ("start_phase", Coordinate::StartPhase, &mut start.start_phase),
        ("section_phase", Coordinate::SectionPhase, &mut start.section_phase),
    ] {
        *place = quantity(key, &[coordinate]).unwrap_or(*place);
        if both.contains(&coordinate)
            && table.entry(Coordinate::PHASE).is_some()
            && let Some(entry) = table.entry(key)
        {
            entry.fault("does not go with `phase`, which is start_phase and section_phase at once");
        }
    }
    start
}

fn read_follow(table: &Table<'_, '_>, axes: &[Axis]) -> Option<Follow> {
    let names = Direction::ALL.map(|direction| (direction.name(), direction));
    let directions = table.entry("directions");
    let Some(follow) = table.entry("follow") else {
        if let Some(directions) = directions {
            directions.fault("needs `follow`, the axis to go along");
        }
        return None;
    };
    let choices: Vec<(&str, usize)> =
        axes.iter().enumerate().map(|(i, axis)| (axis.coordinate.name(), i)).collect();
    let axis = follow.one_of("axis of this study", &choices)?;
    if !matches!(axes[axis].coordinate, Coordinate::Parameter(_)) {
        follow.fault("must be a parameter: a start is not followed but given");
    }
    let mut chosen = Vec::new();
    for entry in directions.map(|entry| entry.list()).unwrap_or_default() {
        match entry.one_of("direction", &names) {
            Some(direction) if chosen.contains(&direction) => entry.fault("is given twice"),
            Some(direction) => chosen.push(direction),
            None => {}
        }
    }
    if chosen.is_empty() {
        chosen.push(Direction::Upward);
    }
    Some(Follow { axis, directions: chosen })
}
