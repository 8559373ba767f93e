//! Progress of a long run: a bar on a terminal, plain lines in a log.

use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::terminal::{in_turn, notify};

/// Before the first line of a log, as quick work needs none.
const FIRST_LINE: Duration = Duration::from_secs(2);
/// The bar is brought up to date this often.
const TICK: Duration = Duration::from_millis(100);
/// Between two lines of a log at least.
const LINE_INTERVAL: Duration = Duration::from_secs(10);

/// Shows how many are done, how fast, and how long the rest will take.
pub struct Progress {
    total: usize,
    what: &'static str,
    begun: Instant,
    bar: Option<ProgressBar>,
    lines: Mutex<Lines>,
}

struct Lines {
    done: usize,
    next: Duration,
}

impl Progress {
    /// Begins to watch `total` of `what`.
    pub fn new(total: usize, what: &'static str) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template(&format!(
                "{{wide_bar}} {{human_pos}}/{{human_len}} {what}, {{per_sec}}, {{eta_precise}} left"
            ))
            .unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::new(total as u64).with_style(style)
        });
        let next = if bar.is_some() { Duration::ZERO } else { FIRST_LINE };
        let lines = Mutex::new(Lines { done: 0, next });
        Progress { total, what, begun: Instant::now(), bar, lines }
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
            let done = lines.done as u64;
            in_turn(Box::new(move || bar.set_position(done)));
        } else {
            lines.next = elapsed + LINE_INTERVAL;
            let rate = lines.done as f64 / elapsed.as_secs_f64();
            let left = (self.total - lines.done) as f64 / rate;
            let (done, total, what) = (lines.done, self.total, self.what);
            let decimals = if rate < 10.0 { 2 } else { 0 };
            notify(&format!("{done}/{total} {what}, {rate:.decimals$} a second, {left:.0} s left"));
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
