//! An oscillator as its text says it: states, rates, and what makes it switch, as values of one graph.

use crate::text::graph::{Graph, Id, Node};
use crate::text::linear::Linear;

/// The most states of a system.
pub const MOST_STATES: usize = 8;
/// The most switches, frictions, pulses and events of a system, each.
pub const MOST_OF_A_KIND: usize = 8;

/// An oscillator that its text describes without a fault.
#[derive(Debug, Clone)]
pub struct Text {
    /// What it is called.
    pub name: String,
    /// Its states.
    pub states: Vec<State>,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// All its values.
    pub graph: Graph,
    /// The rate of each state.
    pub rates: Vec<Id>,
    /// Its switches.
    pub switches: Vec<Switch>,
    /// Its frictions.
    pub frictions: Vec<Friction>,
    /// Its pulses.
    pub pulses: Vec<Pulse>,
    /// Its events.
    pub events: Vec<Event>,
    /// Where its motion is seen.
    pub section: Section,
    /// The state that nothing depends on, by its place.
    pub drift: Option<usize>,
}

/// A state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct State {
    /// Its name in expressions.
    pub name: String,
    /// Its unit, as the text has it.
    pub unit: String,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name in expressions.
    pub name: String,
    /// Its value where none is given.
    pub default: f64,
    /// Its unit, as the text has it; none where it has none.
    pub unit: Option<String>,
    /// What it is, in words.
    pub meaning: Option<String>,
}

/// A number that is 1 on one side of a surface, else 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Switch {
    /// Its name in expressions.
    pub name: String,
    /// Positive on the side where it is 1.
    pub side: Id,
    /// Where the motion is put on the surface.
    pub bound: Option<Bound>,
    /// What becoming 1 is called.
    pub enters: Option<String>,
}

/// Where a state is on a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bound {
    /// The state by its place.
    pub state: usize,
    /// Its value there.
    pub value: Id,
}

/// A friction: a force that at rest is what keeps the rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Friction {
    /// Its name in expressions.
    pub name: String,
    /// What is zero at rest.
    pub of: Id,
    /// The same, by states.
    pub linear: Linear,
    /// Its size while that is not zero.
    pub sliding: Id,
    /// What it can be at rest, in either direction.
    pub holds: Id,
    /// What it is at rest.
    pub at_rest: Id,
}

/// A number that is 1 for a share of each period from its start, else 0.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pulse {
    /// Its name in expressions.
    pub name: String,
    /// The share.
    pub duty: Id,
    /// Its period, which is that of the section.
    pub period: Id,
}

/// An event that moves the state.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// What it is called.
    pub name: String,
    /// Positive until it happens.
    pub lasts: Id,
    /// Where the motion is put before it is moved.
    pub bound: Option<Bound>,
    /// What it makes of states, by the values before it.
    pub reset: Vec<(usize, Id)>,
}

/// Where a motion is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Section {
    /// After each period, which is this.
    Every(Id),
    /// Where a state passes zero.
    When {
        /// The state by its place.
        state: usize,
        /// Whether it falls through zero; else it rises.
        falls: bool,
        /// How long is waited for it.
        within: Id,
    },
}

impl Text {
    /// How many guards its motion has, its section not counted.
    pub fn guards(&self) -> usize {
        let edges = usize::from(!self.pulses.is_empty());
        self.events.len() + self.switches.len() + 2 * self.frictions.len() + edges
    }

    /// The states by which a point of its section is told, by their places.
    pub fn on_section(&self) -> impl Iterator<Item = usize> + '_ {
        let crossed = match self.section {
            Section::Every(_) => None,
            Section::When { state, .. } => Some(state),
        };
        (0..self.states.len()).filter(move |it| Some(*it) != self.drift && Some(*it) != crossed)
    }

    /// The values that its motion needs; of what drifts, none of those by which events move it.
    pub fn roots(&self) -> Vec<Id> {
        let mut roots = self.rates.clone();
        roots.extend(self.switches.iter().map(|it| it.side));
        roots
            .extend(self.frictions.iter().flat_map(|it| [it.of, it.sliding, it.holds, it.at_rest]));
        roots.extend(self.events.iter().map(|it| it.lasts));
        let resets = self.events.iter().flat_map(|it| it.reset.iter());
        roots.extend(resets.filter(|it| Some(it.0) != self.drift).map(|it| it.1));
        roots
    }

    /// A constant where the parameters have their defaults.
    pub fn value_at_defaults(&self, id: Id) -> f64 {
        self.constant(id, &|place| self.parameters[place].default)
    }

    /// A constant where the parameters have values by their places; no number of what is no constant.
    pub fn constant(&self, id: Id, parameter: &dyn Fn(usize) -> f64) -> f64 {
        let of = |id: Id| self.constant(id, parameter);
        match self.graph.node(id) {
            Node::Number(bits) => f64::from_bits(bits),
            Node::Parameter(place) => parameter(place),
            Node::Add(a, b) => of(a) + of(b),
            Node::Sub(a, b) => of(a) - of(b),
            Node::Mul(a, b) => of(a) * of(b),
            Node::Div(a, b) => of(a) / of(b),
            Node::Neg(a) => -of(a),
            Node::Of(function, a) => function.value(of(a)),
            Node::Max(a, b) => of(a).max(of(b)),
            Node::Min(a, b) => of(a).min(of(b)),
            _ => f64::NAN,
        }
    }
}
