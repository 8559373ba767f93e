//! `capsulemap compare`: a recording beside the simulation of the same case.

use std::path::PathBuf;

use clap::Args;

use super::asked_case::{Takes, asked_case};
use super::compare_report::{as_json, explained, told_of};
use super::experiment_figures::{AskedPlot, comparison_plot, text_comparison_plot};
use super::failure::Failure;
use super::recording_form::RecordingForm;
use super::terminal::print;
use super::text_compare;
use super::varied::{Varied, threads, varied};
use crate::experiment::least_squares::Loss;
use crate::experiment::{
    Effort, Free, TextRecord, Weights, compare, compare_text, explain, left_out,
};
use crate::figure::plot::{Plot, draw_plot};
use crate::figure::{Format, Place};
use crate::motion::Case;
use crate::of::default_model;
use crate::orbit::Protocol;
use crate::quantity::printable::printable;

const EXAMPLES: &str = "\
Examples:
  capsulemap compare rig/motion.csv studies/fig5.toml --output rig/comparison
  capsulemap compare rig/motion.csv studies/fig6.toml --explain \"k2=5 kN/m..30 kN/m\" --explain mu_s=0.2..0.8,mu_d=0.1..0.4
  capsulemap compare rig/motion.csv studies/fig5.toml --output rig/residuals --residuals
  capsulemap compare wall.csv wall.toml

A recording is a CSV file with a column t and any of x2, r, x1, y1, y2, a1, drive, current, with their units. drive or current \
give the phase; without them the phase with the least differences is taken. The simulation starts on what the case settles to, \
with x1 and x2 moved by a constant each; offsets of other signals are kept. Events are counted per cycle of the recorded drive, \
in the longest part of the record without a gap. \
An interval of more than one and a half times the median one is a gap: gaps are told, and the simulation goes on through them. A record \
that spans more than 1000 cycles of the drive and ten for each of its samples is refused, and its longest gaps are named, as where the \
clock was set while it recorded: cut it there, and compare the parts by themselves. \
The error of a signal is the root mean square of the difference over the standard deviation of the record; that of x1 and x2 \
is about the record's own mean progression, and the error of their shape, without the difference of the speeds, is told beside it. \
Spikes of a1 are pulses of the acceleration that stand out of the motion about them; those on the stop that follow each other as the \
mass rings there count once.

The recorded speed of a motion that repeats itself is the slope of its means over periods, with the standard error of the noise. \
Of one that does not, the error is that of the means of ten batches of whole cycles; a record of fewer than twenty cycles has none. \
The simulated speed of a motion that does not repeat is the mean of measured_cycles of the study.

A drive of another frequency than omega, of another amplitude than p_d (by 2 % and three standard errors), or of the other sign, and \
signals of the other sign or in another unit are told.

--explain fits parameters by themselves to the first cycles and says how much of the difference each explains; several in one \
option, separated by commas, are fitted together.

The study may be of an oscillator given as text, with a recording as `capsulemap fit` takes it: columns t and states, and the phase of \
the drive at t = 0 is the start_phase of the study. The simulation is the motion that the case settles to, so that the rig must have settled, \
too; of a motion of several cycles that one comes first with which the differences are least, and without a drive the first sample is \
at the moment of the motion with which those of the first twenty cycles are least. What drifts is moved by a constant. \
There are no speeds, impacts and spikes of such recordings, and no --explain.";

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
    #[command(flatten)]
    form: RecordingForm,
    /// The overlay, without an extension: PNG, PDF and the data as CSV are written.
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Cycles of the drive that the overlay shows.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..))]
    cycles: u64,
    /// Draw what is recorded less what is simulated below each signal of the overlay, too.
    #[arg(long, requires = "output")]
    residuals: bool,
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
        let asked = asked_case(&self.study, self.case, Takes::CapsuleAndTexts);
        let model = asked.as_ref().map_or_else(|_| default_model(), |it| it.0.parameters.model());
        let mut faults = Vec::new();
        let choices = self.explain.iter();
        let choices: Vec<Vec<Varied>> =
            choices.map(|text| varied("--explain", text, model, &mut faults)).collect();
        if !faults.is_empty() {
            return Err(Failure::requests(&faults));
        }
        if model.equations.is_some() {
            let (case, protocol) = asked?;
            return self.compare_text(&case, &protocol);
        }
        let recording = self.form.motion(&self.recording, default_model())?;
        let (case, protocol) = asked?;
        let comparison = compare(&recording, &case, &protocol)
            .map_err(|why| Failure::of_file(&self.recording, why))?;
        let effort =
            Effort { loss: Loss::Squares, weights: Weights::Spread, starts: 8, threads: threads() };
        let free: Vec<Vec<Free>> =
            choices.iter().map(|all| all.iter().map(|it| it.free).collect()).collect();
        let explanations = explain(&comparison, &free, &effort)
            .map_err(|why| Failure::of_file(&self.recording, why))?;
        let mut paths = Vec::new();
        if let Some(output) = &self.output {
            paths = self.draw(|asked| comparison_plot(asked, &comparison), output)?;
        }
        let left_out = left_out(&recording);
        if self.json {
            let object = as_json(&comparison, &explanations, &left_out);
            return print(&format!("{object:#}\n"));
        }
        let mut text = told_of(&comparison);
        text.extend(left_out.iter().map(|it| format!("warning: {it}\n")));
        for (it, varied) in explanations.iter().zip(&choices) {
            text += &explained(&comparison, it, varied);
        }
        for path in paths {
            text += &format!("{}\n", printable(&path));
        }
        print(&text)
    }

    /// Compares with the oscillator of a text.
    fn compare_text(&self, case: &Case, protocol: &Protocol) -> Result<(), Failure> {
        if !self.explain.is_empty() {
            let why = "--explain: is for the capsule; `capsulemap fit` finds parameters of an oscillator that is given as text";
            return Err(Failure::request(why));
        }
        let recording = self.form.motion(&self.recording, case.parameters.model())?;
        let of_file = |why| Failure::of_file(&self.recording, why);
        let record = TextRecord::new(&recording, case).map_err(of_file)?;
        let doubts = record.doubts(&recording);
        let comparison = compare_text(&recording, &record, case, protocol).map_err(of_file)?;
        let mut paths = Vec::new();
        if let Some(output) = &self.output {
            paths = self.draw(|asked| text_comparison_plot(asked, &comparison), output)?;
        }
        if self.json {
            return print(&format!("{:#}\n", text_compare::as_json(&comparison, &doubts)));
        }
        let mut text = text_compare::told_of(&comparison, &doubts);
        for path in paths {
            text += &format!("{}\n", printable(&path));
        }
        print(&text)
    }

    /// What the overlay shows.
    fn about(&self) -> String {
        format!(
            "{} beside the simulation of {}",
            printable(&self.recording),
            printable(&self.study)
        )
    }

    /// Draws the overlay, which is called after its file.
    fn draw(
        &self,
        plot: impl Fn(&AskedPlot<'_>) -> Plot,
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
                printable(output)
            )));
        };
        let place =
            Place { folder, formats: &[Format::Png, Format::Pdf], overwrite: self.overwrite };
        let (about, cycles, residuals) = (&self.about(), self.cycles, self.residuals);
        let asked = AskedPlot { name: &name, about, cycles, residuals };
        let files = draw_plot(&plot(&asked), &place).map_err(Failure::request)?;
        Ok(files.paths)
    }
}
