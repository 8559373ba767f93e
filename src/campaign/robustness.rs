//! What tolerances of the parameters leave of a motion: the gain that few draws fall below, and how many keep the motion.

use crate::description::Parameter;

/// The share of draws that gain less than what is told.
pub const LESS: f64 = 0.05;

/// By how much parameters may be off, and how many sets of them are drawn.
///
/// A tolerance t is the half width of an even distribution: the parameter is its value times 1 + t u, where u is drawn evenly from -1
/// to 1, independently for each parameter. The standard deviation is t over the root of 3.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerances {
    /// The greatest relative deviation of each parameter named, between 0 and 1.
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
    /// The gain that 5 % of the draws fall below (SI); negative against the direction asked for, and minus infinity where more of
    /// them have none.
    pub gain: f64,
    /// The price that 5 % of the draws exceed (SI); infinite where more of them have none.
    pub price: f64,
    /// How many draws keep the conditions that can be judged of a draw, if there are such conditions; one that is undecided or has failed
    /// keeps none.
    pub meet_conditions: Option<usize>,
    /// How many take no more than the budget, if there is one.
    pub within_budget: Option<usize>,
    /// How many do both, if both are asked for.
    pub meet_both: Option<usize>,
}

/// What a draw of a motion under tolerances gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draw {
    /// Its gain in the direction asked for (SI); not a number where it has none.
    pub gain: f64,
    /// Its price (SI); not a number where it has none.
    pub price: f64,
    /// Whether it settles to the same period.
    pub is_kept: bool,
    /// Whether it keeps the conditions, if there are any that can be judged.
    pub meets_conditions: Option<bool>,
    /// Whether it takes no more than the budget, if there is one.
    pub is_within_budget: Option<bool>,
}

impl Tolerances {
    /// The factors of the parameters named in each draw, the same for every motion; fewer draws are the first of more.
    pub fn factors(&self) -> Vec<Vec<(Parameter, f64)>> {
        let mut random = fastrand::Rng::with_seed(self.seed);
        let draws = (0..self.draws).map(|_| {
            let each = self.each.iter();
            each.map(|(it, most)| (*it, 1.0 + most * (2.0 * random.f64() - 1.0))).collect()
        });
        draws.collect()
    }
}

impl Robustness {
    /// From all draws.
    ///
    /// # Method
    ///
    /// The quantiles are order statistics: of n draws the one of rank n/20 rounded up, the least counted as 1, so that no draw
    /// is interpolated.
    pub fn of(all: &[Draw]) -> Robustness {
        let draws = all.len();
        let kept = all.iter().filter(|draw| draw.is_kept).count();
        Robustness {
            draws,
            kept: kept as f64 / draws as f64,
            gain: low_quantile(all.iter().map(|draw| draw.gain)),
            price: -low_quantile(all.iter().map(|draw| -draw.price)),
            meet_conditions: counted(all, |draw| draw.meets_conditions),
            within_budget: counted(all, |draw| draw.is_within_budget),
            meet_both: counted(all, |draw| Some(draw.meets_conditions? && draw.is_within_budget?)),
        }
    }
}

/// The value that 5 % of the draws fall below; those without a value are the lowest.
fn low_quantile(values: impl Iterator<Item = f64>) -> f64 {
    let values = values.map(|value| if value.is_nan() { f64::NEG_INFINITY } else { value });
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let draws = values.len();
    let rank = ((LESS * draws as f64).ceil() as usize).clamp(1, draws.max(1)) - 1;
    values.get(rank).copied().unwrap_or(f64::NAN)
}

/// How many draws do something; none where it was not asked of them.
fn counted(all: &[Draw], does: impl Fn(&Draw) -> Option<bool>) -> Option<usize> {
    let does: Option<Vec<bool>> = all.iter().map(does).collect();
    does.filter(|it| !it.is_empty()).map(|it| it.into_iter().filter(|does| *does).count())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_draws_and_those_without_a_value_are_the_worst() {
        let draw = |number: u32| Draw {
            gain: f64::from(number),
            price: f64::from(number),
            is_kept: number <= 90,
            meets_conditions: Some(number <= 60),
            is_within_budget: Some(number > 50),
        };
        let draws: Vec<Draw> = (1..=100).rev().map(draw).collect();
        let found = Robustness::of(&draws);
        assert_eq!((found.gain, found.price, found.kept), (5.0, 96.0, 0.9));
        let counts = [found.meet_conditions, found.within_budget, found.meet_both];
        assert_eq!(counts, [Some(60), Some(50), Some(10)]);
        let failed = |draw: &Draw| match draw.gain > 95.0 {
            true => Draw { gain: f64::NAN, price: f64::NAN, meets_conditions: None, ..*draw },
            false => Draw { meets_conditions: None, ..*draw },
        };
        let with_failures: Vec<Draw> = draws.iter().map(failed).collect();
        let found = Robustness::of(&with_failures);
        assert_eq!((found.gain, found.price), (f64::NEG_INFINITY, f64::INFINITY));
        let counts = [found.meet_conditions, found.within_budget, found.meet_both];
        assert_eq!(counts, [None, Some(50), None]);
        assert_eq!(Robustness::of(&draws[98..99]).gain, 2.0);
    }

    #[test]
    fn draws_fill_the_tolerance_and_do_not_depend_on_their_number() {
        let each = vec![
            (crate::capsule::Parameter::K2.into(), 0.1),
            (crate::capsule::Parameter::MuS.into(), 0.02),
        ];
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
