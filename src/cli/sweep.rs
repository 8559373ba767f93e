//! `capsulemap sweep`: a study, from its file to its results and figures.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;

use super::arguments::{machine, named, study_arguments};
use super::drawing::{FormatChoice, draw_from, formats};
use super::dry_run::estimate;
use super::failure::Failure;
use super::rehearsal::rehearse_study;
use super::scheduler::{self, AskedTask};
use super::stop::before_end;
use super::terminal::notify;
use super::watch::Watch;
use crate::campaign::{
    Campaign, CampaignError, Claims, Complete, Done, Event, Task, output_path, read_study,
};
use crate::figure::Place;
use crate::lane::Instructions;
use crate::quantity::printable::printable;
use crate::store::folder;
use crate::study::Study;

const EXAMPLES: &str = "\
Examples:
  capsulemap sweep studies/overview.toml
  capsulemap sweep STUDY.toml --dry-run
  capsulemap sweep STUDY.toml --output /data/NAME.h5 --threads 8
  capsulemap sweep STUDY.toml --task 3/8   # the third of 8 machines
  capsulemap join STUDY.toml               # once all 8 are done
  capsulemap sweep STUDY.toml --claim      # on any number of machines

A run that was interrupted is resumed by the same command. Without --task, an element of an array of Slurm, Grid Engine, LSF or AWS \
Batch takes its part by itself. PBS, Torque and indexed jobs of Kubernetes do not say how many elements there are: \
--task $PBS_ARRAY_INDEX/8. The same goes for HyperQueue ($HQ_TASK_ID) and GNU parallel ($PARALLEL_SEQ). scripts/slurm, scripts/pbs and \
scripts/kubernetes have array scripts. Processes with --claim share a study without numbers; capsulemap help book clusters shows how.";

/// Compute a study.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Sweep {
    /// The study, a TOML file.
    study: PathBuf,
    /// The file to write; results/NAME/NAME.h5 for a study NAME.toml by default. The blocks that are done lie
    /// beside it, in a folder NAME.blocks, until they are joined.
    #[arg(long, value_name = "FILE.h5")]
    output: Option<PathBuf>,
    /// Compute the I-th of N parts only, and do not join them; 1/1 is all, whatever a scheduler says. With auto, and without this option in
    /// an array of Slurm, Grid Engine, LSF or AWS Batch, the scheduler says which part.
    #[arg(long, value_name = "I/N|auto")]
    task: Option<AskedTask>,
    /// The number of the first part: 0 where a scheduler counts so.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "task")]
    first_task: usize,
    /// Compute blocks that no other process has claimed, one by one, among any number of processes with the same folder of results, which
    /// may come and go; the last joins all. In an array of a scheduler its numbers are not looked at.
    #[arg(long, conflicts_with_all = ["task", "overwrite"])]
    claim: bool,
    /// Others may take a block of this process whose claim was not renewed for so long; it is renewed twelve times as often. Longer
    /// than what is written on one machine takes to be seen on another.
    #[arg(long, value_name = "SECONDS", default_value_t = 60, requires = "claim",
        value_parser = clap::value_parser!(u32).range(1..=86_400))]
    claim_limit: u32,
    /// Compute nothing but a few blocks as a probe, and estimate time and size.
    #[arg(long)]
    dry_run: bool,
    /// Worker threads; one per core by default, or SLURM_CPUS_PER_TASK, NSLOTS, NCPUS, LSB_DJOB_NUMPROC or OMP_NUM_THREADS, the first that is set.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Instructions to compute by; the widest that the processor has, or that the study fills, by default.
    /// Results do not depend on them.
    #[arg(long, value_parser = named(&Instructions::NAMES))]
    instructions: Option<Instructions>,
    /// Replace a file of results that another study left under that name, and delete its blocks; replace files in
    /// the place of figures, too.
    #[arg(long)]
    overwrite: bool,
    /// Do not draw the study's figures.
    #[arg(long)]
    no_figures: bool,
    /// File formats of the figures.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "png,svg,pdf")]
    formats: Vec<FormatChoice>,
}

