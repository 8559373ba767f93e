//! `capsulemap synthesize`: recordings of a rig that is a simulation.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;

use super::asked_case::{Takes, asked_case};
use super::failure::Failure;
use super::files;
use super::terminal::print;
use crate::capsule::{CapsuleParameters as _, CapsuleState as _, State};
use crate::description::Parameters;
use crate::experiment::synthesis::recorded;
use crate::experiment::{Laboratory, Sensor, Signal, SimpleTests, Started, Test, simple_tests};
use crate::motion::Case;
use crate::of::settle_case;
use crate::orbit::Protocol;
use crate::quantity::Dimension;
use crate::quantity::printable::printable;

const EXAMPLES: &str = "\
Examples:
  capsulemap synthesize studies/fig5.toml --output rig
  capsulemap synthesize studies/fig6.toml --output rig --cycles 30 --rate \"5 kHz\" --noise x2=0.02mm --seed 7

Writes motion.csv, and free-vibration.csv, static-force.csv, pull.csv, coasting.csv and motor.csv of the simple tests. Sensors of the \
motion, with the standard deviations of their noise: x2 0.01 mm (LVDT), r 0.02 mm (Hall), a1 0.1 m/s2 (accelerometer), drive \
0.05 N (current).";

/// Most samples of a recording.
const MOST_SAMPLES: f64 = 5e6;

/// Make recordings of a rig from a simulation, with noise and sampling as stated.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Synthesize {
    /// The study, or a file of its results, that says what the rig is.
    study: PathBuf,
    /// Its case, counted from 0.
    #[arg(long, default_value_t = 0)]
    case: usize,
    /// The folder to write to.
    #[arg(long, value_name = "FOLDER")]
    output: PathBuf,
    /// Cycles of the drive that are recorded of the motion, once it has settled.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(2..))]
    cycles: u64,
    /// Samples of the motion per second.
    #[arg(long, default_value = "1 kHz")]
    rate: String,
    /// Noise of sensors, as "x2=0.01mm,r=0.02mm,a1=0.1 m/s2,drive=0.05N".
    #[arg(long, value_name = "NAME=DEVIATION,...")]
    noise: Option<String>,
    /// Steps of the values of sensors, as "r=0.005mm"; none by default.
    #[arg(long, value_name = "NAME=STEP,...")]
    quantum: Option<String>,
    /// Phase of the drive at the first sample of the motion.
    #[arg(long, value_name = "ANGLE", default_value = "0 rad", allow_hyphen_values = true)]
    phase: String,
    /// Force per current of the motor.
    #[arg(long, value_name = "QUANTITY", default_value = "5 N/A")]
    motor_constant: String,
    /// Another seed gives other noise.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Replace files that are there.
    #[arg(long)]
    overwrite: bool,
}

/// The sensors and their noise, unless it is set (SI).
const SENSORS: [(Signal, f64); 4] =
    [(Signal::X2, 10e-6), (Signal::R, 20e-6), (Signal::A1, 0.1), (Signal::Drive, 0.05)];

