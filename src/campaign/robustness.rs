//! What tolerances of the parameters leave of a motion: the speed that few draws fall below, and how many keep the motion.

use crate::capsule::Parameter;

/// The share of draws that are slower than the speed told.
pub const SLOWER: f64 = 0.05;

/// By how much parameters may be off, and how many sets of them are drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerances {
    /// The greatest relative deviation of each parameter named, between 0 and 1; every one within it is as likely.
    pub each: Vec<(Parameter, f64)>,
    /// How many sets are drawn.
    pub draws: usize,
    /// The number by which they are drawn.
    pub seed: u64,
}

/// What tolerances leave of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robustness {
    /// How many sets of parameters were drawn.
    pub draws: usize,
    /// The share of them whose motion, started on the orbit, settles to the same period.
    pub kept: f64,
    /// The speed that 5 % of the draws fall below [m/s]; negative against the direction asked for, and minus infinity where more of
    /// them have none.
    pub speed: f64,
    /// The price that 5 % of the draws exceed (SI); infinite where more of them have none.
    pub price: f64,
}

impl Tolerances {
    /// The factors of the parameters named in each draw, the same for every motion; fewer draws are the first of more.
    pub fn factors(&self) -> Vec<Vec<(Parameter, f64)>> {
        let mut random = fastrand::Rng::with_seed(self.seed);
        let mut one = |(parameter, most): &(Parameter, f64)| {
            (*parameter, 1.0 + most * (2.0 * random.f64() - 1.0))
        };
        (0..self.draws).map(|_| self.each.iter().map(&mut one).collect()).collect()
    }
}

impl Robustness {
    /// From the speeds in the direction asked for and the prices of all draws, of those that have none not a number, and the number
    /// that keep the motion.
    ///
    /// # Method
    ///
    /// The quantiles are order statistics: of n draws the one of rank n/20 rounded up, the least counted as 1, so that no draw
    /// is interpolated.
    pub fn of(speeds: &[f64], prices: &[f64], kept: usize) -> Robustness {
        let draws = speeds.len();
        let rank = ((SLOWER * draws as f64).ceil() as usize).clamp(1, draws.max(1)) - 1;
        let lowest = |values: Vec<f64>| {
            let mut values = values;
            values.sort_by(f64::total_cmp);
            values.get(rank).copied().unwrap_or(f64::NAN)
        };
        let or_worst = |value: &f64| if value.is_nan() { f64::NEG_INFINITY } else { *value };
        Robustness {
            draws,
            kept: kept as f64 / draws as f64,
            speed: lowest(speeds.iter().map(or_worst).collect()),
            price: -lowest(prices.iter().map(|price| or_worst(&-price)).collect()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_draws_and_those_without_a_value_are_the_worst() {
        let speeds: Vec<f64> = (1..=100).rev().map(f64::from).collect();
        let found = Robustness::of(&speeds, &speeds, 90);
        assert_eq!((found.speed, found.price, found.kept), (5.0, 96.0, 0.9));
        let mut with_failures = speeds.clone();
        with_failures[..5].fill(f64::NAN);
        let found = Robustness::of(&with_failures, &with_failures, 0);
        assert_eq!((found.speed, found.price), (f64::NEG_INFINITY, f64::INFINITY));
        assert_eq!(Robustness::of(&[2.0], &[3.0], 1).speed, 2.0);
    }

    #[test]
    fn draws_fill_the_tolerance_and_do_not_depend_on_their_number() {
        let each = vec![(Parameter::K2, 0.1), (Parameter::MuS, 0.02)];
        let tolerances = Tolerances { each, draws: 500, seed: 3 };
        let fewer = Tolerances { draws: 10, ..tolerances.clone() };
        let all = tolerances.factors();
        assert_eq!(all[..10], fewer.factors());
        let of_k2: Vec<f64> = all.iter().map(|draw| draw[0].1).collect();
        let mean = of_k2.iter().sum::<f64>() / 500.0;
        let variance = of_k2.iter().map(|it| (it - mean).powi(2)).sum::<f64>() / 499.0;
        assert!(of_k2.iter().all(|it| (0.9..=1.1).contains(it)));
        // Of numbers that are equally likely within 1 -+ t, the mean is 1 and the variance t^2/3.
        assert!(
            (mean - 1.0).abs() < 0.01 && (variance * 300.0 - 1.0).abs() < 0.15,
            "{mean} {variance}"
        );
    }
}
