//! `capsulemap tradeoff`: what moves fastest for how little, from a file of results.

use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;

use super::arguments::named;
use super::failure::Failure;
use super::optima_text::{csv, json, table};
use super::readable::count;
use super::stop::say_when_stopped;
use super::terminal::{notify, print};
use super::watch::Stages;
use crate::campaign::{
    Between, CampaignError, KeptSearches, Sought, TradeOff, searches_path, study_of,
};
use crate::capsule::Output;
use crate::store::{self, Archive, StoreError, quantity};
use crate::study::document::unknown;
use crate::tradeoff::Direction;

const EXAMPLES: &str = "\
Examples:
  capsulemap tradeoff results/overview/overview.h5
  capsulemap tradeoff FILE.h5 --of work_positive --direction forward --json
  capsulemap tradeoff FILE.h5 --where \"peak_contact_force < 30 N and grazing_margin > 0.1 mm\" --top 20
  capsulemap tradeoff FILE.h5 --refine --json
  capsulemap tradeoff FILE.h5 --budget \"20 mW\" --speed \"5 mm/s\" --csv

The front is of all cases of the file, each with the attractor that it has ended on. Motions that are chaotic or
quasi-periodic take part by their means. With --refine, periodic motions are followed from the cases to where speed is
stationary for its price, and from these along the front; each says what holds it.";

/// Find the fastest motions for the least energy.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Tradeoff {
    /// The file of results.
    file: PathBuf,
    /// The output that should be small: an energy per cycle, `power`, `energy_per_metre` or another.
    #[arg(long, value_name = "OUTPUT", default_value = Output::Power.name())]
    of: String,
    /// Motions to compare; `either` compares magnitudes of speeds.
    #[arg(long, value_parser = named(&Direction::NAMES), default_value = "either")]
    direction: Direction,
    /// Conditions on what there is one number of for each case, joined by `and`; signs < <= > >= = !=.
    #[arg(long = "where", value_name = "CONDITIONS")]
    conditions: Option<String>,
    /// Speed up to which a motion counts as at rest; a millionth of the fastest by default.
    #[arg(long, value_name = "QUANTITY")]
    at_rest: Option<String>,
    /// Most of the output that may be spent: the fastest motion within it is told.
    #[arg(long, value_name = "QUANTITY")]
    budget: Option<String>,
    /// Least speed that is wanted: the motion that reaches it for the least is told.
    #[arg(long, value_name = "QUANTITY")]
    speed: Option<String>,
    /// Search for better motions between the cases, over the parameters that vary, within their ranges (at most 6).
    #[arg(long, conflicts_with = "conditions")]
    refine: bool,
    /// Number by which cases are drawn that the search begins with beside the best ones.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "refine")]
    seed: u64,
    /// Give up the searches that are kept beside the file, and begin anew.
    #[arg(long, requires = "refine")]
    overwrite: bool,
    /// Worker threads; one per core by default.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    threads: Option<u64>,
    /// List the fastest motions too, so many at most.
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    top: usize,
    /// Print one JSON object.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Print a table of comma-separated values.
    #[arg(long)]
    csv: bool,
}

/// What is asked, read.
struct Request {
    of: Output,
    at_rest: Option<f64>,
    budget: Option<f64>,
    speed: Option<f64>,
}

impl Tradeoff {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let request = self.request()?;
        let archive = store::open(&self.file).map_err(Failure::request)?;
        let kept = self.refine.then(|| self.kept(&archive)).transpose()?;
        let threads = self.threads.map(|threads| threads as usize);
        let sought = Sought { seed: self.seed, threads };
        let trade_off = TradeOff {
            archive: &archive,
            file: &self.file,
            of: request.of,
            direction: self.direction,
            conditions: self.conditions.as_deref(),
            at_rest: request.at_rest,
            budget: request.budget,
            speed: request.speed,
            top: self.top,
            slopes: self.json,
            between: kept.as_ref().map_or(Between::Nothing, |it| Between::Sought(it, sought)),
        };
        let stages = Stages::default();
        let answer = trade_off.answer(&|event| {
            stages.show(event);
            ControlFlow::Continue(())
        })?;
        print(&match (self.json, self.csv) {
            (true, _) => format!("{:#}\n", json(&answer)),
            (_, true) => csv(&answer),
            _ => table(&answer),
        })
    }

    /// The searches that are done, and where further ones are kept; nowhere if nothing can be written beside the results.
    fn kept(&self, archive: &Archive) -> Result<KeptSearches, Failure> {
        let study = study_of(archive, &self.file)?;
        match KeptSearches::open(archive, &study, self.overwrite) {
            Err(CampaignError::Store(error @ StoreError::System { .. })) => {
                notify(&format!("{error}; searches are not kept"));
                Ok(KeptSearches::default())
            }
            Err(error) => Err(error.into()),
            Ok(kept) => {
                let path = searches_path(archive.path()).display().to_string();
                if !kept.is_empty() {
                    let count = count(kept.len());
                    notify(&format!("{path}: what {count} searches have led to is kept"));
                }
                say_when_stopped(move || {
                    format!("what is found is kept in {path}; the same command resumes")
                })?;
                Ok(kept)
            }
        }
    }

    fn request(&self) -> Result<Request, Failure> {
        let mut faults = Vec::new();
        let names = || Output::ALL.iter().map(|output| output.name());
        let of = Output::ALL.iter().copied().find(|output| output.name() == self.of);
        if of.is_none() {
            faults.push(format!("--of: {}", unknown("output", &self.of, names())));
        }
        let of = of.unwrap_or(Output::Power);
        let mut read = |option: &str, text: &Option<String>, unit: &str| {
            let value = quantity(text.as_deref()?, unit);
            value.map_err(|fault| faults.push(format!("--{option}: {fault}"))).ok()
        };
        let speed_unit = Output::ProgressionSpeed.unit();
        let request = Request {
            of,
            at_rest: read("at-rest", &self.at_rest, speed_unit),
            budget: read("budget", &self.budget, of.unit()),
            speed: read("speed", &self.speed, speed_unit),
        };
        if faults.is_empty() { Ok(request) } else { Err(Failure::requests(&faults)) }
    }
}
