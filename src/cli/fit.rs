//! `capsulemap fit`: parameters from recorded histories of the motion.

use std::path::{Path, PathBuf};

use clap::Args;

use super::asked_case::{Takes, asked_case};
use super::failure::Failure;
use super::files;
use super::fit_report::{as_json, table, warnings as warnings_of};
use super::identify_report::shown;
use super::recording_form::RecordingForm;
use super::terminal::print;
use super::varied::{Varied, threads, varied};
use crate::capsule::CapsuleParameters as _;
use crate::description::Description;
use crate::experiment::comparison::signals_of;
use crate::experiment::course::varies;
use crate::experiment::identification::parameter_file;
use crate::experiment::least_squares::Loss;
use crate::experiment::simulated_span::check_span;
use crate::experiment::{
    Constant, Effort, Free, Frequencies, Harmonic, Identified, MotionFit, Recorded, Sampling,
    TextRecord, Weights, fit_motion, fit_text, harmonic, left_out,
};
use crate::motion::Case;
use crate::of::default_model;
use crate::quantity::printable::printable;

const EXAMPLES: &str = "\
Examples:
  capsulemap fit rig/motion.csv --study studies/fig5.toml --vary \"k2=1 kN/m..5 kN/m,mu_d=0.1..0.6\"
  capsulemap fit a.csv b.csv --study a.toml --study b.toml --vary \"v_s=0.05 m/s..1 m/s\" --output fitted.toml
  capsulemap fit wall.csv --study wall.toml --vary c=0.01..0.5,r=0.3..1

Each recording has its own study, or all have one; its first case says how the rig was set. The drive must be recorded (column \
drive or current), as it gives the phase, whose error is in those of the parameters. The start is unknown: r and y1, x2 where it is \
recorded or follows from x1 and r, and y2, about what the record has of it or, where that is nothing, among all speeds that the capsule \
can have; rest is tried beside them, and a note says where it is taken. Records are taken as they are: an offset of \
a sensor is one of the motion, and a signal that drifts against the fitted motion by more than four standard errors is warned of. \
A study whose omega is not that of the recorded drive is refused. Intervals are those of the profile likelihood; a parameter that these data leave open \
within its bounds is called one-sided or not determined. The misfit is the standard deviation of the residuals over the noise, which is \
that of the third differences of the residuals. Outliers are samples more than five times the noise from the fit; with --robust they count \
little, errors and intervals are scaled by Huber's formula for such fits, and the \
misfit is that of the others, by the median. `capsulemap compare --residuals` with a study of the fitted values draws the recording \
beside the motion that the case settles to, and what is left.

The study may be of an oscillator given as text (capsulemap help book systems). Then a recording has a column t and columns that are called \
as states, one at least, with their units as \"x [m]\"; a state whose unit is 1 has none, and where all are such, t has none. The drive \
is known: at t = 0 of the record its phase is the start_phase of the study, whenever the first sample is. Without a drive the first sample is \
anywhere in the motion. The start of each state is unknown: where it is recorded, or follows from the rate of one that is, it is looked \
for about what the first samples have of it, else about the start of the study, three times as far as the motion from there goes.";

