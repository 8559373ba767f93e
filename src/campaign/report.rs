//! The events that a campaign reports to its listener, and how the listener stops it.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use super::claims::{Abandoned, ClaimStatus};
use super::error::CampaignError;
use super::kept::Kept;
use crate::run::Record;
use crate::store::{Blocks, Owner, Summary, Unusable};

/// A listener: called with every event, from any thread; returns whether to continue.
///
/// After a `Break` the campaign ends with [`CampaignError::Stopped`]: at the next case while blocks are
/// computed, at the next part while a file is written, and once it is done while attractors are linked,
/// branches are continued or a case's predecessors are computed. Whatever was finished is kept.
pub type Report<'r> = dyn Fn(Event<'_>) -> ControlFlow<()> + Sync + 'r;

/// A listener that ignores all events.
pub fn silent(_: Event<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// An event of a campaign.
#[derive(Clone, Copy)]
pub enum Event<'a> {
    /// The file in the place of the results has all that was asked for.
    Before {
        /// Whether the text of its study is the same, and not only its cases.
        same_text: bool,
    },
    /// The request is accepted and nothing has been written yet; with the file that is there, if its results
    /// are those of this study.
    Accepted(Option<&'a Kept>),
    /// A block is damaged or foreign and is computed again.
    Again {
        /// Its file.
        file: &'a Path,
        /// What is wrong with it.
        why: &'a Unusable,
    },
    /// A block is damaged or foreign and is left out of the file.
    LeftOut {
        /// Its file.
        file: &'a Path,
        /// What is wrong with it.
        why: &'a Unusable,
    },
    /// The blocks have been checked; those that are missing are computed now.
    Surveyed(Survey<'a>),
    /// A case is done; of a refined study only its tiles are reported.
    Case {
        /// Its block.
        block: usize,
        /// Cases of the block.
        cases: usize,
        /// Its record.
        record: &'a Record,
    },
    /// A block is done and on the disk.
    Block(&'a Summary),
    /// Another process has kept a block meanwhile.
    KeptElsewhere(&'a Summary),
    /// A block was computed that another process has kept meanwhile, with the same numbers to the bit; that one stays.
    Twice {
        /// Its number.
        block: usize,
    },
    /// What another process had claimed is taken over from it.
    TakenOver {
        /// The block; none for the join.
        block: Option<usize>,
        /// Who had claimed it; none if that cannot be read.
        owner: Option<&'a Owner>,
        /// Why it is taken over.
        why: Abandoned,
    },
    /// All that is left is claimed by others, which are waited for; sent again and again.
    Awaiting(&'a [ClaimStatus]),
    /// All missing blocks of the task are done.
    Computed {
        /// Cases that were computed.
        cases: usize,
        /// The time they took.
        time: Duration,
    },
    /// Another run writes results in the same folder; this one waits until it is done.
    Waiting {
        /// The folder.
        folder: &'a Path,
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

/// A stage whose progress is counted in steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Attractors are linked; a step is a pair of neighbouring cells.
    Linking,
    /// The file is written; a step is a part of a variable.
    Writing,
    /// Branches are continued; a step is a branch of the study.
    Continuing,
    /// Boundaries of the regions of a map are located and followed; a step is a try between two cases, of as many as are allowed.
    Outlining,
    /// Cases are computed again; a step is a case.
    Repeating,
    /// Points between the cases are drawn and settled; a step is a point.
    Starting,
    /// From motions found other prices are sought; a step is a motion and a side.
    Climbing,
    /// Better motions are sought between the cases; a step is a search.
    Searching,
    /// The refined front is followed; a step is a gap of it.
    Following,
    /// Motions are followed under tolerances of the parameters; a step is a motion.
    Drawing,
    /// The parameters of motions are followed to where these end; a step is a parameter that falls or rises.
    Bounding,
    /// The manifolds of so many saddles are followed, in one step.
    Tracing,
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

/// Calls a listener, and remembers that it has asked to stop.
pub(super) struct Reports<'a> {
    listener: &'a Report<'a>,
    stopped: AtomicBool,
}

impl<'a> Reports<'a> {
    pub(super) fn new(listener: &'a Report<'a>) -> Self {
        Reports { listener, stopped: AtomicBool::new(false) }
    }

    /// Reports an event, from any thread; after a `Break` the caller stops as soon as possible.
    pub(super) fn note(&self, event: Event<'_>) -> ControlFlow<()> {
        if (self.listener)(event).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
        }
        self.proceed()
    }

    /// Whether the listener has not asked to stop.
    pub(super) fn proceed(&self) -> ControlFlow<()> {
        match self.stopped.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Reports that another run is waited for.
    pub(super) fn wait(&self, folder: &Path) {
        let _ = self.note(Event::Waiting { folder });
    }

    /// Reports a step of a stage that cannot be interrupted; a request to stop takes effect after the stage.
    pub(super) fn step(&self, stage: Stage) {
        let _ = self.note(Event::Step(stage));
    }

    /// Reports an event, and fails where the listener has asked to stop.
    pub(super) fn send(&self, event: Event<'_>) -> Result<(), CampaignError> {
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
