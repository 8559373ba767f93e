//! For how many cycles the starts of each attractor are followed until it is decided: quantiles, and shares within so many cycles.

use std::collections::BTreeMap;

/// The quantiles that are told beside the mean and the most: the median, and what 90 and 99 of 100 starts need.
pub const QUANTILES: [f64; 3] = [0.5, 0.9, 0.99];

/// For how many cycles the starts of an attractor are followed until it is decided, measuring included where they are
/// followed to the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settling {
    /// Their mean.
    pub mean: f64,
    /// The least number of cycles within which these shares of its starts are decided, see [`QUANTILES`].
    pub quantiles: [u64; QUANTILES.len()],
    /// The most.
    pub most: u64,
}

/// How many starts have settled on each attractor after so many cycles.
///
/// Numbers of starts are held by cycles, of which there are few, and none for each start.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SettlingTimes {
    /// Starts of each attractor by the cycles for which they were followed.
    by_cycles: Vec<BTreeMap<u64, usize>>,
    /// Starts that have been followed and lead to no known attractor.
    unsettled: usize,
}

/// The shares of all starts that have settled on each attractor within so many cycles.
#[derive(Debug, Clone, PartialEq)]
pub struct SettledWithin {
    /// The cycles.
    pub cycles: u64,
    /// The share by the number of the attractor, among all starts that have been followed.
    pub shares: Vec<f64>,
}

impl SettlingTimes {
    /// Those of the starts of so many attractors: the attractor of each, and for how many cycles it was followed.
    pub fn of(
        attractors: usize,
        starts: impl IntoIterator<Item = (Option<u32>, u64)>,
    ) -> SettlingTimes {
        let mut times =
            SettlingTimes { by_cycles: vec![BTreeMap::new(); attractors], unsettled: 0 };
        for (attractor, cycles) in starts {
            match attractor.and_then(|number| times.by_cycles.get_mut(number as usize)) {
                Some(counts) => *counts.entry(cycles).or_default() += 1,
                None => times.unsettled += 1,
            }
        }
        times
    }

    /// How many attractors there are.
    pub fn attractors(&self) -> usize {
        self.by_cycles.len()
    }

    /// Starts that have been followed and lead to no known attractor: they never count as settled.
    pub fn unsettled(&self) -> usize {
        self.unsettled
    }

    /// All starts that have been followed.
    pub fn followed(&self) -> usize {
        self.by_cycles.iter().flat_map(BTreeMap::values).sum::<usize>() + self.unsettled
    }

    /// What the starts of an attractor need; none where no start leads to it.
    pub fn settling(&self, number: usize) -> Option<Settling> {
        let counts = &self.by_cycles[number];
        let starts: usize = counts.values().sum();
        let (most, _) = counts.last_key_value()?;
        let all: u64 = counts.iter().map(|(cycles, starts)| cycles * *starts as u64).sum();
        let mean = all as f64 / starts as f64;
        let quantiles = QUANTILES.map(|share| self.quantile(number, share).unwrap_or(*most));
        Some(Settling { mean, quantiles, most: *most })
    }

    /// The least number of cycles within which at least this share of the starts of an attractor have settled; none where no start
    /// leads to it.
    pub fn quantile(&self, number: usize, share: f64) -> Option<u64> {
        let counts = &self.by_cycles[number];
        let starts: usize = counts.values().sum();
        let mut settled = 0;
        let mut reached = counts.iter().filter(|(_, count)| {
            settled += **count;
            settled as f64 >= share * starts as f64
        });
        reached.next().map(|(cycles, _)| *cycles)
    }

    /// What has settled within so many cycles.
    pub fn within(&self, cycles: u64) -> SettledWithin {
        let all = self.followed() as f64;
        let shares = self.by_cycles.iter().map(|counts| {
            let settled: usize = counts.range(..=cycles).map(|(_, starts)| starts).sum();
            settled as f64 / all
        });
        SettledWithin { cycles, shares: shares.collect() }
    }

    /// What has settled within 1, 2, 3, 5, 7, 10, 20, ... cycles, until all have that do; empty where none does.
    pub fn curve(&self) -> Vec<SettledWithin> {
        let most = self.by_cycles.iter().filter_map(|it| it.last_key_value()).map(|it| *it.0).max();
        let Some(most) = most else { return Vec::new() };
        let decades = (0..).map(|power| 10_u64.saturating_pow(power));
        let all = decades.flat_map(|ten| [1, 2, 3, 5, 7].map(|it| ten.saturating_mul(it)));
        let below = all.take_while(|cycles| *cycles < most);
        below.chain([most]).map(|cycles| self.within(cycles)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_and_shares_are_those_of_a_sorted_list() {
        let mut random = fastrand::Rng::with_seed(9);
        for _ in 0..50 {
            let count = 1 + random.usize(..400);
            let starts: Vec<(Option<u32>, u64)> = (0..count)
                .map(|_| (random.bool().then(|| random.u32(..3)), random.u64(1..60)))
                .collect();
            let times = SettlingTimes::of(3, starts.iter().copied());
            assert_eq!(times.followed(), count);
            for number in 0..3 {
                let own = starts.iter().filter(|it| it.0 == Some(number as u32));
                let mut cycles: Vec<u64> = own.map(|it| it.1).collect();
                cycles.sort_unstable();
                let Some(settling) = times.settling(number) else {
                    assert!(cycles.is_empty());
                    continue;
                };
                for (share, found) in QUANTILES.iter().zip(settling.quantiles) {
                    // The inverse of the empirical distribution.
                    let place = (share * cycles.len() as f64).ceil() as usize;
                    assert_eq!(found, cycles[place.max(1) - 1]);
                }
                assert_eq!(settling.most, cycles[cycles.len() - 1]);
                let mean = cycles.iter().sum::<u64>() as f64 / cycles.len() as f64;
                assert!((settling.mean - mean).abs() < 1e-12);
                for at in times.curve() {
                    let within = cycles.iter().filter(|it| **it <= at.cycles).count();
                    assert_eq!(at.shares[number], within as f64 / count as f64);
                }
            }
            let known = starts.iter().filter(|it| it.0.is_some()).count();
            assert_eq!(times.unsettled(), count - known);
            if let Some(last) = times.curve().last() {
                assert!(
                    (last.shares.iter().sum::<f64>() - known as f64 / count as f64).abs() < 1e-12
                );
            }
        }
    }
}
