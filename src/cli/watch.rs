//! Shows the events of a campaign on the terminal, and how to resume it after a signal.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock};

use super::block_progress::BlockProgress;
use super::claim_text::{claimed, taken_over};
use super::failure::Failure;
use super::progress::{Progress, Steps};
use super::readable::{blocks_kept, count, counted, time};
use super::stop::say_when_stopped;
use super::summary::summary;
use super::terminal::{notify, print};
use crate::campaign::{CampaignError, ClaimStatus, Event, Stage, Survey};
use crate::quantity::printable::printable;
use crate::store::Blocks;
use crate::study::Study;

/// Listens to the campaign of a study.
pub struct Watch<'a> {
    /// The file of the study.
    path: &'a Path,
    study: &'a Study,
    /// Progress of the blocks, once they are computed.
    blocks: OnceLock<Arc<BlockProgress>>,
    stages: Stages,
    /// What was last said of claims that are waited for.
    awaited: Mutex<String>,
    /// Why the campaign was stopped from here.
    failure: Mutex<Option<Failure>>,
}

impl<'a> Watch<'a> {
    /// Begins to listen; `path` is the file of `study`.
    pub fn new(path: &'a Path, study: &'a Study) -> Self {
        let (blocks, stages) = (OnceLock::new(), Stages::default());
        let (awaited, failure) = (Mutex::default(), Mutex::default());
        Watch { path, study, blocks, stages, awaited, failure }
    }

    /// Shows an event.
    pub fn hear(&self, event: Event<'_>) -> ControlFlow<()> {
        self.heed(self.show(event))
    }

    /// Continues after a success; after a failure, which `end` then returns, stops the campaign.
    pub fn heed(&self, done: Result<(), Failure>) -> ControlFlow<()> {
        match done {
            Ok(()) => ControlFlow::Continue(()),
            Err(failure) => {
                *self.failure.lock().unwrap_or_else(|it| it.into_inner()) = Some(failure);
                ControlFlow::Break(())
            }
        }
    }

    /// Ends the watch over a campaign with what came of it.
    pub fn end<T>(&self, done: Result<T, CampaignError>) -> Result<T, Failure> {
        if let Some(progress) = self.blocks.get() {
            progress.finish();
        }
        let failure = self.failure.lock().unwrap_or_else(|it| it.into_inner()).take();
        match failure {
            Some(failure) => Err(failure),
            None => Ok(done?),
        }
    }

    fn show(&self, event: Event<'_>) -> Result<(), Failure> {
        let blocks = self.blocks.get();
        match event {
            Event::Case { block, cases, record } => {
                blocks.into_iter().for_each(|it| it.case(block, cases, record));
            }
            Event::Block(block) => blocks.into_iter().for_each(|it| it.block(block)),
            Event::KeptElsewhere(block) => {
                blocks.into_iter().for_each(|it| it.kept_elsewhere(block));
            }
            Event::Twice { block } => notify(&format!(
                "block {block}: another process has computed it too, with the same numbers to the bit"
            )),
            Event::TakenOver { block, owner, why } => notify(&taken_over(block, owner, why)),
            Event::Awaiting(claims) => self.wait(claims),
            Event::Again { file, why } => {
                notify(&format!("{}: {why}; it is computed again", printable(file)));
            }
            Event::LeftOut { file, why } => {
                notify(&format!("{}: {why}; it is left out", printable(file)));
            }
            Event::Waiting { folder } => {
                let shown = printable(folder);
                notify(&format!("{shown}: another run writes results there; it is waited for"));
            }
            Event::Surveyed(survey) => return self.survey(&survey),
            Event::Computed { cases, time: took } => {
                blocks.map(|it| it.finish());
                let (cases, took) = (counted(cases, "case"), time(took.as_secs_f64()));
                notify(&format!("{cases} computed in {took}"));
            }
            Event::Joining { folder } => {
                let place = printable(folder).to_string();
                return say_when_stopped(move || {
                    format!("all is kept in {place}; the same command joins it")
                });
            }
            Event::Joined { path, blocks } => return self.joined(path, blocks),
            other => self.stages.show(other),
        }
        Ok(())
    }

    /// Says which claims are waited for, where that was not said last.
    fn wait(&self, claims: &[ClaimStatus]) {
        let lines = format!("waiting for {}", claimed(claims).join("; "));
        let mut awaited = self.awaited.lock().unwrap_or_else(|it| it.into_inner());
        if *awaited != lines {
            notify(&lines);
            *awaited = lines;
        }
    }

    /// Says which blocks are there, and begins to show the progress of the others.
    fn survey(&self, survey: &Survey<'_>) -> Result<(), Failure> {
        let (kept, all) = (survey.kept.len(), survey.blocks);
        let place = printable(survey.folder).to_string();
        if kept > 0 {
            notify(&format!("{place}: {} of {} blocks are done and kept", count(kept), count(all)));
        }
        if kept == all {
            return Ok(());
        }
        let total = [all, survey.cases];
        let progress = self.blocks.get_or_init(|| Arc::new(BlockProgress::new(total, survey.kept)));
        let watched = Arc::clone(progress);
        say_when_stopped(move || blocks_kept([watched.blocks_done(), all], &place))
    }

    /// Prints what the file holds.
    fn joined(&self, path: &Path, blocks: &Blocks<'_>) -> Result<(), Failure> {
        let summary = summary(self.path, self.study, path, blocks).map_err(Failure::machine)?;
        print(&summary)?;
        let shown = printable(path).to_string();
        say_when_stopped(move || format!("{shown} is whole; the same command draws its figures"))
    }
}

/// Progress of each stage, once it has begun.
#[derive(Default)]
pub struct Stages([OnceLock<Progress>; 12]);

impl Stages {
    /// Shows the events of stages, and no others.
    pub fn show(&self, event: Event<'_>) {
        let Stages(all) = self;
        match event {
            Event::Begun(Stage::Tracing, saddles) => notify(&format!(
                "{}: their manifolds are followed, which may take a minute",
                counted(saddles, "saddle")
            )),
            Event::Begun(stage, steps) => {
                let count = match stage {
                    Stage::Outlining => Steps::AtMost,
                    _ => Steps::All,
                };
                all[stage as usize].get_or_init(|| Progress::new(steps, what(stage), count));
            }
            Event::Step(stage) => all[stage as usize].get().into_iter().for_each(Progress::step),
            Event::Ended(stage) => drop(all[stage as usize].get().map(Progress::finish)),
            _ => {}
        }
    }
}

/// What the steps of a stage are.
fn what(stage: Stage) -> &'static str {
    match stage {
        Stage::Linking => "links of attractors",
        Stage::Writing => "parts written",
        Stage::Continuing => "branches",
        Stage::Outlining => "tries of boundaries, at most",
        Stage::Repeating => "cases",
        Stage::Starting => "points between the cases",
        Stage::Climbing => "motions at other prices",
        Stage::Searching => "searches between the cases",
        Stage::Following => "gaps of the front",
        Stage::Drawing => "motions under tolerances",
        Stage::Bounding => "margins",
        Stage::Tracing => "manifolds",
    }
}
