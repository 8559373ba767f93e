//! `capsulemap tradeoff`: what gains most for how little, as what moves fastest, from a file of results.

use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;

use super::arguments::{cost, gain, held, named};
use super::failure::Failure;
use super::optima_csv::csv;
use super::optima_json::json;
use super::optima_text::table;
use super::readable::count;
use super::stop::say_when_stopped;
use super::terminal::{notify, print};
use super::watch::Stages;
use crate::campaign::{
    Between, CampaignError, KeptSearches, Tolerances, TradeOff, searches_path, study_of,
};
use crate::description::{Description, Output, Parameter};
use crate::quantity::printable::printable;
use crate::quantity::{Dimension, parse_quantity};
use crate::store::{self, Archive, StoreError, quantity};
use crate::study::document::unknown;
use crate::tradeoff::{Direction, GainAndCost};

const EXAMPLES: &str = "\
Examples:
  capsulemap tradeoff results/overview/overview.h5
  capsulemap tradeoff FILE.h5 --of work_positive --direction forward --json
  capsulemap tradeoff FILE.h5 --where \"peak_contact_force < 30 N\" --top 20
  capsulemap tradeoff FILE.h5 --refine --json
  capsulemap tradeoff FILE.h5 --refine --tolerances \"k2 = 5 %, mu_s = 10 %\"
  capsulemap tradeoff FILE.h5 --budget \"20 mW\" --speed \"5 mm/s\" --csv
  capsulemap tradeoff FILE.h5 --of work --for amplitude

The front is of all cases of the file, each with the attractor that it has ended on. Motions that are chaotic or \
quasi-periodic take part by their means. The cost is the output --of, the gain the output --for: of the capsule the progression \
speed, of other models any output, and both are named then. With --refine, periodic motions are followed from the cases \
to where the gain is stationary at its cost, and from these along the front; each is told with its active constraint. \
Conditions then bound the search: parameters, and up to 3 outputs that change smoothly.";

/// Find the fastest motions for the least energy, or the most of one output for the least of another.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Tradeoff {
    /// The file of results.
    file: PathBuf,
    /// The output that should be small: an energy per cycle, one over a distance or another; of the capsule the power by default.
    #[arg(long, value_name = "OUTPUT")]
    of: Option<String>,
    /// The output that should be large, the gain; of the capsule the progression speed by default.
    #[arg(long = "for", value_name = "OUTPUT")]
    gain: Option<String>,
    /// Motions to compare: those with a positive gain are `forward`; `either` compares magnitudes of gains.
    #[arg(long, value_parser = named(&Direction::NAMES), default_value = "either")]
    direction: Direction,
    /// Conditions on parameters and outputs that are one number for each case, joined by `and`; signs < <= > >= = !=.
    #[arg(long = "where", value_name = "CONDITIONS")]
    conditions: Option<String>,
    /// Speed, or another gain, up to which a motion counts as at rest; a millionth of the largest by default.
    #[arg(long, value_name = "QUANTITY")]
    at_rest: Option<String>,
    /// Most of the cost that may be spent: the fastest motion within it, or that with the most gain, is told.
    #[arg(long, value_name = "QUANTITY")]
    budget: Option<String>,
    /// Least speed, or another gain, that is wanted: the motion that reaches it for the least is told.
    #[arg(long, value_name = "QUANTITY")]
    speed: Option<String>,
    /// Search for better motions between the cases, over the parameters that vary, within their ranges (at most 6); for outputs with
    /// derivatives, which those of oscillators given as text do not have.
    #[arg(long)]
    refine: bool,
    /// Points drawn over the ranges and settled from rest, from which searches begin besides the cases.
    #[arg(long, value_name = "NUMBER", default_value_t = 256, requires = "refine",
        value_parser = clap::value_parser!(u32).range(..=100_000))]
    starts: u32,
    /// Tolerances of parameters, as "k2 = 5 %, mu_s = 10 %": 5 % is the half width of an even (uniform) distribution, within which each
    /// parameter is drawn by itself. Tells for the periodic optima and motions of the front the gain that 95 of 100 draws reach, the
    /// cost that 95 of 100 do not exceed, the share that keeps the period, and how many draws keep `--where` and `--budget`.
    #[arg(long, value_name = "TOLERANCES")]
    tolerances: Option<String>,
    /// How many sets of parameters are drawn within the tolerances.
    #[arg(long, value_name = "NUMBER", default_value_t = 200, requires = "tolerances",
        value_parser = clap::value_parser!(u32).range(1..))]
    draws: u32,
    /// For the optima, tell how far each parameter may fall and rise, by a half at most, before the motion ends or loses its
    /// stability, and where its events change on the way.
    #[arg(long)]
    margins: bool,
    /// Seed of the random draws: of tolerances, and of the points and cases that searches begin with besides the best cases.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// Delete the searches that are kept beside the file, and begin anew.
    #[arg(long, requires = "refine")]
    overwrite: bool,
    /// Worker threads; one per core by default.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    threads: Option<u64>,
    /// List the motions with the most gain too, so many at most.
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
    of: GainAndCost,
    at_rest: Option<f64>,
    budget: Option<f64>,
    least_gain: Option<f64>,
    tolerances: Option<Tolerances>,
}

