//! `capsulemap fit`: parameters from recorded histories of the motion.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::failure::Failure;
use super::files;
use super::identify::{shown, unit};
use super::synthesize::case_of;
use super::terminal::print;
use crate::capsule::Parameter;
use crate::experiment::comparison::signals_of;
use crate::experiment::identification::parameter_file;
use crate::experiment::least_squares::{Bounds, Loss};
use crate::experiment::motion_fit::Side;
use crate::experiment::{
    Constant, Effort, Free, Identified, MotionFit, Recorded, Recording, Verdict, Weights,
    fit_motion, harmonic,
};
use crate::study::document::unknown;

const EXAMPLES: &str = "\
Examples:
  capsulemap fit rig/motion.csv --study studies/fig5.toml --vary \"k2=1 kN/m..5 kN/m,mu_d=0.1..0.6\"
  capsulemap fit a.csv b.csv --study a.toml --study b.toml --vary \"v_s=0.05..1\" --output fitted.toml

Each recording has its own study, or all have one; its first case says how the rig was set. The drive must be recorded (column \
drive or current), as it gives the phase, whose error is in those of the parameters. Records are taken as they are: an offset of \
a sensor is one of the motion. Intervals are those of the profile likelihood; a parameter that these data leave open \
within its bounds is called one-sided or not determined.";

/// A residual of this many standard deviations of the noise begins to count less, with --robust.
const ROBUST: f64 = 2.0;
/// Residuals below this share of what third differences take for noise are no noise.
const COARSE: f64 = 0.5;

/// Fit parameters to recorded histories of the motion.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Fit {
    /// The recordings.
    #[arg(required = true)]
    recordings: Vec<PathBuf>,
    /// The study of each recording, or one for all.
    #[arg(long, required = true)]
    study: Vec<PathBuf>,
    /// The parameters to fit, each with its bounds.
    #[arg(long, value_name = "NAME=FROM..TO,...", required = true)]
    vary: Vec<String>,
    /// Cycles from the beginning of each recording that are used.
    #[arg(long, default_value_t = 6, value_parser = clap::value_parser!(u64).range(1..))]
    cycles: u64,
    /// Starts of the search within the bounds, the first at the values of the study.
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=1000))]
    starts: u64,
    /// Let outliers count little.
    #[arg(long)]
    robust: bool,
    /// The parameter file to write, which studies include.
    #[arg(long, value_name = "FILE.toml")]
    output: Option<PathBuf>,
    /// Replace files that are there.
    #[arg(long)]
    overwrite: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

