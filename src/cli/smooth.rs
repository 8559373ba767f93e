//! `capsulemap smooth`: the signals of a recording, smoothed or differentiated.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::files;
use super::target::Target;
use crate::experiment::estimate::significant;
use crate::experiment::{Recording, Signal, Window, smoothed};
use crate::of::default_model;
use crate::quantity::Dimension;
use crate::quantity::printable::printable;

const EXAMPLES: &str = "\
Examples:
  capsulemap smooth rig/motion.csv --window \"11 ms\" --output rig/smooth.csv
  capsulemap smooth rig/motion.csv --window \"21 ms\" --order 4 --derivative 1 --output rig/velocities.csv

Savitzky and Golay's method: in the window about each sample a polynomial is fitted, which is read at the sample; at the ends \
that of the last whole window. The times may be uneven. Each part of the record between two gaps is smoothed by itself. The window \
has the odd number of samples whose time is nearest to the one given, by the median interval. compare, fit and identify smooth \
by themselves where they need it: they take the recording as it is.";

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
        let recording = files::motion(&self.recording, default_model())?;
        let sampling = recording.sampling();
        let window = self.window(length, sampling.interval)?;
        let names = Signal::ALL.map(|it| (it.name(), it.dimension()));
        let known = names.into_iter().chain([("current", Dimension::Current)]);
        let mut columns = Vec::new();
        for (name, dimension) in known {
            if let Some(values) = recording.column(name) {
                let values = self.smoothed(&recording, values, window)?;
                columns.push((heading(name, dimension, self.derivative), values));
            }
        }
        let text = csv(recording.required("t"), &columns);
        let told = format!(
            "window: {} samples, {} s; order {}; derivative {}",
            window.samples,
            significant(window.samples as f64 * sampling.interval, 4),
            window.order,
            self.derivative,
        );
        target.put(&text, &[sampling.to_string(), told])
    }

    /// The window whose time is nearest to a length [s], at samples so far apart [s].
    fn window(&self, length: f64, interval: f64) -> Result<Window, Failure> {
        let half = (0.5 * (length / interval - 1.0)).round().max(0.0);
        // A number too large for a size is the largest one.
        let (samples, order) = ((half as usize).saturating_mul(2) | 1, self.order as usize);
        if order >= samples {
            let why = format!(
                "--window: {} are {samples} samples, and a polynomial of order {order} needs more than {order}",
                self.window
            );
            return Err(Failure::request(why));
        }
        if self.derivative > self.order {
            let why = format!("--derivative: that of order {} is zero", self.order);
            return Err(Failure::request(why));
        }
        Ok(Window { samples, order })
    }

    /// A signal smoothed part by part.
    fn smoothed(
        &self,
        recording: &Recording,
        values: &[f64],
        window: Window,
    ) -> Result<Vec<f64>, Failure> {
        let times = recording.required("t");
        let mut all = Vec::with_capacity(values.len());
        for part in recording.sampling().parts(times) {
            let (from, derivative) = (times[part.start], self.derivative as usize);
            let part = smoothed(&times[part.clone()], &values[part], window, derivative);
            all.extend(part.map_err(|why| {
                let name = printable(&self.recording);
                Failure::request(format!("{name}: the part from t = {from} s: {why}"))
            })?);
        }
        Ok(all)
    }
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

/// Columns over time as text, with all digits.
fn csv(times: &[f64], columns: &[(String, Vec<f64>)]) -> String {
    let mut text = String::from("t [s]");
    columns.iter().for_each(|(heading, _)| text += &format!(",{heading}"));
    text += "\n";
    for (row, time) in times.iter().enumerate() {
        // Text can always be written to.
        let _ = write!(text, "{time}");
        for (_, values) in columns {
            let _ = write!(text, ",{}", values[row]);
        }
        text += "\n";
    }
    text
}
