//! What the simple tests of a rig say of its parameters, with where each value comes from.

use super::estimate::{Estimate, reach};
use super::free_vibration::{FreeVibration, free_vibration};
use super::friction::{Coasting, CoastingTests, coasting, static_friction};
use super::line::{Line, line};
use super::profile::Verdict;
use super::recording::{Column, Presence::Required, Recording};
use crate::capsule::{Dimension, Parameter};

/// A fitted decay that leaves so many times the noise does not describe the record.
const MISFIT: f64 = 1.5;
/// Two methods disagree where chance makes them differ so once in a thousand recordings.
const DISAGREE: f64 = 0.999;

/// A simple test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Test {
    /// The mass is displaced and let go, on a capsule that is held: k1 and c.
    FreeVibration,
    /// The stop is loaded by weights: k2.
    StaticForce,
    /// A weight is increased until it moves the rig: mu_s.
    Pull,
    /// The rig is given a speed and slides until it rests: mu_d and v_s.
    Coasting,
    /// The force on the rod is measured over the current: the motor constant.
    Motor,
}

impl Test {
    /// All of them.
    pub const ALL: [Test; 5] =
        [Test::FreeVibration, Test::StaticForce, Test::Pull, Test::Coasting, Test::Motor];

    /// Its name, which is that of its option and the stem of its file.
    pub fn name(self) -> &'static str {
        match self {
            Test::FreeVibration => "free-vibration",
            Test::StaticForce => "static-force",
            Test::Pull => "pull",
            Test::Coasting => "coasting",
            Test::Motor => "motor",
        }
    }

    /// The columns of its recording.
    pub fn columns(self) -> Vec<Column> {
        let columns: &[(&'static str, Dimension)] = match self {
            Test::FreeVibration => &[("t", Dimension::Time), ("r", Dimension::Length)],
            Test::StaticForce => &[("force", Dimension::Force), ("deflection", Dimension::Length)],
            Test::Pull => &[("pulled_mass", Dimension::Mass)],
            Test::Coasting => &[("v", Dimension::Velocity), ("d", Dimension::Length)],
            Test::Motor => &[("current", Dimension::Current), ("force", Dimension::Force)],
        };
        let column = |&(name, dimension)| Column { name, dimension, presence: Required };
        columns.iter().map(column).collect()
    }

    /// Rows that its recording must have.
    pub fn least_rows(self) -> usize {
        match self {
            Test::FreeVibration => 30,
            Test::StaticForce | Test::Motor => 4,
            Test::Pull => 2,
            Test::Coasting => 4,
        }
    }
}

/// What was identified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Constant {
    /// A parameter of the model.
    Parameter(Parameter),
    /// Force per current of the motor.
    MotorConstant,
}

impl Constant {
    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Constant::Parameter(parameter) => parameter.symbol(),
            Constant::MotorConstant => "motor_constant",
        }
    }

    /// What it measures.
    pub fn dimension(self) -> Dimension {
        match self {
            Constant::Parameter(parameter) => parameter.dimension(),
            Constant::MotorConstant => Dimension::ForcePerCurrent,
        }
    }
}

/// An identified constant with where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Identified {
    /// Which.
    pub constant: Constant,
    /// Its value with its uncertainty (SI).
    pub estimate: Estimate,
    /// What the data say of it, where they may leave it open.
    pub verdict: Verdict,
    /// How it was found.
    pub method: &'static str,
    /// The recording.
    pub source: String,
    /// What another method gives, by its name.
    pub other: Option<(&'static str, Estimate)>,
    /// What must be known of it, a sentence each.
    pub notes: Vec<String>,
}

/// Masses and gravity, which the tests take as exact (SI).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Given {
    /// The mass.
    pub m1: f64,
    /// The capsule.
    pub m2: f64,
    /// Gravity.
    pub g: f64,
}

/// What a test says, beside its constants, for a picture.
#[derive(Debug, Clone, PartialEq)]
pub enum Evidence {
    /// The fitted decay.
    Decay(Box<FreeVibration>),
    /// The fitted line.
    Line(Box<Line>),
    /// The coefficients of the coasting tests with the fitted laws.
    Coasting(Box<Coasting>),
    /// Nothing to draw.
    None,
}

