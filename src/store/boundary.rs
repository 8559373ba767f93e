//! The variables that tell how the boundary of basins goes with the size of boxes, and whether all basins have one.

use super::catalogue::{
    BOUNDARY_DIMENSION, UNCERTAINTY_BOXES, UNCERTAINTY_CROSSED, UNCERTAINTY_EXPONENT,
    UNCERTAINTY_EXPONENT_ERROR, UNCERTAINTY_SCALES, UNCERTAINTY_SIZE, UNCERTAINTY_SLOPE,
    UNCERTAINTY_SLOPE_ERROR, UNCERTAINTY_SPAN, WADA_BOUNDARY, WADA_COVERED, WADA_DISTANCE,
    WADA_FARTHER, WADA_FROM, WADA_LEAST_RADIUS, WADA_OF, WADA_PAIR, WADA_PAIR_FARTHER, WADA_RADIUS,
    WADA_SCALE, WADA_UNKNOWN,
};
use super::columns::Columns;
use super::{Dataset, Values};
use crate::attractor::{BoxSize, Estimate, Uncertainty, Wada};

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

/// Adds how far the boundaries of basins are from each other, pair by pair, and what follows at each radius.
pub(super) fn add_wada(dataset: &mut Dataset, found: &Wada) {
    let least = found.least_radius().unwrap_or(0);
    dataset.put(WADA_LEAST_RADIUS, &[], Values::integer(least as i64));
    dataset.put(WADA_UNKNOWN, &[], Values::integer(found.unknown as i64));
    Columns { dataset, rows: &found.boundaries }.integers(WADA_BOUNDARY, |starts| *starts as i64);
    dataset.put_coordinate(WADA_SCALE, Values::count(found.scales.len()));
    let mut scales = Columns { dataset, rows: &found.scales };
    scales.integers(WADA_RADIUS, |scale| scale.radius as i64);
    scales.reals(WADA_FARTHER, |scale| scale.farther);
    scales.reals(WADA_COVERED, |scale| scale.covered);
    dataset.put_coordinate(WADA_PAIR, Values::count(found.pairs.len()));
    let mut pairs = Columns { dataset, rows: &found.pairs };
    pairs.integers(WADA_OF, |pair| i64::from(pair.of));
    pairs.integers(WADA_FROM, |pair| i64::from(pair.from));
    pairs.reals(WADA_DISTANCE, |pair| pair.distance);
    pairs.several(WADA_PAIR_FARTHER, found.scales.len(), |pair, at| pair.farther[at]);
}
