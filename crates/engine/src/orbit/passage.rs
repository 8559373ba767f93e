//! Where motions return to, with derivatives, and what they pass: one at a time, or side by side.

use std::fmt::Debug;

use crate::flow::{Event, Reason, Step, Stroboscopic, Switched, System};
use crate::lane::{Dual, Lane, Mask, Series, series};

use super::directions::{CycleStretch, stretched};
use super::extrema::{Extremum, SignChanges, Turns, nearest};
use super::matrix::Matrix;
use super::measuring::{MeasureRequest, Measured, measured_alone};
use super::return_map::{Cycles, Image, returned};
use super::varied::Varied;

/// A return that is asked for.
#[derive(Debug, Clone)]
pub struct ReturnRequest<M: System<D>, const D: usize> {
    /// The system with the parameters that are held.
    pub system: M,
    /// What varies, with its number and the unit of that.
    pub along: Option<(Varied<M::Parameter>, f64, f64)>,
    /// The section point.
    pub point: [f64; D],
    /// Units of its coordinates.
    pub units: [f64; D],
    /// How many cycles, and how closely.
    pub cycles: Cycles,
    /// Whether events and extrema are asked for, too.
    pub watched: bool,
    /// Directions that take the place of the coordinates, orthonormal columns in units of these: they are made orthonormal again
    /// after each step, and how much each was stretched is told; nothing is watched then.
    pub directions: Option<Matrix<D>>,
}

/// A return, with derivatives along the coordinates of the section point and along the parameter, in their units.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage<E, const D: usize> {
    /// The section point that it returns to.
    pub end: [f64; D],
    /// Its derivatives along the coordinates; where directions are asked for these, orthonormal in the units of the coordinates.
    pub jacobian: Matrix<D>,
    /// How much each cycle has stretched the directions, where that is asked for.
    pub stretches: Vec<CycleStretch<D>>,
    /// Its derivatives along the parameter; zero where none varies.
    pub by_parameter: [f64; D],
    /// The events in order, where they are asked for.
    pub events: Vec<E>,
    /// How near to the section, before or after it, one of them comes [cycles]; infinite where none does.
    pub nearest_event: f64,
    /// How far the local extremum that is nearest to the surface that it may touch is below it.
    pub margin: Option<Margin<D>>,
    /// Each local extremum: when it is met after the section [cycles], and how far it is below the surface.
    pub margins: Vec<(f64, f64)>,
    /// How far an autonomous motion gets from where it begins, in the units of the metric; infinite for a driven one,
    /// which need not move to return.
    pub excursion: f64,
}

/// How far an extremum is below a surface, with derivatives as those of [`Passage`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin<const D: usize> {
    /// The distance; negative above the surface.
    pub value: f64,
    /// Its derivatives along the coordinates.
    pub gradient: [f64; D],
    /// Its derivative along the parameter.
    pub by_parameter: f64,
}

/// Computes returns and measures cycles; the bits do not depend on who does.
pub trait Integrator<M: System<D>, const D: usize>: Debug {
    /// The return that is asked for.
    fn passage(&self, request: ReturnRequest<M, D>) -> Result<Passage<M::Event, D>, Reason>;
    /// The cycles that are to be measured.
    fn measured(&self, request: MeasureRequest<M, D>) -> Measured<M, D>;
    /// Several returns without derivatives.
    fn plain_returns(&self, request: PlainRequest<M, D>) -> PlainReturns<M::Event, D>;
}

/// Returns without derivatives that are asked for.
#[derive(Debug, Clone)]
pub struct PlainRequest<M, const D: usize> {
    /// The system.
    pub system: M,
    /// The section points.
    pub points: Vec<[f64; D]>,
    /// How many cycles, and how closely.
    pub cycles: Cycles,
}

/// Returns without derivatives, each none where the motion cannot be followed so far.
pub type PlainReturns<E, const D: usize> = Vec<Option<PlainReturn<E, D>>>;

/// A return without derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct PlainReturn<E, const D: usize> {
    /// The section point.
    pub end: [f64; D],
    /// The events in order.
    pub events: Vec<E>,
}

/// The image of a section point under the return map of `system`.
pub fn image<M: System<D>, const D: usize>(
    integrator: &dyn Integrator<M, D>,
    system: &M,
    point: &[f64; D],
    cycles: &Cycles,
) -> Result<Image<D>, Reason> {
    let passage = integrator.passage(ReturnRequest {
        system: system.clone(),
        along: None,
        point: *point,
        units: [1.0; D],
        cycles: *cycles,
        watched: false,
        directions: None,
    })?;
    Ok(Image { end: passage.end, jacobian: passage.jacobian })
}

