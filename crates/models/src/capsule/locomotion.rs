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

    /// What the event at the end of a step changes of the velocities; none of a capsule whose velocities never jump.
    #[inline(always)]
    fn jump(&self, _step: &Step<L, Self>) -> Option<Jump<L>>
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

/// A jump of the velocities.
#[derive(Debug, Clone, Copy)]
pub struct Jump<L: Lane> {
    /// Where there is one.
    pub here: L::Mask,
    /// The velocity of the capsule after it [m/s].
    pub y2: L,
    /// The kinetic energy that a stop takes from the motion [J].
    pub lost: L,
    /// The kinetic energy that the drive takes from the relative motion, and what it gives [J].
    pub driven: [L; 2],
}

impl<L: Lane> Jump<L> {
    /// An energy that the motion loses at once, where it is not zero, while the capsule keeps its velocity.
    #[inline(always)]
    pub fn of_energy(lost: L, y2: L) -> Self {
        let zero = L::splat(0.0);
        Jump { here: zero.lt(lost * lost), y2, lost, driven: [zero; 2] }
    }

    /// It where there is one, else another.
    #[inline(always)]
    pub fn or(self, other: Self) -> Self {
        let of = |own: L, others: L| L::select(self.here, own, others);
        let [taken, given] = self.driven;
        Jump {
            here: self.here | other.here,
            y2: of(self.y2, other.y2),
            lost: of(self.lost, other.lost),
            driven: [of(taken, other.driven[0]), of(given, other.driven[1])],
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
    /// Whether the front stop is rigid, so that no motion beyond its place has a minimum there.
    pub is_rigid: bool,
    /// The damping of the stops that are touched [N s/m].
    pub damping: L,
    /// The drag on the capsule while it slides [N].
    pub drag: Series<L>,
    /// The force of the folds on the capsule, forward positive [N].
    pub folds: Series<L>,
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