impl Tradeoff {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let archive = store::open(&self.file).map_err(Failure::request)?;
        let request = self.request(&archive)?;
        self.check_refine(archive.frame().model())?;
        let kept = self.refine.then(|| self.kept(&archive)).transpose()?;
        let threads = self.threads.map(|threads| threads as usize);
        let trade_off = TradeOff {
            archive: &archive,
            file: &self.file,
            of: request.of,
            direction: self.direction,
            conditions: self.conditions.as_deref(),
            at_rest: request.at_rest,
            budget: request.budget,
            least_gain: request.least_gain,
            top: self.top,
            slopes: self.json,
            under: request.tolerances.as_ref(),
            margins: self.margins,
            threads,
            between: kept.as_ref().map_or(Between::Nothing, |kept| Between::Sought {
                kept,
                seed: self.seed,
                points: self.starts as usize,
            }),
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
                kept.damage(archive).iter().for_each(|it| notify(it));
                let path = printable(&searches_path(archive.path())).to_string();
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

    /// Refuses a refinement where no output of the model has derivatives.
    fn check_refine(&self, model: &'static Description) -> Result<(), Failure> {
        if !self.refine || model.outputs().any(Output::is_smooth) {
            return Ok(());
        }
        Err(Failure::request(format!(
            "--refine: follows derivatives of outputs in the parameters, and no output of the model {} has them; without --refine the cases \
             of the file are compared",
            model.name
        )))
    }

    fn request(&self, archive: &Archive) -> Result<Request, Failure> {
        let model = archive.frame().model();
        let mut faults = Vec::new();
        let mut noted = |found: Result<Output, String>| found.map_err(|it| faults.push(it)).ok();
        let cost = noted(cost(archive, self.of.as_deref()));
        let gain = noted(gain(archive, self.gain.as_deref()));
        // Beside an output that is not known the quantities are read as those of the outputs that the model names, if it names some.
        let gain_or_own = gain.or_else(|| GainAndCost::own_gain(model));
        let cost_or_own = cost.or_else(|| model.has_trade_off().then(|| model.power()));
        let limits = [
            ("at-rest", &self.at_rest, gain_or_own),
            ("budget", &self.budget, cost_or_own),
            ("speed", &self.speed, gain_or_own),
        ];
        let [at_rest, budget, least_gain] = limits.map(|(option, text, output)| {
            let value = read_limit(text.as_deref()?, output?);
            value.map_err(|fault| faults.push(format!("--{option}: {fault}"))).ok()
        });
        let tolerances =
            self.tolerances.as_ref().map(|text| self.read_tolerances(text, model, &mut faults));
        let of = gain.zip(cost).map(|(gain, cost)| held(gain, cost));
        match of.transpose() {
            Err(fault) => faults.push(fault),
            Ok(Some(of)) if faults.is_empty() => {
                return Ok(Request { of, at_rest, budget, least_gain, tolerances });
            }
            Ok(_) => {}
        }
        Err(Failure::requests(&faults))
    }

    /// The tolerances in a text; faults are noted.
    fn read_tolerances(
        &self,
        text: &str,
        model: &'static Description,
        faults: &mut Vec<String>,
    ) -> Tolerances {
        let mut each: Vec<(Parameter, f64)> = Vec::new();
        for part in text.split(',') {
            match read_tolerance(part, &each, model) {
                Ok(tolerance) => each.push(tolerance),
                Err(fault) => faults.push(format!("--tolerances {}: {fault}", part.trim())),
            }
        }
        Tolerances { each, draws: self.draws as usize, seed: self.seed }
    }
}

/// A limit of an output (SI); a plain number is in SI already.
fn read_limit(text: &str, output: Output) -> Result<f64, String> {
    text.trim().parse().or_else(|_| parse_quantity(text, output.dimension()))
}

/// The tolerance that a part of a text gives a parameter, which none of those `before` is of.
fn read_tolerance(
    part: &str,
    before: &[(Parameter, f64)],
    model: &'static Description,
) -> Result<(Parameter, f64), String> {
    let (name, value) = part.split_once('=').ok_or("expected PARAMETER = PERCENT")?;
    let Some(parameter) = model.parameter(name.trim()) else {
        let symbols = model.parameters().map(|it| it.symbol());
        return Err(unknown("parameter", name.trim(), symbols));
    };
    let most = quantity(value, Dimension::Number.unit())
        .map_err(|fault| format!("{fault}, relative to the parameter, as 5 % or 0.05"))?;
    if before.iter().any(|it| it.0 == parameter) {
        return Err(format!("{} is given twice", parameter.symbol()));
    }
    if !(most > 0.0 && most < 1.0) {
        return Err(format!("is {} %; must lie between 0 and 100 %", 100.0 * most));
    }
    Ok((parameter, most))
}
