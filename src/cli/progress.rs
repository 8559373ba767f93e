//! Progress of a long run: a bar on a terminal, plain lines in a log.

use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::readable::time;
use super::terminal::{in_turn, notify};

/// Before the first line of a log, as quick work needs none.
const FIRST_LINE: Duration = Duration::from_secs(2);
/// The bar is brought up to date this often.
const TICK: Duration = Duration::from_millis(100);
/// Between two lines of a log at least.
const LINE_INTERVAL: Duration = Duration::from_secs(10);

/// No time left is told before so much has passed.
const TOLD_AFTER: Duration = Duration::from_secs(5);
/// Nor before so many are done, and one in so many of all: the first to be done are seldom like the others.
const TOLD_FROM: usize = 8;
const TOLD_SHARE: usize = 100;

/// Whether what `done` of `total` have taken says how long the rest will take.
pub fn tells_the_rest(elapsed: Duration, done: usize, total: usize) -> bool {
    let enough = done >= TOLD_FROM.max(total.div_ceil(TOLD_SHARE));
    done == total || (elapsed >= TOLD_AFTER && enough)
}

/// What is said where that is not so.
pub const NOT_KNOWN: &str = "time left not known yet";

/// How many steps of a stage will be done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Steps {
    /// All.
    All,
    /// No more than all; it may end before.
    AtMost,
}

/// The time that the rest of `total` takes at the pace of those `done`, in words.
fn left(elapsed: Duration, done: usize, total: usize, steps: Steps) -> String {
    if !tells_the_rest(elapsed, done, total) {
        return NOT_KNOWN.to_owned();
    }
    let each = elapsed.as_secs_f64() / done.max(1) as f64;
    let most = if steps == Steps::AtMost { "at most " } else { "" };
    format!("{most}{} left", time((total - done) as f64 * each))
}

/// Shows how many are done, how fast, and how long the rest will take.
pub struct Progress {
    total: usize,
    what: &'static str,
    steps: Steps,
    begun: Instant,
    bar: Option<ProgressBar>,
    lines: Mutex<Lines>,
}

struct Lines {
    done: usize,
    next: Duration,
}

impl Progress {
    /// Begins to watch `total` of `what`, or fewer.
    pub fn new(total: usize, what: &'static str, steps: Steps) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template(&format!(
                "{{wide_bar}} {{human_pos}}/{{human_len}} {what}, {{per_sec}}, {{msg}}"
            ))
            .unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::new(total as u64).with_style(style)
        });
        let next = if bar.is_some() { Duration::ZERO } else { FIRST_LINE };
        let lines = Mutex::new(Lines { done: 0, next });
        Progress { total, what, steps, begun: Instant::now(), bar, lines }
    }

    /// Notes that one more case is done.
    pub fn step(&self) {
        let Ok(mut lines) = self.lines.lock() else { return };
        lines.done += 1;
        let elapsed = self.begun.elapsed();
        if elapsed < lines.next {
            return;
        }
        if let Some(bar) = self.bar.clone() {
            lines.next = elapsed + TICK;
            let (done, left) =
                (lines.done as u64, left(elapsed, lines.done, self.total, self.steps));
            in_turn(Box::new(move || {
                bar.set_position(done);
                bar.set_message(left);
            }));
        } else {
            lines.next = elapsed + LINE_INTERVAL;
            let rate = lines.done as f64 / elapsed.as_secs_f64();
            let (done, total, what) = (lines.done, self.total, self.what);
            let left = left(elapsed, done, total, self.steps);
            let decimals = if rate < 10.0 { 2 } else { 0 };
            notify(&format!("{done}/{total} {what}, {rate:.decimals$} a second, {left}"));
        }
    }

    /// Ends the watch; returns the time it took.
    pub fn finish(&self) -> Duration {
        if let Some(bar) = self.bar.clone() {
            in_turn(Box::new(move || bar.finish_and_clear()));
        }
        self.begun.elapsed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_time_is_told_before_it_means_something() {
        let after =
            |seconds: f64, done| left(Duration::from_secs_f64(seconds), done, 34_160, Steps::All);
        // One link in four seconds said that all would take a day and a half, when they took seconds.
        for (seconds, done) in [(3.8, 1), (60.0, 1), (60.0, 341), (4.9, 20_000)] {
            assert_eq!(after(seconds, done), NOT_KNOWN, "{done} after {seconds} s");
        }
        assert_eq!(after(60.0, 3416), format!("{} left", time(540.0)));
        let most = left(Duration::from_secs(60), 3416, 34_160, Steps::AtMost);
        assert_eq!(most, format!("at most {} left", time(540.0)));
        assert_eq!(after(0.5, 34_160), format!("{} left", time(0.0)));
        let few = |done| tells_the_rest(Duration::from_secs(60), done, 20);
        assert_eq!([few(1), few(7), few(8), few(20)], [false, false, true, true]);
    }
}
