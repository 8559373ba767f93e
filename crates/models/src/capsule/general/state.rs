//! What a motion of the family is made of beside the state: guards, mode and series.

use capsulemap_engine::flow::Zeros;
use capsulemap_engine::lane::{Lane, Mask, Series, series, side_by_side};

use super::folds::FoldSeries;
use super::springs::{Squares, Touched};
use crate::capsule::state::{EventKind, Jet, State};

/// Guard of the drive, the time until its next edge.
pub(super) const EDGE: usize = 0;
/// Guard of the front stop, `r - delta` while it is touched and `delta - r` apart from it.
pub(super) const FRONT: usize = 1;
/// Guard of the rear stop, `-delta_3 - r` while it is touched and `r + delta_3` apart from it.
pub(super) const REAR: usize = 2;
/// Guard of sliding, the speed; at rest, how far the push is below the break-away force.
pub(super) const FORWARD: usize = 3;
/// At rest, how far the push is above minus the break-away force of backward motion.
pub(super) const BACKWARD: usize = 4;
/// With a release by force, the force of the front stop while it is touched, and minus what it would be beyond its place apart from it.
pub(super) const FRONT_FORCE: usize = 5;
/// The same of the rear stop.
pub(super) const REAR_FORCE: usize = 6;

/// Which field acts in each lane.
#[derive(Debug, Clone, Copy)]
pub struct GeneralMode<L: Lane> {
    /// Whether the mass touches the front stop.
    pub(super) front: L::Mask,
    /// Whether the mass touches the rear stop.
    pub(super) rear: L::Mask,
    /// Whether the mass is beyond the place of the front stop, which has let go of it.
    pub(super) beyond_front: L::Mask,
    /// Whether it is beyond that of the rear stop.
    pub(super) beyond_rear: L::Mask,
    /// Whether the force of the rigid stop has jumped below zero, so that it lets go at once.
    pub(super) let_go: L::Mask,
    /// Whether it has let go where its force fell to zero.
    pub(super) left: L::Mask,
    /// Direction of sliding, +1 or -1; 0 at rest.
    pub(super) slip: L,
    /// How many edges of the drive have passed in the cycle.
    pub(super) passed: L,
    /// The direction in which a force that has jumped breaks the capsule away at once, +1 or -1; else 0.
    pub(super) thrown: L,
}

side_by_side!(GeneralMode { slip, passed, thrown } masks { front, rear, beyond_front, beyond_rear, let_go, left });

impl<L: Lane> Default for GeneralMode<L> {
    fn default() -> Self {
        let (apart, zero) = (L::Mask::splat(false), L::splat(0.0));
        GeneralMode {
            front: apart,
            rear: apart,
            beyond_front: apart,
            beyond_rear: apart,
            let_go: apart,
            left: apart,
            slip: zero,
            passed: zero,
            thrown: zero,
        }
    }
}

impl<L: Lane> GeneralMode<L> {
    /// The stops that the mass touches.
    #[inline(always)]
    pub(super) fn touched(&self) -> Touched<L> {
        Touched { front: self.front, rear: self.rear }
    }

    /// Of the front stop, or of the rear one: where the mass touches it, where it is beyond its place without, and the events there, opening
    /// and closing.
    #[inline(always)]
    pub(super) fn contact(
        &mut self,
        is_front: bool,
    ) -> (&mut L::Mask, &mut L::Mask, [EventKind; 2]) {
        match is_front {
            true => (
                &mut self.front,
                &mut self.beyond_front,
                [EventKind::ContactOpened, EventKind::ContactClosed],
            ),
            false => (
                &mut self.rear,
                &mut self.beyond_rear,
                [EventKind::RearContactOpened, EventKind::RearContactClosed],
            ),
        }
    }

    /// Where the mass is beyond the place of the front stop.
    #[inline(always)]
    pub(super) fn is_in_front(&self) -> L::Mask {
        self.front | self.beyond_front
    }

    /// Where the mass is beyond the place of the rear stop.
    #[inline(always)]
    pub(super) fn is_in_rear(&self) -> L::Mask {
        self.rear | self.beyond_rear
    }

    /// Where the capsule slides.
    #[inline(always)]
    pub(super) fn slides(&self) -> L::Mask {
        L::splat(0.5).lt(self.slip * self.slip)
    }
}

/// Taylor series of a step of a capsule of the family, in the time since its start.
#[derive(Debug, Clone)]
pub struct GeneralJet<L> {
    /// The motion; it has no use for the phase of the drive.
    pub motion: Jet<L>,
    /// Force of the drive on the mass [N].
    pub drive: Series<L>,
    /// What moves the capsule but for the friction: F, less the reaction of the drive, and the forces along the ground [N].
    pub push: Series<L>,
    /// Velocity of the mass relative to the capsule [m/s].
    pub relative: Series<L>,
    pub(super) squares: Squares<L>,
    pub(super) folds: FoldSeries<L>,
    /// The place between two folds where the step begins, in spacings.
    pub(super) place: L,
    /// How long the next edge of the drive is away [s].
    pub(super) until_edge: L,
}

side_by_side!(GeneralJet { place, until_edge } with { motion, drive, push, relative, squares, folds });

impl<L: Lane> Default for GeneralJet<L> {
    #[inline(always)]
    fn default() -> Self {
        let zero = series::zero();
        GeneralJet {
            motion: Jet::default(),
            drive: zero,
            push: zero,
            relative: zero,
            squares: Squares::default(),
            folds: FoldSeries::default(),
            place: L::splat(0.0),
            until_edge: L::splat(0.0),
        }
    }
}

/// A guard that is due, with what its event changes.
pub(super) struct Due<'a, L: Lane> {
    /// In which lanes.
    pub(super) here: L::Mask,
    pub(super) mode: &'a mut GeneralMode<L>,
    pub(super) state: &'a mut State<L>,
    pub(super) zeros: &'a mut Zeros<L>,
    /// When, since the start of the cycle [s].
    pub(super) time: L,
}
