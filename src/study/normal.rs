//! A normal distribution, cut at two ends: its probabilities and its quantiles.

use std::f64::consts::FRAC_1_SQRT_2;

/// Halvings of a range after which no number lies within it.
const HALVINGS: usize = 1100;

/// A normal distribution (SI).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normal {
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation, above zero.
    pub deviation: f64,
}

impl Normal {
    /// So many deviations from the mean a range ends where none is given: two in a thousand million draws would lie beyond.
    pub const FAR: f64 = 6.0;

    /// The probability of a value between two, the lower first.
    ///
    /// Method: the complementary error function of the `libm` crate, the same on every machine, on the side of the mean on which
    /// no digits are lost.
    pub fn probability(&self, low: f64, high: f64) -> f64 {
        let [low, high] = [low, high].map(|it| self.standardised(it));
        if low > 0.0 { below(-low) - below(-high) } else { below(high) - below(low) }
    }

    /// The value below which this share of the distribution between `low` and `high` lies; the share is from 0 to 1.
    ///
    /// Method: the range is halved until no number is between its ends.
    /// Guarantees: the same on every machine; rising with the share.
    /// Breaks: in a range of which the distribution holds less than some 1e-300.
    pub fn quantile(&self, low: f64, high: f64, share: f64) -> f64 {
        // Probabilities near one lose the digits that those near zero keep.
        if low > self.mean {
            let mirrored = Normal { mean: -self.mean, ..*self };
            return -mirrored.quantile(-high, -low, 1.0 - share);
        }
        let [from, to] = [low, high].map(|it| below(self.standardised(it)));
        let wanted = from + (to - from) * share;
        let (mut low, mut high) = (low, high);
        for _ in 0..HALVINGS {
            let middle = 0.5 * low + 0.5 * high;
            if middle <= low || middle >= high {
                break;
            }
            match below(self.standardised(middle)) <= wanted {
                true => low = middle,
                false => high = middle,
            }
        }
        low
    }

    /// The probabilities of the cells of some values, each of which reaches halfway to its neighbours, and at the ends as far beyond;
    /// and what they are together. The values are two or more, all different, in any order.
    pub fn cells(&self, values: &[f64]) -> (Vec<f64>, f64) {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        let rising: Vec<f64> = order.iter().map(|at| values[*at]).collect();
        let last = rising.len() - 1;
        let edge = |at: usize| match at {
            0 => 1.5 * rising[0] - 0.5 * rising[1],
            at if at > last => 1.5 * rising[last] - 0.5 * rising[last - 1],
            at => 0.5 * (rising[at - 1] + rising[at]),
        };
        let mut cells = vec![0.0; values.len()];
        for (at, place) in order.into_iter().enumerate() {
            cells[place] = self.probability(edge(at), edge(at + 1));
        }
        (cells, self.probability(edge(0), edge(last + 1)))
    }

    /// How many deviations a value is from the mean.
    fn standardised(&self, value: f64) -> f64 {
        (value - self.mean) / self.deviation
    }
}

/// The probability of less than so many deviations.
fn below(deviations: f64) -> f64 {
    0.5 * libm::erfc(-deviations * FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STANDARD: Normal = Normal { mean: 0.0, deviation: 1.0 };

    #[test]
    fn probabilities_and_quantiles_are_those_of_the_tables() {
        for (share, deviations) in [
            (0.5, 0.0),
            (0.841_344_746_068_542_9, 1.0),
            (0.975, 1.959_963_984_540_054),
            (0.999, 3.090_232_306_167_813_5),
            (1e-10, -6.361_340_902_404_056),
        ] {
            let found = STANDARD.quantile(f64::MIN, f64::MAX, share);
            assert!((found - deviations).abs() < 1e-12, "{share}: {found}");
            let back = STANDARD.probability(-60.0, deviations);
            assert!((back / share - 1.0).abs() < 1e-14, "{share}: {back}");
        }
        // Far above the mean, where the probability below is one to rounding.
        let tail = STANDARD.probability(10.0, 11.0);
        assert!((tail / 7.619_853_024_160_47e-24 - 1.0).abs() < 1e-2, "{tail:e}");
        assert_eq!(tail, STANDARD.probability(-11.0, -10.0));
    }

    #[test]
    fn quantiles_of_a_cut_range_have_the_probabilities_that_they_are_asked_for() {
        let normal = Normal { mean: 3.0, deviation: 0.5 };
        for [low, high] in [[2.0, 3.2], [1.0, 1.5], [4.0, 9.0], [-5.0, 12.0]] {
            let all = normal.probability(low, high);
            for share in [0.0, 0.1, 0.5, 0.9] {
                let value = normal.quantile(low, high, share);
                assert!((low..=high).contains(&value), "{value}");
                let within = normal.probability(low, value) / all;
                assert!((within - share).abs() < 1e-12, "{low} {high} {share}: {within}");
            }
        }
    }

    #[test]
    fn the_cells_of_an_axis_share_what_it_holds() {
        let normal = Normal { mean: 0.2, deviation: 0.7 };
        let values = [2.0, -1.0, 0.5, 0.0, 1.1];
        let (cells, all) = normal.cells(&values);
        assert!((cells.iter().sum::<f64>() - all).abs() < 1e-14);
        assert!((all - normal.probability(-1.5, 2.45)).abs() < 1e-15);
        assert!((cells[2] - normal.probability(0.25, 0.8)).abs() < 1e-15);
    }
}
