//! What is told of a step that a motion has taken.

use crate::lane::{Lane, Mask, ORDER, Series, SideBySide, series};

use super::switched::{MAX_GUARDS, Switched};

/// One step that was taken; the next is written over it, so that nothing large is moved or cleared.
#[derive(Debug, Clone)]
pub struct Step<L: Lane, S: Switched<L>> {
    /// Time at its start since the start of the cycle [s].
    pub start: L,
    /// Duration [s].
    pub length: L,
    /// The mode during the step.
    pub mode: S::Mode,
    /// The series of the motion during the step.
    pub jet: S::Jet,
    /// The event at its end, as `Switched::switch` numbers it; zero for none.
    pub event: L,
    /// Whether a guard has been obeyed at its end, with an event or without.
    pub switches: L::Mask,
    /// Whether a cycle ends with it.
    pub arrives: L::Mask,
    /// The guards of numbers without derivatives; of others the first place is room for one.
    pub(super) guards: [Series<L>; MAX_GUARDS],
    /// The guards without derivatives of numbers that have some.
    pub(super) plain_guards: [Series<L::Plain>; MAX_GUARDS],
    pub(super) chosen: Series<L::Plain>,
}

impl<L: Lane, S: Switched<L>> Step<L, S> {
    /// The guards of the system, and the section of an autonomous one.
    pub(super) const GUARDS: usize = S::GUARDS + if S::AUTONOMOUS { 1 } else { 0 };

    /// A coefficient of a guard without its derivatives.
    #[inline(always)]
    fn plain_term(&self, which: usize, k: usize) -> L::Plain {
        match const { L::PARTS == 1 } {
            true => self.guards[which][k].plain(),
            false => self.plain_guards[which][k],
        }
    }

    /// Copies the guard that each lane has `chosen`, by its number.
    #[inline(always)]
    pub(super) fn choose(&mut self, chosen: L::Plain) {
        for k in 0..ORDER + 1 {
            let mut term = self.plain_term(0, k);
            for which in 1..Self::GUARDS {
                let taken = L::Plain::splat(which as f64).le(chosen);
                term = L::Plain::select(taken, self.plain_term(which, k), term);
            }
            self.chosen[k] = term;
        }
    }
}

impl<L: Lane, S: Switched<L>> Default for Step<L, S> {
    #[inline(always)]
    fn default() -> Self {
        let zero = L::splat(0.0);
        Step {
            start: zero,
            length: zero,
            mode: S::Mode::default(),
            jet: S::Jet::default(),
            event: zero,
            switches: L::Mask::splat(false),
            arrives: L::Mask::splat(false),
            guards: [series::zero(); MAX_GUARDS],
            plain_guards: [series::zero(); MAX_GUARDS],
            chosen: series::zero(),
        }
    }
}

impl<S: Switched<f64>> Step<f64, S> {
    /// Takes over the step that was taken in lane `index`.
    #[inline(always)]
    pub fn take_lane<L, T>(&mut self, index: usize, lanes: &Step<L, T>)
    where
        L: Lane,
        T: Switched<L>,
        T::Mode: SideBySide<One = S::Mode>,
        T::Jet: SideBySide<One = S::Jet>,
    {
        self.take_times(index, lanes);
        self.jet = lanes.jet.lane(index);
        self.event = lanes.event.lane(index);
        self.switches = lanes.switches.lane(index);
        self.arrives = lanes.arrives.lane(index);
    }

    /// The same of its time, its length and its mode only.
    #[inline(always)]
    pub(super) fn take_times<L, T>(&mut self, index: usize, lanes: &Step<L, T>)
    where
        L: Lane,
        T: Switched<L>,
        T::Mode: SideBySide<One = S::Mode>,
    {
        self.start = lanes.start.lane(index);
        self.length = lanes.length.lane(index);
        self.mode = lanes.mode.lane(index);
    }
}
