//! The stored motion of a case over time, and what follows from it.

use std::f64::consts::TAU;

use super::error::FigureError;
use super::view::View;
use crate::capsule::{CapsuleParameters as _, Forces, State, arc};
use crate::description::{Description, Parameters};
use crate::store::catalogue::{
    Entry, HISTORY_CONTACT, HISTORY_DRIVE, HISTORY_FRICTION, HISTORY_R, HISTORY_TIME, HISTORY_X1,
    HISTORY_X2, HISTORY_Y1, HISTORY_Y2, RELATIVE_VELOCITY,
};
use crate::study::Coordinate;

/// The variables of a state.
const STATES: [Entry; 4] = [HISTORY_R, HISTORY_Y1, HISTORY_X2, HISTORY_Y2];
/// Points of a motion that is computed again between its samples, at most: in all, in a cycle of the drive, and from a
/// sample to the next.
const MOST_POINTS: usize = 64_000;
const MOST_IN_A_CYCLE: f64 = 3200.0;
const MOST_BETWEEN: usize = 32;
/// Relative local tolerance of the motion between samples, which is only drawn.
const TOLERANCE: f64 = 1e-10;
/// By how much of the largest the motion from a sample may miss the next.
const MISSED: f64 = 1e-6;

/// What the quantity called `name` is found from.
pub fn sources(name: &str, model: &'static Description) -> Vec<Entry> {
    match name {
        _ if name == HISTORY_X1.name => vec![HISTORY_X2, HISTORY_R],
        _ if name == RELATIVE_VELOCITY.name => vec![HISTORY_Y1, HISTORY_Y2],
        _ if name == HISTORY_CONTACT.name || name == HISTORY_FRICTION.name => {
            let parameters = model.parameters().map(Entry::of_parameter);
            parameters.chain(STATES).collect()
        }
        _ => Vec::new(),
    }
}

/// What is found from, of a motion that is [drawn](Motion::drawn).
pub fn sources_of_arcs(model: &'static Description) -> Vec<Entry> {
    let parameters = model.parameters().map(Entry::of_parameter);
    let phases = [Coordinate::StartPhase, Coordinate::SectionPhase].map(Entry::of_coordinate);
    parameters.chain(phases).chain(STATES).chain([HISTORY_DRIVE]).collect()
}

/// A case of a figure, by its place among those over the axes `free`.
pub struct Motion<'v, 'a> {
    view: &'v View<'a>,
    free: &'v [&'v str],
    case: usize,
    /// Its points, if they are more than the samples.
    points: Option<Points>,
}

/// Points of a motion, in the order of time.
#[derive(Default)]
struct Points {
    /// Cycles since the first.
    cycles: Vec<f64>,
    states: Vec<State<f64>>,
    /// Force of the drive [N].
    drive: Vec<f64>,
}

