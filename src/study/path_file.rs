//! A path in a study file: an axis along which several quantities vary together, by tables of their values.

use super::axis::{Spacing, is_monotone};
use super::axis_names::{MOST_VALUES, names, quantity};
use super::document::{Entry, Table, unknown_of};
use super::draws::Draws;
use super::{Axis, Coordinate, Grid, Varying};

/// The dimensions that results have of cases beside their axes.
const DIMENSIONS: [&str; 2] = [Grid::DIRECTION, Draws::DIMENSION];

/// Whether an axis is a path: its values, or one of its ends, are tables.
pub(super) fn is_path(table: &Table<'_, '_>) -> bool {
    let values = table.entry("values").filter(Entry::is_list);
    let of_values = values.is_some_and(|values| values.list().iter().any(Entry::is_table));
    let ends = ["from", "to"].map(|key| table.entry(key));
    of_values || ends.iter().flatten().any(Entry::is_table)
}

/// Notes that cases are not drawn along a path.
pub(super) fn refuse_drawn(table: &Table<'_, '_>) {
    let given = ["values", "from", "to"].into_iter().find_map(|key| table.entry(key));
    let why = "a path does not go with `[draws]`, which draws each quantity by itself: give each an axis of its own";
    given.into_iter().for_each(|entry| entry.fault(why));
}

/// Reads a path; `axes` are those before it, and `seen` is what varies along any axis.
pub(super) fn read_path(
    table: &Table<'_, '_>,
    axes: &[Axis],
    seen: &mut Vec<Coordinate>,
) -> Option<Axis> {
    let name = read_name(table, axes);
    let varying = match table.entry("values") {
        Some(values) => read_places(table, &values),
        None => read_ends(table),
    };
    let place = ["values", "from"].into_iter().find_map(|key| table.entry(key))?;
    let varying: Vec<Varying> = varying?;
    let twice: Vec<&str> = varying
        .iter()
        .filter(|it| seen.contains(&it.coordinate))
        .map(|it| it.coordinate.name())
        .collect();
    seen.extend(varying.iter().map(|it| it.coordinate));
    if !twice.is_empty() {
        place.fault(format!("{} on a second axis; each is given once", twice.join(", ")));
    }
    if let [Varying { coordinate, values }] = &varying[..]
        && !is_monotone(values)
    {
        let name = coordinate.name();
        place.fault(format!(
            "{name} alone turns back along the path; it has to rise or to fall throughout, or be a plain axis, \"{name}\""
        ));
    }
    // With faults the axis stands for what varies: what else names that is not at fault.
    Some(Axis { path: Some(name.unwrap_or_default()), varying })
}

/// The name of a path, which is that of a dimension of its own.
fn read_name(table: &Table<'_, '_>, axes: &[Axis]) -> Option<String> {
    let Some(entry) = table.entry("name") else {
        table.missing("name", "a name of its own for the dimension of a path, as \"line\"");
        return None;
    };
    let name = entry.text()?;
    let model = table.model();
    let is_word = name.starts_with(|first: char| first.is_ascii_alphabetic())
        && name.chars().all(|it| it.is_ascii_alphanumeric() || it == '_');
    let is_quantity = names(model).iter().any(|(known, _)| *known == name)
        || model.outputs().any(|output| output.name() == name);
    if !is_word {
        entry.fault(format!(
            "{} cannot name a dimension; expected a letter, then letters, digits and _",
            entry.shown()
        ));
    } else if is_quantity {
        entry.fault(format!(
            "\"{name}\" is a quantity; a path, whose values are tables, has a name of its own, as \"line\""
        ));
    } else if DIMENSIONS.contains(&name) || axes.iter().any(|axis| axis.name() == name) {
        entry.fault(format!("\"{name}\" is a dimension already; a path has a name of its own"));
    }
    Some(name.to_owned())
}

/// The quantities of a table with their values; faults are noted, and a faulty value is none.
fn read_place(entry: &Entry<'_, '_>) -> Option<Vec<(Coordinate, Option<f64>)>> {
    let table = entry.table()?;
    let known = names(table.model());
    let mut place: Vec<(Coordinate, Option<f64>)> = Vec::new();
    for (key, value) in table.entries() {
        let Some((_, coordinate)) = known.iter().find(|(name, _)| *name == key) else {
            let known = known.iter().map(|(name, _)| *name);
            value.fault(unknown_of(table.model(), "axis", &key, known));
            continue;
        };
        if place.iter().any(|(it, _)| it == coordinate) {
            value.fault(format!("\"{}\" is given twice, under two names", coordinate.name()));
            continue;
        }
        place.push((*coordinate, quantity(&value, Some(*coordinate))));
    }
    if table.entries().is_empty() {
        entry.fault("expected at least one quantity with its value, as omega = \"60 rad/s\"");
    }
    let all: Vec<Coordinate> = Coordinate::all(table.model()).collect();
    place.sort_by_key(|(it, _)| all.iter().position(|other| other == it));
    Some(place)
}

