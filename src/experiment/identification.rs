//! What the simple tests of a rig say of its parameters, with where each value comes from.

#[cfg(test)]
mod coverage;
mod identified;
#[cfg(test)]
mod messages;
mod parameter_file;

pub use identified::{Constant, Given, Identified, Other, Test};
pub use parameter_file::parameter_file;

use super::estimate::{Estimate, significant};
use super::free_vibration::{FreeVibration, free_vibration};
use super::friction::{Coasting, CoastingTests, Stribeck, V_S, coasting, static_friction};
use super::line::{Line, Outlier, hysteresis, line, outliers};
use super::noise::of_rounding;
use super::profile::Verdict;
use super::recording::Recording;
use crate::capsule::Parameter;

/// A fitted decay that leaves so many times the noise does not describe the record.
const MISFIT: f64 = 1.5;
/// Two methods disagree where they differ by more standard errors.
const DISAGREE: f64 = 3.0;
/// Why Eq. (2) of the paper is biased.
const EQ_2_BIAS: &str = "biased by construction, as it takes the mean friction over the coast-down for that at the initial speed; no \
                         independent estimate";
/// No friction coefficient of a rig is smaller or larger.
const FRICTION: [f64; 2] = [1e-3, 10.0];
/// Residuals of this share of the largest value are those of rounding in the file, among which there is no outlier.
const ROUNDED: f64 = 1e-6;

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
    if let Some((row, why)) = impossible_rows(test, recording).first() {
        return Err(format!("row {} of the numbers: {why}", row + 1));
    }
    let (mut all, evidence) = match test {
        Test::FreeVibration => of_free_vibration(recording, given)?,
        Test::StaticForce => of_static_force(recording)?,
        Test::Pull => (vec![of_pulls(recording, given)], Evidence::None),
        Test::Coasting => of_coasting(recording, given)?,
        Test::Motor => of_motor(recording)?,
    };
    all.iter_mut().for_each(|it| it.notes.extend(implausible(it.constant, it.estimate.value)));
    Ok((all, evidence))
}

/// Rows with values that the test cannot give, counted from 0, and what is wrong with them.
pub fn impossible_rows(test: Test, recording: &Recording) -> Vec<(usize, String)> {
    let why = match test {
        Test::Pull => "pulled masses must be above zero",
        Test::Coasting => "speeds and distances of coasting tests must be above zero",
        _ => return Vec::new(),
    };
    let columns: Vec<&[f64]> =
        recording.columns.iter().map(|(_, sensed)| &sensed.values[..]).collect();
    let rows = 0..recording.rows();
    let wrong = rows.filter(|&row| columns.iter().any(|values| values[row] <= 0.0));
    wrong.map(|row| (row, why.to_owned())).collect()
}

/// What is said of a value that no rig can have.
fn implausible(constant: Constant, value: f64) -> Option<String> {
    let Constant::Parameter(parameter) = constant else { return None };
    let (symbol, value_text) = (parameter.symbol(), significant(value, 3));
    if !parameter.allowed().admits(value) {
        let allowed = parameter.allowed();
        return Some(format!(
            "{symbol} = {value_text}, but it must be {allowed}: no parameter file has this value"
        ));
    }
    let [least, greatest] = FRICTION;
    let is_friction = [Parameter::MuS, Parameter::MuD].iter().any(|it| parameter == *it);
    let beyond = match value {
        _ if !is_friction => return None,
        _ if value > greatest => format!("above {greatest}"),
        _ if value < least => format!("below {least}"),
        _ => return None,
    };
    Some(format!(
        "{symbol} = {value_text} is {beyond}: are the units of the columns and of the masses right?"
    ))
}

/// What is said of rows far off a line through values y.
fn outliers_of_line(line: &Line, y: &[f64]) -> Vec<String> {
    let largest = y.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    if line.scatter <= ROUNDED * largest {
        return Vec::new();
    }
    outliers(&line.residuals, 2, of_rounding(y)).iter().map(Outlier::to_string).collect()
}

fn of_free_vibration(
    recording: &Recording,
    given: &Given,
) -> Result<(Vec<Identified>, Evidence), String> {
    let found = free_vibration(recording.required("t"), recording.required("r"), given.m1)?;
    let parameters = [Parameter::K1, Parameter::C].into_iter().enumerate();
    let all = parameters.map(|(i, parameter)| of_decay(recording, &found, i, parameter));
    Ok((all.collect(), Evidence::Decay(Box::new(found))))
}

