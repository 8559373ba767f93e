//! `capsulemap join`: the blocks of a study into one file of results.

use std::path::{Path, PathBuf};

use clap::Args;

use super::blocks::{clear_away, enter};
use super::figure::{FormatChoice, draw_from};
use super::progress::Progress;
use super::result_file::{Kept, branches_of, kept, output_path, prepare, read_study};
use super::stop::say_when_stopped;
use super::summary::summary;
use super::words::counted;
use super::{Failure, print, tell};
use crate::run::{self, Machine, has_attractors};
use crate::store::{self, Archive, BlockFolder, Blocks, Company, Dataset, Unusable, keep_branches};
use crate::study::Study;

const EXAMPLES: &str = "\
Examples:
  capsulemap join night.toml
  capsulemap join night.toml --partial

`sweep` joins by itself unless it was one task of several. With --partial the file and the figures go to a
folder `partial` beside the blocks; cases that are not done have the outcome `missing`.";

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
        let older = kept(&output, &study, self.overwrite || self.partial)?;
        let machine = super::machine(self.threads, None)?;
        let (archive, file) = match older {
            Some(Kept { archive, .. }) if archive.has_cases() => {
                tell(&format!("{}: is there, whole, from this study", output.display()));
                if !self.partial {
                    clear_away(&output, &study)?;
                }
                (archive, output)
            }
            older => {
                branches_of(older, &output, self.overwrite || self.partial)?;
                let company = if self.partial { Company::Anybody } else { Company::Alone };
                let blocks = enter(&output, &study, company, false)?;
                let file = if self.partial { partial(&output) } else { output.clone() };
                let joining = Joining {
                    path: &self.study,
                    study: &study,
                    machine,
                    file: &file,
                    beside: &output,
                    overwrite: self.overwrite || self.partial,
                };
                (joining.join(blocks, self.partial)?, file)
            }
        };
        if !self.no_figures {
            draw_from(&archive, &study.drawings, store::folder(&file), &self.formats)?;
        }
        Ok(())
    }
}

/// Where a look before the end goes.
fn partial(output: &Path) -> PathBuf {
    store::folder(output).join("partial").join(output.file_name().unwrap_or_default())
}

/// Blocks on their way into a file.
pub struct Joining<'a> {
    /// The file of the study.
    pub path: &'a Path,
    /// The study.
    pub study: &'a Study,
    /// What to search for attractors on.
    pub machine: Machine,
    /// The file to write.
    pub file: &'a Path,
    /// The file whose branches it takes over, which it replaces unless it is only a look.
    pub beside: &'a Path,
    /// Whether a file of another study is given up.
    pub overwrite: bool,
}

impl Joining<'_> {
    /// Joins the blocks in `folder` into the file, beside branches that have been followed by then, and
    /// removes them, unless they are only a part.
    pub fn join(&self, folder: BlockFolder, is_partial: bool) -> Result<Archive, Failure> {
        prepare(store::folder(self.file))?;
        let blocks = Blocks::open(&folder, self.study, 0..self.study.blocks());
        if !is_partial && !blocks.missing.is_empty() {
            return Err(Failure::request(incomplete(&folder, &blocks.missing)));
        }
        for (number, why) in blocks.missing.iter().filter(|(_, why)| !is_missing(why)) {
            tell(&format!("{}: {why}; it is left out", folder.file(*number).display()));
        }
        let place = folder.path().display().to_string();
        say_when_stopped(move || format!("all is kept in {place}; the same command joins it"))?;
        let mut frame = blocks.frame();
        self.add_attractors(&mut frame, &blocks)?;
        // Branches that were followed meanwhile are in the file, and none can come before it is replaced.
        let _held = store::hold(self.file).map_err(Failure::machine)?;
        let older = kept(self.beside, self.study, self.overwrite)?;
        if let Some(branches) = branches_of(older, self.beside, self.overwrite)? {
            keep_branches(&mut frame, &branches);
        }
        store::discard_unfinished(self.file).map_err(Failure::machine)?;
        let progress = std::cell::OnceCell::new();
        let begun = |steps| drop(progress.set(Progress::new(steps, "pieces written")));
        let done = || progress.get().into_iter().for_each(Progress::step);
        blocks.join(&frame, self.file, begun, done).map_err(Failure::machine)?;
        progress.get().map(Progress::finish);
        let archive = store::open(self.file).map_err(Failure::machine)?;
        print(&summary(self, &blocks).map_err(Failure::machine)?)?;
        drop(blocks);
        let shown = self.file.display().to_string();
        say_when_stopped(move || format!("{shown} is whole; the same command draws its figures"))?;
        if !is_partial {
            folder.remove().map_err(Failure::machine)?;
        }
        Ok(archive)
    }

    /// Searches for the attractors that the cases of `blocks` have ended on, if any are to be told apart.
    fn add_attractors(&self, frame: &mut Dataset, blocks: &Blocks<'_>) -> Result<(), Failure> {
        if !has_attractors(self.study) {
            return Ok(());
        }
        let progress = Progress::new(run::links(self.study), "links of attractors");
        let endings = blocks.endings().map_err(Failure::machine)?;
        let attractors = run::attractors(self.study, &endings, self.machine, || progress.step());
        let attractors = attractors.map_err(Failure::machine)?;
        progress.finish();
        store::add_attractors(frame, self.study, &attractors);
        Ok(())
    }
}

fn is_missing(why: &Unusable) -> bool {
    matches!(why, Unusable::Missing)
}

/// What is missing, and how to get it.
fn incomplete(folder: &BlockFolder, missing: &[(usize, Unusable)]) -> String {
    let shown = folder.path().display();
    let mut text = format!(
        "{shown}: {} missing: {}",
        counted(missing.len(), "block"),
        ranges(missing.iter().map(|(number, _)| *number))
    );
    for (number, why) in missing.iter().filter(|(_, why)| !is_missing(why)) {
        text.push_str(&format!("\n{}: {why}", folder.file(*number).display()));
    }
    text.push_str(
        "\nrun `capsulemap sweep` again, or those tasks that did not end well; --partial joins what there is",
    );
    text
}

/// Numbers in rising order as ranges: "3, 17-24, 90".
fn ranges(numbers: impl Iterator<Item = usize>) -> String {
    let mut ranges: Vec<[usize; 2]> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some([_, last]) if *last + 1 == number => *last = number,
            _ => ranges.push([number, number]),
        }
    }
    let words = ranges.iter().map(|[first, last]| match first == last {
        true => first.to_string(),
        false => format!("{first}-{last}"),
    });
    words.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::ranges;

    #[test]
    fn neighbours_are_told_as_ranges() {
        assert_eq!(ranges([3, 17, 18, 19, 90].into_iter()), "3, 17-19, 90");
        assert_eq!(ranges(std::iter::empty()), "");
    }
}
