//! A simulated motion at given times, as sensors would see it, with exact derivatives in parameters and in the start.

use std::marker::PhantomData;

use crate::capsule::{
    AsPrinted, CapsuleParameters as _, DriveSeries, Filippov, Form, General, Jet, Locomotion,
    OverFolds, Parameter, Parameters, Reading, State,
};
use crate::motion::reduced;
use crate::quantity::Dimension;
pub use crate::samples::Samples;
use crate::samples::{Sampled, samples};
use capsulemap_engine::flow::{
    Motion, Reason, STEPS_PER_CYCLE, Step, Stroboscopic, Switched, cycle,
};
use capsulemap_engine::lane::{Lane, series};

/// What a sensor sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signal {
    /// Displacement of the mass [m].
    X1,
    /// Displacement of the capsule [m].
    X2,
    /// Relative displacement [m].
    R,
    /// Velocity of the mass [m/s].
    Y1,
    /// Velocity of the capsule [m/s].
    Y2,
    /// Acceleration of the mass [m/s^2].
    A1,
    /// Force of the drive [N].
    Drive,
}

impl Signal {
    /// All of them.
    pub const ALL: [Signal; 7] =
        [Signal::X1, Signal::X2, Signal::R, Signal::Y1, Signal::Y2, Signal::A1, Signal::Drive];

    /// Its name in recordings.
    pub fn name(self) -> &'static str {
        match self {
            Signal::X1 => "x1",
            Signal::X2 => "x2",
            Signal::R => "r",
            Signal::Y1 => "y1",
            Signal::Y2 => "y2",
            Signal::A1 => "a1",
            Signal::Drive => "drive",
        }
    }

    /// What it measures.
    pub fn dimension(self) -> Dimension {
        match self {
            Signal::X1 | Signal::X2 | Signal::R => Dimension::Length,
            Signal::Y1 | Signal::Y2 => Dimension::Velocity,
            Signal::A1 => Dimension::Acceleration,
            Signal::Drive => Dimension::Force,
        }
    }

    /// What it is, in a phrase.
    pub fn meaning(self) -> &'static str {
        match self {
            Signal::X1 => "displacement of the mass",
            Signal::X2 => "displacement of the capsule",
            Signal::R => "relative displacement",
            Signal::Y1 => "velocity of the mass",
            Signal::Y2 => "velocity of the capsule",
            Signal::A1 => "acceleration of the mass",
            Signal::Drive => "force of the drive",
        }
    }

    /// Its value in the series of a step, `h` after its beginning.
    fn read<L: Lane>(self, jet: &Jet<L>, h: L, drive: &DriveSeries<'_, L>) -> L {
        match self {
            Signal::X1 => series::value(&jet.r, h) + series::value(&jet.x2, h),
            Signal::X2 => series::value(&jet.x2, h),
            Signal::R => series::value(&jet.r, h),
            Signal::Y1 => series::value(&jet.y1, h),
            Signal::Y2 => series::value(&jet.y2, h),
            Signal::A1 => series::value_and_slope(&jet.y1, h).1,
            Signal::Drive => drive.unit * series::value(drive.force, h),
        }
    }
}

/// What a motion can be differentiated in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Direction {
    /// A parameter of the model.
    Parameter(Parameter),
    /// The relative displacement at the start.
    StartR,
    /// The velocity of the mass at the start.
    StartY1,
    /// The displacement of the capsule at the start.
    StartX2,
    /// The velocity of the capsule at the start.
    StartY2,
    /// The phase of the drive at the start.
    StartPhase,
}

/// A motion from its start.
#[derive(Debug, Clone, PartialEq)]
pub struct Started {
    /// The parameters.
    pub parameters: Parameters,
    /// Where it starts.
    pub start: State<f64>,
    /// Phase of the drive at the start [rad].
    pub phase: f64,
}

impl Started {
    /// The same with another value in one direction.
    pub fn with(&self, direction: Direction, value: f64) -> Started {
        let mut other = self.clone();
        match direction {
            Direction::Parameter(parameter) => other.parameters[parameter] = value,
            Direction::StartR => other.start.r = value,
            Direction::StartY1 => other.start.y1 = value,
            Direction::StartX2 => other.start.x2 = value,
            Direction::StartY2 => other.start.y2 = value,
            Direction::StartPhase => other.phase = value,
        }
        other
    }

    /// Its value in a direction.
    pub fn value(&self, direction: Direction) -> f64 {
        match direction {
            Direction::Parameter(parameter) => self.parameters[parameter],
            Direction::StartR => self.start.r,
            Direction::StartY1 => self.start.y1,
            Direction::StartX2 => self.start.x2,
            Direction::StartY2 => self.start.y2,
            Direction::StartPhase => self.phase,
        }
    }
}

