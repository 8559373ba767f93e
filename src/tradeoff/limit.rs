//! What outputs of a motion may be at most or at least.

use super::hold::Side;
use crate::description::Output;

/// What an output may be at most, or at least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The output.
    pub output: Output,
    /// Which end of its range is given.
    pub side: Side,
    /// The end (SI).
    pub value: f64,
}

impl Limit {
    /// A budget: the most of an output.
    pub fn budget(output: Output, most: f64) -> Limit {
        Limit { output, side: Side::Upper, value: most }
    }

    /// By how much a value of the output exceeds it (SI).
    pub fn excess(&self, value: f64) -> f64 {
        match self.side {
            Side::Upper => value - self.value,
            Side::Lower => self.value - value,
        }
    }
}
