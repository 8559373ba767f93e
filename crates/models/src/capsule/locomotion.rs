//! What is told of a capsule's motion beside its coordinates, however its friction is read.

use capsulemap_engine::flow::Switched;
use capsulemap_engine::lane::{Lane, Mask, Series};

use super::state::{EventKind, Jet, State};

/// A switched system that is a capsule, so that speed and energies can be told from its motion.
pub trait Locomotion<L: Lane>: Switched<L, State = State<L>, Event = EventKind> {
    /// The motion in the series of a step.
    fn jet<'a>(&self, jet: &'a Self::Jet) -> &'a Jet<L>;
    /// The friction force on the capsule, opposing its motion while it slides and F at rest [N].
    fn friction(&self, mode: &Self::Mode, jet: &Self::Jet) -> Series<L>;
    /// The rate of x2, which the equation as printed lets differ from y2 [m/s].
    fn slip_rate(&self, mode: &Self::Mode, jet: &Self::Jet) -> Series<L>;
    /// Where the mass touches the stop.
    fn closed(&self, mode: &Self::Mode) -> L::Mask;
    /// Direction of sliding, +1 or -1; 0 at rest.
    fn direction(&self, mode: &Self::Mode) -> L;

    /// Whether the mass touches the stop in lane `index`.
    fn contact(&self, mode: &Self::Mode, index: usize) -> Contact {
        if self.closed(mode).lane(index) { Contact::Closed } else { Contact::Open }
    }

    /// Whether and where the capsule slides in lane `index`.
    fn stick_slip(&self, mode: &Self::Mode, index: usize) -> StickSlip {
        match self.direction(mode).lane(index) {
            direction if direction > 0.0 => StickSlip::Forward,
            direction if direction < 0.0 => StickSlip::Backward,
            _ => StickSlip::Stick,
        }
    }
}

/// Whether the mass touches the stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contact {
    /// Apart.
    Open,
    /// Touching.
    Closed,
}

/// Whether and where the capsule slides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StickSlip {
    /// At rest on the ground.
    Stick,
    /// Sliding forward.
    Forward,
    /// Sliding backward.
    Backward,
}
