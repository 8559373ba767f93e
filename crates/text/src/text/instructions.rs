//! The instructions by which values are computed, and what they are asked for.

use crate::text::function::Function;

/// The place of a number that is not a series.
pub type Scalar = usize;
/// The place of a series.
pub type Register = usize;

/// What computes a number that is not a series, into the next place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ScalarStep {
    /// A number.
    Number(f64),
    /// A parameter.
    Parameter(usize),
    /// A switch.
    Switch(usize),
    /// A pulse.
    Pulse(usize),
    /// The sign of the sliding of a friction.
    Sign(usize),
    /// a + b
    Add(Scalar, Scalar),
    /// a - b
    Sub(Scalar, Scalar),
    /// a b
    Mul(Scalar, Scalar),
    /// a/b
    Div(Scalar, Scalar),
    /// -a
    Neg(Scalar),
    /// A function of one number.
    Of(Function, Scalar),
    /// The greater one.
    Max(Scalar, Scalar),
    /// The lesser one.
    Min(Scalar, Scalar),
}

/// What computes a term of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SeriesStep {
    /// A constant as a series.
    Constant(Scalar),
    /// Time since the start of the cycle.
    Time,
    /// a + b
    Add(Register, Register),
    /// a - b
    Sub(Register, Register),
    /// -a
    Neg(Register),
    /// a + s
    AddConstant(Register, Scalar),
    /// s - a
    FromConstant(Scalar, Register),
    /// s a
    Scale(Scalar, Register),
    /// a + s b
    AddScaled(Register, Scalar, Register),
    /// s a + r b
    TwoScaled(Scalar, Register, Scalar, Register),
    /// A sum of scaled terms and a constant.
    Sum(Sum),
    /// a b
    Mul(Register, Register),
    /// a a
    Square(Register),
    /// a/b
    Div(Register, Register),
    /// The square root.
    Sqrt(Register),
    /// The exponential.
    Exp(Register),
    /// The natural logarithm.
    Log(Register),
    /// The sine, and in the next register the cosine.
    SinCos(Register),
    /// The same of s + r t.
    Rotation(Scalar, Scalar),
    /// The hyperbolic tangent, and in the next register one less its square.
    Tanh(Register),
    /// A friction, from its size while it slides and what it is at rest.
    Friction(usize, Register, Register),
}

/// The most terms of a sum that one instruction computes.
pub const MOST_TERMS: usize = 8;

/// A sum of scaled terms and a constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sum {
    /// The terms, of which those that there are come first.
    each: [(u16, u16); MOST_TERMS],
    /// How many there are.
    count: u8,
    /// What is added to the first order.
    pub constant: Option<u16>,
}

impl Sum {
    /// That of these terms.
    ///
    /// # Panics
    /// Where there are more than [`MOST_TERMS`]; a text has far fewer than 65 536 values.
    pub fn new(terms: &[(Scalar, Register)], constant: Option<Scalar>) -> Sum {
        let small = |place: usize| u16::try_from(place).expect("a text has few values");
        let mut each = [(0, 0); MOST_TERMS];
        for (own, (scalar, register)) in each[..terms.len()].iter_mut().zip(terms) {
            *own = (small(*scalar), small(*register));
        }
        Sum { each, count: terms.len() as u8, constant: constant.map(small) }
    }

    /// Its terms: the number and the series of each.
    #[inline(always)]
    pub fn terms(&self) -> &[(u16, u16)] {
        &self.each[..usize::from(self.count)]
    }
}

/// Where an exponential in a function is too small to be seen beside one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unseen {
    /// Where the argument is far below zero, as of the exponential itself.
    Below,
    /// Where its magnitude is large, as of the hyperbolic tangent.
    Beyond,
}

/// What computes a register, or two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instruction {
    /// The register, or the first of two.
    pub register: Register,
    /// How.
    pub step: SeriesStep,
    /// Whether earlier terms of it are asked for, or all of them.
    pub is_kept: bool,
    /// Whether it needs all terms of its operands and of itself.
    pub folds: bool,
    /// Whether it writes the next register, too.
    pub is_pair: bool,
}

