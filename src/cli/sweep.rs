//! `capsulemap sweep`: a study, from its file to its results and figures.

use std::path::PathBuf;

use clap::Args;

use super::blocks::{clear_away, compute, enter};
use super::dry_run::foretell;
use super::figure::{FormatChoice, draw_from};
use super::join::Joining;
use super::result_file::{Kept, branches_of, kept, output_path, prepare, read_study, rehearse};
use super::task::Task;
use super::words::{counted, time};
use super::{Failure, machine, named, tell};
use crate::lane::Instructions;
use crate::store::{self, Archive, BlockFolder, Company, Dataset, folder};
use crate::study::Study;

const EXAMPLES: &str = "\
Examples:
  capsulemap sweep studies/overview.toml
  capsulemap sweep night.toml --dry-run
  capsulemap sweep night.toml --output /data/night.h5 --threads 8
  capsulemap sweep night.toml --task 3/8      # on each of 8 machines; then: capsulemap join night.toml

A run that was stopped, by whatever, goes on with the same command. Without --task, a job of a Slurm array
takes its part by itself; scripts/slurm has the array script.";

/// More values on an axis than this are alike to every figure.
const MOST_VALUES: usize = 16;

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
    /// Compute the I-th of N parts only, and do not join them; 1/1 is all, whatever Slurm says.
    #[arg(long, value_name = "I/N")]
    task: Option<Task>,
    /// Compute nothing but a few blocks as a probe, and foretell time and size.
    #[arg(long, conflicts_with = "task")]
    dry_run: bool,
    /// Worker threads; one per core by default, or SLURM_CPUS_PER_TASK.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Instructions to compute by; the widest that the processor has, or that the study fills, by default.
    /// Results do not depend on them.
    #[arg(long, value_parser = named(&Instructions::NAMES))]
    instructions: Option<Instructions>,
    /// Replace a file of results that another study left under that name, and give up its blocks.
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
        let output = output_path(&self.study, self.output.as_deref())?;
        let older = kept(&output, &study, self.overwrite)?;
        if self.dry_run {
            return foretell(&study, machine, &output);
        }
        let task = self.task()?;
        let joining = Joining {
            path: &self.study,
            study: &study,
            machine,
            file: &output,
            beside: &output,
            overwrite: self.overwrite,
        };
        let archive = match older {
            Some(older) if self.suffices(&older) => self.already(&joining, older)?,
            older => {
                branches_of(older, &output, self.overwrite)?;
                match self.compute(&joining, task)? {
                    Some(archive) => archive,
                    None => return Ok(()),
                }
            }
        };
        if !self.no_figures && task.of == 1 {
            draw_from(&archive, &study.drawings, folder(&output), &self.formats)?;
        }
        Ok(())
    }

    /// Whether a file that is there has all cases and is to stay.
    fn suffices(&self, older: &Kept) -> bool {
        older.archive.has_cases() && !self.overwrite
    }

    /// Says that a file is there, and clears away what a run has left that was stopped at its very end.
    fn already(&self, joining: &Joining<'_>, older: Kept) -> Result<Archive, Failure> {
        let words = if older.same_words { "this study" } else { "a study with the same cases" };
        let shown = joining.file.display();
        tell(&format!("{shown}: already computed, by this program from {words}"));
        clear_away(joining.file, joining.study)?;
        Ok(older.archive)
    }

    /// Computes the blocks of a task, and joins them if it is the only one.
    fn compute(&self, joining: &Joining<'_>, task: Task) -> Result<Option<Archive>, Failure> {
        let Joining { study, machine, file, .. } = *joining;
        if !self.no_figures {
            rehearse(&without_cases(study), &study.drawings)
                .map_err(|failure| failure.within(&self.study.display().to_string()))?;
        }
        prepare(folder(file))?;
        let company = if task.of > 1 { Company::Tasks } else { Company::Alone };
        let blocks = enter(file, study, company, self.overwrite)?;
        // A run that has just ended may have joined all while this one waited for it.
        let older = kept(file, study, self.overwrite)?;
        if let Some(older) = older.filter(|older| self.suffices(older)) {
            drop(blocks);
            return self.already(joining, older).map(Some);
        }
        let added = compute(study, machine, &blocks, task)?;
        if added.cases > 0 {
            let seconds = added.time.as_secs_f64();
            tell(&format!("{} computed in {}", counted(added.cases, "case"), time(seconds)));
        }
        if task.of > 1 {
            self.part_with(task, &blocks);
            return Ok(None);
        }
        joining.join(blocks, false).map(Some)
    }

    /// Which part of the study to compute.
    fn task(&self) -> Result<Task, Failure> {
        let from_slurm = || Task::of_slurm(|name| std::env::var(name).ok());
        let task = match self.task {
            Some(task) => task,
            None => match from_slurm() {
                None => return Ok(Task::WHOLE),
                Some(task) => {
                    let task = task.map_err(Failure::request)?;
                    tell(&format!("{task}, as SLURM_ARRAY_TASK_ID says; --task 1/1 computes all"));
                    task
                }
            },
        };
        if task.of > 1 {
            tell(&format!("{task}: one block in {}", task.of));
        }
        Ok(task)
    }

    /// The end of a task.
    fn part_with(&self, task: Task, blocks: &BlockFolder) {
        let (shown, study) = (blocks.path().display(), self.study.display());
        tell(&format!(
            "{task}: its blocks are in {shown}; once all tasks are done: capsulemap join {study}"
        ));
    }
}

/// The results of a study of which no case is done, with no more values than figures look at, as each has
/// room for what its cases would have.
fn without_cases(study: &Study) -> Dataset {
    let mut small = study.clone();
    small.protocol.points = small.protocol.points.min(1);
    small.protocol.impact_points = small.protocol.impact_points.min(1);
    small.case_set.truncate(MOST_VALUES);
    if let Some(span) = &mut small.protocol.history {
        span.per_cycle = span.per_cycle.min(2);
    }
    store::dataset(&small, &[])
}
