//! Where motions return to, with derivatives, and what they pass: one at a time, or side by side.

use crate::flow::{
    Event, MAX_GUARDS, Motion, Reason, STEPS_PER_CYCLE, Step, Stroboscopic, Switched, System,
};
use crate::lane::{Dual, Instructions, Lane, Mask, Series, SideBySide, Work, series};

use super::extrema::{Extremum, Turns, nearest};
use super::matrix::Matrix;
use super::return_map::{Cycles, returned};

/// With no more than one lane in so many taken, returns are followed faster one by one.
const WORTHWHILE: usize = 4;

/// A return that is asked for.
#[derive(Debug, Clone)]
pub struct ReturnRequest<M: System<D>, const D: usize> {
    /// The system with the parameters that are held.
    pub system: M,
    /// The parameter that varies, with its value and its unit.
    pub along: Option<(M::Parameter, f64, f64)>,
    /// The section point.
    pub point: [f64; D],
    /// Units of its coordinates.
    pub units: [f64; D],
    /// How many cycles, and how closely.
    pub cycles: Cycles,
    /// Whether events and extrema are asked for, too.
    pub watched: bool,
}

/// A return, with derivatives along the coordinates of the section point and along the parameter, in their units.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage<E, const D: usize> {
    /// The section point that it returns to.
    pub end: [f64; D],
    /// Its derivatives along the coordinates.
    pub jacobian: Matrix<D>,
    /// Its derivatives along the parameter; zero where none varies.
    pub by_parameter: [f64; D],
    /// The events in order, where they are asked for.
    pub events: Vec<E>,
    /// How far the local extremum that is nearest to the surface that it may touch is below it.
    pub margin: Option<Margin<D>>,
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

/// Computes returns; the bits do not depend on who does.
pub trait Integrator<M: System<D>, const D: usize> {
    /// The return that is asked for.
    fn passage(&self, request: ReturnRequest<M, D>) -> Result<Passage<M::Event, D>, Reason>;
}

/// Computes each return when it is asked for.
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
            _ => panic!("a section has one to six coordinates, not {D}"),
        }
    }
}

/// The returns that are asked for of systems that are alike ([`System::is_alike`]), in their order.
///
/// Guarantees: the bits of [`OneByOne`].
///
/// # Panics
/// Where the processor does not have the instructions.
pub fn passages<M: System<D>, const D: usize>(
    instructions: Instructions,
    requests: &[&ReturnRequest<M, D>],
) -> Vec<Result<Passage<M::Event, D>, Reason>> {
    instructions.run_on_a_vector(Crowd { requests })
}

/// What a motion passes until its return.
#[derive(Debug, Clone)]
pub struct Passing<L, E> {
    /// The events so far.
    pub events: Vec<E>,
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
        let (events, extrema) = (Vec::new(), Vec::new());
        Passing { events, extrema, turns: Turns::default(), elapsed: 0.0, period }
    }

    /// Takes note of a step of this length [s], of the event at its end, and of the coordinate that may touch a
    /// surface, with the surface.
    pub fn see(&mut self, (length, event): (f64, Option<E>), touching: Option<(&Series<L>, L)>) {
        self.events.extend(event);
        if let Some((coordinate, surface)) = touching {
            let Passing { turns, extrema, elapsed, period, .. } = self;
            turns.during(coordinate, (length, event), |time, value| {
                let time = (*elapsed + time) / *period;
                extrema.push(Extremum { margin: surface - value, time });
            });
        }
        self.elapsed += length;
    }
}

impl<M: System<D>, const D: usize> ReturnRequest<M, D> {
    /// The value of a parameter.
    fn value(&self, parameter: M::Parameter) -> f64 {
        match self.along {
            Some((along, value, _)) if along == parameter => value,
            _ => self.system.value(parameter),
        }
    }

    /// The derivative of a parameter along the one that varies.
    fn seed(&self, parameter: M::Parameter) -> f64 {
        match self.along {
            Some((along, _, unit)) if along == parameter => unit,
            _ => 0.0,
        }
    }
}

