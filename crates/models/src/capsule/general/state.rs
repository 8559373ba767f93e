//! What a motion of the family is made of beside the state: mode and series.

use capsulemap_engine::lane::{Lane, Mask, Series, series, side_by_side};

use super::springs::{Squares, Touched};
use crate::capsule::state::Jet;

/// Which field acts in each lane.
#[derive(Debug, Clone, Copy)]
pub struct GeneralMode<L: Lane> {
    /// Whether the mass touches the front stop.
    pub(super) front: L::Mask,
    /// Whether the mass touches the rear stop.
    pub(super) rear: L::Mask,
    /// Direction of sliding, +1 or -1; 0 at rest.
    pub(super) slip: L,
    /// How many edges of the drive have passed in the cycle.
    pub(super) passed: L,
    /// The direction in which a force that has jumped breaks the capsule away at once, +1 or -1; else 0.
    pub(super) thrown: L,
}

side_by_side!(GeneralMode { slip, passed, thrown } masks { front, rear });

impl<L: Lane> Default for GeneralMode<L> {
    fn default() -> Self {
        let (apart, zero) = (L::Mask::splat(false), L::splat(0.0));
        GeneralMode { front: apart, rear: apart, slip: zero, passed: zero, thrown: zero }
    }
}

impl<L: Lane> GeneralMode<L> {
    /// The stops that the mass touches.
    #[inline(always)]
    pub(super) fn touched(&self) -> Touched<L> {
        Touched { front: self.front, rear: self.rear }
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
    /// How long the next edge of the drive is away [s].
    pub(super) until_edge: L,
}

side_by_side!(GeneralJet { until_edge } with { motion, drive, push, relative, squares });

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
            until_edge: L::splat(0.0),
        }
    }
}
