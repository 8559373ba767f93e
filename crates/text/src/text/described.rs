//! What a text says of itself to the program: the description of its model.

use std::f64::consts::PI;

use capsulemap_engine::flow::Event as _;
use capsulemap_models::description::{
    Chart, CoordinateDescription, Description, DriveRoles, Equations, Kept, MotionDescription,
    OutputDescription, ParameterDescription, Parameters, Presence, Remark, Roles, Rules, Signal,
    SignalKind, SpectrumRoles,
};
use capsulemap_models::quantity::shown::shown;
use capsulemap_models::quantity::units::dimension_of;
use capsulemap_models::quantity::{Allowed, Bounds, Dimension, Quantity};

use crate::text::content::{Section, State, Text};
use crate::text::event_names::{event_name, event_symbol};
use crate::text::graph::{Id, Node};
use crate::text::interpreter::constants;
use crate::text::mode::TextEvent;
use crate::text::program::Program;
use crate::text::symbol::symbol;

/// The outputs of every text, in their order, from [`first_of_all`] on.
pub const LARGEST_PART: usize = 0;
/// The largest Lyapunov exponent.
pub const EXPONENT: usize = 1;
/// Its standard error.
pub const EXPONENT_ERROR: usize = 2;
/// The longest period that is excluded.
pub const EXCLUDED_PERIOD: usize = 3;
/// The largest defect of a step.
pub const DEFECT: usize = 4;
/// How far the section is from repeating.
pub const SECTION_RESIDUAL: usize = 5;
/// The largest multiplier.
pub const LARGEST_MULTIPLIER: usize = 6;
/// How long a cycle lasts.
pub const CYCLE_DURATION: usize = 7;
/// How many outputs every text has.
pub const OF_ALL: usize = 8;

/// Where the outputs that every text has begin among the outputs: behind the speed of what drifts, and the text's own.
pub fn first_of_all(text: &Text) -> usize {
    usize::from(text.drift.is_some()) + text.outputs.len()
}

/// Where the shares of rest begin, one for each friction.
fn first_rest(text: &Text) -> usize {
    first_of_all(text) + OF_ALL
}

/// Where the counts of events begin.
fn first_count(text: &Text) -> usize {
    first_rest(text) + text.frictions.len()
}

/// The counts of those events at which a surface is met that may be touched.
fn impact_counts(program: &Program) -> impl Iterator<Item = usize> {
    let counts = first_count(&program.text)..;
    counts.zip(&program.events).filter(|(_, event)| event.is_impact()).map(|(count, _)| count)
}

/// Where all exponents begin, each with its error, and the dimension with its error; before them is the error of the speed of what
/// drifts, where something does.
pub fn first_of_spectrum(program: &Program) -> usize {
    let text = &program.text;
    first_count(text) + program.events.len() + usize::from(text.drift.is_some())
}

fn spectrum_roles(program: &Program) -> SpectrumRoles {
    let first = first_of_spectrum(program);
    let exponents = program.text.on_section().count();
    let pair = |number: usize| [first + 2 * number, first + 2 * number + 1];
    SpectrumRoles { exponents: list((0..exponents).map(pair)), dimension: pair(exponents) }
}

/// Characters that are kept as long as the program runs, as those of its own models are.
pub(crate) fn kept(text: impl Into<String>) -> &'static str {
    Box::leak(text.into().into_boxed_str())
}

/// A list that is kept as long.
pub(crate) fn list<T>(items: impl IntoIterator<Item = T>) -> &'static [T] {
    Box::leak(items.into_iter().collect::<Vec<_>>().into_boxed_slice())
}

