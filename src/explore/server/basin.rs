//! A small basin of attraction at the parameters of a case, computed from coarse to fine.

use serde_json::{Value, json};

use super::answer::Refusal;
use super::asked::Asked;
use super::computations::BUDGET;
use super::explored::Explored;
use super::motion::{followed, shown};
use crate::attractor::{Attractor, Label};
use crate::description::{Description, Parameter, Section, State};
use crate::figure::{label_colour, shown_quantity};
use crate::flow::stop;
use crate::motion::Case;
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
        let is_parameter = |it: &(Coordinate, f64)| !it.0.is_start();
        let at: Vec<(Coordinate, f64)> = given.iter().copied().filter(is_parameter).collect();
        let case = explored.near(&at, asked.sweep()?)?.case;
        let mut axes = axes(asked, starts, around(explored, &case))?;
        let told = [0, 1].map(|axis| axis_json(explored, &axes[axis]));
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
        let told = |name: &str, value: f64, unit: &str| json!({ "name": name, "value": value, "unit": unit });
        let start = &self.study.start;
        let mut held: Vec<Value> =
            others.map(|it| told(it.name(), start[it], it.start().dimension.unit())).collect();
        let phase = self.study.base.model().has_drive().then_some(self.study.start_phase);
        held.extend(phase.map(|phase| told("phase", phase, Dimension::Angle.unit())));
        held
    }

    /// What the coarse grid of a pass shows, and the attractors that are known by now.
    fn pass(&self, step: usize, records: &[Record]) -> Option<Value> {
        let motions = run::final_motions(&self.study, records);
        let found = run::attractors(&self.study, &motions, Machine::default(), || ()).ok()?;
        if stop::is_asked() {
            return None;
        }
        let label = |case: usize| match found.label(case, &motions) {
            Label::Attractor(number) => i64::from(number),
            _ => UNKNOWN,
        };
        let labels: Vec<i64> = coarse(step).map(label).collect();
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
        let is_in_plane = self.study.start_phase == self.study.section_phase;
        let model = self.study.base.model();
        let main = model.main_output();
        let in_plane = |point: &Section| {
            let state = State::at_section(model, point);
            model.start_coordinates().take(2).map(|it| state[it]).collect::<Vec<f64>>()
        };
        let told = |(number, attractor): (usize, &Attractor<Section>)| {
            let record = records.iter().find(|record| record.index == attractor.case)?;
            let orbit = &record.orbit;
            let is_periodic = orbit.outcome == Outcome::Periodic;
            let points = attractor.points.iter().filter(|_| is_periodic && is_in_plane);
            Some(json!({
                "label": number,
                (OUTCOME.name): orbit.outcome.name(),
                (PERIOD.name): is_periodic.then_some(orbit.period),
                (main.name()): orbit.outputs[main],
                "colour": label_colour(Some(number as u32)),
                "points": points.map(in_plane).collect::<Vec<_>>(),
            }))
        };
        found.of_starts.iter().enumerate().filter_map(told).collect()
    }
}

/// The axes that a request asks for, the faster first; `usual` are their ends where it does not.
fn axes(
    asked: &Asked,
    starts: [Coordinate; 2],
    usual: [[f64; 2]; 2],
) -> Result<Vec<Axis>, Refusal> {
    let axis = |axis: usize| {
        let [low, high] = ends(starts[axis]);
        let from = asked.number(&low)?.unwrap_or(usual[axis][0]);
        let to = asked.number(&high)?.unwrap_or(usual[axis][1]);
        match from < to {
            true => Ok(Axis {
                coordinate: starts[axis],
                values: Spacing::Linear.values(from, to, SIDE),
            }),
            false => Err(Refusal::unfit(format!("{low} must be less than {high}"))),
        }
    };
    (0..starts.len()).map(axis).collect()
}

/// An axis of starts, its ends in the unit shown.
fn axis_json(explored: &Explored, axis: &Axis) -> Value {
    let name = axis.coordinate.name();
    let it = shown_quantity(name, explored.archive.frame());
    let range = [axis.values[0], axis.values[SIDE - 1]].map(|value| value * it.factor);
    json!({ "name": name, "label": it.label, "factor": it.factor, "range": range })
}

/// The cases of the grid of every so many starts, row by row from the least y1.
fn coarse(step: usize) -> impl Iterator<Item = usize> {
    let along = move || (0..SIDE).step_by(step);
    along().flat_map(move |row| along().map(move |column| row * SIDE + column))
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
    let of_drive = |it: Option<Parameter>| it.map_or(1.0, |it| parameters[it]);
    let usual = of_drive(model.drive_amplitude()) / stiffness;
    let omega = of_drive(model.drive_frequency());
    let widest = |place: usize, usual: f64| {
        let column = stretch.as_ref().map(|it| &it.histories[place]);
        let values = column.into_iter().flatten();
        let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], it| {
            [low.min(*it), high.max(*it)]
        });
        let half = WIDER * 0.5 * (high - low);
        let middle = 0.5 * (high + low);
        let is_wide = half.is_finite() && half > 0.0;
        if is_wide { [middle - half, middle + half] } else { [-usual, usual] }.map(rounded)
    };
    let mut places = (0..model.coordinates.len()).filter(|place| Some(*place) != model.drift);
    [usual, usual * omega]
        .map(|usual| places.next().map_or([-usual, usual], |at| widest(at, usual)))
}

/// A number to three digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
