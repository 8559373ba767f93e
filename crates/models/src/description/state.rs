//! A state of a model: a value for each of its coordinates.

use std::fmt::{self, Debug, Display, Formatter};
use std::ops::{Index, IndexMut};

use super::{Description, Section};
use crate::quantity::Quantity;

/// What a model says of a coordinate of its state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoordinateDescription {
    /// Its name in starts.
    pub name: &'static str,
    /// What fingerprints of studies know its start by, which files keep: it stays whatever else is called anew.
    pub tag: &'static str,
    /// It at the start.
    pub start: Quantity,
}

/// A coordinate of the state of a model.
#[derive(Clone, Copy)]
pub struct StateCoordinate {
    model: &'static Description,
    index: usize,
}

/// A coordinate that a model has from another is the same.
impl PartialEq for StateCoordinate {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index && self.model.shares_with(other.model)
    }
}

impl Eq for StateCoordinate {}

/// As fingerprints of studies have it.
impl Debug for StateCoordinate {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.described().tag)
    }
}

impl StateCoordinate {
    /// The coordinate of a model at a place among its coordinates.
    pub const fn of(model: &'static Description, index: usize) -> StateCoordinate {
        StateCoordinate { model, index }
    }

    fn described(self) -> &'static CoordinateDescription {
        &self.model.coordinates[self.index]
    }

    /// Its name in starts.
    pub fn name(self) -> &'static str {
        self.described().name
    }

    /// It at the start.
    pub fn start(self) -> Quantity {
        self.described().start
    }
}

/// A state of a model: a value for each of its coordinates (SI).
#[derive(Clone, PartialEq)]
pub struct State {
    model: &'static Description,
    values: Vec<f64>,
}

/// As fingerprints of studies have it.
impl Debug for State {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("State");
        for (coordinate, value) in self.each() {
            text.field(coordinate.name(), &value);
        }
        text.finish()
    }
}

/// Its coordinates by name, with their units.
impl Display for State {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (place, (coordinate, value)) in self.each().enumerate() {
            let (comma, unit) = (if place == 0 { "" } else { ", " }, coordinate.start().dimension);
            write!(f, "{comma}{} = {value}", coordinate.name())?;
            if !matches!(unit.unit(), "" | "1") {
                write!(f, " {}", unit.unit())?;
            }
        }
        Ok(())
    }
}

impl From<&State> for State {
    fn from(state: &State) -> State {
        state.clone()
    }
}

impl State {
    /// The state with these values, in the order of the model.
    ///
    /// # Panics
    /// Where there is not one for each coordinate.
    pub fn new(model: &'static Description, values: &[f64]) -> State {
        let of = model.name;
        assert!(values.len() == model.coordinates.len(), "a value for each coordinate of {of}");
        State { model, values: values.to_vec() }
    }

    /// All coordinates zero.
    pub fn origin(model: &'static Description) -> State {
        State { model, values: vec![0.0; model.coordinates.len()] }
    }

    /// The state at a section point; the other coordinates are zero.
    pub fn at_section(model: &'static Description, point: &[f64]) -> State {
        let mut state = State::origin(model);
        for (coordinate, value) in model.section_coordinates().zip(point) {
            state[coordinate] = *value;
        }
        state
    }

    /// The model whose state it is.
    pub fn model(&self) -> &'static Description {
        self.model
    }

    /// Every coordinate with its value.
    pub fn each(&self) -> impl Iterator<Item = (StateCoordinate, f64)> + '_ {
        self.model.coordinates().zip(self.values.iter().copied())
    }

    /// The values, in the order of the model.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The section point.
    pub fn section(&self) -> Section {
        self.model.section_coordinates().map(|it| self[it]).collect()
    }

    /// The same, with that which drifts as in another state.
    pub fn drifted_as(mut self, other: &State) -> State {
        if let Some(drift) = self.model.drift {
            self.values[drift] = other.values[drift];
        }
        self
    }

    /// The same, with that which drifts at zero.
    pub fn without_drift(self) -> State {
        let origin = State::origin(self.model);
        self.drifted_as(&origin)
    }
}

/// Of the model's own coordinates.
///
/// # Panics
/// Where the coordinate is that of another model.
impl Index<StateCoordinate> for State {
    type Output = f64;
    fn index(&self, coordinate: StateCoordinate) -> &f64 {
        assert!(coordinate.model.shares_with(self.model), "a coordinate of {}", self.model.name);
        &self.values[coordinate.index]
    }
}

impl IndexMut<StateCoordinate> for State {
    fn index_mut(&mut self, coordinate: StateCoordinate) -> &mut f64 {
        assert!(coordinate.model.shares_with(self.model), "a coordinate of {}", self.model.name);
        &mut self.values[coordinate.index]
    }
}
