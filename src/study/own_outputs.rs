//! The outputs of a study: those to keep, and those that it defines over others, `[outputs.own]`.

use capsulemap_text::own::{OUTPUTS, OWN, of_table, with_own};

use super::definition::usual_outputs;
use super::document::{Entry, Fault, Faults, Table};
use crate::description::{Description, Kept, Output, Parameters};
use crate::orbit::{Exponents, Protocol};

/// The key of a study that has the table of those that it defines, as a path.
pub const KEY: &str = "outputs.own";

/// The key of the outputs to keep, where a study defines some, too.
const KEEP: &str = "keep";

/// A model with the outputs that a study defines; the model itself where these have faults.
pub(super) fn defined_in(model: &'static Description, text: &str) -> &'static Description {
    with_own(model, text).unwrap_or(model)
}

/// Notes what is wrong in the outputs that a study defines over those of a model; returns whether nothing is.
pub(super) fn check_defined(top: &Table<'_, '_>, model: &'static Description, text: &str) -> bool {
    match with_own(model, text) {
        Ok(_) => true,
        Err(faults) => {
            faults.iter().for_each(|it| top.note(of_text(it)));
            false
        }
    }
}

/// The model of results with the outputs of the table that they have.
pub fn known(model: &'static Description, table: &str) -> &'static Description {
    of_table(model, table)
}

/// Makes sure that the table of own outputs that results have suits their model; `name` is what has it, for messages.
///
/// # Errors
/// All that is wrong in it.
pub fn check_known(name: &str, model: &'static Description, table: &str) -> Result<(), Faults> {
    let found = with_own(model, table).map_err(|faults| Faults {
        file: name.to_owned(),
        faults: faults.iter().map(of_text).collect(),
    });
    found.map(|_| ())
}

/// The outputs that a study keeps.
pub(super) fn read_outputs(
    top: &Table<'_, '_>,
    parameters: &Parameters,
    protocol: &Protocol,
) -> Vec<Output> {
    let Some(entry) = kept(top) else { return usual_outputs(parameters, protocol) };
    let model = top.model();
    let names: Vec<(&str, Output)> =
        model.outputs().map(|output| (output.name(), output)).collect();
    let mut outputs = Vec::new();
    for entry in entry.list() {
        match entry.one_of("output", &names) {
            Some(output) if outputs.contains(&output) => {
                entry.fault(format!("{} is given twice", entry.shown()))
            }
            Some(output)
                if output.kept() == Kept::WithExponents
                    && protocol.exponents == Exponents::Largest =>
            {
                entry.fault("is computed where [protocol] has exponents = \"all\"");
            }
            output => outputs.extend(output),
        }
    }
    outputs
}

/// The list of the outputs to keep, if there is one: `outputs = [...]`, or `keep` in the table `[outputs]`.
fn kept<'r, 'a>(top: &Table<'r, 'a>) -> Option<Entry<'r, 'a>> {
    let entry = top.entry(OUTPUTS)?;
    if !entry.is_table() {
        return Some(entry);
    }
    let table = entry.table()?;
    let kept = table.entry(KEEP);
    // It has been read with the model.
    let _ = table.entry(OWN);
    table.finish();
    kept
}

/// Notes own outputs that use a parameter of which there is no value.
pub(super) fn check_used(top: &Table<'_, '_>, parameters: &Parameters) {
    let Some(own) = top.entry(OUTPUTS).filter(Entry::is_table) else { return };
    let Some(own) = own.table().and_then(|it| it.table(OWN)) else { return };
    for (parameter, name) in top.model().used_by_own() {
        let symbol = parameter.symbol();
        let other = parameter.replaced_by().find(|it| parameters.is_given(*it));
        let why = match other {
            Some(other) => format!("{} stands for it", other.symbol()),
            None => "it is not given".to_owned(),
        };
        if let Some(entry) = own.entry(name).filter(|_| !parameters.states(parameter)) {
            entry.fault(format!("uses {symbol}, which has no value here: {why}"));
        }
    }
}

/// The outputs of a study as keys of its text: with the table of those that it defines, the list of `kept` within it.
pub(super) fn written(model: &'static Description, kept: Option<String>) -> Option<String> {
    let own = model.own?;
    let kept = kept.map_or_else(String::new, |it| format!("[{OUTPUTS}]\n{KEEP} = {it}\n\n"));
    Some(format!("\n{kept}{}", own.table.trim_start()))
}

/// A fault of a text as one of a study.
fn of_text(fault: &capsulemap_text::Fault) -> Fault {
    let message = format!("column {}: {}", fault.column, fault.message);
    Fault { line: Some(fault.line), key: KEY.to_owned(), message }
}
