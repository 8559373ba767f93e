//! Attractors across cells whose cases do not show them: no start there leads to an orbit that exists.

use rayon::prelude::*;

use crate::branch::natural::{End, Solution};
use crate::model::Locomotion;

use super::cell::{Attractor, Cell};
use super::change::{Change, changes};
use super::family::{Links, Neighbours, goes_on_in};

/// A periodic attractor of one cell that is seen again in a later one, but in none between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Bridge {
    /// The cell where it was last seen, by its place on the line, and the attractor by its place there.
    pub from: [usize; 2],
    /// The cell where it is seen again, and the attractor there.
    pub to: [usize; 2],
    /// What happens to it on the way.
    pub changes: Vec<Change>,
}

/// The bridges of a line, in order.
///
/// Method: an orbit that attracts at the next cell, where no case shows it, is followed from cell to cell
/// until one has it, or that of twice the period that it has become, or until it ends or repels. `between` gives what is held between a cell and the next.
pub fn bridges<'a, S: Locomotion>(
    cells: &[Cell],
    links: &[Links],
    between: impl Fn(usize) -> Option<Neighbours<'a, S>> + Sync,
) -> Vec<Bridge> {
    let unseen = links.iter().enumerate().flat_map(|(at, links)| {
        links.unseen.iter().map(move |(place, solution)| ([at, *place], solution))
    });
    let unseen: Vec<([usize; 2], &Solution)> = unseen.collect();
    let crossed: Vec<Option<Bridge>> = unseen
        .into_par_iter()
        .map(|(from, solution)| cross(cells, links, from, solution, &between))
        .collect();
    let mut found: Vec<Bridge> = Vec::new();
    for bridge in crossed.into_iter().flatten() {
        if found.iter().all(|other| other.to != bridge.to) {
            found.push(bridge);
        }
    }
    found
}

/// Follows an orbit, which attracts at the cell after `from`, to the next cell that shows it.
fn cross<'a, S: Locomotion>(
    cells: &[Cell],
    links: &[Links],
    from: [usize; 2],
    solution: &Solution,
    between: impl Fn(usize) -> Option<Neighbours<'a, S>>,
) -> Option<Bridge> {
    let mut here = solution.clone();
    let mut found = Vec::new();
    for at in from[0] + 1..links.len() {
        let Neighbours { along, values, .. } = between(at)?;
        let (mut path, end) = along.follow(&here, values[1]);
        let changed = changes(&along, &path);
        here = path.pop().filter(|_| end == End::Reached)?;
        let omega = along.omega(here.value);
        let goes_on = |it: &Attractor| goes_on_in(&here, it, &changed, omega);
        let place = cells[at + 1].attractors.iter().position(goes_on);
        found.extend(changed);
        if let Some(place) = place {
            let is_new = links[at].pairs.iter().all(|pair| pair[1] != place);
            return is_new.then_some(Bridge { from, to: [at + 1, place], changes: found });
        }
        if !here.attracts() {
            return None;
        }
    }
    None
}
