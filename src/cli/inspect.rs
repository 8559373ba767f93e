//! `capsulemap inspect`: what is in a file of results.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Map, Value, json};

use super::attractor_list;
use super::failure::Failure;
use super::terminal::{print, print_as_it_is};
use crate::store::catalogue::{OUTCOME, STUDY_TEXT};
use crate::store::{self, Dataset, Values, Variable};

const EXAMPLES: &str = "\
Examples:
  capsulemap inspect results/overview/overview.h5
  capsulemap inspect FILE.h5 --json | jq .variables.progression_speed
  capsulemap inspect FILE.h5 --study > again.toml";

/// Say what is in a file of results.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Inspect {
    /// The file of results.
    file: PathBuf,
    /// Print one JSON object.
    #[arg(long, conflicts_with = "study")]
    json: bool,
    /// Print the study that the results came from.
    #[arg(long)]
    study: bool,
}

impl Inspect {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let dataset = store::read(&self.file).map_err(Failure::request)?;
        if self.study {
            print_as_it_is(dataset.texts.get(STUDY_TEXT).map_or("", String::as_str))
        } else if self.json {
            print(&format!("{:#}\n", describe(&dataset)))
        } else {
            print(&notify(&dataset))
        }
    }
}

/// Least and greatest value that is a number, and how many are not.
fn range(values: &Values) -> (Option<[f64; 2]>, usize) {
    let reals = values.to_real();
    let mut finite = reals.iter().copied().filter(|value| value.is_finite());
    let missing = reals.iter().filter(|value| value.is_nan()).count();
    let first = finite.next();
    let range = first.map(|first| {
        finite.fold([first, first], |[low, high], value| [low.min(value), high.max(value)])
    });
    (range, missing)
}

fn describe(dataset: &Dataset) -> Value {
    let coordinates: Map<String, Value> =
        dataset.coordinates.iter().map(|(name, it)| (name.clone(), described(it))).collect();
    let variables: Map<String, Value> =
        dataset.variables.iter().map(|(name, it)| (name.clone(), described(it))).collect();
    json!({
        "attributes": dataset.attributes,
        "coordinates": coordinates,
        "variables": variables,
        "attractors": attractor_list::attractors(dataset),
        "saddles": attractor_list::saddles(dataset),
        "outcomes": outcomes(dataset).into_iter().collect::<Map<_, _>>(),
    })
}

fn described(variable: &Variable) -> Value {
    let (range, missing) = range(&variable.values);
    json!({
        "dimensions": variable.dimensions,
        "shape": variable.values.shape(),
        "unit": variable.unit,
        "long_name": variable.long_name,
        "range": range,
        "missing": missing,
    })
}

/// How many cases came out how; what did not occur is left out.
fn outcomes(dataset: &Dataset) -> Vec<(String, Value)> {
    let Some(Variable { values: Values::Integer(codes), flags, .. }) =
        dataset.variable(OUTCOME.name)
    else {
        return Vec::new();
    };
    let counts = flags.iter().map(|(code, name)| {
        let count = codes.iter().filter(|found| *found == code).count();
        (name, count)
    });
    counts
        .filter(|&(_, count)| count > 0)
        .map(|(name, count)| (name.clone(), json!(count)))
        .collect()
}

fn notify(dataset: &Dataset) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    for (name, value) in &dataset.attributes {
        let _ = writeln!(text, "{name}: {value}");
    }
    let counts: Vec<String> =
        outcomes(dataset).iter().map(|(name, count)| format!("{count} {name}")).collect();
    if !counts.is_empty() {
        let _ = writeln!(text, "outcomes: {}", counts.join(", "));
    }
    text.push_str(&attractor_list::tables(dataset));
    let (constants, variables): (Vec<_>, Vec<_>) =
        dataset.variables.iter().partition(|(_, it)| it.dimensions.is_empty());
    text.push_str("\ncoordinates\n");
    for (name, variable) in &dataset.coordinates {
        write_variable(&mut text, name, variable);
    }
    text.push_str("\nvariables\n");
    for (name, variable) in variables {
        write_variable(&mut text, name, variable);
    }
    text.push_str("\nconstants\n");
    for (name, variable) in constants {
        write_variable(&mut text, name, variable);
    }
    text
}

fn write_variable(text: &mut String, name: &str, variable: &Variable) {
    let shape: Vec<String> = variable.values.shape().iter().map(ToString::to_string).collect();
    let (range, missing) = range(&variable.values);
    let mut values = match range {
        Some([low, high]) if low == high => short(low),
        Some([low, high]) => format!("{} .. {}", short(low), short(high)),
        None => "no values".to_owned(),
    };
    if missing > 0 {
        let _ = write!(values, " ({missing} missing)");
    }
    let unit = if variable.unit == "1" { "" } else { &variable.unit };
    let _ = writeln!(
        text,
        "  {name:<24} {:<12} {values} {unit}  [{}]",
        shape.join(" x "),
        variable.long_name
    );
}

/// A number with seven digits that matter, however small or large.
fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        let text = format!("{value:.6}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.6e}")
    }
}
