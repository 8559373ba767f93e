//! The motion of one case, computed as it is asked for.

use std::collections::BTreeMap;

use axum::response::Response;
use serde::Serialize;
use serde_json::Value;

use super::answer::{Refusal, json as json_answer};
use super::asked::Asked;
use super::computations::{BUDGET, MOTION_BUDGET};
use super::explored::{Explored, Kept, Near};
use super::followed::{MOST_POINTS, followed};
use crate::campaign::command;
use crate::description::{Section, State};
use crate::explore::case_json::{case_json, remarks};
use crate::flow::stop;
use crate::motion::{Case, Orbit, Simulation, SimulationSize};
use crate::of::{model_of, settle_case};
use crate::orbit::{HistorySpan, Outcome, Protocol};
use crate::store::catalogue::CYCLES;
use crate::study::Study;

/// Cycles of the transient, as `capsulemap simulate` computes without another number.
const TRANSIENT: u64 = 20;
/// Cycles that the histories show at most, and of a motion that does not repeat.
const MOST_SHOWN: u64 = 8;
/// Events of the simulation at most: an answer of more than some megabytes is no click.
const MOST_EVENTS: usize = 10_000;
/// What computes the histories of a motion that takes too long here.
pub const INSTEAD: &str = "the command of the motion, which the page hands over, has no such limit";
/// Samples of a cycle in figures.
const PER_CYCLE: u32 = 400;

/// What is told of a motion.
#[derive(Serialize)]
struct Told {
    /// What `capsulemap simulate --json` prints of its case.
    simulate: Value,
    /// What the numbers do not say by themselves.
    remarks: Vec<String>,
    /// Its stroboscopic section.
    stroboscopic: Vec<Section>,
    /// The same points in the coordinates of the phase portrait.
    portrait: Vec<[f64; 2]>,
    history: Option<History>,
    /// The command that computes it.
    command: String,
    /// The number of the nearest case of the file, and whether it is that case.
    nearest: usize,
    exact: bool,
    /// Where it starts, in words.
    start: String,
}

/// What is told of a motion before it is judged.
#[derive(Serialize)]
struct Early<'a> {
    history: &'a History,
}

/// Columns over time in SI; a screen shows fewer digits than theirs.
#[derive(Serialize)]
struct History {
    cycles: u64,
    /// The period of the drive [s], if there is one.
    period: Option<f64>,
    /// Where the first coordinate meets the surface of impacts.
    surface: Option<f64>,
    t: Vec<f64>,
    /// The signals by their names; those are missing that motions with these parameters do not have.
    signals: BTreeMap<&'static str, Vec<f32>>,
}

/// The case that is asked for: what `capsulemap simulate --json` prints of it, its remarks, the command, and the histories of
/// what it settles to.
///
/// Fails if a coordinate is out of its bounds, or it takes longer than a click may.
pub fn motion(explored: &Explored, asked: &Asked) -> Result<Response, Refusal> {
    let clicked = Clicked::of(explored, asked)?;
    let early = clicked.early();
    Ok(json_answer(&clicked.told(early)?))
}

/// A case that was clicked.
pub struct Clicked {
    near: Near,
    protocol: Protocol,
    /// Cycles of its transient.
    cycles: u64,
    /// The command that computes it.
    command: String,
    /// What the file has of its motion, if it is a case of the file.
    kept: Option<Kept>,
}

impl Clicked {
    /// The case that is asked for.
    ///
    /// Fails if a coordinate is out of its bounds.
    pub fn of(explored: &Explored, asked: &Asked) -> Result<Clicked, Refusal> {
        asked.only(explored.model(), &[CYCLES.name, "sweep"])?;
        let cycles = asked.count(CYCLES.name, [0, 400], TRANSIENT as usize)? as u64;
        let near = explored.near(&asked.coordinates(explored.model())?, asked.sweep()?)?;
        let protocol = explored.protocol();
        let file = explored.file.to_string_lossy();
        let command = format!("{} --cycles {cycles}", command(&near.case, &protocol, &file));
        let kept = explored.kept(&near)?;
        Ok(Clicked { near, protocol, cycles, command, kept })
    }

    /// Sends what is told of it in one object; of a motion that does not repeat, which takes long to judge, its histories before.
    pub fn compute(self, send: &dyn Fn(String) -> bool) {
        let early = self.early();
        let is_early = early.is_some();
        if let Some(history) = &early {
            let part = serde_json::to_string(&Early { history }).unwrap_or_default();
            if !send(part) {
                return;
            }
        }
        match self.told(early) {
            Ok(told) => {
                // It is not sent twice.
                let history = told.history.filter(|_| !is_early);
                let told = Told { history, ..told };
                send(serde_json::to_string(&told).unwrap_or_default());
            }
            Err(refusal) => {
                send(refusal.line());
            }
        }
    }

    /// The motion from the section point that the file has of it.
    fn early(&self) -> Option<History> {
        let point = self.kept.as_ref()?.point.as_ref()?;
        let from = State::at_section(self.near.case.parameters.model(), point);
        history(&self.near.case, from, MOST_SHOWN, self.protocol.tolerance)
    }

