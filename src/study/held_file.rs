//! Where a figure of a study file holds axes, and paths by their places or by what varies along them.

use std::collections::BTreeMap;

use super::axis::{is_within, range};
use super::document::{Entry, Table, unknown};
use super::drawing::{Held, check_panels};
use super::{Axis, Coordinate, DrawingKind, Varying};
use crate::quantity::Dimension;

/// The names of axes, and of what varies along those that are paths.
pub(super) fn names_along(axes: &[Axis]) -> Vec<&str> {
    let mut names = Vec::new();
    for axis in axes {
        names.push(axis.name());
        for varying in axis.varying.iter().filter(|_| axis.path.is_some()) {
            names.push(varying.coordinate.name());
        }
    }
    names
}

/// The older name of an axis with the one that it has now, if it has one.
pub(super) fn older_name(axis: &Axis) -> Option<(&'static str, &'static str)> {
    let has_one = axis.coordinates().any(|it| it == Coordinate::StartPhase);
    has_one.then_some((Coordinate::PHASE, Coordinate::StartPhase.name()))
}

/// What `at` may hold: an axis, or what varies along a path.
struct Holdable<'a> {
    /// Its place among the axes.
    axis: usize,
    name: &'a str,
    dimension: Dimension,
    /// Between which values (SI).
    range: [f64; 2],
    /// Whether it is a path by its places, which are counted.
    is_by_places: bool,
}

/// What `at` may hold by some name of it.
fn holdable<'a>(axes: &'a [Axis], name: &str) -> Option<Holdable<'a>> {
    let of_place = |(place, axis): (usize, &'a Axis)| {
        let own = |it: &&Varying| {
            let is_older = older_name(axis)
                .is_some_and(|(older, now)| older == name && now == it.coordinate.name());
            it.coordinate.name() == name || is_older
        };
        let varying = axis.varying.iter().find(own).map(|it| Holdable {
            axis: place,
            name: it.coordinate.name(),
            dimension: it.coordinate.dimension(),
            range: range(&it.values),
            is_by_places: false,
        });
        let path = axis.path.as_deref().filter(|path| *path == name).map(|name| Holdable {
            axis: place,
            name,
            dimension: Dimension::Number,
            range: [0.0, axis.places().saturating_sub(1) as f64],
            is_by_places: true,
        });
        varying.or(path)
    };
    axes.iter().enumerate().find_map(of_place)
}

/// Where a figure of a kind holds axes.
pub(super) fn read_at(table: &Table<'_, '_>, axes: &[Axis], kind: Option<DrawingKind>) -> Held {
    let (mut at, mut several, mut last) = (BTreeMap::new(), BTreeMap::new(), None);
    let mut held: Vec<usize> = Vec::new();
    for (name, entry) in table.entries() {
        let Some(found) = holdable(axes, &name) else {
            entry.fault(unknown("axis of this study", &name, names_along(axes).into_iter()));
            continue;
        };
        if held.contains(&found.axis) {
            let path = axes[found.axis].name();
            entry.fault(format!("a second value along `{path}`; hold it by one of its quantities"));
            continue;
        }
        held.push(found.axis);
        if !entry.is_list() {
            at.extend(value_of(&entry, &found).map(|value| (found.name.to_owned(), value)));
            continue;
        }
        let values = entry.list().iter().filter_map(|it| value_of(it, &found)).collect();
        several.insert(found.axis, (found.name.to_owned(), values));
        if kind.is_some_and(|kind| !kind.keys().panels) {
            let kinds = DrawingKind::with_panels();
            entry.fault(format!("expected one value for this kind of figure; {kinds} take lists"));
        }
        last = Some(entry);
    }
    let panels: Vec<(String, Vec<f64>)> = several.into_values().collect();
    if let (Err(fault), Some(entry)) = (check_panels(&panels), last) {
        entry.fault(fault);
    }
    (at, panels)
}

/// The value at which something is held; faults are noted.
fn value_of(entry: &Entry<'_, '_>, held: &Holdable<'_>) -> Option<f64> {
    let value = entry.quantity(held.dimension);
    if value.is_some_and(|value| !is_within(value, &held.range)) {
        let [low, high] = held.range;
        let found = entry.shown();
        entry.fault(match held.is_by_places {
            true => format!(
                "expected a place along the path, counted from 0, its first, to {high}, its last, found {found}; a quantity along the path \
                 holds it, too"
            ),
            false => format!(
                "expected a value within the axis, from {low} to {high} in SI units, found {found}"
            ),
        });
    }
    value
}
