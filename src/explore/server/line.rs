//! A bifurcation diagram along a line over the map, computed as it is watched.

use serde_json::{Value, json};

use super::answer::Refusal;
use super::asked::Asked;
use super::computations::BUDGET;
use super::explored::Explored;
use crate::description::{Description, Output, State};
use crate::flow::stop;
use crate::motion::{Case, Orbit};
use crate::of::{model_of, settle_case};
use crate::orbit::{Machine, Outcome, Protocol};
use crate::store::catalogue::{OUTCOME, PERIOD, section};
use crate::study::axis::set;
use crate::study::{
    Axis, CaseSet, Coordinate, Direction, Drawing, DrawingKind, Grid, Inherit, Spacing, Study,
    Varying,
};

/// Values along the line.
const LEAST: usize = 2;
const MOST: usize = 2000;
const USUAL: usize = 300;
/// Cases that are settled together and then sent.
const TOGETHER: usize = 32;
/// The parameters of a request beside the ends of the line.
const KNOWN: [&str; 6] = ["count", "start", "log", "sweep", "kind", "format"];
/// The outputs that are sent of each case.
fn shown_outputs(model: &'static Description) -> Vec<Output> {
    match model.has_trade_off() {
        true => vec![model.speed(), model.power(), model.exponent()],
        false => vec![model.main_output(), model.exponent()],
    }
}
/// Why a line has no study.
pub const NO_STUDY: &str = "no study can hold this line";

/// The name of the path of a line along which several coordinates vary.
const PATH: &str = "line";

/// What computes a line that takes too long here.
pub const INSTEAD: &str =
    "the study of the line, which the page hands over, has no such limit: `capsulemap sweep`";

/// A line between two points of the plane of two coordinates.
pub struct Line {
    /// The case at its beginning, with the values of all coordinates but those that vary.
    first: Case,
    /// What varies, one at least, with as many values each.
    varied: Vec<Varying>,
    /// Whether each case starts where the one before it settled.
    inherits: bool,
    protocol: Protocol,
}

impl Line {
    /// The line from the coordinates of a request to those with `to_` before their names; evenly in the logarithms of those that
    /// `log` names.
    ///
    /// Fails if they are not the same coordinates, or a parameter is out of its bounds along the line.
    pub fn of(explored: &Explored, asked: &Asked) -> Result<Line, Refusal> {
        Line::with(explored, asked, &[])
    }

    /// The same of a request that has more names.
    pub fn with(explored: &Explored, asked: &Asked, more: &[&str]) -> Result<Line, Refusal> {
        let to = asked.coordinates_after("to_", explored.model())?;
        let names: Vec<String> = to.iter().map(|(it, _)| format!("to_{}", it.name())).collect();
        asked.only(
            explored.model(),
            &names
                .iter()
                .map(String::as_str)
                .chain(KNOWN)
                .chain(more.iter().copied())
                .collect::<Vec<_>>(),
        )?;
        let from = asked.coordinates(explored.model())?;
        let inherits = match asked.text("start") {
            None | Some("inherit") => true,
            Some("afresh") => false,
            Some(_) => return Err(Refusal::unfit("start: inherit or afresh is expected")),
        };
        let count = asked.count("count", [LEAST, MOST], USUAL)?;
        let varied = varied(asked, &from, &to, count)?;
        let mut first = explored.near(&from, asked.sweep()?)?.case;
        if !inherits {
            let as_asked = explored.study.case(0);
            (first.start, first.start_phase) = (as_asked.start, as_asked.start_phase);
        }
        let line = Line { first, varied, inherits, protocol: explored.protocol() };
        let cases = line.cases();
        match cases.iter().find_map(|case| case.parameters.faults().into_iter().next()) {
            Some(fault) => Err(Refusal::unfit(fault.to_string())),
            None => Ok(line),
        }
    }

    /// The study of the line, with its diagram: along an axis, or along a path where several coordinates vary.
    pub fn study(&self) -> Option<Study> {
        let path = self.single().is_none().then(|| PATH.to_owned());
        let axis = Axis { path, varying: self.varied.clone() };
        let inherit =
            self.inherits.then(|| Inherit { axis: 0, directions: vec![Direction::Upward] });
        let mut diagram = Drawing::new("bifurcation", DrawingKind::Bifurcation);
        diagram.x = Some(axis.name().to_owned());
        let names: Vec<&str> = axis.coordinates().map(Coordinate::name).collect();
        let study = Study {
            title: format!("Along {}", names.join(" and ")),
            base: self.first.parameters.clone(),
            start: self.first.start.clone().without_drift(),
            start_phase: self.first.start_phase,
            section_phase: self.first.section_phase,
            case_set: CaseSet::Grid(Grid { axes: vec![axis], inherit }),
            protocol: self.protocol,
            drawings: vec![diagram],
            ..Study::of(self.first.parameters.model())
        };
        study.validated("the study of the line").ok()
    }

