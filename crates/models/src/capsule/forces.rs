//! The forces on the capsule in a state of the motion.

use super::general::{Ground, Springs, Touched};
use super::parameters::CapsuleParameters as _;
use super::shape::Reaction;
use super::state::State;
use crate::description::Parameters;

/// The forces in a state [N].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forces {
    /// Of the stop on the mass, and so of the mass on the stop: zero apart from it.
    pub contact: f64,
    /// Of the rear stop, above zero where it pushes the mass forward; zero apart from it.
    pub rear_contact: f64,
    /// Of the mass on the capsule, F: of spring, damper and stops.
    pub of_mass: f64,
    /// Of the friction on the capsule, against its motion while it slides; at rest what moves it otherwise.
    pub friction: f64,
}

impl Forces {
    /// The forces on a capsule with these parameters in a state while the drive has a force [N], friction set-valued at rest as Filippov
    /// has it.
    pub fn of(parameters: &Parameters, state: &State<f64>, drive: f64) -> Forces {
        let shape = parameters.shape();
        let springs = Springs::new(|it| parameters[it], shape);
        let ground = Ground::new(|it| parameters[it], shape);
        let touched = Touched {
            front: springs.front.at < state.r,
            rear: springs.has_rear() && state.r < springs.rear.at,
        };
        let of_mass = springs.force(&touched, state);
        let reaction = if shape.reaction == Reaction::Capsule { drive } else { 0.0 };
        let friction = match state.y2 {
            0.0 => of_mass - reaction + ground.push,
            y2 => ground.force(y2.signum(), y2),
        };
        let contact = springs.of_front(&touched, state);
        Forces { contact, rear_contact: -springs.of_rear(&touched, state), of_mass, friction }
    }
}
