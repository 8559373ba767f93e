//! Progress of a run of blocks: a bar on a terminal, a line per block in a log.

use std::collections::VecDeque;
use std::io::IsTerminal;
use std::sync::{Mutex, MutexGuard};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::tell;
use super::words::{count, counted, estimated, rate};
use crate::store::Summary;
use crate::sweep::{Forecast, Record};

/// "Now" is the time since as long ago.
const NOW: Duration = Duration::from_secs(20);
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
    /// Blocks and cases that are done.
    done: [usize; 2],
    /// Cycles of the cases that are done.
    cycles: u64,
    /// Cases and cycles that were there before.
    before: (usize, u64),
    forecast: Forecast,
    /// When how many cases were done, the latest last.
    recent: VecDeque<(Instant, usize)>,
}

impl BlockProgress {
    /// Begins to watch a run of so many blocks and cases, of which those `kept` were there before.
    pub fn new(total: [usize; 2], kept: &[Summary]) -> Self {
        let mut forecast = Forecast::new(total[1]);
        kept.iter().for_each(|block| forecast.add(block.cases, block.cycles));
        let before = (
            kept.iter().map(|block| block.cases).sum(),
            kept.iter().map(|block| block.cycles).sum(),
        );
        let begun = Instant::now();
        let state = State {
            done: [kept.len(), before.0],
            cycles: before.1,
            before,
            forecast,
            recent: VecDeque::from([(begun, before.0)]),
        };
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

    /// Notes that a case is done.
    pub fn case(&self, record: &Record) {
        let mut state = self.state();
        state.done[1] += 1;
        state.cycles += record.orbit.cycles;
        let last = state.recent.back().map_or(self.begun, |(at, _)| *at);
        if last.elapsed() >= TICK {
            let entry = (Instant::now(), state.done[1]);
            state.recent.push_back(entry);
            while state.recent.len() > 2 && state.recent[1].0.elapsed() > NOW {
                state.recent.pop_front();
            }
            if let Some(bar) = &self.bar {
                bar.set_position(state.done[1] as u64);
                bar.set_message(self.words(&state));
            }
        }
    }

    /// Notes that a block is on disk.
    pub fn block(&self, block: &Summary) {
        let mut state = self.state();
        state.done[0] += 1;
        state.forecast.add(block.cases, block.cycles);
        if self.bar.is_none() {
            let cases = counted(block.cases, "case");
            let cycles = counted(block.cycles as usize, "cycle");
            let words = self.words(&state);
            tell(&format!("block {}: {cases}, {cycles}; {words}", block.number));
        }
    }

    /// How far the run is, in a line.
    fn words(&self, state: &State) -> String {
        let share = |i: usize| format!("{}/{}", count(state.done[i]), count(self.total[i]));
        let seconds = self.begun.elapsed().as_secs_f64();
        let average = (state.done[1] - state.before.0) as f64 / seconds;
        let (then, before) = state.recent.front().copied().unwrap_or((self.begun, 0));
        let now = (state.done[1] - before) as f64 / then.elapsed().as_secs_f64();
        let pace = seconds / (state.cycles - state.before.1) as f64;
        let left = state.forecast.seconds_left(state.cycles, pace);
        let left = left.filter(|left| left.value.is_finite());
        let left = left.map_or("time left not known yet".to_owned(), |left| {
            format!("{} left", estimated(left))
        });
        let [blocks, cases] = [0, 1].map(share);
        let [now, average] = [now, average].map(rate);
        format!("{blocks} blocks, {cases} cases, {now}/s now, {average}/s on average, {left}")
    }

    /// Blocks that are done.
    pub fn blocks_done(&self) -> usize {
        self.state().done[0]
    }

    /// Ends the watch; returns the time it took.
    pub fn finish(&self) -> Duration {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
        self.begun.elapsed()
    }
}
