//! A bifurcation diagram along a line over the map, computed as it is watched.

use serde_json::{Value, json};

use super::answer::Refusal;
use super::asked::Asked;
use super::explored::Explored;
use crate::capsule::{Case, Orbit, Output, State, settle_all, settle_case};
use crate::orbit::{Machine, Outcome, Protocol};
use crate::study::Coordinate;
use crate::study::axis::set;

/// Values along the line.
const LEAST: usize = 2;
const MOST: usize = 2000;
const USUAL: usize = 200;
/// Cases that are settled together and then sent.
const TOGETHER: usize = 32;

/// A line between two points of the plane of two coordinates.
pub struct Line {
    cases: Vec<(f64, Case)>,
    /// Whether each case starts where the one before it settled.
    inherits: bool,
    protocol: Protocol,
}

impl Line {
    /// The line from the coordinates of a request to those with `to_` before their names.
    ///
    /// Fails if they are not the same coordinates, or a parameter is out of its bounds along the line.
    pub fn of(explored: &Explored, asked: &Asked) -> Result<Line, Refusal> {
        let ends = |it: Coordinate| {
            Ok::<_, Refusal>(asked.number(&format!("to_{}", it.name()))?.map(|to| (it, to)))
        };
        let to: Vec<(Coordinate, f64)> =
            Coordinate::all().filter_map(|it| ends(it).transpose()).collect::<Result<_, _>>()?;
        let names: Vec<String> = to.iter().map(|(it, _)| format!("to_{}", it.name())).collect();
        let known = names.iter().map(String::as_str).chain(["count", "start"]);
        asked.only(&known.collect::<Vec<_>>())?;
        let from = asked.coordinates()?;
        let pairs: Option<Vec<_>> = to
            .iter()
            .map(|(it, to)| Some((*it, from.iter().find(|given| given.0 == *it)?.1, *to)))
            .collect();
        let Some(pairs) = pairs.filter(|it| !it.is_empty()) else {
            return Err(Refusal::unfit("a line needs both ends of each coordinate that varies"));
        };
        let inherits = match asked.text("start") {
            None | Some("inherit") => true,
            Some("afresh") => false,
            Some(_) => return Err(Refusal::unfit("start: inherit or afresh is expected")),
        };
        let count = asked.count("count", [LEAST, MOST], USUAL)?;
        let first = explored.near(&from)?.case;
        let fresh = explored.study.case(0);
        let case = |number: usize| {
            let share = number as f64 / (count - 1) as f64;
            let mut case = first.clone();
            if !inherits {
                (case.start, case.start_phase) = (fresh.start, fresh.start_phase);
            }
            for (coordinate, from, to) in &pairs {
                set(&mut case, *coordinate, from + share * (to - from));
            }
            match case.parameters.faults().first() {
                Some(fault) => Err(Refusal::unfit(fault.to_string())),
                None => Ok((share, case)),
            }
        };
        let cases = (0..count).map(case).collect::<Result<Vec<_>, _>>()?;
        Ok(Line { cases, inherits, protocol: explored.protocol() })
    }

    /// Settles the cases one after the other and sends what they settle to, as long as somebody listens.
    pub fn compute(self, _: &Explored, send: &dyn Fn(String) -> bool) {
        if self.inherits {
            return self.follow(send);
        }
        for part in self.cases.chunks(TOGETHER) {
            let cases: Vec<Case> = part.iter().map(|(_, case)| case.clone()).collect();
            let orbits = settle_all(&cases, &self.protocol, Machine::default());
            for ((share, _), orbit) in part.iter().zip(orbits) {
                if !send(told(*share, &orbit).to_string()) {
                    return;
                }
            }
        }
    }

    /// The same where each case starts where the one before it settled.
    fn follow(self, send: &dyn Fn(String) -> bool) {
        let mut from: Option<State<f64>> = None;
        for (share, mut case) in self.cases {
            if let Some(state) = from {
                case.start = State { x2: 0.0, ..state };
                case.start_phase = case.section_phase;
            }
            let orbit = settle_case(&case, &self.protocol);
            if !send(told(share, &orbit).to_string()) {
                return;
            }
            from = orbit.failure.is_none().then_some(orbit.end).or(from);
        }
    }
}

/// One value of the line: its share of the length, the section points, and outputs in SI.
fn told(share: f64, orbit: &Orbit) -> Value {
    let points: Vec<f32> = orbit.section.iter().map(|it| it[0] as f32).collect();
    json!({
        "share": share,
        "outcome": orbit.outcome.name(),
        "period": if orbit.outcome == Outcome::Periodic { json!(orbit.period) } else { Value::Null },
        "section_r": points,
        "progression_speed": orbit.outputs[Output::ProgressionSpeed],
        "power": orbit.outputs[Output::Power],
        "lyapunov_exponent": orbit.outputs[Output::LyapunovExponent],
    })
}
