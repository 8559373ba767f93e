//! Reads recordings from CSV, and finds every fault with its line.

use std::io::Read;

use csv::{ReaderBuilder, Trim};

use super::file_faults::{Faults, Kind};
use super::file_form::FileForm;
use super::file_rows::Rows;
use super::header::{Table, table};
use super::header_columns::Found;
use super::header_messages::{HeaderMessages, columns_of};
use super::preamble::intervals;
use super::recording::{Column, Presence, Recording, RecordingFaults, Sensed};
use super::table_lines::name_and_unit;
use crate::quantity::Dimension;
use crate::quantity::printable::excerpt;

impl Recording {
    /// Reads the columns that are `known` from the text of a file; other columns are left out. Where `known` has a
    /// column of times, they must increase. Lines that begin with `#` are comments, and rows without any value are left out.
    ///
    /// The header may stand below other lines, and units below the names ([`FileForm`] says more of it). Numbers have a decimal comma
    /// where the first one has it and no comma separates the cells. A cell that is empty or NaN leaves its sensor out of its row; a row
    /// that lacks a required column is left out.
    ///
    /// Fails with all faults at once, of which the first twenty are kept and the others counted: a column that is missing, is
    /// given twice or has another unit than its dimension allows, a cell that is not a finite number or has more than one line,
    /// a row of another length, times that do not increase, fewer than `least` rows. A fault of many rows is kept once, with its first
    /// line and how many they are. The time grows as the text does.
    pub fn read(
        source: &str,
        text: &str,
        known: &[Column],
        least: usize,
    ) -> Result<Recording, RecordingFaults> {
        Self::read_as(source, text, known, least, None)
    }

    /// The same of a file of which a `form` is said, or may be: then faults name the options that say it.
    ///
    /// Fails as [`Recording::read`], and where the form does not fit the file.
    pub fn read_as(
        source: &str,
        text: &str,
        known: &[Column],
        least: usize,
        form: Option<&FileForm>,
    ) -> Result<Recording, RecordingFaults> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let none = FileForm::default();
        let said = form.unwrap_or(&none);
        let table = table(text, known, said);
        let mut reading = Reading {
            faults: Faults::new(text),
            others: Vec::new(),
            notes: Vec::new(),
            known,
            table,
            form: said,
            has_options: form.is_some(),
        };
        let recording = reading.recording(source, least);
        reading.faults.none_or(source).map(|()| recording)
    }
}

struct Reading<'k> {
    faults: Faults<'k>,
    /// The names of the columns that were not asked for.
    others: Vec<String>,
    notes: Vec<String>,
    known: &'k [Column],
    table: Table<'k>,
    form: &'k FileForm,
    /// Whether the form can be said by options.
    has_options: bool,
}

