//! The cases in a study file: axes with their values, or ranges and how points are drawn from them.

use std::collections::BTreeSet;

use super::axis::Spacing;
use super::axis_names::{MOST_VALUES, names, quantity};
use super::document::{Entry, Table};
use super::draws::{DrawKind, Range};
use super::path_file::{is_path, read_path, refuse_drawn};
use super::sobol_points::MOST_DIMENSIONS;
use super::{Axis, CaseSet, Coordinate, Draws, Grid, Normal, Saltelli};
use crate::quantity::Allowed;

/// A distribution that has less than this in its range is taken for a slip of the pen.
const LEAST_PROBABILITY: f64 = 1e-9;

/// Reads `[[axes]]` and `[draws]`.
pub(super) fn read_case_set(top: &Table<'_, '_>) -> CaseSet {
    let entries = top.entry("axes").map(|entry| entry.list()).unwrap_or_default();
    let draws = top.table("draws").map(|table| read_draws(table, entries.len()));
    let is_drawn = draws.is_some();
    let mut seen = Vec::new();
    let (mut axes, mut ranges) = (Vec::new(), Vec::new());
    if is_drawn && entries.is_empty() {
        top.missing("axes", "ranges to draw from, as `[[axes]]` with name, from and to");
    }
    for entry in entries {
        let Some(table) = entry.table() else { continue };
        if is_path(&table) {
            if is_drawn {
                refuse_drawn(&table);
            }
            axes.extend(read_path(&table, &axes, &mut seen));
            table.finish();
            continue;
        }
        let name = table.entry("name");
        let coordinate = read_name(&table, name.as_ref());
        let values = (!is_drawn).then(|| read_values(&table, coordinate).unwrap_or_default());
        let range = if is_drawn { read_range(&table, coordinate) } else { None };
        table.finish();
        let (Some(name), Some(coordinate)) = (name, coordinate) else { continue };
        if seen.contains(&coordinate) {
            name.fault(format!("a second axis \"{}\"; each is given once", coordinate.name()));
            continue;
        }
        seen.push(coordinate);
        // With ends values too: what else names this axis is not at fault.
        axes.extend(values.map(|values| Axis::of(coordinate, values)));
        let unread = Range::even(coordinate, [f64::NAN; 2], Spacing::Linear);
        ranges.push(range.unwrap_or(unread));
    }
    match draws {
        Some(draws) => CaseSet::Draws(Draws { ranges, ..draws }),
        None => CaseSet::Grid(Grid { axes, inherit: None }),
    }
}

/// Reads `[draws]`, which has no ranges, of so many quantities.
fn read_draws(table: Table<'_, '_>, quantities: usize) -> Draws {
    let kind = table.entry("kind").and_then(|entry| entry.one_of("kind", &DrawKind::NAMES));
    let kind = kind.unwrap_or_default();
    let count = match kind {
        DrawKind::Saltelli => read_base_samples(&table, quantities).map(|rows| {
            let row = Saltelli { quantities }.row_length();
            rows as usize * row
        }),
        DrawKind::Uniform | DrawKind::LowDiscrepancy => read_count(&table),
    };
    let seed = table.entry("seed").and_then(|entry| entry.whole(0, i64::MAX as u64));
    table.finish();
    Draws { kind, count: count.unwrap_or(1), seed: seed.unwrap_or(0), ranges: Vec::new() }
}

/// The number of draws.
fn read_count(table: &Table<'_, '_>) -> Option<usize> {
    if let Some(extra) = table.entry("base_samples") {
        extra.fault("goes with `kind = \"saltelli\"` alone; give the number of draws as `count`");
    }
    let Some(count) = table.entry("count") else {
        table.missing("count", "the number of draws");
        return None;
    };
    count.whole(1, MOST_VALUES).map(|count| count as usize)
}

/// The number of rows of a design over so many quantities.
fn read_base_samples(table: &Table<'_, '_>, quantities: usize) -> Option<u64> {
    let row = Saltelli { quantities }.row_length() as u64;
    if let Some(extra) = table.entry("count") {
        extra.fault(format!(
            "does not go with `kind = \"saltelli\"`; give `base_samples`, each of which makes {row} cases here: two and one for each axis"
        ));
    }
    if 2 * quantities > MOST_DIMENSIONS
        && let Some(kind) = table.entry("kind")
    {
        kind.fault(format!("{quantities} axes; {} are the most of a design", MOST_DIMENSIONS / 2));
    }
    let Some(entry) = table.entry("base_samples") else {
        table.missing("base_samples", "the number of base samples, a power of two");
        return None;
    };
    let rows = entry.whole(2, MOST_VALUES / row)?;
    if !rows.is_power_of_two() {
        let above = rows.next_power_of_two();
        entry.fault(format!(
            "{rows} is no power of two, with which Sobol' points are even; the next are {} and {above}",
            above / 2
        ));
        return None;
    }
    Some(rows)
}

/// What varies along an axis.
fn read_name(table: &Table<'_, '_>, name: Option<&Entry<'_, '_>>) -> Option<Coordinate> {
    let names = names(table.model());
    if name.is_none() {
        let others = Coordinate::all(table.model())
            .filter(|it| !matches!(it, Coordinate::Parameter(_)))
            .map(Coordinate::name);
        let others: Vec<&str> = others.collect();
        if let [others @ .., last] = &others[..] {
            table.missing("name", &format!("a parameter, {} or {last}", others.join(", ")));
        }
    }
    name?.one_of("axis", &names)
}

