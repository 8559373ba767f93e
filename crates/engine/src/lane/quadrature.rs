//! Integrals of products of series over a step.

use super::{Lane, Series};

/// Nodes of the rule.
pub const NODES: usize = 12;

/// Nodes on [0, 1] and weights of the Gauss-Legendre rule with twelve points.
const RULE: [(f64, f64); NODES] = {
    // The upper half for [-1, 1], from Abramowitz and Stegun, table 25.4.
    let table = [
        (0.981_560_634_246_719_2, 0.047_175_336_386_511_83),
        (0.904_117_256_370_474_9, 0.106_939_325_995_318_43),
        (0.769_902_674_194_304_7, 0.160_078_328_543_346_23),
        (0.587_317_954_286_617_4, 0.203_167_426_723_065_92),
        (0.367_831_498_998_180_2, 0.233_492_536_538_354_8),
        (0.125_233_408_511_468_9, 0.249_147_045_813_402_8),
    ];
    let mut rule = [(0.0, 0.0); NODES];
    let mut i = 0;
    while i < table.len() {
        let (node, weight) = (0.5 * (1.0 - table[i].0), 0.5 * table[i].1);
        rule[i] = (node, weight);
        rule[NODES - 1 - i] = (1.0 - node, weight);
        i += 1;
    }
    rule
};

/// Values at the nodes of a step.
pub type Values<L> = [L; NODES];

/// The values of a series at the nodes on [0, h].
#[inline(always)]
pub fn values<L: Lane>(series: &Series<L>, h: L) -> Values<L> {
    // A loop: what the functions of the standard library for arrays call is not compiled for the instructions of a lane.
    let mut times = [h; NODES];
    for (time, (node, _)) in times.iter_mut().zip(&RULE) {
        *time = L::splat(*node) * h;
    }
    let mut sums = const { [L::ZERO; NODES] };
    for &term in series.iter().rev() {
        for (sum, time) in sums.iter_mut().zip(&times) {
            *sum = *sum * *time + term;
        }
    }
    sums
}

/// The integral over [0, h] of the product of two series, from their values at the nodes.
///
/// Method: Gauss-Legendre, exact to degree 23. Where the terms of both series shrink steadily, so that
/// those of degree 16 are below the tolerance of the step, the terms of the product beyond 23 are below the
/// tolerance to the power 3/2.
#[inline(always)]
pub fn integral_of_product<L: Lane>(a: &Values<L>, b: &Values<L>, h: L) -> L {
    let mut sum = L::splat(0.0);
    for ((&(_, weight), a), b) in RULE.iter().zip(a).zip(b) {
        sum = sum + L::splat(weight) * (*a * *b);
    }
    sum * h
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lane::series;

    #[test]
    fn products_up_to_degree_23_are_exact() {
        let h = 0.7_f64;
        let power = |k: usize| {
            let mut series = series::zero::<f64>();
            series[k] = 1.0;
            values(&series, h)
        };
        for k in 0..=23 {
            let (a, b) = (k / 2, k - k / 2);
            let exact = h.powi(k as i32 + 1) / (k + 1) as f64;
            let error = integral_of_product(&power(a), &power(b), h) / exact - 1.0;
            assert!(error.abs() < 1e-15, "degree {k}: {error:e}");
        }
    }
}
