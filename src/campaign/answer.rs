//! The answer of a trade-off: the front, the optima, and what was left out.

use std::collections::BTreeMap;

use super::count::{count, counted};
use super::motion_row::Row;
use super::robustness::Tolerances;
use crate::tradeoff::{Direction, GainAndCost};

/// What is best among the motions of a file.
pub struct Answer {
    /// The file of results.
    pub file: String,
    /// The outputs that should be large and small.
    pub of: GainAndCost,
    /// The motions that are compared.
    pub direction: Direction,
    /// The conditions that its cases, and the motions between them, keep, in the form of [`Condition::normal`](crate::store::Condition::normal).
    pub conditions: Vec<String>,
    /// The most of the price that may be spent, and the least gain that is wanted (SI), if they were given. They choose among
    /// the motions of the front and leave none out.
    pub limits: [Option<f64>; 2],
    /// Cases of the file.
    pub cases: usize,
    /// How many take no part, by the reason.
    pub left_out: BTreeMap<String, usize>,
    /// The gain up to which a motion counts as one without gain, as at rest (SI), and how many do or gain the other way.
    pub at_rest: (f64, usize),
    /// What searches between the cases have brought, if there were any.
    pub refined: Option<Refined>,
    /// The optima.
    pub named: Vec<Named>,
    /// The Pareto front, by rising price.
    pub front: Vec<Row>,
    /// The motions with the most gain, if they are asked for.
    pub top: Vec<Row>,
    /// The tolerances that the motions were judged under, if any.
    pub tolerances: Option<Tolerances>,
    /// Conditions that cannot be judged of a draw, which the counts of draws leave out.
    pub not_judged: Vec<String>,
    /// The motions of the front, by their places, that are on the front of the prices and gains that tolerances leave; empty where none are
    /// asked for.
    pub robust_front: Vec<usize>,
}

impl Answer {
    /// The optima, the front and the motions with the most gain, one after the other; a motion may be among several.
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
#[derive(Debug, Clone, PartialEq)]
pub struct Refined {
    /// The searches.
    pub searched: Searched,
    /// Motions that they have led to.
    pub found: usize,
    /// The number by which starts were drawn; none of searches that were kept before.
    pub seed: Option<u64>,
    /// How many points were drawn over the ranges, and from how many of them searches began: those that settle to a periodic motion in
    /// the direction asked for; none of searches that were kept before.
    pub drawn: Option<[usize; 2]>,
    /// The area that the front of the cases dominates up to the dearest price of both fronts, and that of the whole front, in
    /// units of gain and price.
    pub hypervolumes: [f64; 2],
}

/// Searches for motions between the cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Searched {
    /// Their number.
    pub searches: usize,
    /// Motions and points that they have begun with.
    pub starts: usize,
    /// Orbits that they have led to and that do not count: plain integration from them does not lead back, or they do not keep the
    /// conditions.
    pub unsettled: usize,
    /// The directions in which gain was sought.
    pub directions: Vec<Direction>,
}

impl Searched {
    /// How many from how many starts, and for which directions.
    pub fn in_words(&self) -> String {
        let Searched { searches, starts, directions, .. } = self;
        let directions: Vec<&str> = directions.iter().map(|it| it.name()).collect();
        let plural = if *searches == 1 { "" } else { "es" };
        let (searches, starts) = (count(*searches), counted(*starts, "start"));
        format!("{searches} search{plural} from {starts} ({})", directions.join(", "))
    }
}

/// An optimum.
pub struct Named {
    /// Its name in JSON.
    pub name: &'static str,
    /// The motion; none where there is none.
    pub row: Option<Row>,
}
