//! How full the lanes have been: of the lanes that were moved, how many had a motion that something came of.

use std::sync::atomic::{AtomicU64, Ordering};

/// What motions are followed side by side for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kernel {
    /// Cases that settle.
    Cases,
    /// Returns with derivatives.
    Returns,
    /// Returns without derivatives.
    PlainReturns,
    /// Cycles that are measured.
    Measuring,
    /// Linearised flows of motions that do not repeat.
    Exponents,
}

/// Steps of lanes of a kernel since the program began.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LaneSteps {
    /// All that were taken.
    pub all: u64,
    /// Those with a motion in the lane.
    pub with_motion: u64,
}

impl LaneSteps {
    /// Those after others had been counted.
    pub fn since(self, before: LaneSteps) -> LaneSteps {
        LaneSteps { all: self.all - before.all, with_motion: self.with_motion - before.with_motion }
    }
}

static STEPS: [[AtomicU64; 2]; Kernel::ALL.len()] =
    [const { [const { AtomicU64::new(0) }; 2] }; Kernel::ALL.len()];

impl Kernel {
    /// Every kernel, in the order of declaration.
    pub const ALL: [Kernel; 5] = [
        Kernel::Cases,
        Kernel::Returns,
        Kernel::PlainReturns,
        Kernel::Measuring,
        Kernel::Exponents,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::Cases => "cases",
            Kernel::Returns => "returns with derivatives",
            Kernel::PlainReturns => "returns",
            Kernel::Measuring => "measuring",
            Kernel::Exponents => "exponents",
        }
    }

    /// Its steps in lanes since the program began, of all threads; motions that are followed one by one do not count.
    pub fn steps(self) -> LaneSteps {
        let [all, with_motion] = &STEPS[self as usize];
        let [all, with_motion] = [all, with_motion].map(|it| it.load(Ordering::Relaxed));
        LaneSteps { all, with_motion }
    }

    /// Counts steps of lanes.
    pub(super) fn count(self, steps: LaneSteps) {
        let [all, with_motion] = &STEPS[self as usize];
        all.fetch_add(steps.all, Ordering::Relaxed);
        with_motion.fetch_add(steps.with_motion, Ordering::Relaxed);
    }
}
