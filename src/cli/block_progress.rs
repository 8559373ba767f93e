//! Progress of a run of blocks: a bar on a terminal, a line per block in a log.

use std::collections::VecDeque;
use std::io::IsTerminal;
use std::sync::{Mutex, MutexGuard};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::progress::{NOT_KNOWN, tells_the_rest};
use super::readable::{count, counted, estimated, rate};
use super::terminal::{in_turn, notify};
use crate::run::{Forecast, Record};
use crate::store::Summary;

/// "Now" is the time since as long ago.
const NOW: Duration = Duration::from_secs(20);
/// So few cases may all be in the lanes at a time.
const FEW: usize = 128;
/// A time left shorter than this is not shown [s].
const LAST: f64 = 1.0;
/// The bar is brought up to date this often.
const TICK: Duration = Duration::from_millis(200);

/// Shows how many blocks and cases are done, how fast, and how long the rest will take.
pub struct BlockProgress {
    /// Blocks and cases of the run, those that were there before included.
    total: [usize; 2],
    begun: Instant,
    bar: Option<ProgressBar>,
    state: Mutex<State>,
}

struct State {
    /// Blocks that are done.
    blocks: usize,
    forecast: Forecast,
    /// Cases and cycles that were done before the run.
    before: (usize, u64),
    /// When how many cases were done, the latest last.
    recent: VecDeque<(Instant, usize)>,
}

impl BlockProgress {
    /// Begins to watch a run of so many blocks and cases, of which those `kept` were there before.
    pub fn new(total: [usize; 2], kept: &[Summary]) -> Self {
        let mut forecast = Forecast::new(total[1]);
        kept.iter().for_each(|it| forecast.complete(it.number, it.cases, it.cycles));
        let (begun, before) = (Instant::now(), forecast.done());
        let recent = VecDeque::from([(begun, before.0)]);
        let state = State { blocks: kept.len(), forecast, before, recent };
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("{wide_bar} {msg}");
            let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::new(total[1] as u64).with_style(style)
        });
        BlockProgress { total, begun, bar, state: Mutex::new(state) }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Notes that a case of block `number`, which has so many, is done.
    pub fn case(&self, number: usize, cases: usize, record: &Record) {
        let mut state = self.state();
        state.forecast.add(number, cases, 1, record.orbit.cycles);
        let done = state.forecast.done().0;
        let last = state.recent.back().map_or(self.begun, |(at, _)| *at);
        if last.elapsed() < TICK {
            return;
        }
        state.recent.push_back((Instant::now(), done));
        while state.recent.len() > 2 && state.recent[1].0.elapsed() > NOW {
            state.recent.pop_front();
        }
        let line = self.line(&state);
        drop(state);
        if let Some(bar) = self.bar.clone() {
            in_turn(Box::new(move || {
                bar.set_position(done as u64);
                bar.set_message(line);
            }));
        }
    }

    /// Notes that a block is on disk.
    pub fn block(&self, block: &Summary) {
        let mut state = self.state();
        state.blocks += 1;
        state.forecast.complete(block.number, block.cases, block.cycles);
        let line = self.line(&state);
        drop(state);
        if self.bar.is_none() {
            let cases = counted(block.cases, "case");
            let cycles = counted(block.cycles as usize, "cycle");
            notify(&format!("block {}: {cases}, {cycles}; {line}", block.number));
        }
    }

    /// Notes that another process has kept a block, which says nothing of the pace of this one.
    pub fn kept_elsewhere(&self, block: &Summary) {
        let mut state = self.state();
        let done = state.forecast.done();
        state.forecast.complete(block.number, block.cases, block.cycles);
        let now = state.forecast.done();
        let more = now.0 - done.0;
        state.blocks += 1;
        state.before = (state.before.0 + more, state.before.1 + (now.1 - done.1));
        state.recent.iter_mut().for_each(|(_, cases)| *cases += more);
    }

    /// How far the run is, in a line.
    fn line(&self, state: &State) -> String {
        let (done, cycles) = state.forecast.done();
        let seconds = self.begun.elapsed().as_secs_f64();
        let average = (done - state.before.0) as f64 / seconds;
        let (then, before) = state.recent.front().copied().unwrap_or((self.begun, 0));
        let now = (done - before) as f64 / then.elapsed().as_secs_f64();
        let pace = seconds / (cycles - state.before.1) as f64;
        let known = tells_the_rest(
            self.begun.elapsed(),
            done - state.before.0,
            self.total[1] - state.before.0,
        );
        let left = state.forecast.seconds_left(pace).filter(|it| known && it.value.is_finite());
        // Blocks that were damaged after they had been kept count twice.
        let cases_left = self.total[1].saturating_sub(done);
        let left = match left {
            None => NOT_KNOWN.to_owned(),
            Some(left) if left.value < LAST && (1..=FEW).contains(&cases_left) => {
                format!("the last {} are computed", counted(cases_left, "case"))
            }
            Some(left) => format!("{} left", estimated(left)),
        };
        let blocks = format!("{}/{}", count(state.blocks), count(self.total[0]));
        let cases = format!("{}/{}", count(done), count(self.total[1]));
        let [now, average] = [now, average].map(rate);
        format!(
            "{blocks} blocks kept, {cases} cases computed, {now}/s now, {average}/s on average, {left}"
        )
    }

    /// Blocks that are done.
    pub fn blocks_done(&self) -> usize {
        self.state().blocks
    }

    /// Ends the watch; returns the time it took.
    pub fn finish(&self) -> Duration {
        if let Some(bar) = self.bar.clone() {
            in_turn(Box::new(move || bar.finish_and_clear()));
        }
        self.begun.elapsed()
    }
}
