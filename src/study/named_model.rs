//! The model that a study names: `model = "..."`.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::document::Table;
use crate::description::Description;
use crate::of::{all_models, default_model, model_called};

/// The key by which a study names its model.
const MODEL: &str = "model";

/// The model that a study names; that of studies which name none where it names none that is known.
pub(super) fn model_in(document: &DeTable<'_>) -> &'static Description {
    let named = match document.get(MODEL).map(Spanned::get_ref) {
        Some(DeValue::String(name)) => model_called(name),
        _ => None,
    };
    named.unwrap_or_else(default_model)
}

/// Whether a study names a model that is known, or none; a fault is noted where it does not.
pub(super) fn check_model(top: &Table<'_, '_>) -> bool {
    top.entry(MODEL).is_none_or(|entry| {
        let names: Vec<(&str, ())> = all_models().iter().map(|it| (it.name, ())).collect();
        entry.one_of("model", &names).is_some()
    })
}
