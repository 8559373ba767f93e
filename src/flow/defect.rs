//! The defect of a step: how far its polynomials are from solving the equations.

use crate::lane::series::{derivative, value_and_slope};
use crate::model::Field;

use super::Step;
use super::guard::crossings;

/// Where a step is looked at, as shares of its length; where the terms left out are largest is its end.
const LOOKED_AT: [f64; 3] = [1.0 / 3.0, 2.0 / 3.0, 1.0];

/// The largest difference on a step between the rates of its polynomials and those of the equations, times
/// its length, in the units of the field's weights.
///
/// Method: both rates are evaluated at three times of the step, the last of them its end, and wherever the
/// coordinate turns that a narrow layer of the field belongs to: a layer that is entered and left again
/// within a step is deepest there, and one that is passed shows at the end.
/// Guarantees: no coefficient of the field's series takes part, so that a term which they miss shows with its
/// whole size. Of a step whose last terms are below the tolerance the defect is that of the terms left out,
/// some ten tolerances at most. NaN where a rate is not a number.
pub fn defect<S: Field<D>, const D: usize>(system: &S, step: &Step<f64, S>) -> f64 {
    let mut largest = 0.0;
    let mut look_at = |h: f64| {
        let rates = system.coordinates(&step.jet).map(|series| value_and_slope(series, h));
        let coordinates = rates.map(|(value, _)| value);
        let exact = system.rates(&step.mode, step.start + h, &coordinates);
        for (((_, rate), exact), weight) in rates.iter().zip(exact).zip(system.weights()) {
            largest = greater(largest, (weight * (rate - exact) * step.length).abs());
        }
    };
    for share in LOOKED_AT {
        look_at(share * step.length);
    }
    if let Some(series) = system.layered(&step.mode, &step.jet) {
        crossings(&derivative(series), step.length, |h, _| look_at(h));
    }
    largest
}

/// The greater of two numbers, of which one that is not known is greater than any.
pub fn greater(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}
