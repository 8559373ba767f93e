//! The parts of a text one by one: frictions, switches, pulses, rates, events, the section, states and parameters.

use toml::de::DeTable;

use capsulemap_models::quantity::Bounds;

use crate::text::content::{
    Bound, Event, Lasting, MOST_OF_A_KIND, Moved, Parameter, Pulse, Section, State, Switch,
    TextOutput,
};
use crate::text::entries::{Entry, Parsed, Value, entries, needed};
use crate::text::graph::{Graph, Id, Level, Node};
use crate::text::linear::linear;
use crate::text::values::Values;
use crate::text::written::{Source, hint, place_of};

pub(crate) fn values_of_frictions<'a>(
    values: &mut Values<'a, '_>,
    parsed: &Parsed<'_, 'a>,
) -> Vec<Option<Id>> {
    for (place, it) in parsed.frictions.iter().enumerate() {
        let Some(table) = values.source.table(it.value, &it.name) else { continue };
        let written = needed(values.source, table, it, "of");
        values.of_frictions[place] = written.and_then(|it| values.value(&it));
    }
    values.of_frictions.clone()
}

/// The size of a friction that slides, and what it can be at rest.
pub(crate) fn friction<'a>(values: &mut Values<'a, '_>, it: &Entry<'_, 'a>) -> Option<(Id, Id)> {
    let source = values.source;
    let table = it.value.get_ref().as_table()?;
    source.only(table, &format!("[system.friction.{}]", it.name), &["of", "sliding", "holds"]);
    let sliding = needed(source, table, it, "sliding").and_then(|it| values.value(&it));
    let holds = match table.get("holds") {
        Some(value) => {
            let written = source.expression(value, "holds");
            written.and_then(|it| values.value(&it))
        }
        None => sliding,
    };
    Some((sliding?, holds?))
}

pub(crate) fn switch<'a>(values: &mut Values<'a, '_>, it: &Entry<'_, 'a>) -> Option<Switch> {
    let source = values.source;
    let table = source.table(it.value, &it.name)?;
    source.only(table, &format!("[system.switch.{}]", it.name), &["where", "enters"]);
    let enters = table.get("enters").and_then(|it| source.string(it, "enters"));
    let written = match table.get("where") {
        Some(value) => source.string(value, "where"),
        None => needed(source, table, it, "where"),
    };
    let side = values.excess(&written?)?;
    let bound = bound(&mut values.graph, side);
    let enters = enters.map(|it| it.characters);
    Some(Switch { name: it.name.clone(), side, bound, enters })
}

/// The only state on which a surface depends, with its value there; none where there are more, or it depends on others, too.
fn bound(graph: &mut Graph, surface: Id) -> Option<Bound> {
    let it = linear(graph, surface)?;
    let [(state, factor)] = it.factors[..] else { return None };
    let value = graph.div(it.constant, factor);
    Some(Bound { state, value: graph.neg(value) })
}

pub(crate) fn pulses<'a>(
    values: &mut Values<'a, '_>,
    parsed: &Parsed<'_, 'a>,
) -> Option<Vec<Pulse>> {
    let source = values.source;
    let mut pulses = Vec::new();
    for it in &parsed.pulses {
        let Some(table) = source.table(it.value, &it.name) else { continue };
        source.only(table, &format!("[system.pulse.{}]", it.name), &["period", "duty"]);
        let mut constant = |key: &str| {
            let written = needed(source, table, it, key);
            written.and_then(|it| values.constant(&it, key))
        };
        let (period, duty) = (constant("period"), constant("duty"));
        let pulse = period.zip(duty);
        pulses.push(pulse.map(|(period, duty)| Pulse { name: it.name.clone(), duty, period }));
    }
    pulses.into_iter().collect()
}

/// The rate of each state, in the order of the states.
pub(crate) fn rates<'a>(
    values: &mut Values<'a, '_>,
    parsed: &Parsed<'_, 'a>,
    table: &DeTable<'a>,
) -> Option<Vec<Id>> {
    let source = values.source;
    let entries = entries(source, table, "rates");
    for it in &entries {
        parsed.state(source, &it.name, it.at);
    }
    let mut rates = Vec::new();
    for state in &parsed.states {
        let Some(entry) = entries.iter().find(|it| it.name == state.name) else {
            source.fault(state.at, format!("the state {} needs a rate", state.name));
            rates.push(None);
            continue;
        };
        let written = source.expression(entry.value, &entry.name);
        rates.push(written.and_then(|it| values.value(&it)));
    }
    rates.into_iter().collect()
}

