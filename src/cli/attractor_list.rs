//! The attractors of the starts of a study, the saddles between their basins and the boundary of these, as tables on the terminal.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::description::Output;
use crate::store::Dataset;
use crate::store::catalogue::{
    ATTRACTOR, ATTRACTOR_KIND, ATTRACTOR_PERIOD, ATTRACTOR_SHARE, ATTRACTOR_SHARE_ERROR,
    BOUNDARY_DIMENSION, EDGE_HIGH, EDGE_LOW, EDGE_MULTIPLIER_REAL, EDGE_PERIOD, PERIOD, Place,
    UNCERTAINTY_EXPONENT, UNCERTAINTY_EXPONENT_ERROR, UNCERTAINTY_SCALES, UNCERTAINTY_SLOPE,
    UNCERTAINTY_SLOPE_ERROR, UNCERTAINTY_SPAN,
};

/// The attractors in the order of their numbers, each as an object; empty where the file has no table of them, as that of a study
/// along a parameter, which has a table for each of its values.
pub fn attractors(dataset: &Dataset) -> Vec<Value> {
    let dimensions = dataset.variable(ATTRACTOR_KIND.name).map(|it| it.values.shape().len());
    if dimensions != Some(1) {
        return Vec::new();
    }
    let kinds = numbers(dataset, ATTRACTOR_KIND.name);
    let flags = dataset.variable(ATTRACTOR_KIND.name).map_or(&[][..], |it| &it.flags);
    let periods = numbers(dataset, ATTRACTOR_PERIOD.name);
    let [shares, errors] =
        [ATTRACTOR_SHARE, ATTRACTOR_SHARE_ERROR].map(|it| numbers(dataset, it.name));
    let outputs = dataset.model().gain_and_work().into_iter();
    let outputs: Vec<(Output, Vec<f64>)> =
        outputs.map(|it| (it, numbers(dataset, &Place::Attractor.name(it.name())))).collect();
    let attractors = kinds.iter().enumerate().map(|(number, code)| {
        let kind = flags.iter().find(|(it, _)| *it as f64 == *code).map(|(_, name)| name);
        let period = periods.get(number).filter(|period| **period > 0.0);
        let mut told = json!({
            ATTRACTOR.name: number,
            "kind": kind,
            PERIOD.name: period.map(|it| *it as u64),
        });
        for (output, values) in &outputs {
            told[output.name()] = json!(values.get(number));
        }
        told["share"] = json!(shares.get(number));
        told["share_error"] = json!(errors.get(number));
        told
    });
    attractors.collect()
}

/// The saddles, each as an object; empty where the file has none.
pub fn saddles(dataset: &Dataset) -> Vec<Value> {
    let [low, high, period] =
        [EDGE_LOW, EDGE_HIGH, EDGE_PERIOD].map(|it| numbers(dataset, it.name));
    let multipliers = numbers(dataset, EDGE_MULTIPLIER_REAL.name);
    let width = multipliers.len().checked_div(low.len()).unwrap_or(0);
    let saddles = (0..low.len()).map(|place| {
        json!({
            "between": [low[place] as u64, high[place] as u64],
            PERIOD.name: period[place] as u64,
            "multipliers_real": multipliers[place * width..(place + 1) * width],
        })
    });
    saddles.collect()
}

