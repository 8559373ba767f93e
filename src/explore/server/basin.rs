//! A small basin of attraction at the parameters of a case, computed from coarse to fine.

use serde_json::{Value, json};

use super::answer::Refusal;
use super::asked::Asked;
use super::computations::BUDGET;
use super::explored::Explored;
use super::followed::followed;
use super::motion::shown;
use super::units::Units;
use crate::attractor::{Attractor, Label};
use crate::description::{Description, Section, State};
use crate::figure::label_colour;
use crate::flow::stop;
use crate::motion::{Case, Orbit};
use crate::of::settle_case;
use crate::orbit::{Machine, Outcome};
use crate::quantity::Dimension;
use crate::run::{self, Attractors, Record, run_sample};
use crate::store::catalogue::{OUTCOME, PERIOD};
use crate::study::axis::set;
use crate::study::{Axis, CaseSet, Coordinate, Drawing, DrawingKind, Grid, Spacing, Study};

/// Starts along each side of the finest grid: one more than a multiple of the coarsest step.
const SIDE: usize = 97;
/// Each pass computes every so many starts along each side.
const STEPS: [usize; 5] = [16, 8, 4, 2, 1];
/// Starts that are computed together before the page is told.
const TOGETHER: usize = 1024;
/// How much wider than the motion the grid is.
const WIDER: f64 = 2.0;
/// The axes, the faster first.
fn coordinates(model: &'static Description) -> [Coordinate; 2] {
    let mut all = Coordinate::starts(model);
    [(); 2].map(|()| all.next().expect("a section of two coordinates at least"))
}
/// What the ends of an axis are called in a request.
fn ends(coordinate: Coordinate) -> [String; 2] {
    ["from", "to"].map(|end| format!("{}_{end}", coordinate.name()))
}

/// What computes a basin that takes too long here.
pub const INSTEAD: &str =
    "the study of the basin, which the page hands over, has no such limit: `capsulemap sweep`";
/// What the page is told of a start whose attractor is not known.
const UNKNOWN: i64 = -1;

/// A grid of starts over r and y1 at the parameters of a case.
pub struct Basin {
    study: Study,
    /// What the page is told of the axes, the faster first.
    axes: [Value; 2],
}

impl Basin {
    /// The grid that a request asks for; without ends, about the motion that the case settles to.
    ///
    /// Fails if a coordinate is out of its bounds or the ends of an axis are one.
    pub fn of(explored: &Explored, asked: &Asked) -> Result<Basin, Refusal> {
        let starts = coordinates(explored.model());
        let ends = starts.map(ends);
        let known = ends.iter().flatten().map(String::as_str).chain(["sweep", "kind", "format"]);
        asked.only(explored.model(), &known.collect::<Vec<_>>())?;
        let given = asked.coordinates(explored.model())?;
        let at = given.iter().copied().filter(|it| !it.0.is_start());
        let at: Vec<(Coordinate, f64)> = at.collect();
        let case = explored.near(&at, asked.sweep()?)?.case;
        let mut axes = axes(asked, starts, around(explored, &case))?;
        let units = Units::of(asked)?;
        let told = [0, 1].map(|axis| axis_json(explored, &units, &axes[axis]));
        // Those of a study come with the slower first.
        axes.reverse();
        let mut begins = explored.study.case(0);
        given.iter().filter(|it| it.0.is_start()).for_each(|it| set(&mut begins, it.0, it.1));
        let mut basin = Drawing::new("basin", DrawingKind::Basin);
        [basin.x, basin.y] = starts.map(|it| Some(it.name().to_owned()));
        let study = Study {
            title: "Starts and where they lead".to_owned(),
            base: case.parameters,
            start: begins.start.clone().without_drift(),
            start_phase: begins.start_phase,
            section_phase: case.section_phase,
            case_set: CaseSet::Grid(Grid { axes, inherit: None }),
            protocol: explored.protocol(),
            drawings: vec![basin],
            ..Study::of(explored.model())
        };
        match study.validated("the study of the basin") {
            Ok(study) => Ok(Basin { study, axes: told }),
            Err(faults) => Err(Refusal::unfit(faults.to_string())),
        }
    }

