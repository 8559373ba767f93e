//! The series of a step of a text's oscillator.

use capsulemap_engine::in_lanes;
use capsulemap_engine::lane::{Lane, Series, SideBySide};

/// The series of a step.
#[derive(Debug, Clone)]
pub struct TextJet<L> {
    /// The registers of the program.
    pub registers: Vec<Series<L>>,
    /// The numbers of the case and of the mode.
    pub(crate) numbers: Vec<L>,
    /// The terms of one order of all registers.
    pub(crate) row: Vec<L>,
    /// How long the next edge of a pulse is away.
    pub(crate) until_edge: L,
}

impl<L: Lane> Default for TextJet<L> {
    #[inline(always)]
    fn default() -> Self {
        let until_edge = L::splat(0.0);
        TextJet { registers: Vec::new(), numbers: Vec::new(), row: Vec::new(), until_edge }
    }
}

in_lanes! {
    impl<L: Lane> SideBySide for TextJet<L> {
        type One = TextJet<f64>;

        fn splat(one: &TextJet<f64>) -> Self {
            TextJet {
                registers: all(&one.registers),
                numbers: one.numbers.iter().map(|it| L::splat(*it)).collect(),
                row: vec![L::splat(0.0); one.row.len()],
                until_edge: L::splat(one.until_edge),
            }
        }
        fn lane(&self, index: usize) -> TextJet<f64> {
            TextJet {
                registers: self.registers.iter().map(|it| it.lane(index)).collect(),
                numbers: self.numbers.iter().map(|it| it.lane(index)).collect(),
                row: vec![0.0; self.row.len()],
                until_edge: self.until_edge.lane(index),
            }
        }
        fn put(&mut self, index: usize, one: &TextJet<f64>) {
            *self = if self.registers.is_empty() { Self::splat(one) } else { std::mem::take(self) };
            for (own, one) in self.registers.iter_mut().zip(&one.registers) {
                own.put(index, one);
            }
            for (own, one) in self.numbers.iter_mut().zip(&one.numbers) {
                *own = own.with_lane(index, *one);
            }
            self.until_edge = self.until_edge.with_lane(index, one.until_edge);
        }
        fn take_lane(&mut self, index: usize, other: &Self) {
            for (own, other) in self.registers.iter_mut().zip(&other.registers) {
                own.take_lane(index, other);
            }
            for (own, other) in self.numbers.iter_mut().zip(&other.numbers) {
                *own = own.with_lane_of(index, *other);
            }
            self.until_edge = self.until_edge.with_lane_of(index, other.until_edge);
        }
    }

    fn all<L: Lane>(of: &[Series<f64>]) -> Vec<Series<L>> {
        of.iter().map(SideBySide::splat).collect()
    }
}
