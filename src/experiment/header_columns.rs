//! The known columns in a header, by the names that they have there or by those that a person says.

use super::cells::size_of_unit;
use super::file_form::FileForm;
use super::recording::Column;
use super::table_lines::name_and_unit;
use crate::quantity::{Dimension, parse_quantity};

/// Names of the column of times, in lower case.
const TIMES: [&str; 5] = ["t", "time", "zeit", "x-axis", "x_value"];

/// A known column in a header.
#[derive(Debug, Clone)]
pub(super) struct Found {
    /// Which.
    pub column: Column,
    /// Where it stands in a row, the first of several places where its name stands more than once.
    pub places: Vec<usize>,
    /// The size of its unit; none where it has none, or another.
    pub size: Option<f64>,
    /// Whether a unit stands in its cell, though one that does not fit.
    pub has_other_unit: bool,
    /// Whether its unit is said by a person.
    pub is_unit_said: bool,
    /// Whether its name stands in the header, rather than its place being said.
    pub is_named: bool,
}

impl Found {
    /// Whether its unit must be looked for elsewhere.
    pub fn lacks_unit(&self) -> bool {
        self.size.is_none() && !self.has_other_unit
    }
}

/// The known columns in a header.
pub(super) fn found_in(header: &[String], known: &[Column], form: &FileForm) -> Vec<Found> {
    let said = known.iter().filter_map(|column| said(header, *column, form.named(column.name)?));
    let mut all: Vec<Found> = said.collect();
    let taken: Vec<usize> = all.iter().flat_map(|it| it.places.clone()).collect();
    for column in known.iter().filter(|it| form.named(it.name).is_none()) {
        let exact = places(header, &taken, |cell| its_unit(cell, *column).is_some());
        let places = match exact.is_empty() && column.name == "t" {
            true => places(header, &taken, is_time),
            false => exact,
        };
        let Some(first) = places.first() else { continue };
        let cell = &header[*first];
        let unit = its_unit(cell, *column).unwrap_or(name_and_unit(cell).1);
        all.push(with_unit(*column, places, unit));
    }
    all
}

/// The places of the cells that a test takes, but those that are taken already.
fn places(header: &[String], taken: &[usize], test: impl Fn(&str) -> bool) -> Vec<usize> {
    let places = (0..header.len()).filter(|it| !taken.contains(it));
    places.filter(|&it| test(&header[it])).collect()
}

/// The unit in a cell that has the name of a column, which may be empty; none where it has another name.
fn its_unit(cell: &str, column: Column) -> Option<&str> {
    let (name, unit, _) = name_and_unit(cell);
    if name == column.name {
        return Some(unit);
    }
    // As names of variables have it.
    let unit = cell.strip_prefix(column.name)?.strip_prefix('_')?;
    size_of_unit(unit, column.dimension).map(|_| unit)
}

/// Whether a cell may name a column of times; a temperature is none.
fn is_time(cell: &str) -> bool {
    let (name, unit, _) = name_and_unit(cell);
    let is_of_time = unit.is_empty() || size_of_unit(unit, Dimension::Time).is_some();
    is_of_time && TIMES.contains(&name.to_lowercase().as_str())
}

fn with_unit(column: Column, places: Vec<usize>, unit: &str) -> Found {
    let size = match unit.is_empty() && column.dimension != Dimension::Number {
        true => None,
        false => size_of_unit(unit, column.dimension),
    };
    let has_other_unit = size.is_none() && !unit.is_empty();
    Found { column, places, size, has_other_unit, is_unit_said: false, is_named: true }
}

/// The column that a person calls so; none where the header has none of this name.
fn said(header: &[String], column: Column, in_file: &str) -> Option<Found> {
    if let Some(found) = said_without_unit(header, column, in_file) {
        return Some(found);
    }
    let (name, unit) = in_file.rsplit_once(':')?;
    let size = unit_said(unit.trim(), column.dimension)?;
    let found = said_without_unit(header, column, name.trim())?;
    Some(Found { size: Some(size), has_other_unit: false, is_unit_said: true, ..found })
}

/// The size of a unit that a person says: one of the dimension, or what one of the file's numbers stands for, as "2.5 mm".
pub(super) fn unit_said(unit: &str, dimension: Dimension) -> Option<f64> {
    let known = size_of_unit(unit, dimension).filter(|_| !unit.is_empty());
    known.or_else(|| parse_quantity(unit, dimension).ok().filter(|it| it.is_finite() && *it != 0.0))
}

fn said_without_unit(header: &[String], column: Column, name: &str) -> Option<Found> {
    if let Some(number) = name.strip_prefix('#').and_then(|it| it.parse::<usize>().ok()) {
        let place = number.checked_sub(1)?;
        let unit = header.get(place).map_or("", |it| name_and_unit(it).1);
        return Some(Found { is_named: false, ..with_unit(column, vec![place], unit) });
    }
    let whole = places(header, &[], |cell| cell.eq_ignore_ascii_case(name));
    let found = match whole.is_empty() {
        true => places(header, &[], |cell| name_and_unit(cell).0.eq_ignore_ascii_case(name)),
        false => whole,
    };
    let unit = name_and_unit(header.get(*found.first()?)?).1;
    Some(with_unit(column, found, unit))
}
