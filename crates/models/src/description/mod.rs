//! What a model says of itself in words that do not depend on it: parameters and choices by name, and values of them.

pub mod choice;
mod faults;
pub mod motion;
pub mod output;
mod own;
pub mod parameter;
pub mod parameters;
pub mod phases;
pub mod roles;
pub mod rules;
pub mod section;
pub mod state;

use std::any::Any;
use std::fmt::{self, Debug, Formatter};

use crate::quantity::Quantity;

pub use choice::Choice;
pub use motion::{Chart, MotionDescription, Signal, SignalGroup, SignalKind, Source};
pub use output::{Kept, Output, OutputDescription, Outputs};
pub use own::{Definitions, OwnOutputs};
pub use parameter::{Parameter, ParameterDescription, Presence};
pub use parameters::{Fault, Parameters};
pub use roles::{DriveRoles, Roles, SpectrumRoles, TradeOffRoles};
pub use rules::{NotGiven, Remark, Rules, Threshold};
pub use section::{MOST_COORDINATES, Section};
pub use state::{CoordinateDescription, State, StateCoordinate};

/// What a model says of itself.
pub struct Description {
    /// Its name in studies and files.
    pub name: &'static str,
    /// The model whose parameters, choices, coordinates and outputs it has as its first ones, if there is one: they are the same.
    pub extends: Option<&'static Description>,
    /// Its parameters, in the order of tables and files.
    pub parameters: &'static [ParameterDescription],
    /// What is chosen beside the values of parameters, as the law of a force.
    pub choices: &'static [Choice],
    /// The coordinates of its state, in the order of section points.
    pub coordinates: &'static [CoordinateDescription],
    /// The coordinate that drifts, by its place among them, on which no motion depends: section points do not have it.
    pub drift: Option<usize>,
    /// The coordinates of section points, by their places among them; of the others, those that do not drift are zero on the section.
    pub on_section: &'static [usize],
    /// The coordinates of a point of the section, which a drive passes once a cycle, and other systems where they say.
    pub section: &'static [Quantity],
    /// As what the coordinates of section points are compared with each other, in words.
    pub compared_as: &'static [&'static str],
    /// The parts of the direction of the family of a neutral orbit, as they are compared.
    pub neutral: &'static [Quantity],
    /// The section coordinates of a saddle between two basins.
    pub edge: &'static [Quantity],
    /// The section coordinates of where a case was last.
    pub end: &'static [Quantity],
    /// What it says of a motion over time.
    pub motion: MotionDescription,
    /// The numbers that sum up a case, in the order of tables and files.
    pub outputs: &'static [OutputDescription],
    /// What some of them are for.
    pub roles: Roles,
    /// What it says of values beside each other.
    pub rules: Rules,
    /// The equations of its systems, where they are given as a text; none where the program has them.
    pub equations: Option<Equations>,
    /// The outputs that a study defines, behind those of the model that it extends; none where a study defines none.
    pub own: Option<OwnOutputs>,
}

/// Equations that are given as a text.
#[derive(Clone, Copy)]
pub struct Equations {
    /// They, for those who know what they are.
    pub content: &'static (dyn Any + Send + Sync),
    /// The tables of a study that say them, which differ where they do.
    pub tables: &'static str,
}

impl Debug for Equations {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Equations").field(&self.tables).finish()
    }
}

/// A description is one only with itself.
impl PartialEq for Description {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Eq for Description {}

impl Debug for Description {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Description").field(&self.name).finish()
    }
}

impl Description {
    /// Whether what one of two models has at a place is what the other has there, as they are one model or one extends the other,
    /// be it by way of others.
    pub(crate) fn shares_with(&'static self, other: &'static Description) -> bool {
        self.is_or_extends(other) || other.is_or_extends(self)
    }

    /// Whether it is another model or extends it, be it by way of others.
    pub fn is_or_extends(&'static self, other: &'static Description) -> bool {
        self == other || self.extends.is_some_and(|it| it.is_or_extends(other))
    }

    /// The point of its section with these coordinates; what is behind them is left out.
    ///
    /// # Panics
    /// Where there are fewer than it has.
    pub fn section_point(&self, coordinates: &[f64]) -> Section {
        Section::new(&coordinates[..self.section.len()])
    }

    /// Every parameter, in the order of tables and files.
    pub fn parameters(&'static self) -> impl DoubleEndedIterator<Item = Parameter> + Clone {
        (0..self.parameters.len()).map(move |index| Parameter::of(self, index))
    }

    /// Every coordinate of the state.
    pub fn coordinates(&'static self) -> impl DoubleEndedIterator<Item = StateCoordinate> + Clone {
        (0..self.coordinates.len()).map(move |index| StateCoordinate::of(self, index))
    }

    /// The coordinate that drifts.
    pub fn drift(&'static self) -> Option<StateCoordinate> {
        self.drift.map(|index| StateCoordinate::of(self, index))
    }

    /// The coordinates of section points.
    pub fn section_coordinates(&'static self) -> impl Iterator<Item = StateCoordinate> + Clone {
        self.on_section.iter().map(move |index| StateCoordinate::of(self, *index))
    }

    /// The coordinates that a start can have: all but that which drifts.
    pub fn start_coordinates(&'static self) -> impl Iterator<Item = StateCoordinate> + Clone {
        let all = (0..self.coordinates.len()).filter(move |index| Some(*index) != self.drift);
        all.map(move |index| StateCoordinate::of(self, index))
    }

    /// Every output, in the order of tables and files.
    pub fn outputs(&'static self) -> impl DoubleEndedIterator<Item = Output> + Clone {
        (0..self.outputs.len()).map(move |index| Output::of(self, index))
    }

    /// The output called `name`.
    pub fn output(&'static self, name: &str) -> Option<Output> {
        self.outputs().find(|it| it.name() == name)
    }

    /// The parameter with this symbol.
    pub fn parameter(&'static self, symbol: &str) -> Option<Parameter> {
        self.parameters().find(|it| it.symbol() == symbol)
    }
}