/// The number that a lane holds, with its derivatives.
fn one<L: Lane, const U: usize>(lanes: &Dual<L, U>, lane: usize) -> Dual<f64, U> {
    let gradient = std::array::from_fn(|i| lanes.gradient[i].lane(lane));
    Dual { value: lanes.value.lane(lane), gradient }
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
        coordinate.gradient[i] = request.units[i];
    }
    let autonomous = M::Single::AUTONOMOUS;
    let mut excursion: f64 = if autonomous { 0.0 } else { f64::INFINITY };
    let metric = request.system.metric();
    let mut passing = Passing::<Dual<f64, U>, M::Event>::new(system.period().value);
    let end = returned(&system, from, &request.cycles, |step| {
        if !request.watched {
            return;
        }
        if autonomous {
            let here = M::In::<Dual<f64, U>>::point(&system.at(&step.jet, Dual::splat(0.0)));
            let here = here.map(|coordinate| coordinate.value);
            excursion = excursion.max(metric.distance(&here, &request.point));
        }
        let event = M::Event::from_code(step.event.value);
        passing.see((step.length.value, event), system.touching(&step.jet));
    })?;
    Ok(told(end, passing, excursion))
}

/// The return that ends so, with what was passed.
fn told<E, const D: usize, const U: usize>(
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
        by_parameter: end.map(|it| it.gradient[D]),
        events: passing.events,
        margin,
        excursion,
    }
}

struct Crowd<'a, M: System<D>, const D: usize> {
    requests: &'a [&'a ReturnRequest<M, D>],
}

impl<M: System<D>, const D: usize> Work for Crowd<'_, M, D> {
    type Output = Vec<Result<Passage<M::Event, D>, Reason>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        // What is never reached is not compiled.
        let few = self.requests.len() * WORTHWHILE <= L::WIDTH;
        if const { L::WIDTH == 1 || M::Single::AUTONOMOUS } || few {
            let alone = |it: &&ReturnRequest<M, D>| OneByOne.passage((*it).clone());
            return self.requests.iter().map(alone).collect();
        }
        let mut found = Vec::with_capacity(self.requests.len());
        for group in self.requests.chunks(L::WIDTH) {
            if !can_share(group) {
                found.extend(group.iter().map(|it| OneByOne.passage((*it).clone())));
                continue;
            }
            match const { D } {
                1 => together::<L, M, D, 2>(group, &mut found),
                2 => together::<L, M, D, 3>(group, &mut found),
                3 => together::<L, M, D, 4>(group, &mut found),
                4 => together::<L, M, D, 5>(group, &mut found),
                5 => together::<L, M, D, 6>(group, &mut found),
                6 => together::<L, M, D, 7>(group, &mut found),
                _ => panic!("a section has one to six coordinates, not {D}"),
            }
        }
        found
    }
}

/// Whether there are lanes for these returns: derivatives along a parameter are known where nothing but parameters
/// differs.
fn can_share<M: System<D>, const D: usize>(requests: &[&ReturnRequest<M, D>]) -> bool {
    let first = &requests[0].system;
    requests.iter().all(|it| it.along.is_none())
        || requests.iter().all(|it| it.system.shares_all_but_parameters(first))
}

/// The systems of the returns, each in its lane.
#[inline(always)]
fn in_lanes<L: Lane, M: System<D>, const D: usize, const U: usize>(
    requests: &[&ReturnRequest<M, D>],
) -> M::In<Dual<L, U>> {
    let of = |lane: usize| requests[lane.min(requests.len() - 1)];
    if requests.iter().any(|it| it.along.is_some()) {
        return of(0).system.system(|parameter| {
            let mut dual = Dual::<L, U>::constant(L::from_fn(|lane| of(lane).value(parameter)));
            dual.gradient[D] = L::from_fn(|lane| of(lane).seed(parameter));
            dual
        });
    }
    let mut system = M::In::<Dual<L, U>>::splat(&of(0).system.single());
    for (lane, it) in requests.iter().enumerate() {
        system.put(lane, &it.system.single());
    }
    system
}

