//! Finds the table in a recording's file: its header, wherever that stands, the units and the first row of numbers.

use super::cells::{is_number, size_of_unit};
use super::file_form::FileForm;
use super::header_columns::{Found, found_in};
use super::preamble::unit_of;
use super::recording::Column;
use super::table_lines::{Line, cells, first_lines, name_and_unit};

/// The header is looked for in so many lines.
const LOOKED_AT: usize = 1000;
/// Units stand at most so many lines below names.
const BELOW: usize = 8;
/// So many rows below a header tell how well it fits.
const ROWS: usize = 8;
/// What separates cells, the first where several fit alike.
const DELIMITERS: [u8; 3] = [b';', b'\t', b','];

/// The table of a file.
#[derive(Debug)]
pub(super) struct Table<'t> {
    /// What separates the cells.
    pub delimiter: u8,
    /// The cells of the header; none where the file has none.
    pub header: Vec<String>,
    /// The byte at which the line of the header begins.
    pub at: usize,
    /// The known columns.
    pub found: Vec<Found>,
    /// The byte at which rows begin.
    pub data: usize,
    /// Cells of a row; none where the first row says so.
    pub cells: Option<usize>,
    /// The lines before the rows.
    pub before: Vec<Line<'t>>,
}

/// How well a line fits as a header; more is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Fit {
    columns: usize,
    with_unit: usize,
    is_no_comment: bool,
    rows: usize,
}

/// What a file is searched for.
struct Search<'a, 't> {
    lines: Vec<Line<'t>>,
    known: &'a [Column],
    form: &'a FileForm,
}

/// The table of a text.
///
/// # Method
///
/// Of the first thousand lines that one is the header in which most of the known columns are, of these with most of their units in it or
/// below, of these above most rows of numbers, of these the first; a comment only where it is the best. Where no line has any, it is the
/// first that is no comment. Where all columns are given by their places it is above the first of most rows of numbers.
pub(super) fn table<'t>(text: &'t str, known: &[Column], form: &FileForm) -> Table<'t> {
    let search = Search { lines: first_lines(text, LOOKED_AT), known, form };
    let mut best: Option<(Fit, Table<'t>)> = None;
    for place in 0..search.lines.len() {
        for delimiter in DELIMITERS {
            let Some((fit, table)) = search.header_at(place, delimiter) else { continue };
            if best.as_ref().is_none_or(|it| fit > it.0) {
                best = Some((fit, table));
            }
        }
    }
    match best {
        Some((_, table)) => table,
        None => search.by_places().unwrap_or_else(|| search.first_line(text)),
    }
}