/// The program of the text that has the equations of a model.
///
/// # Panics
/// Where the program has them.
pub fn program_of(model: &'static Description) -> &'static Program {
    let equations = model.equations.map(|it| it.content);
    equations.and_then(|it| it.downcast_ref()).expect("the model of a text")
}

/// The description of the model of a program.
pub fn description(program: &'static Program, equations: Equations) -> &'static Description {
    let text = &program.text;
    let on_section: Vec<usize> = text.on_section().collect();
    let of_section = |prefix: &str, meaning: &str| {
        list(on_section.iter().map(|it| of_state(&text.states[*it], prefix, meaning)))
    };
    let neutral = on_section.iter().map(|it| {
        let meaning = "in the direction of the family of a neutral orbit";
        let quantity = of_state(&text.states[*it], "neutral", meaning);
        Quantity { dimension: Dimension::Number, shown: None, ..quantity }
    });
    let is_driven = matches!(text.section, Section::Every(_));
    Box::leak(Box::new(Description {
        name: kept(text.name.clone()),
        extends: None,
        parameters: list(text.parameters.iter().map(|it| of_parameter(text, it))),
        choices: &[],
        coordinates: list(text.states.iter().map(of_coordinate)),
        drift: text.drift,
        on_section: list(on_section.iter().copied()),
        section: of_section("section", "at the section"),
        compared_as: list(on_section.iter().map(|it| kept(compared(program, *it)))),
        neutral: list(neutral),
        edge: of_section("edge_section", "of the saddle at the section"),
        end: of_section("end", "at the end of the case"),
        motion: of_motion(text),
        outputs: list(outputs(program)),
        roles: Roles {
            drive: is_driven.then(|| DriveRoles {
                frequency: frequency(text),
                period: None,
                amplitude: None,
                cycle: Some(period),
            }),
            impact_surface: impact_surface(text),
            rear_surface: None,
            natural: None,
            trade_off: None,
            rest_share: (!text.frictions.is_empty()).then(|| first_rest(text)),
            key_outputs: list(key_outputs(text)),
            event_counts: list(first_count(text)..first_count(text) + program.events.len()),
            impact_counts: list(impact_counts(program)),
            exponent: first_of_all(text) + EXPONENT,
            exponent_error: first_of_all(text) + EXPONENT_ERROR,
            spectrum: Some(spectrum_roles(program)),
            gain_error: text.drift.map(|_| first_of_spectrum(program) - 1),
            excluded_period: first_of_all(text) + EXCLUDED_PERIOD,
            defect: first_of_all(text) + DEFECT,
            section_residual: first_of_all(text) + SECTION_RESIDUAL,
        },
        rules: Rules { remarks: remarks_on_units, ..Rules::NONE },
        equations: Some(equations),
        own: None,
    }))
}

/// That the units of a text do not fit each other, with the first place.
fn remarks_on_units(parameters: &Parameters) -> Vec<Remark> {
    let misfits = &program_of(parameters.model()).text.misfits;
    let told = misfits.first().map(|first| Remark {
        about: Vec::new(),
        text: match misfits.len() {
            1 => format!("units in the text of the oscillator: {first}"),
            count => format!(
                "units in the text of the oscillator, at {count} places, which `capsulemap check` tells: {first}"
            ),
        },
    });
    told.into_iter().collect()
}

/// The quantity of a state somewhere.
fn of_state(state: &State, prefix: &str, meaning: &str) -> Quantity {
    let dimension = dimension_of(kept(state.unit.clone()));
    let label = match prefix {
        "start" => "Initial",
        "section" => "Stroboscopic",
        _ => "",
    };
    Quantity {
        name: kept(format!("{prefix}_{}", state.name)),
        dimension,
        meaning: kept(format!("{} {meaning}", state.meaning.as_ref().unwrap_or(&state.name))),
        shown: shown(label, kept(symbol(&state.name)), of_unit(dimension), 1.0),
    }
}

/// The unit of a dimension as figures show it.
pub(crate) fn of_unit(dimension: Dimension) -> &'static str {
    match dimension.unit() {
        "1" => "",
        unit => kept(raised(unit)),
    }
}

/// A unit whose powers are raised.
fn raised(unit: &str) -> String {
    let mut markup = String::new();
    let mut before = ' ';
    for character in unit.chars() {
        match character.is_ascii_digit() && before.is_alphabetic() {
            true => markup.push_str(&format!("^{{{character}}}")),
            false => markup.push(character),
        }
        before = character;
    }
    markup
}

fn of_coordinate(state: &State) -> CoordinateDescription {
    CoordinateDescription {
        name: kept(state.name.clone()),
        tag: kept(format!("start {}", state.name)),
        start: of_state(state, "start", "at the start"),
    }
}

fn of_parameter(text: &Text, it: &crate::text::content::Parameter) -> ParameterDescription {
    let dimension = dimension_of(kept(it.unit.clone().unwrap_or_else(|| "1".into())));
    let meaning = it.meaning.clone().unwrap_or_else(|| format!("parameter {}", it.name));
    let place = text.parameters.iter().position(|other| other.name == it.name);
    let is_time = place.is_some_and(|place| place_of_cycle(text) == Some(place));
    ParameterDescription {
        quantity: Quantity {
            name: kept(it.name.clone()),
            dimension,
            meaning: kept(meaning),
            shown: shown("", kept(symbol(&it.name)), of_unit(dimension), 1.0),
        },
        tag: kept(it.name.clone()),
        allowed: allowed(it.bounds, is_time),
        default: it.default,
        is_asked_for: false,
        presence: Presence::Always,
        replaces: None,
    }
}

/// What a parameter with these bounds may be; above zero where it tells how long a cycle lasts.
fn allowed(bounds: Bounds, is_time: bool) -> Allowed {
    match bounds {
        Bounds::NONE if is_time => Allowed::Positive,
        Bounds::NONE => Allowed::Finite,
        _ if is_time && bounds.least <= 0.0 && bounds.above < 0.0 => {
            Allowed::Within(Bounds { least: Bounds::NONE.least, above: 0.0, ..bounds })
        }
        _ => Allowed::Within(bounds),
    }
}

/// The parameter that alone tells how long a cycle lasts, as its period or its frequency.
fn place_of_cycle(text: &Text) -> Option<usize> {
    let Section::Every(period) = text.section else { return None };
    frequency(text).or_else(|| parameter(text, period))
}

/// The parameter that a value is.
fn parameter(text: &Text, id: Id) -> Option<usize> {
    match text.graph.node(id) {
        Node::Parameter(place) => Some(place),
        _ => None,
    }
}

/// The parameter that is the angular frequency of the drive, where the section is each 2 pi by it.
fn frequency(text: &Text) -> Option<usize> {
    let Section::Every(period) = text.section else { return None };
    let Node::Div(turn, by) = text.graph.node(period) else { return None };
    let is_turn = text.graph.number_of(turn) == Some(2.0 * PI);
    parameter(text, by).filter(|_| is_turn)
}

/// How long a cycle lasts, by the values of the parameters; of an autonomous system how long it is waited for.
pub fn period(parameters: &Parameters) -> f64 {
    let program = program_of(parameters.model());
    let values: Vec<f64> = parameters.each().map(|it| it.1).collect();
    constants(program, &values)[program.period]
}

/// The parameter that is where the first state is at an impact.
fn impact_surface(text: &Text) -> Option<usize> {
    let switches = text.switches.iter().map(|it| it.bound);
    let bounds = text.events.iter().map(|it| it.bound).chain(switches).flatten();
    let mut at_first = bounds.filter(|it| it.state == 0);
    at_first.find_map(|it| parameter(text, it.value))
}

/// As what a state is compared with others.
fn compared(program: &Program, state: usize) -> String {
    let name = &program.text.states[state].name;
    match program.counts_as_velocity(state) {
        true => format!("2 pi/T {name}"),
        false => name.clone(),
    }
}

fn of_motion(text: &Text) -> MotionDescription {
    let histories: &'static [Quantity] =
        list(text.states.iter().map(|it| of_state(it, "history", "along the motion")));
    let kind = |place: usize| match text.drift == Some(place) {
        true => SignalKind::Drifting,
        false => SignalKind::Coordinate,
    };
    let signals = (0..histories.len()).map(|it| Signal::kept(histories[it], kind(it), it));
    let charts = histories
        .iter()
        .zip(&text.states)
        .map(|(it, state)| Chart { title: kept(state.name.clone()), signals: list([it.name]) });
    let mut others = (0..histories.len()).filter(|it| text.drift != Some(*it));
    let portrait = others.next().zip(others.find(|it| is_rate(text, 0, *it)).or(Some(1)));
    let portrait = portrait.filter(|(_, other)| *other < histories.len());
    MotionDescription {
        histories,
        signals: list(signals),
        panels: list(histories.iter().map(|it| it.name)),
        charts: list(charts),
        portrait: portrait.map(|(one, other)| [histories[one].name, histories[other].name]),
        events: list(TextEvent::all().map(|it| kept(event_name(text, it)))),
        ..MotionDescription::NONE
    }
}

/// Whether the rate of a state is another state.
fn is_rate(text: &Text, of: usize, other: usize) -> bool {
    text.graph.node(text.rates[of]) == Node::State(other)
}

fn key_outputs(text: &Text) -> Vec<usize> {
    (0..first_of_all(text)).chain([first_of_all(text) + LARGEST_PART]).collect()
}

fn outputs(program: &Program) -> Vec<OutputDescription> {
    let text = &program.text;
    // A text whose states have units counts time in seconds.
    let has_units = text.states.iter().any(|it| it.unit != "1");
    let [time, rate] = if has_units { ["s", "1/s"] } else { ["1"; 2] };
    let mut outputs = Vec::new();
    if let Some(drift) = text.drift {
        let State { name, unit, .. } = &text.states[drift];
        let unit = if unit == "1" { unit.clone() } else { format!("{unit}/s") };
        outputs.push(output(format!("speed_of_{name}"), format!("mean rate of {name}"), &unit));
    }
    for it in &text.outputs {
        let meaning = it.meaning.clone().unwrap_or_else(|| it.name.clone());
        outputs.push(output(it.name.clone(), meaning, it.unit.as_deref().unwrap_or("1")));
    }
    outputs.extend([
        number("largest_part", "largest part of a section point, as parts are compared"),
        output("lyapunov_exponent", "largest Lyapunov exponent", rate),
        output("lyapunov_uncertainty", "standard error of that exponent", rate),
        number("excluded_period", "longest period excluded, in cycles"),
        number("integration_defect", "largest defect of a step"),
        number("section_residual", "how far the section is from repeating"),
        number("largest_multiplier", "largest magnitude of a multiplier"),
        output("cycle_duration", "mean duration of a cycle", time),
    ]);
    for it in &text.frictions {
        let meaning = format!("share of time at which {} holds", it.name);
        outputs.push(number(format!("rest_share_of_{}", it.name), meaning));
    }
    for it in &program.events {
        let name = event_symbol(text, *it);
        let meaning = format!("how often {} happens in a cycle", event_name(text, *it));
        outputs.push(number(format!("{name}_per_cycle"), meaning));
    }
    outputs.extend(text.drift.map(|_| OutputDescription {
        kept: Kept::WithMeanError,
        ..with_error(outputs[0], "mean over batches of cycles of a motion that does not repeat")
    }));
    outputs.extend(spectrum(text.on_section().count(), rate));
    outputs
}

/// The standard error of another output.
fn with_error(of: OutputDescription, what: &str) -> OutputDescription {
    let Quantity { name, dimension, .. } = of.quantity;
    let meaning = format!("standard error of {name}, {what}");
    output(format!("{name}_error"), meaning, dimension.unit())
}

/// All exponents, as many as these, and the dimension, each with its standard error.
fn spectrum(count: usize, rate: &str) -> Vec<OutputDescription> {
    let exponent = |number: usize| {
        let meaning = format!("exponent {number} of all Lyapunov exponents, the largest first");
        output(format!("lyapunov_{number}"), meaning, rate)
    };
    let meaning = "dimension of the attractor on the section by all Lyapunov exponents";
    let dimension = number("kaplan_yorke_dimension", meaning);
    let all = (1..=count).map(exponent).chain([dimension]);
    let with_errors = all.flat_map(|it| [it, with_error(it, "over batches of cycles")]);
    with_errors.map(|it| OutputDescription { kept: Kept::WithExponents, ..it }).collect()
}

fn number(name: impl Into<String>, meaning: impl Into<String>) -> OutputDescription {
    output(name, meaning, "1")
}

fn output(name: impl Into<String>, meaning: impl Into<String>, unit: &str) -> OutputDescription {
    let name = kept(name);
    let quantity =
        Quantity { name, dimension: dimension_of(kept(unit)), meaning: kept(meaning), shown: None };
    OutputDescription { quantity, tag: name, is_smooth: false, kept: Kept::Always }
}
