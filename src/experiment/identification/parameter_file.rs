//! The parameter file of identified constants, which studies include.

use super::identified::{Constant, Identified};
use crate::description::Parameter;
use crate::experiment::profile::Verdict;
use crate::quantity::Dimension;

/// The identified constants as a parameter file, which studies include by `include = "FILE"`; `settings` are parameters that
/// were given, by symbol with their values as text. A constant that is not determined on both sides has no value there.
pub fn parameter_file(all: &[Identified], settings: &[(Parameter, f64)]) -> String {
    let mut text = concat!(
        "# Identified by capsulemap ",
        env!("CARGO_PKG_VERSION"),
        ". A study takes these values by include = \"FILE\" at its top.\n\n[parameters]\n"
    )
    .to_owned();
    for (parameter, value) in settings {
        text += &format!("{} = {}\n", parameter.symbol(), quantity(*value, parameter.dimension()));
    }
    for it in all {
        text += &setting(it);
    }
    for it in all {
        text += &provenance(it);
    }
    text
}

fn unit_behind(dimension: Dimension) -> String {
    match dimension {
        Dimension::Number => String::new(),
        dimension => format!(" {}", dimension.unit()),
    }
}

fn quantity(value: f64, dimension: Dimension) -> String {
    match dimension {
        Dimension::Number => format!("{value}"),
        dimension => format!("\"{value} {}\"", dimension.unit()),
    }
}

/// The line of a constant under `[parameters]`; a comment where it has no value that studies may take.
fn setting(it: &Identified) -> String {
    let Constant::Parameter(parameter) = it.constant else { return String::new() };
    let (symbol, verdict) = (parameter.symbol(), it.verdict);
    let value = quantity(it.estimate.value, parameter.dimension());
    let unless = match parameter.is_asked_for() {
        true => format!("a study must set {symbol}"),
        false => {
            let default = parameter.default_value();
            let unit = unit_behind(parameter.dimension());
            format!("a study takes the default, {default}{unit}, unless it sets {symbol}")
        }
    };
    match (verdict, parameter.allowed().admits(it.estimate.value)) {
        (Verdict::Determined, true) => format!("{symbol} = {value}\n"),
        (Verdict::Determined, false) => {
            format!(
                "# {symbol} = {value} was found, but must be {}; {unless}\n",
                parameter.allowed()
            )
        }
        _ => format!("# {symbol} has no value here: {verdict}; {unless}\n"),
    }
}

/// The table that says how a constant was found.
fn provenance(it: &Identified) -> String {
    let Identified { constant, estimate, verdict, method, source, .. } = it;
    let dimension = constant.dimension();
    let [least, greatest] = estimate.interval.map(|it| quantity(it, dimension));
    let mut text = format!("\n[identified.{}]\n", constant.symbol());
    if *verdict == Verdict::Determined {
        text += &format!("value = {}\n", quantity(estimate.value, dimension));
        if estimate.standard_error.is_finite() {
            let error = quantity(estimate.standard_error, dimension);
            text += &format!("standard_error = {error}\n");
        }
    }
    if estimate.interval.iter().all(|it| it.is_finite()) {
        text += &format!("interval_95 = [{least}, {greatest}]\n");
    }
    text += &format!(
        "verdict = \"{verdict}\"\nmethod = \"{method}\"\nrecording = {}\n",
        toml_string(source)
    );
    for note in &it.notes {
        text += &format!("# {note}\n");
    }
    text
}

/// A text as TOML writes it.
fn toml_string(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
