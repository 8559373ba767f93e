//! Ends a step: obeys the guard that ends it.

use crate::lane::{Lane, Mask, Part};

use super::step_end::StepEnd;
use super::switched::{Switched, Zeros};

/// Obeys the guard that ends a step; yields the kind of event.
pub(super) struct Obey<'a, L: Lane, S: Switched<L>> {
    pub system: &'a S,
    pub end: &'a StepEnd<L>,
    pub mode: &'a mut S::Mode,
    pub state: &'a mut S::State,
    pub zeros: &'a mut Zeros<L>,
    /// When, since the start of the cycle [s].
    pub time: L,
}

impl<L: Lane, S: Switched<L>> Part for Obey<'_, L, S> {
    type Output = L;

    #[inline(always)]
    fn run(self) -> L {
        let Obey { system, end, mode, state, zeros, time } = self;
        let mut event = L::splat(0.0);
        for which in 0..S::GUARDS {
            let due = end.is_due(which);
            if due.any() {
                event = event + system.switch(which, due, mode, state, zeros, time);
            }
        }
        event
    }
}