impl<'t> Search<'_, 't> {
    /// The table whose header is this line, and how well it fits; none where no known column is named in it.
    fn header_at(&self, place: usize, delimiter: u8) -> Option<(Fit, Table<'t>)> {
        let line = self.lines[place];
        let is_comment = line.is_comment();
        let header = cells(line.text.trim_start_matches('#'), delimiter);
        let found = found_in(&header, self.known, self.form);
        if !found.iter().any(|it| it.is_named) {
            return None;
        }
        let mut table = Table {
            delimiter,
            cells: Some(header.len()),
            header,
            at: line.at,
            found,
            data: line.next,
            before: Vec::new(),
        };
        let mut rows = place + 1;
        if table.found.iter().any(|it| it.lacks_unit())
            && let Some(below) = self.units_below(place, &mut table)
        {
            (rows, table.data) = (below + 1, self.lines[below].next);
        }
        if table.found.iter().any(|it| it.is_unit_said) {
            while self.is_of_words(rows, delimiter, &table.found) && rows < place + BELOW {
                table.data = self.lines[rows].next;
                rows += 1;
            }
        }
        table.before = self.lines[..rows].to_vec();
        for found in table.found.iter_mut().filter(|it| it.lacks_unit()) {
            if let Some(unit) = unit_of(&table.before, delimiter, found.column, found.places[0]) {
                found.size = Some(unit);
            }
        }
        let fit = Fit {
            columns: table.found.len(),
            with_unit: table.found.iter().filter(|it| it.size.is_some()).count(),
            is_no_comment: !is_comment,
            rows: self.rows_from(rows, delimiter, &table.found),
        };
        Some((fit, table))
    }

    /// Takes units from a line below that of the names, if one has them and nothing between holds numbers; gives its place.
    fn units_below(&self, place: usize, table: &mut Table<'t>) -> Option<usize> {
        for below in place + 1..(place + 1 + BELOW).min(self.lines.len()) {
            let row = cells(self.lines[below].text.trim_start_matches('#'), table.delimiter);
            let of_row = |found: &Found| row.get(found.places[0]).map_or("", String::as_str);
            if table.found.iter().any(|it| is_number(of_row(it))) {
                return None;
            }
            let mut is_of_units = false;
            for found in table.found.iter_mut().filter(|it| it.lacks_unit()) {
                let cell = row.get(found.places[0]).map_or("", String::as_str);
                found.size = unit_in(cell, found.column);
                is_of_units |= found.size.is_some();
            }
            if is_of_units {
                return Some(below);
            }
        }
        None
    }

    /// Whether a line has words in all columns, as a line of units has it below names whose units a person says.
    fn is_of_words(&self, place: usize, delimiter: u8, found: &[Found]) -> bool {
        let Some(line) = self.lines.get(place) else { return false };
        let row = cells(line.text, delimiter);
        let is_word =
            |it: &Found| row.get(it.places[0]).is_some_and(|it| !it.is_empty() && !is_number(it));
        found.iter().all(is_word) && self.rows_from(place + 1, delimiter, found) > 0
    }

    /// How many of the rows from this line on have a number in the first of the columns.
    fn rows_from(&self, from: usize, delimiter: u8, found: &[Found]) -> usize {
        let Some(first) = found.iter().find(|it| it.column.name == "t").or(found.first()) else {
            return 0;
        };
        let lines = self.lines[from.min(self.lines.len())..].iter();
        let rows = lines.filter(|it| !it.is_blank() && !it.is_comment()).take(ROWS);
        rows.take_while(|line| {
            cells(line.text, delimiter).get(first.places[0]).is_some_and(|it| is_number(it))
        })
        .count()
    }

    /// The table whose columns are given by their places alone.
    fn by_places(&self) -> Option<Table<'t>> {
        let found = found_in(&[], self.known, self.form);
        if found.is_empty() {
            return None;
        }
        let mut best: Option<(usize, usize, u8)> = None;
        for place in 0..self.lines.len() {
            for delimiter in DELIMITERS {
                let row = cells(self.lines[place].text, delimiter);
                let has = |it: &Found| row.get(it.places[0]).is_some_and(|it| is_number(it));
                if !found.iter().all(has) {
                    continue;
                }
                let rows = self.rows_from(place, delimiter, &found);
                if best.is_none_or(|it| rows > it.0) {
                    best = Some((rows, place, delimiter));
                }
            }
        }
        let (_, place, delimiter) = best?;
        let before = self.lines[..place].to_vec();
        let mut found = found;
        for found in found.iter_mut().filter(|it| it.lacks_unit()) {
            let above = before.iter().rev().take(2);
            found.size = above
                .filter_map(|line| {
                    let row = cells(line.text, delimiter);
                    let cell = row.get(found.places[0])?;
                    unit_in(cell, found.column).or(unit_in(name_and_unit(cell).1, found.column))
                })
                .next();
        }
        let at = self.lines[place].at;
        Some(Table { delimiter, header: Vec::new(), at, found, data: at, cells: None, before })
    }

    /// The table whose header is the first line that is no comment.
    fn first_line(&self, text: &str) -> Table<'t> {
        let place = self.lines.iter().position(|it| !it.is_comment() && !it.text.trim().is_empty());
        let line = place.map(|it| self.lines[it]);
        let header = line.map_or("", |it| it.text);
        let count = |it: &u8| header.bytes().filter(|byte| byte == it).count();
        let delimiter = DELIMITERS.into_iter().rev().max_by_key(count).unwrap_or(b',');
        let header = cells(header, delimiter);
        Table {
            delimiter,
            cells: Some(header.len()),
            header,
            at: line.map_or(0, |it| it.at),
            found: Vec::new(),
            data: line.map_or(text.len(), |it| it.next),
            before: Vec::new(),
        }
    }
}

/// The size of the unit in a cell that holds nothing else, perhaps within brackets.
fn unit_in(cell: &str, column: Column) -> Option<f64> {
    let bare = cell.trim_matches(|it| "[]()".contains(it)).trim();
    if bare.is_empty() { None } else { size_of_unit(bare, column.dimension) }
}