impl<'v, 'a> Motion<'v, 'a> {
    /// The motion of a case at the samples of its history, which are even.
    pub fn sampled(view: &'v View<'a>, free: &'v [&'v str], case: usize) -> Motion<'v, 'a> {
        Motion { view, free, case, points: None }
    }

    /// The motion of a case as it is drawn: between the samples of a short history computed again from each to the
    /// next, with its events, so that arcs within the contact are none of straight lines.
    pub fn drawn(view: &'v View<'a>, free: &'v [&'v str], case: usize) -> Motion<'v, 'a> {
        let sampled = Motion::sampled(view, free, case);
        let points = sampled.computed();
        Motion { points, ..sampled }
    }

    /// The cycles of its points, counted from its start.
    pub fn cycles(&self) -> Result<Vec<f64>, FigureError> {
        if let Some(points) = &self.points {
            return Ok(points.cycles.clone());
        }
        let cycles = self.view.coordinate_values(HISTORY_TIME.name);
        if cycles.is_empty() { Err(self.view.without_histories()) } else { Ok(cycles) }
    }

    /// The values of the quantity called `name` at its points, in the unit of the figure.
    pub fn shown(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        let factor = self.view.quantity(name).factor;
        Ok(self.samples(name)?.into_iter().map(|value| value * factor).collect())
    }

    /// The same in SI.
    fn samples(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        let both = |a: Entry, b: Entry, of: fn(f64, f64) -> f64| {
            let (a, b) = (self.stored(a.name)?, self.stored(b.name)?);
            Ok(a.into_iter().zip(b).map(|(a, b)| of(a, b)).collect())
        };
        match name {
            _ if name == HISTORY_X1.name => both(HISTORY_X2, HISTORY_R, |x2, r| x2 + r),
            _ if name == RELATIVE_VELOCITY.name => both(HISTORY_Y1, HISTORY_Y2, |y1, y2| y1 - y2),
            _ if name == HISTORY_CONTACT.name => self.forces(|forces| forces.contact),
            _ if name == HISTORY_FRICTION.name => {
                if !self.parameters()?.switching().balances_at_rest() {
                    let why = "the friction at rest is not that of the equation as printed";
                    return Err(self.view.unfit(why));
                }
                self.forces(|forces| forces.friction)
            }
            _ => self.stored(name),
        }
    }

    /// The values of a variable at its points.
    fn stored(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        if let Some(Points { states, drive, .. }) = &self.points {
            let of = |value: fn(&State<f64>) -> f64| Ok(states.iter().map(value).collect());
            match name {
                _ if name == HISTORY_R.name => return of(|state| state.r),
                _ if name == HISTORY_Y1.name => return of(|state| state.y1),
                _ if name == HISTORY_X2.name => return of(|state| state.x2),
                _ if name == HISTORY_Y2.name => return of(|state| state.y2),
                _ if name == HISTORY_DRIVE.name => return Ok(drive.clone()),
                _ => {}
            }
        }
        let count = self.cycles()?.len();
        let all = self.view.take(name, self.free)?;
        Ok(all.iter().skip(self.case * count).take(count).copied().collect())
    }

    /// A force at each point.
    fn forces(&self, of: impl Fn(Forces) -> f64) -> Result<Vec<f64>, FigureError> {
        let parameters = self.parameters()?;
        let states = self.states()?;
        Ok(states.iter().map(|state| of(Forces::of(&parameters, state))).collect())
    }

    /// The states at its points.
    fn states(&self) -> Result<Vec<State<f64>>, FigureError> {
        let [r, y1, x2, y2] = STATES.map(|it| self.stored(it.name));
        let all = r?.into_iter().zip(y1?).zip(x2?).zip(y2?);
        Ok(all.map(|(((r, y1), x2), y2)| State { r, y1, x2, y2 }).collect())
    }

    /// The parameters of the case.
    fn parameters(&self) -> Result<Parameters, FigureError> {
        let mut parameters = Parameters::of(self.view.model());
        for parameter in self.view.model().parameters() {
            parameters[parameter] = self.number(parameter.symbol())?;
        }
        for (place, choice) in self.view.model().choices.iter().enumerate() {
            let named = self.view.dataset.attributes.get(choice.name);
            let chosen =
                choice.options.iter().position(|it| named.is_some_and(|named| named == it));
            let Some(chosen) = chosen else {
                let why = format!("the results do not name their {}", choice.meaning);
                return Err(self.view.unfit(why));
            };
            parameters.choose(place, chosen);
        }
        Ok(parameters)
    }

    /// The value of a parameter or of another coordinate of the case [SI].
    fn number(&self, name: &str) -> Result<f64, FigureError> {
        let values = self.view.parameter(name, self.free)?;
        Ok(values.iter().nth(self.case).copied().unwrap_or(f64::NAN))
    }

    /// The motion between the samples, from each to the next, where these are few; none where it does not lead
    /// from each to the next, so that the history is not one of what is known of the case.
    fn computed(&self) -> Option<Points> {
        let cycles = self.cycles().ok()?;
        let [first, last] = self.view.drawing.cycles.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let is_shown = |cycle: f64| (first - 1e-9..=last + 1e-9).contains(&cycle);
        let shown = cycles.iter().filter(|cycle| is_shown(**cycle)).count();
        let step = cycles.get(1)? - cycles[0];
        let wanted = (MOST_IN_A_CYCLE * step) as usize;
        let count = (MOST_POINTS / shown.max(1)).min(MOST_BETWEEN).min(wanted) as u32;
        if count < 2 {
            return None;
        }
        let (parameters, states) = (self.parameters().ok()?, self.states().ok()?);
        let drive = self.stored(HISTORY_DRIVE.name).ok()?;
        let phase = self.phase(&parameters, &cycles, &drive)?;
        let size = |of: fn(&State<f64>) -> f64| {
            states.iter().map(of).fold(0.0, |most: f64, value| most.max(value.abs()))
        };
        let sizes = [size(|it| it.r), size(|it| it.y1), size(|it| it.y2)];
        let mut points = Points::default();
        let omega = parameters[parameters.model().drive_frequency()];
        for (place, state) in states.iter().enumerate() {
            points.put(cycles[place], *state, drive[place]);
            let Some(next) = states.get(place + 1) else { break };
            if !(is_shown(cycles[place]) && is_shown(cycles[place + 1])) {
                continue;
            }
            let phases = [place, place + 1].map(|at| phase + TAU * cycles[at]);
            let arc = arc(&parameters, *state, phases, count, TOLERANCE).ok()?;
            let (end, between) = arc.split_last()?;
            let missed = [end.state.r - next.r, end.state.y1 - next.y1, end.state.y2 - next.y2];
            let meets = |(missed, size): (&f64, f64)| missed.abs() <= MISSED * size;
            if !missed.iter().zip(sizes).all(meets) {
                return None;
            }
            for point in between {
                points.put(cycles[place] + point.time * omega / TAU, point.state, point.drive);
            }
        }
        Some(points)
    }

    /// The phase of the drive at the first sample, that of the start or of the section; none if the force of the drive
    /// tells of another.
    fn phase(&self, parameters: &Parameters, cycles: &[f64], drive: &[f64]) -> Option<f64> {
        let p_d = parameters[parameters.model().drive_amplitude()];
        let phases = [Coordinate::SectionPhase, Coordinate::StartPhase];
        phases.into_iter().find_map(|coordinate| {
            let phase = self.number(coordinate.name()).ok()?;
            let meets = |(cycle, force): (&f64, &f64)| {
                (p_d * (phase + TAU * cycle).cos() - force).abs() <= MISSED * p_d
            };
            cycles.iter().zip(drive).take(3).all(meets).then_some(phase)
        })
    }
}

impl Points {
    fn put(&mut self, cycle: f64, state: State<f64>, drive: f64) {
        self.cycles.push(cycle);
        self.states.push(state);
        self.drive.push(drive);
    }
}
