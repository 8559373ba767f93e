//! `capsulemap inspect`: what is in a file of results.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Map, Value, json};

use super::asked_density::densities;
use super::failure::Failure;
use super::terminal::{print, print_as_it_is};
use super::{attractor_list, basin_list, manifold_list};
use crate::campaign::{WeightedShares, settling_times, weighted_shares};
use crate::run::{SettledWithin, SettlingTimes};
use crate::store::catalogue::{OUTCOME, STUDY_TEXT};
use crate::store::{self, Dataset, Values, Variable};

const EXAMPLES: &str = "\
Examples:
  capsulemap inspect results/overview/overview.h5
  capsulemap inspect FILE.h5 --json | jq .variables.progression_speed
  capsulemap inspect BASIN.h5 --settled-within 20,50,100
  capsulemap inspect BASIN.h5 --density start_r=\"0 mm,2 mm\"
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
    /// Of basins: tell which share of the starts has settled on each attractor within these numbers of cycles.
    #[arg(long, value_name = "CYCLES,...", value_delimiter = ',', conflicts_with = "study")]
    settled_within: Vec<u64>,
    /// Of basins on a grid: tell the shares of starts that are drawn from a normal distribution of this coordinate; once for each.
    #[arg(long, value_name = "NAME=MEAN,DEVIATION", conflicts_with = "study")]
    density: Vec<String>,
}

impl Inspect {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let dataset = store::read(&self.file).map_err(Failure::request)?;
        if self.study {
            return print_as_it_is(dataset.texts.get(STUDY_TEXT).map_or("", String::as_str));
        }
        let basins = self.basins(&dataset)?;
        match self.json {
            true => print(&format!("{:#}\n", describe(&dataset, &basins))),
            false => print(&notify(&dataset, &basins)),
        }
    }

    /// What is asked of basins, and what is told of how they settle.
    fn basins(&self, dataset: &Dataset) -> Result<Basins, Failure> {
        let weighted = match self.density.is_empty() {
            true => None,
            false => {
                let densities = densities(&self.density, dataset.model());
                let densities = densities.map_err(|faults| Failure::requests(&faults))?;
                let found = weighted_shares(dataset, &densities);
                Some(found.map_err(|faults| self.refusal("--density", &faults))?)
            }
        };
        let settling = match settling_times(dataset) {
            Err(fault) if !self.settled_within.is_empty() => {
                return Err(self.refusal("--settled-within", &[fault]));
            }
            found => found.ok(),
        };
        let settling = settling.map(|(times, inferred)| Settling {
            within: match self.settled_within.is_empty() {
                true => times.curve(),
                false => self.settled_within.iter().map(|it| times.within(*it)).collect(),
            },
            times,
            inferred,
        });
        Ok(Basins { weighted, settling })
    }

    /// Why the file does not have what an option asks for.
    fn refusal(&self, option: &str, faults: &[String]) -> Failure {
        let faults: Vec<String> = faults.iter().map(|it| format!("{option}: {it}")).collect();
        Failure::of_file(&self.file, faults.join("; "))
    }
}

/// What is told of basins beside the tables of the file.
struct Basins {
    /// Shares under the distribution that is asked for.
    weighted: Option<WeightedShares>,
    /// How fast starts settle, where the file has basins.
    settling: Option<Settling>,
}

/// How fast starts settle.
struct Settling {
    times: SettlingTimes,
    /// Starts that were inferred.
    inferred: usize,
    /// What has settled within so many cycles.
    within: Vec<SettledWithin>,
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

fn describe(dataset: &Dataset, basins: &Basins) -> Value {
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
        "manifolds": manifold_list::manifolds(dataset),
        "wada": basin_list::wada(dataset),
        "settling": basins.settling.as_ref().map(|it| basin_list::settling(&it.times, it.inferred, &it.within)),
        "weighted": basins.weighted.as_ref().map(basin_list::weighted),
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

fn notify(dataset: &Dataset, basins: &Basins) -> String {
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
    text.push_str(&manifold_list::manifolds_text(dataset));
    text.push_str(&basin_list::wada_text(dataset));
    if let Some(Settling { times, inferred, within }) = &basins.settling {
        text.push_str(&basin_list::settling_text(times, *inferred, within));
    }
    text.push_str(&basins.weighted.as_ref().map_or(String::new(), basin_list::weighted_text));
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