/// Computes each when it is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OneByOne;

impl<M: System<D>, const D: usize> Integrator<M, D> for OneByOne {
    fn passage(&self, request: ReturnRequest<M, D>) -> Result<Passage<M::Event, D>, Reason> {
        match const { D } {
            1 => alone::<M, D, 2>(&request),
            2 => alone::<M, D, 3>(&request),
            3 => alone::<M, D, 4>(&request),
            4 => alone::<M, D, 5>(&request),
            5 => alone::<M, D, 6>(&request),
            6 => alone::<M, D, 7>(&request),
            7 => alone::<M, D, 8>(&request),
            8 => alone::<M, D, 9>(&request),
            _ => panic!("a section has one to eight coordinates, not {D}"),
        }
    }

    fn measured(&self, request: MeasureRequest<M, D>) -> Measured<M, D> {
        measured_alone(request)
    }

    fn plain_returns(&self, request: PlainRequest<M, D>) -> PlainReturns<M::Event, D> {
        let PlainRequest { system, points, cycles } = request;
        points.iter().map(|point| plain_return::<M, D>(&system.single(), *point, &cycles)).collect()
    }
}

/// A return in plain numbers, if the motion can be followed so far.
fn plain_return<M: System<D>, const D: usize>(
    system: &M::Single,
    point: [f64; D],
    cycles: &Cycles,
) -> Option<PlainReturn<M::Event, D>> {
    let mut events = Vec::new();
    let end = returned(system, point, cycles, |step| {
        events.extend(M::Event::from_code(step.event).filter(|it| !it.is_timed()));
    });
    Some(PlainReturn { end: end.ok()?, events })
}

/// What a motion passes until its return.
#[derive(Debug, Clone)]
pub struct Passing<L, E> {
    /// The events so far.
    pub events: Vec<E>,
    /// When the first and the last of them came [cycles].
    first_and_last: Option<[f64; 2]>,
    /// The local extrema of the coordinate that may touch a surface, in order.
    pub extrema: Vec<Extremum<L>>,
    turns: Turns<L>,
    /// Time since the start [s].
    elapsed: f64,
    /// Duration of a cycle [s].
    period: f64,
}

impl<L: Lane, E: Event> Passing<L, E> {
    /// Nothing passed yet, in cycles of this duration [s].
    pub fn new(period: f64) -> Self {
        let (events, extrema, turns) = (Vec::new(), Vec::new(), Turns::default());
        Passing { events, first_and_last: None, extrema, turns, elapsed: 0.0, period }
    }

    /// Takes note of a step of this length [s] with the event at its end.
    pub fn see(&mut self, (length, event): (f64, Option<E>)) {
        self.elapsed += length;
        if let Some(event) = event.filter(|it| !it.is_timed()) {
            self.events.push(event);
            let now = self.elapsed / self.period;
            self.first_and_last = Some([self.first_and_last.map_or(now, |[first, _]| first), now]);
        }
    }

    /// Takes note of how the coordinate that may touch a surface turns during a step in a lane, before the step is seen;
    /// `at` tells the coordinate at a time.
    pub(super) fn turn<P: Lane>(
        &mut self,
        changes: (&SignChanges<P, L>, usize),
        step: (f64, Option<E>),
        at: impl Fn(f64) -> L,
        surfaces: impl Fn() -> [L; 2],
    ) {
        let Passing { turns, extrema, elapsed, period, .. } = self;
        turns.during(changes, step, at, |time, value| {
            let time = (*elapsed + time) / *period;
            let [first, second] = surfaces().map(|surface| surface - value);
            let is_second = second.abs().plain().lane(0) < first.abs().plain().lane(0);
            extrema.push(Extremum { margin: if is_second { second } else { first }, time });
        });
    }

    /// Takes note of a step of a motion that has one lane.
    pub fn see_alone<S: Switched<L, Event = E>>(
        &mut self,
        system: &S,
        step: &Step<L, S>,
        changes: &mut SignChanges<L::Plain, L>,
    ) {
        let seen = (step.length.lane(0), E::from_code(step.event.lane(0)));
        if let Some((coordinate, surfaces)) = system.touching(&step.jet) {
            let all = <L::Plain as Lane>::Mask::splat(true);
            changes.of(coordinate, step.length.plain(), all, |value, _| *value);
            self.turn((changes, 0), seen, |time| value_at(coordinate, time), || surfaces);
        }
        self.see(seen);
    }
}

