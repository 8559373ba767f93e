//! A stretch of a motion, in what is kept of it at each time.

use crate::description::{Description, State};

/// A stretch of a motion: what is kept of it at some instants, in the order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    model: &'static Description,
    /// Time since it began [s].
    pub times: Vec<f64>,
    /// By what the model keeps of a motion at each time, then by time (SI).
    pub histories: Vec<Vec<f64>>,
}

impl Stretch {
    /// None of the motion.
    pub fn of(model: &'static Description) -> Stretch {
        Stretch {
            model,
            times: Vec::new(),
            histories: vec![Vec::new(); model.motion.histories.len()],
        }
    }

    /// Adds an instant: the state, and what depends on time alone.
    pub fn push(&mut self, time: f64, state: &State, driven: &[f64]) {
        self.times.push(time);
        let values = state.values().iter().chain(driven);
        self.histories.iter_mut().zip(values).for_each(|(column, value)| column.push(*value));
    }

    /// Adds what follows, which began so long after this [s]; its first instant is the last of this.
    pub fn append(&mut self, began: f64, next: &Stretch) {
        let first = usize::from(!self.times.is_empty());
        self.times.extend(next.times.iter().skip(first).map(|time| began + time));
        for (column, more) in self.histories.iter_mut().zip(&next.histories) {
            column.extend(more.iter().skip(first));
        }
    }

    /// Keeps so many instants at most.
    pub fn truncate(&mut self, most: usize) {
        self.times.truncate(most);
        self.histories.iter_mut().for_each(|column| column.truncate(most));
    }

    /// The state at an instant.
    pub fn state(&self, place: usize) -> State {
        self.model.state_of(&self.histories, place)
    }
}
