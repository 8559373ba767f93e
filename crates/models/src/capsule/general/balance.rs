//! The mean forces along the ground: what a periodic motion balances, and where none can.

use std::f64::consts::PI;

use capsulemap_engine::lane::Lane;

use super::drive::mean_and_largest;
use super::folds::Folds;
use super::ground::Ground;
use crate::capsule::parameter::Parameter;
use crate::capsule::shape::Shape;
use crate::description::Parameters;

/// A capsule whose mean force is not held runs away at the speed that all forces together would give it in so many cycles.
const CYCLES: f64 = 10.0;

/// The mean forces on mass and capsule together along the ground, and what holds them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance<L> {
    /// Of drive, gravity and load, forward positive: the mean friction of a motion that repeats [N].
    pub mean: L,
    /// Of gravity and load alone [N].
    pub along: L,
    /// The largest force that the drive may have [N].
    pub largest_drive: L,
    /// The friction at high speed against a motion in the direction of the mean, over folds its mean; infinite where there is drag [N].
    pub sliding: L,
    /// The larger of the forces at which the capsule breaks away, forward and backward; over folds the largest that this may be [N].
    pub break_away: L,
}

impl Balance<f64> {
    /// That of a capsule.
    pub fn of(parameters: &Parameters) -> Self {
        Balance::new(|it| parameters[it], Shape::of(parameters))
    }

    /// Whether friction holds the mean force while the capsule slides.
    pub fn holds(&self) -> bool {
        self.mean.abs() <= self.sliding
    }
}

impl<L: Lane> Balance<L> {
    /// That of capsules with these parameters, of one shape.
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape) -> Self {
        let (zero, far) = (L::splat(0.0), L::splat(f64::INFINITY));
        let ground = Ground::new(&of, shape);
        let [mean_drive, largest_drive] = mean_and_largest(&of, shape);
        let along = ground.push + ground.pull;
        let external = if shape.reacts() { zero } else { mean_drive };
        let mean = external + along;
        let against = ground.towards(mean);
        let folds = Folds::new(&of, shape);
        let (mut at_speed, mut at_top, mut fold) = (L::splat(1.0), L::splat(1.0), zero);
        if shape.over_folds {
            (at_speed, at_top) = (folds.mean_resistance(), folds.largest_resistance());
            fold = of(Parameter::FoldForce);
        }
        let drag = if shape.has_drag() { against.linear + against.quadratic } else { zero };
        let (forward, backward) = (ground.forward.break_away, ground.backward.break_away);
        Balance {
            mean,
            along,
            largest_drive,
            sliding: L::select(zero.lt(drag), far, against.dynamic * at_speed),
            break_away: forward.max(backward) * at_top + fold,
        }
    }

    /// The speed at which a capsule that slides in the direction of the mean force has run away; infinite where friction or drag holds
    /// that force [m/s].
    ///
    /// Method: while it slides on, mass and capsule together gain (mean force - sliding friction) times the period in each cycle,
    /// whatever the forces between them are. What brings it to rest again takes more than one cycle from a speed that is far above what
    /// the forces of a cycle give.
    pub(super) fn runaway_speed(&self, of: impl Fn(Parameter) -> L, shape: Shape) -> L {
        let mass = of(Parameter::M1) + of(Parameter::M2);
        let period = L::splat(2.0 * PI) / shape.frequency(&of);
        let force = self.largest_drive + self.break_away + self.along.abs();
        let speed = L::splat(CYCLES) * force * period / mass;
        L::select(self.mean.abs().le(self.sliding), L::splat(f64::INFINITY), speed)
    }
}
