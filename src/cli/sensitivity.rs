//! `capsulemap sensitivity`: Sobol indices of outputs, from a file of results whose cases are Saltelli's design.

use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::sensitivity_text::{csv, json, table};
use super::terminal::print;
use crate::campaign::{NO_DESIGN, Resampling, Sensitivity as Asked};
use crate::description::Output;
use crate::store::catalogue::{CERTIFICATE, CYCLES, FAILURE_REASON, OUTCOME, PERIOD};
use crate::store::{self, Archive, Design};
use crate::study::document::unknown;

const EXAMPLES: &str = "\
Examples:
  capsulemap sensitivity results/sensitivity/sensitivity.h5
  capsulemap sensitivity FILE.h5 --of progression_speed,power --json
  capsulemap sensitivity FILE.h5 --of power --resamples 5000 --csv

The study draws its cases by `kind = \"saltelli\"` under [draws]. S1, the first order, is the share of the variance that a quantity \
makes by itself; ST, the total order, the share that it takes part in. S1 as in Saltelli and others (2010), ST as in Jansen (1999), \
intervals as in SALib: the normal quantile times the standard deviation over resampled base samples. A base sample with a case that \
failed, is undecided or has no finite value is left out, and counted.";

/// Find which of the quantities that are drawn the variance of outputs comes from: Sobol indices with intervals.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Sensitivity {
    /// The file of results.
    file: PathBuf,
    /// Outputs; all that the file has by default.
    #[arg(long, value_name = "OUTPUT", value_delimiter = ',')]
    of: Vec<String>,
    /// How often base samples are resampled.
    #[arg(long, value_name = "NUMBER", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(10..=1_000_000))]
    resamples: u32,
    /// Share of intervals that are to hold the true value.
    #[arg(long, value_name = "SHARE", default_value_t = 0.95, value_parser = read_confidence)]
    confidence: f64,
    /// Seed of the resampling.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// Worker threads; one per core by default.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    threads: Option<u64>,
    /// Print one JSON object.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print a table of comma-separated values.
    #[arg(long)]
    csv: bool,
}

impl Sensitivity {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let archive = store::open(&self.file).map_err(Failure::request)?;
        if Design::of(archive.frame()).is_none() {
            return Err(Failure::of_file(&self.file, NO_DESIGN));
        }
        let outputs = self.outputs(&archive)?;
        let resampling = Resampling {
            resamples: self.resamples as usize,
            confidence: self.confidence,
            seed: self.seed,
        };
        let threads = self.threads.map(|threads| threads as usize);
        let (archive, outputs) = (&archive, &outputs[..]);
        let asked = Asked { archive, file: &self.file, outputs, resampling, threads };
        let answer = asked.answer()?;
        print(&match (self.json, self.csv) {
            (true, _) => format!("{:#}\n", json(&asked, &answer)),
            (_, true) => csv(&answer),
            _ => table(&asked, &answer),
        })
    }

    /// The outputs that are named, or all of the file; all faults at once.
    fn outputs(&self, archive: &Archive) -> Result<Vec<Output>, Failure> {
        let kept: Vec<Output> = archive
            .frame()
            .model()
            .outputs()
            .filter(|it| archive.unit(it.name()).is_some())
            .collect();
        if self.of.is_empty() {
            return Ok(kept);
        }
        let (mut found, mut faults) = (Vec::new(), Vec::new());
        for name in &self.of {
            match read_output(name.trim(), &kept, archive) {
                Ok(output) if found.contains(&output) => {
                    faults.push(format!("--of: {} is given twice", output.name()));
                }
                Ok(output) => found.push(output),
                Err(fault) => faults.push(format!("--of: {fault}")),
            }
        }
        if faults.is_empty() { Ok(found) } else { Err(Failure::requests(&faults)) }
    }
}

/// The output of a name, among those that a file has.
fn read_output(name: &str, kept: &[Output], archive: &Archive) -> Result<Output, String> {
    let verdicts = [OUTCOME, PERIOD, CERTIFICATE, FAILURE_REASON, CYCLES];
    if verdicts.iter().any(|it| it.name == name) {
        return Err(format!(
            "{name} is a category or a count of the computation, of which a variance tells nothing; name an output"
        ));
    }
    if let Some(output) = kept.iter().find(|it| it.name() == name) {
        return Ok(*output);
    }
    if archive.frame().model().output(name).is_some() {
        let kept: Vec<&str> = kept.iter().map(|it| it.name()).collect();
        return Err(format!("the file has no {name} (it has: {})", kept.join(", ")));
    }
    Err(unknown("output", name, kept.iter().map(|it| it.name())))
}

/// A share between 0 and 1, neither of which is one of intervals.
fn read_confidence(text: &str) -> Result<f64, String> {
    let share: f64 = text.trim().parse().map_err(|_| "expected a number, as 0.95".to_owned())?;
    match share > 0.0 && share < 1.0 {
        true => Ok(share),
        false => Err("must lie between 0 and 1, as 0.95".to_owned()),
    }
}
