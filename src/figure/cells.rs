//! The cells of a map along one of its axes.

use super::scale::{Scale, Spacing};

/// The cells along one axis: their places in the results, from the smallest value to the largest.
pub struct Cells {
    order: Vec<usize>,
    /// Where each cell but the last ends, as a share of the axis.
    ends: Vec<f64>,
    /// The axis, with half a cell beyond its first and last value.
    pub scale: Scale,
}

impl Cells {
    /// Cells around `values`, each as far as half way to its neighbours.
    pub fn around(values: &[f64]) -> Cells {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        let sorted: Vec<f64> = order.iter().map(|index| values[*index]).collect();
        let inner = Scale::of_axis(&sorted);
        let scale = match sorted.as_slice() {
            [first, second, .., before, last] => outer(inner, *first, *second, *before, *last),
            [first, last] => outer(inner, *first, *last, *first, *last),
            [first, second, last] => outer(inner, *first, *second, *second, *last),
            _ => inner,
        };
        let middle = |pair: &[f64]| (scale.share(pair[0]) + scale.share(pair[1])) / 2.0;
        Cells { order, ends: sorted.windows(2).map(middle).collect(), scale }
    }

    /// How many cells there are.
    pub fn count(&self) -> usize {
        self.order.len()
    }

    /// The place in the results of cell number `cell`.
    pub fn place(&self, cell: usize) -> usize {
        self.order[cell]
    }

    /// Where cell number `cell` begins and ends, as shares of the axis.
    pub fn range(&self, cell: usize) -> [f64; 2] {
        let begins = cell.checked_sub(1).map_or(0.0, |before| self.ends[before]);
        [begins, self.ends.get(cell).copied().unwrap_or(1.0)]
    }

    /// The place in the results of the cell at `share` of the axis.
    pub fn at(&self, share: f64) -> usize {
        self.order[self.ends.partition_point(|end| *end < share)]
    }
}

/// `inner` and half a cell more at both ends.
fn outer(inner: Scale, first: f64, second: f64, before: f64, last: f64) -> Scale {
    if inner.low == inner.high || first == last {
        return inner;
    }
    match inner.spacing {
        Spacing::Linear => Scale {
            low: first - (second - first) / 2.0,
            high: last + (last - before) / 2.0,
            ..inner
        },
        Spacing::Log => Scale {
            low: first / (second / first).sqrt(),
            high: last * (last / before).sqrt(),
            ..inner
        },
    }
}