/// The stiffness (0) or the damping (1) of a decay.
fn of_decay(
    recording: &Recording,
    found: &FreeVibration,
    which: usize,
    parameter: Parameter,
) -> Identified {
    Identified {
        constant: Constant::Parameter(parameter.into()),
        estimate: found.by_decay[which],
        verdict: Verdict::Determined,
        method: match found.from_release {
            true => "least squares on the decay from its release on",
            false => {
                "least squares on the decay from where the mass first passes its rest position"
            }
        },
        source: recording.source.clone(),
        other: found.by_decrement.map(|estimates| Other {
            method: "logarithmic decrement",
            estimate: estimates[which],
            disagreement: found.disagreement().map(|it| it[which]),
            bias: None,
        }),
        notes: notes_of_decay(recording, found, which),
    }
}

/// What must be known of the stiffness (0) or the damping (1) of a decay.
fn notes_of_decay(recording: &Recording, found: &FreeVibration, which: usize) -> Vec<String> {
    const WHY: &str =
        "the damping may not be viscous, the spring not linear, or the capsule not at rest";
    let sampling = recording.sampling();
    let mut notes = Vec::new();
    if !sampling.gaps.is_empty() {
        notes.push(format!("the record: {sampling}"));
    }
    if which == 1 && found.by_decay[1].value <= 0.0 {
        notes.push("the amplitude does not decay: is this a free vibration?".to_owned());
    }
    let is_rounding = found.scatter <= ROUNDED * found.amplitudes[0].hypot(found.amplitudes[1]);
    if found.scatter > MISFIT * found.noise && !is_rounding {
        let share = found.scatter / found.noise;
        notes.push(format!(
            "the fitted decay leaves {share:.1} times the noise of the record: {WHY}"
        ));
    }
    match found.disagreement().map(|it| it[which].abs()) {
        Some(apart) if apart > DISAGREE => {
            notes.push(format!("the two methods differ by {apart:.1} standard errors: {WHY}"));
        }
        Some(_) => {}
        None => notes.push(
            "the record has fewer than four turning points above its noise: no second method checks the fit"
                .to_owned(),
        ),
    }
    notes
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
    let curved = line.curvature.map(|it| {
        let [first, last] = it.slopes.map(|slope| 1e-3 / slope);
        let what = if last > first { "stiffens" } else { "softens" };
        format!(
            "the spring is not linear (chance {:.1e}): it {what} from {first:.4} kN/m over the lower half of the loads to {last:.4} kN/m over \
             the upper; one stiffness describes it in the mean only",
            it.chance
        )
    });
    let apart = hysteresis(loads, &line.residuals).map(|it| {
        let (size, what) = (significant(1e3 * it.abs(), 2), if it > 0.0 { "larger" } else { "smaller" });
        format!("deflections are {size} mm {what} while the load falls than while it rises (hysteresis, as of friction)")
    });
    let mut notes: Vec<String> = curved.into_iter().chain(apart).collect();
    if notes.is_empty() {
        notes.extend(outliers_of_line(&line, deflections));
    }
    let identified = Identified {
        constant: Constant::Parameter(Parameter::K2.into()),
        estimate: compliance.map(|it| 1.0 / it, slope),
        verdict: Verdict::Determined,
        method: "line through deflection over load",
        source: recording.source.clone(),
        other: None,
        notes,
    };
    Ok((vec![identified], Evidence::Line(Box::new(line))))
}

fn of_pulls(recording: &Recording, given: &Given) -> Identified {
    let pulled = recording.required("pulled_mass");
    let estimate = static_friction(pulled, given.m1 + given.m2);
    let mut notes = Vec::new();
    if estimate.standard_error <= 1e-12 * estimate.value {
        notes.push(
            "all pulled masses are equal: their scatter is below the steps of the weights, and half a step bounds the error"
                .to_owned(),
        );
    }
    let ratios: Vec<f64> = pulled.iter().map(|it| it / (given.m1 + given.m2)).collect();
    let residuals: Vec<f64> = ratios.iter().map(|it| it - estimate.value).collect();
    let rounding = of_rounding(&ratios);
    notes.extend(outliers(&residuals, 1, rounding).iter().map(Outlier::to_string));
    Identified {
        constant: Constant::Parameter(Parameter::MuS.into()),
        estimate,
        verdict: Verdict::Determined,
        method: "mean of pulled mass over mass of the rig",
        source: recording.source.clone(),
        other: None,
        notes,
    }
}

fn of_coasting(
    recording: &Recording,
    given: &Given,
) -> Result<(Vec<Identified>, Evidence), String> {
    let [speeds, distances] = ["v", "d"].map(|name| recording.required(name));
    let found = coasting(&CoastingTests { speeds, distances, g: given.g })?;
    let parameters = [Parameter::MuD, Parameter::Vs].into_iter().enumerate();
    let all = parameters.map(|(i, parameter)| of_law(recording, &found, i, parameter));
    Ok((all.collect(), Evidence::Coasting(Box::new(found))))
}

