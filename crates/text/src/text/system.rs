//! The system of a text by its parameters, from which the engine makes the oscillator in numbers of any kind.

use std::ptr;

use capsulemap_engine::flow::{Metric, System};
use capsulemap_engine::lane::Lane;

use crate::text::content::Section;
use crate::text::instructions::Place;
use crate::text::interpreter::at;
use crate::text::mode::{TextEvent, TextMode};
use crate::text::oscillator::{Oscillator, Values};
use crate::text::program::Program;
use crate::text::sums::Sums;

/// The system of a text, driven or autonomous: `D` coordinates on its section, states in `N` places.
#[derive(Debug, Clone)]
pub struct TextSystem<const D: usize, const N: usize, const AUTONOMOUS: bool> {
    program: &'static Program,
    /// The values of its parameters.
    values: Vec<f64>,
    /// How long after the start of a period its section is [periods].
    turns: f64,
}

/// A driven system.
pub type Driven<const D: usize, const N: usize> = TextSystem<D, N, false>;
/// An autonomous system.
pub type Autonomous<const D: usize, const N: usize> = TextSystem<D, N, true>;

impl<const D: usize, const N: usize, const AUTONOMOUS: bool> TextSystem<D, N, AUTONOMOUS> {
    /// The system of a program with its defaults, seen where a period begins.
    ///
    /// # Panics
    /// Where the program has room for another number of coordinates, or a section of the other kind.
    pub fn new(program: &'static Program) -> Self {
        let is_autonomous = matches!(program.text.section, Section::When { .. });
        assert!(program.room == D && N == D + 2, "the program has room for {}", program.room);
        assert!(is_autonomous == AUTONOMOUS, "the section of the text is of the other kind");
        let values = program.text.parameters.iter().map(|it| it.default).collect();
        TextSystem { program, values, turns: 0.0 }
    }

    /// The same seen so many turns later, from 0 to below 1.
    pub fn seen_at(self, turns: f64) -> Self {
        TextSystem { turns, ..self }
    }

    /// The program of its text.
    pub fn program(&self) -> &'static Program {
        self.program
    }

    /// The values of its parameters.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The same with these values of its parameters.
    ///
    /// # Panics
    /// Where there is not one for each.
    pub fn with_values(self, values: Vec<f64>) -> Self {
        assert!(values.len() == self.values.len(), "a value for each parameter");
        TextSystem { values, ..self }
    }

    /// The same with another value of the parameter called `name`.
    ///
    /// # Panics
    /// Where there is none.
    pub fn with_named(&self, name: &str, value: f64) -> Self {
        self.with(self.parameter(name).expect("the name of a parameter"), value)
    }

    /// The place of the parameter called `name`.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.program.text.parameters.iter().position(|it| it.name == name)
    }
}

impl<const D: usize, const N: usize, const AUTONOMOUS: bool> PartialEq
    for TextSystem<D, N, AUTONOMOUS>
{
    fn eq(&self, other: &Self) -> bool {
        self.shares_all_but_parameters(other) && self.values == other.values
    }
}

impl<const D: usize, const N: usize, const AUTONOMOUS: bool> System<D>
    for TextSystem<D, N, AUTONOMOUS>
{
    const IS_INTERPRETED: bool = true;

    type Parameter = usize;
    type Event = TextEvent;
    type State<L: Lane> = [L; N];
    type Mode<L: Lane> = TextMode<L>;
    type Single = Oscillator<f64, D, N, AUTONOMOUS>;
    type In<L: Lane> = Oscillator<L, D, N, AUTONOMOUS>;
    type Observer = Sums<f64>;
    type Observers<L: Lane> = Sums<L>;

    fn single(&self) -> Self::Single {
        self.constant()
    }

    fn system<L: Lane>(&self, of: impl Fn(usize) -> L) -> Oscillator<L, D, N, AUTONOMOUS> {
        let values: Vec<L> = (0..self.values.len()).map(of).collect();
        Oscillator::new(self.program, &values, self.turns)
    }

    fn has(&self, parameter: usize) -> bool {
        parameter < self.values.len()
    }

    fn value(&self, parameter: usize) -> f64 {
        self.values[parameter]
    }

    fn with(&self, parameter: usize, value: f64) -> Self {
        let mut other = self.clone();
        other.values[parameter] = value;
        other
    }

    fn metric(&self) -> Metric<D> {
        let scales: [f64; N] = self.program.scales(self.period());
        Metric::new(std::array::from_fn(|i| scales[i]))
    }

    fn gained(observed: &Sums<f64>) -> Option<f64> {
        Some(observed.advance())
    }

    fn observer(&self, _points: usize) -> Sums<f64> {
        Sums::none(self.program)
    }

    fn is_alike(&self, other: &Self) -> bool {
        ptr::eq(self.program, other.program)
    }

    fn shares_all_but_parameters(&self, other: &Self) -> bool {
        self.is_alike(other) && self.turns == other.turns
    }
}

impl<const D: usize, const N: usize, const AUTONOMOUS: bool> TextSystem<D, N, AUTONOMOUS> {
    /// Whether a state is behind the bound of an event, so that no motion starts there.
    pub fn is_behind(&self, time: f64, state: [f64; N]) -> bool {
        let single = self.single();
        let mut values = Values::room();
        single.compute(&mut values, &TextMode::default(), time, &state);
        let value = |place: &Place| at(*place, &values.numbers, &values.registers);
        self.program.lasts.iter().any(|it| value(it) < 0.0)
    }

    /// The period of the section, or the longest time that is waited for it.
    fn period(&self) -> f64 {
        capsulemap_engine::flow::Switched::period(&self.single())
    }
}