    /// What is told of the case: the histories are those that are `early`, if they are there.
    ///
    /// Fails if it takes longer than a click may.
    fn told(self, early: Option<History>) -> Result<Told, Refusal> {
        let Clicked { near, protocol, cycles, command, kept } = self;
        let case = &near.case;
        let most = SimulationSize { cycles, events: MOST_EVENTS };
        let simulation = model_of(&case.parameters).simulate(case, most, protocol.tolerance);
        let orbit = settle_case(case, &protocol);
        let history = match (early, &orbit.failure) {
            (_, Some(_)) => None,
            (Some(early), None) => Some(early),
            (None, None) => {
                let from = orbit.end.clone().without_drift();
                history(case, from, shown(&orbit), protocol.tolerance)
            }
        };
        if stop::is_asked() {
            let instead = format!("run `{command}`, which has no such limit");
            return Err(Refusal::late(MOTION_BUDGET, &instead));
        }
        let mut remarks = remarks(&case.parameters, &orbit);
        remarks.extend(other_mean(kept.as_ref(), &orbit));
        remarks.extend(end_of_simulation(&simulation, cycles));
        remarks.extend(history.as_ref().and_then(History::end));
        Ok(Told {
            simulate: case_json(&case.parameters, &simulation, &orbit),
            remarks,
            history,
            portrait: on_portrait(case, &orbit.section),
            stroboscopic: orbit.section,
            command,
            nearest: near.index,
            exact: near.is_exact,
            start: near.start,
        })
    }
}

/// Section points in the coordinates of the phase portrait; none where the model has none.
fn on_portrait(case: &Case, points: &[Section]) -> Vec<[f64; 2]> {
    let model = case.parameters.model();
    let signals = model.motion.portrait.map(|names| names.map(|name| model.signal(name)));
    let Some([Some(x), Some(y)]) = signals else { return Vec::new() };
    let states = points.iter().map(|point| State::at_section(model, point));
    states.filter_map(|state| Some([x.in_state(&state)?, y.in_state(&state)?])).collect()
}

/// Where the simulation ends before its cycles do, and what has all of them.
fn end_of_simulation(simulation: &Simulation, cycles: u64) -> Option<String> {
    let followed = simulation.section.len().saturating_sub(1) as u64;
    (followed < cycles && simulation.failure.is_none()).then(|| {
        format!(
            "the numbers here end after {followed} of {cycles} cycles, before event {}; the command has all of them",
            MOST_EVENTS + 1
        )
    })
}

/// Why the speed of a case of the file is not the one that the file has, where its motion does not repeat.
fn other_mean(kept: Option<&Kept>, orbit: &Orbit) -> Option<String> {
    let kept = kept?.speed.filter(|_| orbit.outcome != Outcome::Periodic)?;
    Some(format!(
        "the file has the speed {:.6} mm/s for this case: of a motion that does not repeat, both are means over some cycles, \
         and these are others",
        1e3 * kept
    ))
}

/// The study of the one case that a request asks for, with the history of what it settles to.
///
/// Fails as [`Clicked`] does.
pub fn study(explored: &Explored, asked: &Asked) -> Result<Study, Refusal> {
    asked.only(explored.model(), &[CYCLES.name, "sweep", "kind", "format"])?;
    let case = explored.near(&asked.coordinates(explored.model())?, asked.sweep()?)?.case;
    let protocol = explored.protocol();
    let model = case.parameters.model();
    if !model.keeps_histories() {
        return Err(Refusal::unfit("figures show no histories of motions without a drive"));
    }
    let cycles = shown(&settle_case(&case, &protocol)) as u32;
    if stop::is_asked() {
        return Err(Refusal::late(BUDGET, INSTEAD));
    }
    let history = Some(HistorySpan { cycles, per_cycle: PER_CYCLE, from_start: false });
    Ok(Study {
        base: case.parameters,
        start: case.start,
        start_phase: case.start_phase,
        section_phase: case.section_phase,
        protocol: Protocol { history, ..protocol },
        ..Study::of(model)
    })
}

/// Cycles of an orbit that are shown.
pub fn shown(orbit: &Orbit) -> u64 {
    match orbit.period {
        0 => MOST_SHOWN,
        period => period.clamp(2, MOST_SHOWN),
    }
}

/// The motion of a case from a state on its section over some cycles, with its events, in columns in SI.
fn history(case: &Case, from: State, cycles: u64, tolerance: f64) -> Option<History> {
    let stretch = followed(case, from, cycles, tolerance)?;
    let parameters = &case.parameters;
    let model = parameters.model();
    let present = model.motion.signals.iter().filter(|it| (it.missing)(parameters).is_none());
    let signals = present.map(|it| {
        let values = it.values(parameters, &stretch.histories);
        (it.name(), values.into_iter().map(|value| value as f32).collect())
    });
    Some(History {
        cycles,
        period: parameters.period_of_drive(),
        surface: model.impact_surface().map(|it| parameters[it]),
        signals: signals.collect(),
        t: stretch.times,
    })
}

impl History {
    /// Where it ends before its cycles do.
    fn end(&self) -> Option<String> {
        let (last, count, cycles) = (self.t.last()?, self.t.len(), self.cycles);
        let whole = self.period.map(|period| format!(" of {:.4} s", cycles as f64 * period));
        let whole = whole.unwrap_or_else(|| format!(", before {cycles} cycles"));
        (count >= MOST_POINTS).then(|| {
            format!(
                "the histories end after {last:.4} s{whole}, as they have {count} points by then"
            )
        })
    }
}
