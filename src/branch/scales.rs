//! What the section point and the parameters are measured by, so that arclength means something.

use crate::capsule::{Parameter, Parameters};
use crate::orbit::Section;
use crate::orbit::recurrence::size;

use super::Request;

/// Units of r, y1 and y2.
///
/// A velocity counts relative to the largest of those at the section points `first` and of what the mass
/// would have if it swung linearly at the ends of the range; a displacement r counts as omega r.
pub fn units(request: &Request, first: &[Section]) -> [f64; 3] {
    let omega = request.parameters[Parameter::Omega];
    let swung = request.range.map(|value| {
        let mut parameters = request.parameters.clone();
        parameters[request.along] = value;
        linear_speed(&parameters)
    });
    let sizes = first.iter().map(|point| size(omega, point));
    let speed = sizes.chain(swung).filter(|speed| speed.is_finite()).fold(0.0, f64::max);
    let speed = if speed > 0.0 { speed } else { 1.0 };
    [speed / omega, speed, speed]
}

/// Amplitude of the velocity of the mass while nothing slips or touches [m/s].
fn linear_speed(parameters: &Parameters) -> f64 {
    let omega = parameters[Parameter::Omega];
    let spring = parameters[Parameter::K1] - parameters[Parameter::M1] * omega * omega;
    let impedance = libm::hypot(spring, parameters[Parameter::C] * omega);
    parameters[Parameter::Pd] * omega / impedance
}
