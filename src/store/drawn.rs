//! The draws of a study in its file: their numbers as a coordinate, and what was drawn along it.

use ndarray::{ArrayD, IxDyn};

use super::{Dataset, Values, Variable};
use crate::study::Draws;

/// Adds the draws by their numbers, what was drawn as variables over them, and how they were drawn.
pub(super) fn add(dataset: &mut Dataset, draws: &Draws) {
    let shape = || IxDyn(&[draws.count]);
    let numbers = ArrayD::from_shape_fn(shape(), |index| index[0] as i64);
    let numbers = over_draws("1", "number of the draw", Values::Integer(numbers));
    dataset.coordinates.push((Draws::DIMENSION.to_owned(), numbers));
    for (place, range) in draws.ranges.iter().enumerate() {
        let drawn = range.coordinate;
        let values = ArrayD::from_shape_fn(shape(), |index| draws.value(index[0], place));
        let unit = drawn.dimension().unit();
        let variable = over_draws(unit, drawn.meaning(), Values::Real(values));
        dataset.variables.insert(drawn.name().to_owned(), variable);
    }
    dataset.attributes.insert("draws_kind".to_owned(), draws.kind.name().to_owned());
    dataset.attributes.insert("draws_seed".to_owned(), draws.seed.to_string());
}

fn over_draws(unit: &str, long_name: &str, values: Values) -> Variable {
    Variable {
        dimensions: vec![Draws::DIMENSION.to_owned()],
        unit: unit.to_owned(),
        long_name: long_name.to_owned(),
        values,
        flags: Vec::new(),
    }
}
