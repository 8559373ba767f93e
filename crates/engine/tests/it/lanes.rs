//! The same source serves one case or many side by side, to the same bits.

use capsulemap_engine::flow::{Motion, Reason, Step, Switched as _};
use capsulemap_engine::lane::{Instructions, Lane, Mask, SideBySide, Work};
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::{
    Capsule, CapsuleParameters as _, CapsuleState as _, Case, Orbit, Parameter, Parameters,
    Resistance, State, settle, settle_case,
};

use super::draws;

const CYCLES: usize = 10;

/// Cases with every mode among them, whose events fall at different times.
fn cases(count: usize) -> Vec<(Parameters, State<f64>)> {
    (0..count)
        .map(|i| {
            let mut p = Parameters::default();
            let share = i as f64 / count as f64;
            p[Parameter::Omega] = 15.0 + 120.0 * share;
            p[Parameter::Pd] = 1.0 + ((7 * i) % 11) as f64 * 0.6;
            p[Parameter::K2] = 1e3 + ((5 * i) % 13) as f64 * 6e3;
            p[Parameter::Delta] = ((3 * i) % 7) as f64 * 6e-4;
            p[Parameter::MuS] = 0.3 + 0.5 * share;
            let y2 = if i % 3 == 0 { 0.05 } else { 0.0 };
            (p, State::of([-1e-3 * share, 0.1 * share, 0.0, y2]))
        })
        .collect()
}

/// The state at the end of each cycle and the time of each event, as bits.
fn alone(p: &Parameters, start: State<f64>) -> (Vec<[u64; 4]>, Vec<u64>) {
    let system = Capsule::single(p, 0.0);
    let mut motion = Motion::new(&system, 0.0, start);
    let mut step = Step::default();
    let (mut states, mut events) = (Vec::new(), Vec::new());
    while states.len() < CYCLES {
        motion.step(&system, p.drive_period(), 1e-12, &mut step);
        if step.event != 0.0 {
            events.push(motion.time.to_bits());
        }
        if motion.time >= p.drive_period() {
            motion.begin_cycle(&system, true);
            states.push(bits(&motion.state));
        }
    }
    (states, events)
}

fn bits(state: &State<f64>) -> [u64; 4] {
    [state.r, state.y1, state.x2, state.y2].map(f64::to_bits)
}

/// The same for every case of a list, side by side, as many as the lanes are.
struct Together<'a>(&'a [(Parameters, State<f64>)]);

impl Work for Together<'_> {
    type Output = Vec<(Vec<[u64; 4]>, Vec<u64>)>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        // A loop, as what iterators call is compiled without the instructions of the lanes.
        let mut found = Vec::with_capacity(self.0.len());
        for cases in self.0.chunks(L::WIDTH) {
            found.extend(side_by_side::<L>(cases));
        }
        found
    }
}

/// Up to `L::WIDTH` cases, each lane with its own time, step and mode; spare lanes repeat the first case.
#[inline(always)]
fn side_by_side<L: Lane>(cases: &[(Parameters, State<f64>)]) -> Vec<(Vec<[u64; 4]>, Vec<u64>)> {
    let of = |lane: usize| cases.get(lane).unwrap_or(&cases[0]);
    let one = |lane: usize| Capsule::single(&of(lane).0, 0.0);
    let begun = |lane: usize| Motion::new(&one(lane), 0.0, of(lane).1);
    let mut system = Capsule::<L>::splat(&one(0));
    let mut motion = Motion::<L, Capsule<L>>::splat(&begun(0));
    for lane in 0..L::WIDTH {
        system.put(lane, &one(lane));
        motion.put(lane, &begun(lane));
    }
    let periods = system.period();
    let mut step = Step::default();
    let mut found = vec![(Vec::new(), Vec::new()); cases.len()];
    while found.iter().any(|(states, _)| states.len() < CYCLES) {
        motion.step(&system, periods, 1e-12, &mut step);
        let ended = periods.le(motion.time);
        for (lane, (states, events)) in found.iter_mut().enumerate() {
            if states.len() == CYCLES {
                continue;
            }
            if step.event.lane(lane) != 0.0 {
                events.push(motion.time.lane(lane).to_bits());
            }
            if ended.lane(lane) {
                states.push(bits(&motion.state.lane(lane)));
            }
        }
        if ended.any() {
            motion.begin_cycle(&system, ended);
        }
    }
    found
}