/// Cycles of the drive that are used unless another number is given.
const CYCLES: u64 = 6;
/// A residual of this many standard deviations of the noise begins to count less, with --robust.
const ROBUST: f64 = 2.0;

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
    /// Cycles of the drive from the beginning of each recording that are used; 6 unless it is given, and all where there is no drive.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    cycles: Option<u64>,
    /// Starts of the search within the bounds, the first at the values of the study.
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=1000))]
    starts: u64,
    #[command(flatten)]
    form: RecordingForm,
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
        let cases = self.cases();
        let text = cases.first().and_then(text_of);
        let varied = self.varied(text.unwrap_or_else(default_model))?;
        let free: Vec<Free> = varied.iter().map(|it| it.free).collect();
        if let Some(output) = &self.output {
            files::check_free(output, self.overwrite)?;
        }
        let (fit, warnings) = match text {
            Some(model) => self.text_fit(&cases, model, &free)?,
            None => self.capsule_fit(&cases, &free)?,
        };
        if let Some(output) = &self.output {
            files::put(output, &parameter_file(&self.identified(&fit), &[]))?;
        }
        let names = self.names();
        let of_fit = warnings_of(&fit, &varied, &names, self.robust);
        let warnings: Vec<String> = warnings.into_iter().chain(of_fit).collect();
        if self.json {
            return print(&format!("{:#}\n", as_json(&fit, &names, &warnings)));
        }
        let mut text = table(&fit, &varied, &names, self.robust);
        text.extend(warnings.iter().map(|it| format!("warning: {it}\n")));
        if let Some(output) = &self.output {
            text += &format!("{}\n", printable(output));
        }
        print(&text)
    }

    /// The first case of each study.
    fn cases(&self) -> Vec<Result<Case, Failure>> {
        let first = |path: &PathBuf| asked_case(path, 0, Takes::CapsuleAndTexts).map(|it| it.0);
        self.study.iter().map(first).collect()
    }

    /// The case of a recording.
    fn case_of(&self, cases: &[Result<Case, Failure>], index: usize) -> Result<Case, Failure> {
        cases[index.min(cases.len() - 1)].clone()
    }

    /// How the search is to be done.
    fn effort(&self) -> Effort {
        let loss = if self.robust { Loss::SoftL1(ROBUST) } else { Loss::Squares };
        let (starts, threads) = (self.starts as usize, threads());
        Effort { loss, weights: Weights::Noise, starts, threads }
    }

    /// The fit of a capsule, and warnings of the recordings.
    fn capsule_fit(
        &self,
        cases: &[Result<Case, Failure>],
        free: &[Free],
    ) -> Result<(MotionFit, Vec<String>), Failure> {
        let (mut recorded, mut warnings) = (Vec::new(), Vec::new());
        for index in 0..self.recordings.len() {
            let (one, doubts) = self.recorded(cases, index)?;
            recorded.push(one);
            warnings.extend(doubts);
        }
        let fit = fit_motion(&recorded, free, &self.effort()).map_err(Failure::request)?;
        Ok((fit, warnings))
    }

    /// The fit of the oscillator of a text, and warnings of the recordings.
    fn text_fit(
        &self,
        cases: &[Result<Case, Failure>],
        model: &'static Description,
        free: &[Free],
    ) -> Result<(MotionFit, Vec<String>), Failure> {
        if self.cycles.is_some() && model.roles.drive.is_none() {
            let why = "--cycles: the oscillator has no drive; all of a recording is used";
            return Err(Failure::request(why));
        }
        let (mut records, mut warnings) = (Vec::new(), Vec::new());
        for (index, path) in self.recordings.iter().enumerate() {
            let case = self.case_of(cases, index)?;
            if case.parameters.model() != model {
                let (study, name) = (&self.study[index], case.parameters.model().name);
                let why = format!(
                    "it is about {name}, and the first about {}; fit them by themselves",
                    model.name
                );
                return Err(Failure::of_file(study, why));
            }
            let recording = self.form.motion(path, model)?;
            let of_file = |why| Failure::of_file(path, why);
            let record = TextRecord::new(&recording, &case).map_err(of_file)?;
            let doubts = record.doubts(&recording).into_iter();
            warnings.extend(doubts.map(|it| format!("{}: {it}", printable(path))));
            let period = case.parameters.period_of_drive();
            let span = period.map_or(f64::INFINITY, |it| it * self.used_cycles() as f64);
            records.push(record.up_to(span).map_err(of_file)?);
        }
        let fit = fit_text(&records, free, &self.effort()).map_err(Failure::request)?;
        Ok((fit, warnings))
    }

    /// Cycles of the drive that are used.
    fn used_cycles(&self) -> u64 {
        self.cycles.unwrap_or(CYCLES)
    }

    /// The parameters to fit, each once, where there are as many studies as the recordings need.
    fn varied(&self, model: &'static Description) -> Result<Vec<Varied>, Failure> {
        let mut faults = Vec::new();
        let varied: Vec<Varied> =
            self.vary.iter().flat_map(|text| varied("--vary", text, model, &mut faults)).collect();
        for (i, Varied { free, .. }) in varied.iter().enumerate() {
            if varied[..i].iter().any(|other| other.free.parameter == free.parameter) {
                faults.push(format!("--vary: {} is given twice", free.parameter.symbol()));
            }
        }
        if ![1, self.recordings.len()].contains(&self.study.len()) {
            let (studies, recordings) = (self.study.len(), self.recordings.len());
            faults.push(format!("--study: {studies} studies for {recordings} recordings; expected one, or one for each"));
        }
        if faults.is_empty() { Ok(varied) } else { Err(Failure::requests(&faults)) }
    }

    /// A recording as the fit takes it, and warnings of its gaps and of its frequency.
    fn recorded(
        &self,
        cases: &[Result<Case, Failure>],
        index: usize,
    ) -> Result<(Recorded, Vec<String>), Failure> {
        let path = &self.recordings[index];
        let recording = self.form.motion(path, default_model())?;
        let case = self.case_of(cases, index)?;
        let (times, signals) = signals_of(&recording).map_err(|why| Failure::of_file(path, why))?;
        let period = case.parameters.drive_period();
        let sampling = recording.sampling();
        check_span(&times, &sampling, period).map_err(|why| Failure::of_file(path, why))?;
        for (signal, sensed) in &signals {
            varies(signal.name(), &sensed.values).map_err(|why| Failure::of_file(path, why))?;
        }
        let drive = recording.sensed("drive").or(recording.sensed("current"));
        let drive = drive.ok_or_else(|| {
            let why =
                "has neither a column drive [N] nor current [A], which give the phase of the drive";
            Failure::of_file(path, why)
        })?;
        let drive = harmonic(&drive.at(&times), &drive.values)
            .map_err(|why| Failure::of_file(path, why))?;
        let span = self.used_cycles() as f64 * period;
        let omega = case.parameters.frequency();
        let mut warnings = warnings_of_record(path, &sampling, &drive, omega, span)?;
        warnings.extend(left_out(&recording).iter().map(|it| format!("{}: {it}", printable(path))));
        let count = times.partition_point(|time| *time <= span);
        let signals = signals.into_iter().map(|(signal, sensed)| (signal, sensed.first(count)));
        let recorded = Recorded {
            parameters: case.parameters,
            times: times[..count].to_vec(),
            phase: drive.phase.value,
            phase_error: drive.phase.standard_error,
            signals: signals.collect(),
        };
        Ok((recorded, warnings))
    }

    fn names(&self) -> Vec<String> {
        self.recordings.iter().map(|it| printable(it).to_string()).collect()
    }

    fn identified(&self, fit: &MotionFit) -> Vec<Identified> {
        let names = self.names();
        let identified = fit.fitted.iter().map(|it| Identified {
            constant: Constant::Parameter(it.parameter),
            estimate: it.estimate,
            verdict: it.verdict,
            method: "least squares of simulated and recorded histories",
            source: names.join(", "),
            other: None,
            notes: Vec::new(),
        });
        identified.collect()
    }
}

