//! What a campaign tells its listener while it is under way, and how the listener stops it.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::run::Record;
use crate::store::{Blocks, Summary, Unusable};

use super::error::CampaignError;
use super::kept::Kept;

/// A listener: hears of every event, from any thread, and answers whether to continue.
///
/// After a `Break` the campaign ends with [`CampaignError::Stopped`]: at the next case while blocks are
/// computed, at the next part while a file is written, and once it is done while attractors are linked,
/// branches are continued or a case's predecessors are computed. Whatever was finished is kept.
pub type Report<'r> = dyn Fn(Event<'_>) -> ControlFlow<()> + Sync + 'r;

/// The listener that nothing is told.
pub fn silent(_: Event<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Something that a campaign tells.
#[derive(Clone, Copy)]
pub enum Event<'a> {
    /// The file in the place of the results has all that was asked for.
    Before {
        /// Whether its study is word for word the same, and not only one with the same cases.
        same_words: bool,
    },
    /// Nothing speaks against the request, and nothing has been written yet; with the file that is there, if
    /// its results are those of this study.
    Accepted(Option<&'a Kept>),
    /// A block that is there cannot be trusted and is computed again.
    Again {
        /// Its file.
        file: &'a Path,
        /// What is wrong with it.
        why: &'a Unusable,
    },
    /// A block that is there cannot be trusted and is left out of the file.
    LeftOut {
        /// Its file.
        file: &'a Path,
        /// What is wrong with it.
        why: &'a Unusable,
    },
    /// The blocks have been looked at; those that are missing are computed now.
    Surveyed(Survey<'a>),
    /// A case is done.
    Case {
        /// Its block.
        block: usize,
        /// Cases of the block.
        cases: usize,
        /// What came of it.
        record: &'a Record,
    },
    /// A block is done and on the disk.
    Block(&'a Summary),
    /// All missing blocks of the task are done.
    Computed {
        /// Cases that were computed.
        cases: usize,
        /// The time they took.
        time: Duration,
    },
    /// The blocks in this folder are joined now.
    Joining {
        /// Where they are.
        folder: &'a Path,
    },
    /// The file is complete, and its blocks are removed next unless it is partial.
    Joined {
        /// The file.
        path: &'a Path,
        /// The blocks in it.
        blocks: &'a Blocks<'a>,
    },
    /// The file that is verified was written by another version of the program.
    OtherProgram {
        /// That version.
        theirs: &'a str,
        /// This version.
        ours: &'a str,
    },
    /// A stage of so many steps begins.
    Begun(Stage, usize),
    /// A step of a stage is done.
    Step(Stage),
    /// A stage is over.
    Ended(Stage),
}

/// A part of the work that is counted in steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Attractors are linked; a step is a pair of neighbouring cells.
    Linking,
    /// The file is written; a step is a part of a variable.
    Writing,
    /// Branches are continued; a step is a branch of the study.
    Continuing,
    /// Cases are computed again; a step is a case.
    Repeating,
}

/// The blocks of a task before it begins.
#[derive(Debug, Clone, Copy)]
pub struct Survey<'a> {
    /// Their folder.
    pub folder: &'a Path,
    /// Blocks of the task.
    pub blocks: usize,
    /// Cases of the task.
    pub cases: usize,
    /// The blocks that are done.
    pub kept: &'a [Summary],
}

/// Tells a listener, and remembers that it has asked to stop.
pub(super) struct Reports<'a> {
    listener: &'a Report<'a>,
    stopped: AtomicBool,
}

impl<'a> Reports<'a> {
    pub(super) fn new(listener: &'a Report<'a>) -> Self {
        Reports { listener, stopped: AtomicBool::new(false) }
    }

    /// Tells of an event, from any thread; the answer is to be heeded as soon as possible.
    pub(super) fn note(&self, event: Event<'_>) -> ControlFlow<()> {
        if (self.listener)(event).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
        }
        match self.stopped.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Tells of a step of a stage that cannot be broken off; the answer is heeded after the stage.
    pub(super) fn step(&self, stage: Stage) {
        let _ = self.note(Event::Step(stage));
    }

    /// Tells of an event, and fails where the listener has asked to stop.
    pub(super) fn tell(&self, event: Event<'_>) -> Result<(), CampaignError> {
        match self.note(event) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(CampaignError::Stopped),
        }
    }

    /// Fails where the listener has asked to stop.
    pub(super) fn check(&self) -> Result<(), CampaignError> {
        match self.stopped.load(Ordering::Relaxed) {
            true => Err(CampaignError::Stopped),
            false => Ok(()),
        }
    }
}
