//! `capsulemap join`: the blocks of a study into one file of results.

use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;

use super::arguments::machine;
use super::drawing::{FormatChoice, draw_from, formats};
use super::failure::Failure;
use super::readable::counted;
use super::terminal::{notify, print};
use super::watch::Watch;
use crate::campaign::{Campaign, Event, output_path, read_study};
use crate::figure::Place;
use crate::quantity::printable::printable;
use crate::store;

const EXAMPLES: &str = "\
Examples:
  capsulemap join STUDY.toml
  capsulemap join STUDY.toml --partial
  capsulemap join STUDY.toml --missing 8   # of 8 tasks, those to repeat
  capsulemap join STUDY.toml --from a/NAME.blocks b/NAME.blocks

`sweep` joins by itself unless it was one task of several. With --partial the file and the figures go to a \
folder `partial` beside the blocks; cases that are not done have the outcome `missing`. Machines that share no disk leave their blocks in \
folders of their own, as results/NAME/NAME.blocks; --from copies from these what is missing here, and leaves them as they are.";

/// Join the blocks that the tasks of a sweep have computed.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Join {
    /// The study, a TOML file.
    study: PathBuf,
    /// The file to write; results/NAME/NAME.h5 for a study NAME.toml by default.
    #[arg(long, value_name = "FILE.h5")]
    output: Option<PathBuf>,
    /// Join what there is, for a look before the end; the blocks stay.
    #[arg(long)]
    partial: bool,
    /// Join nothing, and print which of so many tasks lack blocks, as a list for an array; nothing where none is missing.
    #[arg(long, value_name = "TASKS", conflicts_with_all = ["partial", "overwrite"],
        value_parser = clap::value_parser!(u32).range(1..))]
    missing: Option<u32>,
    /// Folders of blocks of other machines, of which those are copied that are missing here.
    #[arg(long, value_name = "FOLDER", num_args = 1.., conflicts_with = "missing")]
    from: Vec<PathBuf>,
    /// Replace a file of results that another study left under that name.
    #[arg(long, conflicts_with = "partial")]
    overwrite: bool,
    /// Worker threads for the search for attractors; one per core by default, or SLURM_CPUS_PER_TASK.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Do not draw the study's figures.
    #[arg(long)]
    no_figures: bool,
    /// File formats of the figures.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "png,svg,pdf")]
    formats: Vec<FormatChoice>,
}

impl Join {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let study = read_study(&self.study)?;
        let output = output_path(&self.study, self.output.as_deref())?;
        let machine = machine(self.threads, None)?;
        let overwrite = self.overwrite;
        let campaign = Campaign { study: &study, output: &output, machine, overwrite };
        if let Some(tasks) = self.missing {
            let missing = campaign.unfinished_tasks(tasks as usize)?;
            let missing: Vec<String> = missing.iter().map(usize::to_string).collect();
            return print(&format!("{}\n", missing.join(",")));
        }
        let watch = Watch::new(&self.study, &study);
        for folder in &self.from {
            let copied = watch.end(campaign.collect(folder, &|event| watch.hear(event)))?;
            notify(&format!("{}: {} copied", printable(folder), counted(copied, "block")));
        }
        let join = if self.partial { Campaign::join_partial } else { Campaign::join };
        let joined = join(&campaign, &|event| match event {
            Event::Before { .. } => {
                notify(&format!("{}: is there, whole, from this study", printable(&output)));
                ControlFlow::Continue(())
            }
            other => watch.hear(other),
        });
        let file = watch.end(joined)?;
        if !self.no_figures {
            let folder = store::folder(&file.path);
            let formats = formats(&self.formats);
            let place = Place { folder, formats: &formats, overwrite };
            draw_from(&file.archive, &study, &place)?;
        }
        Ok(())
    }
}
