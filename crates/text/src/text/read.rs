//! From the characters of a text to an oscillator, or to all that is wrong with it.

use toml::de::DeTable;

use crate::text::content::{
    Event, Friction, MOST_ON_SECTION, Parameter, Pulse, Section, State, Switch, Text,
};
use crate::text::dependence::check_dependence;
use crate::text::entries::Parsed;
use crate::text::event_names::event_symbols;
use crate::text::fault::Fault;
use crate::text::fitting::misfits;
use crate::text::graph::{Graph, Id, Node};
use crate::text::linear::{Linear, TakenApart, linear};
use crate::text::names::Names;
use crate::text::parts;
use crate::text::values::Values;
use crate::text::written::{Source, hint, place_of};

/// Guards that a system has at most, its section included.
const MOST_GUARDS: usize = capsulemap_engine::flow::MAX_GUARDS;

/// Reads the table `system` of a text.
///
/// # Errors
/// All that is wrong in it, each with its line and column.
pub fn read(text: &str) -> Result<Text, Vec<Fault>> {
    let source = Source::new(text);
    let tables = source.tables();
    source.only(tables.get_ref(), "the text", &["system"]);
    system_in(source, tables.get_ref())
}

/// Reads the table `system` of a text that has other tables, too, as a study.
///
/// # Errors
/// All that is wrong in it, each with its line and column.
pub fn read_in(text: &str) -> Result<Text, Vec<Fault>> {
    let source = Source::new(text);
    let tables = source.tables();
    system_in(source, tables.get_ref())
}

fn system_in<'a>(source: Source<'a>, table: &DeTable<'a>) -> Result<Text, Vec<Fault>> {
    let found = match table.get("system") {
        Some(value) => source.table(value, "system").and_then(|it| of_table(&source, it)),
        None => {
            source.fault(0, "the text needs a table [system]");
            None
        }
    };
    match found {
        Some(text) if !source.has_faults() => Ok(text),
        _ => Err(source.into_faults()),
    }
}

fn of_table<'a>(source: &Source<'a>, table: &DeTable<'a>) -> Option<Text> {
    const KEYS: [&str; 12] = [
        "name",
        "states",
        "parameters",
        "definitions",
        "rates",
        "switch",
        "friction",
        "pulse",
        "events",
        "section",
        "drift",
        "outputs",
    ];
    source.only(table, "[system]", &KEYS);
    let name = table.get("name").and_then(|it| source.string(it, "name"));
    if table.get("name").is_none() {
        source.fault(place_of(table), "[system] needs a name");
    }
    let parsed = Parsed::of(source, table);
    let mut names = Names::new();
    parsed.give_names(source, &mut names);
    let mut values = Values::new(source, names, parsed.frictions.len());
    let found = Found::of(&mut values, &parsed, table);
    let outputs = parts::outputs(&mut values, &parsed);
    values.all_definitions();
    let measured = std::mem::take(&mut values.measured);
    let counts = std::mem::take(&mut values.counts);
    let graph = std::mem::take(&mut values.graph);
    let text = found?.text(source, &parsed, graph, name?.characters)?;
    let text = Text { measured, outputs: outputs?, ..text };
    let misfits = if source.has_faults() { Vec::new() } else { misfits(source, table, &text) };
    let text = Text { misfits, ..text };
    check_counts(source, &text, &counts);
    check_guards(source, &text, place_of(table));
    check_coordinates(source, &text, place_of(table));
    check_lasting(source, &text, place_of(table));
    check_dependence(source, &text, table);
    Some(text.with_moved())
}

/// What was found in the expressions of a text; none of what is wrong.
struct Found {
    states: Vec<State>,
    parameters: Vec<Parameter>,
    rates: Vec<Id>,
    switches: Vec<Switch>,
    frictions: Vec<(Id, Id, Id)>,
    pulses: Vec<Pulse>,
    events: Vec<Event>,
    section: Section,
    drift: Option<usize>,
}

