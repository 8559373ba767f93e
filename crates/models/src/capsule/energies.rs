//! The energies that a motion exchanges.

use serde::Serialize;

use capsulemap_engine::lane::{Lane, side_by_side};

/// Energies, summed since a start [J].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Energies<L> {
    /// Work of the drive [J].
    pub work_net: L,
    /// Its positive part [J].
    pub work_positive: L,
    /// The integral of its magnitude [J].
    pub work_absolute: L,
    /// Work of a drive that acts between mass and capsule [J].
    pub work_actuator: L,
    /// Energy lost to the resistance of the ground [J].
    pub friction_loss: L,
    /// Energy lost in the damper [J].
    pub damper_loss: L,
}

side_by_side!(Energies {
    work_net,
    work_positive,
    work_absolute,
    work_actuator,
    friction_loss,
    damper_loss
});

impl<L: Lane> Energies<L> {
    /// Nothing exchanged.
    pub fn none() -> Self {
        let zero = L::splat(0.0);
        Energies {
            work_net: zero,
            work_positive: zero,
            work_absolute: zero,
            work_actuator: zero,
            friction_loss: zero,
            damper_loss: zero,
        }
    }
}

impl<L: Copy> Energies<L> {
    /// All of them, in their order.
    pub fn all(&self) -> [L; 6] {
        let Energies {
            work_net,
            work_positive,
            work_absolute,
            work_actuator,
            friction_loss,
            damper_loss,
        } = *self;
        [work_net, work_positive, work_absolute, work_actuator, friction_loss, damper_loss]
    }
}
