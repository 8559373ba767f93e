//! Rows of a recording's file as they are read into columns.

use csv::StringRecord;

use super::cells::{Numbers, Wrong};
use super::file_faults::{Faults, Kind};
use super::header::Table;
use super::header_columns::Found;
use super::recording::{Presence, Sensed};

/// What the last column is called that rows may lack, as instruments write it.
const COMMENT: &str = "comment";

/// The rows of a file as they are read.
pub(super) struct Rows {
    /// The numbers of the file.
    numbers: Numbers,
    /// Cells of a row: as many as the header has, or the first row.
    cells: Option<usize>,
    /// How many of them may be lacking.
    lacking: usize,
    pub columns: Vec<(Found, Sensed)>,
    /// Empty cells of each column, and the byte of the first one's row.
    pub empty: Vec<(usize, u64)>,
    /// The bytes of the rows that are kept.
    pub places: Vec<u64>,
    /// Their numbers among all rows.
    pub numbered: Vec<usize>,
}

impl Rows {
    pub fn new(table: &Table<'_>, found: Vec<Found>) -> Rows {
        let is_comment = |it: &String| it.to_lowercase() == COMMENT;
        let lacking = usize::from(table.header.last().is_some_and(is_comment));
        let columns: Vec<(Found, Sensed)> =
            found.into_iter().map(|it| (it, Sensed::default())).collect();
        Rows {
            numbers: Numbers { delimiter: table.delimiter, mark: None },
            cells: table.cells,
            lacking,
            empty: vec![(0, 0); columns.len()],
            columns,
            places: Vec::new(),
            numbered: Vec::new(),
        }
    }

    /// Adds the numbers of a row to the columns: the row of this number from this byte of the file on.
    pub fn add(
        &mut self,
        record: &StringRecord,
        (number, start): (usize, u64),
        faults: &mut Faults<'_>,
    ) {
        let at = start + record.position().map_or(0, csv::Position::byte);
        // A quote that is not closed would make one cell of all rows that follow.
        if record.iter().any(|cell| cell.contains(['\n', '\r'])) {
            faults.push(("", Kind::Quote), at, |_| {
                "a cell has more than one line; a quote is not closed".to_owned()
            });
            return;
        }
        let filled =
            (0..record.len()).rposition(|it| !record[it].is_empty()).map_or(0, |it| it + 1);
        let cells = *self.cells.get_or_insert(filled);
        if filled > cells || record.len() + self.lacking < cells {
            let delimiter = self.numbers.delimiter;
            faults.push(("", Kind::Length), at, |_| row_length(record.len(), cells, delimiter));
            return;
        }
        let values: Vec<Result<Option<f64>, Wrong>> = self
            .columns
            .iter()
            .map(|(found, _)| {
                let cell = record.get(found.places[0]).unwrap_or("");
                self.numbers.read(cell, found.size.unwrap_or(1.0), at)
            })
            .collect();
        let mut is_kept = true;
        for (i, ((found, _), value)) in self.columns.iter().zip(&values).enumerate() {
            let name = found.column.name;
            match value {
                Ok(Some(_)) => {}
                Ok(None) if found.column.is_times() => {
                    faults.push((name, Kind::Empty), at, |_| {
                        format!("{name}: has no value; --interval stands for the times of equally spaced samples")
                    });
                }
                Ok(None) => {
                    if self.empty[i].0 == 0 {
                        self.empty[i].1 = at;
                    }
                    self.empty[i].0 += 1;
                    is_kept &= found.column.presence == Presence::Optional;
                }
                Err(wrong) => {
                    let (numbers, cell) = (&self.numbers, &record[found.places[0]]);
                    faults.push((name, Kind::Cell(*wrong)), at, |faults| {
                        let line = numbers.mark.map(|it| faults.line(it.1));
                        format!("{name}: {}", numbers.told(cell, *wrong, line))
                    });
                }
            }
        }
        if !is_kept {
            return;
        }
        let row = self.places.len();
        for ((_, sensed), value) in self.columns.iter_mut().zip(values) {
            if let Ok(Some(value)) = value {
                sensed.rows.push(row);
                sensed.values.push(value);
            }
        }
        self.places.push(at);
        self.numbered.push(number);
    }
}

/// Why a row of so many cells cannot be read that has another number of cells than the header.
fn row_length(found: usize, expected: usize, delimiter: u8) -> String {
    let hint = match found > expected && delimiter == b',' {
        true => "; a number has a decimal point, not a comma, where commas separate the cells",
        false => "",
    };
    let cells = if found == 1 { "cell" } else { "cells" };
    format!("{found} {cells}, but the header has {expected}{hint}")
}