pub(crate) fn events<'a>(
    values: &mut Values<'a, '_>,
    parsed: &Parsed<'_, 'a>,
    table: &DeTable<'a>,
    rates: Option<&[Id]>,
) -> Option<Vec<Event>> {
    let source = values.source;
    let Some(value) = table.get("events") else { return Some(Vec::new()) };
    let Some(array) = value.get_ref().as_array() else {
        source.fault(value.span().start, "events are a list: write [[system.events]]");
        return None;
    };
    let mut events = Vec::new();
    for (place, it) in array.iter().enumerate() {
        if place == MOST_OF_A_KIND {
            source.fault(it.span().start, format!("more than {MOST_OF_A_KIND} events"));
            return None;
        }
        events.push(event(values, parsed, it, rates));
    }
    events.into_iter().collect()
}

fn event<'a>(
    values: &mut Values<'a, '_>,
    parsed: &Parsed<'_, 'a>,
    value: &Value<'a>,
    rates: Option<&[Id]>,
) -> Option<Event> {
    let source = values.source;
    let table = source.table(value, "an event")?;
    source.only(table, "[[system.events]]", &["name", "while", "reset", "lasting"]);
    let entry = Entry { name: "an event".into(), at: value.span().start, value };
    let name = needed(source, table, &entry, "name");
    let condition = needed(source, table, &entry, "while");
    let lasts = condition.and_then(|it| values.excess(&it));
    let mut reset = Some(Vec::new());
    for it in entries(source, table, "reset") {
        let state = parsed.state(source, &it.name, it.at);
        let written = source.expression(it.value, &it.name);
        let value = written.and_then(|it| values.value(&it));
        match (state, value, &mut reset) {
            (Some(state), Some(value), Some(known)) => known.push((state, value)),
            _ => reset = None,
        }
    }
    let lasts = lasts?;
    let bound = bound(&mut values.graph, lasts);
    let (stays_on_surface, moved) = (true, Moved::default());
    let (name, reset) = (name?.characters, reset?);
    let lasting = match table.get("lasting") {
        None => None,
        Some(it) if it.get_ref().as_bool() == Some(false) => None,
        Some(it) if it.get_ref().as_bool() == Some(true) => {
            let found = lasting(&mut values.graph, (lasts, bound), rates?, &reset);
            if let Err(message) = found {
                source.fault(it.span().start, format!("{name} cannot last: {message}"));
            }
            Some(found.ok()?)
        }
        Some(it) => {
            source.fault(it.span().start, "lasting must be true or false");
            return None;
        }
    };
    Some(Event { name, lasts, bound, reset, stays_on_surface, lasting, moved })
}

/// What is held in a contact that lasts at the bound of an event, or why it cannot be.
fn lasting(
    graph: &mut Graph,
    (lasts, bound): (Id, Option<Bound>),
    rates: &[Id],
    reset: &[(usize, Id)],
) -> Result<Lasting, &'static str> {
    let bound = bound.ok_or("its condition must be of one state and constants")?;
    let Node::State(velocity) = graph.node(rates[bound.state]) else {
        return Err("the rate of the state in its condition must be a state");
    };
    let factor = linear(graph, lasts).and_then(|it| graph.number_of(it.factors[0].1));
    let factor = factor.ok_or("its condition must be that a state is above or below something")?;
    let stays = reset.iter().all(|(state, value)| *state != bound.state || *value == bound.value);
    if !stays {
        return Err("it must leave the state in its condition on the bound");
    }
    if reset.iter().all(|(state, _)| *state != velocity) {
        return Err("its reset must say what becomes of the rate of the state in its condition");
    }
    Ok(Lasting { velocity, is_above: factor > 0.0 })
}

pub(crate) fn section<'a>(
    values: &mut Values<'a, '_>,
    parsed: &Parsed<'_, 'a>,
    table: &DeTable<'a>,
) -> Option<Section> {
    const FORMS: &str = "{ every = \"2*pi/w\" } or { when = \"v falls\", within = 100.0 }";
    let source = values.source;
    let Some(value) = table.get("section") else {
        source.fault(place_of(table), format!("[system] needs a section, {FORMS}"));
        return None;
    };
    let section = source.table(value, "section")?;
    source.only(section, "section", &["every", "when", "within"]);
    let at = value.span().start;
    match [section.get("every"), section.get("when"), section.get("within")] {
        [Some(every), None, None] => {
            let written = source.expression(every, "every")?;
            Some(Section::Every(values.constant(&written, "every")?))
        }
        [None, Some(when), Some(within)] => {
            let when = source.string(when, "when")?;
            let within = source.expression(within, "within")?;
            let within = values.constant(&within, "within")?;
            if !parsed.pulses.is_empty() {
                source.fault(at, "a system with pulses has a section { every = \"...\" }");
            }
            let mut words = when.characters.split_whitespace();
            let state = words.next().unwrap_or_default();
            let place = parsed.states.iter().position(|it| it.name == state);
            let falls = match words.next() {
                Some("falls") => Some(true),
                Some("rises") => Some(false),
                _ => None,
            };
            let (Some(state), Some(falls), None) = (place, falls, words.next()) else {
                let states: Vec<&str> = parsed.states.iter().map(|it| it.name.as_str()).collect();
                let message = format!(
                    "a section is where a state falls or rises through zero, as \"v falls\"{}",
                    hint(state, states)
                );
                source.fault(when.at, message);
                return None;
            };
            Some(Section::When { state, falls, within })
        }
        _ => {
            source.fault(at, format!("a section is {FORMS}"));
            None
        }
    }
}

