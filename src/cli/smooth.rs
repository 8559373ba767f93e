//! `capsulemap smooth`: the signals of a recording, smoothed or differentiated.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::files;
use super::recording_form::RecordingForm;
use super::target::Target;
use crate::experiment::estimate::significant;
use crate::experiment::smoothed_parts::{Part, Smoothing, smoothed_parts, window};
use crate::experiment::{Signal, left_out};
use crate::of::default_model;
use crate::quantity::Dimension;

const EXAMPLES: &str = "\
Examples:
  capsulemap smooth rig/motion.csv --window \"11 ms\" --output rig/smooth.csv
  capsulemap smooth rig/motion.csv --window \"21 ms\" --order 4 --derivative 1 --output rig/velocities.csv

Savitzky and Golay's method: in the window about each sample a polynomial is fitted, which is read at the sample; at the ends \
that of the last whole window. The times may be uneven. A gap of more than half the window cuts the record, and so does a change of the \
interval: each part is smoothed by itself. The window of a part has the odd number of its samples whose time is nearest to the one given; \
a part with fewer is left out and told, and so is a cell that is empty. compare, fit and identify smooth \
by themselves where they need it: they take the recording as it is.";

/// So many parts are named.
const NAMED: usize = 3;

/// Smooth and differentiate the signals of a recording.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Smooth {
    /// The recording.
    recording: PathBuf,
    /// Length of the window.
    #[arg(long, value_name = "TIME")]
    window: String,
    /// Order of the polynomial.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u64).range(0..=12))]
    order: u64,
    /// Which derivative to write; 0 is the signal itself.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u64).range(0..=2))]
    derivative: u64,
    #[command(flatten)]
    form: RecordingForm,
    /// The CSV file to write, in SI units; - for standard output.
    #[arg(long, value_name = "FILE.csv")]
    output: PathBuf,
    /// Replace a file that is there.
    #[arg(long)]
    overwrite: bool,
}

impl Smooth {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let length = files::quantity("--window", &self.window, Dimension::Time);
        let length = length.map_err(Failure::request)?;
        let target = Target::of(&self.output, |path| files::check_free(path, self.overwrite))?;
        let recording = self.form.motion(&self.recording, default_model())?;
        let sampling = recording.sampling();
        let how = self.how(length, sampling.interval)?;
        let names = Signal::ALL.map(|it| (it.name(), it.dimension()));
        let known = names.into_iter().chain([("current", Dimension::Current)]);
        let (mut columns, mut told) = (Vec::new(), vec![sampling.to_string()]);
        told.extend(left_out(&recording).iter().map(|it| format!("note: {it}")));
        for (name, dimension) in known {
            let Some(sensed) = recording.sensed(name) else { continue };
            let times = sensed.at(recording.required("t"));
            let parts = smoothed_parts(&times, &sensed.values, how);
            told.extend(doubts(name, &parts));
            if parts.iter().all(|it| it.values.is_err()) {
                let why = parts.first().and_then(|it| it.values.as_ref().err().copied());
                let why = why.map_or_else(|| "it has no value".to_owned(), |it| it.to_string());
                let most = parts.iter().map(|it| it.samples.len()).max().unwrap_or(0);
                let why = format!(
                    "{name}: no part can be smoothed, the longest of {most} samples: {why}"
                );
                return Err(Failure::of_file(&self.recording, why));
            }
            let column = column(recording.rows(), &sensed.rows, parts);
            columns.push((heading(name, dimension, self.derivative), column));
        }
        if columns.is_empty() {
            let names = Signal::ALL.map(Signal::name).join(", ");
            let why = format!(
                "it has no signal; the signals are {names}, current; --columns \"x2=NAME:mm\" says which column is one"
            );
            return Err(Failure::of_file(&self.recording, why));
        }
        let text = csv(recording.required("t"), &columns);
        let samples = window(how, sampling.interval).samples;
        told.push(format!(
            "window: {samples} samples, {} s; order {}; derivative {}",
            significant(samples as f64 * sampling.interval, 4),
            how.order,
            self.derivative,
        ));
        target.put(&text, &told)
    }

    /// How signals are smoothed in a window of this length [s]; the median interval is that of the record [s].
    fn how(&self, length: f64, interval: f64) -> Result<Smoothing, Failure> {
        let (order, derivative) = (self.order as usize, self.derivative as usize);
        let how = Smoothing { length, order, derivative };
        let samples = window(how, interval).samples;
        if order >= samples {
            let why = format!(
                "--window: {} are {samples} samples, and a polynomial of order {order} needs more than {order}",
                self.window
            );
            return Err(Failure::request(why));
        }
        if derivative > order {
            let why = format!("--derivative: that of order {order} is zero");
            return Err(Failure::request(why));
        }
        Ok(how)
    }
}

