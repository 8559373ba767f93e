//! Attractors across cells whose cases do not show them: no start there leads to an orbit that exists.

use rayon::prelude::*;

use crate::capsule::Reading;

use super::change::{Change, changes};
use super::family::{Links, Neighbours, Unseen, doubles};
use super::natural::End;
use crate::attractor::Table;

/// A periodic attractor of one cell that is seen again in a later one, but in none between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Bridge {
    /// The cell where it was last seen, by its place on the line, and the attractor by its place there.
    pub from: [usize; 2],
    /// The cell where it is seen again, and the attractor there.
    pub to: [usize; 2],
    /// Its changes in between.
    pub changes: Vec<Change>,
}

/// The bridges of a line, in order.
///
/// Method: an orbit that attracts at the next cell, where no case shows it, is followed from cell to cell
/// until one has it, or until it ends or repels. One that has doubled its period is followed on past cells
/// that show nothing new, as cases settle slowly there. `between` gives what is held between a cell and the
/// next.
pub fn bridges<'a, R: Reading>(
    cells: &[Table<3>],
    links: &[Links],
    between: impl Fn(usize) -> Option<Neighbours<'a, R>> + Sync,
) -> Vec<Bridge> {
    let unseen = links.iter().enumerate().flat_map(|(at, links)| {
        links.unseen.iter().map(move |(place, unseen)| ([at, *place], unseen))
    });
    let unseen: Vec<([usize; 2], &Unseen)> = unseen.collect();
    let crossed: Vec<Option<Bridge>> = unseen
        .into_par_iter()
        .map(|(from, unseen)| cross(cells, links, from, unseen.clone(), &between))
        .collect();
    let mut found: Vec<Bridge> = Vec::new();
    for bridge in crossed.into_iter().flatten() {
        if found.iter().all(|other| other.to != bridge.to) {
            found.push(bridge);
        }
    }
    found
}

/// Follows an orbit, which is at the cell after `from`, to the next cell that shows it.
fn cross<'a, R: Reading>(
    cells: &[Table<3>],
    links: &[Links],
    from: [usize; 2],
    mut here: Unseen,
    between: impl Fn(usize) -> Option<Neighbours<'a, R>>,
) -> Option<Bridge> {
    let mut found = Vec::new();
    for at in from[0] + 1..links.len() {
        let Neighbours { along, values, .. } = between(at)?;
        let (mut path, end) = along.follow(&here.orbit, values[1]);
        if here.orbit.attracts() {
            let changed = changes(&along, &path);
            here.doubled |= doubles(&changed);
            found.extend(changed);
        }
        here.orbit = path.pop().filter(|_| end == End::Reached)?;
        let metric = along.metric(here.orbit.value);
        let next = &cells[at + 1].attractors;
        let is_new = |place: usize| links[at].pairs.iter().all(|pair| pair[1] != place);
        if let Some(place) = next.iter().position(|it| here.belongs_to(it, &metric)) {
            return is_new(place).then_some(Bridge { from, to: [at + 1, place], changes: found });
        }
        let something_new = || (0..next.len()).any(is_new);
        if !here.is_followed() || (!here.orbit.attracts() && something_new()) {
            return None;
        }
    }
    None
}
