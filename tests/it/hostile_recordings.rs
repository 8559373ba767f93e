//! Recordings as CSV of whatever text: read to the numbers that stand in them or refused, in a time that grows as they do.

use std::time::{Duration, Instant};

use capsulemap::experiment::{Column, Presence, Recording, Window, smoothed};
use capsulemap::quantity::Dimension;
use proptest::prelude::*;

use super::damage::fuzz;

const KNOWN: [Column; 3] = [
    Column { name: "t", dimension: Dimension::Time, presence: Presence::Required },
    Column { name: "x2", dimension: Dimension::Length, presence: Presence::Required },
    Column { name: "r", dimension: Dimension::Length, presence: Presence::Optional },
];
/// Headers by column, the sizes of their units, and a column that is not read.
const HEADERS: [&[(&str, f64)]; 4] = [
    &[("t [s]", 1.0), ("t (ms)", 1e-3), ("t in min", 60.0)],
    &[("x2 [mm]", 1e-3), ("x2/m", 1.0)],
    &[("r [m]", 1.0), ("r / um", 1e-6)],
    &[("note", 1.0)],
];
/// What cells hold besides numbers.
const CELLS: [&str; 14] = [
    "", "NaN", "inf", "-1e400", "1e308", "4,5", "0x10", "1_0", "+.5", "-0", " 7 ", "\u{b5}", "1e",
    "#3",
];

/// A recording with damage: a text in which no other program would see more than one table.
#[derive(Debug, Clone)]
struct Hostile {
    delimiter: char,
    /// Which of the headers of each column, and the order of the columns.
    headers: [usize; 4],
    turns: usize,
    rows: Vec<[String; 4]>,
    /// Where a character is put over another, as a share of the rows' text.
    damage: Vec<(f64, char)>,
    line_end: &'static str,
}

fn hostile() -> impl Strategy<Value = Hostile> {
    let number = (-1e6..1e6_f64, -12..12_i32).prop_map(|(it, exponent)| format!("{it}e{exponent}"));
    let cell = prop_oneof![
        24 => number,
        1 => (0..CELLS.len()).prop_map(|i| CELLS[i].to_owned()),
    ];
    let time = prop_oneof![30 => Just(None), 1 => cell.clone().prop_map(Some)];
    let row = (time, cell.clone(), cell.clone(), cell);
    let rows = proptest::collection::vec(row, 0..40).prop_map(|rows| {
        let numbered = rows.into_iter().enumerate();
        let row = |(i, (t, x2, r, note))| {
            let t: Option<String> = t;
            [t.unwrap_or_else(|| format!("{}", 0.1 * i as f64)), x2, r, note]
        };
        numbered.map(row).collect::<Vec<_>>()
    });
    let damage = prop_oneof![
        Just(',').boxed(),
        Just(';').boxed(),
        Just('"').boxed(),
        Just('\n').boxed(),
        Just('#').boxed(),
        Just('\t').boxed(),
        Just('\u{b5}').boxed(),
        Just('\r').boxed(),
        proptest::char::range('0', '9').boxed(),
    ];
    let damages = proptest::collection::vec((0.0..1.0_f64, damage), 0..3);
    let headers = (0..3_usize, 0..2_usize, 0..2_usize).prop_map(|(t, x2, r)| [t, x2, r, 0]);
    let delimiter = prop_oneof![Just(','), Just(';'), Just('\t')];
    let line_end = prop_oneof![Just("\n"), Just("\r\n")];
    (delimiter, headers, 0..4_usize, rows, damages, line_end).prop_map(
        |(delimiter, headers, turns, rows, damage, line_end)| Hostile {
            delimiter,
            headers,
            turns,
            rows,
            damage,
            line_end,
        },
    )
}

impl Hostile {
    /// The columns in their order in the file.
    fn order(&self) -> [usize; 4] {
        std::array::from_fn(|i| (i + self.turns) % 4)
    }

