//! The forces on the capsule in a state of the motion.

use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::state::State;
use crate::description::Parameters;

/// The forces in a state [N].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forces {
    /// Of the stop on the mass, and so of the mass on the stop: k2 (r - delta) beyond the gap, else zero.
    pub contact: f64,
    /// Of the mass on the capsule, F = k1 r + c (y1 - y2) and the contact force.
    pub of_mass: f64,
    /// Of the friction on the capsule, against its motion while it slides, and F at rest.
    pub friction: f64,
}

impl Forces {
    /// The forces on a capsule with these parameters in a state, friction set-valued at rest as Filippov has it.
    pub fn of(parameters: &Parameters, state: &State<f64>) -> Forces {
        let State { r, y1, y2, .. } = *state;
        let [k1, c, k2, delta] =
            [Parameter::K1, Parameter::C, Parameter::K2, Parameter::Delta].map(|it| parameters[it]);
        let contact = k2 * (r - delta).max(0.0);
        let of_mass = k1 * r + c * (y1 - y2) + contact;
        let friction = if y2 == 0.0 { of_mass } else { parameters.drag().force(y2.signum(), y2) };
        Forces { contact, of_mass, friction }
    }
}