/// The values of an axis of a grid.
fn read_values(table: &Table<'_, '_>, coordinate: Option<Coordinate>) -> Option<Vec<f64>> {
    let [values, points] = ["values", "points"].map(|key| table.entry(key));
    if let Some(values) = values {
        for key in ["from", "to", "points", "spacing"] {
            if let Some(extra) = table.entry(key) {
                extra.fault("does not go with a list of values");
            }
        }
        let list = values.list();
        if list.is_empty() {
            values.fault("expected at least one value");
        }
        return Some(distinct(&list, |entry| quantity(entry, coordinate)));
    }
    let expected = "from, to and points, or a list of values";
    let ends = read_ends(table, coordinate, expected);
    if points.is_none() {
        table.missing("points", expected);
    }
    let points = points.and_then(|entry| entry.whole(1, MOST_VALUES));
    let ((from, to, spacing), points) = (ends?, points?);
    if from == to && points > 1 {
        let to = table.entry("to")?;
        to.fault(format!("{} is the same as `from`; expected another value", to.shown()));
        return None;
    }
    if from != to && points == 1 {
        let why = "1 takes no value but `from`: give that alone under `values`, or more points";
        table.entry("points")?.fault(why.to_owned());
        return None;
    }
    let values = spacing.values(from, to, points as usize);
    if values.windows(2).any(|pair| pair[0] == pair[1]) {
        table
            .entry("points")?
            .fault(format!("{points} are more than there are numbers from {from} to {to}"));
        return None;
    }
    Some(values)
}

/// The range that an axis is drawn from.
fn read_range(table: &Table<'_, '_>, coordinate: Option<Coordinate>) -> Option<Range> {
    for key in ["values", "points"] {
        if let Some(extra) = table.entry(key) {
            extra.fault("does not go with `[draws]`: an axis has a range, `from` and `to`");
        }
    }
    if table.entry("mean").is_some() || table.entry("deviation").is_some() {
        return read_normal(table, coordinate);
    }
    let expected = "from and to, the range to draw from, or mean and deviation";
    let (from, to, spacing) = read_ends(table, coordinate, expected)?;
    if from == to {
        let to = table.entry("to")?;
        to.fault(format!("{} is the same as `from`; expected another value", to.shown()));
        return None;
    }
    Some(Range::even(coordinate?, [from, to], spacing))
}

/// The range of a normal distribution, which `mean` and `deviation` say: it ends where `from` and `to` say, or where the quantity
/// has its bounds, six deviations from the mean at most.
fn read_normal(table: &Table<'_, '_>, coordinate: Option<Coordinate>) -> Option<Range> {
    for key in ["mean", "deviation"] {
        if table.entry(key).is_none() {
            table.missing(key, "mean and deviation, of a normal distribution");
        }
    }
    if let Some(spacing) = table.entry("spacing") {
        spacing.fault("does not go with `mean` and `deviation`: the value itself is distributed");
    }
    let coordinate = coordinate?;
    let dimension = coordinate.dimension();
    let mean = table.entry("mean").and_then(|it| it.allowed_quantity(dimension, Allowed::Finite));
    let deviation =
        table.entry("deviation").and_then(|it| it.allowed_quantity(dimension, Allowed::Positive));
    let given = ["from", "to"].map(|key| table.entry(key));
    let ends = given.each_ref().map(|it| it.as_ref().map(|it| quantity(it, Some(coordinate))));
    let (mean, deviation) = (mean?, deviation?);
    let [least, most] = coordinate.allowed().ends();
    let far = Normal::FAR * deviation;
    let from = ends[0].unwrap_or(Some((mean - far).max(least)))?;
    let to = ends[1].unwrap_or(Some((mean + far).min(most)))?;
    let normal = Normal { mean, deviation };
    if from >= to || normal.probability(from, to) < LEAST_PROBABILITY {
        let entry = table.entry("mean")?;
        entry.fault(format!(
            "{} with this deviation leaves nothing to draw from {from} to {to} in SI units; expected a range near the mean, the lower end first",
            entry.shown()
        ));
        return None;
    }
    Some(Range { coordinate, from, to, spacing: Spacing::Linear, normal: Some(normal) })
}

/// The ends of an axis and what lies between them.
fn read_ends(
    table: &Table<'_, '_>,
    coordinate: Option<Coordinate>,
    expected: &str,
) -> Option<(f64, f64, Spacing)> {
    let [from, to, spacing] = ["from", "to", "spacing"].map(|key| table.entry(key));
    for (key, found) in [("from", &from), ("to", &to)] {
        if found.is_none() {
            table.missing(key, expected);
        }
    }
    let rule = match &spacing {
        Some(entry) => entry.one_of("spacing", &Spacing::NAMES),
        None => Some(Spacing::Linear),
    };
    let [from, to] = [from, to].map(|end| quantity(&end?, coordinate));
    let ends = (from?, to?, rule?);
    if ends.2 == Spacing::Logarithmic && !(ends.0 > 0.0 && ends.1 > 0.0) {
        spacing?.fault("needs both ends above zero");
        return None;
    }
    Some(ends)
}

/// The values of a list; one that stands there twice is a fault.
fn distinct<'r, 'a>(
    list: &[Entry<'r, 'a>],
    quantity: impl Fn(&Entry<'r, 'a>) -> Option<f64>,
) -> Vec<f64> {
    let mut values = Vec::with_capacity(list.len());
    let mut seen = BTreeSet::new();
    for entry in list {
        match quantity(entry) {
            // Adding zero makes -0 and 0 the same.
            Some(value) if !seen.insert((value + 0.0).to_bits()) => {
                entry.fault(format!("{value}, in SI units, is given twice"))
            }
            Some(value) => values.push(value),
            None => {}
        }
    }
    values
}