impl Reading<'_> {
    fn recording(&mut self, source: &str, least: usize) -> Recording {
        let found = self.header();
        let interval = self.interval(&found);
        let mut rows = Rows::new(&self.table, found);
        let start = self.table.data;
        // Without a line break at its end the reader takes a last comment for a row.
        let whole = self.faults.text.as_bytes()[start..].chain(&b"\n"[..]);
        let mut reader = ReaderBuilder::new()
            .delimiter(self.table.delimiter)
            .comment(Some(b'#'))
            .flexible(true)
            .trim(Trim::All)
            .has_headers(false)
            .from_reader(whole);
        for (number, record) in reader.records().map_while(Result::ok).enumerate() {
            if record.iter().any(|cell| !cell.is_empty()) {
                rows.add(&record, (number, start as u64), &mut self.faults);
            }
        }
        self.tell_empty_cells(&rows);
        let lines = self.faults.lines(&rows.places);
        let Rows { columns, places, numbered, .. } = rows;
        let mut columns: Vec<(Column, Sensed)> =
            columns.into_iter().map(|(found, sensed)| (found.column, sensed)).collect();
        let times = self.known.iter().find(|it| it.is_times());
        if let (Some(interval), Some(times)) = (interval, times) {
            let values = numbered.iter().map(|number| *number as f64 * interval).collect();
            columns.insert(0, (*times, Sensed { rows: (0..places.len()).collect(), values }));
        }
        let [others, notes] = [&mut self.others, &mut self.notes].map(std::mem::take);
        let (source, rows) = (source.to_owned(), places.len());
        let recording = Recording { source, others, notes, columns, rows, lines };
        if self.faults.count == 0 {
            self.rows(&recording, &places, least);
        }
        recording
    }

    /// The known columns of the header; its faults are noted.
    fn header(&mut self) -> Vec<Found> {
        let at = self.table.at as u64;
        let mut found = self.table.found.clone();
        let mut is_known = vec![false; self.table.header.len()];
        for place in found.iter().flat_map(|it| it.places.iter()) {
            is_known.iter_mut().skip(*place).take(1).for_each(|it| *it = true);
        }
        for (cell, is_known) in self.table.header.iter().zip(is_known) {
            if !is_known && !cell.is_empty() {
                self.others.push(excerpt(name_and_unit(cell).0).into_owned());
            }
        }
        if self.form.interval.is_some() {
            let times = found.iter().find(|it| it.column.is_times());
            if let Some(cell) = times.and_then(|it| self.table.header.get(it.places[0])) {
                let why =
                    format!("the column {} is not read, as --interval is given", excerpt(cell));
                self.notes.push(why);
            }
            found.retain(|it| !it.column.is_times());
        }
        for it in &found {
            let name = it.column.name;
            if it.places.len() > 1 {
                let message = self.messages().stands_twice(it);
                self.faults.push((name, Kind::Header), at, |_| message);
            }
            if it.size.is_none() {
                let message = self.messages().other_unit(it);
                self.faults.push((name, Kind::Header), at, |_| message);
            }
        }
        for column in self.known {
            let is_there = found.iter().any(|found| found.column == *column);
            let name = column.name;
            if let Some(said) = self.form.named(name).filter(|_| !is_there) {
                let columns = columns_of(&self.table.header);
                let message = format!(
                    "--columns {name}={}: there is no such column; {columns}",
                    excerpt(said)
                );
                self.faults.push((name, Kind::Header), at, |_| message);
            } else if !is_there && column.presence == Presence::Required && !column.is_times() {
                let message = self.messages().missing(*column);
                self.faults.push((name, Kind::Header), at, |_| message);
            }
        }
        found
    }

    /// The time between two samples where no column has the times [s].
    fn interval(&mut self, found: &[Found]) -> Option<f64> {
        let times = *self.known.iter().find(|it| it.is_times())?;
        let column = found.iter().find(|it| it.column.is_times());
        if self.form.interval.is_some() {
            return self.form.interval;
        }
        if column.is_some()
            || self.form.named("t").is_some()
            || times.presence == Presence::Optional
        {
            return None;
        }
        let mut said = intervals(&self.table.before, self.table.delimiter);
        said.dedup_by(|a, b| a.interval == b.interval);
        match said.as_slice() {
            [one] if times.dimension == Dimension::Time => {
                let line = self.faults.line(one.at as u64);
                self.notes.push(format!(
                    "no column of times: the samples are {} s apart, as line {line} says ({})",
                    one.interval,
                    excerpt(&one.label)
                ));
                Some(one.interval)
            }
            _ => {
                let mut message = self.messages().missing(times);
                if said.len() > 1 {
                    message +=
                        &format!("; {} lines say different intervals of samples", said.len());
                }
                self.faults.push((times.name, Kind::Header), self.table.at as u64, |_| message);
                None
            }
        }
    }

    fn messages(&self) -> HeaderMessages<'_> {
        HeaderMessages { header: &self.table.header, has_options: self.has_options }
    }

    /// Notes of which columns cells are empty.
    fn tell_empty_cells(&mut self, rows: &Rows) {
        for ((found, _), (count, first)) in rows.columns.iter().zip(&rows.empty) {
            if *count > 0 {
                let line = self.faults.line(*first);
                let [cells, those] = match count {
                    1 => ["cell is", "that row"],
                    _ => ["cells are", "those rows"],
                };
                let without = match found.column.presence {
                    Presence::Required => {
                        format!("; {those} are left out").replace("row are", "row is")
                    }
                    Presence::Optional => String::new(),
                };
                let name = found.column.name;
                self.notes.push(format!(
                    "{name}: {count} {cells} empty or NaN, the first in line {line}{without}"
                ));
            }
        }
    }

    /// What is asked of all rows together.
    fn rows(&mut self, recording: &Recording, places: &[u64], least: usize) {
        if recording.rows() < least {
            let rows = recording.rows();
            let are = if rows == 1 { "row" } else { "rows" };
            self.faults.of_file(format!("{rows} {are} of numbers; at least {least} are needed"));
        }
        let Some(times) = recording.sensed("t") else { return };
        let option = if self.has_options {
            "; where they are rounded, --interval stands for those of equally spaced samples"
        } else {
            ""
        };
        for (i, pair) in times.values.windows(2).enumerate() {
            if pair[1] <= pair[0] {
                let before = recording.lines[i];
                self.faults.push(("t", Kind::Order), places[i + 1], |_| {
                    format!(
                        "t = {} s does not come after {} s in line {before}; times must increase{option}",
                        pair[1], pair[0]
                    )
                });
            }
        }
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
            assert_eq!(recording.sensed("r"), None);
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
            ("t [s],x2 [m]\n0,1\n1,inf\n", Some(3), "x2: \"inf\" is not a finite number"),
            ("t [s],x2 [m]\n0,1\n# pause\n,1\n", Some(4), "t: has no value"),
            ("t [s],x2 [m]\n0,1\n1,NaN\n", None, "1 row of numbers; at least 2 are needed"),
            ("t [s],x2 [m]\n0,1\n0.5,one\n", Some(3), "x2: \"one\" is not a number"),
            (
                "t [s];x2 [m]\n0;1.5\n0,5;2\n",
                Some(3),
                "t: \"0,5\" has a decimal comma, but numbers in line 2",
            ),
            (
                "t [s],x2 [m]\n0,1\n\"0,5\",2\n",
                Some(3),
                "t: \"0,5\" has a decimal comma, and commas",
            ),
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
            ("", Some(1), "no column t; expected \"t [s]\"; the file is empty, or"),
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
    fn a_fault_that_repeats_is_told_once_and_counted() {
        for (rows, row, lines) in [(1000, "a,b\n", 3), (2000, "0,1\n", 2)] {
            let faults = read(&format!("t [s],x2 [m]\n{}", row.repeat(rows))).expect_err("faults");
            assert_eq!(faults.count, if rows == 1000 { 2000 } else { 1999 });
            let told = faults.to_string();
            assert_eq!(told.lines().count(), lines, "{told}");
            let each = if rows == 1000 { 1000 } else { 1999 };
            assert!(
                told.ends_with(&format!("; so in {each} rows, of which this is the first")),
                "{told}"
            );
        }
        let twice = "t [s],x2 [V]\n0,1\n1,2\n";
        assert!(!read(twice).expect_err("a fault").to_string().contains("rows"));
    }

    #[test]
    fn an_empty_cell_leaves_its_sensor_out_of_its_row() {
        let text = "t [s];x2 [mm];r [mm]\n0;1;\n1;2;0,5\n2;;0,6\n;;\n3;4;NaN\n";
        let recording = read(text).expect("readable");
        // x2 is required: its row is left out.
        assert_eq!(recording.required("t"), [0.0, 1.0, 3.0]);
        assert_eq!(recording.required("x2"), [1e-3, 2e-3, 4e-3]);
        let r = recording.sensed("r").expect("read");
        assert_eq!((&r.rows[..], &r.values[..]), (&[1][..], &[0.5e-3][..]));
        assert_eq!([0, 1, 2].map(|row| recording.line(row)), [2, 3, 6]);
        assert_eq!(
            recording.notes,
            [
                "x2: 1 cell is empty or NaN, the first in line 4; that row is left out",
                "r: 2 cells are empty or NaN, the first in line 2"
            ]
        );
    }

    #[test]
    fn times_may_be_an_interval_and_columns_may_be_named() {
        let mut form = FileForm { interval: Some(2e-3), ..FileForm::default() };
        form.name_columns("x2=Ch1:2.5 mm, r=#3:mm").expect("a list");
        let text = "Rig 3\nTime,Ch1,Ch2\n12:00:01,1,4\n12:00:02,2,5\n,,\n12:00:03,4,6\n";
        let recording = Recording::read_as("rig.csv", text, &KNOWN, 2, Some(&form)).expect("read");
        assert_eq!(recording.required("t"), [0.0, 2e-3, 3.0 * 2e-3]);
        assert_eq!(recording.required("x2"), [2.5e-3, 5e-3, 1e-2]);
        assert_eq!(recording.required("r"), [4e-3, 5e-3, 6e-3]);
        assert_eq!(recording.notes, ["the column Time is not read, as --interval is given"]);
        form.interval = None;
        let told = Recording::read_as("rig.csv", text, &KNOWN, 2, Some(&form)).expect_err("faults");
        assert!(told.to_string().contains("--columns \"t=Time:s\""), "{told}");
    }
}
