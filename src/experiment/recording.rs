//! Recordings of an experiment: columns of numbers with units, and how their times are spaced.

use std::fmt;
use std::ops::Range;

use crate::quantity::Dimension;
use crate::quantity::printable::one_line;

/// So many faults of a file are kept and told; the others are counted.
pub const MOST_TOLD: usize = 20;
/// So many gaps of a record are named; the others are counted.
const MOST_GAPS: usize = 5;
/// An interval this many times the median one is a gap.
pub const GAP: f64 = 1.5;
/// Intervals that differ from the median one by more than this share of it are uneven.
const EVEN: f64 = 1e-3;

/// A column that a recording may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Its name in the header.
    pub name: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    /// Whether a recording must have it.
    pub presence: Presence,
}

impl Column {
    /// Whether it is that of times.
    pub fn is_times(&self) -> bool {
        self.name == "t"
    }
}

/// Whether a recording must have a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// It must.
    Required,
    /// It may.
    Optional,
}

/// What is wrong in a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingFaults {
    /// The file.
    pub source: String,
    /// The first twenty: line, counted from 1, and what is wrong there; no line where the whole file is meant. One that repeats stands here
    /// once, with how many times.
    pub faults: Vec<(Option<u64>, String)>,
    /// How many there are in all.
    pub count: usize,
    /// How many of them are of none of those.
    pub untold: usize,
}

impl fmt::Display for RecordingFaults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let RecordingFaults { source, faults, count, untold } = self;
        let plural = if *count == 1 { "fault" } else { "faults" };
        write!(f, "{}: {count} {plural}", one_line(source))?;
        for (line, message) in faults {
            match line {
                Some(line) => write!(f, "\n  line {line}: {message}")?,
                None => write!(f, "\n  {message}")?,
            }
        }
        match untold {
            0 => Ok(()),
            more => write!(f, "\n  and {more} more"),
        }
    }
}

impl std::error::Error for RecordingFaults {}

/// What a sensor has recorded: its values (SI), each in its row; a row whose cell was empty has none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sensed {
    /// The rows, counted from 0, rising.
    pub rows: Vec<usize>,
    /// The value in each [SI].
    pub values: Vec<f64>,
}

impl From<Vec<f64>> for Sensed {
    /// A value in each row.
    fn from(values: Vec<f64>) -> Sensed {
        Sensed { rows: (0..values.len()).collect(), values }
    }
}

impl Sensed {
    /// The values in the first rows, so many.
    pub fn first(&self, rows: usize) -> Sensed {
        let count = self.rows.partition_point(|row| *row < rows);
        Sensed { rows: self.rows[..count].to_vec(), values: self.values[..count].to_vec() }
    }

    /// Pairs of its values and those of its rows in something that has a value in each row.
    pub fn beside<'s, T>(&'s self, all: &'s [T]) -> impl Iterator<Item = (f64, &'s T)> {
        self.rows.iter().zip(&self.values).map(|(row, value)| (*value, &all[*row]))
    }

    /// The times of its values, by those of all rows.
    pub fn at(&self, times: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| times[*row]).collect()
    }
}

/// The columns of a file that were asked for, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// The file.
    pub source: String,
    /// The names of the columns of the file that were not asked for.
    pub others: Vec<String>,
    /// What must be known of how the file was read, in sentences: cells that are empty, times that were not in it.
    pub notes: Vec<String>,
    pub(super) columns: Vec<(Column, Sensed)>,
    pub(super) rows: usize,
    /// The line of each row.
    pub(super) lines: Vec<u64>,
}

/// The times of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampling {
    /// Samples.
    pub count: usize,
    /// The first time [s].
    pub first: f64,
    /// Median time between two samples [s].
    pub interval: f64,
    /// Whether all intervals but the gaps are equal, within a thousandth of the median.
    pub is_even: bool,
    /// Where each gap begins, and how long it is [s]: an interval of more than one and a half times the median.
    pub gaps: Vec<(f64, f64)>,
}

impl Recording {
    /// What a column holds, if the recording has it.
    pub fn sensed(&self, name: &str) -> Option<&Sensed> {
        let (_, sensed) = self.columns.iter().find(|(column, _)| column.name == name)?;
        Some(sensed)
    }

    /// The values of a column that was required, one in each row [SI].
    ///
    /// # Panics
    /// Where the recording does not have it.
    pub fn required(&self, name: &str) -> &[f64] {
        &self.sensed(name).expect("a required column is there").values
    }

