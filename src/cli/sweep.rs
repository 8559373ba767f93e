//! `capsulemap sweep`: a study, from its file to its results and figures.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;

use super::figure::{FormatChoice, draw_all};
use super::progress::Progress;
use super::result_file::{folder, kept, output_path, prepare, read_study, ready, rehearse};
use super::{Failure, named, print, tell};
use crate::lane::Instructions;
use crate::model::{Parameter, Parameters, Resistance, Switching};
use crate::orbit::{Case, Outcome, Protocol};
use crate::store::{self, Dataset, has_cases, keep_branches};
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
        let study = read_study(&self.study)?;
        let output = output_path(&self.study, self.output.as_deref())?;
        let dataset = match kept(&output, &study, self.overwrite)? {
            Some(dataset) if has_cases(&dataset) && !self.overwrite => {
                let shown = output.display();
                tell(&format!("{shown}: already computed, by this program from this study"));
                dataset
            }
            older => {
                if !self.no_figures {
                    rehearse(&without_cases(&study), &study.drawings)
                        .map_err(|failure| failure.within(&name))?;
                }
                prepare(folder(&output))?;
                self.compute(&study, machine, &output, older)?
            }
        };
        if !self.no_figures {
            let drawings = ready(&dataset, &study.drawings);
            draw_all(&dataset, &drawings, folder(&output), &self.formats)?;
        }
        Ok(())
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

    /// Computes the cases and writes them beside the branches of an `older` file, if it has any.
    fn compute(
        &self,
        study: &Study,
        machine: Machine,
        output: &Path,
        older: Option<Dataset>,
    ) -> Result<Dataset, Failure> {
        let progress = Progress::new(study.cases(), "cases");
        let records = Mutex::new(Vec::with_capacity(study.cases()));
        run(study, machine, |record| {
            progress.step();
            records.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(record);
        })
        .map_err(Failure::machine)?;
        let mut seconds = progress.finish().as_secs_f64();
        let mut records = records.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
        records.sort_by_key(|record| record.index);
        let mut dataset = store::dataset(study, &records);
        if has_attractors(study) {
            let progress = Progress::new(sweep::links(study), "links of attractors");
            let endings = sweep::endings(study, &records);
            let attractors = sweep::attractors(study, &endings, machine, || progress.step())
                .map_err(Failure::machine)?;
            seconds += progress.finish().as_secs_f64();
            store::add_attractors(&mut dataset, study, &attractors);
        }
        if let Some(older) = older {
            keep_branches(&mut dataset, &older);
        }
        store::write(&dataset, output).map_err(Failure::machine)?;
        print(&summary(study, &records, output, seconds))?;
        Ok(dataset)
    }
}

/// The results of a study of which no case is done, without the room that those would take.
fn without_cases(study: &Study) -> Dataset {
    let mut small = study.clone();
    small.protocol.points = small.protocol.points.min(1);
    small.protocol.impact_points = small.protocol.impact_points.min(1);
    store::dataset(&small, &[])
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
