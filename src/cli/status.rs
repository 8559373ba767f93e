//! `capsulemap status`: how far a sweep is, from the files on disk.

use std::path::{Path, PathBuf};

use clap::Args;

use super::arguments::study_arguments;
use super::claim_text::claimed;
use super::failure::Failure;
use super::readable::{count, counted, estimated, rate, size, time};
use super::summary::outcomes;
use super::terminal::print;
use crate::campaign::{BlockStatus, Campaign, CampaignError, block_path, output_path, read_study};
use crate::quantity::printable::printable;
use crate::store::Archive;
use crate::store::provenance::CREATED;
use crate::study::Study;

const EXAMPLES: &str = "\
Examples:
  capsulemap status STUDY.toml
  watch -n 10 capsulemap status STUDY.toml";

/// Say how far a sweep is.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Status {
    /// The study, a TOML file.
    study: PathBuf,
    /// The file that the sweep writes; results/NAME/NAME.h5 for a study NAME.toml by default.
    #[arg(long, value_name = "FILE.h5")]
    output: Option<PathBuf>,
}

impl Status {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let study = read_study(&self.study)?;
        let output = output_path(&self.study, self.output.as_deref())?;
        let status = Campaign::new(&study, &output).status()?;
        let mut text = String::new();
        if let Some(blocks) = &status.blocks {
            let arguments = study_arguments(&self.study, self.output.as_deref());
            text.push_str(&unfinished(&study, blocks, &arguments));
        }
        let file = status.file.map_err(|error| match error {
            // Nothing is replaced by looking at it.
            CampaignError::OtherResults { .. } => {
                Failure::request(format!("{error}; name another --output"))
            }
            error => Failure::from(error),
        });
        if let Ok(Some(kept)) = &file {
            text.push_str(&whole(&output, &kept.archive));
        }
        if text.is_empty() && file.is_ok() {
            text = format!("{}: nothing is there yet\n", printable(&block_path(&output)));
        }
        print(&text)?;
        file.map(drop)
    }
}

/// A file of this study.
fn whole(output: &Path, archive: &Archive) -> String {
    let created = archive.frame().attributes.get(CREATED).map_or("", String::as_str);
    let holds = match archive.has_cases() {
        true => "all cases",
        false => "branches only",
    };
    format!("{}: {holds}, written {created}\n", printable(output))
}

/// A run that is not finished; `arguments` name its study and output.
fn unfinished(study: &Study, blocks: &BlockStatus, arguments: &str) -> String {
    let done = count(blocks.done.len());
    let all = count(study.blocks());
    let shown = printable(&blocks.folder);
    let cases = count(blocks.cases());
    let (wanted, bytes) = (count(study.cases()), size(blocks.bytes as f64));
    let mut text = format!("{shown}: {done} of {all} blocks, {cases} of {wanted} cases, {bytes}\n");
    text.push_str(&outcomes(&blocks.done));
    if blocks.is_busy {
        text.push_str("a run is active");
    } else if blocks.done.len() == study.blocks() {
        text.push_str(&format!("all blocks are there: `capsulemap join {arguments}` joins them"));
    } else {
        text.push_str(&format!("no run is active: `capsulemap sweep {arguments}` resumes"));
    }
    text.push_str(&pace(study, blocks));
    text.push('\n');
    claimed(&blocks.claims).iter().for_each(|line| text.push_str(&format!("{line}\n")));
    for (maker, blocks) in &blocks.makers {
        text.push_str(&format!("{} by {maker}\n", counted(*blocks, "block")));
    }
    for (file, why) in &blocks.faults {
        text.push_str(&format!("{}: {why}\n", printable(file)));
    }
    text
}

/// When the last block came, how fast they come, and how long the rest will take.
fn pace(study: &Study, blocks: &BlockStatus) -> String {
    let Some(pace) = blocks.pace(study) else { return String::new() };
    let mut text = format!("; the last block came {} ago", time(pace.since_last.as_secs_f64()));
    if let Some(lately) = pace.cases_per_second {
        text.push_str(&format!(", {} cases/s lately", rate(lately)));
    }
    if let Some(left) = pace.left {
        text.push_str(&format!(", {} left at that pace", estimated(left)));
    }
    text
}
