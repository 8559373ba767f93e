//! The stored motion of a case over time, and what follows from it.

use std::f64::consts::TAU;

use super::error::FigureError;
use super::view::View;
use crate::description::{Description, Parameter, Parameters, Presence, SignalKind, Source, State};
use crate::motion::{Case, Stretch};
use crate::of::model_of;
use crate::store::catalogue::{Entry, HISTORY_TIME, histories, impacts, section};
use crate::study::{Coordinate, Drawing};

/// Points of a motion that is computed again between its samples, at most: in all, in a cycle of the drive, and from a
/// sample to the next.
const MOST_POINTS: usize = 64_000;
const MOST_IN_A_CYCLE: f64 = 3200.0;
const MOST_BETWEEN: usize = 32;
/// Relative local tolerance of the motion between samples, which is only drawn.
const TOLERANCE: f64 = 1e-10;
/// By how much of the largest the motion from a sample may miss the next.
const MISSED: f64 = 1e-6;

/// What the signal called `name` is found from, where it is not kept itself.
pub fn sources(name: &str, model: &'static Description) -> Vec<Entry> {
    let coordinates = histories(model).into_iter().take(model.coordinates.len());
    match model.signal(name).map(|it| it.source) {
        None | Some(Source::Kept(_)) => Vec::new(),
        Some(Source::State(_)) => coordinates.collect(),
        Some(Source::Parameters(_)) => {
            model.parameters().map(Entry::of_parameter).chain(histories(model)).collect()
        }
    }
}

/// What is found from, of a motion that is [drawn](Motion::drawn).
pub fn sources_of_arcs(model: &'static Description) -> Vec<Entry> {
    let parameters = model.parameters().map(Entry::of_parameter);
    let phases = Coordinate::phases(model).map(Entry::of_coordinate);
    parameters.chain(phases).chain(histories(model)).collect()
}

/// The cycles of a motion that a figure shows.
#[derive(Debug, Clone, Copy)]
pub struct ShownCycles {
    /// The first.
    pub first: f64,
    /// The last.
    pub last: f64,
}

impl ShownCycles {
    /// Those that the request names, or all.
    pub fn of(drawing: &Drawing) -> ShownCycles {
        let [first, last] = drawing.cycles.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        ShownCycles { first, last }
    }

    /// Whether a time, in cycles, is among them.
    pub fn has(self, cycle: f64) -> bool {
        (self.first - 1e-9..=self.last + 1e-9).contains(&cycle)
    }
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
struct Points {
    /// Cycles since the first.
    cycles: Vec<f64>,
    /// What is kept of the motion: by what it is, then by point.
    histories: Vec<Vec<f64>>,
}

/// The samples of a motion that are followed from each to the next.
struct Samples {
    parameters: Parameters,
    /// Cycles since the first.
    cycles: Vec<f64>,
    /// What is kept of the motion: by what it is, then by sample.
    histories: Vec<Vec<f64>>,
    /// The largest magnitude of each.
    sizes: Vec<f64>,
    /// Parts into which the time from a sample to the next is cut.
    count: u32,
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

    /// The frequency of the drive [rad/s].
    pub fn frequency(&self) -> Result<f64, FigureError> {
        match self.view.model().drive_frequency() {
            Some(frequency) => self.number(frequency.symbol()),
            None => Err(self.view.unfit("its cycles are none of a drive, and last differently")),
        }
    }

    /// The values of the quantity called `name` at its points, in the unit of the figure.
    pub fn shown(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        let factor = self.view.quantity(name).factor;
        let mut samples = self.samples(name)?;
        let kind = self.view.model().signal(name).map(|it| it.kind);
        if kind == Some(SignalKind::Repeating) {
            break_turns(&mut samples);
        }
        Ok(samples.into_iter().map(|value| value * factor).collect())
    }

    /// The same in SI.
    fn samples(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        let model = self.view.model();
        let signal = model.signal(name);
        let Some(signal) = signal.filter(|it| !matches!(it.source, Source::Kept(_))) else {
            return self.kept(name);
        };
        if let Source::State(value) = signal.source {
            let histories = self.histories(model.coordinates.len())?;
            let states = (0..histories[0].len()).map(|place| model.state_of(&histories, place));
            return Ok(states.map(|state| value(&state)).collect());
        }
        let parameters = self.parameters()?;
        if let Some(why) = (signal.missing)(&parameters) {
            return Err(self.view.unfit(why));
        }
        Ok(signal.values(&parameters, &self.histories(usize::MAX)?))
    }

