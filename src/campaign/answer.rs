//! The answer of a trade-off: the front, the optima, and what was left out.

use std::collections::BTreeMap;

use crate::capsule::Output;
use crate::tradeoff::Direction;

use super::motion_row::Row;
use super::robustness::Tolerances;

/// What is best among the motions of a file.
pub struct Answer {
    /// The file of results.
    pub file: String,
    /// The output that should be small.
    pub of: Output,
    /// The motions that are compared.
    pub direction: Direction,
    /// Cases of the file.
    pub cases: usize,
    /// How many take no part, by the reason.
    pub left_out: BTreeMap<String, usize>,
    /// The speed up to which a motion counts as at rest [m/s], and how many do or move the other way.
    pub at_rest: (f64, usize),
    /// What a search between the cases has brought, if it was asked for.
    pub refined: Option<Gain>,
    /// The optima.
    pub named: Vec<Named>,
    /// The Pareto front, by rising price.
    pub front: Vec<Row>,
    /// The fastest motions, if they are asked for.
    pub top: Vec<Row>,
    /// The tolerances that the motions were judged under, if any.
    pub tolerances: Option<Tolerances>,
    /// The motions of the front, by their places, that are on the front of the prices and speeds that tolerances leave; empty where none are
    /// asked for.
    pub robust_front: Vec<usize>,
}

impl Answer {
    /// The optima, the front and the fastest, one after the other; a motion may be among several.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        let named = self.named.iter().filter_map(|it| it.row.as_ref());
        named.chain(&self.front).chain(&self.top)
    }

    /// The same, to be changed.
    pub fn rows_mut(&mut self) -> impl Iterator<Item = &mut Row> {
        let named = self.named.iter_mut().filter_map(|it| it.row.as_mut());
        named.chain(&mut self.front).chain(&mut self.top)
    }
}

/// What a search for motions between the cases has brought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gain {
    /// Searches.
    pub searches: usize,
    /// Motions that they have led to.
    pub found: usize,
    /// The number by which starts were drawn.
    pub seed: u64,
    /// The area that the front of the cases dominates up to the dearest price of both fronts, and that of the whole front, in
    /// units of speed and price.
    pub hypervolumes: [f64; 2],
}

/// An optimum.
pub struct Named {
    /// Its name in JSON.
    pub name: &'static str,
    /// The motion; none where there is none.
    pub row: Option<Row>,
}
