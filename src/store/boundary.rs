//! The variables that tell how the boundary of basins goes with the size of boxes.

use super::catalogue::{
    BOUNDARY_DIMENSION, UNCERTAINTY_BOXES, UNCERTAINTY_CROSSED, UNCERTAINTY_EXPONENT,
    UNCERTAINTY_EXPONENT_ERROR, UNCERTAINTY_SCALES, UNCERTAINTY_SIZE, UNCERTAINTY_SLOPE,
    UNCERTAINTY_SLOPE_ERROR, UNCERTAINTY_SPAN,
};
use super::columns::Columns;
use super::{Dataset, Values};
use crate::attractor::{BoxSize, Estimate, Uncertainty};

/// Adds the uncertainty exponent, the sizes it comes from, and the slope between each and the next.
pub(super) fn add(dataset: &mut Dataset, found: &Uncertainty) {
    dataset.put(UNCERTAINTY_EXPONENT, &[], Values::real(found.exponent.value));
    dataset.put(UNCERTAINTY_EXPONENT_ERROR, &[], Values::real(found.exponent.error));
    dataset.put(BOUNDARY_DIMENSION, &[], Values::real(found.dimension.value));
    dataset.put(UNCERTAINTY_SCALES, &[], Values::integer(i64::from(found.scales)));
    dataset.put_coordinate(UNCERTAINTY_SIZE, Values::count(found.sizes.len()));
    let mut columns = Columns { dataset, rows: &found.sizes };
    columns.integers(UNCERTAINTY_SPAN, |size| size.span as i64);
    columns.integers(UNCERTAINTY_BOXES, |size| size.boxes as i64);
    columns.integers(UNCERTAINTY_CROSSED, |size| size.crossed as i64);
    columns.reals(UNCERTAINTY_SLOPE, |size| slope(found, size).map_or(f64::NAN, |it| it.value));
    columns
        .reals(UNCERTAINTY_SLOPE_ERROR, |size| slope(found, size).map_or(f64::NAN, |it| it.error));
}

/// The slope between a size and the next.
fn slope<'a>(found: &'a Uncertainty, size: &BoxSize) -> Option<&'a Estimate> {
    found.slopes.iter().find(|it| it.spans[0] == size.span).map(|it| &it.slope)
}