    /// What is kept of it: the first so many.
    fn histories(&self, count: usize) -> Result<Vec<Vec<f64>>, FigureError> {
        let kept = self.view.model().motion.histories.iter().take(count);
        kept.map(|it| self.kept(it.name)).collect()
    }

    /// The values of what is kept under this name at its points.
    fn kept(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        let mut known = self.view.model().motion.histories.iter();
        let place = known.position(|it| it.name == name);
        if let (Some(points), Some(place)) = (&self.points, place) {
            return Ok(points.histories[place].clone());
        }
        let count = self.cycles()?.len();
        let all = self.view.take(name, self.free)?;
        Ok(all.iter().skip(self.case * count).take(count).copied().collect())
    }

    /// The values of a coordinate at its section points (SI); none of what goes on from cycle to cycle, and where the study keeps no
    /// points.
    pub fn at_sections(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        let model = self.view.model();
        self.at_points(name, &section(model), |point| State::at_section(model, point))
    }

    /// The same at its impacts.
    pub fn at_impacts(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        let model = self.view.model();
        let Some(at_impact) = model.motion.at_impact else { return Ok(Vec::new()) };
        // Where the surface is not known, neither is the coordinate that meets it.
        let surface = self.surface().unwrap_or(f64::NAN);
        self.at_points(name, &impacts(model), |told| at_impact(surface, told))
    }

    /// Where impacts happen [SI], if that is known.
    pub fn surface(&self) -> Option<f64> {
        self.number(self.view.model().impact_surface()?.symbol()).ok()
    }

    /// Where the stops are that the first coordinate meets, as far as they are known [SI], and on which side, 1 or -1.
    pub fn stops(&self) -> Vec<(f64, f64)> {
        let (model, parameters) = (self.view.model(), self.parameters().ok());
        let at = |it: Parameter| match &parameters {
            Some(all) if (model.rules.no_effect)(all, it).is_some() => None,
            Some(all) => Some(all[it]),
            // Of results that do not hold all parameters, what they hold.
            None => self.number(it.symbol()).ok().filter(|it| it.is_finite()),
        };
        let known = model.surfaces().filter_map(|(it, side)| Some((side * at(it)?, side)));
        known.collect()
    }

    /// The values of a coordinate at points that have these numbers, of which the states follow.
    fn at_points(
        &self,
        name: &str,
        numbers: &[Entry],
        state: impl Fn(&[f64]) -> State,
    ) -> Result<Vec<f64>, FigureError> {
        let signal = self.view.model().signal(name);
        let on_section = [SignalKind::Coordinate, SignalKind::Repeating];
        let signal = signal.filter(|it| on_section.contains(&it.kind));
        let Some(signal) = signal else { return Ok(Vec::new()) };
        let rows = numbers.iter().map(|it| self.row(it.name));
        let rows = rows.collect::<Result<Vec<_>, FigureError>>()?;
        let mut values = Vec::new();
        for place in 0..rows.iter().map(Vec::len).max().unwrap_or(0) {
            // What does not depend on a number that is not there is known all the same.
            let numbers = rows.iter().map(|row| row.get(place).copied().unwrap_or(f64::NAN));
            values.extend(signal.in_state(&state(&numbers.collect::<Vec<f64>>())));
        }
        Ok(values)
    }

    /// The numbers of the case along the last dimension of a variable; none where it is not kept.
    fn row(&self, name: &str) -> Result<Vec<f64>, FigureError> {
        if self.view.dataset.variable(name).is_none() {
            return Ok(Vec::new());
        }
        let all = self.view.take(name, self.free)?;
        let count = all.shape().last().copied().unwrap_or(0);
        Ok(all.iter().skip(self.case * count).take(count).copied().collect())
    }