    /// The values of a column, one in each row, if the recording has it [SI].
    ///
    /// Fails where a row has none, with the column and the first line.
    pub fn whole(&self, name: &str) -> Result<Option<&[f64]>, String> {
        let Some(Sensed { rows, values }) = self.sensed(name) else { return Ok(None) };
        if values.len() == self.rows {
            return Ok(Some(values));
        }
        let first = (0..self.rows).find(|row| rows.get(*row) != Some(row)).unwrap_or(0);
        let (line, empty) = (self.line(first), self.rows - values.len());
        Err(format!(
            "{name}: {empty} of {} rows have no value, the first in line {line}; leave those rows out of the file, or the column",
            self.rows
        ))
    }

    /// The line of the file, counted from 1, of a row.
    pub fn line(&self, row: usize) -> u64 {
        self.lines[row]
    }

    /// Rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The values of a column, one in each row, if the recording has it; NaN where a row has none [SI].
    pub fn filled(&self, name: &str) -> Option<Vec<f64>> {
        let Sensed { rows, values } = self.sensed(name)?;
        let mut filled = vec![f64::NAN; self.rows];
        rows.iter().zip(values).for_each(|(row, value)| filled[*row] = *value);
        Some(filled)
    }

    /// The times between the rows, by the column of times `t`.
    ///
    /// # Panics
    /// Where the recording has no column `t`, or fewer than two rows.
    pub fn sampling(&self) -> Sampling {
        let times = self.required("t");
        let intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let interval = median(&intervals);
        let (mut gaps, mut is_even) = (Vec::new(), true);
        for (&begins, &length) in times.iter().zip(&intervals) {
            if length > GAP * interval {
                gaps.push((begins, length));
            } else if (length - interval).abs() > EVEN * interval {
                is_even = false;
            }
        }
        Sampling { count: times.len(), first: times[0], interval, is_even, gaps }
    }
}

impl Sampling {
    /// The samples of the longest part of the record without a gap, by its times since any moment.
    pub fn whole_part(&self, times: &[f64]) -> Range<usize> {
        let parts = self.parts(times).into_iter();
        parts.max_by_key(ExactSizeIterator::len).unwrap_or(0..times.len())
    }

    /// The samples of each part of the record without a gap, by its times since any moment.
    pub fn parts(&self, times: &[f64]) -> Vec<Range<usize>> {
        let (mut parts, mut from) = (Vec::new(), 0);
        for (begins, _) in &self.gaps {
            let ends = begins - self.first + 0.5 * self.interval;
            let end = times.partition_point(|time| time - times[0] <= ends).max(from);
            parts.push(from..end);
            from = end;
        }
        parts.push(from..times.len().max(from));
        parts
    }
}

impl fmt::Display for Sampling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rate = 1.0 / self.interval;
        write!(f, "{} samples at {rate:.6} Hz", self.count)?;
        if !self.is_even {
            f.write_str(" in the median, not evenly spaced")?;
        }
        match self.gaps.as_slice() {
            [] => Ok(()),
            [(begins, length)] => write!(f, "; a gap of {length:.4} s at t = {begins:.6} s"),
            gaps => {
                let first = gaps.iter().take(MOST_GAPS);
                let named = first
                    .map(|(begins, length)| format!("{length:.4} s at t = {begins:.6} s"))
                    .collect::<Vec<_>>();
                write!(f, "; {} gaps, of {}", gaps.len(), named.join(", "))?;
                match gaps.len().saturating_sub(MOST_GAPS) {
                    0 => Ok(()),
                    more => write!(f, " and {more} more"),
                }
            }
        }
    }
}

/// The median of at least one number.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() % 2 {
        1 => sorted[middle],
        _ => 0.5 * (sorted[middle - 1] + sorted[middle]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_and_uneven_times_are_told() {
        let sampling = |times: &[f64]| {
            let rows: Vec<String> = times.iter().map(|t| format!("{t}\n")).collect();
            let presence = Presence::Required;
            let column = Column { name: "t", dimension: Dimension::Time, presence };
            let text = format!("t [s]\n{}", rows.concat());
            Recording::read("rig.csv", &text, &[column], 2).expect("readable").sampling()
        };
        let even = sampling(&[0.0, 0.1, 0.2, 0.3]);
        assert!(even.is_even && even.gaps.is_empty() && (even.interval - 0.1).abs() < 1e-12);
        let gap = sampling(&[0.0, 0.1, 0.2, 0.5, 0.6]);
        assert!(gap.is_even && gap.gaps.len() == 1, "{gap}");
        assert!(gap.to_string().contains("a gap of 0.3000 s at t = 0.200000 s"), "{gap}");
        assert!(!sampling(&[0.0, 0.1, 0.22, 0.3]).is_even);
    }
}
