//! The series of several quantities over a step, for systems whose state is an array.

use std::ops::{Index, IndexMut};

use crate::lane::{Lane, Series, SideBySide, series};

/// The series of `N` quantities over a step: first the coordinates, then whatever else the recurrences of the
/// field or its guards need.
#[derive(Debug, Clone)]
pub struct Taylor<L, const N: usize>(pub [Series<L>; N]);

impl<L: Lane, const N: usize> Default for Taylor<L, N> {
    #[inline(always)]
    fn default() -> Self {
        Taylor([series::zero(); N])
    }
}

impl<L, const N: usize> Index<usize> for Taylor<L, N> {
    type Output = Series<L>;
    #[inline(always)]
    fn index(&self, which: usize) -> &Series<L> {
        &self.0[which]
    }
}

impl<L, const N: usize> IndexMut<usize> for Taylor<L, N> {
    #[inline(always)]
    fn index_mut(&mut self, which: usize) -> &mut Series<L> {
        &mut self.0[which]
    }
}

impl<L: Lane, const N: usize> SideBySide for Taylor<L, N> {
    type One = Taylor<f64, N>;

    #[inline(always)]
    fn splat(one: &Self::One) -> Self {
        let mut lanes = Taylor::default();
        for (lanes, one) in lanes.0.iter_mut().zip(&one.0) {
            *lanes = SideBySide::splat(one);
        }
        lanes
    }
    #[inline(always)]
    fn lane(&self, index: usize) -> Self::One {
        let mut one = Taylor::default();
        for (one, lanes) in one.0.iter_mut().zip(&self.0) {
            *one = lanes.lane(index);
        }
        one
    }
    #[inline(always)]
    fn put(&mut self, index: usize, one: &Self::One) {
        for (lanes, one) in self.0.iter_mut().zip(&one.0) {
            lanes.put(index, one);
        }
    }
    #[inline(always)]
    fn take_lane(&mut self, index: usize, other: &Self) {
        for (lanes, other) in self.0.iter_mut().zip(&other.0) {
            lanes.take_lane(index, other);
        }
    }
}

impl<L: Lane, const N: usize> Taylor<L, N> {
    /// Sets the first terms to a state.
    #[inline(always)]
    pub fn begin<const K: usize>(&mut self, state: &[L; K]) {
        for (series, coordinate) in self.0.iter_mut().zip(state) {
            series[0] = *coordinate;
        }
    }

    /// The first `K` quantities `h` after the start of the step.
    #[inline(always)]
    pub fn at<const K: usize>(&self, h: L) -> [L; K] {
        // A loop: what the functions of the standard library for arrays call is not compiled for the instructions
        // of a lane.
        let mut at = [h; K];
        for (value, series) in at.iter_mut().zip(&self.0) {
            *value = series::value(series, h);
        }
        at
    }

    /// The same with the slopes of the series.
    #[inline(always)]
    pub fn motion<const K: usize>(&self, h: L) -> ([L; K], [L; K]) {
        let pairs: [(L, L); K] = std::array::from_fn(|i| series::value_and_slope(&self.0[i], h));
        (pairs.map(|pair| pair.0), pairs.map(|pair| pair.1))
    }
}