/// What must be known of the parts of a signal: those that are left out, and those with another window.
fn doubts(name: &str, parts: &[Part]) -> Vec<String> {
    let mut told = Vec::new();
    let short: Vec<&Part> = parts.iter().filter(|it| it.values.is_err()).collect();
    for part in short.iter().take(NAMED) {
        let (samples, begins) = (part.samples.len(), part.begins);
        if let Err(why) = part.values {
            told.push(format!(
                "warning: {name}: the part of {samples} samples from t = {begins} s is left out: {why}"
            ));
        }
    }
    if let Some(more @ 1..) = short.len().checked_sub(NAMED) {
        told.push(format!("warning: {name}: and {more} parts more are left out"));
    }
    let first = parts.first().map_or(0, |it| it.window.samples);
    for part in
        parts.iter().filter(|it| it.values.is_ok() && it.window.samples != first).take(NAMED)
    {
        told.push(format!(
            "note: {name}: from t = {} s samples are {} s apart, {} in a window",
            part.begins,
            significant(part.interval, 4),
            part.window.samples
        ));
    }
    told
}

/// A column with the values of the parts in their rows, and none in others.
fn column(count: usize, rows: &[usize], parts: Vec<Part>) -> Vec<Option<f64>> {
    let mut all = vec![None; count];
    for part in parts {
        let Ok(values) = part.values else { continue };
        for (row, value) in rows[part.samples].iter().zip(values) {
            all[*row] = Some(value);
        }
    }
    all
}

/// What a column is called: derivatives of displacements by the names that recordings have for them.
fn heading(name: &str, dimension: Dimension, derivative: u64) -> String {
    let known = match (name, derivative) {
        ("x1", 1) => Some("y1"),
        ("x2", 1) => Some("y2"),
        ("x1", 2) => Some("a1"),
        _ => None,
    };
    let called = match derivative {
        0 => name.to_owned(),
        1 => format!("d{name}/dt"),
        _ => format!("d2{name}/dt2"),
    };
    let unit = match (dimension, derivative) {
        (Dimension::Length, 1) => "m/s".to_owned(),
        (Dimension::Length, 2) | (Dimension::Velocity, 1) => "m/s2".to_owned(),
        (_, 0) => dimension.unit().to_owned(),
        (_, 1) => format!("{}/s", dimension.unit()),
        _ => format!("{}/s/s", dimension.unit()),
    };
    format!("{} [{unit}]", known.unwrap_or(&called))
}

/// Columns over time as text, with all digits; what has no value is an empty cell.
fn csv(times: &[f64], columns: &[(String, Vec<Option<f64>>)]) -> String {
    let mut text = String::from("t [s]");
    columns.iter().for_each(|(heading, _)| text += &format!(",{heading}"));
    text += "\n";
    for (row, time) in times.iter().enumerate() {
        // Text can always be written to.
        let _ = write!(text, "{time}");
        for (_, values) in columns {
            let _ = match values[row] {
                Some(value) => write!(text, ",{value}"),
                None => write!(text, ","),
            };
        }
        text += "\n";
    }
    text
}
