//! Attractors across cells whose cases do not show them: no start there leads to an orbit that exists.

use std::sync::Arc;

use super::link::{Links, Neighbours, is_reached};
use super::table::{Executor, Table, results};
use crate::branch::{PeriodicOrbit, SegmentEnd, SpecialValue, succession};
use crate::flow::System;
use crate::orbit::passage::OneByOne;

/// A periodic attractor of one cell that is seen again in a later one, but in none between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Bridge<P> {
    /// The cell where it was last seen, by its place on the line, and the attractor by its place there.
    pub from: [usize; 2],
    /// The cell where it is seen again, and the attractor there.
    pub to: [usize; 2],
    /// Its special points in between.
    pub special: Vec<SpecialValue<P>>,
}

impl<P> Bridge<P> {
    /// The same with section points held in another way.
    pub fn map<Q>(self, held: impl Fn(P) -> Q + Copy) -> Bridge<Q> {
        let Bridge { from, to, special } = self;
        Bridge { from, to, special: special.into_iter().map(|it| it.map(held)).collect() }
    }
}

/// The bridges of a line, in order.
///
/// Method: an orbit that is stable at the next cell, where no case shows it, is continued from cell to cell, see
/// [`succession`], until one has it, or until it ends or becomes unstable. `between` gives what is held between a cell
/// and the next.
pub fn bridges<M: System<D>, const D: usize>(
    cells: &[Arc<Table<[f64; D]>>],
    links: &[Links<[f64; D]>],
    between: impl Fn(usize) -> Option<Neighbours<M, D>> + Sync,
    executor: &dyn Executor,
) -> Vec<Bridge<[f64; D]>> {
    let unseen = links.iter().enumerate().flat_map(|(at, links)| {
        links.unseen.iter().map(move |(place, unseen)| ([at, *place], unseen))
    });
    let unseen: Vec<([usize; 2], &PeriodicOrbit<[f64; D]>)> = unseen.collect();
    let crossed = results(executor, 0..unseen.len(), |number| {
        let (from, unseen) = unseen[number];
        cross(cells, links, from, unseen.clone(), &between)
    });
    let mut found: Vec<Bridge<[f64; D]>> = Vec::new();
    for bridge in crossed.into_iter().flatten() {
        if found.iter().all(|other| other.to != bridge.to) {
            found.push(bridge);
        }
    }
    found
}

/// Continues an orbit, which is at the cell after `from`, to the next cell that shows it.
fn cross<M: System<D>, const D: usize>(
    cells: &[Arc<Table<[f64; D]>>],
    links: &[Links<[f64; D]>],
    from: [usize; 2],
    mut here: PeriodicOrbit<[f64; D]>,
    between: impl Fn(usize) -> Option<Neighbours<M, D>>,
) -> Option<Bridge<[f64; D]>> {
    let mut special = Vec::new();
    for at in from[0] + 1..links.len() {
        let Neighbours { along, protocol, values, .. } = between(at)?;
        let found = succession(&OneByOne, &along, (here.value, &here.points), values[1])?;
        let SegmentEnd::Reached(orbit) = found.end else { return None };
        here = orbit;
        special.extend(found.special);
        let metric = along.metric(here.value);
        let next = &cells[at + 1].attractors;
        if let Some(place) = next.iter().position(|it| is_reached(&here, it, &metric, &protocol)) {
            let is_new = links[at].pairs.iter().all(|pair| pair[1] != place);
            return is_new.then_some(Bridge { from, to: [at + 1, place], special });
        }
        if !here.is_stable() {
            return None;
        }
    }
    None
}
