//! `capsulemap sweep`: a study, from its file to its results and figures.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;

use super::figure::{FormatChoice, draw_all, file_stem};
use super::progress::Progress;
use super::{Failure, named, print, tell};
use crate::lane::Instructions;
use crate::model::{Parameter, Parameters, Resistance, Switching};
use crate::orbit::{Case, Outcome, Protocol};
use crate::store::{self, Dataset};
use crate::sweep::{self, Machine, Record, Study, has_attractors, run};

const EXAMPLES: &str = "\
Examples:
  capsulemap sweep studies/overview.toml
  capsulemap sweep night.toml --output /data/night.h5 --threads 8
  capsulemap sweep studies/fig5.toml --formats pdf";

/// So many failed cases are named in the summary; the file names them all.
const FAILURES_SHOWN: usize = 5;

/// Compute a study.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Sweep {
    /// The study, a TOML file.
    study: PathBuf,
    /// The file to write; results/NAME/NAME.h5 for a study NAME.toml by default.
    #[arg(long, value_name = "FILE.h5")]
    output: Option<PathBuf>,
    /// Worker threads; one per core by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Instructions to compute by; the widest that the processor has, or that the study fills, by default.
    /// Results do not depend on them.
    #[arg(long, value_parser = named(&Instructions::NAMES))]
    instructions: Option<Instructions>,
    /// Replace a file of results that another study left under that name.
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
        let machine = self.machine()?;
        let name = self.study.display().to_string();
        let study = Study::parse(&name, &self.text()?).map_err(Failure::request)?;
        let output = self.output_path()?;
        let folder = output.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new("."));
        let dataset = match self.finished(&output, &study)? {
            Some(dataset) => dataset,
            None => {
                if !self.no_figures {
                    rehearse(&study).map_err(|failure| failure.within(&name))?;
                }
                prepare(folder)?;
                self.compute(&study, machine, &output)?
            }
        };
        if !self.no_figures {
            draw_all(&dataset, &study.drawings, folder, &self.formats)?;
        }
        Ok(())
    }

    /// The text of the study file.
    fn text(&self) -> Result<String, Failure> {
        let name = self.study.display();
        let bytes = std::fs::read(&self.study)
            .map_err(|error| Failure::request(format!("{name}: cannot be read: {error}")))?;
        String::from_utf8(bytes).map_err(|error| {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = valid.iter().filter(|&&byte| byte == b'\n').count() + 1;
            Failure::request(format!("{name}: line {line}: is not text in UTF-8"))
        })
    }

    fn output_path(&self) -> Result<PathBuf, Failure> {
        let stem = file_stem(&self.study)?;
        let default = || Path::new("results").join(&stem).join(format!("{stem}.h5"));
        let output = self.output.clone().unwrap_or_else(default);
        if output.exists() && !output.is_file() {
            let what = if output.is_dir() { "a folder" } else { "not a plain file" };
            let message = format!("{}: is {what}; name a file", output.display());
            return Err(Failure::request(message));
        }
        let same = |path: &Path| std::fs::canonicalize(path).ok();
        if same(&output).is_some_and(|output| Some(output) == same(&self.study)) {
            let message = format!("{}: is the study itself; name another file", output.display());
            return Err(Failure::request(message));
        }
        Ok(output)
    }

    /// The results, if the file holds those of this very study by this very program.
    fn finished(&self, output: &Path, study: &Study) -> Result<Option<Dataset>, Failure> {
        if !output.exists() || self.overwrite {
            return Ok(None);
        }
        let shown = output.display();
        let advice = "name another --output, or replace it with --overwrite";
        let dataset = store::read(output)
            .map_err(|error| Failure::request(format!("{error}\n{shown} is kept: {advice}")))?;
        let now = store::provenance::attributes();
        let same_program =
            ["source", "commit"].iter().all(|&key| dataset.attributes.get(key) == now.get(key));
        if dataset.texts.get("study") == Some(&study.text) && same_program {
            tell(&format!("{shown}: already computed, by this program from this study"));
            return Ok(Some(dataset));
        }
        let what = if same_program { "study" } else { "version of the program or study" };
        Err(Failure::request(format!("{shown}: holds results of another {what}; {advice}")))
    }

    /// What to run on, as far as this machine has it.
    fn machine(&self) -> Result<Machine, Failure> {
        let threads = self.threads.map(usize::from);
        let instructions = self.instructions;
        let Some(missing) = instructions.filter(|it| !it.is_available()) else {
            return Ok(Machine { threads, instructions });
        };
        let available: Vec<_> = Instructions::available().map(Instructions::name).collect();
        Err(Failure::request(format!(
            "--instructions: this processor has no {} (allowed here: {})",
            missing.name(),
            available.join(", ")
        )))
    }

    fn compute(&self, study: &Study, machine: Machine, output: &Path) -> Result<Dataset, Failure> {
        let progress = Progress::new(study.cases());
        let records = Mutex::new(Vec::with_capacity(study.cases()));
        run(study, machine, |record| {
            progress.step();
            records.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(record);
        })
        .map_err(Failure::machine)?;
        let seconds = progress.finish().as_secs_f64();
        let mut records = records.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
        records.sort_by_key(|record| record.index);
        let mut dataset = store::dataset(study, &records);
        if has_attractors(study) {
            let attractors =
                sweep::attractors(study, &records, machine).map_err(Failure::machine)?;
            store::add_attractors(&mut dataset, study, &attractors);
        }
        store::write(&dataset, output).map_err(Failure::machine)?;
        print(&summary(study, &records, output, seconds))?;
        Ok(dataset)
    }
}