    /// What varies along it, if that is one coordinate alone.
    pub fn single(&self) -> Option<&Varying> {
        if let [single] = &self.varied[..] { Some(single) } else { None }
    }

    /// The case at a place with the start of the request.
    pub fn case(&self, place: usize) -> Case {
        let mut case = self.first.clone();
        self.varied.iter().for_each(|it| set(&mut case, it.coordinate, it.values[place]));
        case
    }

    /// The cases with the starts of the request.
    fn cases(&self) -> Vec<Case> {
        (0..self.varied[0].values.len()).map(|place| self.case(place)).collect()
    }

    /// Sends the study or why there is none, and what each case settles to, as long as somebody listens, and why it ends before
    /// the last where it takes too long.
    pub fn compute(self, send: &dyn Fn(String) -> bool) {
        let study = self.study();
        let why = study.is_none().then_some(NO_STUDY);
        let head = json!({ "study": study.map(|it| it.text), "why": why });
        if send(head.to_string()) {
            match self.inherits {
                true => self.follow(send),
                false => self.settle(send),
            }
        }
        if stop::is_asked() {
            send(Refusal::late(BUDGET, INSTEAD).line());
        }
    }

    /// Settles the cases, each from the start of the study.
    fn settle(&self, send: &dyn Fn(String) -> bool) {
        let cases = self.cases();
        let shares = shares(cases.len());
        for (part, shares) in cases.chunks(TOGETHER).zip(shares.chunks(TOGETHER)) {
            let orbits =
                model_of(&part[0].parameters).settle_all(part, &self.protocol, Machine::default());
            if stop::is_asked() {
                return;
            }
            for ((share, case), orbit) in shares.iter().zip(part).zip(&orbits) {
                if !send(told(*share, case, orbit).to_string()) {
                    return;
                }
            }
        }
    }

    /// Settles the cases one after the other, each from where the one before it settled; after a failure from the start of the
    /// study, as a run does.
    fn follow(&self, send: &dyn Fn(String) -> bool) {
        let mut from: Option<State> = None;
        let cases = self.cases();
        for (share, mut case) in shares(cases.len()).into_iter().zip(cases) {
            if let Some(state) = from {
                case.start = state.drifted_as(&case.start);
                case.start_phase = case.section_phase;
            }
            let orbit = settle_case(&case, &self.protocol);
            if stop::is_asked() || !send(told(share, &case, &orbit).to_string()) {
                return;
            }
            from = (orbit.outcome != Outcome::Failed).then(|| orbit.end.clone());
        }
    }
}

/// The coordinates that differ between the two ends of a line, each with so many values.
///
/// Fails if one has no beginning, or none differs.
fn varied(
    asked: &Asked,
    from: &[(Coordinate, f64)],
    to: &[(Coordinate, f64)],
    count: usize,
) -> Result<Vec<Varying>, Refusal> {
    let mut varied = Vec::new();
    for &(coordinate, to) in to {
        let Some(&(_, from)) = from.iter().find(|it| it.0 == coordinate) else {
            let name = coordinate.name();
            return Err(Refusal::unfit(format!("{name}: a line needs both of its ends")));
        };
        if from != to {
            let values = spacing(asked, coordinate, [from, to])?.values(from, to, count);
            varied.push(Varying { coordinate, values });
        }
    }
    match varied.is_empty() {
        true => Err(Refusal::unfit("a line needs two ends that differ")),
        false => Ok(varied),
    }
}

/// How the values of a coordinate lie between its ends.
pub fn spacing(asked: &Asked, coordinate: Coordinate, ends: [f64; 2]) -> Result<Spacing, Refusal> {
    let mut logarithmic = asked.text("log").unwrap_or_default().split(',');
    match logarithmic.any(|name| name == coordinate.name()) {
        true if ends.iter().all(|end| *end > 0.0) => Ok(Spacing::Logarithmic),
        true => Err(Refusal::unfit(format!("log: {} is not above zero", coordinate.name()))),
        false => Ok(Spacing::Linear),
    }
}

/// The places of so many values, as shares of the line.
fn shares(count: usize) -> Vec<f64> {
    (0..count).map(|number| number as f64 / (count - 1) as f64).collect()
}

/// One value of the line: its share of the length, the section points, the state on the section from which the motion goes on, and
/// outputs in SI.
fn told(share: f64, case: &Case, orbit: &Orbit) -> Value {
    let points: Vec<f32> = orbit.section.iter().map(|it| it[0] as f32).collect();
    let period = (orbit.outcome == Outcome::Periodic).then_some(orbit.period);
    let end = (orbit.outcome != Outcome::Failed).then(|| orbit.end.section());
    let mut told = json!({
        "share": share,
        "end": end,
        "phase": case.section_phase,
        (OUTCOME.name): orbit.outcome.name(),
        (PERIOD.name): period,
    });
    let model = orbit.outputs.model();
    told[section(model)[0].name] = json!(points);
    for output in shown_outputs(model) {
        told[output.name()] = json!(orbit.outputs[output]);
    }
    told
}