    /// The parameters of the case.
    fn parameters(&self) -> Result<Parameters, FigureError> {
        let mut parameters = Parameters::of(self.view.model());
        for parameter in self.view.model().parameters() {
            match (parameter.presence(), self.number(parameter.symbol())) {
                (Presence::Optional, Err(_)) => {}
                (Presence::Told, Ok(value)) if value == parameter.default_value() => {}
                (_, value) => parameters[parameter] = value?,
            }
        }
        for (place, choice) in self.view.model().choices.iter().enumerate() {
            let named = self.view.dataset.attributes.get(choice.name);
            if named.is_none() && choice.is_optional {
                continue;
            }
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
        let shown = ShownCycles::of(self.view.drawing);
        let samples = self.samples_between(shown)?;
        let phase = self.phase(&samples)?;
        samples.followed(phase, shown)
    }

    /// The samples, if the time between those that are shown is cut into parts.
    fn samples_between(&self, shown: ShownCycles) -> Option<Samples> {
        let cycles = self.cycles().ok()?;
        let count = cycles.iter().filter(|cycle| shown.has(**cycle)).count();
        let step = cycles.get(1)? - cycles[0];
        let wanted = (MOST_IN_A_CYCLE * step) as usize;
        let count = (MOST_POINTS / count.max(1)).min(MOST_BETWEEN).min(wanted) as u32;
        if count < 2 {
            return None;
        }
        let histories = self.histories(usize::MAX).ok()?;
        let sizes = histories.iter().map(|column| largest(column)).collect();
        let parameters = self.parameters().ok()?;
        Some(Samples { parameters, cycles, histories, sizes, count })
    }

    /// The phase of the drive at the first sample, that of the section or of the start; none if neither leads to the second.
    fn phase(&self, samples: &Samples) -> Option<f64> {
        let phases = [Coordinate::SectionPhase, Coordinate::StartPhase];
        phases.into_iter().find_map(|coordinate| {
            let phase = self.number(coordinate.name()).ok()?;
            samples.arc(0, phase).map(|_| phase)
        })
    }
}

/// The largest magnitude.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

impl Samples {
    /// The samples with the motion between those that are shown, where the drive is at `phase` at the first [rad]; none where it does
    /// not lead from each to the next.
    fn followed(&self, phase: f64, shown: ShownCycles) -> Option<Points> {
        let mut points =
            Points { cycles: Vec::new(), histories: vec![Vec::new(); self.histories.len()] };
        for (place, &begins) in self.cycles.iter().enumerate() {
            points.put(begins, &self.histories, place);
            let Some(&next) = self.cycles.get(place + 1) else { break };
            if !(shown.has(begins) && shown.has(next)) {
                continue;
            }
            let arc = self.arc(place, phase)?;
            let end = arc.times.len() - 1;
            for between in 1..end {
                let share = arc.times[between] / arc.times[end];
                points.put(begins + share * (next - begins), &arc.histories, between);
            }
        }
        Some(points)
    }

    /// The motion from a sample to the next, where the drive is at `phase` at the first [rad]; none where it does not lead there.
    fn arc(&self, place: usize, phase: f64) -> Option<Stretch> {
        let model = self.parameters.model();
        let [start_phase, section_phase] =
            [place, place + 1].map(|at| phase + TAU * self.cycles[at]);
        let case = Case {
            parameters: self.parameters.clone(),
            start: model.state_of(&self.histories, place),
            start_phase,
            section_phase,
        };
        let arc = model_of(&self.parameters).arc(&case, self.count, TOLERANCE).ok()?;
        (0..self.sizes.len()).all(|column| self.meets(&arc, column, place)).then_some(arc)
    }

    /// Whether what is kept in a column leads from a sample to the next along `arc`; it may drift.
    fn meets(&self, arc: &Stretch, column: usize, place: usize) -> bool {
        let (samples, most) = (&self.histories[column], MISSED * self.sizes[column]);
        let arc_column = &arc.histories[column];
        let begins_at_sample = (arc_column[0] - samples[place]).abs() <= most;
        let end = arc.times.len() - 1;
        let ends_at_next = (arc_column[end] - samples[place + 1]).abs() <= most;
        Some(column) == self.parameters.model().drift || (begins_at_sample && ends_at_next)
    }
}

/// Leaves a sample out where what repeats begins anew, so that no line leads across the picture there.
fn break_turns(samples: &mut [f64]) {
    let mut before = f64::NAN;
    for sample in samples {
        let jumps = (*sample - before).abs() > 0.5;
        before = *sample;
        if jumps {
            *sample = f64::NAN;
        }
    }
}

impl Points {
    /// Adds what is kept of a motion at a place.
    fn put(&mut self, cycle: f64, histories: &[Vec<f64>], place: usize) {
        self.cycles.push(cycle);
        self.histories.iter_mut().zip(histories).for_each(|(column, of)| column.push(of[place]));
    }
}
