//! An oscillator as its text says it: states, rates, and what makes it switch, as values of one graph.

use capsulemap_models::quantity::Bounds;

use crate::text::fault::Fault;
use crate::text::graph::{Graph, Id, Node};
use crate::text::linear::Linear;

/// The most states of a system.
pub const MOST_STATES: usize = 8;
/// The most coordinates of a point of a section.
pub const MOST_ON_SECTION: usize = 8;
/// The most switches, frictions and events of a system, each.
pub const MOST_OF_A_KIND: usize = 8;
/// The most pulses of a system.
pub const MOST_PULSES: usize = 4;

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
    /// What outputs are of.
    pub measured: Vec<Measured>,
    /// Its outputs.
    pub outputs: Vec<TextOutput>,
    /// Where its units do not fit each other.
    pub misfits: Vec<Fault>,
}

/// What is measured of a motion that has settled.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Measured {
    /// The integral of a value over a cycle.
    Integral(Id),
    /// Its mean over time.
    Mean(Id),
    /// Its largest value.
    Largest(Id),
    /// Its least value.
    Least(Id),
    /// How often the event of this name happens in a cycle.
    Count(String),
}

impl Measured {
    /// The value that it is of, if it is of one.
    pub fn of(&self) -> Option<Id> {
        match self {
            Measured::Integral(of)
            | Measured::Mean(of)
            | Measured::Largest(of)
            | Measured::Least(of) => Some(*of),
            Measured::Count(_) => None,
        }
    }
}

/// An output of a text.
#[derive(Debug, Clone, PartialEq)]
pub struct TextOutput {
    /// Its name.
    pub name: String,
    /// Its unit, as the text has it; none where it has none.
    pub unit: Option<String>,
    /// What it is, in words.
    pub meaning: Option<String>,
    /// Its value, of parameters and what is measured.
    pub value: Id,
}

/// A state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct State {
    /// Its name in expressions.
    pub name: String,
    /// Its unit, as the text has it.
    pub unit: String,
    /// What it is, in words.
    pub meaning: Option<String>,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name in expressions.
    pub name: String,
    /// Its value where none is given.
    pub default: f64,
    /// What it may be.
    pub bounds: Bounds,
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
    /// Whether its condition is on its bound after it, too.
    pub stays_on_surface: bool,
    /// What is held where impacts accumulate, if they end in a contact that lasts.
    pub lasting: Option<Lasting>,
    /// What depends on states that it moves.
    pub moved: Moved,
}

/// A contact that lasts: the state on the bound and its rate stay there as long as the forces press.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lasting {
    /// The state that is the rate of that on the bound, by its place.
    pub velocity: usize,
    /// Whether the motion is above the bound; else it is below.
    pub is_above: bool,
}

/// What depends on states that an event moves, each by place.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Moved {
    /// Switches.
    pub switches: Vec<bool>,
    /// Conditions of events, but for the bound that it stays on.
    pub events: Vec<bool>,
    /// Frictions.
    pub frictions: Vec<bool>,
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
    /// The same once it is known what depends on states that its events move.
    pub fn with_moved(mut self) -> Text {
        let all = self.events.clone();
        for (place, event) in all.iter().enumerate() {
            let moves = |id: Id| {
                let mut states = event.reset.iter().map(|it| Node::State(it.0));
                states.any(|it| self.graph.depends_on(id, it))
            };
            let on_bound = event.bound.is_some_and(|bound| {
                event
                    .reset
                    .iter()
                    .all(|(state, value)| *state != bound.state || *value == bound.value)
            });
            let stays_on_surface = on_bound || !moves(event.lasts);
            let moved = Moved {
                switches: self.switches.iter().map(|it| moves(it.side)).collect(),
                events: all
                    .iter()
                    .enumerate()
                    .map(|(other, it)| moves(it.lasts) && !(other == place && stays_on_surface))
                    .collect(),
                frictions: self.frictions.iter().map(|it| moves(it.of)).collect(),
            };
            (self.events[place].stays_on_surface, self.events[place].moved) =
                (stays_on_surface, moved);
        }
        self
    }

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

    /// The values that its motion needs, and those of which something is measured.
    pub fn roots_and_measured(&self) -> Vec<Id> {
        self.roots().into_iter().chain(self.measured.iter().filter_map(Measured::of)).collect()
    }

    /// A constant where the parameters have their defaults; no number of what is no constant.
    pub fn value_at_defaults(&self, id: Id) -> f64 {
        self.graph.constants(&|place| self.parameters[place].default, &[])[id.index()]
    }
}
