//! What the section point and the parameters are measured by, so that arclength means something.

use crate::flow::System;
use crate::lane::Dual;
use crate::orbit::Varied;

/// Units of the coordinates of the section.
///
/// A coordinate counts relative to the largest of the sizes of the section points `first` and of those that
/// the system expects of its motion at the ends of the range.
pub fn units<M: System<D>, const D: usize>(
    system: &M,
    along: &Varied<M::Parameter>,
    range: [f64; 2],
    first: &[[f64; D]],
) -> [f64; D] {
    let metric = system.metric();
    let expected = range.map(|value| along.of(system, value).expected_size());
    let sizes = first.iter().map(|point| metric.size(point));
    let size = sizes.chain(expected).filter(|size| size.is_finite()).fold(0.0, f64::max);
    let size = if size > 0.0 { size } else { 1.0 };
    metric.scales.map(|scale| size / scale)
}

/// Unknowns in their own units, with derivatives along them.
pub fn seeded<const U: usize>(at: &[f64; U], units: &[f64; U]) -> [Dual<f64, U>; U] {
    std::array::from_fn(|i| {
        let mut seeded = Dual::constant(at[i] * units[i]);
        seeded.gradient[i] = units[i];
        seeded
    })
}
