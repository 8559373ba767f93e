//! What follows from a text, in words: its section, modes, guards, events and outputs, and what a step costs.

use capsulemap_models::description::Description;

use crate::text::content::{Section, Text};
use crate::text::described::program_of;
use crate::text::event_names::event_name;
use crate::text::fault::Fault;
use crate::text::program::Program;

/// Instructions of a term of the paper's capsule as a text, beside which others are told.
const OF_CAPSULE: usize = 11;

/// What follows from the text of a model: what each line is about, and it.
///
/// # Panics
/// Where the model is of no text.
pub fn derived(model: &'static Description) -> Vec<(&'static str, String)> {
    let program = program_of(model);
    let text = &program.text;
    let outputs: Vec<&str> = model.outputs.iter().map(|it| it.quantity.name).collect();
    let events: Vec<String> = program.events.iter().map(|it| event_name(text, *it)).collect();
    let mut all = vec![
        ("states", with_units(text.states.iter().map(|it| (&it.name, Some(&it.unit))))),
        ("defaults", parameters(text)),
        ("section", section(text)),
        ("modes", modes(text)),
        ("guards", guards(text)),
        ("events", if events.is_empty() { "none".into() } else { events.join(", ") }),
        ("can give", outputs.join(", ")),
        ("cost", cost(program)),
    ];
    if text.misfits.is_empty() {
        let states = text.states.iter().map(|it| it.unit.as_str());
        let parameters = text.parameters.iter().filter_map(|it| it.unit.as_deref());
        let are_given = states.chain(parameters).any(|it| it != "1");
        let told =
            if are_given { "fit each other, as far as they are given" } else { "none are given" };
        all.push(("units", told.into()));
    }
    all.extend(text.misfits.iter().map(|it| ("units", it.to_string())));
    all
}

/// Where the units in the text of a model do not fit each other.
///
/// # Panics
/// Where the model is of no text.
pub fn misfits(model: &'static Description) -> &'static [Fault] {
    &program_of(model).text.misfits
}

/// Names with their units, where they have some.
fn with_units<'t>(all: impl Iterator<Item = (&'t String, Option<&'t String>)>) -> String {
    let shown = all.map(|(name, unit)| match unit.map(String::as_str) {
        None | Some("1") => name.clone(),
        Some(unit) => format!("{name} [{unit}]"),
    });
    shown.collect::<Vec<_>>().join(", ")
}

fn parameters(text: &Text) -> String {
    let shown = text.parameters.iter().map(|it| match it.unit.as_deref() {
        None | Some("1") => format!("{} = {}", it.name, it.default),
        Some(unit) => format!("{} = {} {unit}", it.name, it.default),
    });
    shown.collect::<Vec<_>>().join(", ")
}

fn section(text: &Text) -> String {
    let names: Vec<&str> = text.on_section().map(|it| text.states[it].name.as_str()).collect();
    let points = format!("points have ({})", names.join(", "));
    let drifts = text.drift.map_or_else(String::new, |it| {
        format!("; {} drifts: nothing depends on it", text.states[it].name)
    });
    match text.section {
        Section::Every(period) => {
            let period = text.value_at_defaults(period);
            format!("each period of the drive, {period:.6} with the defaults; {points}{drifts}")
        }
        Section::When { state, falls, within } => {
            let (name, within) = (&text.states[state].name, text.value_at_defaults(within));
            let verb = if falls { "falls" } else { "rises" };
            format!("where {name} {verb} through zero, waited for {within}; {points}{drifts}")
        }
    }
}

fn modes(text: &Text) -> String {
    let lasting: Vec<&String> =
        text.events.iter().filter(|it| it.lasting.is_some()).map(|it| &it.name).collect();
    let count = 2_usize.pow((text.switches.len() + text.pulses.len() + lasting.len()) as u32)
        * 3_usize.pow(text.frictions.len() as u32);
    let of = |names: Vec<&String>, what: &str| {
        let names: Vec<&str> = names.into_iter().map(String::as_str).collect();
        (!names.is_empty()).then(|| format!("{what} {}", names.join(", ")))
    };
    let parts = [
        of(text.switches.iter().map(|it| &it.name).collect(), "switches"),
        of(
            text.frictions.iter().map(|it| &it.name).collect(),
            "frictions, which rest or slide either way:",
        ),
        of(text.pulses.iter().map(|it| &it.name).collect(), "pulses"),
        of(lasting, "contacts that last after"),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    match parts.is_empty() {
        true => "1, the equations are always the same".into(),
        false => format!("up to {count}, by {}", parts.join("; ")),
    }
}

fn guards(text: &Text) -> String {
    let section = usize::from(matches!(text.section, Section::When { .. }));
    let count = text.guards() + section;
    format!("{count} of {}: what ends a step exactly there", capsulemap_engine::flow::MAX_GUARDS)
}

fn cost(program: &Program) -> String {
    let count = program.series.len();
    let folds = program.series.iter().filter(|it| it.step.folds()).count();
    format!(
        "{count} instructions for each term of the series, {folds} of them over all earlier terms; the paper's capsule \
         as a text takes {OF_CAPSULE}"
    )
}