/// The dynamic friction coefficient (0) or the Stribeck velocity (1) of coasting tests.
fn of_law(
    recording: &Recording,
    found: &Coasting,
    which: usize,
    parameter: Parameter,
) -> Identified {
    let law = &found.by_coast_down;
    let [second, first] = [law, &found.by_initial_speed].map(|law| [law.mu_d, law.v_s][which]);
    let mut notes: Vec<String> = ambiguity(parameter, law, which).into_iter().collect();
    if which == 0 {
        notes.extend(found.misfits.iter().cloned());
    }
    Identified {
        constant: Constant::Parameter(parameter.into()),
        estimate: second,
        verdict: law.verdicts[which],
        method: "distances of the coast-down under the Coulomb-Stribeck law",
        source: recording.source.clone(),
        other: Some(Other {
            method: "v^2/(2 g d) at the initial speed, Eq. (2)",
            estimate: first,
            disagreement: None,
            bias: Some(EQ_2_BIAS),
        }),
        notes,
    }
}

/// The separate ranges of a parameter of friction that agree with the tests, where there are several.
fn ambiguity(parameter: Parameter, law: &Stribeck, which: usize) -> Option<String> {
    let symbol = parameter.symbol();
    if law.verdicts[which] == Verdict::NotDetermined {
        return (parameter == Parameter::MuD).then(|| {
            "mu_d follows from v_s, of which every value agrees with these tests".to_owned()
        });
    }
    if law.verdicts[which] != Verdict::Several {
        return None;
    }
    let (bounds, unit) = match parameter {
        Parameter::Vs => (V_S, " m/s"),
        _ => ([0.0, f64::INFINITY], ""),
    };
    let ranges: Vec<String> =
        law.ranges[which].iter().map(|range| range_in_words(*range, bounds, unit)).collect();
    Some(format!(
        "{symbol} may be {}: over these speeds a small v_s describes the tests as well as a large one with half the mu_d; tests over more \
         speeds tell them apart",
        ranges.join(" or ")
    ))
}

/// A range, which may end at a bound within which it was looked for.
fn range_in_words([least, greatest]: [f64; 2], bounds: [f64; 2], unit: &str) -> String {
    let [from, to] = [least, greatest].map(|it| significant(it, 3));
    match (least <= bounds[0] * 1.000_001, greatest >= bounds[1] * 0.999_999) {
        (true, _) => format!("below {to}{unit}"),
        (_, true) => format!("above {from}{unit}"),
        _ => format!("{from} to {to}{unit}"),
    }
}

fn of_motor(recording: &Recording) -> Result<(Vec<Identified>, Evidence), String> {
    let [currents, forces] = ["current", "force"].map(|name| recording.required(name));
    let line =
        line(currents, forces).ok_or("all currents are equal, so no line lies through them")?;
    let largest = forces.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    if line.slope.value.abs() * (currents.iter().fold(0.0, |most: f64, it| most.max(it.abs())))
        <= 1e-12 * largest
    {
        return Err("all forces are equal, so the motor constant is not determined".to_owned());
    }
    let identified = Identified {
        constant: Constant::MotorConstant,
        estimate: line.slope,
        verdict: Verdict::Determined,
        method: "line through force over current",
        source: recording.source.clone(),
        other: None,
        notes: notes_of_motor(&line, forces, largest),
    };
    Ok((vec![identified], Evidence::Line(Box::new(line))))
}

/// What must be known of the line of a motor, whose largest force is this.
fn notes_of_motor(line: &Line, forces: &[f64], largest: f64) -> Vec<String> {
    let intercept = line.intercept;
    let mut notes = Vec::new();
    if !intercept.holds(0.0) && intercept.value.abs() > 1e-9 * largest {
        let force = significant(intercept.value, 3);
        notes.push(format!("without current the force is {force} N, not zero"));
    }
    if line.slope.value < 0.0 {
        notes.push(
            "the force is opposite to the current: is the sign of one of them reversed?".to_owned(),
        );
    }
    if let Some(it) = line.curvature {
        notes.push(format!(
            "the force is not proportional to the current (chance {:.1e})",
            it.chance
        ));
    } else {
        notes.extend(outliers_of_line(line, forces));
    }
    notes
}

/// Notes that concern several constants together.
pub fn remarks(all: &[Identified]) -> Vec<String> {
    let [Some(mu_s), Some(mu_d)] =
        [Parameter::MuS, Parameter::MuD].map(|parameter| determined(all, parameter))
    else {
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

/// The estimate of a parameter, if it is determined.
fn determined(all: &[Identified], parameter: Parameter) -> Option<Estimate> {
    let found = all.iter().find(|it| it.constant == Constant::Parameter(parameter.into()))?;
    (found.verdict == Verdict::Determined).then_some(found.estimate)
}