/// The constants that a recording of a test gives.
///
/// Fails where the recording does not allow it, and says why.
pub fn identify(
    test: Test,
    recording: &Recording,
    given: &Given,
) -> Result<(Vec<Identified>, Evidence), String> {
    match test {
        Test::FreeVibration => of_free_vibration(recording, given),
        Test::StaticForce => of_static_force(recording),
        Test::Pull => Ok((vec![of_pulls(recording, given)], Evidence::None)),
        Test::Coasting => of_coasting(recording, given),
        Test::Motor => of_motor(recording),
    }
}

fn of_free_vibration(
    recording: &Recording,
    given: &Given,
) -> Result<(Vec<Identified>, Evidence), String> {
    let sampling = recording.sampling();
    let found = free_vibration(recording.required("t"), recording.required("r"), given.m1)?;
    let gaps = (!sampling.gaps.is_empty()).then(|| format!("the record: {sampling}"));
    let apart = found.disagreement();
    let identified = |i: usize, parameter: Parameter| {
        let mut notes: Vec<String> = gaps.iter().cloned().collect();
        if parameter == Parameter::C && found.by_decay[i].value <= 0.0 {
            notes.push(
                "the amplitude does not decay: is this a free vibration? no parameter file has this value"
                    .to_owned(),
            );
        }
        if found.scatter > MISFIT * found.noise {
            notes.push(format!(
                "the fitted decay leaves {:.1} times the noise of the record: the damping may not be viscous, the spring not linear, or the \
                 capsule not at rest",
                found.scatter / found.noise
            ));
        }
        if apart[i] > reach(found.turns - 2, DISAGREE) {
            let apart = apart[i];
            notes.push(format!(
                "the two methods differ by {apart:.1} standard errors: the damping may not be viscous, the spring not linear, or \
                 the capsule not at rest"
            ));
        }
        Identified {
            constant: Constant::Parameter(parameter),
            estimate: found.by_decay[i],
            verdict: Verdict::Determined,
            method: "least squares on the whole decay",
            source: recording.source.clone(),
            other: Some(("logarithmic decrement", found.by_decrement[i])),
            notes,
        }
    };
    let all = vec![identified(0, Parameter::K1), identified(1, Parameter::C)];
    Ok((all, Evidence::Decay(Box::new(found))))
}

/// The deflection over the load, as weights are known better than deflections.
fn of_static_force(recording: &Recording) -> Result<(Vec<Identified>, Evidence), String> {
    let [loads, deflections] = ["force", "deflection"].map(|name| recording.required(name));
    let line =
        line(loads, deflections).ok_or("all loads are equal, so no line lies through them")?;
    let compliance = line.slope;
    if compliance.interval[0] <= 0.0 {
        return Err("the deflection does not grow with the load: the stiffness is not determined"
            .to_owned());
    }
    let slope = -1.0 / (compliance.value * compliance.value);
    let notes = line.curvature.map(|it| {
        let [first, last] = it.slopes.map(|slope| 1e-3 / slope);
        let what = if last > first { "stiffens" } else { "softens" };
        format!(
            "the spring is not linear (chance {:.1e}): it {what} from {first:.4} kN/m over the lower half of the loads to {last:.4} kN/m over \
             the upper; one stiffness describes it in the mean only",
            it.chance
        )
    });
    let identified = Identified {
        constant: Constant::Parameter(Parameter::K2),
        estimate: compliance.map(|it| 1.0 / it, slope),
        verdict: Verdict::Determined,
        method: "line through deflection over load",
        source: recording.source.clone(),
        other: None,
        notes: notes.into_iter().collect(),
    };
    Ok((vec![identified], Evidence::Line(Box::new(line))))
}

fn of_pulls(recording: &Recording, given: &Given) -> Identified {
    let pulled = recording.required("pulled_mass");
    Identified {
        constant: Constant::Parameter(Parameter::MuS),
        estimate: static_friction(pulled, given.m1 + given.m2),
        verdict: Verdict::Determined,
        method: "mean of pulled mass over mass of the rig",
        source: recording.source.clone(),
        other: None,
        notes: Vec::new(),
    }
}

