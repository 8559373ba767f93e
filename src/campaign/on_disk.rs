//! A study whose results are kept in a file as they come, while others may look at what is done.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard};

use super::error::CampaignError;
use super::in_memory::Wanted;
use super::report::{Event, silent};
use super::request::Campaign;
use super::share::Task;
use super::until_stopped::until_stopped;
use crate::flow::Stop;
use crate::run::Machine;
use crate::store::{self, Dataset};
use crate::study::Study;

/// A study that is computed into its file, by one thread.
#[derive(Debug)]
pub struct OnDisk {
    study: Study,
    output: PathBuf,
    machine: Machine,
    overwrite: bool,
    /// What ends the computation.
    stop: Stop,
    /// How many cases are done, those of earlier runs among them.
    done: Mutex<usize>,
}

impl OnDisk {
    /// The study, whose results go to the file `output`; one of another study is replaced where `overwrite` says so.
    pub fn new(study: Study, output: PathBuf, machine: Machine, overwrite: bool) -> OnDisk {
        OnDisk { study, output, machine, overwrite, stop: Stop::default(), done: Mutex::default() }
    }

    /// How many cases are done, and how many the study has; a refined study needs fewer.
    pub fn progress(&self) -> [usize; 2] {
        [*self.done(), self.study.cases()]
    }

    /// Ends the computation within a few steps of its motions, from any thread; the blocks that are done stay.
    pub fn stop(&self) {
        self.stop.ask();
    }

    /// Computes what is wanted and not in the file yet, and reads the file.
    ///
    /// Fails as [`Campaign::run`] and [`Campaign::continue_branches`] do, and with [`CampaignError::Stopped`] if it was stopped.
    pub fn run(&self, wanted: Wanted) -> Result<Dataset, CampaignError> {
        until_stopped(&self.stop, || self.compute(wanted))
    }

    fn compute(&self, wanted: Wanted) -> Result<Dataset, CampaignError> {
        let campaign = self.campaign();
        let hear = |event: Event<'_>| self.hear(event);
        if wanted.cases {
            campaign.run(Task::WHOLE, &hear)?;
        }
        if wanted.branches {
            campaign.continue_branches(&hear)?;
        }
        Ok(store::read(&self.output)?)
    }

    /// Counts what is done; what was computed after the computation was stopped has no meaning, and is not kept.
    fn hear(&self, event: Event<'_>) -> ControlFlow<()> {
        if self.stop.is_asked() {
            return ControlFlow::Break(());
        }
        match event {
            Event::Before { .. } => *self.done() = self.study.cases(),
            Event::Surveyed(survey) => {
                *self.done() = survey.kept.iter().map(|it| it.computed).sum();
            }
            Event::Case { .. } => *self.done() += 1,
            Event::Block(block) if self.study.refine.is_some() => *self.done() += block.computed,
            _ => {}
        }
        ControlFlow::Continue(())
    }

    /// The file if it is whole, or what its blocks hold by now: cases that are not done have the outcome `missing`.
    ///
    /// Fails as [`Campaign::join_partial`] does.
    pub fn so_far(&self) -> Result<Dataset, CampaignError> {
        let refused = |said| CampaignError::Refused {
            folder: std::env::temp_dir(),
            refused: "no folder can be created there",
            said,
        };
        let folder = tempfile::tempdir().map_err(refused)?;
        let file = folder.path().join("partial.h5");
        let joined = self.campaign().join_partial_into(&file, &silent)?;
        Ok(store::read(&joined.path)?)
    }

    fn campaign(&self) -> Campaign<'_> {
        let OnDisk { study, output, machine, overwrite, .. } = self;
        Campaign { study, output, machine: *machine, overwrite: *overwrite }
    }

    fn done(&self) -> MutexGuard<'_, usize> {
        self.done.lock().unwrap_or_else(|it| it.into_inner())
    }
}