impl Fit {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let mut faults = Vec::new();
        let free: Vec<Free> =
            self.vary.iter().flat_map(|text| varied("--vary", text, &mut faults)).collect();
        for (i, it) in free.iter().enumerate() {
            if free[..i].iter().any(|other| other.parameter == it.parameter) {
                faults.push(format!("--vary: {} is given twice", it.parameter.symbol()));
            }
        }
        if ![1, self.recordings.len()].contains(&self.study.len()) {
            let (studies, recordings) = (self.study.len(), self.recordings.len());
            faults.push(format!("--study: {studies} studies for {recordings} recordings; expected one, or one for each"));
        }
        if !faults.is_empty() {
            return Err(Failure::requests(&faults));
        }
        if let Some(output) = &self.output {
            files::check_free(output, self.overwrite)?;
        }
        let recorded: Vec<Recorded> =
            (0..self.recordings.len()).map(|i| self.recorded(i)).collect::<Result<_, _>>()?;
        let loss = if self.robust { Loss::SoftL1(ROBUST) } else { Loss::Squares };
        let effort = Effort {
            loss,
            weights: Weights::Noise,
            starts: self.starts as usize,
            threads: threads(),
        };
        let fit = fit_motion(&recorded, &free, &effort).map_err(Failure::request)?;
        if let Some(output) = &self.output {
            files::put(output, &parameter_file(&self.identified(&fit), &[]))?;
        }
        if self.json {
            return print(&format!("{:#}\n", as_json(&fit)));
        }
        let mut text = table(&fit);
        if let Some(output) = &self.output {
            text += &format!("{}\n", output.display());
        }
        print(&text)
    }

    /// A recording as the fit takes it.
    fn recorded(&self, index: usize) -> Result<Recorded, Failure> {
        let path = &self.recordings[index];
        let told = |why: String| Failure::request(format!("{}: {why}", path.display()));
        let recording = files::motion(path)?;
        let case = case_of(&self.study[index.min(self.study.len() - 1)], 0)?;
        let (times, signals) = signals_of(&recording).map_err(told)?;
        let drive = drive(&recording).ok_or_else(|| {
            told(
                "has neither a column drive [N] nor current [A], which give the phase of the drive"
                    .to_owned(),
            )
        })?;
        let drive = harmonic(&times, drive).map_err(told)?;
        let omega = case.parameters[Parameter::Omega];
        if (drive.omega.value / omega - 1.0).abs() > 0.02 {
            return Err(told(format!(
                "the drive has {:.4} rad/s, but omega is {omega} rad/s in the study",
                drive.omega.value
            )));
        }
        let span = self.cycles as f64 * case.parameters.drive_period();
        let count = times.partition_point(|time| *time <= span);
        let cut = |values: Vec<f64>| values[..count].to_vec();
        Ok(Recorded {
            parameters: case.parameters,
            times: times[..count].to_vec(),
            phase: drive.phase.value,
            phase_error: drive.phase.standard_error,
            signals: signals.into_iter().map(|(signal, values)| (signal, cut(values))).collect(),
        })
    }

    fn identified(&self, fit: &MotionFit) -> Vec<Identified> {
        let names: Vec<String> =
            self.recordings.iter().map(|it| it.display().to_string()).collect();
        let one = |it: &crate::experiment::Fitted| Identified {
            constant: Constant::Parameter(it.parameter),
            estimate: it.estimate,
            verdict: it.verdict,
            method: "least squares of simulated and recorded histories",
            source: names.join(", "),
            other: None,
            notes: Vec::new(),
        };
        fit.fitted.iter().map(one).collect()
    }
}

fn drive(recording: &Recording) -> Option<&[f64]> {
    recording.column("drive").or(recording.column("current"))
}

/// Threads of this machine.
pub fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Parameters with bounds, as "k2=1 kN/m..5 kN/m,mu_d=0.1..0.6".
pub fn varied(option: &str, text: &str, faults: &mut Vec<String>) -> Vec<Free> {
    let mut all = Vec::new();
    for part in text.split(',') {
        let Some((name, (from, to))) = part
            .split_once('=')
            .and_then(|(name, range)| Some((name.trim(), range.split_once("..")?)))
        else {
            faults.push(format!(
                "{option}: {part}: expected NAME=FROM..TO, as \"k2=1 kN/m..5 kN/m\""
            ));
            continue;
        };
        let Some(parameter) = Parameter::named(name) else {
            let symbols = Parameter::ALL.iter().map(|it| it.symbol());
            faults.push(format!("{option}: {}", unknown("parameter", name, symbols)));
            continue;
        };
        let mut read = |text: &str| {
            let value = files::quantity(&format!("{option} {name}"), text, parameter.dimension());
            match value {
                Ok(value) if parameter.allowed().admits(value) => Some(value),
                Ok(value) => {
                    faults
                        .push(format!("{option} {name}: {value} must be {}", parameter.allowed()));
                    None
                }
                Err(fault) => {
                    faults.push(fault);
                    None
                }
            }
        };
        let (Some(least), Some(greatest)) = (read(from), read(to)) else { continue };
        if least >= greatest {
            faults.push(format!("{option} {name}: {from} must be below {to}"));
            continue;
        }
        all.push(Free { parameter, bounds: Bounds { least, greatest } });
    }
    all
}