impl Synthesize {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let mut faults = Vec::new();
        let rate = read("--rate", &self.rate, Dimension::AngularFrequency, &mut faults);
        let rate = rate / std::f64::consts::TAU;
        let phase = read("--phase", &self.phase, Dimension::Angle, &mut faults);
        let (option, dimension) = ("--motor-constant", Dimension::ForcePerCurrent);
        let motor_constant = read(option, &self.motor_constant, dimension, &mut faults);
        if rate <= 0.0 {
            faults.push(format!("--rate: {} must be above zero", self.rate));
        }
        let sensors = self.sensors(&mut faults);
        if !faults.is_empty() {
            return Err(Failure::requests(&faults));
        }
        let (case, _) = asked_case(&self.study, self.case, Takes::Capsule)?;
        let paths = self.paths();
        for path in &paths {
            files::check_free(path, self.overwrite)?;
        }
        let motion = self.motion(&case, rate, phase, &sensors)?;
        let laboratory = Laboratory {
            r_noise: noise_of(&sensors, Signal::R),
            deflection_noise: noise_of(&sensors, Signal::X2),
            motor_constant,
            ..Laboratory::default()
        };
        let tests = test_files(&simple_tests(&case.parameters, &laboratory, self.seed));
        let mut text = String::new();
        for (path, content) in paths.iter().zip(tests.into_iter().chain([motion])) {
            files::put(path, &content)?;
            text += &format!("{}\n", printable(path));
        }
        print(&text)
    }

    /// The files to write, in the order of [`Test::ALL`], that of the motion last.
    fn paths(&self) -> Vec<PathBuf> {
        let names = Test::ALL.map(Test::name).into_iter().chain(["motion"]);
        names.map(|name| self.output.join(format!("{name}.csv"))).collect()
    }

    /// The sensors as they are set.
    fn sensors(&self, faults: &mut Vec<String>) -> Vec<Sensor> {
        let mut sensors: Vec<Sensor> =
            SENSORS.map(|(signal, noise)| Sensor { signal, noise, quantum: 0.0 }).to_vec();
        let options = [("--noise", &self.noise), ("--quantum", &self.quantum)];
        for (option, text) in options {
            for pair in text.iter().flat_map(|text| text.split(',')) {
                let Some((name, value)) = pair.split_once('=') else {
                    faults.push(format!("{option}: {pair}: expected NAME=QUANTITY"));
                    continue;
                };
                let names = SENSORS.map(|it| it.0.name()).join(", ");
                let Some(sensor) = sensors.iter_mut().find(|it| it.signal.name() == name.trim())
                else {
                    faults.push(format!(
                        "{option}: no sensor {}; expected one of {names}",
                        name.trim()
                    ));
                    continue;
                };
                match files::quantity(&format!("{option} {name}"), value, sensor.signal.dimension())
                {
                    Ok(value) if value < 0.0 => {
                        faults.push(format!("{option} {name}: {value} is below zero"))
                    }
                    Ok(value) if option == "--noise" => sensor.noise = value,
                    Ok(value) => sensor.quantum = value,
                    Err(fault) => faults.push(fault),
                }
            }
        }
        sensors
    }

    /// The record of the motion on its attractor.
    fn motion(
        &self,
        case: &Case,
        rate: f64,
        phase: f64,
        sensors: &[Sensor],
    ) -> Result<String, Failure> {
        let duration = self.cycles as f64 * case.parameters.drive_period();
        let count = (duration * rate).floor();
        if !(16.0..=MOST_SAMPLES).contains(&count) {
            return Err(Failure::request(format!(
                "--rate {}: {count} samples in {duration} s; expected 16 to {MOST_SAMPLES}",
                self.rate
            )));
        }
        let motion = settled(&case.parameters, case.start.capsule(), phase);
        let times: Vec<f64> = (0..count as u32).map(|i| f64::from(i) / rate).collect();
        let values = recorded(&motion, &times, sensors, self.seed)
            .map_err(|why| Failure::request(format!("the motion cannot be followed: {why:?}")))?;
        let names = sensors
            .iter()
            .map(|it| format!("{} [{}]", it.signal.name(), it.signal.dimension().unit()));
        let header: Vec<String> = ["t [s]".to_owned()].into_iter().chain(names).collect();
        let columns: Vec<&[f64]> =
            [times.as_slice()].into_iter().chain(values.iter().map(Vec::as_slice)).collect();
        Ok(csv(&header.join(","), &columns))
    }
}

/// The quantity that an option was given; a fault is noted, and 1 stands for it.
fn read(option: &str, text: &str, dimension: Dimension, faults: &mut Vec<String>) -> f64 {
    files::quantity(option, text, dimension).unwrap_or_else(|fault| {
        faults.push(fault);
        1.0
    })
}

/// What the capsule settles to from `start`, at this phase of the drive and at x2 = 0.
fn settled(parameters: &Parameters, start: State<f64>, phase: f64) -> Started {
    let case = Case::at_section(parameters.clone(), start, phase);
    let end = settle_case(&case, &Protocol::default()).end;
    Started { parameters: parameters.clone(), start: State { x2: 0.0, ..end.capsule() }, phase }
}

fn noise_of(sensors: &[Sensor], signal: Signal) -> f64 {
    sensors.iter().find(|it| it.signal == signal).map_or(0.0, |it| it.noise)
}

/// The simple tests as files, in the order of [`Test::ALL`].
fn test_files(tests: &SimpleTests) -> Vec<String> {
    vec![
        csv("t [s],r [m]", &tests.free_vibration),
        csv("force [N],deflection [m]", &tests.static_force),
        csv("pulled_mass [kg]", std::slice::from_ref(&tests.pull)),
        csv("v [m/s],d [m]", &tests.coasting),
        csv("current [A],force [N]", &tests.motor),
    ]
}

/// Columns as CSV, with eight digits, which is far below any noise.
fn csv<C: AsRef<[f64]>>(header: &str, columns: &[C]) -> String {
    let mut text = format!("{header}\n");
    for row in 0..columns[0].as_ref().len() {
        for (place, column) in columns.iter().enumerate() {
            let joint = if place == 0 { "" } else { "," };
            // Writing to a text cannot fail.
            let _ = write!(text, "{joint}{:.8e}", column.as_ref()[row]);
        }
        text.push('\n');
    }
    text
}