    /// The study of the grid, with its figure.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Sends the grid, and after each pass what is known of the starts, as long as somebody listens, and why it ends before the
    /// last where it takes too long.
    pub fn compute(self, send: &dyn Fn(String) -> bool) {
        self.refine(send);
        if stop::is_asked() {
            send(Refusal::late(BUDGET, INSTEAD).line());
        }
    }

    fn refine(&self, send: &dyn Fn(String) -> bool) {
        if !send(self.head().to_string()) {
            return;
        }
        let mut records: Vec<Record> = Vec::new();
        let mut done = vec![false; self.study.cases()];
        for step in STEPS {
            let wanted: Vec<usize> = coarse(step).filter(|case| !done[*case]).collect();
            for part in wanted.chunks(TOGETHER) {
                let Some(more) = self.computed(part) else { return };
                records.extend(more);
                part.iter().for_each(|case| done[*case] = true);
                let told = json!({ "computed": records.len(), "cases": self.study.cases() });
                if !send(told.to_string()) {
                    return;
                }
            }
            match self.pass(step, &records) {
                Some(pass) if send(pass.to_string()) => {}
                _ => return,
            }
        }
    }

    /// The records of some starts; none if the threads cannot be started or are to end.
    fn computed(&self, cases: &[usize]) -> Option<Vec<Record>> {
        // A few starts do not repay a sample of starts that tells their orbits before.
        let early_decision = cases.len() == TOGETHER;
        let study = Study { early_decision, ..self.study.clone() };
        let records = run_sample(&study, Machine::default(), cases, || ()).ok();
        records.filter(|_| !stop::is_asked())
    }

    fn head(&self) -> Value {
        let [x, y] = &self.axes;
        let surface = self.study.base.model().impact_surface();
        json!({
            "study": self.study.text,
            "x": x,
            "y": y,
            "side": SIDE,
            "held": self.held(),
            "surface": surface.map(|it| self.study.base[it]),
        })
    }

    /// What the starts share beside the coordinates of the plane: the others of the section, and the phase.
    fn held(&self) -> Vec<Value> {
        let others = self.study.base.model().start_coordinates().skip(self.axes.len());
        let start = &self.study.start;
        let mut held: Vec<Value> =
            others.map(|it| held_json(it.name(), start[it], it.start().dimension.unit())).collect();
        let phase = self.study.base.model().has_drive().then_some(self.study.start_phase);
        held.extend(phase.map(|phase| held_json("phase", phase, Dimension::Angle.unit())));
        held
    }

    /// What the coarse grid of a pass shows, and the attractors that are known by now.
    fn pass(&self, step: usize, records: &[Record]) -> Option<Value> {
        let motions = run::final_motions(&self.study, records);
        let found = run::attractors(&self.study, &motions, Machine::default(), || ()).ok()?;
        if stop::is_asked() {
            return None;
        }
        let labels = coarse(step).map(|case| match found.label(case, &motions) {
            Label::Attractor(number) => i64::from(number),
            _ => UNKNOWN,
        });
        let labels: Vec<i64> = labels.collect();
        Some(json!({
            "step": step,
            "computed": records.len(),
            "cases": self.study.cases(),
            "labels": labels,
            "attractors": self.attractors(&found, records),
            "unknown": label_colour(None),
        }))
    }

    /// The attractors with what the first of their cases settled to, and their section points where those lie in the plane of the
    /// starts.
    fn attractors(&self, found: &Attractors, records: &[Record]) -> Vec<Value> {
        let attractors = found.of_starts.iter().enumerate().filter_map(|(number, attractor)| {
            let record = records.iter().find(|record| record.index == attractor.case)?;
            Some(self.attractor_json(number, attractor, &record.orbit))
        });
        attractors.collect()
    }