fn of_coasting(
    recording: &Recording,
    given: &Given,
) -> Result<(Vec<Identified>, Evidence), String> {
    let [speeds, distances] = ["v", "d"].map(|name| recording.required(name));
    if speeds.iter().chain(distances).any(|it| *it <= 0.0) {
        return Err("speeds and distances of coasting tests must be above zero".to_owned());
    }
    let found = coasting(&CoastingTests { speeds, distances, g: given.g })?;
    let (second, first) = (&found.by_coast_down, &found.by_initial_speed);
    let identified =
        |parameter, (estimate, other): (Estimate, Estimate), verdict: Verdict| Identified {
            constant: Constant::Parameter(parameter),
            estimate,
            verdict,
            method: "distances of the coast-down under the Coulomb-Stribeck law",
            source: recording.source.clone(),
            other: Some(("v^2/(2 g d) at the initial speed, Eq. (2)", other)),
            notes: Vec::new(),
        };
    let all = vec![
        identified(Parameter::MuD, (second.mu_d, first.mu_d), second.verdicts[0]),
        identified(Parameter::Vs, (second.v_s, first.v_s), second.verdicts[1]),
    ];
    Ok((all, Evidence::Coasting(Box::new(found))))
}

fn of_motor(recording: &Recording) -> Result<(Vec<Identified>, Evidence), String> {
    let [currents, forces] = ["current", "force"].map(|name| recording.required(name));
    let line =
        line(currents, forces).ok_or("all currents are equal, so no line lies through them")?;
    let intercept = line.intercept;
    let mut notes = Vec::new();
    if !intercept.holds(0.0) {
        notes.push(format!("without current the force is {:.4} N, not zero", intercept.value));
    }
    if let Some(it) = line.curvature {
        notes.push(format!(
            "the force is not proportional to the current (chance {:.1e})",
            it.chance
        ));
    }
    let identified = Identified {
        constant: Constant::MotorConstant,
        estimate: line.slope,
        verdict: Verdict::Determined,
        method: "line through force over current",
        source: recording.source.clone(),
        other: None,
        notes,
    };
    Ok((vec![identified], Evidence::Line(Box::new(line))))
}

/// Notes that concern several constants together.
pub fn remarks(all: &[Identified]) -> Vec<String> {
    let of = |parameter| {
        let found = all.iter().find(|it| it.constant == Constant::Parameter(parameter))?;
        Some(found.estimate)
    };
    let (Some(mu_s), Some(mu_d)) = (of(Parameter::MuS), of(Parameter::MuD)) else {
        return Vec::new();
    };
    if mu_s.value >= 2.0 * mu_d.value {
        return Vec::new();
    }
    vec![format!(
        "mu_s = {:.4} is below 2 mu_d = {:.4}, the friction of sliding at rest: below it mu_s has no effect, and the capsule \
         breaks away at 2 mu_d",
        mu_s.value,
        2.0 * mu_d.value
    )]
}

/// The identified constants as a parameter file, which studies include by `include = "FILE"`; `settings` are parameters that
/// were given, by symbol with their values as text.
pub fn parameter_file(all: &[Identified], settings: &[(Parameter, f64)]) -> String {
    let mut text = concat!(
        "# Identified by capsulemap ",
        env!("CARGO_PKG_VERSION"),
        ". A study takes these values by include = \"FILE\" at its top.\n\n[parameters]\n"
    )
    .to_owned();
    let quantity = |value: f64, dimension: Dimension| match dimension {
        Dimension::Number => format!("{value}"),
        dimension => format!("\"{value} {}\"", dimension.unit()),
    };
    for (parameter, value) in settings {
        text += &format!("{} = {}\n", parameter.symbol(), quantity(*value, parameter.dimension()));
    }
    for it in all {
        let Constant::Parameter(parameter) = it.constant else { continue };
        let value = quantity(it.estimate.value, parameter.dimension());
        let symbol = parameter.symbol();
        text += &match (it.verdict, parameter.allowed().admits(it.estimate.value)) {
            (Verdict::NotDetermined, _) => {
                format!("# {symbol} is not determined by the recording\n")
            }
            (_, false) => {
                format!("# {symbol} = {value} was found, but must be {}\n", parameter.allowed())
            }
            (_, true) => format!("{symbol} = {value}\n"),
        };
    }
    for it in all {
        let Identified { constant, estimate, verdict, method, source, .. } = it;
        let of = |value: f64| quantity(value, constant.dimension());
        let [least, greatest] = estimate.interval.map(of);
        text += &format!(
            "\n[identified.{}]\nvalue = {}\nstandard_error = {}\ninterval_95 = [{least}, {greatest}]\nverdict = \"{verdict}\"\nmethod = \
             \"{method}\"\nrecording = {}\n",
            constant.symbol(),
            of(estimate.value),
            of(estimate.standard_error),
            toml_string(source),
        );
        for note in &it.notes {
            text += &format!("# {note}\n");
        }
    }
    text
}

/// A text as TOML writes it.
fn toml_string(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
