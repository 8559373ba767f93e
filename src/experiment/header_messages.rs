//! What is said of a header that does not have what is needed, with the options that help.

use super::header_columns::Found;
use super::recording::Column;
use crate::quantity::Dimension;
use crate::quantity::printable::excerpt;
use crate::quantity::units::expectation;

/// So many columns of a header are named at most.
const MOST_COLUMNS: usize = 20;

/// A header, and whether options may say how it is meant.
pub(super) struct HeaderMessages<'h> {
    /// Its cells.
    pub header: &'h [String],
    /// Whether the command has options for it.
    pub has_options: bool,
}

impl HeaderMessages<'_> {
    /// That a known column stands more than once.
    pub fn stands_twice(&self, found: &Found) -> String {
        let name = found.column.name;
        let cells = found.places.iter().filter_map(|it| self.header.get(*it));
        let cells: Vec<_> = cells.take(MOST_COLUMNS).map(|it| excerpt(it)).collect();
        let option = match self.has_options && cells[0] != cells[1] {
            true => format!("; say which: --columns \"{name}={}\"", cells[0]),
            false if self.has_options => {
                format!("; say which: --columns \"{name}=#{}\"", found.places[0] + 1)
            }
            false => String::new(),
        };
        format!("the column {name} stands twice: {}{option}", cells.join(", "))
    }

    /// That a known column has no unit, or another one.
    pub fn other_unit(&self, found: &Found) -> String {
        let Found { column, places, .. } = found;
        let expected = expectation(column.dimension);
        let example = example(*column);
        let name = column.name;
        let cell = self.header.get(places[0]);
        let shown =
            cell.map_or_else(|| format!("#{}", places[0] + 1), |it| excerpt(it).into_owned());
        let unit = column.dimension.unit();
        let option = match self.has_options {
            true => format!(
                "; or --columns \"{name}={shown}:{unit}\", or with what 1 stands for, as \"2.5 {unit}\""
            ),
            false => String::new(),
        };
        format!("\"{shown}\": expected {expected}, as {example}{option}")
    }

    /// That a required column is not there.
    pub fn missing(&self, column: Column) -> String {
        let (name, example) = (column.name, example(column));
        let columns = columns_of(self.header);
        let unit = column.dimension.unit();
        let option = match (self.has_options, column.is_times() && column.dimension == Dimension::Time) {
            (false, _) => String::new(),
            (true, true) => "; --columns \"t=NAME:s\" says which it is, --interval \"1 ms\" stands for times of equally spaced samples".to_owned(),
            (true, false) => format!("; --columns \"{name}=NAME:{unit}\" says which it is"),
        };
        format!("no column {name}; expected {example}; {columns}{option}")
    }
}

/// The columns of a header, as many as a line shows.
pub(super) fn columns_of(header: &[String]) -> String {
    if header.is_empty() {
        return "the file is empty, or has no header".to_owned();
    }
    let first: Vec<_> = header.iter().take(MOST_COLUMNS).map(|it| excerpt(it)).collect();
    let more = match header.len().saturating_sub(MOST_COLUMNS) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("the columns are {}{more}", first.join(", "))
}

/// How a column may stand in a header.
fn example(column: Column) -> String {
    match column.dimension {
        Dimension::Number => format!("\"{}\"", column.name),
        dimension => format!("\"{} [{}]\"", column.name, dimension.unit()),
    }
}
