//! Begins a step: the series of the motion, and how long they describe it.

use crate::lane::{Lane, Part};

use super::switched::Switched;

/// Writes the series of a motion from where it is, and says how long a step may be.
pub(super) struct Expand<'a, L: Lane, S: Switched<L>> {
    pub system: &'a S,
    pub mode: &'a S::Mode,
    /// Since the start of the cycle [s].
    pub time: L,
    pub state: &'a S::State,
    /// The longest step that is wanted [s].
    pub most: L::Plain,
    /// Relative local error of a step.
    pub tolerance: f64,
    pub jet: &'a mut S::Jet,
}

impl<L: Lane, S: Switched<L>> Part for Expand<'_, L, S> {
    type Output = L::Plain;

    #[inline(always)]
    fn run(self) -> L::Plain {
        let Expand { system, mode, time, state, most, tolerance, jet } = self;
        system.expand(mode, time, state, jet);
        let allowed = system.longest_step(jet, tolerance).min(most);
        system.step_bound(mode, jet, allowed, tolerance)
    }
}
