//! How much is left of a run whose cases take unequal time.

/// What has been done of a run, and what that says of the rest.
///
/// Assumptions: time goes with the drive cycles that cases are followed, and the blocks that are done are a
/// fair sample of all, which [`super::spread`] sees to. Cases that are done are no such sample, as the slow
/// ones are still under way; so the mean is that of whole blocks.
#[derive(Debug, Clone, Default)]
pub struct Forecast {
    /// Cases of the whole run.
    cases: usize,
    /// Cycles per case of each block that is done, with its number of cases.
    blocks: Vec<(f64, usize)>,
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
        Forecast { cases, blocks: Vec::new() }
    }

    /// Takes note of a block that is done.
    pub fn add(&mut self, cases: usize, cycles: u64) {
        self.blocks.push((cycles as f64 / cases as f64, cases));
    }

    /// Cycles of the whole run; none before the first block is done.
    ///
    /// Method: mean and standard error of a sample of blocks out of a finite number of them.
    pub fn cycles(&self) -> Option<Estimate> {
        let done: usize = self.blocks.iter().map(|(_, cases)| cases).sum();
        if done == 0 {
            return None;
        }
        let weight = |cases: usize| cases as f64 / done as f64;
        let mean: f64 = self.blocks.iter().map(|(mean, cases)| mean * weight(*cases)).sum();
        let squares = self.blocks.iter().map(|(it, cases)| {
            let off = (it - mean) * weight(*cases);
            off * off
        });
        let count = self.blocks.len() as f64;
        let unseen = (1.0 - done as f64 / self.cases as f64).max(0.0);
        let error = (squares.sum::<f64>() * count / (count - 1.0) * unseen).sqrt();
        let whole = self.cases as f64;
        // A single block says nothing of how blocks differ, unless it is all there is.
        let error = if unseen == 0.0 { 0.0 } else { error };
        Some(Estimate { value: mean * whole, error: error * whole })
    }

    /// Seconds left when so many cycles have been done, each of which takes `pace` seconds; none before the
    /// first block is done.
    pub fn seconds_left(&self, cycles: u64, pace: f64) -> Option<Estimate> {
        let Estimate { value, error } = self.cycles()?;
        let left = (value - cycles as f64).max(0.0);
        Some(Estimate { value: pace * left, error: pace * error })
    }
}

#[cfg(test)]
mod tests {
    use super::super::spread;
    use super::*;

    #[test]
    fn equal_blocks_are_foretold_exactly() {
        let mut forecast = Forecast::new(1000);
        assert_eq!(forecast.cycles(), None);
        forecast.add(100, 5000);
        let first = forecast.cycles().expect("an estimate");
        assert!(first.value == 50_000.0 && first.error.is_nan());
        forecast.add(100, 5000);
        assert_eq!(forecast.cycles(), Some(Estimate { value: 50_000.0, error: 0.0 }));
        assert_eq!(
            forecast.seconds_left(10_000, 0.002),
            Some(Estimate { value: 80.0, error: 0.0 })
        );
    }

    #[test]
    fn the_truth_is_within_three_errors_for_blocks_that_get_ever_slower() {
        let costs: Vec<u64> = (0..200).map(|block| 1000 + block * block * block / 100).collect();
        let truth: u64 = costs.iter().sum();
        let mut forecast = Forecast::new(200 * 512);
        for (done, block) in spread(costs.len()).into_iter().enumerate() {
            forecast.add(512, costs[block]);
            let Estimate { value, error } = forecast.cycles().expect("an estimate");
            assert!(done < 9 || (value - truth as f64).abs() <= 3.0 * error + 1.0, "{done}");
        }
        let end = forecast.cycles().expect("an estimate");
        assert!((end.value - truth as f64).abs() < 1e-3 && end.error == 0.0);
    }
}
