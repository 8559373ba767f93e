//! `capsulemap compare`: a recording beside the simulation of the same case.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::experiment_figures::comparison_plot;
use super::failure::Failure;
use super::files;
use super::fit::{threads, told_of_bound, varied};
use super::identify::{shown, unit};
use super::synthesize::case_of;
use super::terminal::print;
use crate::capsule::{Output, Parameter};
use crate::experiment::comparison::EXPLAINED_CYCLES;
use crate::experiment::least_squares::Loss;
use crate::experiment::{Comparison, Effort, Explanation, Free, Weights, compare, explain};
use crate::figure::plot::draw_plot;
use crate::figure::{Format, Place};
use crate::orbit::Outcome;
use crate::store::catalogue::{CYCLES, OUTCOME, PERIOD};

const EXAMPLES: &str = "\
Examples:
  capsulemap compare rig/motion.csv studies/fig5.toml --output rig/comparison
  capsulemap compare rig/motion.csv studies/fig6.toml --explain \"k2=5 kN/m..30 kN/m\" --explain mu_s=0.2..0.8,mu_d=0.1..0.4

A recording is a CSV file with a column t and any of x2, r, x1, y1, y2, a1, drive, current, with their units. drive or current \
give the phase; without them the phase with the least differences is taken. The simulation starts on what the case settles to, \
with x1 and x2 moved by a constant each; offsets of other signals are kept. Events are counted per cycle of the recorded drive, \
in the longest part of the record without a gap. \
The error of a signal is the root mean square of the difference over the standard deviation of the record, without the mean \
progression.

--explain fits parameters by themselves to the first cycles and says how much of the difference each explains; several in one \
option, separated by commas, are fitted together.";

/// Compare a recording with the simulation of the same case.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Compare {
    /// The recording.
    recording: PathBuf,
    /// The study, or a file of its results, whose case it is.
    study: PathBuf,
    /// The case, counted from 0.
    #[arg(long, default_value_t = 0)]
    case: usize,
    /// Parameters that might explain the difference, with their bounds.
    #[arg(long, value_name = "NAME=FROM..TO,...")]
    explain: Vec<String>,
    /// The overlay, without an extension: PNG, PDF and the data as CSV are written.
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Cycles of the drive that the overlay shows.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..))]
    cycles: u64,
    /// Replace files that are there.
    #[arg(long)]
    overwrite: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

impl Compare {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let mut faults = Vec::new();
        let choices: Vec<Vec<Free>> =
            self.explain.iter().map(|text| varied("--explain", text, &mut faults)).collect();
        if !faults.is_empty() {
            return Err(Failure::requests(&faults));
        }
        let recording = files::motion(&self.recording)?;
        let case = case_of(&self.study, self.case)?;
        let name = self.recording.display();
        let told = |why: String| Failure::request(format!("{name}: {why}"));
        let comparison = compare(&recording, &case.parameters).map_err(told)?;
        let effort =
            Effort { loss: Loss::Squares, weights: Weights::Spread, starts: 8, threads: threads() };
        let explanations = explain(&comparison, &choices, &effort).map_err(told)?;
        let mut paths = Vec::new();
        if let Some(output) = &self.output {
            paths = self.draw(&comparison, output)?;
        }
        if self.json {
            return print(&format!("{:#}\n", as_json(&comparison, &explanations)));
        }
        let mut text = told_of(&comparison);
        for it in &explanations {
            text += &explained(&comparison, it);
        }
        for path in paths {
            text += &format!("{}\n", path.display());
        }
        print(&text)
    }

    fn draw(
        &self,
        comparison: &Comparison,
        output: &std::path::Path,
    ) -> Result<Vec<PathBuf>, Failure> {
        let folder = crate::store::folder(output);
        // An extension that is given all the same is not doubled.
        let is_format = output
            .extension()
            .is_some_and(|it| ["png", "pdf", "csv"].iter().any(|known| it == *known));
        let stem = if is_format { output.file_stem() } else { output.file_name() };
        let Some(name) = stem.map(|it| it.to_string_lossy().into_owned()) else {
            return Err(Failure::request(format!(
                "--output {}: expected a file",
                output.display()
            )));
        };
        let place =
            Place { folder, formats: &[Format::Png, Format::Pdf], overwrite: self.overwrite };
        let about = format!(
            "{} beside the simulation of {}",
            self.recording.display(),
            self.study.display()
        );
        let files = draw_plot(&comparison_plot(&name, comparison, &about, self.cycles), &place)
            .map_err(Failure::request)?;
        Ok(files.paths)
    }
}

