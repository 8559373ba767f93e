//! `capsulemap identify`: the constants of a rig from its simple tests.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::experiment_figures::evidence_plot;
use super::failure::Failure;
use super::files;
use super::terminal::print;
use crate::capsule::Parameter;
use crate::experiment::estimate::{decimals, significant};
use crate::experiment::identification::{
    Evidence, Other, impossible_rows, parameter_file, remarks,
};
use crate::experiment::recording::MOST_TOLD;
use crate::experiment::{Estimate, Given, Identified, Recording, Test, Verdict, identify};
use crate::figure::plot::{Plot, draw_plot};
use crate::figure::{Format, Place};
use crate::quantity::Dimension;
use crate::quantity::printable::printable;

const EXAMPLES: &str = "\
Examples:
  capsulemap identify rig --m1 \"0.11 kg\" --m2 \"0.53 kg\" --output rig/identified.toml
  capsulemap identify --static-force spring.csv --output spring.toml

FOLDER may hold free-vibration.csv, static-force.csv, pull.csv, coasting.csv and motor.csv; options name other files. A recording \
is a CSV file whose header has names with units:

  test            columns                  gives             needs
  free-vibration  t [s], r [mm]            k1, c             --m1
  static-force    force [N], deflection [mm]  k2
  pull            pulled_mass [kg]         mu_s              --m1, --m2
  coasting        v [m/s], d [mm]          mu_d, v_s
  motor           current [A], force [N]   motor_constant

Intervals hold the true value in 95 of 100 experiments. A study takes the values by include = \"FILE.toml\" at its top. What the tests do \
not determine, as mu_d and v_s where separate ranges of them agree with the tests, has no value there, and the study takes its default.";

/// Find constants of a rig from recordings of simple tests.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Identify {
    /// A folder with the recordings.
    folder: Option<PathBuf>,
    /// Free vibration of the mass on a capsule that is held: k1 and c.
    #[arg(long, value_name = "CSV")]
    free_vibration: Option<PathBuf>,
    /// Deflection of the stop under weights: k2.
    #[arg(long, value_name = "CSV")]
    static_force: Option<PathBuf>,
    /// Masses that just move the rig: mu_s.
    #[arg(long, value_name = "CSV")]
    pull: Option<PathBuf>,
    /// Initial speeds and distances until rest: mu_d and v_s.
    #[arg(long, value_name = "CSV")]
    coasting: Option<PathBuf>,
    /// Force of the motor over its current: the motor constant.
    #[arg(long, value_name = "CSV")]
    motor: Option<PathBuf>,
    /// The internal mass, weighed.
    #[arg(long, value_name = "MASS")]
    m1: Option<String>,
    /// The mass of the capsule, weighed.
    #[arg(long, value_name = "MASS")]
    m2: Option<String>,
    /// Acceleration of gravity.
    #[arg(long, value_name = "ACCELERATION", default_value = "9.81 m/s2")]
    g: String,
    /// The parameter file to write.
    #[arg(long, value_name = "FILE.toml")]
    output: Option<PathBuf>,
    /// A folder for pictures of the fits, with their data.
    #[arg(long, value_name = "FOLDER")]
    figures: Option<PathBuf>,
    /// Replace files that are there.
    #[arg(long)]
    overwrite: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// What was found in a recording.
struct Found {
    test: Test,
    recording: Recording,
    identified: Vec<Identified>,
    evidence: Evidence,
}