    fn joined(&self, cells: [&str; 4]) -> String {
        let mut cells = cells;
        cells.rotate_left(self.turns);
        cells.join(&self.delimiter.to_string()) + self.line_end
    }

    fn text(&self) -> String {
        let header = self.joined(std::array::from_fn(|i| HEADERS[i][self.headers[i]].0));
        let rows = self.rows.iter().map(|row| self.joined(row.each_ref().map(String::as_str)));
        let mut rows: Vec<char> = rows.collect::<String>().chars().collect();
        let length = rows.len();
        for (at, other) in &self.damage {
            rows.iter_mut().skip((at * length as f64) as usize).take(1).for_each(|it| *it = *other);
        }
        header + &rows.into_iter().collect::<String>()
    }

    /// The numbers of the columns t, x2 and r by a reader of its own, r perhaps empty; none where a cell is no number, or where the text
    /// has quotes or ends of lines that are read in more than one sense.
    fn numbers(&self, text: &str) -> Option<Option<[Vec<f64>; 3]>> {
        let plain = text.replace("\r\n", "\n");
        if plain.contains(['"', '\r']) {
            return None;
        }
        let lines = plain.split('\n').skip(1).filter(|it| !it.is_empty() && !it.starts_with('#'));
        let mut columns = [const { Vec::new() }; 3];
        let (mut has_point, mut has_comma) = (false, false);
        for line in lines {
            let cells: Vec<&str> = line.split(self.delimiter).map(str::trim).collect();
            if cells.iter().all(|it| it.is_empty()) {
                continue;
            }
            // What stands behind the columns may be empty.
            if cells.len() < 4 || cells[4..].iter().any(|it| !it.is_empty()) {
                return Some(None);
            }
            let mut row = [None; 3];
            for (cell, column) in cells.iter().zip(self.order()).filter(|(_, column)| *column < 3) {
                let size = HEADERS[column][self.headers[column]].1;
                let is_comma = self.delimiter != ',' && cell.matches(',').count() == 1;
                let plain = if is_comma { cell.replace(',', ".") } else { (*cell).to_owned() };
                has_comma |= is_comma;
                has_point |= cell.contains('.');
                match plain.parse::<f64>().map(|it| it * size) {
                    _ if cell.is_empty() => {}
                    Ok(value) if value.is_nan() => {}
                    Ok(value) if value.is_finite() => row[column] = Some(value),
                    _ => return Some(None),
                }
            }
            match row {
                [None, ..] => return Some(None),
                [Some(t), Some(x2), r] => {
                    columns[0].push(t);
                    columns[1].push(x2);
                    columns[2].extend(r);
                }
                _ => {}
            }
        }
        if has_point && has_comma {
            return Some(None);
        }
        let rises = columns[0].windows(2).all(|pair| pair[0] < pair[1]);
        Some((rises && columns[0].len() >= 2).then_some(columns))
    }
}

/// In the long form ten minutes, `FUZZ_SECONDS=600`.
#[test]
fn any_recording_is_read_to_its_own_numbers_or_refused() {
    let count = fuzz(&hostile(), |hostile| {
        let text = hostile.text();
        let begun = Instant::now();
        let read = Recording::read("rig.csv", &text, &KNOWN, 2);
        prop_assert!(begun.elapsed() < Duration::from_secs(10));
        let lines = text.split(['\n', '\r']).count() as u64;
        match (&read, hostile.numbers(&text)) {
            (Ok(read), expected) => {
                prop_assert!(read.rows() as u64 <= lines);
                let found = ["t", "x2", "r"].map(|name| read.required(name).to_vec());
                prop_assert!(found[..2].iter().all(|it| it.len() == read.rows()));
                let rows = &read.sensed("r").expect("read").rows;
                prop_assert!(rows.len() == found[2].len() && rows.is_sorted_by(|a, b| a < b));
                prop_assert!(rows.iter().all(|row| *row < read.rows()));
                prop_assert!(found.iter().flatten().all(|it| it.is_finite()));
                if let Some(expected) = expected {
                    let bits = |all: &[Vec<f64>; 3]| {
                        all.each_ref()
                            .map(|it| it.iter().map(|it| it.to_bits()).collect::<Vec<_>>())
                    };
                    prop_assert_eq!(Some(bits(&found)), expected.as_ref().map(bits), "{:?}", text);
                }
            }
            (Err(faults), expected) => {
                prop_assert!(!matches!(expected, Some(Some(_))), "{:?} {}", text, faults);
                prop_assert!(faults.count > 0 && faults.faults.len() <= 20);
                let known = faults.faults.iter().filter_map(|it| it.0);
                prop_assert!(known.into_iter().all(|line| (1..=lines + 1).contains(&line)));
                prop_assert!(faults.to_string().lines().count() <= 22);
            }
        }
        Ok(())
    });
    println!("{count} recordings");
}

