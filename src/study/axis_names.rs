//! What an axis of a study file may vary, by its names, and the values that it may have.

use super::Coordinate;
use super::document::Entry;
use crate::description::Description;

/// More values on an axis, and more draws, than this are taken for a slip of the pen.
pub(super) const MOST_VALUES: u64 = 10_000_000;

/// What an axis of a study of a model may vary, by its names.
pub(super) fn names(model: &'static Description) -> Vec<(&'static str, Coordinate)> {
    let own = Coordinate::all(model).map(|coordinate| (coordinate.name(), coordinate));
    let older = Coordinate::phases(model).take(1).map(|it| (Coordinate::PHASE, it));
    own.chain(older).collect()
}

/// The value of an entry of an axis, if it is allowed.
pub(super) fn quantity(entry: &Entry<'_, '_>, coordinate: Option<Coordinate>) -> Option<f64> {
    let coordinate = coordinate?;
    entry.allowed_quantity(coordinate.dimension(), coordinate.allowed())
}
