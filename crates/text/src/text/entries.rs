//! The entries of a text by kind, each under its name.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::text::content::{MOST_OF_A_KIND, MOST_PULSES, MOST_STATES};
use crate::text::names::{Meaning, Names};
use crate::text::written::{Source, Written, hint, place_of};

/// A value with its place.
pub(crate) type Value<'a> = Spanned<DeValue<'a>>;

/// What stands under a name, with the name's place.
pub(crate) struct Entry<'t, 'a> {
    pub(crate) name: String,
    pub(crate) at: usize,
    pub(crate) value: &'t Value<'a>,
}

/// The entries of a text by kind.
pub(crate) struct Parsed<'t, 'a> {
    pub(crate) states: Vec<Entry<'t, 'a>>,
    pub(crate) parameters: Vec<Entry<'t, 'a>>,
    pub(crate) definitions: Vec<Entry<'t, 'a>>,
    pub(crate) switches: Vec<Entry<'t, 'a>>,
    pub(crate) frictions: Vec<Entry<'t, 'a>>,
    pub(crate) pulses: Vec<Entry<'t, 'a>>,
    pub(crate) outputs: Vec<Entry<'t, 'a>>,
}

impl<'t, 'a> Parsed<'t, 'a> {
    pub(crate) fn of(source: &Source<'a>, table: &'t DeTable<'a>) -> Self {
        let of = |key: &str| entries(source, table, key);
        let parsed = Parsed {
            states: of("states"),
            parameters: of("parameters"),
            definitions: of("definitions"),
            switches: of("switch"),
            frictions: of("friction"),
            pulses: of("pulse"),
            outputs: of("outputs"),
        };
        if parsed.states.is_empty() {
            source.fault(place_of(table), "[system] needs states, as states = { x = \"m\" }");
        }
        let kinds = [
            ("states", &parsed.states, MOST_STATES),
            ("switches", &parsed.switches, MOST_OF_A_KIND),
            ("frictions", &parsed.frictions, MOST_OF_A_KIND),
            ("pulses", &parsed.pulses, MOST_PULSES),
        ];
        for (what, entries, most) in kinds {
            if let Some(it) = entries.get(most) {
                source.fault(it.at, format!("more than {most} {what}"));
            }
        }
        parsed
    }

    /// The place of the state called `name`; where there is none, that is noted.
    pub(crate) fn state(&self, source: &Source<'a>, name: &str, at: usize) -> Option<usize> {
        let place = self.states.iter().position(|it| it.name == name);
        if place.is_none() {
            let states = self.states.iter().map(|it| it.name.as_str());
            let hint = hint(name, states.collect::<Vec<_>>());
            source.fault(at, format!("there is no state {name:?}{hint}"));
        }
        place
    }

    pub(crate) fn give_names(&self, source: &Source<'a>, names: &mut Names) {
        type Kind<'k, 't, 'a> = (&'k [Entry<'t, 'a>], fn(usize) -> Meaning);
        let kinds: [Kind<'_, '_, '_>; 7] = [
            (&self.states, Meaning::State),
            (&self.parameters, Meaning::Parameter),
            (&self.definitions, Meaning::Definition),
            (&self.switches, Meaning::Switch),
            (&self.frictions, Meaning::Friction),
            (&self.pulses, Meaning::Pulse),
            (&self.outputs, Meaning::Output),
        ];
        for (entries, meaning) in kinds {
            for (place, it) in entries.iter().enumerate() {
                names.give(source, &it.name, it.at, meaning(place));
            }
        }
        for it in &self.definitions {
            let nothing = Written { characters: "0".into(), at: it.at };
            let written = source.expression(it.value, &it.name).unwrap_or(nothing);
            names.definitions.push((it.name.clone(), written));
        }
    }
}

/// The entries of the table under a key, in the order of the text.
pub(crate) fn entries<'t, 'a>(
    source: &Source<'a>,
    table: &'t DeTable<'a>,
    key: &str,
) -> Vec<Entry<'t, 'a>> {
    let within = table.get(key).and_then(|it| source.table(it, key));
    let entries = within.into_iter().flatten().map(|(name, value)| Entry {
        name: name.get_ref().to_string(),
        at: name.span().start,
        value,
    });
    let mut entries: Vec<_> = entries.collect();
    entries.sort_by_key(|it| it.at);
    entries
}

/// The expression or the string under a key that has to be there.
pub(crate) fn needed<'a>(
    source: &Source<'a>,
    table: &DeTable<'a>,
    of: &Entry<'_, 'a>,
    key: &str,
) -> Option<Written> {
    match table.get(key) {
        Some(value) => source.expression(value, key),
        None => {
            source.fault(of.at, format!("{} needs `{key}`", of.name));
            None
        }
    }
}