/// A reader of CSV may take a comment without a line break after it for a row.
#[test]
fn a_file_may_end_without_a_line_break() {
    for rows in ["0,1\n1,2", "0,1\n1,2\n# the end", "0,1\r1,2\r# the end", "0,1\n1,\"2\""] {
        let text = format!("t [s],x2 [m]\n{rows}");
        let recording = Recording::read("rig.csv", &text, &KNOWN, 2).expect(rows);
        assert_eq!(recording.required("x2"), [1.0, 2.0], "{rows}");
    }
}

/// The shortest of three times that something takes.
fn shortest(what: impl Fn()) -> Duration {
    let time = |_| {
        let begun = Instant::now();
        what();
        begun.elapsed()
    };
    (0..3).map(time).min().expect("three times")
}

/// Ten times as much takes ten times as long, by a factor that the load of a machine explains; what grows as the square would take
/// a hundred times as long.
fn grows_linearly(name: &str, times: [Duration; 2]) {
    let ratio = times[1].as_secs_f64() / times[0].as_secs_f64();
    println!("{name}: {:.3?}, {:.3?}: {ratio:.1} times as long", times[0], times[1]);
    assert!(ratio < 40.0, "{name}: {times:?}");
}

/// In the long form `ROWS=100000` and ten times as many.
#[test]
fn the_time_of_faulty_rows_grows_as_they_do() {
    let rows = std::env::var("ROWS").ok().and_then(|text| text.parse().ok()).unwrap_or(20_000);
    for (name, row) in [
        ("no numbers", "a,b\n"),
        ("times that do not increase", "0,1\n"),
        ("rows of another length", "0,1,2\n"),
        ("decimal commas and comments", "#\n\n\"0,5\",1\n"),
    ] {
        let times = [1, 10].map(|many| {
            let text = format!("t [s],x2 [m]\n{}", row.repeat(many * rows));
            shortest(|| {
                let faults = Recording::read("rig.csv", &text, &KNOWN, 2).expect_err("faults");
                assert!(faults.count >= many * rows - 1);
            })
        });
        grows_linearly(name, times);
    }
    let times = [1, 10].map(|many| {
        let columns = ["t [s],".repeat(many * rows), "x2 [m],".repeat(many * rows)].concat();
        shortest(|| assert!(Recording::read("rig.csv", &columns, &KNOWN, 2).is_err()))
    });
    grows_linearly("columns that stand more than once", times);
}

#[test]
fn the_time_of_smoothing_grows_with_the_record_and_not_with_the_window() {
    let times = [20_000, 200_000].map(|rows: usize| {
        let at: Vec<f64> = (0..rows).map(|i| 1e-3 * i as f64).collect();
        let values: Vec<f64> = at.iter().map(|t| (7.0 * t).sin()).collect();
        let window = Window { samples: (rows / 3) | 1, order: 3 };
        shortest(|| assert!(smoothed(&at, &values, window, 0).is_ok()))
    });
    grows_linearly("windows of a third of the record", times);
}