/// A return in a lane.
struct Occupant<E, const U: usize> {
    passing: Passing<Dual<f64, U>, E>,
    cycles: u64,
    /// Steps of the cycle.
    steps: u64,
}

/// As many returns as there are lanes, or fewer.
#[inline(always)]
fn together<L: Lane, M: System<D>, const D: usize, const U: usize>(
    requests: &[&ReturnRequest<M, D>],
    found: &mut Vec<Result<Passage<M::Event, D>, Reason>>,
) {
    let of = |lane: usize| requests[lane.min(requests.len() - 1)];
    let alike = |it: &&ReturnRequest<M, D>| it.system.is_alike(&of(0).system);
    assert!(requests.iter().all(alike), "motions side by side are alike");
    let system = in_lanes::<L, M, D, U>(requests);
    let from = std::array::from_fn(|i| {
        let mut dual = Dual::<L, U>::constant(L::from_fn(|lane| of(lane).point[i]));
        dual.gradient[i] = L::from_fn(|lane| of(lane).units[i]);
        dual
    });
    let until = system.period();
    let mut motion = Motion::begun(&system, Dual::splat(0.0), M::In::<Dual<L, U>>::state(from));
    let mut step = Step::default();
    let mut occupants: Vec<Option<Occupant<M::Event, U>>> = (0..requests.len())
        .map(|lane| {
            let passing = Passing::new(until.lane(lane));
            Some(Occupant { passing, cycles: 0, steps: 0 })
        })
        .collect();
    let first = found.len();
    found.extend(requests.iter().map(|_| Err(Reason::TooManySteps)));
    let tolerance = of(0).cycles.tolerance;
    let equal = |it: &&ReturnRequest<M, D>| it.cycles.tolerance == tolerance;
    assert!(requests.iter().all(equal), "one tolerance serves all lanes");
    let mut first_steps = MAX_GUARDS;
    while occupants.iter().any(Option::is_some) {
        let (to, tolerance) =
            if first_steps > 0 { (Dual::splat(0.0), 1.0) } else { (until, tolerance) };
        motion.step(&system, to, tolerance, &mut step);
        if first_steps > 0 {
            first_steps -= 1;
            continue;
        }
        let broken = motion.broken(&system).bits();
        let arrives = step.arrives.bits();
        for (lane, place) in occupants.iter_mut().enumerate() {
            let Some(occupant) = place else { continue };
            occupant.steps += 1;
            if of(lane).watched {
                occupant.see(&system, &step, lane);
            }
            if broken >> lane & 1 != 0 {
                let why = motion.breakdown(&system, lane).map(Reason::from);
                found[first + lane] = Err(why.unwrap_or(Reason::TooManySteps));
                *place = None;
            } else if arrives >> lane & 1 != 0 {
                occupant.cycles += 1;
                occupant.steps = 0;
                if occupant.cycles >= of(lane).cycles.count
                    && let Some(Occupant { passing, .. }) = place.take()
                {
                    let end = M::In::<Dual<L, U>>::point(&motion.state);
                    let end = std::array::from_fn(|i| one(&end[i], lane));
                    found[first + lane] = Ok(told(end, passing, f64::INFINITY));
                }
            } else if occupant.steps >= STEPS_PER_CYCLE {
                *place = None;
            }
        }
        if step.arrives.any() {
            motion.begin_cycle(step.arrives);
        }
    }
}

impl<E: Event, const U: usize> Occupant<E, U> {
    /// Takes note of what the motion in a lane passes in a step.
    #[inline(always)]
    fn see<L: Lane, S>(&mut self, system: &S, step: &Step<Dual<L, U>, S>, lane: usize)
    where
        S: Switched<Dual<L, U>, Event = E>,
    {
        let event = E::from_code(step.event.lane(lane));
        let length = step.length.lane(lane);
        let Some((coordinate, surface)) = system.touching(&step.jet) else {
            return self.passing.see((length, event), None);
        };
        let mut own = series::zero();
        for (own, lanes) in own.iter_mut().zip(coordinate) {
            *own = one(lanes, lane);
        }
        self.passing.see((length, event), Some((&own, one(&surface, lane))));
    }
}