/// The `signals` of a motion at `times` since its start [s], which increase from zero or later, and their derivatives in
/// `directions`.
///
/// # Method
///
/// The motion is followed in numbers with derivatives, four directions at a time, event times included, so that the jumps
/// that impact, slip and stick put into the linearised flow are in them. A sample is read from the series of the step
/// that it lies in, at a time since its beginning that depends on the directions as that beginning does.
///
/// # Guarantees
///
/// Errors of the order of `tolerance`, in the derivatives too, relative to their sizes.
///
/// # Breaks
///
/// Fails where the motion cannot be followed. Where an event falls on another or a surface is only touched, the
/// derivatives are those of the side that the motion takes.
pub fn sampled(
    motion: &Started,
    times: &[f64],
    signals: &[Signal],
    directions: &[Direction],
    tolerance: f64,
) -> Result<Samples, Reason> {
    let mut parts = motion.clone();
    for direction in directions {
        if let Direction::Parameter(parameter) = direction {
            parts.parameters = parts.parameters.with_part((*parameter).into());
        }
    }
    let of_form = match parts.parameters.form() {
        Form::Filippov => sampled_as::<Filippov, 3>,
        Form::AsPrinted => sampled_as::<AsPrinted, 3>,
        Form::General => sampled_as::<General, 3>,
        Form::OverFolds => sampled_as::<OverFolds, 4>,
    };
    of_form(&parts, times, signals, directions, tolerance)
}

/// A motion with what is read of it, and how its equations are written.
struct AsForm<'a, R, const D: usize> {
    motion: &'a Started,
    times: &'a [f64],
    signals: &'a [Signal],
    tolerance: f64,
    form: PhantomData<R>,
}

fn sampled_as<R: Reading<D>, const D: usize>(
    motion: &Started,
    times: &[f64],
    signals: &[Signal],
    directions: &[Direction],
    tolerance: f64,
) -> Result<Samples, Reason> {
    let form = PhantomData::<R>;
    samples(&AsForm { motion, times, signals, tolerance, form }, directions)
}

impl<R: Reading<D>, const D: usize> Sampled<Direction> for AsForm<'_, R, D> {
    fn value(&self, direction: Direction) -> f64 {
        self.motion.value(direction)
    }

    fn followed<L: Lane>(&self, of: impl Fn(Direction) -> L) -> Result<Vec<Vec<L>>, Reason> {
        let AsForm { motion, times, signals, tolerance, .. } = *self;
        let shape = motion.parameters.shape();
        let system = R::capsule::<L>(|it| of(Direction::Parameter(it)), shape, 0.0);
        let start = State {
            r: of(Direction::StartR),
            y1: of(Direction::StartY1),
            x2: of(Direction::StartX2),
            y2: of(Direction::StartY2),
            place: L::splat(motion.start.place),
        };
        // The phase within a turn, with the derivative of the phase itself.
        let turns = L::splat(reduced(motion.phase) - motion.phase);
        let omega = shape.frequency(|it| of(Direction::Parameter(it)));
        let begins = (of(Direction::StartPhase) + turns) / omega;
        let mut sampler = Sampler {
            times,
            signals,
            began: -begins,
            values: vec![Vec::with_capacity(times.len()); signals.len()],
            next: 0,
        };
        let mut course = Motion::new(&system, begins, start);
        let mut step = Step::default();
        while sampler.next < times.len() {
            let limits = (STEPS_PER_CYCLE, tolerance);
            let duration = cycle(&system, &mut course, &mut step, limits, |step| {
                sampler.see::<R, D>(&system, step);
            })?;
            sampler.began = sampler.began + duration;
        }
        Ok(sampler.values)
    }
}

struct Sampler<'a, L> {
    times: &'a [f64],
    signals: &'a [Signal],
    /// When the cycle began, since the start of the motion [s].
    began: L,
    values: Vec<Vec<L>>,
    next: usize,
}

impl<L: Lane> Sampler<'_, L> {
    /// Reads the samples that lie in a step.
    fn see<R: Reading<D>, const D: usize>(&mut self, system: &R::In<L>, step: &Step<L, R::In<L>>)
    where
        R::In<L>: Stroboscopic<L, D> + Switched<L> + Locomotion<L>,
    {
        let (jet, drive) = (system.jet(&step.jet), system.drive(&step.jet));
        while let Some(&time) = self.times.get(self.next) {
            let since = L::splat(time) - (self.began + step.start);
            if step.length.lane(0) < since.lane(0) {
                return;
            }
            // A sample that rounding puts just before its step lies at its beginning.
            for (signal, values) in self.signals.iter().zip(&mut self.values) {
                values.push(signal.read(jet, since, &drive));
            }
            self.next += 1;
        }
    }
}
