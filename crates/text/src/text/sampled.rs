//! The states of a motion of a text at given times, with exact derivatives in parameters, in the start and in the phase of the drive.

use std::f64::consts::TAU;

use capsulemap_engine::flow::{Breakdown, Motion, Reason, STEPS_PER_CYCLE, Step, Switched};
use capsulemap_engine::lane::{Lane, Mask, series};
use capsulemap_models::description::{Parameter, Parameters, State};
pub use capsulemap_models::samples::Samples;
use capsulemap_models::samples::{Sampled, samples};

use crate::text::content::Section;
use crate::text::described::program_of;
use crate::text::model::{FEW, MANY, PLACES, PLACES_OF_FEW};
use crate::text::oscillator::Oscillator;
use crate::text::program::Program;

/// What a motion can be differentiated in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Direction {
    /// A parameter of the model.
    Parameter(Parameter),
    /// A state at the start, by its place.
    Start(usize),
    /// The phase of the drive at time zero.
    Phase,
}

/// A motion from its start.
#[derive(Debug, Clone, PartialEq)]
pub struct Started {
    /// The parameters, of the model of a text.
    pub parameters: Parameters,
    /// Where it starts.
    pub start: State,
    /// Phase of the drive at time zero [rad]; without effect on an autonomous system.
    pub phase: f64,
    /// When it starts, since time zero [s].
    pub time: f64,
}

impl Started {
    /// Of a case that starts at time zero, at this phase of the drive [rad].
    pub fn new(parameters: Parameters, start: State, phase: f64) -> Started {
        Started { parameters, start, phase, time: 0.0 }
    }

    /// The same with another value in one direction.
    pub fn with(&self, direction: Direction, value: f64) -> Started {
        let mut other = self.clone();
        match direction {
            Direction::Parameter(parameter) => other.parameters[parameter] = value,
            Direction::Start(place) => {
                let mut values = self.start.values().to_vec();
                values[place] = value;
                other.start = State::new(self.start.model(), &values);
            }
            Direction::Phase => other.phase = value,
        }
        other
    }

    /// Its value in a direction.
    pub fn value(&self, direction: Direction) -> f64 {
        match direction {
            Direction::Parameter(parameter) => self.parameters[parameter],
            Direction::Start(place) => self.start.values()[place],
            Direction::Phase => self.phase,
        }
    }
}

/// The states at some places, the `columns`, of a motion at `times` since its start [s], which increase from zero or later, and their
/// derivatives in `directions`.
///
/// # Method
///
/// The motion is followed in numbers with derivatives, four directions at a time, event times included, so that the jumps
/// that resets, switches, slip and stick put into the linearised flow are in them. A sample is read from the series of the step
/// that it lies in, at a time since its beginning that depends on the directions as that beginning does. The motion is followed no
/// further than to the last sample; one of an autonomous system need not come back to its section.
///
/// # Guarantees
///
/// Errors of the order of `tolerance`, in the derivatives too, relative to their sizes.
///
/// # Breaks
///
/// Fails where the motion cannot be followed. Where an event falls on another or a surface is only touched, the
/// derivatives are those of the side that the motion takes.
///
/// # Panics
///
/// Where the parameters are not those of a text.
// Inlined into another crate, it would have its numbers compiled there once more.
#[inline(never)]
pub fn sampled(
    motion: &Started,
    times: &[f64],
    columns: &[usize],
    directions: &[Direction],
    tolerance: f64,
) -> Result<Samples, Reason> {
    let program = program_of(motion.parameters.model());
    let is_driven = matches!(program.text.section, Section::Every(_));
    let of_kind = match (is_driven, program.room) {
        (true, FEW) => sampled_as::<FEW, PLACES_OF_FEW, false>,
        (false, FEW) => sampled_as::<FEW, PLACES_OF_FEW, true>,
        (true, _) => sampled_as::<MANY, PLACES, false>,
        (false, _) => sampled_as::<MANY, PLACES, true>,
    };
    of_kind(program, motion, Asked { times, columns }, directions, tolerance)
}

/// A motion with what is read of it, and its program.
struct OfProgram<'a, const D: usize, const N: usize, const AUTONOMOUS: bool> {
    program: &'static Program,
    motion: &'a Started,
    asked: Asked<'a>,
    tolerance: f64,
}

fn sampled_as<const D: usize, const N: usize, const AUTONOMOUS: bool>(
    program: &'static Program,
    motion: &Started,
    asked: Asked<'_>,
    directions: &[Direction],
    tolerance: f64,
) -> Result<Samples, Reason> {
    samples(&OfProgram::<D, N, AUTONOMOUS> { program, motion, asked, tolerance }, directions)
}