impl Sweep {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = machine(self.threads, self.instructions)?;
        let study = read_study(&self.study)?;
        let notes = study.remarks.iter().cloned().chain(study.remarks_on_values());
        let notes = notes.chain(study.varied_without_effect());
        notes.for_each(|why| notify(&format!("note: {why}")));
        let output = output_path(&self.study, self.output.as_deref())?;
        let overwrite = self.overwrite;
        let campaign = Campaign { study: &study, output: &output, machine, overwrite };
        let formats = formats(&self.formats);
        let place = Place { folder: folder(&output), formats: &formats, overwrite };
        if self.dry_run {
            campaign.kept()?;
            self.rehearse(&study, &place)?;
            return estimate(&campaign, self.task()?);
        }
        let task = self.task()?;
        let watch = Watch::new(&self.study, &study);
        let done = self.compute(&campaign, task, &watch, &place);
        match watch.end(done)? {
            Done::Complete(Complete { archive, .. }) if !self.no_figures && task.of == 1 => {
                draw_from(&archive, &study, &place)
            }
            Done::Complete(_) => Ok(()),
            Done::Elsewhere(file) => {
                let shown = printable(&file.path);
                notify(&format!("{shown}: is whole; another process has joined it"));
                Ok(())
            }
            Done::Shared(blocks) => {
                self.part_with(task, &blocks, study.blocks());
                Ok(())
            }
        }
    }

    /// Computes a part of the study, or what can be claimed.
    fn compute(
        &self,
        campaign: &Campaign<'_>,
        task: Task,
        watch: &Watch<'_>,
        place: &Place<'_>,
    ) -> Result<Done, CampaignError> {
        if !self.claim {
            return campaign.run(task, &|event| self.hear(event, campaign, watch, place));
        }
        let claims = Claims::new(Duration::from_secs(self.claim_limit.into()));
        let held = claims.clone();
        before_end(move || held.release_all());
        campaign.run_with_claims(&claims, &|event| self.hear(event, campaign, watch, place))
    }

    /// Shows an event; before anything is written, tries whether the figures can be drawn.
    fn hear(
        &self,
        event: Event<'_>,
        campaign: &Campaign<'_>,
        watch: &Watch<'_>,
        place: &Place<'_>,
    ) -> ControlFlow<()> {
        match event {
            Event::Before { same_text } => {
                let source = if same_text { "this study" } else { "a study with the same cases" };
                let shown = printable(campaign.output);
                notify(&format!("{shown}: already computed, by this program from {source}"));
                ControlFlow::Continue(())
            }
            Event::Accepted(_) => watch.heed(self.rehearse(campaign.study, place)),
            other => watch.hear(other),
        }
    }

    /// Draws the figures as if no case were done.
    fn rehearse(&self, study: &Study, place: &Place<'_>) -> Result<(), Failure> {
        if self.no_figures {
            return Ok(());
        }
        rehearse_study(study, place)
            .map_err(|failure| failure.within(&printable(&self.study).to_string()))
    }

    /// Which part of the study to compute.
    fn task(&self) -> Result<Task, Failure> {
        if self.claim {
            return Ok(Task::WHOLE);
        }
        let task = match self.task {
            Some(AskedTask::Part { number, of }) => self.part(number, of)?,
            asked => {
                let found = scheduler::task(asked.is_some(), &|name| std::env::var(name).ok());
                let found = found.map_err(|why| match asked {
                    Some(_) => Failure::request(format!("--task auto: {why}")),
                    None => Failure::request(why),
                })?;
                let Some((task, name)) = found else { return Ok(Task::WHOLE) };
                notify(&format!("{task}, as {name} says; --task 1/1 computes all"));
                task
            }
        };
        if task.of > 1 {
            notify(&format!("{task}: one block in {}", task.of));
        }
        Ok(task)
    }

    /// The part of this number, counted from the first.
    fn part(&self, number: usize, of: usize) -> Result<Task, Failure> {
        let first = self.first_task;
        let place = number.checked_sub(first).filter(|place| *place < of);
        place.map(|place| Task { number: place + 1, of }).ok_or_else(|| {
            let last = (first + of).saturating_sub(1);
            Failure::request(format!(
                "--task {number}/{of}: expected I/N with I from {first} to {last}, as N is {of} and the first part has the number {first}"
            ))
        })
    }

    /// The end of a task of a study with `count` blocks.
    fn part_with(&self, task: Task, blocks: &Path, count: usize) {
        let shown = printable(blocks);
        if task.number > count {
            notify(&format!("{task}: no block is its own, as the study has {count}"));
            return;
        }
        let join = study_arguments(&self.study, self.output.as_deref());
        notify(&format!(
            "{task}: its blocks are in {shown}; once all tasks are done: capsulemap join {join}"
        ));
    }
}