    /// An attractor by its number, with the orbit that the first of its cases settled to.
    fn attractor_json(&self, number: usize, it: &Attractor<Section>, orbit: &Orbit) -> Value {
        let model = self.study.base.model();
        let main = model.main_output();
        let is_in_plane = self.study.start_phase == self.study.section_phase;
        let is_periodic = orbit.outcome == Outcome::Periodic;
        let points = it.points.iter().filter(|_| is_periodic && is_in_plane);
        json!({
            "label": number,
            (OUTCOME.name): orbit.outcome.name(),
            (PERIOD.name): is_periodic.then_some(orbit.period),
            (main.name()): orbit.outputs[main],
            "colour": label_colour(Some(number as u32)),
            "points": points.map(|point| in_plane(model, point)).collect::<Vec<_>>(),
        })
    }
}

/// A section point in the plane of the starts.
fn in_plane(model: &'static Description, point: &Section) -> Vec<f64> {
    let state = State::at_section(model, point);
    model.start_coordinates().take(2).map(|it| state[it]).collect()
}

/// A value that all starts share.
fn held_json(name: &str, value: f64, unit: &str) -> Value {
    json!({ "name": name, "value": value, "unit": unit })
}

/// The axes that a request asks for, the faster first; `usual` are their ends where it does not.
fn axes(
    asked: &Asked,
    starts: [Coordinate; 2],
    usual: [[f64; 2]; 2],
) -> Result<Vec<Axis>, Refusal> {
    starts.into_iter().zip(usual).map(|(start, usual)| axis(asked, start, usual)).collect()
}

/// The axis of a coordinate that a request asks for; `usual` are its ends where it does not.
fn axis(asked: &Asked, coordinate: Coordinate, usual: [f64; 2]) -> Result<Axis, Refusal> {
    let [low, high] = ends(coordinate);
    let from = asked.number(&low)?.unwrap_or(usual[0]);
    let to = asked.number(&high)?.unwrap_or(usual[1]);
    match from < to {
        true => Ok(Axis::of(coordinate, Spacing::Linear.values(from, to, SIDE))),
        false => Err(Refusal::unfit(format!("{low} must be less than {high}"))),
    }
}

/// An axis of starts, its ends in the unit shown.
fn axis_json(explored: &Explored, units: &Units, axis: &Axis) -> Value {
    let name = axis.name();
    let it = units.shown(name, explored);
    let values = &axis.varying[0].values;
    let range = [values[0], values[SIDE - 1]].map(|value| value * it.factor);
    json!({ "name": name, "label": it.label, "factor": it.factor, "range": range })
}

/// The cases of the grid of every so many starts, row by row from the least y1.
fn coarse(step: usize) -> impl Iterator<Item = usize> {
    (0..SIDE)
        .step_by(step)
        .flat_map(move |row| (0..SIDE).step_by(step).map(move |column| row * SIDE + column))
}

/// Ends of the axes about the motion that a case settles to, to three digits; about the gap where there is none.
fn around(explored: &Explored, case: &Case) -> [[f64; 2]; 2] {
    let protocol = explored.protocol();
    let orbit = settle_case(case, &protocol);
    let from = orbit.end.clone().without_drift();
    let stretch = followed(case, from, shown(&orbit), protocol.tolerance);
    let parameters = &case.parameters;
    let model = parameters.model();
    let stiffness = model.natural().map_or(1.0, |[stiffness, _]| parameters[stiffness]);
    let [amplitude, omega] = [model.drive_amplitude(), model.drive_frequency()]
        .map(|it| it.map_or(1.0, |it| parameters[it]));
    let usual = amplitude / stiffness;
    let mut places = (0..model.coordinates.len()).filter(|place| Some(*place) != model.drift);
    [usual, usual * omega].map(|usual| {
        let Some(place) = places.next() else { return [-usual, usual] };
        let history = stretch.as_ref().map_or(&[][..], |it| &it.histories[place]);
        wider(history).unwrap_or([-usual, usual]).map(rounded)
    })
}

/// Ends about some values, which leave room beside them; none of values that do not differ.
fn wider(values: &[f64]) -> Option<[f64; 2]> {
    let [low, high] = values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], it| [low.min(*it), high.max(*it)]);
    let half = WIDER * 0.5 * (high - low);
    let middle = 0.5 * (high + low);
    (half.is_finite() && half > 0.0).then_some([middle - half, middle + half])
}

/// A number to three digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