impl<const D: usize, const N: usize, const AUTONOMOUS: bool> Sampled<Direction>
    for OfProgram<'_, D, N, AUTONOMOUS>
{
    fn value(&self, direction: Direction) -> f64 {
        self.motion.value(direction)
    }

    fn followed<L: Lane>(&self, of: impl Fn(Direction) -> L) -> Result<Vec<Vec<L>>, Reason> {
        let sampler = Sampler::new(self.asked);
        sampler.followed::<D, N, AUTONOMOUS>(self.program, self.motion, of, self.tolerance)
    }
}

/// When a motion starts since the last passage of the phase zero, where the period and the phase are numbers of any kind.
fn start_in_cycle<L: Lane>(motion: &Started, period: L, phase: L) -> L {
    let turns = (motion.phase / TAU + motion.time / period.lane(0)).floor();
    let begins = (phase / L::splat(TAU) - L::splat(turns)) * period + L::splat(motion.time);
    let value = begins.lane(0);
    // By rounding a start on the phase zero may be just before it, or a whole turn behind it.
    let is_within = (0.0..period.lane(0)).contains(&value);
    if is_within { begins } else { begins - L::splat(value) }
}

/// What is read of a motion, and when.
#[derive(Clone, Copy)]
struct Asked<'a> {
    /// Times since the start [s].
    times: &'a [f64],
    /// States by their places.
    columns: &'a [usize],
}

/// What has been read of a motion, in numbers of one kind.
struct Sampler<'a, L> {
    asked: Asked<'a>,
    /// When the cycle began, since the start of the motion [s].
    began: L,
    values: Vec<Vec<L>>,
    next: usize,
}

impl<'a, L: Lane> Sampler<'a, L> {
    fn new(asked: Asked<'a>) -> Self {
        let values = vec![Vec::with_capacity(asked.times.len()); asked.columns.len()];
        Sampler { asked, began: L::splat(0.0), values, next: 0 }
    }

    /// The states in a motion whose values are those `of` directions, by column and time.
    fn followed<const D: usize, const N: usize, const AUTONOMOUS: bool>(
        mut self,
        program: &'static Program,
        motion: &Started,
        of: impl Fn(Direction) -> L,
        tolerance: f64,
    ) -> Result<Vec<Vec<L>>, Reason> {
        let parameters = motion.parameters.each().map(|it| of(Direction::Parameter(it.0)));
        let parameters: Vec<L> = parameters.collect();
        let system = Oscillator::<L, D, N, AUTONOMOUS>::new(program, &parameters, 0.0);
        let mut start = [L::splat(0.0); N];
        for (place, at) in program.layout.iter().enumerate() {
            start[*at] = of(Direction::Start(place));
        }
        let period = system.period();
        let begins = match AUTONOMOUS {
            true => L::splat(0.0),
            false => start_in_cycle(motion, period, of(Direction::Phase)),
        };
        self.began = -begins;
        let mut course = Motion::new(&system, begins, start);
        let mut step = Step::default();
        let mut steps = 0;
        while self.next < self.asked.times.len() {
            course.single_step(&system, period, tolerance, &mut step);
            steps += 1;
            self.see(&step);
            match course.breakdown(&system, &step, 0) {
                // What does not come back to its section goes on all the same.
                None | Some(Breakdown::NoReturn) => {}
                Some(breakdown) => return Err(breakdown.into()),
            }
            let is_late = AUTONOMOUS && period.lane(0) <= course.time.lane(0);
            if step.arrives.lane(0) || is_late {
                self.began = self.began + course.time;
                course.begin_cycle(&system, L::Mask::splat(true));
                steps = 0;
            }
            if steps == STEPS_PER_CYCLE {
                return Err(Reason::TooManySteps);
            }
        }
        Ok(self.values)
    }

    /// Reads the samples that lie in a step.
    fn see<const D: usize, const N: usize, const AUTONOMOUS: bool>(
        &mut self,
        step: &Step<L, Oscillator<L, D, N, AUTONOMOUS>>,
    ) {
        while let Some(&time) = self.asked.times.get(self.next) {
            let since = L::splat(time) - (self.began + step.start);
            if step.length.lane(0) < since.lane(0) {
                return;
            }
            // A sample that rounding puts just before its step lies at its beginning.
            for (column, values) in self.asked.columns.iter().zip(&mut self.values) {
                values.push(series::value(&step.jet.registers[*column], since));
            }
            self.next += 1;
        }
    }
}
