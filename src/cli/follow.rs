//! `capsulemap follow`: the branches of a study, into the file of its results.

use std::path::{Path, PathBuf};

use clap::Args;

use super::branch_summary::summary;
use super::figure::{FormatChoice, draw_from};
use super::progress::Progress;
use super::result_file::{Kept, kept, output_path, prepare, read_study, rehearse};
use super::{Failure, print, tell};
use crate::run::{Unfollowed, follow};
use crate::store::{self, Archive, Dataset, add_branches, drop_branches, folder, has_branches};
use crate::study::Study;

const EXAMPLES: &str = "\
Examples:
  capsulemap follow studies/hysteresis.toml
  capsulemap follow branches.toml --output /data/branches.h5 --threads 2
  capsulemap sweep STUDY.toml && capsulemap follow STUDY.toml --formats pdf";

/// Follow periodic orbits through parameters.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Follow {
    /// The study, a TOML file with [[branches]].
    study: PathBuf,
    /// The file to add the branches to; results/NAME/NAME.h5 for a study NAME.toml by default.
    #[arg(long, value_name = "FILE.h5")]
    output: Option<PathBuf>,
    /// Worker threads; one per core by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Follow again, and replace a file of results that another study left under that name.
    #[arg(long)]
    overwrite: bool,
    /// Do not draw the study's figures.
    #[arg(long)]
    no_figures: bool,
    /// File formats of the figures.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "png,svg,pdf")]
    formats: Vec<FormatChoice>,
}

impl Follow {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let name = self.study.display().to_string();
        let study = read_study(&self.study)?;
        if study.branches.is_empty() {
            let message = format!("{name}: asks for no [[branches]]; studies/README.md shows how");
            return Err(Failure::request(message));
        }
        let output = output_path(&self.study, self.output.as_deref())?;
        let archive = match kept(&output, &study, self.overwrite)? {
            Some(Kept { archive, same_words: true })
                if has_branches(archive.frame()) && !self.overwrite =>
            {
                let shown = output.display();
                tell(&format!("{shown}: already followed, by this program from this study"));
                archive
            }
            older => {
                if !self.no_figures {
                    let mut dataset = self.older(older, &study, &output)?;
                    drop_branches(&mut dataset);
                    self.rehearse(&study, &dataset).map_err(|failure| failure.within(&name))?;
                }
                prepare(folder(&output))?;
                self.follow(&study, &output)?
            }
        };
        if !self.no_figures {
            draw_from(&archive, &study.drawings, folder(&output), &self.formats)?;
        }
        Ok(())
    }

    /// What the file holds already, in the words of this study; its cases stay, whatever else has changed.
    fn older(&self, older: Option<Kept>, study: &Study, output: &Path) -> Result<Dataset, Failure> {
        let Some(Kept { archive, same_words }) = older else { return Ok(store::frame(study)) };
        if has_branches(archive.frame()) && !same_words && !self.overwrite {
            return Err(Failure::request(format!(
                "{}: holds branches of a study in other words; --overwrite follows anew and keeps the cases",
                output.display()
            )));
        }
        let mut dataset = archive.dataset(|_, _| true).map_err(Failure::machine)?;
        let frame = store::frame(study);
        dataset.texts.extend(frame.texts);
        dataset.attributes.extend(frame.attributes);
        Ok(dataset)
    }

    /// Draws the figures as if no branch could be followed.
    fn rehearse(&self, study: &Study, dataset: &Dataset) -> Result<(), Failure> {
        let mut empty = dataset.clone();
        let nothing = vec![Err(Unfollowed::NoOrbit); study.branches.len()];
        add_branches(&mut empty, study, &nothing);
        rehearse(&empty, &study.drawings)
    }

    /// Follows the branches and writes them beside what the file holds by then.
    fn follow(&self, study: &Study, output: &Path) -> Result<Archive, Failure> {
        let progress = Progress::new(study.branches.len(), "branches");
        let threads = self.threads.map(usize::from);
        let followed = follow(study, threads, || progress.step()).map_err(Failure::machine)?;
        let seconds = progress.finish().as_secs_f64();
        // Cases that were joined meanwhile are in the file, and none can come before it is replaced.
        let _held = store::hold(output).map_err(Failure::machine)?;
        let mut dataset = self.older(kept(output, study, self.overwrite)?, study, output)?;
        drop_branches(&mut dataset);
        add_branches(&mut dataset, study, &followed);
        store::write(&dataset, output).map_err(Failure::machine)?;
        print(&summary(study, &followed, output, seconds))?;
        store::open(output).map_err(Failure::machine)
    }
}
