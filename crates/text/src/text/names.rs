//! The names of a text and what each stands for.

use std::collections::HashMap;

use crate::text::expression::is_name;
use crate::text::function::Function;
use crate::text::written::{Source, Written, hint};

/// Names that have a meaning in every text.
const OWN: [&str; 2] = ["t", "pi"];
/// Functions of two constants.
pub const OF_TWO: [&str; 2] = ["max", "min"];
/// What outputs may measure of a motion, beside the largest and the least value.
pub const MEASURES: [&str; 3] = ["integral", "mean", "count"];

/// What a name stands for, by its place among those of its kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// Time since the start of the cycle.
    Time,
    /// The ratio of a circle.
    Pi,
    /// A state.
    State(usize),
    /// A parameter.
    Parameter(usize),
    /// A definition.
    Definition(usize),
    /// A switch.
    Switch(usize),
    /// A friction.
    Friction(usize),
    /// A pulse.
    Pulse(usize),
    /// An output.
    Output(usize),
}

/// All names of a text.
#[derive(Debug, Default)]
pub struct Names {
    meanings: HashMap<String, Meaning>,
    /// What the definitions are, by their places.
    pub definitions: Vec<(String, Written)>,
}

impl Names {
    /// Those that every text has.
    pub fn new() -> Self {
        let own = [Meaning::Time, Meaning::Pi];
        let meanings = OWN.iter().zip(own).map(|(name, meaning)| ((*name).into(), meaning));
        Names { meanings: meanings.collect(), definitions: Vec::new() }
    }

    /// Gives a name a meaning, or notes why it cannot have it.
    pub fn give(&mut self, source: &Source<'_>, name: &str, at: usize, meaning: Meaning) {
        let is_function = Function::NAMES
            .iter()
            .map(|it| it.0)
            .chain(OF_TWO)
            .chain(MEASURES)
            .any(|it| it == name);
        if !is_name(name) {
            let message = format!("{name:?} is no name: letters, digits and _, no digit first");
            source.fault(at, message);
        } else if is_function || OWN.contains(&name) {
            source.fault(at, format!("{name:?} has a meaning in every text already"));
        } else if let Some(known) = self.meanings.insert(name.into(), meaning) {
            source.fault(at, format!("{name:?} is the name of {} already", kind(known)));
        }
    }

    /// What a name stands for; where it stands for nothing, what is to be said of that.
    pub fn meaning(&self, name: &str) -> Result<Meaning, String> {
        self.meanings.get(name).copied().ok_or_else(|| {
            let mut names: Vec<&String> = self.meanings.keys().collect();
            names.sort();
            format!("nothing is called {name:?}{}", hint(name, names))
        })
    }
}

/// What something with a name is, in words.
fn kind(meaning: Meaning) -> &'static str {
    match meaning {
        Meaning::Time => "the time",
        Meaning::Pi => "a number",
        Meaning::State(_) => "a state",
        Meaning::Parameter(_) => "a parameter",
        Meaning::Definition(_) => "a definition",
        Meaning::Switch(_) => "a switch",
        Meaning::Friction(_) => "a friction",
        Meaning::Pulse(_) => "a pulse",
        Meaning::Output(_) => "an output",
    }
}