#[test]
fn a_case_has_the_same_bits_alone_and_among_others() {
    let cases = cases(48);
    let expected: Vec<_> = cases.iter().map(|(p, start)| alone(p, *start)).collect();
    assert!(expected.iter().filter(|(_, events)| events.len() > 10).count() > 30);
    for instructions in Instructions::available() {
        assert!(instructions.run(Together(&cases)) == expected, "{}", instructions.name());
        // In another order, beside other neighbours.
        let backward: Vec<_> = cases.iter().rev().cloned().collect();
        let mut found = instructions.run(Together(&backward[5..]));
        found.reverse();
        assert!(found == expected[..43], "{}", instructions.name());
    }
}

#[test]
fn an_orbit_has_the_same_bits_by_any_instructions_and_in_any_order() {
    let mut cases = draws::cases(150, 5);
    // One that cannot be followed; some that do not settle are among the others.
    cases[40].start = State { r: 1e300, ..cases[40].start.capsule() }.into();
    let protocol = Protocol {
        max_cycles: 300,
        measured_cycles: 8,
        exponent_cycles: 400,
        ..Protocol::default()
    };
    let written = |orbits: &[Orbit]| -> Vec<String> {
        orbits.iter().map(|orbit| format!("{orbit:?}")).collect()
    };
    let alone: Vec<Orbit> = cases
        .iter()
        .map(|Case { parameters, start, section_phase: phase, .. }| {
            settle(parameters, *phase, start.clone(), &protocol)
        })
        .collect();
    let outcomes = |outcome| alone.iter().filter(|orbit| orbit.outcome == outcome).count();
    let wander = outcomes(Outcome::Undecided) + outcomes(Outcome::Chaotic);
    assert!(outcomes(Outcome::Failed) == 1 && wander > 1);
    let expected = written(&alone);
    for instructions in Instructions::available() {
        let found = written(&draws::settled(&cases, &protocol, instructions));
        assert!(found == expected, "{}", instructions.name());
        let backward: Vec<Case> = cases.iter().rev().cloned().collect();
        let mut found = written(&draws::settled(&backward, &protocol, instructions));
        found.reverse();
        assert!(found == expected, "{} backward", instructions.name());
    }
}

#[test]
fn a_case_has_so_many_steps_and_no_more_by_any_instructions() {
    let cases = draws::wide(200, 31, Resistance::CoulombStribeck);
    let usual = Protocol { max_cycles: 100, exponent_cycles: 64, ..Protocol::default() };
    let unlimited = draws::settled(&cases, &usual, Instructions::widest());
    let mut ended = [0, 0];
    for max_steps in [1, 100, 3000, 10_000, 100_000] {
        let protocol = Protocol { max_steps, ..usual };
        let alone: Vec<Orbit> = cases.iter().map(|case| settle_case(case, &protocol)).collect();
        for (limited, free) in alone.iter().zip(&unlimited) {
            match &limited.failure {
                Some(failure) => {
                    assert!(failure.reason == Reason::OutOfSteps, "{failure}");
                    assert_eq!(limited.outcome, Outcome::Failed);
                    // A cycle has a step at least.
                    assert!(limited.cycles <= max_steps);
                    ended[0] += 1;
                }
                // What is done in time is what it is without a limit.
                None => {
                    assert_eq!(format!("{limited:?}"), format!("{free:?}"));
                    ended[1] += 1;
                }
            }
        }
        let alone = format!("{alone:?}");
        for instructions in Instructions::available() {
            let found = format!("{:?}", draws::settled(&cases, &protocol, instructions));
            assert!(found == alone, "{max_steps} steps, {}", instructions.name());
        }
    }
    assert!(ended.iter().all(|&cases| cases > 200), "{ended:?}");
}

#[test]
fn the_bits_are_those_of_every_machine() {
    // One number over all bits, as computed on x86-64 with AVX-512; a change of the integrator changes it on
    // purpose, another machine or compiler must not.
    let mut digest: u64 = 0xcbf2_9ce4_8422_2325;
    for (p, start) in cases(48) {
        let (states, events) = alone(&p, start);
        for bits in states.into_iter().flatten().chain(events) {
            digest = (digest ^ bits).wrapping_mul(0x0100_0000_01b3);
        }
    }
    assert_eq!(digest, 0x9de3_3f2e_46a6_ab10, "{digest:#018x}");
}