/// The value of a series at a time, its first term at the start.
pub(super) fn value_at<L: Lane>(series: &Series<L>, time: f64) -> L {
    if time == 0.0 { series[0] } else { series::value(series, L::splat(time)) }
}

impl<M: System<D>, const D: usize> ReturnRequest<M, D> {
    /// The value of a parameter.
    pub(super) fn value(&self, parameter: M::Parameter) -> f64 {
        let varied = self.along.as_ref();
        let given = varied.and_then(|(along, number, _)| along.value(parameter, *number));
        given.unwrap_or_else(|| self.system.value(parameter))
    }

    /// The derivative of a parameter along the number that varies.
    pub(super) fn seed(&self, parameter: M::Parameter) -> f64 {
        let varied = self.along.as_ref();
        varied.and_then(|(along, _, unit)| Some(along.slope(parameter)? * unit)).unwrap_or(0.0)
    }

    /// The derivative of a coordinate of the section point along a direction at the start.
    pub(super) fn coordinate_seed(&self, coordinate: usize, direction: usize) -> f64 {
        match &self.directions {
            Some(directions) => directions[coordinate][direction] * self.units[coordinate],
            None if coordinate == direction => self.units[coordinate],
            None => 0.0,
        }
    }
}

/// A return in numbers with derivatives along `D` coordinates and a parameter.
fn alone<M: System<D>, const D: usize, const U: usize>(
    request: &ReturnRequest<M, D>,
) -> Result<Passage<M::Event, D>, Reason> {
    let seeded = |parameter: M::Parameter| {
        let mut dual = Dual::<f64, U>::constant(request.value(parameter));
        dual.gradient[D] = request.seed(parameter);
        dual
    };
    let system = request.system.system(seeded);
    let mut from = request.point.map(Dual::<f64, U>::constant);
    for (i, coordinate) in from.iter_mut().enumerate() {
        for direction in 0..D {
            coordinate.gradient[direction] = request.coordinate_seed(i, direction);
        }
    }
    if request.directions.is_some() {
        let (end, stretches) = stretched(&system, from, &request.units, &request.cycles)?;
        let passing = Passing::new(system.period().value);
        return Ok(Passage { stretches, ..told(end, passing, f64::INFINITY) });
    }
    let autonomous = M::Single::AUTONOMOUS;
    let mut excursion: f64 = if autonomous { 0.0 } else { f64::INFINITY };
    let metric = request.system.metric();
    let mut passing = Passing::<Dual<f64, U>, M::Event>::new(system.period().value);
    let mut changes = SignChanges::none();
    let end = returned(&system, from, &request.cycles, |step| {
        if !request.watched {
            return;
        }
        if autonomous {
            let here = M::In::<Dual<f64, U>>::point(&system.at(&step.jet, Dual::splat(0.0)));
            let here = here.map(|coordinate| coordinate.value);
            excursion = excursion.max(metric.distance(&here, &request.point));
        }
        passing.see_alone(&system, step, &mut changes);
    })?;
    Ok(told(end, passing, excursion))
}

/// The return that ends so, with what was passed.
pub(super) fn told<E, const D: usize, const U: usize>(
    end: [Dual<f64, U>; D],
    passing: Passing<Dual<f64, U>, E>,
    excursion: f64,
) -> Passage<E, D> {
    let margin = nearest(&passing.extrema).map(|extremum| Margin {
        value: extremum.margin.value,
        gradient: std::array::from_fn(|i| extremum.margin.gradient[i]),
        by_parameter: extremum.margin.gradient[D],
    });
    Passage {
        end: end.map(|it| it.value),
        jacobian: end.map(|it| std::array::from_fn(|i| it.gradient[i])),
        stretches: Vec::new(),
        by_parameter: end.map(|it| it.gradient[D]),
        events: passing.events,
        nearest_event: passing.first_and_last.map_or(f64::INFINITY, |[first, last]| {
            first.min(passing.elapsed / passing.period - last)
        }),
        margin,
        margins: passing.extrema.iter().map(|it| (it.time, it.margin.value)).collect(),
        excursion,
    }
}
