//! The start in a study file: the state, the phases of the drive and the axis along which cases inherit it.

use super::document::{Entry, Table};
use super::{Axis, CaseSet, Coordinate, Direction, Inherit};
use crate::description::{Description, State};
use crate::quantity::Allowed;

/// Keys of an inherited start, with the older name of the first.
const INHERITED: [&str; 3] = ["inherit", "follow", "directions"];

/// Where a motion starts, and where its section is.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Start {
    /// The state.
    pub state: State,
    /// Phase of the drive at the start [rad].
    pub start_phase: f64,
    /// Phase of the drive at the section [rad].
    pub section_phase: f64,
}

impl Start {
    /// The origin of a model, at the phase zero.
    fn of(model: &'static Description) -> Start {
        Start { state: State::origin(model), start_phase: 0.0, section_phase: 0.0 }
    }
}

/// Reads `[start]`, and its `inherit` into `case_set`; what is given there must not vary.
pub(super) fn read_start(top: &Table<'_, '_>, case_set: &mut CaseSet) -> Start {
    let usual = Start::of(top.model());
    let Some(table) = top.table("start") else { return usual };
    let start = read_state(&table, usual, &case_set.varied());
    match case_set {
        CaseSet::Grid(grid) => grid.inherit = read_inherit(&table, &grid.axes),
        CaseSet::Draws(_) => {
            for entry in INHERITED.into_iter().filter_map(|key| table.entry(key)) {
                entry.fault("does not go with `[draws]`, whose cases have no neighbours");
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
    let mut start = usual;
    let both: Vec<Coordinate> = Coordinate::phases(start.state.model()).collect();
    if !both.is_empty()
        && let Some(phase) = read_quantity(table, Coordinate::PHASE, &both, varied)
    {
        (start.start_phase, start.section_phase) = (phase, phase);
    }
    for coordinate in start.state.model().start_coordinates() {
        let key = coordinate.name();
        let given = read_quantity(table, key, &[Coordinate::Start(coordinate)], varied);
        start.state[coordinate] = given.unwrap_or(start.state[coordinate]);
    }
    let places = [&mut start.start_phase, &mut start.section_phase];
    for (coordinate, place) in both.into_iter().zip(places) {
        let key = coordinate.name();
        *place = read_quantity(table, key, &[coordinate], varied).unwrap_or(*place);
        if table.entry(Coordinate::PHASE).is_some()
            && let Some(entry) = table.entry(key)
        {
            entry.fault("does not go with `phase`, which is start_phase and section_phase at once");
        }
    }
    start
}

/// The value that `key` gives some coordinates of the start, none of which may be among those that vary.
fn read_quantity(
    table: &Table<'_, '_>,
    key: &str,
    coordinates: &[Coordinate],
    varied: &[Coordinate],
) -> Option<f64> {
    let entry = table.entry(key)?;
    if varied.iter().any(|coordinate| coordinates.contains(coordinate)) {
        entry.fault("is given here and on an axis");
    }
    entry.allowed_quantity(coordinates[0].dimension(), Allowed::Finite)
}

/// The axis of `inherit`, also under the older name of the key.
fn inherit_entry<'r, 'a>(table: &Table<'r, 'a>) -> Option<Entry<'r, 'a>> {
    let (inherit, older) = (table.entry("inherit"), table.alias("follow"));
    if let (Some(_), Some(older)) = (&inherit, &older) {
        older.fault("is an older name of `inherit`, which is given too; give one of them");
    }
    inherit.or(older)
}

fn read_inherit(table: &Table<'_, '_>, axes: &[Axis]) -> Option<Inherit> {
    let names = Direction::ALL.map(|direction| (direction.name(), direction));
    let directions = table.entry("directions");
    let Some(inherit) = inherit_entry(table) else {
        if let Some(directions) = directions {
            directions.fault("needs `inherit`, the axis along which cases inherit their start");
        }
        return None;
    };
    let choices: Vec<(&str, usize)> =
        axes.iter().enumerate().map(|(i, axis)| (axis.name(), i)).collect();
    let axis = inherit.one_of("axis of this study", &choices)?;
    if !axes[axis].is_of_parameters() {
        inherit.fault("must be of parameters; an axis over the start gives the start itself");
    }
    let mut chosen = Vec::new();
    for entry in directions.map(|entry| entry.list()).unwrap_or_default() {
        match entry.one_of("direction", &names) {
            Some(direction) if chosen.contains(&direction) => {
                entry.fault(format!("{} is given twice", entry.shown()))
            }
            Some(direction) => chosen.push(direction),
            None => {}
        }
    }
    if chosen.is_empty() {
        chosen.push(Direction::Upward);
    }
    Some(Inherit { axis, directions: chosen })
}
