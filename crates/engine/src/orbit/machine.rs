//! What cases are computed on: threads, and the instructions of each.

use std::thread;

use crate::flow::stop;
use crate::lane::Instructions;

/// Room for the stack of a thread [bytes]: a build without optimisation keeps all that lanes compute with there.
pub const STACK: usize = 32 << 20;

/// What cases are computed on; the results do not depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Machine {
    /// Number of threads; all cores for none.
    pub threads: Option<usize>,
    /// By which each thread moves its cases; those that suit their number for none.
    pub instructions: Option<Instructions>,
}

impl Machine {
    /// One thread.
    pub fn single() -> Self {
        Machine { threads: Some(1), instructions: None }
    }

    /// How many threads compute.
    pub fn threads(&self) -> usize {
        let all = || thread::available_parallelism().map_or(1, usize::from);
        self.threads.unwrap_or_else(all)
    }

    /// The instructions to move so many cases a thread by.
    pub fn instructions_for(&self, cases: usize) -> Instructions {
        self.instructions.unwrap_or_else(|| Instructions::suited_to(cases))
    }

    /// Calls `work` on as many threads as so many cases are worth, with the cases of a thread if they are
    /// shared out evenly, and the instructions for them.
    pub(super) fn share_out(&self, cases: usize, work: impl Fn(usize, Instructions) + Sync) {
        let threads = self.threads().clamp(1, cases.max(1));
        let share = cases.div_ceil(threads);
        let instructions = self.instructions_for(share);
        let stop = stop::current();
        thread::scope(|scope| {
            for _ in 0..threads {
                let thread = thread::Builder::new().stack_size(STACK);
                let worker = thread.spawn_scoped(scope, || {
                    stop::obey(stop.clone());
                    work(share, instructions);
                });
                worker.expect("a thread can be started");
            }
        });
    }
}
