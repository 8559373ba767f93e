//! A path as the text of a study file, with all digits and in SI units.

use super::path_file::evenly;
use super::toml_text::{Document, inline, list, quantity, text};
use super::{Axis, Spacing, Varying};

/// Writes what follows the name of a path.
pub(super) fn write_path(document: &mut Document, axis: &Axis) {
    match spacing(axis) {
        Some(spacing) => {
            document.put("from", place(axis, 0));
            document.put("to", place(axis, axis.places() - 1));
            document.put("points", axis.places());
            document.put("spacing", text(spacing.name()));
        }
        None => document.put("values", list((0..axis.places()).map(|at| place(axis, at)))),
    }
}

/// The values at a place, in one line.
fn place(axis: &Axis, at: usize) -> String {
    inline(axis.varying.iter().map(|Varying { coordinate, values }| {
        let value = values.get(at).copied().unwrap_or(f64::NAN);
        (coordinate.name().to_owned(), quantity(value, coordinate.dimension()))
    }))
}

/// The spacing that makes exactly the values of a path from its ends, if there is such.
fn spacing(axis: &Axis) -> Option<Spacing> {
    let points = axis.places();
    if points < 3 || axis.varying.iter().any(|it| it.values.len() != points) {
        return None;
    }
    let makes = |spacing: &Spacing, values: &[f64]| {
        let ends = [values[0], values[points - 1]];
        let can_be =
            *spacing == Spacing::Linear || ends[0] == ends[1] || ends.iter().all(|end| *end > 0.0);
        can_be && are_same(&evenly(*spacing, ends, points), values)
    };
    [Spacing::Linear, Spacing::Logarithmic]
        .into_iter()
        .find(|spacing| axis.varying.iter().all(|it| makes(spacing, &it.values)))
}

/// Whether values are the same to the bit.
pub(super) fn are_same(some: &[f64], others: &[f64]) -> bool {
    some.iter().zip(others).all(|(a, b)| a.to_bits() == b.to_bits())
}