/// How the boundary of the basins goes with the size of boxes, and a word where no power law describes it; empty where the file
/// does not tell.
fn boundary(dataset: &Dataset) -> String {
    let known = [UNCERTAINTY_EXPONENT, UNCERTAINTY_EXPONENT_ERROR, BOUNDARY_DIMENSION]
        .map(|entry| numbers(dataset, entry.name).first().copied());
    let [Some(exponent), Some(error), Some(dimension)] = known else { return String::new() };
    let mut text = format!(
        "\nboundary of the basins: dimension {dimension:.3} ± {error:.3}, uncertainty exponent {exponent:.3} ± {error:.3} (sizes in starts)\n"
    );
    let [spans, slopes, errors] = [UNCERTAINTY_SPAN, UNCERTAINTY_SLOPE, UNCERTAINTY_SLOPE_ERROR]
        .map(|entry| numbers(dataset, entry.name));
    for ((span, slope), error) in spans.iter().zip(&slopes).zip(&errors) {
        if slope.is_finite() {
            let _ = writeln!(text, "  local slope {slope:.3} ± {error:.3} from the size {span} on");
        }
    }
    if numbers(dataset, UNCERTAINTY_SCALES.name).first() == Some(&0.0) {
        text.push_str(
            "  no power law: local slopes differ by more than their errors; exponent and dimension are means over these sizes\n",
        );
    }
    text
}

/// All as tables; empty where there is nothing of it.
pub fn tables(dataset: &Dataset) -> String {
    let mut text = String::new();
    let (attractors, saddles) = (attractors(dataset), saddles(dataset));
    if !attractors.is_empty() {
        write_attractors(&mut text, dataset, &attractors);
    }
    if !saddles.is_empty() {
        write_saddles(&mut text, &saddles);
    }
    text + &boundary(dataset)
}

fn write_attractors(text: &mut String, dataset: &Dataset, attractors: &[Value]) {
    let (outputs, main) = (dataset.model().gain_and_work(), dataset.model().main_output());
    let headings: Vec<String> = outputs.iter().map(|it| heading(*it, *it == main)).collect();
    text.push_str("\nattractors, by their numbers in the file and in figures\n");
    let _ = writeln!(
        text,
        "  {:>3}  {:<14} {}  share of the starts",
        "",
        "motion",
        headings.join("  ")
    );
    for it in attractors {
        let kind = it["kind"].as_str().unwrap_or("-");
        let motion = it[PERIOD.name].as_u64().map_or(kind.to_owned(), |it| format!("period {it}"));
        let values = outputs.iter().zip(&headings).map(|(output, heading)| {
            format!("{:>width$}", number(&it[output.name()]), width = heading.chars().count())
        });
        let values = values.collect::<Vec<_>>().join("  ");
        let [share, error] = ["share", "share_error"].map(|key| number(&it[key]));
        let error = match it["share_error"].is_null() {
            true => "of those computed, others are missing".to_owned(),
            false => format!("± {error}"),
        };
        let _ =
            writeln!(text, "  {:>3}  {motion:<14} {values}  {share} {error}", it[ATTRACTOR.name]);
    }
}

/// What stands above the column of an output; the main one is called speed.
fn heading(output: Output, is_main: bool) -> String {
    match is_main {
        true => format!("{:>12}", format!("speed [{}]", output.unit())),
        false => format!("{:>17}", format!("{} [{}]", output.name(), output.unit())),
    }
}

fn write_saddles(text: &mut String, saddles: &[Value]) {
    text.push_str("\nsaddles on the boundaries of their basins\n");
    for it in saddles {
        let [low, high] = [0, 1].map(|end| &it["between"][end]);
        let largest = number(&it["multipliers_real"][0]);
        let period = &it[PERIOD.name];
        let _ = writeln!(text, "  between {low} and {high}: period {period}, multiplier {largest}");
    }
}

/// A number with six decimals; a dash where there is none.
fn number(value: &Value) -> String {
    value.as_f64().map_or("-".to_owned(), |it| format!("{it:.6}"))
}

/// A whole number that the file has once; none where it has not.
pub fn whole(dataset: &Dataset, name: &str) -> Option<u64> {
    numbers(dataset, name).first().map(|it| *it as u64)
}

/// The numbers of a variable as they are stored; none where there is none.
pub fn numbers(dataset: &Dataset, name: &str) -> Vec<f64> {
    let variable = dataset.variable(name);
    variable.map_or(Vec::new(), |it| it.values.to_real().into_iter().collect())
}
