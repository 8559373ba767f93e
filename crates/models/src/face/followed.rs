//! A case followed from its start, cycle by cycle.

use capsulemap_engine::flow::{Event as _, Observer as _, Switched as _, System};
use capsulemap_engine::orbit::{self, Trajectory};

use super::{Face, engine_case, explained};
use crate::motion::{Case, Event, Sample, Simulation, SimulationSize};

/// A motion at the end of a cycle.
pub struct AtSection<S, O> {
    /// Cycles since the first section.
    pub cycle: u64,
    /// Time since the start [s].
    pub time: f64,
    /// Where it is.
    pub state: S,
    /// What was observed since the start.
    pub observed: O,
}

/// An event.
pub struct AtEvent<E, S> {
    /// Time since the start [s].
    pub time: f64,
    /// What it is.
    pub event: E,
    /// The state before it.
    pub state: S,
}

/// A case in full, in the types of its system.
pub struct Followed<M: System<D>, const D: usize> {
    /// It at each section.
    pub section: Vec<AtSection<M::State<f64>, M::Observer>>,
    /// Every event in order.
    pub events: Vec<AtEvent<M::Event, M::State<f64>>>,
    /// Why it stopped early, if it did.
    pub failure: Option<orbit::Failure<M::State<f64>>>,
}

impl<M: System<D>, const D: usize> Followed<M, D> {
    /// Adds the section that a motion is at, with what was observed of it.
    fn add_section(&mut self, trajectory: &Trajectory<'_, M::Single, D>, observed: M::Observer) {
        self.section.push(AtSection {
            cycle: trajectory.progress.cycles,
            time: trajectory.cycle_began(),
            state: trajectory.state(),
            observed,
        });
    }
}

/// Follows a case from its start to the first section, and for so many cycles from there, no further than to the last section
/// before which it has no more events than `most` says.
pub fn followed<M: Face<D>, const D: usize>(
    case: &Case,
    most: SimulationSize,
    tolerance: f64,
) -> Followed<M, D> {
    let orbit::Case { system, start, begins } = engine_case::<M, D>(case);
    let single = system.single();
    let mut observer = system.observer(0);
    let mut trajectory = Trajectory::begun(&single, start, begins, tolerance);
    let mut followed = Followed { section: Vec::new(), events: Vec::new(), failure: None };
    loop {
        let began = trajectory.cycle_began();
        if trajectory.is_at_section() {
            followed.add_section(&trajectory, observer.clone());
        }
        if followed.section.len() as u64 > most.cycles {
            break;
        }
        let before = followed.events.len();
        let cycle = trajectory.cycle(|step| {
            observer.see(&single, step);
            if let Some(event) = M::Event::from_code(step.event) {
                let state = single.at(&step.jet, step.length);
                let time = began + (step.start + step.length);
                followed.events.push(AtEvent { time, event, state });
            }
        });
        if let Err(why) = cycle {
            followed.failure = Some(explained::<M, D>(why, case));
            break;
        }
        if followed.events.len() > most.events {
            followed.events.truncate(before);
            break;
        }
    }
    followed
}

/// The same, as the model describes it.
pub fn simulate<M: Face<D>, const D: usize>(
    case: &Case,
    most: SimulationSize,
    tolerance: f64,
) -> Simulation {
    let system = M::of(&case.parameters, case.section_phase);
    let Followed { section, events, failure } = followed::<M, D>(case, most, tolerance);
    let section = section.into_iter().map(|it| Sample {
        cycle: it.cycle,
        time: it.time,
        state: system.told(&it.state),
        sums: M::sums(&it.observed),
        counts: M::counts(&it.observed),
    });
    let events = events.into_iter().map(|it| Event {
        time: it.time,
        number: it.event.number(),
        state: system.told(&it.state),
    });
    Simulation {
        section: section.collect(),
        events: events.collect(),
        failure: failure.map(|it| it.map(|state| system.told(&state))),
    }
}
