//! What is told of a capsule's motion beside its coordinates, however its friction is read.

use capsulemap_engine::flow::{Step, Switched};
use capsulemap_engine::lane::{Lane, Mask, Series};

use super::state::{EventKind, Jet, State};

/// The force of the drive during a step, and where it does its work.
#[derive(Debug, Clone, Copy)]
pub struct DriveSeries<'a, L> {
    /// The force in units of `unit`.
    pub force: &'a Series<L>,
    /// What the force is told in [N].
    pub unit: L,
    /// The velocity at which the force works, that of the mass or, with a reaction on the capsule, that relative to it [m/s].
    pub rate: &'a Series<L>,
    /// Whether the capsule takes up the reaction.
    pub reacts: bool,
}

/// A switched system that is a capsule, so that speed and energies can be told from its motion.
pub trait Locomotion<L: Lane>: Switched<L, State = State<L>, Event = EventKind> {
    /// Whether it has [`Locomotion::parts`].
    const HAS_PARTS: bool = false;

    /// The motion in the series of a step.
    fn jet<'a>(&self, jet: &'a Self::Jet) -> &'a Jet<L>;
    /// The force of the drive.
    fn drive<'a>(&self, jet: &'a Self::Jet) -> DriveSeries<'a, L>;
    /// The friction force on the capsule, opposing its motion while it slides and what moves it at rest [N].
    fn friction(&self, mode: &Self::Mode, jet: &Self::Jet) -> Series<L>;
    /// The rate of x2, which the equation as printed lets differ from y2 [m/s].
    fn slip_rate(&self, mode: &Self::Mode, jet: &Self::Jet) -> Series<L>;
    /// Where the mass touches the stop.
    fn closed(&self, mode: &Self::Mode) -> L::Mask;
    /// Direction of sliding, +1 or -1; 0 at rest.
    fn direction(&self, mode: &Self::Mode) -> L;

    /// What the capsule has beside one stop, a damper and friction during a step, as members of the family do; none where it has
    /// nothing else.
    #[inline(always)]
    fn parts(&self, _step: &Step<L, Self>) -> Option<Parts<L>>
    where
        Self: Sized,
    {
        None
    }

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

/// What a member of the family has beside one stop, a damper and friction, during a step.
#[derive(Debug, Clone)]
pub struct Parts<L: Lane> {
    /// The forces in contact of the front stop and of the rear stop, against the mass; zero apart from it [N].
    pub stops: [Series<L>; 2],
    /// Where the rear stop is [m]; far away where there is none.
    pub rear: L,
    /// The damping of the stops that are touched [N s/m].
    pub damping: L,
    /// The drag on the capsule while it slides [N].
    pub drag: Series<L>,
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

/// The sign of a number: -1, 0 or 1.
#[inline(always)]
pub(super) fn direction<L: Lane>(x: L) -> L {
    let zero = L::splat(0.0);
    let forward = L::select(zero.lt(x), L::splat(1.0), zero);
    L::select(x.lt(zero), L::splat(-1.0), forward)
}