/// The model of a case, where it is that of a text.
fn text_of(case: &Result<Case, Failure>) -> Option<&'static Description> {
    let model = case.as_ref().ok()?.parameters.model();
    model.equations.is_some().then_some(model)
}

/// Warnings of the gaps of a record, and of a frequency that is not surely that of the study, `omega`, over this span.
///
/// Fails where the frequencies differ.
fn warnings_of_record(
    path: &Path,
    sampling: &Sampling,
    drive: &Harmonic,
    omega: f64,
    span: f64,
) -> Result<Vec<String>, Failure> {
    let mut warnings = Vec::new();
    if !sampling.gaps.is_empty() {
        warnings.push(format!(
            "{}: {sampling}; where the clock was set there, the drive changes its phase: cut the file there and take the parts by \
             themselves",
            printable(path)
        ));
    }
    let fault = frequencies(drive, omega);
    match drive.beside(omega, span) {
        Frequencies::Same => {}
        Frequencies::Apart => warnings.push(format!("{}: {fault}", printable(path))),
        Frequencies::Differ => return Err(Failure::of_file(path, fault)),
    }
    Ok(warnings)
}

/// That the recorded frequency is not that of the study.
fn frequencies(drive: &Harmonic, omega: f64) -> String {
    let error = drive.omega.standard_error;
    let value = shown(drive.omega.value, error);
    format!(
        "the drive has {value} rad/s (standard error {}), but omega is {omega} rad/s in the study; set omega = \"{value} rad/s\" there",
        shown(error, error)
    )
}
