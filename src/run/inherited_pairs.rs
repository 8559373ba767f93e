//! Which attractors of two neighbouring cells the cases lead between that inherit their start.

use std::sync::Arc;

use crate::attractor::Table;
use crate::description::Section;
use crate::study::Direction;

/// The attractors of two cells between which the cases lead that have this one of the `directions` of a cell in
/// turn, each pair once.
pub(super) fn leads(
    cells: &[Arc<Table<Section>>; 2],
    directions: &[Direction],
    direction: Direction,
) -> Vec<[usize; 2]> {
    let [low, high] = cells.each_ref().map(|cell| &cell.of_case);
    let both = low.iter().zip(high).zip(directions.iter().cycle());
    let mut pairs = Vec::new();
    for ((a, b), _) in both.filter(|(_, it)| **it == direction) {
        if let (Some(a), Some(b)) = (a, b)
            && !pairs.contains(&[*a as usize, *b as usize])
        {
            pairs.push([*a as usize, *b as usize]);
        }
    }
    pairs
}
