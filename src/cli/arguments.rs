//! Reads what several commands are given: the machine, names out of a few, and quantities.

use clap::builder::{PossibleValuesParser, TypedValueParser};

use std::path::Path;

use super::failure::Failure;
use super::readable::counted;
use super::scheduler;
use super::terminal::notify;
use crate::campaign::quoted;
use crate::description::{Description, Output};
use crate::lane::Instructions;
use crate::quantity::{Dimension, parse_quantity};
use crate::run::Machine;
use crate::store::Archive;
use crate::study::document::unknown;
use crate::tradeoff::GainAndCost;

/// What to run on, as far as this machine has it.
pub fn machine(
    threads: Option<u16>,
    instructions: Option<Instructions>,
) -> Result<Machine, Failure> {
    let threads = threads.map(usize::from).or_else(granted);
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

/// The processors that a scheduler has granted this task, if one says so; it is told where a run would use others.
fn granted() -> Option<usize> {
    let (count, name) = scheduler::granted(&|name| std::env::var(name).ok())?;
    let threads = counted(count, "thread");
    notify(&format!("{threads}, as {name} says; --threads sets another number"));
    Some(count)
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

/// The output of results that `--of` names as the cost; the power if it names none and the model has one.
pub fn cost(archive: &Archive, name: Option<&str>) -> Result<Output, String> {
    let model = archive.frame().model();
    match name {
        Some(name) => output("--of", name, model),
        None if model.has_trade_off() => Ok(model.power()),
        None => Err(unnamed(archive, "--of", "cost", "small")),
    }
}

/// The output of results that `--for` names as the gain; the speed if it names none and the model has one.
pub fn gain(archive: &Archive, name: Option<&str>) -> Result<Output, String> {
    let model = archive.frame().model();
    match name {
        Some(name) => output("--for", name, model),
        None => {
            GainAndCost::own_gain(model).ok_or_else(|| unnamed(archive, "--for", "gain", "large"))
        }
    }
}

/// The output of a model that an option names.
fn output(option: &str, name: &str, model: &'static Description) -> Result<Output, String> {
    let names = model.outputs().map(|output| output.name());
    model.output(name).ok_or_else(|| format!("{option}: {}", unknown("output", name, names)))
}

/// What is said where a model has no gain or cost of its own, and no option names one.
fn unnamed(archive: &Archive, option: &str, what: &str, size: &str) -> String {
    let model = archive.frame().model();
    let kept = model.outputs().map(|it| it.name()).filter(|it| archive.unit(it).is_some());
    format!(
        "{option}: missing; the model {} names no {what} of its own, so name the output that should be {size} (allowed: {})",
        model.name,
        kept.collect::<Vec<_>>().join(", ")
    )
}

/// A gain against a cost; an output against itself is refused, but for the gain that the model names.
pub fn held(gain: Output, cost: Output) -> Result<GainAndCost, String> {
    let of = GainAndCost { gain, cost };
    match gain == cost && !of.has_own_gain() {
        true => Err(format!("--for: `{}` is the output of --of, too; name another", gain.name())),
        false => Ok(of),
    }
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
