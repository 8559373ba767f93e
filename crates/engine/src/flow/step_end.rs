//! Where a step ends, and which guard ends it.

use crate::lane::Lane;

/// Where a step ends, and which guard ends it (-1 for none).
pub(super) struct StepEnd<L: Lane> {
    pub length: L::Plain,
    pub guard: L::Plain,
    /// The same length as the root that it is, where a guard falls.
    pub root: L,
    /// Where a guard is no finite number, so that nothing is known of where it falls.
    pub unknown: L::Mask,
}

impl<L: Lane> StepEnd<L> {
    /// Where a guard ends the step.
    #[inline(always)]
    pub fn falls(&self) -> L::Mask {
        L::Plain::splat(-0.5).lt(self.guard)
    }

    /// Where this guard ends the step.
    #[inline(always)]
    pub fn is_due(&self, which: usize) -> L::Mask {
        let away = self.guard - L::Plain::splat(which as f64);
        away.abs().lt(L::Plain::splat(0.5))
    }
}
