//! Sobol indices as a table for people, as JSON and as comma-separated values.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::readable::{count, counted};
use crate::campaign::{
    OutputSensitivity, Sensitivity, SensitivityAnswer, SobolIndex, SobolIndices,
};
use crate::description::Output;
use crate::quantity::printable::printable;

/// A table for people.
pub fn table(asked: &Sensitivity<'_>, answer: &SensitivityAnswer) -> String {
    let design = &answer.design;
    let (rows, length) = (design.base_samples, design.rows().row_length());
    let mut text = format!(
        "{}: {} of {}, {}\nintervals at {} % from {} resamples, seed {}\n",
        printable(asked.file),
        counted(rows, "base sample"),
        match design.quantities.len() {
            1 => "1 quantity".to_owned(),
            several => format!("{several} quantities"),
        },
        counted(rows * length, "case"),
        100.0 * asked.resampling.confidence,
        count(asked.resampling.resamples),
        asked.resampling.seed,
    );
    for (output, found) in &answer.outputs {
        write_output(&mut text, &design.quantities, *output, found);
    }
    text
}

/// What was found of an output.
fn write_output(text: &mut String, names: &[String], output: Output, found: &OutputSensitivity) {
    let unit = bracketed(output);
    // Text can always be written to.
    let _ = match &found.indices {
        Ok(it) => writeln!(
            text,
            "\n{}{unit}: mean {:.6e}, variance {:.6e}",
            output.name(),
            it.mean,
            it.variance
        ),
        Err(why) => writeln!(text, "\n{}{unit}: no indices: {}", output.name(), why.reason()),
    };
    for note in notes(found) {
        let _ = writeln!(text, "  {note}");
    }
    if let Ok(indices) = &found.indices {
        write_indices(text, names, indices);
    }
}

/// The indices, a line for each quantity.
fn write_indices(text: &mut String, names: &[String], indices: &SobolIndices) {
    let width = names.iter().map(|it| it.chars().count()).fold(8, usize::max);
    let _ = writeln!(text, "  {:<width$} {:>17} {:>17}", "", "S1", "ST");
    let each = names.iter().map(String::as_str).zip(indices.first.iter().zip(&indices.total));
    let sums = [("sum", (&indices.first_sum, &indices.total_sum))];
    for (name, (first, total)) in each.chain(sums) {
        let _ = writeln!(text, "  {name:<width$} {:>17} {:>17}", shown(first), shown(total));
    }
}

/// An index with its interval.
fn shown(index: &SobolIndex) -> String {
    format!("{:.4} \u{b1} {:.4}", index.value, index.half_width)
}

/// What is left out, and what the values are where motions do not repeat.
fn notes(found: &OutputSensitivity) -> Vec<String> {
    let mut notes = Vec::new();
    if found.rows_left_out > 0 {
        let reasons = found.left_out.iter().map(|(why, cases)| format!("{} {why}", count(*cases)));
        notes.push(format!(
            "{} of {} left out, by their cases: {}",
            count(found.rows_left_out),
            counted(found.rows + found.rows_left_out, "base sample"),
            reasons.collect::<Vec<_>>().join(", ")
        ));
    }
    if found.aperiodic > 0 {
        notes.push(format!(
            "{} of chaotic or quasi-periodic motions: values are means with standard errors, whose variance each ST has in it",
            counted(found.aperiodic, "case")
        ));
    }
    notes
}

/// The unit of an output in brackets; nothing where it has none.
fn bracketed(output: Output) -> String {
    match output.unit() {
        "1" => String::new(),
        unit => format!(" [{unit}]"),
    }
}

/// One JSON object.
pub fn json(asked: &Sensitivity<'_>, answer: &SensitivityAnswer) -> Value {
    let names = &answer.design.quantities;
    let outputs = answer.outputs.iter().map(|(output, found)| {
        let mut told = Map::new();
        told.insert("unit".to_owned(), json!(output.unit()));
        told.insert("base_samples".to_owned(), json!(found.rows));
        told.insert("base_samples_left_out".to_owned(), json!(found.rows_left_out));
        told.insert("cases_left_out".to_owned(), json!(found.left_out));
        told.insert("aperiodic_cases".to_owned(), json!(found.aperiodic));
        told.insert(
            "no_indices".to_owned(),
            json!(found.indices.as_ref().err().map(|it| it.reason())),
        );
        let indices = found.indices.as_ref().ok();
        told.insert("mean".to_owned(), json!(indices.map(|it| it.mean)));
        told.insert("variance".to_owned(), json!(indices.map(|it| it.variance)));
        insert_both(&mut told, "S1_sum", indices.map(|it| &it.first_sum));
        insert_both(&mut told, "ST_sum", indices.map(|it| &it.total_sum));
        let each = names.iter().enumerate().map(|(place, name)| {
            let mut told = Map::new();
            insert_both(&mut told, "S1", indices.map(|it| &it.first[place]));
            insert_both(&mut told, "ST", indices.map(|it| &it.total[place]));
            (name.clone(), Value::Object(told))
        });
        told.insert("quantities".to_owned(), Value::Object(each.collect()));
        (output.name().to_owned(), Value::Object(told))
    });
    let outputs: Map<String, Value> = outputs.collect();
    json!({
        "file": asked.file,
        "base_samples": answer.design.base_samples,
        "cases": answer.design.base_samples * answer.design.rows().row_length(),
        "quantities": names,
        "confidence": asked.resampling.confidence,
        "resamples": asked.resampling.resamples,
        "seed": asked.resampling.seed,
        "outputs": outputs,
    })
}

/// Inserts an index and half the width of its interval.
fn insert_both(told: &mut Map<String, Value>, name: &str, index: Option<&SobolIndex>) {
    told.insert(name.to_owned(), json!(index.map(|it| it.value)));
    told.insert(format!("{name}_conf"), json!(index.map(|it| it.half_width)));
}

/// Comma-separated values: a header, then a line for each quantity of each output.
pub fn csv(answer: &SensitivityAnswer) -> String {
    let header = [
        "output",
        "unit",
        "quantity",
        "S1",
        "S1_conf",
        "ST",
        "ST_conf",
        "S1_sum",
        "S1_sum_conf",
        "ST_sum",
        "ST_sum_conf",
        "mean",
        "variance",
        "base_samples",
        "base_samples_left_out",
        "aperiodic_cases",
    ];
    let mut text = format!("{}\n", header.join(","));
    for (output, found) in &answer.outputs {
        for (place, name) in answer.design.quantities.iter().enumerate() {
            let mut cells = vec![output.name().to_owned(), output.unit().to_owned(), name.clone()];
            cells.extend(numbers(found, place));
            text += &format!("{}\n", cells.join(","));
        }
    }
    text
}

/// The numbers of an output and a quantity; empty where there are no indices.
fn numbers(found: &OutputSensitivity, place: usize) -> Vec<String> {
    let indices = found.indices.as_ref().ok();
    let of_quantity = indices.map(|it| {
        let both = [it.first[place], it.total[place], it.first_sum, it.total_sum];
        let pairs = both.iter().flat_map(|index| [index.value, index.half_width]);
        pairs.chain([it.mean, it.variance]).map(|number| format!("{number:?}")).collect()
    });
    let mut cells: Vec<String> = of_quantity.unwrap_or_else(|| vec![String::new(); 10]);
    let counts = [found.rows, found.rows_left_out, found.aperiodic];
    cells.extend(counts.map(|count| count.to_string()));
    cells
}