/// The comparison in lines.
fn told_of(it: &Comparison) -> String {
    let mut text = format!("record:       {}, {:.2} cycles of the drive\n", it.sampling, it.cycles);
    text += &match &it.drive {
        Some(drive) => format!(
            "drive:        {} rad/s as recorded, {} rad/s in the study; phase {} rad at the first sample\n",
            shown(drive.omega.value, drive.omega.standard_error),
            it.motion.parameters[Parameter::Omega],
            shown(drive.phase.value, drive.phase.standard_error),
        ),
        None => format!(
            "drive:        not recorded; phase {:.3} rad at the first sample makes the differences least\n",
            it.phase
        ),
    };
    if let Some(drive) = &it.drive
        && !drive.omega.holds(it.motion.parameters[Parameter::Omega])
    {
        text += "              warning: the frequencies differ, so that recording and study are not the same case\n";
    }
    let period = match it.outcome {
        (Outcome::Periodic, period) => format!("periodic, period {period}"),
        (other, _) => format!("{}: histories need not agree, only speeds and counts", other.name()),
    };
    let recorded = match it.recorded_period {
        Some(period) => format!("period {period}"),
        None => "no period up to 8".to_owned(),
    };
    text += &format!("motion:       {recorded} recorded; {period} simulated\n");
    if let Some(speed) = &it.recorded_speed {
        text += &format!(
            "speed:        {} mm/s recorded (standard error {}), {:.4} mm/s simulated{}\n",
            shown(speed.value * 1e3, speed.standard_error * 1e3),
            shown(speed.standard_error * 1e3, speed.standard_error * 1e3),
            it.simulated_speed * 1e3,
            if it.outcome.0 == Outcome::Periodic {
                ""
            } else {
                ", the mean of 128 cycles of a motion that does not repeat"
            }
        );
    }
    text += &match it.recorded_impacts {
        Some(recorded) => format!(
            "impacts:      {recorded:.2} per cycle recorded (r reaches delta), {} simulated\n",
            it.impacts
        ),
        None => format!("impacts:      {} per cycle simulated; {}\n", it.impacts, uncounted(it)),
    };
    if let Some([recorded, simulated]) = it.spikes {
        text +=
            &format!("spikes of a1: {recorded:.2} per cycle recorded, {simulated:.2} simulated\n");
    }
    for difference in &it.differences {
        text += &format!(
            "error of {:<5}{:.2} %\n",
            format!("{}:", difference.signal.name()),
            difference.error * 100.0
        );
    }
    text
}

/// Why the impacts of a record are not counted.
fn uncounted(it: &Comparison) -> &'static str {
    match it.is_countable {
        true => "r is not recorded",
        false => {
            "not counted in the record: fewer than three cycles without a gap, or than 20 samples a cycle"
        }
    }
}

fn explained(comparison: &Comparison, it: &Explanation) -> String {
    let of = |parameter| it.changed.iter().find(|it| it.0 == parameter).map(|it| it.1);
    let mu_d = of(Parameter::MuD).unwrap_or(comparison.motion.parameters[Parameter::MuD]);
    let changed: Vec<String> = it
        .changed
        .iter()
        .map(|(parameter, value, _)| {
            if *parameter == Parameter::MuS && *value < 2.0 * mu_d {
                return "mu_s below 2 mu_d, where it has no effect".to_owned();
            }
            let old = comparison.motion.parameters[*parameter];
            let change = 100.0 * (value / old - 1.0);
            format!(
                "{} = {}{} ({change:+.1} %)",
                parameter.symbol(),
                shown(*value, 1e-3 * value),
                unit(parameter.dimension())
            )
        })
        .collect();
    let bounds: String = it
        .changed
        .iter()
        .filter(|it| it.0 != Parameter::MuS || it.1 >= 2.0 * mu_d)
        .map(|(parameter, value, bound)| told_of_bound("  ", *parameter, *value, *bound))
        .collect();
    format!(
        "with {}: error of all signals {:.1} % over the first {EXPLAINED_CYCLES} cycles, {:.1} % without; {} impacts per cycle, {:.4} \
         mm/s\n{bounds}",
        changed.join(", "),
        100.0 * it.misfit[1],
        100.0 * it.misfit[0],
        it.impacts,
        it.speed * 1e3
    )
}

fn as_json(it: &Comparison, explanations: &[Explanation]) -> serde_json::Value {
    let differences =
        it.differences.iter().map(|it| json!({ "signal": it.signal.name(), "error": it.error }));
    let explanation = |it: &Explanation| {
        let changed = it
            .changed
            .iter()
            .map(|(parameter, value, bound)| {
                json!({ "name": parameter.symbol(), "value": value, "on_bound": bound.map(|it| it.name()) })
            });
        json!({
            "changed": changed.collect::<Vec<_>>(),
            "error": it.misfit[1],
            "error_without": it.misfit[0],
            Output::ImpactsPerCycle.name(): it.impacts,
            Output::ProgressionSpeed.name(): it.speed,
        })
    };
    json!({
        "countable": it.is_countable,
        "samples": it.sampling.count,
        "gaps": it.sampling.gaps,
        CYCLES.name: it.cycles,
        "omega_recorded": it.drive.as_ref().map(|it| it.omega.value),
        "phase": it.phase,
        "period_recorded": it.recorded_period,
        OUTCOME.name: it.outcome.0.name(),
        PERIOD.name: it.outcome.1,
        "speed_recorded": it.recorded_speed.map(|it| it.value),
        "speed_recorded_error": it.recorded_speed.map(|it| it.standard_error),
        "speed_simulated": it.simulated_speed,
        "spikes_per_cycle": it.spikes,
        Output::ImpactsPerCycle.name(): it.impacts,
        "impacts_per_cycle_recorded": it.recorded_impacts,
        "errors": differences.collect::<Vec<_>>(),
        "explanations": explanations.iter().map(explanation).collect::<Vec<_>>(),
    })
}