impl Identify {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let files = self.files()?;
        let given = self.given(&files)?;
        if let Some(output) = &self.output {
            files::check_free(output, self.overwrite)?;
        }
        let mut found = Vec::new();
        let mut failures = Vec::new();
        for (test, path) in files {
            match read(test, &path, &given) {
                Ok(it) => found.push(it),
                Err(failure) => failures.push(failure),
            }
        }
        if let Some(failure) = Failure::all(failures) {
            return Err(failure);
        }
        let all: Vec<Identified> = found.iter().flat_map(|it| it.identified.clone()).collect();
        let mut written = Vec::new();
        if let Some(folder) = &self.figures {
            written.extend(self.draw(&found, &given, folder)?);
        }
        if let Some(output) = &self.output {
            files::put(output, &parameter_file(&all, &self.settings(&given)))?;
            written.push(output.clone());
        }
        if self.json {
            return print(&format!("{:#}\n", as_json(&all)));
        }
        let mut text = table(&all);
        for remark in remarks(&all) {
            text += &format!("note: {remark}\n");
        }
        for path in written {
            text += &format!("{}\n", printable(&path));
        }
        print(&text)
    }

    /// The recordings that are named or in the folder.
    fn files(&self) -> Result<Vec<(Test, PathBuf)>, Failure> {
        let own =
            [&self.free_vibration, &self.static_force, &self.pull, &self.coasting, &self.motor];
        let of = |(test, own): (Test, &Option<PathBuf>)| {
            let in_folder = self.folder.as_ref().map(|it| it.join(format!("{}.csv", test.name())));
            // What is no plain file is refused when it is read, rather than taken as absent.
            let is_there = |path: &PathBuf| path.symlink_metadata().is_ok();
            Some((test, own.clone().or(in_folder.filter(is_there))?))
        };
        let files: Vec<_> = Test::ALL.into_iter().zip(own).filter_map(of).collect();
        if !files.is_empty() {
            return Ok(files);
        }
        let names = Test::ALL.map(|it| format!("{}.csv", it.name())).join(", ");
        Err(Failure::request(match &self.folder {
            Some(folder) if !folder.exists() => {
                format!("{}: there is no such folder", printable(folder))
            }
            Some(file) if !file.is_dir() => format!(
                "{}: is no folder, and one with some of {names} is expected; an option says what a file is, as --pull FILE",
                printable(file)
            ),
            Some(folder) => format!("{}: holds none of {names}", printable(folder)),
            None => format!(
                "no recording is given; expected a folder with some of {names}, or an option for each"
            ),
        }))
    }

    /// Masses and gravity, of which those must be given that a test needs.
    fn given(&self, files: &[(Test, PathBuf)]) -> Result<Given, Failure> {
        let mut faults = Vec::new();
        let mut read =
            |option: &str, text: Option<&String>, parameter: Parameter, needs: &[Test]| {
                let test = files.iter().find(|(test, _)| needs.contains(test));
                match (text, test) {
                    (Some(text), _) => match files::quantity(option, text, parameter.dimension()) {
                        Ok(value) if value > 0.0 => return value,
                        Ok(_) => faults.push(format!("{option}: {text} must be above zero")),
                        Err(fault) => faults.push(fault),
                    },
                    (None, Some((test, path))) => faults.push(
                        format!(
                            "{option}: missing; {} needs the {}, as \"{} kg\"",
                            printable(path),
                            parameter.meaning(),
                            if parameter == Parameter::M1 { 0.11 } else { 0.53 },
                        ) + &format!(" ({} test)", test.name()),
                    ),
                    (None, None) => {}
                }
                f64::NAN
            };
        let m1 = read("--m1", self.m1.as_ref(), Parameter::M1, &[Test::FreeVibration, Test::Pull]);
        let m2 = read("--m2", self.m2.as_ref(), Parameter::M2, &[Test::Pull]);
        let g = read("--g", Some(&self.g), Parameter::G, &[]);
        if faults.is_empty() { Ok(Given { m1, m2, g }) } else { Err(Failure::requests(&faults)) }
    }

    /// The parameters that were given, for the parameter file.
    fn settings(&self, given: &Given) -> Vec<(Parameter, f64)> {
        let all = [(Parameter::M1, given.m1), (Parameter::M2, given.m2), (Parameter::G, given.g)];
        all.into_iter().filter(|(_, value)| value.is_finite()).collect()
    }

    fn draw(&self, found: &[Found], given: &Given, folder: &Path) -> Result<Vec<PathBuf>, Failure> {
        let place =
            Place { folder, formats: &[Format::Png, Format::Pdf], overwrite: self.overwrite };
        let plots: Vec<Plot> = found
            .iter()
            .filter_map(|it| evidence_plot(it.test, &it.recording, &it.evidence, given))
            .collect();
        let mut paths = Vec::new();
        for plot in plots {
            paths.extend(draw_plot(&plot, &place).map_err(Failure::request)?.paths);
        }
        Ok(paths)
    }
}

/// Reads a recording and identifies its constants.
fn read(test: Test, path: &Path, given: &Given) -> Result<Found, Failure> {
    let text = files::text(path)?;
    let recording = files::recording_in(&text, path, &test.columns(), test.least_rows())?;
    let impossible = impossible_rows(test, &recording);
    if !impossible.is_empty() {
        let told = impossible.iter().take(MOST_TOLD);
        let mut faults: Vec<String> = told
            .map(|(row, why)| format!("{}: line {}: {why}", printable(path), line_of(&text, *row)))
            .collect();
        let more = impossible.len() - faults.len();
        if more > 0 {
            faults.push(format!("{}: and {more} faults more", printable(path)));
        }
        return Err(Failure::requests(&faults));
    }
    let (identified, evidence) = identify(test, &recording, given)
        .map_err(|why| Failure::request(format!("{}: {why}", printable(path))))?;
    Ok(Found { test, recording, identified, evidence })
}

/// The line of a row of numbers, counted from 0, in a file with a header, blank lines and comments.
fn line_of(text: &str, row: usize) -> usize {
    let is_row = |line: &str| !line.trim().is_empty() && !line.starts_with('#');
    let rows = text.lines().enumerate().filter(|(_, line)| is_row(line));
    rows.skip(1).nth(row).map_or(0, |(line, _)| line + 1)
}

/// A value with the decimals that show two significant digits of its standard error; without one, with three significant digits.
pub fn shown(value: f64, error: f64) -> String {
    match decimals(error) {
        Some(decimals) => format!("{value:.decimals$}"),
        None => significant(value, 3),
    }
}

