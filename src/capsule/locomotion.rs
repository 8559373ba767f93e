//! What is told of a capsule's motion beside its coordinates, however its friction is read.

use crate::flow::Field;
use crate::lane::Series;

use super::state::{Contact, EventKind, Jet, State, StickSlip};

/// A switched system that is a capsule, so that speed and energies can be told from its motion.
pub trait Locomotion: Field<State = State<f64>, Event = EventKind> {
    /// The motion in the series of a step.
    fn jet<'a>(&self, jet: &'a Self::Jet) -> &'a Jet<f64>;
    /// The friction force on the capsule, opposing its motion while it slides and F at rest [N].
    fn friction(&self, mode: &Self::Mode, jet: &Self::Jet) -> Series<f64>;
    /// The rate of x2, which the equation as printed lets differ from y2 [m/s].
    fn slip_rate(&self, mode: &Self::Mode, jet: &Self::Jet) -> Series<f64>;
    /// Whether the mass touches the stop.
    fn contact(&self, mode: &Self::Mode) -> Contact;
    /// Whether and where the capsule slides.
    fn stick_slip(&self, mode: &Self::Mode) -> StickSlip;
}
