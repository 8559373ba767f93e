//! Reads recordings from CSV, and finds every fault with its line.

use std::io::Read;

use csv::{ReaderBuilder, StringRecord, Trim};

use super::recording::{Column, MOST_TOLD, Presence, Recording, RecordingFaults};
use crate::quantity::Dimension;
use crate::quantity::printable::excerpt;
use crate::quantity::units::{expectation, unit};

/// So many columns of a header are named at most.
const MOST_COLUMNS: usize = 20;

impl Recording {
    /// Reads the columns that are `known` from the text of a file; other columns are left out. Where `known` has a
    /// column of times, they must increase. Lines that begin with `#` are comments.
    ///
    /// Fails with all faults at once, of which the first twenty are kept and the others counted: a column that is missing, is
    /// given twice or has another unit than its dimension allows, a cell that is not a finite number or has more than one line,
    /// a row of another length, times that do not increase, fewer than `least` rows. The time grows as the text does.
    pub fn read(
        source: &str,
        text: &str,
        known: &[Column],
        least: usize,
    ) -> Result<Recording, RecordingFaults> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut reading = Reading { faults: Vec::new(), count: 0, others: Vec::new(), known, text };
        let recording = reading.recording(source, least);
        let Reading { faults, count, .. } = reading;
        match count {
            0 => Ok(recording),
            _ => Err(RecordingFaults { source: source.to_owned(), faults, count }),
        }
    }
}

/// A column of the file: which of the known ones, its place in a row, and the size of its unit.
struct Found {
    column: Column,
    place: usize,
    size: f64,
}

struct Reading<'k> {
    /// The first faults.
    faults: Vec<(Option<u64>, String)>,
    /// How many there are.
    count: usize,
    /// The names of the columns that were not asked for.
    others: Vec<String>,
    known: &'k [Column],
    text: &'k str,
}

impl Reading<'_> {
    /// Notes a fault of the row at this byte, if it is among the first: to count lines and to put words together for each of
    /// many would take long.
    fn fault(&mut self, at: u64, message: impl FnOnce(&Self) -> String) {
        self.count += 1;
        if self.faults.len() < MOST_TOLD {
            self.faults.push((Some(self.line(at)), message(self)));
        }
    }

    /// The line of the row at this byte, before which the reader may have left out lines.
    fn line(&self, at: u64) -> u64 {
        let (before, after) = self.text.split_at(at as usize);
        let left_out = after.lines().take_while(|it| it.is_empty() || it.starts_with('#'));
        (before.matches('\n').count() + left_out.count() + 1) as u64
    }

    fn recording(&mut self, source: &str, least: usize) -> Recording {
        let text = self.text;
        // Without a line break at its end the reader takes a last comment for a row.
        let whole = text.as_bytes().chain(&b"\n"[..]);
        let mut reader = ReaderBuilder::new()
            .delimiter(delimiter(text))
            .comment(Some(b'#'))
            .flexible(true)
            .trim(Trim::All)
            .has_headers(false)
            .from_reader(whole);
        let mut records = reader.records().map_while(Result::ok);
        let header = records.next().unwrap_or_default();
        let found = self.header(&header);
        let mut columns: Vec<_> = found.iter().map(|it| (it.column, Vec::new())).collect();
        let mut places = Vec::new();
        for record in records {
            places.push(place_of(&record));
            self.row(&record, header.len(), &found, &mut columns);
        }
        let others = std::mem::take(&mut self.others);
        let (source, rows) = (source.to_owned(), places.len());
        let recording = Recording { source, others, columns, rows };
        if self.count == 0 {
            self.rows(&recording, &places, least);
        }
        recording
    }

    /// Adds the numbers of a row, which has so many cells, to the columns.
    fn row(
        &mut self,
        record: &StringRecord,
        cells: usize,
        found: &[Found],
        columns: &mut [(Column, Vec<f64>)],
    ) {
        let at = place_of(record);
        // A quote that is not closed would make one cell of all rows that follow.
        if record.iter().any(|cell| cell.contains(['\n', '\r'])) {
            self.fault(at, |_| "a cell has more than one line; a quote is not closed".to_owned());
            return;
        }
        if record.len() != cells {
            self.fault(at, |_| row_length(record, cells));
            return;
        }
        for (found, (_, values)) in found.iter().zip(columns) {
            match finite(&record[found.place], found.size) {
                Some(value) => values.push(value),
                None => self.fault(at, |_| {
                    format!("{}: {}", found.column.name, unreadable(&record[found.place]))
                }),
            }
        }
    }

    /// The known columns of a header.
    fn header(&mut self, header: &StringRecord) -> Vec<Found> {
        let at = place_of(header);
        let mut all: Vec<Found> = Vec::new();
        for (place, cell) in header.iter().enumerate() {
            let (name, its_unit) = name_and_unit(cell);
            let Some(&column) = self.known.iter().find(|column| column.name == name) else {
                self.others.push(excerpt(name).into_owned());
                continue;
            };
            if all.iter().any(|found| found.column == column) {
                self.fault(at, |_| format!("the column {name} stands twice"));
                continue;
            }
            // As texts of oscillators write a plain number.
            let is_number = column.dimension == Dimension::Number && its_unit == "1";
            match unit(if is_number { "" } else { its_unit }, column.dimension) {
                Some((_, size)) => all.push(Found { column, place, size }),
                None => {
                    let expected = expectation(column.dimension);
                    let (cell, example) = (excerpt(cell), example(column));
                    self.fault(at, |_| format!("\"{cell}\": expected {expected}, as {example}"));
                    all.push(Found { column, place, size: 1.0 });
                }
            }
        }
        for column in self.known {
            let is_there = all.iter().any(|found| found.column == *column);
            if !is_there && column.presence == Presence::Required {
                let (name, example) = (column.name, example(*column));
                self.fault(at, |_| {
                    format!("no column {name}; expected {example}; {}", columns_of(header))
                });
            }
        }
        all
    }

    /// What is asked of all rows together.
    fn rows(&mut self, recording: &Recording, places: &[u64], least: usize) {
        if recording.rows() < least {
            let rows = recording.rows();
            let are = if rows == 1 { "row" } else { "rows" };
            let message = format!("{rows} {are} of numbers; at least {least} are needed");
            self.count += 1;
            self.faults.push((None, message));
        }
        let Some(times) = recording.column("t") else { return };
        for (i, pair) in times.windows(2).enumerate() {
            if pair[1] <= pair[0] {
                self.fault(places[i + 1], |reading| {
                    let before = reading.line(places[i]);
                    format!(
                        "t = {} s does not come after {} s in line {before}; times must increase",
                        pair[1], pair[0]
                    )
                });
            }
        }
    }
}

