//! The model that a study names, `model = "..."`, or that of the system that it has.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::document::Table;
use super::named_system::{self, check_system, system_in};
use super::own_outputs::{check_defined, defined_in};
use crate::description::Description;
use crate::of::{all_models, default_model, model_called};

/// The key by which a study names its model.
const MODEL: &str = "model";

/// The model that a study names, or has as a system, with the outputs that the study defines; that of studies which name none where
/// it names none that is known.
pub(super) fn model_in(document: &DeTable<'_>, text: &str) -> &'static Description {
    defined_in(without_own(document, text), text)
}

/// The same without the outputs that the study defines.
fn without_own(document: &DeTable<'_>, text: &str) -> &'static Description {
    if let Some(model) = system_in(document, text) {
        return model;
    }
    let named = match document.get(MODEL).map(Spanned::get_ref) {
        Some(DeValue::String(name)) => model_called(name),
        _ => None,
    };
    named.unwrap_or_else(default_model)
}

/// Whether a study names a model that is known, or none, and has no system and no own outputs with faults; a fault is noted where it
/// does not.
pub(super) fn check_model(top: &Table<'_, '_>, text: &str) -> bool {
    let is_sound = check_system(top, text);
    if let Some(entry) = top.entry(MODEL).filter(|_| top.entry(named_system::KEY).is_some()) {
        entry.fault("a study has a `system` of its own, or names a `model`, not both");
        return false;
    }
    is_sound
        && top.entry(MODEL).is_none_or(|entry| {
            let names: Vec<(&str, ())> = all_models().iter().map(|it| (it.name, ())).collect();
            entry.one_of("model", &names).is_some()
        })
        && check_defined(top, top.model().without_own(), text)
}