/// The state that drifts; none within where none does, none where it is no state.
#[allow(clippy::option_option)]
pub(crate) fn drift<'a>(
    source: &Source<'a>,
    parsed: &Parsed<'_, 'a>,
    table: &DeTable<'a>,
) -> Option<Option<usize>> {
    let Some(value) = table.get("drift") else { return Some(None) };
    let name = source.string(value, "drift")?;
    parsed.state(source, &name.characters, name.at).map(Some)
}

pub(crate) fn outputs<'a>(
    values: &mut Values<'a, '_>,
    parsed: &Parsed<'_, 'a>,
) -> Option<Vec<TextOutput>> {
    values.is_output = true;
    let mut outputs = Vec::new();
    for it in &parsed.outputs {
        let output = output(values, it);
        values.outputs.push(output.as_ref().map(|it| it.value));
        outputs.push(output);
    }
    values.is_output = false;
    outputs.into_iter().collect()
}

fn output<'a>(values: &mut Values<'a, '_>, it: &Entry<'_, 'a>) -> Option<TextOutput> {
    let source = values.source;
    let (written, [unit, meaning]) = match it.value.get_ref().as_table() {
        None => (source.expression(it.value, &it.name), [None, None]),
        Some(table) => {
            let place = format!("[system.outputs.{}]", it.name);
            source.only(table, &place, &["value", "unit", "meaning"]);
            (needed(source, table, it, "value"), unit_and_meaning(source, table))
        }
    };
    let written = written?;
    let value = values.value(&written)?;
    if values.graph.level(value) != Level::Case {
        let message = format!(
            "{} changes along the motion: say what of it, as integral(...), mean(...), max(...) or min(...)",
            it.name
        );
        source.fault(written.at, message);
        return None;
    }
    Some(TextOutput { name: it.name.clone(), unit, meaning, value })
}

/// The unit and the meaning that a table gives.
fn unit_and_meaning<'a>(source: &Source<'a>, table: &DeTable<'a>) -> [Option<String>; 2] {
    ["unit", "meaning"].map(|key| {
        let string = table.get(key).and_then(|it| source.string(it, key));
        string.map(|it| it.characters)
    })
}

pub(crate) fn state<'a>(source: &Source<'a>, it: &Entry<'_, 'a>) -> Option<State> {
    let name = it.name.clone();
    let Some(table) = it.value.get_ref().as_table() else {
        let unit = source.string(it.value, "the unit of a state")?.characters;
        return Some(State { name, unit, meaning: None });
    };
    source.only(table, &format!("the state {name}"), &["unit", "meaning"]);
    let [unit, meaning] = unit_and_meaning(source, table);
    Some(State { name, unit: unit.unwrap_or_else(|| "1".into()), meaning })
}

pub(crate) fn parameter<'a>(source: &Source<'a>, it: &Entry<'_, 'a>) -> Option<Parameter> {
    let name = it.name.clone();
    let bounds = Bounds::NONE;
    let Some(table) = it.value.get_ref().as_table() else {
        let default = source.number(it.value, &name)?;
        return Some(Parameter { name, default, bounds, unit: None, meaning: None });
    };
    let place = format!("[system.parameters.{name}]");
    let keys = ["default", "unit", "meaning", "least", "above", "most", "below"];
    source.only(table, &place, &keys);
    let default = match table.get("default") {
        Some(value) => source.number(value, "default"),
        None => {
            source.fault(it.at, format!("{name} needs a default"));
            None
        }
    };
    let [unit, meaning] = unit_and_meaning(source, table);
    let (default, bounds) = (default?, bounds_of(source, table, &name));
    if !bounds.admit(default) {
        source.fault(it.at, format!("the default of {name}, {default}, must be {bounds}"));
    }
    Some(Parameter { name, default, bounds, unit, meaning })
}

/// The bounds that a table gives a parameter, no two of one side.
fn bounds_of<'a>(source: &Source<'a>, table: &DeTable<'a>, name: &str) -> Bounds {
    let given = |key: &str| table.get(key).and_then(|it| source.number(it, key));
    for [one, other] in [["least", "above"], ["most", "below"]] {
        if let (Some(_), Some(value)) = (table.get(one), table.get(other)) {
            let message = format!("{name} has `{one}` and `{other}`: leave one of them out");
            source.fault(value.span().start, message);
        }
    }
    let none = Bounds::NONE;
    Bounds {
        least: given("least").unwrap_or(none.least),
        above: given("above").unwrap_or(none.above),
        most: given("most").unwrap_or(none.most),
        below: given("below").unwrap_or(none.below),
    }
}
