//! The cells of a map along one of its axes.

use super::scale::{Scale, finite_range};

/// An axis is uneven where the widest step is longer than the shortest by this factor.
const UNEVEN: f64 = 1.01;

/// The cells along one axis: their places in the results, from the smallest value to the largest.
pub struct Cells {
    order: Vec<usize>,
    /// Their values, from the smallest to the largest.
    sorted: Vec<f64>,
    /// Where each cell but the last ends, as a share of the axis.
    ends: Vec<f64>,
    /// The axis, from its first value to its last: beyond them nothing was computed.
    pub scale: Scale,
    /// Its values, where they are not evenly spread along it, so that the width of a cell does not tell them.
    pub uneven: Vec<f64>,
}

impl Cells {
    /// Cells around `values`, each as far as half way to its neighbours, the first and the last from their own value.
    pub fn around(values: &[f64]) -> Cells {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        let sorted: Vec<f64> = order.iter().map(|index| values[*index]).collect();
        let scale = Scale::of_axis(&sorted);
        let ends =
            sorted.windows(2).map(|pair| (scale.share(pair[0]) + scale.share(pair[1])) / 2.0);
        let ends: Vec<f64> = ends.collect();
        let steps = sorted.windows(2).map(|pair| scale.share(pair[1]) - scale.share(pair[0]));
        let (least, most) = finite_range(steps).unwrap_or((1.0, 1.0));
        let uneven = if most > UNEVEN * least { sorted.clone() } else { Vec::new() };
        Cells { order, sorted, ends, scale, uneven }
    }

    /// How many cells there are.
    pub fn count(&self) -> usize {
        self.order.len()
    }

    /// The values of the cells, from the smallest to the largest.
    pub fn values(&self) -> impl Iterator<Item = f64> + '_ {
        self.sorted.iter().copied()
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

    /// Whether each place in the results has a part of its cell within these limits, if there are any.
    pub fn within(&self, limits: Option<[f64; 2]>) -> Vec<bool> {
        let shares = limits.map(|limits| limits.map(|end| self.scale.share(end)));
        let mut within = vec![true; self.count()];
        for cell in 0..self.count() {
            let [begins, ends] = self.range(cell);
            within[self.place(cell)] = shares.is_none_or(|[low, high]| begins < high && low < ends);
        }
        within
    }

    /// The place in the results of the cell at `share` of another axis, or the nearest to it.
    pub fn under(&self, axis: &Scale, share: f64) -> usize {
        self.at(self.scale.share(axis.value(share)))
    }

    /// The place in the results of the cell at `share` of the axis.
    pub fn at(&self, share: f64) -> usize {
        self.order[self.ends.partition_point(|end| *end < share)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_coloured_beyond_what_was_computed() {
        for (values, uneven) in
            [(vec![3.0, 1.0, 2.0], false), (vec![1.0, 2.0, 100.0], true), (vec![1.0, 2.0], false)]
        {
            let cells = Cells::around(&values);
            let (low, high) = finite_range(values.iter().copied()).expect("there are values");
            assert_eq!((cells.scale.low, cells.scale.high), (low, high));
            assert_eq!(!cells.uneven.is_empty(), uneven, "{values:?}");
            let at = |value: f64| values[cells.at(cells.scale.share(value))];
            values.iter().for_each(|&value| assert_eq!(at(value), value));
        }
        // Each tenfold of the last is as far on a logarithmic axis.
        assert!(Cells::around(&[1.0, 10.0, 100.0]).uneven.is_empty());
    }
}
