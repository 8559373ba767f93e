//! `capsulemap status`: how far a sweep is, told from what lies on disk.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use clap::Args;

use super::blocks::block_path;
use super::result_file::{Kept, kept, output_path, read_study};
use super::summary::outcomes;
use super::words::{count, counted, estimated, rate, size, time};
use super::{Failure, print};
use crate::run::Forecast;
use crate::store::{Archive, BlockFolder, Company, StoreError, Summary, Unusable, provenance};
use crate::study::Study;

const EXAMPLES: &str = "\
Examples:
  capsulemap status night.toml
  watch -n 10 capsulemap status night.toml";

/// The rate now is that of the blocks written within this time.
const NOW: Duration = Duration::from_secs(300);

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

/// The blocks that are there.
#[derive(Default)]
struct There {
    blocks: Vec<Summary>,
    /// When each was written.
    written: Vec<SystemTime>,
    bytes: u64,
    /// Blocks by who made them.
    makers: BTreeMap<String, usize>,
    /// What is wrong with others.
    faults: Vec<String>,
}

impl Status {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let study = read_study(&self.study)?;
        let output = output_path(&self.study, self.output.as_deref())?;
        let path = block_path(&output);
        let mut text = String::new();
        if path.is_dir() {
            let folder = BlockFolder::enter(&path, &study, Company::Anybody, false);
            let folder = folder.map_err(|error| match error {
                StoreError::Changed { .. } => Failure::request(error),
                _ => Failure::machine(error),
            })?;
            text.push_str(&on_the_way(&study, &folder, BlockFolder::is_busy(&path)));
        }
        match kept(&output, &study, false) {
            Ok(None) => {}
            Ok(Some(Kept { archive, .. })) => text.push_str(&whole(&output, &archive)),
            Err(refused) => text.push_str(&format!("{refused}\n")),
        }
        if text.is_empty() {
            text = format!("{}: nothing is there yet\n", path.display());
        }
        print(&text)
    }
}

/// A file of this study.
fn whole(output: &Path, archive: &Archive) -> String {
    let made = archive.frame().attributes.get("created").map_or("", String::as_str);
    let holds = match archive.has_cases() {
        true => "all cases",
        false => "branches only",
    };
    format!("{}: {holds}, written {made}\n", output.display())
}

/// A run that has not come to its end.
fn on_the_way(study: &Study, folder: &BlockFolder, is_busy: bool) -> String {
    let there = there(study, folder);
    let done = count(there.blocks.len());
    let all = count(study.blocks());
    let shown = folder.path().display();
    let cases = count(there.blocks.iter().map(|block| block.cases).sum());
    let (wanted, bytes) = (count(study.cases()), size(there.bytes as f64));
    let mut text = format!("{shown}: {done} of {all} blocks, {cases} of {wanted} cases, {bytes}\n");
    text.push_str(&outcomes(&there.blocks));
    if is_busy {
        text.push_str("at work now");
    } else if there.blocks.len() == study.blocks() {
        text.push_str("all blocks are there: `capsulemap join` puts them together");
    } else {
        text.push_str("nobody is at work: `capsulemap sweep` goes on");
    }
    text.push_str(&pace(study, &there));
    text.push('\n');
    for (maker, blocks) in &there.makers {
        text.push_str(&format!("{} by {maker}\n", counted(*blocks, "block")));
    }
    there.faults.iter().for_each(|fault| text.push_str(&format!("{fault}\n")));
    text
}

/// When the last block came, how fast they come, and how long the rest will take.
fn pace(study: &Study, there: &There) -> String {
    let Some(&last) = there.written.iter().max() else { return String::new() };
    let since = last.elapsed().unwrap_or(Duration::ZERO);
    let mut text = format!("; the last block came {} ago", time(since.as_secs_f64()));
    let recent = |at: &SystemTime| last.duration_since(*at).is_ok_and(|ago| ago <= NOW);
    let first = there.written.iter().copied().filter(recent).min().unwrap_or(last);
    let span = last.duration_since(first).unwrap_or(Duration::ZERO).as_secs_f64();
    // The first block of the span was computed before it.
    let within = |at: &SystemTime| *at > first && *at <= last;
    let both = there.blocks.iter().zip(&there.written);
    let in_span: Vec<&Summary> = both.filter(|(_, at)| within(at)).map(|(it, _)| it).collect();
    let cases: usize = in_span.iter().map(|block| block.cases).sum();
    let cycles: u64 = in_span.iter().map(|block| block.cycles).sum();
    if cycles == 0 || span == 0.0 {
        return text;
    }
    let mut forecast = Forecast::new(study.cases());
    there.blocks.iter().for_each(|it| forecast.add(it.number, it.cases, (it.cases, it.cycles)));
    text.push_str(&format!(", {} cases/s lately", rate(cases as f64 / span)));
    if let Some(left) = forecast.seconds_left(span / cycles as f64) {
        text.push_str(&format!(", {} left at that pace", estimated(left)));
    }
    text
}

/// Looks at the heads of all blocks, not at their numbers.
fn there(study: &Study, folder: &BlockFolder) -> There {
    let mut there = There::default();
    for number in 0..study.blocks() {
        let file = folder.file(number);
        match folder.glance(number) {
            Ok(head) => {
                let metadata = std::fs::metadata(&file);
                there.bytes += metadata.as_ref().map_or(0, |it| it.len());
                let written = metadata.and_then(|it| it.modified());
                there.written.push(written.unwrap_or(SystemTime::UNIX_EPOCH));
                *there.makers.entry(provenance::maker(&head.made)).or_default() += 1;
                there.blocks.push(head.block);
            }
            Err(Unusable::Missing) => {}
            Err(why) => there.faults.push(format!("{}: {why}", file.display())),
        }
    }
    there
}