impl Found {
    fn of<'a>(
        values: &mut Values<'a, '_>,
        parsed: &Parsed<'_, 'a>,
        table: &DeTable<'a>,
    ) -> Option<Found> {
        let of_frictions = parts::values_of_frictions(values, parsed);
        let switches: Vec<_> = parsed.switches.iter().map(|it| parts::switch(values, it)).collect();
        let pulses = parts::pulses(values, parsed);
        let rates = parts::rates(values, parsed, table);
        let frictions: Vec<_> = parsed
            .frictions
            .iter()
            .zip(of_frictions)
            .map(|(it, of)| Some((of, parts::friction(values, it)?)))
            .map(|it| it.and_then(|(of, (sliding, holds))| Some((of?, sliding, holds))))
            .collect();
        let events = parts::events(values, parsed, table, rates.as_deref());
        let section = parts::section(values, parsed, table);
        let drift = parts::drift(values.source, parsed, table);
        let source = values.source;
        let states = parsed.states.iter().map(|it| parts::state(source, it)).collect::<Option<_>>();
        let parameters =
            parsed.parameters.iter().map(|it| parts::parameter(source, it)).collect::<Vec<_>>();
        Some(Found {
            states: states?,
            parameters: parameters.into_iter().collect::<Option<_>>()?,
            rates: rates?,
            switches: switches.into_iter().collect::<Option<_>>()?,
            frictions: frictions.into_iter().collect::<Option<_>>()?,
            pulses: pulses?,
            events: events?,
            section: section?,
            drift: drift?,
        })
    }

    /// The oscillator, once its frictions at rest are solved for.
    fn text(
        self,
        source: &Source<'_>,
        parsed: &Parsed<'_, '_>,
        mut graph: Graph,
        name: String,
    ) -> Option<Text> {
        let mut frictions = Vec::new();
        for (place, (of, sliding, holds)) in self.frictions.iter().copied().enumerate() {
            let entry = &parsed.frictions[place];
            let solved = at_rest(&mut graph, &self.rates, of, (place, self.frictions.len()));
            match solved {
                Ok((linear, at_rest)) => frictions.push(Friction {
                    name: entry.name.clone(),
                    of,
                    linear,
                    sliding,
                    holds,
                    at_rest,
                }),
                Err(message) => source.fault(entry.at, format!("{}: {message}", entry.name)),
            }
            let touches = |id: Id| {
                let all = 0..self.frictions.len();
                all.map(Node::Friction).any(|it| graph.depends_on(id, it))
            };
            if touches(sliding) || touches(holds) || touches(of) {
                let message = "`of`, `sliding` and `holds` may not be of a friction";
                source.fault(entry.at, format!("{}: {message}", entry.name));
            }
        }
        let Found { states, parameters, rates, switches, pulses, events, section, drift, .. } =
            self;
        Some(Text {
            name,
            states,
            parameters,
            graph,
            rates,
            switches,
            frictions,
            pulses,
            events,
            section,
            drift,
            measured: Vec::new(),
            outputs: Vec::new(),
            misfits: Vec::new(),
        })
    }
}

/// What the friction at a place is of, by states, and what it is at rest: the rate of what it is of vanishes there.
fn at_rest(
    graph: &mut Graph,
    rates: &[Id],
    of: Id,
    (place, count): (usize, usize),
) -> Result<(Linear, Id), String> {
    let linear = linear(graph, of).filter(|it| !it.factors.is_empty());
    let Some(linear) = linear else {
        return Err("`of` must be a sum of states with constant factors".into());
    };
    let mut rate = graph.number(0.0);
    for (state, factor) in &linear.factors {
        let part = graph.mul(*factor, rates[*state]);
        rate = graph.add(rate, part);
    }
    let apart = TakenApart::default().of(graph, rate, place);
    let Some(apart) = apart else {
        return Err("the rates must be linear in the friction".into());
    };
    let Some(factor) = apart.factor else {
        return Err("the rates of what it is of must have the friction".into());
    };
    let others = (0..count).map(Node::Friction);
    if others.clone().any(|it| graph.depends_on(apart.without, it) || graph.depends_on(factor, it))
    {
        return Err("a friction may not act on what another one is of".into());
    }
    let force = graph.div(apart.without, factor);
    Ok((linear, graph.neg(force)))
}

/// Notes counts of what no event is called.
fn check_counts(source: &Source<'_>, text: &Text, counts: &[(String, usize)]) {
    let names = event_symbols(text);
    for (name, at) in counts.iter().filter(|it| !names.contains(&it.0)) {
        source.fault(*at, format!("no event is called {name:?}{}", hint(name, &names)));
    }
}

/// Notes frictions of what a contact that lasts holds: at rest, both would be solved for at once.
fn check_lasting(source: &Source<'_>, text: &Text, at: usize) {
    for event in &text.events {
        let (Some(lasting), Some(bound)) = (event.lasting, event.bound) else { continue };
        let held = [bound.state, lasting.velocity];
        let of_held = |it: &&Friction| it.linear.factors.iter().any(|it| held.contains(&it.0));
        if let Some(friction) = text.frictions.iter().find(of_held) {
            let (event, friction) = (&event.name, &friction.name);
            source.fault(
                at,
                format!("{event} cannot last: the friction {friction} is of what it holds"),
            );
        }
    }
}

/// Notes that a point of the section has too many coordinates.
fn check_coordinates(source: &Source<'_>, text: &Text, at: usize) {
    let count = text.on_section().count();
    if !(1..=MOST_ON_SECTION).contains(&count) {
        let message = format!(
            "a point of the section has {count} coordinates, the states but for one that drifts and one that is zero on it; it may have 1 to {MOST_ON_SECTION}"
        );
        source.fault(at, message);
    }
}

fn check_guards(source: &Source<'_>, text: &Text, at: usize) {
    let section = usize::from(matches!(text.section, Section::When { .. }));
    let guards = text.guards() + section;
    if guards > MOST_GUARDS {
        let message = format!(
            "the system has {guards} guards (one an event and a switch, two a friction, one the pulses, \
             one a section by a state), and may have {MOST_GUARDS}"
        );
        source.fault(at, message);
    }
}
