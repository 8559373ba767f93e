//! How much is left of a run whose cases take unequal time.

use std::collections::BTreeMap;

/// Fewer blocks tell nothing of how much they differ.
const SAMPLE: usize = 8;

/// What has been done of a run, and what that says of the rest.
///
/// Assumptions: time goes with the drive cycles that cases are followed, and the blocks that have been begun
/// are a fair sample of all, which [`crate::study::spread`] sees to. Those that are done already are none, as the
/// quick ones end first; so a block that is under way counts with what it will take if it goes on as it has
/// begun. It breaks where a few cases take most of the time, as nothing is known of them until they are done,
/// and where the first cases of a line that is followed are unlike the last.
#[derive(Debug, Clone, Default)]
pub struct Forecast {
    /// Cases of the whole run.
    cases: usize,
    /// The blocks that have been begun, by number.
    blocks: BTreeMap<usize, Begun>,
    /// Cases and cycles that are done.
    done: (usize, u64),
}

/// A block that has been begun: its cases, those that are done, and their cycles.
#[derive(Debug, Clone, Copy)]
struct Begun {
    cases: usize,
    done: usize,
    cycles: u64,
}

impl Begun {
    /// Cycles of a case on average.
    fn mean(&self) -> f64 {
        self.cycles as f64 / self.done.max(1) as f64
    }

    /// Its part of so many cases.
    fn weight(&self, cases: usize) -> f64 {
        self.cases as f64 / cases as f64
    }
}

/// A number with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard error; NaN where nothing is known of it.
    pub error: f64,
}

impl Forecast {
    /// The forecast of a run of so many cases, of which nothing is known.
    pub fn new(cases: usize) -> Self {
        Forecast { cases, ..Forecast::default() }
    }

    /// Takes note that `done` more of the `cases` of block `number` are done, in so many cycles.
    pub fn add(&mut self, number: usize, cases: usize, done: usize, cycles: u64) {
        let nothing = Begun { cases, done: 0, cycles: 0 };
        let block = self.blocks.entry(number).or_insert(nothing);
        block.done += done;
        block.cycles += cycles;
        self.done = (self.done.0 + done, self.done.1 + cycles);
    }

    /// Takes note that all of the `cases` of block `number` are done, in so many cycles together.
    pub fn complete(&mut self, number: usize, cases: usize, cycles: u64) {
        let nothing = Begun { cases, done: 0, cycles: 0 };
        let block = self.blocks.entry(number).or_insert(nothing);
        let rest = (cases - block.done, cycles - block.cycles);
        (block.done, block.cycles) = (cases, cycles);
        self.done = (self.done.0 + rest.0, self.done.1 + rest.1);
    }

    /// Cases that are done, and their cycles.
    pub fn done(&self) -> (usize, u64) {
        self.done
    }

    /// Cycles of the whole run; none before the first case is done.
    ///
    /// Method: mean and standard error of a sample of blocks out of a finite number of them, each with what
    /// its cases take on average.
    pub fn cycles(&self) -> Option<Estimate> {
        let begun: usize = self.blocks.values().map(|block| block.cases).sum();
        if begun == 0 {
            return None;
        }
        let all: f64 = self.blocks.values().map(|it| it.mean() * it.weight(begun)).sum();
        let squares = self.blocks.values().map(|block| {
            let off = (block.mean() - all) * block.weight(begun);
            off * off
        });
        let count = self.blocks.len() as f64;
        let unknown = (1.0 - self.done.0 as f64 / self.cases as f64).max(0.0);
        let error = (squares.sum::<f64>() * count / (count - 1.0) * unknown).sqrt();
        let whole = self.cases as f64;
        // A few blocks say little of how blocks differ, unless they are all there is and done.
        let error = match () {
            () if unknown == 0.0 => 0.0,
            () if self.blocks.len() < SAMPLE => f64::NAN,
            () => error,
        };
        Some(Estimate { value: all * whole, error: error * whole })
    }

    /// Seconds left when a cycle takes `pace` seconds; none before the first case is done.
    ///
    /// It is never less than what as many cases have taken until now.
    pub fn seconds_left(&self, pace: f64) -> Option<Estimate> {
        let Estimate { value, error } = self.cycles()?;
        let (done, cycles) = self.done;
        let alike = cycles as f64 / done as f64 * self.cases.saturating_sub(done) as f64;
        let left = (value - cycles as f64).max(alike);
        Some(Estimate { value: pace * left, error: pace * error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::spread;

    #[test]
    fn equal_blocks_are_foretold_exactly() {
        let mut forecast = Forecast::new(1000);
        assert_eq!(forecast.cycles(), None);
        forecast.add(0, 100, 100, 5000);
        let first = forecast.cycles().expect("an estimate");
        assert!(first.value == 50_000.0 && first.error.is_nan());
        (1..8).for_each(|block| forecast.add(block, 100, 100, 5000));
        assert_eq!(forecast.cycles(), Some(Estimate { value: 50_000.0, error: 0.0 }));
        assert_eq!(forecast.seconds_left(0.002), Some(Estimate { value: 20.0, error: 0.0 }));
        assert_eq!(forecast.done(), (800, 40_000));
    }

    #[test]
    fn the_truth_is_within_three_errors_for_blocks_that_get_ever_slower() {
        let costs: Vec<u64> = (0..200).map(|block| 1000 + block * block * block / 100).collect();
        let truth: u64 = costs.iter().sum();
        let mut forecast = Forecast::new(200 * 512);
        for (done, block) in spread(costs.len()).into_iter().enumerate() {
            forecast.add(block, 512, 512, costs[block]);
            let Estimate { value, error } = forecast.cycles().expect("an estimate");
            assert!(done < 9 || (value - truth as f64).abs() <= 3.0 * error + 1.0, "{done}");
        }
        let end = forecast.cycles().expect("an estimate");
        assert!((end.value - truth as f64).abs() < 1e-3 && end.error == 0.0);
    }

    #[test]
    fn slow_blocks_in_progress_count_with_what_they_will_take() {
        // Forty blocks at once, each as many times slower than the first as its number; the quick are done.
        let cases = 1000;
        let cycles = |block: u64| 10 * (block + 1);
        let truth: u64 = (0..40).map(|block| cycles(block) * cases as u64).sum();
        let mut forecast = Forecast::new(40 * cases);
        let budget = 100_000;
        for block in 0..40 {
            let done = (budget / cycles(block)).min(cases as u64);
            forecast.add(block as usize, cases, done as usize, done * cycles(block));
        }
        let Estimate { value, .. } = forecast.cycles().expect("an estimate");
        assert!((value - truth as f64).abs() < 1e-6 * truth as f64, "{value} {truth}");
    }
}
