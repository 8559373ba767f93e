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
    /// a - s b
    SubScaled(Register, Scalar, Register),
    /// s a + r b
    TwoScaled(Scalar, Register, Scalar, Register),
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
                | SeriesStep::SubScaled(..)
                | SeriesStep::TwoScaled(..)
                | SeriesStep::Rotation(..)
                | SeriesStep::Friction(..)
        )
    }

    /// The registers and the numbers that it takes, two of each; where it takes fewer, any others.
    #[inline(always)]
    pub fn operands(self) -> ([Register; 2], [Scalar; 2]) {
        match self {
            SeriesStep::Constant(s) => ([0, 0], [s, 0]),
            SeriesStep::Time => ([0, 0], [0, 0]),
            SeriesStep::Rotation(s, r) => ([0, 0], [s, r]),
            SeriesStep::Add(a, b)
            | SeriesStep::Sub(a, b)
            | SeriesStep::Mul(a, b)
            | SeriesStep::Div(a, b)
            | SeriesStep::Friction(_, a, b) => ([a, b], [0, 0]),
            SeriesStep::AddConstant(a, s)
            | SeriesStep::FromConstant(s, a)
            | SeriesStep::Scale(s, a) => ([a, 0], [s, 0]),
            SeriesStep::AddScaled(a, s, b) | SeriesStep::SubScaled(a, s, b) => ([a, b], [s, 0]),
            SeriesStep::TwoScaled(s, a, r, b) => ([a, b], [s, r]),
            SeriesStep::Neg(a)
            | SeriesStep::Square(a)
            | SeriesStep::Sqrt(a)
            | SeriesStep::Exp(a)
            | SeriesStep::Log(a)
            | SeriesStep::SinCos(a)
            | SeriesStep::Tanh(a) => ([a, 0], [0, 0]),
        }
    }

    /// The registers that it takes, without others.
    pub fn series_operands(self) -> Vec<Register> {
        let ([a, b], _) = self.operands();
        match self {
            SeriesStep::Constant(_) | SeriesStep::Time | SeriesStep::Rotation(..) => Vec::new(),
            SeriesStep::Add(..)
            | SeriesStep::Sub(..)
            | SeriesStep::Mul(..)
            | SeriesStep::Div(..)
            | SeriesStep::Friction(..)
            | SeriesStep::AddScaled(..)
            | SeriesStep::SubScaled(..)
            | SeriesStep::TwoScaled(..) => vec![a, b],
            _ => vec![a],
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