impl SeriesStep {
    /// Whether it needs all terms of its operands and of itself.
    pub fn folds(self) -> bool {
        !matches!(
            self,
            SeriesStep::Constant(_)
                | SeriesStep::Time
                | SeriesStep::Add(..)
                | SeriesStep::Sub(..)
                | SeriesStep::Neg(_)
                | SeriesStep::AddConstant(..)
                | SeriesStep::FromConstant(..)
                | SeriesStep::Scale(..)
                | SeriesStep::AddScaled(..)
                | SeriesStep::TwoScaled(..)
                | SeriesStep::Sum(_)
                | SeriesStep::Rotation(..)
                | SeriesStep::Friction(..)
        )
    }

    /// The registers that it takes.
    pub fn operands(self) -> Vec<Register> {
        match self {
            SeriesStep::Constant(_) | SeriesStep::Time | SeriesStep::Rotation(..) => Vec::new(),
            SeriesStep::Add(a, b)
            | SeriesStep::Sub(a, b)
            | SeriesStep::Mul(a, b)
            | SeriesStep::Div(a, b)
            | SeriesStep::Friction(_, a, b)
            | SeriesStep::AddScaled(a, _, b)
            | SeriesStep::TwoScaled(_, a, _, b) => vec![a, b],
            SeriesStep::Sum(sum) => sum.terms().iter().map(|it| usize::from(it.1)).collect(),
            SeriesStep::AddConstant(a, _)
            | SeriesStep::FromConstant(_, a)
            | SeriesStep::Scale(_, a)
            | SeriesStep::Neg(a)
            | SeriesStep::Square(a)
            | SeriesStep::Sqrt(a)
            | SeriesStep::Exp(a)
            | SeriesStep::Log(a)
            | SeriesStep::SinCos(a)
            | SeriesStep::Tanh(a) => vec![a],
        }
    }

    /// How many registers it writes.
    #[inline(always)]
    pub fn registers(self) -> usize {
        match self {
            SeriesStep::SinCos(_) | SeriesStep::Rotation(..) | SeriesStep::Tanh(_) => 2,
            _ => 1,
        }
    }
}

/// A value of a text by where it is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A number.
    Scalar(Scalar),
    /// A series.
    Series(Register),
}

/// What a guard of the motion is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guard {
    /// An event by its place.
    Event(usize),
    /// A switch by its place.
    Switch(usize),
    /// A friction by its place: its sliding, or at rest what it holds forward.
    Forward(usize),
    /// A friction at rest by its place: what it holds backward.
    Backward(usize),
    /// The next edge of a pulse.
    Edge,
}

/// Where the values of a friction are computed.
#[derive(Debug, Clone)]
pub struct FrictionPlaces {
    /// What is zero at rest.
    pub of: Place,
    /// Its size while it slides.
    pub sliding: Place,
    /// What it can be at rest.
    pub holds: Place,
    /// What it is at rest.
    pub at_rest: Place,
    /// The state that is put where the friction rests, of those that it is of that with the largest factor, and this.
    pub leading: (usize, Scalar),
    /// The other states that it is of, with their factors.
    pub others: Vec<(usize, Scalar)>,
}

/// What a contact that lasts holds, and what presses on it.
#[derive(Debug, Clone, Copy)]
pub struct LastingPlaces {
    /// The state on the bound.
    pub state: usize,
    /// That which is its rate.
    pub velocity: usize,
    /// The rate of that, which would be without the contact.
    pub acceleration: Place,
    /// What makes of an acceleration one towards the bound: -1 where the motion is above it, else 1.
    pub towards: f64,
}

/// Where the motion is put on surfaces: a state and its value, by place.
#[derive(Debug, Clone, Default)]
pub struct Bounds {
    /// Of each switch.
    pub switches: Vec<Option<(usize, Scalar)>>,
    /// Of each event.
    pub events: Vec<Option<(usize, Scalar)>>,
}
