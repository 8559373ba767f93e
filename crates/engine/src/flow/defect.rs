//! The defect of a step: how far its polynomials are from solving the equations.

use crate::lane::ORDER;
use crate::lane::Series;
use crate::lane::series::derivative;

use super::guard::crossings;
use super::metric::greater;
use super::step::Step;
use super::switched::Field;

/// The largest difference on a step between the rates of its polynomials and those of the equations, times
/// its length, in the units of the field's weights.
///
/// Method: both rates are evaluated in the middle of the step, at its end, where the terms left out are
/// largest, and wherever the coordinate turns that a narrow layer of the field belongs to: a layer that is
/// entered and left again within a step is deepest there, and one that is passed shows at the end.
/// Guarantees: no coefficient of the field's series takes part, so that a term which they miss shows with its
/// whole size. Of a step whose last terms are below the tolerance the defect is that of the terms left out:
/// of 30 000 random capsules 99 in 100 had less than 30 tolerances, and the largest, where a fast motion has
/// faded beside a slow one, 2100.
/// NaN where a rate is not a number.
#[inline]
pub fn defect<S: Field>(system: &S, step: &Step<f64, S>) -> f64 {
    let weights = system.weights();
    let mut largest = 0.0;
    let mut look_at = |h: f64| {
        let (state, slopes) = system.motion(&step.jet, h);
        let exact = S::coordinates(&system.rates(&step.mode, step.start + h, &state));
        let slopes = S::coordinates(&slopes);
        let rates = slopes.as_ref().iter().zip(exact.as_ref());
        for ((slope, exact), weight) in rates.zip(weights.as_ref()) {
            largest = greater(largest, (weight * (slope - exact) * step.length).abs());
        }
    };
    look_at(0.5 * step.length);
    look_at(step.length);
    let layered = system.layered(&step.mode, &step.jet);
    if let Some(series) = layered.filter(|series| !is_monotone(series, step.length)) {
        crossings(&derivative(series), step.length, |h, _| look_at(h));
    }
    largest
}

/// Whether the slope at the start outweighs all that it can change by on [0, h].
#[inline]
fn is_monotone(series: &Series<f64>, h: f64) -> bool {
    let mut change = 0.0;
    for k in (2..=ORDER).rev() {
        change = change * h + k as f64 * series[k].abs();
    }
    change * h < series[1].abs()
}
