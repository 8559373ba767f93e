//! Reads what several commands are given: the machine, names out of a few, and quantities.

use clap::builder::{PossibleValuesParser, TypedValueParser};

use std::path::Path;

use super::failure::Failure;
use crate::campaign::quoted;
use crate::description::{Description, Output};
use crate::lane::Instructions;
use crate::quantity::printable::printable;
use crate::quantity::{Dimension, parse_quantity};
use crate::run::Machine;
use crate::store::Archive;
use crate::study::document::unknown;

/// What to run on, as far as this machine has it.
pub fn machine(
    threads: Option<u16>,
    instructions: Option<Instructions>,
) -> Result<Machine, Failure> {
    let threads = threads.map(usize::from).or_else(|| granted().filter(|count| *count > 0));
    let Some(missing) = instructions.filter(|it| !it.is_available()) else {
        return Ok(Machine { threads, instructions });
    };
    let available: Vec<_> = Instructions::available().map(Instructions::name).collect();
    Err(Failure::request(format!(
        "--instructions: this processor has no {} (allowed here: {})",
        missing.name(),
        available.join(", ")
    )))
}

/// The processors that Slurm has granted a task, if it says so.
fn granted() -> Option<usize> {
    std::env::var("SLURM_CPUS_PER_TASK").ok()?.trim().parse().ok()
}

/// Reads one of a few names, which the help then lists.
pub fn named<T: Copy + Send + Sync + 'static>(
    names: &'static [(&'static str, T)],
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(names.iter().map(|&(name, _)| name)).map(move |given| {
        let found = names.iter().find(|(name, _)| *name == given);
        found.map(|&(_, value)| value).expect("only known names get here")
    })
}

/// The model of results, of which motions gain something that has a cost.
///
/// Fails where they do not.
pub fn with_trade_off(archive: &Archive) -> Result<&'static Description, Failure> {
    let model = archive.frame().model();
    match model.has_trade_off() {
        true => Ok(model),
        false => Err(Failure::request(format!(
            "{}: {}",
            printable(archive.path()),
            model.without_trade_off()
        ))),
    }
}

/// The output of a model that an option names; its power if it names none.
pub fn price(
    option: &str,
    name: Option<&str>,
    model: &'static Description,
) -> Result<Output, String> {
    let Some(name) = name else { return Ok(model.power()) };
    let names = model.outputs().map(|output| output.name());
    model.output(name).ok_or_else(|| format!("{option}: {}", unknown("output", name, names)))
}

/// What follows a command in a hint, so that it runs as it is printed: the study, and the output where it was given.
pub fn study_arguments(study: &Path, output: Option<&Path>) -> String {
    let study = quoted(&study.to_string_lossy());
    match output {
        Some(output) => format!("{study} --output {}", quoted(&output.to_string_lossy())),
        None => study,
    }
}

/// A quantity on the command line, in SI; a plain number is in SI already, and none is infinite.
pub fn plain_or_quantity(text: &str, dimension: Dimension) -> Result<f64, String> {
    let plain = text.trim().parse::<f64>();
    let value = plain.or_else(|_| parse_quantity(text, dimension))?;
    if value.is_finite() { Ok(value) } else { Err(format!("{value} is not a finite number")) }
}

/// The quantity that an option was given, as [`plain_or_quantity`] reads it; a fault is noted and gives none.
pub fn read_quantity(
    option: &str,
    text: &str,
    dimension: Dimension,
    faults: &mut Vec<String>,
) -> Option<f64> {
    plain_or_quantity(text, dimension)
        .map_err(|fault| faults.push(format!("{option}: {fault}")))
        .ok()
}
