//! The forces on the capsule in a state of the motion.

use super::general::{Folds, Ground, Springs, Touched};
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
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
    /// Of the folds on the capsule, forward positive; zero on even ground.
    pub folds: f64,
}

impl Forces {
    /// The forces on a capsule with these parameters in a state while the drive has a force [N], friction set-valued at rest as Filippov
    /// has it.
    pub fn of(parameters: &Parameters, state: &State<f64>, drive: f64) -> Forces {
        let shape = parameters.shape();
        let springs = Springs::new(|it| parameters[it], shape);
        let ground = Ground::new(|it| parameters[it], shape);
        let folds = Folds::new(|it| parameters[it], shape).exactly_at(state.place);
        let is_beyond = Touched {
            front: springs.front.at < state.r,
            rear: springs.has_rear() && state.r < springs.rear.at,
        };
        let is_let_go = |pushes: f64| springs.release_by_force && pushes < 0.0;
        let touched = Touched {
            front: is_beyond.front && !is_let_go(springs.of_front(&is_beyond, state)),
            rear: is_beyond.rear && !is_let_go(-springs.of_rear(&is_beyond, state)),
        };
        let reaction = if shape.reacts() { drive } else { 0.0 };
        let own = springs.force(&touched, state);
        let external = drive - reaction + ground.pull + ground.push + folds.pushes;
        let slides = match state.y2 {
            0.0 => None,
            y2 => Some(folds.resists * ground.force(y2.signum(), y2)),
        };
        let is_at_stop = springs.is_rigid && state.r == springs.front.at && state.y1 == state.y2;
        let bearing = match slides {
            _ if !is_at_stop => 0.0,
            None => drive - own + ground.pull,
            Some(friction) => {
                let [m1, m2] = [Parameter::M1, Parameter::M2].map(|it| parameters[it]);
                drive - own + ground.pull - m1 * (external - friction) / (m1 + m2)
            }
        };
        // Where the stop would have to pull, the mass is about to leave it.
        let bearing = bearing.max(0.0);
        let of_mass = own + bearing;
        Forces {
            contact: springs.of_front(&touched, state) + bearing,
            rear_contact: -springs.of_rear(&touched, state),
            of_mass,
            friction: slides.unwrap_or(of_mass - reaction + ground.push + folds.pushes),
            folds: folds.pushes,
        }
    }
}
