//! The integrator's two forms at once: what a test follows alone is followed among others in lanes too, to
//! the same bits.

use std::marker::PhantomData;

use capsulemap_engine::flow::{Event, Motion, Step, Switched};
use capsulemap_engine::lane::{Instructions, Lane, Mask, SideBySide, Work};
use capsulemap_engine::orbit::Protocol;
use capsulemap_models::capsule::{
    self, AsPrinted, CapsuleParameters as _, CapsuleState as _, Case, EventKind, Filippov, Form,
    General, Orbit, OverFolds, Parameter, Parameters, Reading, Simulation, State,
};
use capsulemap_models::description::Presence;
use capsulemap_models::model::CaseQueue;
use capsulemap_models::of::model_of;

/// [`capsule::simulate`], compared with the same case in the last lane of a vector of others.
pub fn simulate(
    parameters: &Parameters,
    phase: f64,
    start: State<f64>,
    cycles: u64,
    tolerance: f64,
) -> Simulation {
    simulate_by(&[Instructions::widest()], parameters, phase, start, cycles, tolerance)
}

/// The same, compared in the lanes of all these instructions.
pub fn simulate_by(
    instructions: &[Instructions],
    parameters: &Parameters,
    phase: f64,
    start: State<f64>,
    cycles: u64,
    tolerance: f64,
) -> Simulation {
    let alone = capsule::simulate(parameters, phase, start, cycles, tolerance);
    let case = Case::at_section(parameters.clone(), start, phase);
    let bits = |state: [f64; 4]| state.map(f64::to_bits);
    let states: Vec<_> = alone.section.iter().map(|s| bits([s.r, s.y1, s.x2, s.y2])).collect();
    let events: Vec<_> = alone.events.iter().map(|event| (event.t.to_bits(), event.kind)).collect();
    let expected = (states, events);
    for instructions in instructions {
        let others = match parameters.form() {
            Form::Filippov => among_others::<Filippov, 3>(*instructions, &case, cycles, tolerance),
            Form::AsPrinted => {
                among_others::<AsPrinted, 3>(*instructions, &case, cycles, tolerance)
            }
            Form::General => among_others::<General, 3>(*instructions, &case, cycles, tolerance),
            Form::OverFolds => {
                among_others::<OverFolds, 4>(*instructions, &case, cycles, tolerance)
            }
        };
        assert!(others == expected, "{} lanes, another motion: {case:?}", instructions.name());
    }
    alone
}

/// [`capsule::settle`], compared with the same case side by side with others.
pub fn settle(
    parameters: &Parameters,
    phase: f64,
    start: State<f64>,
    protocol: &Protocol,
) -> Orbit {
    let alone = capsule::settle(parameters, phase, start, protocol);
    let case = Case::at_section(parameters.clone(), start, phase);
    let among = among(&case, protocol);
    // Text, because a number that is not known does not equal itself.
    assert_eq!(format!("{alone:?}"), format!("{among:?}"), "in lanes another orbit: {case:?}");
    alone
}

/// What a case settles to among others.
fn among(case: &Case, protocol: &Protocol) -> Orbit {
    let mut queue = CaseAmongOthers { case, given: 0, orbit: None };
    // By the door, as the lanes of the capsule are compiled there already.
    let model = model_of(&case.parameters);
    model.settle_queue(Instructions::widest(), protocol, None, &mut queue);
    queue.orbit.expect("the case has been in the lanes to its end")
}

/// Another case of the same shape.
fn neighbour(case: &Case, number: usize) -> Case {
    let mut other = super::draws::cases(1, number as u64).remove(0);
    let drawn = std::mem::replace(&mut other.parameters, case.parameters.clone());
    for &parameter in Parameter::ALL {
        if parameter.presence() == Presence::Always {
            other.parameters[parameter] = drawn[parameter];
        }
    }
    other
}

/// A queue that gives one case, and then others until it is finished.
struct CaseAmongOthers<'a> {
    case: &'a Case,
    given: usize,
    orbit: Option<Orbit>,
}

impl CaseQueue for CaseAmongOthers<'_> {
    fn next(&mut self, done: Option<(usize, Orbit)>) -> Option<(usize, Case)> {
        if let Some((0, orbit)) = done {
            self.orbit = Some(orbit);
        }
        let number = self.given;
        self.given += 1;
        match number {
            0 => Some((0, self.case.clone())),
            _ if self.orbit.is_none() => Some((number, neighbour(self.case, number))),
            _ => None,
        }
    }
}

fn among_others<R: Reading<D>, const D: usize>(
    instructions: Instructions,
    case: &Case,
    cycles: u64,
    tolerance: f64,
) -> Course {
    instructions.run(Among::<R, D> { case, cycles, tolerance, reading: PhantomData })
}

/// A case in the last lane, with others before it.
struct Among<'a, R, const D: usize> {
    case: &'a Case,
    cycles: u64,
    tolerance: f64,
    reading: PhantomData<R>,
}

type Course = (Vec<[u64; 4]>, Vec<(u64, EventKind)>);

impl<R: Reading<D>, const D: usize> Work for Among<'_, R, D> {
    /// States at the section and events, until the case is done or cannot go on.
    type Output = Course;

    #[inline(always)]
    fn run<L: Lane>(self) -> Course {
        let last = L::WIDTH - 1;
        let cases: Vec<Case> =
            (0..last).map(|lane| neighbour(self.case, lane)).chain([self.case.clone()]).collect();
        let own = R::single(&self.case.parameters, self.case.section_phase);
        let mut system = R::In::<L>::splat(&own);
        let mut motion =
            Motion::<L, R::In<L>>::splat(&Motion::new(&own, 0.0, self.case.start.capsule()));
        for (lane, case) in cases.iter().enumerate() {
            let one = R::single(&case.parameters, case.section_phase);
            system.put(lane, &one);
            motion.put(lane, &Motion::new(&one, 0.0, case.start.capsule()));
        }
        let periods = system.period();
        let period = periods.lane(last);
        let section = |state: State<f64>| [state.r, state.y1, state.x2, state.y2].map(f64::to_bits);
        let mut states = vec![section(motion.state.lane(last))];
        let mut events = Vec::new();
        let mut step = Step::default();
        while states.len() as u64 <= self.cycles {
            motion.step(&system, periods, self.tolerance, &mut step);
            let begun = (states.len() - 1) as f64 * period;
            if let Some(kind) = EventKind::from_code(step.event.lane(last)) {
                let t = begun + (step.start.lane(last) + step.length.lane(last));
                events.push((t.to_bits(), kind));
            }
            if motion.broken(&system).lane(last) {
                break;
            }
            let ended = periods.le(motion.time);
            if ended.lane(last) {
                states.push(section(motion.state.lane(last)));
            }
            motion.begin_cycle(&system, ended);
        }
        (states, events)
    }
}
