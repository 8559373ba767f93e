//! What the equations of a text may depend on: not on what drifts, and on time only so that they repeat with the section.

use toml::de::DeTable;

use crate::text::content::{Event, MOST_OF_A_KIND, Section, Text};
use crate::text::function::Function;
use crate::text::graph::{Graph, Id, Level, Node};
use crate::text::written::{Source, place_of};

/// A multiple of a turn to this is one [turns].
const WHOLE: f64 = 1e-9;
/// Values of a parameter, by its place and its default, at which it is asked whether the equations repeat; what holds by chance for the
/// defaults does not hold for the others.
const TRIALS: [fn(usize, f64) -> f64; 3] = [
    |_, value| value,
    |place, value| value * (1.0 + 0.1 / (1.37 + place as f64)) + 0.013 / (1.7 + place as f64),
    |place, value| value * (1.0 + 0.3 / (2.11 + place as f64)) - 0.0071 / (1.3 + place as f64),
];

/// Notes where something depends on what is said to drift, or on time in another way than the section allows.
pub fn check_dependence(source: &Source<'_>, text: &Text, table: &DeTable<'_>) {
    let place = |key: &str| table.get(key).map_or_else(|| place_of(table), |it| it.span().start);
    let depends = |node: Node| {
        text.roots_and_measured().into_iter().any(|it| text.graph.depends_on(it, node))
    };
    if let Some(drift) = text.drift.filter(|it| depends(Node::State(*it))) {
        let name = &text.states[drift].name;
        source.fault(place("drift"), format!("{name} cannot drift: the equations depend on it"));
    }
    for message in jumping_conditions(text) {
        source.fault(place_of(table), message);
    }
    let moves_drift = |it: &Event| it.reset.iter().any(|it| Some(it.0) == text.drift);
    if let Some(event) = text.events.iter().find(|it| moves_drift(it)) {
        source
            .fault(place("drift"), format!("what drifts cannot be reset, as {} does", event.name));
    }
    let period = match text.section {
        Section::Every(period) => period,
        Section::When { within, .. } => within,
    };
    let value = text.value_at_defaults(period);
    if !(value > 0.0 && value.is_finite()) {
        let message =
            "`every` and `within` must be positive where the parameters have their defaults";
        source.fault(place("section"), message);
    }
    for pulse in &text.pulses {
        let duty = text.value_at_defaults(pulse.duty);
        if !(duty > 0.0 && duty < 1.0) {
            let message = format!("the duty of {} must be above 0 and below 1", pulse.name);
            source.fault(place("pulse"), message);
        }
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
    let mut waiting = text.roots_and_measured();
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
                if !TRIALS.iter().all(|trial| repeats(text, &graph, [rate, every], *trial)) {
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
fn repeats(text: &Text, graph: &Graph, of: [Id; 2], trial: fn(usize, f64) -> f64) -> bool {
    let values = graph.constants(&|place| trial(place, text.parameters[place].default), &[]);
    let [rate, every] = of.map(|it| values[it.index()]);
    let turns = rate * every / (2.0 * std::f64::consts::PI);
    // Where a trial makes no number it tells nothing.
    !turns.is_finite() || (turns - turns.round()).abs() <= WHOLE * turns.abs().max(1.0)
}

/// Why conditions cannot be told by a surface, each reason in a sentence: they may not depend on what jumps.
fn jumping_conditions(text: &Text) -> Vec<String> {
    let jumps = |id: Id| {
        let all = 0..MOST_OF_A_KIND;
        let kinds = [Node::Switch, Node::Pulse, Node::Friction, Node::Sign];
        all.flat_map(|place| kinds.map(|it| it(place))).any(|it| text.graph.depends_on(id, it))
    };
    let switches = text.switches.iter().map(|it| (&it.name, it.side));
    let conditions = switches.chain(text.events.iter().map(|it| (&it.name, it.lasts)));
    conditions
        .filter(|it| jumps(it.1))
        .map(|(name, _)| {
            format!("the condition of {name} may not depend on switches, pulses and frictions, which jump")
        })
        .collect()
}
