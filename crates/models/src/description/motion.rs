//! What a model says of a motion over time: what is kept of it, what follows from that, its events and its sums.

use super::{Description, Parameters, State};
use crate::quantity::Quantity;

/// What a model says of a motion over time.
#[derive(Debug, Clone, Copy)]
pub struct MotionDescription {
    /// What is kept of a motion at each time: the coordinates of its state in their order, then what depends on time alone, as the
    /// force of a drive; nothing where histories are not kept.
    pub histories: &'static [Quantity],
    /// What figures can show of a motion over time.
    pub signals: &'static [Signal],
    /// Several of these that are shown together.
    pub groups: &'static [SignalGroup],
    /// The names of the signals and groups that a history shows, one below the other, where no others are asked for.
    pub panels: &'static [&'static str],
    /// The charts of a motion on a page, with the signals of each.
    pub charts: &'static [Chart],
    /// The names of the two signals of a phase portrait, where no others are asked for; none where there are no histories.
    pub portrait: Option<[&'static str; 2]>,
    /// What is told of an impact.
    pub impact: &'static [Quantity],
    /// The state at an impact, by the value of the first coordinate on the surface and what is told of the impact; what drifts is
    /// zero. None where impacts are not told of.
    pub at_impact: Option<fn(f64, &[f64]) -> State>,
    /// The names of events, in the order of their numbers, from 1 on.
    pub events: &'static [&'static str],
    /// The names of what is summed up from the start of a motion (SI).
    pub sums: &'static [&'static str],
    /// The names of what is counted from the start of a motion.
    pub counts: &'static [&'static str],
}

impl MotionDescription {
    /// Of a model of which no histories are kept.
    pub const NONE: MotionDescription = MotionDescription {
        histories: &[],
        signals: &[],
        groups: &[],
        panels: &[],
        charts: &[],
        portrait: None,
        impact: &[],
        at_impact: None,
        events: &[],
        sums: &[],
        counts: &[],
    };
}

/// What a motion has at each time.
#[derive(Debug, Clone, Copy)]
pub struct Signal {
    /// What it is.
    pub quantity: Quantity,
    /// What it tells of the motion.
    pub kind: SignalKind,
    /// Where it comes from.
    pub source: Source,
    /// Why motions with these parameters do not have it, in a sentence.
    pub missing: fn(&Parameters) -> Option<&'static str>,
}

/// What a signal tells of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SignalKind {
    /// Where it is or how fast.
    Coordinate,
    /// Where it is, and goes on from cycle to cycle.
    Drifting,
    /// Where it is on what repeats, from 0 to 1, after which it begins anew.
    Repeating,
    /// A force.
    Force,
}

/// Where a signal comes from.
#[derive(Debug, Clone, Copy)]
pub enum Source {
    /// It is kept, at this place among the histories.
    Kept(usize),
    /// It follows from the state alone.
    State(fn(&State) -> f64),
    /// It follows from the parameters, the state, and what is kept of a motion beside its coordinates.
    Parameters(fn(&Parameters, &State, &[f64]) -> f64),
}

/// Signals that are shown together.
#[derive(Debug, Clone, Copy)]
pub struct SignalGroup {
    /// What they are together.
    pub quantity: Quantity,
    /// Their names.
    pub signals: &'static [&'static str],
}

/// A chart over time.
#[derive(Debug, Clone, Copy)]
pub struct Chart {
    /// What its signals are, which have one unit.
    pub title: &'static str,
    /// Their names.
    pub signals: &'static [&'static str],
}

impl Signal {
    /// A signal that is kept, at this place among the histories.
    pub const fn kept(quantity: Quantity, kind: SignalKind, place: usize) -> Signal {
        Signal { quantity, kind, source: Source::Kept(place), missing: |_| None }
    }

    /// A signal that follows from the state.
    pub const fn of_state(
        quantity: Quantity,
        kind: SignalKind,
        value: fn(&State) -> f64,
    ) -> Signal {
        Signal { quantity, kind, source: Source::State(value), missing: |_| None }
    }

    /// A force that follows from the parameters, the state, and what is kept of a motion beside its coordinates.
    pub const fn force(
        quantity: Quantity,
        value: fn(&Parameters, &State, &[f64]) -> f64,
    ) -> Signal {
        let source = Source::Parameters(value);
        Signal { quantity, kind: SignalKind::Force, source, missing: |_| None }
    }

    /// Its name.
    pub const fn name(&self) -> &'static str {
        self.quantity.name
    }

    /// Its value in a state; none where it depends on time or on parameters, too.
    pub fn in_state(&self, state: &State) -> Option<f64> {
        match self.source {
            Source::Kept(place) => state.values().get(place).copied(),
            Source::State(value) => Some(value(state)),
            Source::Parameters(_) => None,
        }
    }

    /// Its values along a motion, from what is kept of it.
    pub fn values(&self, parameters: &Parameters, histories: &[Vec<f64>]) -> Vec<f64> {
        let (model, count) = (parameters.model(), histories.first().map_or(0, Vec::len));
        let states = (0..count).map(|place| model.state_of(histories, place));
        match self.source {
            Source::Kept(place) => histories[place].clone(),
            Source::State(value) => states.map(|state| value(&state)).collect(),
            Source::Parameters(value) => {
                let beside = &histories[model.coordinates.len()..];
                let at = |(place, state): (usize, State)| {
                    let kept: Vec<f64> = beside.iter().map(|column| column[place]).collect();
                    value(parameters, &state, &kept)
                };
                states.enumerate().map(at).collect()
            }
        }
    }
}

impl Description {
    /// What each point of the sections has: of the stroboscopic section, and of the impacts.
    pub fn points(&self) -> impl Iterator<Item = Quantity> {
        self.section.iter().chain(self.motion.impact).copied()
    }

    /// Whether files can keep histories of its motions: samples at even times, of cycles that last equally.
    pub fn keeps_histories(&self) -> bool {
        self.has_drive() && !self.motion.histories.is_empty()
    }

    /// The signal called `name`.
    pub fn signal(&'static self, name: &str) -> Option<&'static Signal> {
        self.motion.signals.iter().find(|it| it.name() == name)
    }

    /// The group of signals called `name`.
    pub fn signal_group(&'static self, name: &str) -> Option<&'static SignalGroup> {
        self.motion.groups.iter().find(|it| it.quantity.name == name)
    }

    /// The signal that is the coordinate at a place among those of the state.
    pub fn signal_of_coordinate(&'static self, place: usize) -> Option<&'static Signal> {
        let mut signals = self.motion.signals.iter();
        signals.find(|it| matches!(it.source, Source::Kept(kept) if kept == place))
    }

    /// The quantity by which the coordinate at a place is shown along a motion: that of histories, or of starts where none are kept.
    pub fn coordinate_along(&self, place: usize) -> Quantity {
        let kept = self.motion.histories.get(place).copied();
        kept.unwrap_or_else(|| self.coordinates[place].start)
    }

    /// The state at a place of a motion, from what is kept of it.
    pub fn state_of(&'static self, histories: &[Vec<f64>], place: usize) -> State {
        let values: Vec<f64> =
            histories.iter().take(self.coordinates.len()).map(|column| column[place]).collect();
        State::new(self, &values)
    }

    /// The name of the event with this number.
    pub fn event(&self, number: u8) -> &'static str {
        self.motion.events[usize::from(number) - 1]
    }
}
