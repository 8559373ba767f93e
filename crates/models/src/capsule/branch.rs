//! Branches of periodic motions of a capsule, with their outputs.

use capsulemap_engine::branch::NotFollowed;

use super::parameters::CapsuleParameters as _;
use super::shape::Form;
use super::system::{AsPrinted, CapsuleSystem, Filippov, General, OverFolds};
use crate::face;
pub use crate::motion::branch::{Branch, Found, Point, Request, Special};

/// Follows a branch of periodic orbits both ways from the one that is given, and what leaves it.
///
/// # Errors
/// Where no periodic orbit is found near the point that is given, or none that a branch goes through.
pub fn follow(request: &Request) -> Result<Found, NotFollowed> {
    match request.setting.parameters.form() {
        Form::Filippov => face::follow::<CapsuleSystem<Filippov>, 3>(request),
        Form::AsPrinted => face::follow::<CapsuleSystem<AsPrinted>, 3>(request),
        Form::General => face::follow::<CapsuleSystem<General>, 3>(request),
        Form::OverFolds => face::follow::<CapsuleSystem<OverFolds>, 4>(request),
    }
}
