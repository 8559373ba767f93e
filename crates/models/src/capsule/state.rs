//! What the capsule's motion is made of: state, mode, event and the series of a step.

use std::fmt;

use serde::Serialize;

use capsulemap_engine::flow::Event;
use capsulemap_engine::lane::{Lane, Series, series, side_by_side};

use crate::description;

/// Positions and velocities [m, m/s].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct State<L> {
    /// Relative displacement of the mass, `x1 - x2` [m].
    pub r: L,
    /// Velocity of the mass [m/s].
    pub y1: L,
    /// Displacement of the capsule [m].
    pub x2: L,
    /// Velocity of the capsule [m/s].
    pub y2: L,
    /// Place of the capsule between two folds, in spacings from a top on [-]; zero on even ground.
    #[serde(skip)]
    pub place: L,
}

side_by_side!(State { r, y1, x2, y2, place });

/// What a state of the capsule is, by the names of its coordinates.
pub trait CapsuleState {
    /// It with its coordinates by their names.
    fn capsule(&self) -> State<f64>;
}

impl CapsuleState for description::State {
    fn capsule(&self) -> State<f64> {
        self.into()
    }
}

impl State<f64> {
    /// r, y1, x2 and y2, which are all on even ground.
    pub fn coordinates(&self) -> [f64; 4] {
        [self.r, self.y1, self.x2, self.y2]
    }
}

impl fmt::Display for State<f64> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let State { r, y1, x2, y2, .. } = self;
        write!(f, "r = {r} m, y1 = {y1} m/s, x2 = {x2} m, y2 = {y2} m/s")
    }
}

impl<L: Lane> State<L> {
    /// The state with these r, y1, x2 and y2, on even ground.
    #[inline(always)]
    pub fn of([r, y1, x2, y2]: [L; 4]) -> Self {
        State { r, y1, x2, y2, place: L::splat(0.0) }
    }

    /// The state of each lane.
    pub fn from_fn(mut state: impl FnMut(usize) -> State<f64>) -> Self {
        State {
            r: L::from_fn(|i| state(i).r),
            y1: L::from_fn(|i| state(i).y1),
            x2: L::from_fn(|i| state(i).x2),
            y2: L::from_fn(|i| state(i).y2),
            place: L::from_fn(|i| state(i).place),
        }
    }
}

/// What happens where a mode ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum EventKind {
    /// The mass reaches the stop: an impact.
    ContactClosed = 1,
    /// The mass leaves the stop.
    ContactOpened,
    /// The capsule starts to slide forward from rest.
    SlipForward,
    /// The capsule starts to slide backward from rest.
    SlipBackward,
    /// The capsule comes to rest.
    Stick,
    /// The capsule turns round without resting.
    Reversal,
    /// The mass reaches the rear stop.
    RearContactClosed,
    /// The mass leaves the rear stop.
    RearContactOpened,
    /// The drive passes an edge.
    DriveEdge,
}

impl Event for EventKind {
    const ALL: &'static [Self] = &[
        EventKind::ContactClosed,
        EventKind::ContactOpened,
        EventKind::SlipForward,
        EventKind::SlipBackward,
        EventKind::Stick,
        EventKind::Reversal,
        EventKind::RearContactClosed,
        EventKind::RearContactOpened,
        EventKind::DriveEdge,
    ];

    #[inline(always)]
    fn number(self) -> u8 {
        self as u8
    }

    fn is_impact(self) -> bool {
        matches!(self, EventKind::ContactClosed | EventKind::RearContactClosed)
    }

    fn is_timed(self) -> bool {
        self == EventKind::DriveEdge
    }
}

/// Where the event of this code is of a kind.
#[inline(always)]
pub(in crate::capsule) fn is_event<L: Lane>(code: L, kind: EventKind) -> L::Mask {
    (code - kind.code()).abs().lt(L::splat(0.5))
}

/// Taylor series of a step of the capsule, in the time since its start.
#[derive(Debug, Clone)]
pub struct Jet<L> {
    /// Relative displacement [m].
    pub r: Series<L>,
    /// Velocity of the mass [m/s].
    pub y1: Series<L>,
    /// Displacement of the capsule [m].
    pub x2: Series<L>,
    /// Velocity of the capsule as a state [m/s].
    pub y2: Series<L>,
    /// Force of the mass on the capsule, F [N].
    pub force: Series<L>,
    /// `exp(-|y2|/v_s)`, or zero where the law of resistance has no such term [-].
    pub decay: Series<L>,
    /// The exponent `-|y2|/v_s` of numbers with derivatives, else zero [-].
    pub exponent: Series<L>,
    /// `cos` of the phase of the drive [-].
    pub cos: Series<L>,
    /// Acceleration of the capsule, known to one order less [m/s^2].
    pub acceleration: Series<L>,
}

side_by_side!(Jet {} with { r, y1, x2, y2, force, decay, exponent, cos, acceleration });

impl<L: Lane> Default for Jet<L> {
    #[inline(always)]
    fn default() -> Self {
        let zero = series::zero();
        Jet {
            r: zero,
            y1: zero,
            x2: zero,
            y2: zero,
            force: zero,
            decay: zero,
            exponent: zero,
            cos: zero,
            acceleration: zero,
        }
    }
}

impl<L: Lane> Jet<L> {
    /// The state `h` after the start of the step.
    #[inline(always)]
    pub fn state(&self, h: L) -> State<L> {
        State::of([
            series::value(&self.r, h),
            series::value(&self.y1, h),
            series::value(&self.x2, h),
            series::value(&self.y2, h),
        ])
    }

    /// The state at the start of the step.
    #[inline(always)]
    pub fn beginning(&self) -> State<L> {
        State::of([self.r[0], self.y1[0], self.x2[0], self.y2[0]])
    }

    /// The state `h` after the start of the step, and the slopes of the series there; side by side, as they
    /// do not wait for each other.
    #[inline(always)]
    pub fn motion(&self, h: L) -> (State<L>, State<L>) {
        let series = [&self.r, &self.y1, &self.x2, &self.y2];
        let (mut values, mut slopes) = ([L::splat(0.0); 4], [L::splat(0.0); 4]);
        for k in (0..series::ORDER + 1).rev() {
            for i in 0..4 {
                slopes[i] = slopes[i] * h + values[i];
                values[i] = values[i] * h + series[i][k];
            }
        }
        (State::of(values), State::of(slopes))
    }
}
