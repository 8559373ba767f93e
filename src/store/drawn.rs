//! The draws of a study in its file: their numbers as a coordinate, and what was drawn along it.

use ndarray::{ArrayD, IxDyn};

use super::catalogue::{DRAW, Entry};
use super::{Dataset, Values};
use crate::study::Draws;

/// Adds the draws by their numbers, what was drawn as variables over them, and how they were drawn.
pub(super) fn add(dataset: &mut Dataset, draws: &Draws) {
    dataset.put_coordinate(DRAW, Values::count(draws.count));
    for (place, range) in draws.ranges.iter().enumerate() {
        let drawn = |index: usize| draws.value(index, place);
        let values = ArrayD::from_shape_fn(IxDyn(&[draws.count]), |index| drawn(index[0]));
        let entry = Entry::of_coordinate(range.coordinate);
        dataset.put(entry, &[DRAW.name], Values::Real(values));
    }
    dataset.attributes.insert("draws_kind".to_owned(), draws.kind.name().to_owned());
    dataset.attributes.insert("draws_seed".to_owned(), draws.seed.to_string());
}