/// Draws the figures from results without a single case, so that a mistake in one of them is told
/// before a long run and not after it.
fn rehearse(study: &Study) -> Result<(), Failure> {
    if study.drawings.is_empty() {
        return Ok(());
    }
    let mut small = study.clone();
    small.protocol.points = small.protocol.points.min(1);
    small.protocol.impact_points = small.protocol.impact_points.min(1);
    // In no format at all, nothing is written.
    draw_all(&store::dataset(&small, &[]), &study.drawings, Path::new("."), &[])
}

/// Makes the folder of the results, and sees that a file can be written there before a long run.
fn prepare(folder: &Path) -> Result<(), Failure> {
    let shown = folder.display();
    let file = folder.ancestors().find(|ancestor| ancestor.is_file());
    if let Some(file) = file {
        return Err(Failure::request(format!(
            "{shown}: {} is a file, not a folder; name another --output",
            file.display()
        )));
    }
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::machine(format!("{shown}: cannot be made: {error}")))?;
    tempfile::tempfile_in(folder).map(drop).map_err(|error| {
        Failure::machine(format!("{shown}: no file can be written there: {error}"))
    })
}

/// How many cases came out how, and how to look at those that failed.
fn summary(study: &Study, records: &[Record], output: &Path, seconds: f64) -> String {
    let cycles: u64 = records.iter().map(|record| record.orbit.cycles).sum();
    let shown = output.display();
    let (count, plural) = (records.len(), if records.len() == 1 { "" } else { "s" });
    let mut text = format!("{shown}: {count} case{plural}, {cycles} cycles in {seconds:.1} s\n");
    for outcome in Outcome::ALL {
        let count = records.iter().filter(|record| record.orbit.outcome == outcome).count();
        if count > 0 {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "  {:<14} {count}", outcome.name());
        }
    }
    let failures = records.iter().filter_map(|record| Some((record, record.orbit.failure?)));
    for (&Record { index, start, .. }, failure) in failures.take(FAILURES_SHOWN) {
        let _ = writeln!(text, "  case {index} failed: {failure}");
        let case = Case { start, ..study.case(index) };
        let _ = writeln!(text, "    replay: {}", replay(&case, &study.protocol));
    }
    text
}

/// The command that follows one case in full.
fn replay(case: &Case, protocol: &Protocol) -> String {
    let mut command = "capsulemap simulate".to_owned();
    for &parameter in Parameter::ALL {
        let _ = write!(command, " --set {}={}", parameter.symbol(), case.parameters[parameter]);
    }
    let start = case.start;
    let _ = write!(command, " --start r={},y1={},y2={}", start.r, start.y1, start.y2);
    let _ = write!(command, " --phase {}", case.phase);
    let usual = Protocol::default();
    if protocol.tolerance != usual.tolerance {
        let _ = write!(command, " --tolerance {}", protocol.tolerance);
    }
    if protocol.max_cycles != usual.max_cycles {
        let _ = write!(command, " --max-cycles {}", protocol.max_cycles);
    }
    let Parameters { switching, resistance, .. } = case.parameters;
    if switching != Switching::default() {
        let _ = write!(command, " --friction-switching {}", switching.name());
    }
    if resistance != Resistance::default() {
        let _ = write!(command, " --resistance {}", resistance.name());
    }
    command
}