/// The names of the quantities of a place.
fn listed(place: &[(Coordinate, Option<f64>)]) -> String {
    place.iter().map(|(it, _)| it.name()).collect::<Vec<_>>().join(", ")
}

/// Whether a place has the quantities of the `first`; notes where it has others.
fn is_alike(
    entry: &Entry<'_, '_>,
    place: &[(Coordinate, Option<f64>)],
    first: &[(Coordinate, Option<f64>)],
) -> bool {
    let is_alike = place.iter().map(|it| it.0).eq(first.iter().map(|it| it.0));
    if !is_alike {
        let [own, expected] = [place, first].map(listed);
        entry.fault(format!("gives {own}; expected {expected}, as the first place of the path"));
    }
    is_alike
}

/// What varies along a path that is a list of places.
fn read_places(table: &Table<'_, '_>, values: &Entry<'_, '_>) -> Option<Vec<Varying>> {
    for key in ["from", "to", "points", "spacing"] {
        if let Some(extra) = table.entry(key) {
            extra.fault("does not go with a list of values");
        }
    }
    let entries = values.list();
    let mut places: Vec<Vec<(Coordinate, Option<f64>)>> = Vec::with_capacity(entries.len());
    for entry in &entries {
        let Some(place) = read_place(entry) else { continue };
        if let Some(first) = places.first()
            && !is_alike(entry, &place, first)
        {
            continue;
        }
        if places.last().is_some_and(|last| is_one(last, &place)) {
            entry.fault("is the same as the place before; expected another value");
        }
        places.push(place);
    }
    // A place without a value has none along the others either.
    if places.iter().flatten().any(|(_, value)| value.is_none()) {
        return places.first().map(|first| unread(first));
    }
    let varying = places.first()?.iter().enumerate().map(|(i, (coordinate, _))| {
        let values = places.iter().filter_map(|place| place[i].1);
        Varying { coordinate: *coordinate, values: values.collect() }
    });
    Some(varying.collect())
}

/// Whether two places are one.
fn is_one(one: &[(Coordinate, Option<f64>)], other: &[(Coordinate, Option<f64>)]) -> bool {
    one.iter().zip(other).all(|(a, b)| a.1.is_some() && a.1 == b.1)
}

/// What varies along a path between two ends.
fn read_ends(table: &Table<'_, '_>) -> Option<Vec<Varying>> {
    let expected = "from, to and points, or a list of values; of a path these are tables";
    let [from, to, points, spacing] =
        ["from", "to", "points", "spacing"].map(|key| table.entry(key));
    for (key, found) in [("from", &from), ("to", &to), ("points", &points)] {
        if found.is_none() {
            table.missing(key, expected);
        }
    }
    let rule = match &spacing {
        Some(entry) => entry.one_of("spacing", &Spacing::NAMES),
        None => Some(Spacing::Linear),
    };
    let [first, last] = [&from, &to].map(|end| read_place(end.as_ref()?));
    let points = points.and_then(|entry| entry.whole(2, MOST_VALUES));
    let (first, last) = (first?, last?);
    let (true, Some(points), Some(rule)) = (is_alike(&to?, &last, &first), points, rule) else {
        return Some(unread(&first));
    };
    if is_one(&first, &last) {
        table.entry("to")?.fault("is the same as `from`; expected another value");
        return Some(unread(&first));
    }
    let mut varying = unread(&first);
    for ((it, from), to) in varying.iter_mut().zip(&first).zip(&last) {
        let (Some(from), Some(to)) = (from.1, to.1) else { return Some(unread(&first)) };
        if rule == Spacing::Logarithmic && from != to && !(from > 0.0 && to > 0.0) {
            let name = it.coordinate.name();
            spacing?.fault(format!("needs both ends of {name} above zero"));
            return Some(unread(&first));
        }
        it.values = evenly(rule, [from, to], points as usize);
    }
    let is_standing = |at: usize| varying.iter().all(|it| it.values[at] == it.values[at + 1]);
    if (0..points as usize - 1).any(is_standing) {
        table
            .entry("points")?
            .fault(format!("{points} are more than there are numbers between the ends"));
        return Some(unread(&first));
    }
    Some(varying)
}

/// What varies, without values.
fn unread(place: &[(Coordinate, Option<f64>)]) -> Vec<Varying> {
    place.iter().map(|it| Varying { coordinate: it.0, values: Vec::new() }).collect()
}

/// So many values from one to another by a rule; one that does not change stays to the bit.
pub(super) fn evenly(rule: Spacing, [from, to]: [f64; 2], points: usize) -> Vec<f64> {
    match from == to {
        true => vec![from; points],
        false => rule.values(from, to, points),
    }
}
