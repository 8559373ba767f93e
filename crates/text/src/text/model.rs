//! The models of texts: one for each, which stays as long as the program runs.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use capsulemap_models::description::{Description, Equations};
use capsulemap_models::model::Model;
use capsulemap_models::of::{Of, make_known};

use crate::text::content::{MOST_ON_SECTION, Section, Text};
use crate::text::described::description;
use crate::text::fault::Fault;
use crate::text::program::Program;
use crate::text::read::read_in;
use crate::text::system::{Autonomous, Driven};
use crate::text::tables::system_alone;

/// Coordinates for which a point of the section of a small system has room.
pub const FEW: usize = 3;
/// Places of the states of those.
pub const PLACES_OF_FEW: usize = FEW + 2;
/// Coordinates for which a point of the section of others has room.
pub const MANY: usize = MOST_ON_SECTION;
/// Places of the states of those.
pub const PLACES: usize = MANY + 2;

/// The models that were made, by what differs between texts that differ.
static KNOWN: Mutex<BTreeMap<String, &'static Description>> = Mutex::new(BTreeMap::new());

/// The model of the table `system` in a text, which may have other tables: the same for texts that say the same.
///
/// # Errors
/// All that is wrong in it, each with its line and column.
pub fn model(text: &str) -> Result<&'static Description, Vec<Fault>> {
    let read = read_in(text)?;
    let tables = system_alone(text);
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(description) = known.get(&tables) {
        return Ok(description);
    }
    let (model, description) = of_text(read, tables.clone());
    if let Err(why) = make_known(model) {
        return Err(vec![Fault::at(text, 0, why.to_string())]);
    }
    known.insert(tables, description);
    Ok(description)
}

/// The model of the tables of a text, which is known where it was made before; none where something in them is wrong.
pub fn of_tables(tables: &str) -> Option<&'static Description> {
    let known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner).get(tables).copied();
    known.or_else(|| model(tables).ok())
}

/// The model of a text, with its description.
fn of_text(text: Text, tables: String) -> (&'static dyn Model, &'static Description) {
    let room = if text.on_section().count() <= FEW { FEW } else { MANY };
    let is_driven = matches!(text.section, Section::Every(_));
    let program: &'static Program = Box::leak(Box::new(Program::new(text, room)));
    let tables = Box::leak(tables.into_boxed_str());
    let equations = Equations { content: program, tables };
    let description = description(program, equations);
    program.description.set(description).expect("it is described once");
    let model: &'static dyn Model = match (is_driven, room) {
        (true, FEW) => {
            Box::leak(Box::new(Of::<Driven<FEW, PLACES_OF_FEW>, FEW>::described(description)))
        }
        (false, FEW) => {
            Box::leak(Box::new(Of::<Autonomous<FEW, PLACES_OF_FEW>, FEW>::described(description)))
        }
        (true, _) => Box::leak(Box::new(Of::<Driven<MANY, PLACES>, MANY>::described(description))),
        (false, _) => {
            Box::leak(Box::new(Of::<Autonomous<MANY, PLACES>, MANY>::described(description)))
        }
    };
    (model, description)
}
