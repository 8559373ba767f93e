//! Outputs that a study defines over those of its model, `[outputs.own]`: from their text to a description that has them.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use capsulemap_models::description::{Description, Kept, OutputDescription, OwnOutputs, Roles};
use capsulemap_models::quantity::Quantity;
use capsulemap_models::quantity::shown::words;
use capsulemap_models::quantity::units::dimension_of;

use crate::text::described::{kept, list, of_unit};
use crate::text::entries::entries;
use crate::text::fault::Fault;
use crate::text::own_read::{Own, read_all};
use crate::text::own_value::OwnValues;
use crate::text::tables::table_alone;
use crate::text::written::Source;

/// The key of a study that has the table of them.
pub const OUTPUTS: &str = "outputs";
/// That table.
pub const OWN: &str = "own";

/// Models and the tables of outputs that are defined over theirs.
type Known = BTreeMap<(usize, String), &'static Description>;

/// The descriptions that there are.
static KNOWN: Mutex<Known> = Mutex::new(BTreeMap::new());

/// The model with the outputs that a text defines over its own; the model itself where it defines none. The same for texts that
/// say the same.
///
/// # Errors
/// All that is wrong in them, each with its line and column.
pub fn with_own(
    model: &'static Description,
    text: &str,
) -> Result<&'static Description, Vec<Fault>> {
    let source = Source::new(text);
    let tables = source.tables();
    let outputs = tables.get_ref().get(OUTPUTS).and_then(|it| it.get_ref().as_table());
    let Some(outputs) = outputs.filter(|it| it.contains_key(OWN)) else { return Ok(model) };
    let entries = entries(&source, outputs, OWN);
    if entries.is_empty() && !source.has_faults() {
        return Ok(model);
    }
    let read = read_all(&source, model, &entries);
    let (Some((own, values)), false) = (read, source.has_faults()) else {
        return Err(source.into_faults());
    };
    let table = table_alone(text, &format!("[{OUTPUTS}.{OWN}]"), outputs, OWN);
    let place = (std::ptr::from_ref(model).addr(), table.clone());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    Ok(known.entry(place).or_insert_with(|| described(model, own, values, table)))
}

/// The model with the outputs of a table; the model itself where something in it is wrong.
pub fn of_table(model: &'static Description, table: &str) -> &'static Description {
    let place = (std::ptr::from_ref(model).addr(), table.to_owned());
    let known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner).get(&place).copied();
    known.unwrap_or_else(|| with_own(model, table).unwrap_or(model))
}

/// The description of a model with own outputs behind its outputs.
fn described(
    model: &'static Description,
    own: Vec<Own>,
    values: OwnValues,
    table: String,
) -> &'static Description {
    let first = model.outputs.len();
    let places = first..first + own.len();
    let outputs = own.into_iter().map(output);
    let roles = Roles {
        key_outputs: list(model.roles.key_outputs.iter().copied().chain(places)),
        ..model.roles
    };
    Box::leak(Box::new(Description {
        extends: Some(model),
        outputs: list(model.outputs.iter().copied().chain(outputs)),
        roles,
        own: Some(OwnOutputs {
            definitions: Box::leak(Box::new(values)),
            table: Box::leak(table.into_boxed_str()),
        }),
        ..*model
    }))
}

fn output(own: Own) -> OutputDescription {
    let name = kept(own.name);
    let dimension = dimension_of(kept(own.unit));
    let quantity = Quantity {
        name,
        dimension,
        shown: words(kept(label(name, own.meaning.as_deref())), of_unit(dimension)),
        meaning: kept(own.meaning.unwrap_or(own.expression)),
    };
    OutputDescription { quantity, tag: name, is_smooth: own.is_smooth, kept: Kept::Always }
}

/// What an own output is called in figures: its meaning, or its name as words.
fn label(name: &str, meaning: Option<&str>) -> String {
    let words = meaning.map_or_else(|| name.replace('_', " "), str::to_owned);
    let mut letters = words.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    first + letters.as_str()
}