/// An estimate in words: value, standard error and interval; where the data do not determine it, what they say of it.
fn told(estimate: &Estimate, verdict: Verdict, unit: &str) -> String {
    let Estimate { value, standard_error: error, interval } = estimate;
    let is_told = verdict == Verdict::Determined && error.is_finite();
    let [least, greatest] = interval.map(|end| match is_told {
        true => shown(end, *error),
        false => significant(end, 3),
    });
    match verdict {
        _ if is_told && *error <= 1e-12 * value.abs() => {
            format!(
                "{}{unit}, no standard error, as the tests do not scatter",
                significant(*value, 6)
            )
        }
        _ if is_told => format!(
            "{}{unit}, standard error {}, 95 %: {least} to {greatest}",
            shown(*value, *error),
            shown(*error, *error)
        ),
        Verdict::LimitedAbove => format!("below {greatest}{unit}, no standard error"),
        Verdict::LimitedBelow => format!("above {least}{unit}, no standard error"),
        _ => format!("between {least} and {greatest}{unit}, no standard error"),
    }
}

/// What a second method gives, and how far it differs.
fn told_of_other(other: &Other, unit: &str) -> String {
    let Other { method, estimate, disagreement, bias } = other;
    let verdict = match estimate.standard_error.is_finite() {
        true => Verdict::Determined,
        false => Verdict::NotDetermined,
    };
    let text = format!("{}, by {method}", told(estimate, verdict, unit));
    let apart = disagreement
        .map(|it| format!("; the methods differ by {:.1} standard errors", it.abs()))
        .unwrap_or_default();
    let bias = bias.map(|it| format!(": {it}")).unwrap_or_default();
    text + &apart + &bias
}

/// The unit as it stands behind a number; nothing for a plain number.
pub fn unit(dimension: Dimension) -> String {
    match dimension {
        Dimension::Number => String::new(),
        dimension => format!(" {}", dimension.unit()),
    }
}

/// The constants, one per line, with notes below.
fn table(all: &[Identified]) -> String {
    let mut text = String::new();
    for it in all {
        let unit = unit(it.constant.dimension());
        let found = told(&it.estimate, it.verdict, &unit);
        text += &format!("{:<15}{found}\n", it.constant.symbol());
        text += &format!("{:<15}{}, {}\n", "", it.method, it.source);
        if let Some(other) = &it.other {
            text += &format!("{:<15}{}\n", "", told_of_other(other, &unit));
        }
        if it.verdict != Verdict::Determined {
            text += &format!("{:<15}{}\n", "", it.verdict);
        }
        for note in &it.notes {
            text += &format!("{:<15}warning: {note}\n", "");
        }
    }
    text
}

fn as_json(all: &[Identified]) -> serde_json::Value {
    let one = |it: &Identified| {
        let other = it.other.map(|it| {
            json!({
                "method": it.method,
                "value": it.estimate.value,
                "standard_error": it.estimate.standard_error,
                "disagreement_in_standard_errors": it.disagreement,
                "bias": it.bias,
            })
        });
        json!({
            "name": it.constant.symbol(),
            "unit": it.constant.dimension().unit(),
            "value": it.estimate.value,
            "standard_error": it.estimate.standard_error,
            "interval_95": it.estimate.interval,
            "verdict": it.verdict.to_string(),
            "method": it.method,
            "recording": it.source,
            "other": other,
            "notes": it.notes,
        })
    };
    json!({ "identified": all.iter().map(one).collect::<Vec<_>>(), "notes": remarks(all) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_have_two_digits_of_their_errors_and_none_where_they_have_none() {
        let told = |value, standard_error, interval, verdict| {
            told(&Estimate { value, standard_error, interval }, verdict, " N/m")
        };
        assert_eq!(
            told(2418.96, 1.499, [2415.72, 2422.2], Verdict::Determined),
            "2419.0 N/m, standard error 1.5, 95 %: 2415.7 to 2422.2"
        );
        let open = f64::INFINITY;
        for (interval, verdict, text) in [
            ([1e-4, 0.00751], Verdict::LimitedAbove, "below 0.00751 N/m, no standard error"),
            ([0.5, 100.0], Verdict::LimitedBelow, "above 0.500 N/m, no standard error"),
            ([0.31, 0.65], Verdict::Several, "between 0.310 and 0.650 N/m, no standard error"),
            (
                [0.31, 0.65],
                Verdict::NotDetermined,
                "between 0.310 and 0.650 N/m, no standard error",
            ),
        ] {
            assert_eq!(told(0.4, open, interval, verdict), text);
            assert_eq!(
                told(0.4, 8.2e32, interval, verdict).split(',').next_back(),
                Some(" no standard error")
            );
        }
        let exact = told(0.65625, 0.0, [0.65625; 2], Verdict::Determined);
        assert_eq!(exact, "0.656250 N/m, no standard error, as the tests do not scatter");
    }

    #[test]
    fn rows_are_found_among_comments_and_blank_lines() {
        let text = "# rig\n\npulled_mass [kg]\n0.4\n# again\n\n-0.4\n";
        assert_eq!([0, 1].map(|row| line_of(text, row)), [4, 7]);
    }
}
