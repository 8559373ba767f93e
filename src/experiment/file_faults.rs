//! The faults of a recording's file with their lines; one that repeats is kept once and counted.

use super::cells::Wrong;
use super::recording::{MOST_TOLD, RecordingFaults};

/// Faults of one kind in one column are one that repeats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Of the header; these do not repeat.
    Header,
    /// A row of another length.
    Length,
    /// A cell of more than one line.
    Quote,
    /// A time that is not there.
    Empty,
    /// What a cell holds.
    Cell(Wrong),
    /// A time that does not come after the one before.
    Order,
}

/// A fault that has been found.
#[derive(Debug)]
struct Fault {
    /// The column and the kind; none of the whole file.
    key: Option<(&'static str, Kind)>,
    line: Option<u64>,
    message: String,
    /// How many times.
    times: usize,
}

/// The faults of a text.
#[derive(Debug)]
pub(super) struct Faults<'t> {
    /// The text.
    pub text: &'t str,
    /// How many there are.
    pub count: usize,
    faults: Vec<Fault>,
    /// Those that are of none of these.
    untold: usize,
}

impl<'t> Faults<'t> {
    /// None yet.
    pub fn new(text: &'t str) -> Self {
        Faults { text, count: 0, faults: Vec::new(), untold: 0 }
    }

    /// Notes a fault of the row at this byte, if it is the first of its column and kind: to count lines and to put words together for
    /// each of many would take long.
    pub fn push(
        &mut self,
        key: (&'static str, Kind),
        at: u64,
        message: impl FnOnce(&Self) -> String,
    ) {
        self.count += 1;
        let repeats = key.1 != Kind::Header;
        if let Some(same) = self.faults.iter_mut().find(|it| repeats && it.key == Some(key)) {
            same.times += 1;
        } else if self.faults.len() < MOST_TOLD {
            let (line, message) = (Some(self.line(at)), message(self));
            self.faults.push(Fault { key: Some(key), line, message, times: 1 });
        } else {
            self.untold += 1;
        }
    }

    /// Notes a fault of the whole file.
    pub fn of_file(&mut self, message: String) {
        self.count += 1;
        self.faults.push(Fault { key: None, line: None, message, times: 1 });
    }

    /// The line of the row at this byte, before which the reader may have left out lines.
    pub fn line(&self, at: u64) -> u64 {
        self.lines(&[at])[0]
    }

    /// The lines of rows at these bytes, which rise.
    pub fn lines(&self, places: &[u64]) -> Vec<u64> {
        let (mut from, mut line) = (0, 1);
        let lines = places.iter().map(|&at| {
            let (before, after) = self.text.split_at(at as usize);
            line += before[from..].matches('\n').count();
            from = at as usize;
            let left_out = after.lines().take_while(|it| it.is_empty() || it.starts_with('#'));
            (line + left_out.count()) as u64
        });
        lines.collect()
    }

    /// An error with all faults; none where there are none.
    pub fn none_or(self, source: &str) -> Result<(), RecordingFaults> {
        if self.count == 0 {
            return Ok(());
        }
        let Faults { count, untold, .. } = self;
        let faults = self.faults.into_iter().map(|it| match it.times {
            1 => (it.line, it.message),
            times => {
                (it.line, format!("{}; so in {times} rows, of which this is the first", it.message))
            }
        });
        let (source, faults) = (source.to_owned(), faults.collect());
        Err(RecordingFaults { source, faults, count, untold })
    }
}
