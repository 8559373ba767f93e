//! What the equations of a text may depend on: not on what drifts, and on time only so that they repeat with the section.

use toml::de::DeTable;

use crate::text::content::{Section, Text};
use crate::text::graph::{Function, Id, Level, Node};
use crate::text::written::{Source, place_of};

/// A multiple of a turn to this is one [turns].
const WHOLE: f64 = 1e-9;
/// What the parameters are multiplied by where it is asked whether the equations repeat: what holds for these holds for all.
const TRIALS: [fn(usize) -> f64; 2] = [|_| 1.0, |place| 1.0 + 0.1 / (1.37 + place as f64)];

/// Notes where something depends on what is said to drift, or on time in another way than the section allows.
pub fn check_dependence(source: &Source<'_>, text: &Text, table: &DeTable<'_>) {
    let place = |key: &str| table.get(key).map_or_else(|| place_of(table), |it| it.span().start);
    let depends = |node: Node| text.roots().into_iter().any(|it| text.graph.depends_on(it, node));
    if let Some(drift) = text.drift.filter(|it| depends(Node::State(*it))) {
        let name = &text.states[drift].name;
        source.fault(place("drift"), format!("{name} cannot drift: the equations depend on it"));
    }
    match text.section {
        Section::When { state, .. } => {
            if depends(Node::Time) {
                let message =
                    "the equations depend on time: the section must be { every = \"...\" }";
                source.fault(place("section"), message);
            }
            if text.drift == Some(state) {
                let message = "the section cannot be where what drifts is zero";
                source.fault(place("section"), message);
            }
        }
        Section::Every(every) => {
            if let Some(pulse) = text.pulses.iter().find(|it| it.period != every) {
                let message =
                    format!("the period of the pulse {} must be that of the section", pulse.name);
                source.fault(place("pulse"), message);
            }
            for message in unlike_each_period(text, every) {
                source.fault(place("rates"), message);
            }
        }
    }
}

/// Why the equations are not the same in each period of the section, each reason in a sentence; nothing where they are.
fn unlike_each_period(text: &Text, every: Id) -> Vec<String> {
    let mut graph = text.graph.clone();
    let mut reasons = Vec::new();
    let mut seen = vec![false; graph.len()];
    let mut waiting = text.roots();
    while let Some(id) = waiting.pop() {
        if std::mem::replace(&mut seen[id.index()], true) {
            continue;
        }
        if graph.node(id) == Node::Time {
            let message = "t may stand in sin and cos alone, as in cos(w*t)";
            reasons.push(message.to_owned());
        }
        let Node::Of(Function::Sin | Function::Cos, of) = graph.node(id) else {
            waiting.extend(graph.parts(id));
            continue;
        };
        if !graph.depends_on(of, Node::Time) {
            waiting.push(of);
            continue;
        }
        match graph.line(of).filter(|it| graph.level(it[1]) == Level::Case) {
            Some([_, rate]) => {
                let line = Text { graph: graph.clone(), ..text.clone() };
                if !TRIALS.iter().all(|trial| repeats(&line, rate, every, *trial)) {
                    let message = "a sine or cosine of t does not repeat after `every` of the section, \
                                   whatever the parameters are";
                    reasons.push(message.to_owned());
                }
            }
            None => reasons
                .push("sin and cos of t must be of a constant times t, and a constant".into()),
        }
    }
    reasons.sort();
    reasons.dedup();
    reasons
}

/// Whether an angle of this rate changes by whole turns in a period, at some values of the parameters.
fn repeats(text: &Text, rate: Id, every: Id, trial: fn(usize) -> f64) -> bool {
    let value = |place: usize| trial(place) * text.parameters[place].default;
    let [rate, every] = [rate, every].map(|it| text.constant(it, &value));
    let turns = rate * every / (2.0 * std::f64::consts::PI);
    (turns - turns.round()).abs() <= WHOLE * turns.abs().max(1.0)
}