/// The byte at which the reader began to look for a row.
fn place_of(record: &StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::byte)
}

/// What separates the cells of the first line that is no comment: the commonest of semicolon, tab and comma, in this order
/// where they are equally many.
fn delimiter(text: &str) -> u8 {
    let header = text.lines().find(|line| !line.starts_with('#') && !line.trim().is_empty());
    let header = header.unwrap_or_default();
    let delimiters = [b',', b'\t', b';'].into_iter();
    let commonest = delimiters.max_by_key(|it| header.bytes().filter(|byte| byte == it).count());
    commonest.unwrap_or(b',')
}

/// The name and the unit of a column, written "name [unit]", "name (unit)", "name in unit" or "name / unit".
fn name_and_unit(cell: &str) -> (&str, &str) {
    for (open, close) in [(" [", "]"), ("[", "]"), (" (", ")"), ("(", ")"), (" in ", ""), ("/", "")]
    {
        if let Some((name, rest)) = cell.split_once(open)
            && let Some(unit) = rest.trim_end().strip_suffix(close)
        {
            return (name.trim(), unit.trim());
        }
    }
    (cell, "")
}

/// The columns of a header, as many as a line shows.
fn columns_of(header: &StringRecord) -> String {
    if header.is_empty() {
        return "the file is empty".to_owned();
    }
    let first: Vec<_> = header.iter().take(MOST_COLUMNS).map(excerpt).collect();
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

/// Why a row cannot be read that has another number of cells than the header.
fn row_length(record: &StringRecord, expected: usize) -> String {
    let hint = match record.len() > expected {
        true => "; a number has a decimal point, not a comma",
        false => "",
    };
    let cells = if record.len() == 1 { "cell" } else { "cells" };
    format!("{} {cells}, but the header has {expected}{hint}", record.len())
}

/// The number in a cell times the size of its unit, if both are finite.
fn finite(cell: &str, size: f64) -> Option<f64> {
    let value = cell.parse::<f64>().ok()?;
    Some(value * size).filter(|value| value.is_finite())
}

/// Why there is no finite number in a cell.
fn unreadable(cell: &str) -> String {
    let shown = excerpt(cell);
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => format!("\"{shown}\" is too large for SI units"),
        Ok(_) => {
            format!("\"{shown}\" is not a finite number; a row that lacks a value must be left out")
        }
        Err(_) if cell.is_empty() => {
            "has no value; a row that lacks a value must be left out".to_owned()
        }
        Err(_) if cell.replace(',', ".").parse::<f64>().is_ok() => {
            format!("\"{shown}\" has a decimal comma; expected a decimal point")
        }
        Err(_) => format!("\"{shown}\" is not a number"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: [Column; 3] = [
        Column { name: "t", dimension: Dimension::Time, presence: Presence::Required },
        Column { name: "x2", dimension: Dimension::Length, presence: Presence::Required },
        Column { name: "r", dimension: Dimension::Length, presence: Presence::Optional },
    ];

    fn read(text: &str) -> Result<Recording, RecordingFaults> {
        Recording::read("rig.csv", text, &KNOWN, 2)
    }

    #[test]
    fn columns_are_read_in_their_units() {
        for text in [
            "# rig 3\nt [ms],note,x2 [mm]\n0,1,2.5\n1,2,3.5\n",
            "t (ms);note;x2 (mm)\n0;1;2.5\n1;2;3.5\n",
            "\u{feff}t/ms\tnote\tx2 / mm\r\n0\t1\t2.5\r\n1\t2\t3.5\r\n",
            "x2 in mm, t in ms\n 2.5, 0\n\n3.5, 1",
        ] {
            let recording = read(text).expect(text);
            assert_eq!(recording.required("x2"), [2.5 * 1e-3, 3.5 * 1e-3], "{text}");
            assert_eq!(recording.required("t"), [0.0, 1e-3], "{text}");
            assert_eq!(recording.column("r"), None);
        }
    }

    #[test]
    fn faults_have_their_lines() {
        for (text, line, message) in [
            ("t [s],x2 [V]\n0,1\n1,2\n", Some(1), "\"x2 [V]\": expected a length in m, mm"),
            ("t [s],x2\n0,1\n1,2\n", Some(1), "\"x2\": expected a length in m"),
            (
                "t [s],r [m]\n0,1\n1,2\n",
                Some(1),
                "no column x2; expected \"x2 [m]\"; the columns are t [s], r [m]",
            ),
            ("t [s],x2 [m]\n0,1\n1,NaN\n", Some(3), "x2: \"NaN\" is not a finite number"),
            ("t [s],x2 [m]\n0,1\n# pause\n1,\n", Some(4), "x2: has no value"),
            ("t [s],x2 [m]\n0,1\n0.5,one\n", Some(3), "x2: \"one\" is not a number"),
            ("t [s];x2 [m]\n0;1\n0,5;2\n", Some(3), "t: \"0,5\" has a decimal comma"),
            (
                "t [s],x2 [m]\n0,1\n0,5,2\n",
                Some(3),
                "3 cells, but the header has 2; a number has a decimal point",
            ),
            ("t [s],x2 [m]\n0,1\n1\n", Some(3), "1 cell, but the header has 2"),
            ("t [s],x2 [m]\n0,1\n0,2\n", Some(3), "t = 0 s does not come after 0 s in line 2"),
            ("t [s],x2 [m]\n0,1\n", None, "1 row of numbers; at least 2 are needed"),
            (
                "t [s],x2 [m]\n0,1\n1,\"2\n2,3\n",
                Some(3),
                "a cell has more than one line; a quote is not closed",
            ),
            ("t [s],x2 [m]\n0,1\n1,a\u{1b}\n", Some(3), "x2: \"a\\u001b\" is not a number"),
            ("t [s],t [s],x2 [m]\n0,0,1\n1,1,2\n", Some(1), "the column t stands twice"),
            ("", Some(1), "no column t; expected \"t [s]\"; the file is empty"),
        ] {
            let faults = read(text).expect_err(text);
            let is_told =
                |(its, told): &(Option<u64>, String)| *its == line && told.starts_with(message);
            assert!(faults.faults.iter().any(is_told), "{text}: {faults}");
        }
    }

    #[test]
    fn all_faults_are_told_at_once() {
        let faults = read("t [s],x2 [V]\nx,1\n1,y\n").expect_err("faults");
        assert_eq!(faults.faults.len(), 3, "{faults}");
        assert!(faults.to_string().starts_with("rig.csv: 3 faults\n  line 1: \"x2 [V]\""));
    }

    #[test]
    fn the_first_twenty_faults_are_told_and_all_are_counted() {
        for (rows, row) in [(1000, "a,b\n"), (2000, "0,1\n")] {
            let faults = read(&format!("t [s],x2 [m]\n{}", row.repeat(rows))).expect_err("faults");
            assert_eq!(faults.count, if rows == 1000 { 2000 } else { 1999 });
            let told = faults.to_string();
            assert_eq!(told.lines().count(), 22, "{told}");
            assert!(told.ends_with(&format!("and {} more", faults.count - 20)), "{told}");
        }
    }

    #[test]
    fn gaps_and_uneven_times_are_told() {
        let text = |times: &[f64]| {
            let rows: Vec<String> = times.iter().map(|t| format!("{t},0")).collect();
            format!("t [s],x2 [m]\n{}\n", rows.join("\n"))
        };
        let sampling = |times: &[f64]| read(&text(times)).expect("readable").sampling();
        let even = sampling(&[0.0, 0.1, 0.2, 0.3]);
        assert!(even.is_even && even.gaps.is_empty() && (even.interval - 0.1).abs() < 1e-12);
        let gap = sampling(&[0.0, 0.1, 0.2, 0.5, 0.6]);
        assert!(gap.is_even && gap.gaps.len() == 1, "{gap}");
        assert!(gap.to_string().contains("a gap of 0.3000 s at t = 0.200000 s"), "{gap}");
        assert!(!sampling(&[0.0, 0.1, 0.22, 0.3]).is_even);
    }
}
