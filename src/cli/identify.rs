//! `capsulemap identify`: the constants of a rig from its simple tests.

use std::path::{Path, PathBuf};

use clap::Args;

use super::experiment_figures::evidence_plot;
use super::failure::Failure;
use super::files;
use super::identify_report::{as_json, table};
use super::recording_form::RecordingForm;
use super::terminal::print;
use crate::capsule::Parameter;
use crate::description;
use crate::experiment::identification::{Evidence, impossible_rows, parameter_file, remarks};
use crate::experiment::{Column, FileForm, Given, Identified, Recording, Test, identify};
use crate::figure::plot::{Plot, draw_plot};
use crate::figure::{Format, Place};
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
    #[command(flatten)]
    form: RecordingForm,
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
        let columns: Vec<Vec<Column>> = files.iter().map(|it| it.0.columns().to_vec()).collect();
        let forms = self.form.of_each(&columns)?;
        let mut found = Vec::new();
        let mut failures = Vec::new();
        for ((test, path), form) in files.into_iter().zip(&forms) {
            match read(test, &path, &given, form) {
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
        let files = Test::ALL.into_iter().zip(own).filter_map(|(test, own)| {
            let in_folder = self.folder.as_ref().map(|it| it.join(format!("{}.csv", test.name())));
            // What is no plain file is refused when it is read, rather than taken as absent.
            let there = in_folder.filter(|path| path.symlink_metadata().is_ok());
            Some((test, own.clone().or(there)?))
        });
        let files: Vec<(Test, PathBuf)> = files.collect();
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
        let pulled = files.iter().find(|(test, _)| *test == Test::Pull);
        let needs_m1 =
            files.iter().find(|(test, _)| [Test::FreeVibration, Test::Pull].contains(test));
        let m1 = read_given("--m1", self.m1.as_ref(), Parameter::M1, needs_m1, &mut faults);
        let m2 = read_given("--m2", self.m2.as_ref(), Parameter::M2, pulled, &mut faults);
        let g = read_given("--g", Some(&self.g), Parameter::G, None, &mut faults);
        if faults.is_empty() { Ok(Given { m1, m2, g }) } else { Err(Failure::requests(&faults)) }
    }

    /// The parameters that were given, for the parameter file.
    fn settings(&self, given: &Given) -> Vec<(description::Parameter, f64)> {
        let all = [(Parameter::M1, given.m1), (Parameter::M2, given.m2), (Parameter::G, given.g)];
        let given = all.into_iter().filter(|(_, value)| value.is_finite());
        given.map(|(parameter, value)| (parameter.into(), value)).collect()
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

/// The value of a parameter above zero, which a test may need; a fault is noted and gives no number.
fn read_given(
    option: &str,
    text: Option<&String>,
    parameter: Parameter,
    needed_by: Option<&(Test, PathBuf)>,
    faults: &mut Vec<String>,
) -> f64 {
    match (text, needed_by) {
        (Some(text), _) => match files::quantity(option, text, parameter.dimension()) {
            Ok(value) if value > 0.0 => return value,
            Ok(_) => faults.push(format!("{option}: {text} must be above zero")),
            Err(fault) => faults.push(fault),
        },
        (None, Some((test, path))) => faults.push(format!(
            "{option}: missing; {} needs the {}, as \"{} kg\" ({} test)",
            printable(path),
            parameter.meaning(),
            if parameter == Parameter::M1 { 0.11 } else { 0.53 },
            test.name()
        )),
        (None, None) => {}
    }
    f64::NAN
}

/// Reads a recording and identifies its constants.
fn read(test: Test, path: &Path, given: &Given, form: &FileForm) -> Result<Found, Failure> {
    let recording = files::recording_as(path, &test.columns(), test.least_rows(), form)?;
    let impossible = impossible_rows(test, &recording);
    if let Some((row, why)) = impossible.first() {
        let (line, rows) = (recording.line(*row), impossible.len());
        let so = match rows {
            1 => String::new(),
            rows => format!("; so in {rows} rows, of which this is the first"),
        };
        return Err(Failure::of_file(path, format!("line {line}: {why}{so}")));
    }
    let (mut identified, evidence) =
        identify(test, &recording, given).map_err(|why| Failure::of_file(path, why))?;
    identified.iter_mut().for_each(|it| it.notes.extend(recording.notes.iter().cloned()));
    Ok(Found { test, recording, identified, evidence })
}
