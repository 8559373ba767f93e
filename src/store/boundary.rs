//! The variables that tell how the boundary of basins goes with the size of boxes.

use ndarray::{ArrayD, IxDyn};

use super::catalogue::{
    BOUNDARY_DIMENSION, Entry, UNCERTAINTY_BOXES, UNCERTAINTY_CROSSED, UNCERTAINTY_EXPONENT,
    UNCERTAINTY_EXPONENT_ERROR, UNCERTAINTY_SCALES, UNCERTAINTY_SIZE, UNCERTAINTY_SLOPE,
    UNCERTAINTY_SLOPE_ERROR, UNCERTAINTY_SPAN,
};
use super::{Dataset, Values};
use crate::attractor::{BoxSize, Estimate, Uncertainty};

/// Adds the uncertainty exponent, the sizes it comes from, and the slope between each and the next.
pub(super) fn add(dataset: &mut Dataset, found: &Uncertainty) {
    let once = [
        (UNCERTAINTY_EXPONENT, found.exponent.value),
        (UNCERTAINTY_EXPONENT_ERROR, found.exponent.error),
        (BOUNDARY_DIMENSION, found.dimension.value),
    ];
    for (entry, value) in once {
        dataset.put(entry, &[], Values::Real(ArrayD::from_elem(IxDyn(&[]), value)));
    }
    let scales = ArrayD::from_elem(IxDyn(&[]), i64::from(found.scales));
    dataset.put(UNCERTAINTY_SCALES, &[], Values::Integer(scales));
    dataset.put_coordinate(UNCERTAINTY_SIZE, Values::count(found.sizes.len()));
    let mut whole = |entry: Entry, of: fn(&BoxSize) -> usize| {
        let numbers = found.sizes.iter().map(|size| of(size) as i64).collect();
        dataset.put_column(entry, Values::integers(numbers));
    };
    whole(UNCERTAINTY_SPAN, |size| size.span);
    whole(UNCERTAINTY_BOXES, |size| size.boxes);
    whole(UNCERTAINTY_CROSSED, |size| size.crossed);
    let mut real = |entry: Entry, of: fn(&Estimate) -> f64| {
        let at = |size: &BoxSize| {
            let slope = found.slopes.iter().find(|it| it.spans[0] == size.span);
            slope.map_or(f64::NAN, |it| of(&it.slope))
        };
        dataset.put_column(entry, Values::reals(found.sizes.iter().map(at).collect()));
    };
    real(UNCERTAINTY_SLOPE, |it| it.value);
    real(UNCERTAINTY_SLOPE_ERROR, |it| it.error);
}