fn table(fit: &MotionFit) -> String {
    let mut text = String::new();
    for it in &fit.fitted {
        let error = it.estimate.standard_error;
        let unit = unit(it.parameter.dimension());
        let [least, greatest] = it.estimate.interval.map(|end| shown(end, error));
        text += &match it.verdict {
            Verdict::Determined => format!(
                "{:<6}{}{unit}, standard error {}, 95 %: {least} to {greatest}\n",
                it.parameter.symbol(),
                shown(it.estimate.value, error),
                shown(error, error),
            ),
            verdict => format!(
                "{:<6}{verdict}: {least} to {greatest}{unit} within its bounds\n",
                it.parameter.symbol()
            ),
        };
    }
    for it in fit.fitted.iter().filter(|it| it.verdict != Verdict::NotDetermined) {
        text += &told_of_bound("", it.parameter, it.estimate.value, it.bound);
    }
    if !fit.combined.is_empty() {
        let names: Vec<&str> = fit.combined.iter().map(|it| it.symbol()).collect();
        text += &format!(
            "note: of {} only combinations are determined: changed together they leave the motion as it is; hold one of them\n",
            names.join(", ")
        );
    }
    let strongest = strongest(fit);
    if let Some((a, b, value)) = strongest {
        text +=
            &format!("strongest correlation {value:+.2}, of {} and {}\n", a.symbol(), b.symbol());
    }
    let [same, starts] = fit.starts;
    text += &format!(
        "misfit {:.2} in units of the noise (1 where the model describes the records), {} samples; {same} of {starts} starts led \
         here\n",
        fit.misfit, fit.samples
    );
    if fit
        .motions
        .iter()
        .any(|it| it.parameters.drag().static_limit < it.parameters.drag().at_onset)
        && fit.fitted.iter().any(|it| it.parameter == Parameter::MuS)
    {
        text += "note: mu_s below 2 mu_d has no effect; the capsule breaks away at 2 mu_d\n";
    }
    if fit.misfit < COARSE {
        text += "warning: the records change too much from sample to sample for their noise to be told from the motion; errors rest \
                 on the residuals alone\n";
    }
    if fit.misfit > 1.5 {
        text += "warning: the model does not describe the records to their noise; errors are those of the best fit, not of the truth\n";
    }
    text
}

/// What is said of a best value on a bound.
pub fn told_of_bound(
    before: &str,
    parameter: Parameter,
    value: f64,
    bound: Option<Side>,
) -> String {
    let Some(side) = bound else { return String::new() };
    let (symbol, side, unit) = (parameter.symbol(), side.name(), unit(parameter.dimension()));
    format!(
        "{before}warning: {symbol} is best at the {side} value allowed, {value}{unit}: the true one may lie beyond; widen the bounds\n"
    )
}

/// The two parameters that are correlated most.
fn strongest(fit: &MotionFit) -> Option<(Parameter, Parameter, f64)> {
    let count = fit.fitted.len();
    let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
    let of = |(i, j): (usize, usize)| {
        (fit.fitted[j].parameter, fit.fitted[i].parameter, fit.correlations[i][j])
    };
    pairs.map(of).filter(|it| it.2.is_finite()).max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))
}

fn as_json(fit: &MotionFit) -> serde_json::Value {
    let one = |it: &crate::experiment::Fitted| {
        json!({
            "name": it.parameter.symbol(),
            "unit": it.parameter.dimension().unit(),
            "value": it.estimate.value,
            "standard_error": it.estimate.standard_error,
            "interval_95": it.estimate.interval,
            "verdict": it.verdict.to_string(),
            "on_bound": it.bound.map(|it| it.name()),
        })
    };
    let combined = fit.combined.iter().map(|it| it.symbol());
    json!({
        "fitted": fit.fitted.iter().map(one).collect::<Vec<_>>(),
        "combined": combined.collect::<Vec<_>>(),
        "correlations": fit.correlations,
        "misfit": fit.misfit,
        "samples": fit.samples,
        "starts_here": fit.starts[0],
        "starts": fit.starts[1],
    })
}
