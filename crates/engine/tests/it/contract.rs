//! What every system owes the integrator: the laws that six of them are checked by, and that one which hides a
//! scale from the step control is found out.

mod lanes;
mod maps;
mod orbits;
mod steps;
mod subject;
pub mod systems;

use capsulemap_engine::flow::{Field, Motion, Step, Stroboscopic};

use capsulemap_engine::flow::defect::defect;
use capsulemap_engine::flow::metric::greater;
use capsulemap_engine::orbit::{Outcome, Proof, Protocol};
use capsulemap_models::capsule::{
    Capsule, CapsuleParameters as _, CapsuleState as _, Case, Output, Parameter, Parameters,
    PrintedCapsule, Resistance, State, settle_as,
};

use super::den_hartog::DryFriction;
use super::draws;
use super::exponents::Duffing;
use super::forms::settle;
use super::oscillators::Impact;
use super::unbounded::Blind;

const TOLERANCE: f64 = 1e-12;
/// The defect of a step is that of the terms left out: of the order of the tolerance.
const SOUND: f64 = 1e4 * TOLERANCE;

/// The largest defect of a step over so many cycles, relative to the largest coordinate met.
fn largest_defect<S: Field>(system: &S, start: S::State, cycles: u32) -> f64 {
    let period = system.period();
    let mut motion = Motion::new(system, 0.0, start);
    let mut step = Step::default();
    let (mut largest, mut size, mut done) = (0.0, 0.0_f64, 0);
    while done < cycles {
        motion.step(system, period, TOLERANCE, &mut step);
        assert_eq!(motion.breakdown(system, &step, 0), None);
        largest = greater(largest, defect(system, &step));
        let begins = S::coordinates(&system.beginning(&step.jet));
        for (x, weight) in begins.as_ref().iter().zip(system.weights().as_ref()) {
            size = size.max((weight * x).abs());
        }
        if motion.time >= period {
            motion.begin_cycle(system, true);
            done += 1;
        }
    }
    if largest == 0.0 { 0.0 } else { largest / size }
}

#[test]
fn the_steps_of_every_system_satisfy_its_equations() {
    let impact = Impact {
        k: 1.0,
        c: 0.05,
        drive: 1.0,
        omega: 2.6,
        gravity: 0.0,
        stop: 0.1,
        restitution: 0.8,
    };
    let start = Impact::<f64>::state([0.0, 0.3]);
    let found = largest_defect(&impact, start, 200);
    assert!(found < 1e-10, "rigid impact: {found:e}");

    let dry = DryFriction { omega: 0.45, friction: 0.4 };
    let start = DryFriction::<f64>::state([0.1, 0.0]);
    let found = largest_defect(&dry, start, 50);
    assert!(found < 1e-10, "dry friction: {found:e}");

    let start = <Duffing as Stroboscopic<f64, 2>>::state([0.1, 0.1]);
    let found = largest_defect(&Duffing, start, 200);
    assert!(found < 1e-10, "Duffing: {found:e}");
}

#[test]
fn the_steps_of_the_capsule_satisfy_its_equations_over_the_whole_box() {
    for (_, law) in Resistance::NAMES {
        for case in draws::wide(150, 12, law) {
            let Case { parameters, start, section_phase: phase, .. } = &case;
            let capsule = Capsule::single(parameters, *phase);
            let found = largest_defect(&capsule, start.capsule(), 5);
            assert!(found < SOUND, "{found:e}: {case:?}");
            // As printed a capsule without static friction would switch at F = 0 without end.
            if parameters.drag().static_limit > 0.0 {
                let printed = PrintedCapsule::single(parameters, *phase);
                let found = largest_defect(&printed, start.capsule(), 5);
                assert!(found < SOUND, "as printed {found:e}: {case:?}");
            }
        }
    }
}

/// A capsule whose steps, paced by its series alone, jump over the layer around rest.
pub fn example() -> Case {
    let parameters = Parameters::with(&[
        (Parameter::Omega, 20.0),
        (Parameter::Pd, 8.0),
        (Parameter::K2, 2420.0),
        (Parameter::Delta, 3.5e-3),
        (Parameter::M2, 0.2),
        (Parameter::MuS, 0.33),
        (Parameter::MuD, 0.165),
        (Parameter::Vs, 0.002),
    ]);
    Case::at_section(parameters, State::default(), 0.0)
}

#[test]
fn a_layer_that_steps_jump_over_is_refused_a_certificate() {
    let case = example();
    let Case { parameters, start, section_phase: phase, .. } = &case;
    let protocol = Protocol::default();
    let orbit = settle_as::<Blind>(&case, &protocol);
    // Its energies balance and its section repeats: the series agree with themselves.
    assert!(orbit.outputs[Output::EnergyResidual].abs() < 1e-12);
    assert!(orbit.outputs[Output::SectionResidual] < 1e-11);
    assert!(orbit.outputs[Output::ProgressionSpeed] > 1e-4);
    assert!(orbit.outputs[Output::IntegrationDefect] > 1e-3);
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Undecided, 0));
    assert_eq!(orbit.certificate.proof, Proof::None);

    let orbit = settle(parameters, *phase, start.capsule(), &protocol);
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    assert!(orbit.outputs[Output::IntegrationDefect] < 1e-10);
    // The limit of the reference in 80 bits after 300 cycles (own.cpp, tolerance 1e-17).
    let speed = orbit.outputs[Output::ProgressionSpeed];
    assert!((speed + 2.283_396_033_344_7e-4).abs() < 1e-12, "{speed:e}");
}

#[test]
fn a_sound_orbit_is_certified_at_every_tolerance() {
    let tolerances = [1e-14, 1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4];
    let cases: Vec<Case> = std::iter::once(example()).chain(draws::cases(12, 8)).collect();
    for case in &cases {
        let Case { parameters, start, section_phase: phase, .. } = case;
        for tolerance in tolerances {
            let protocol = Protocol::with_tolerance(tolerance);
            let orbit = settle(parameters, *phase, start.capsule(), &protocol);
            assert_eq!(orbit.outcome, Outcome::Periodic, "{tolerance:e}: {case:?}");
        }
    }
}

#[test]
fn no_blind_step_is_certified_over_the_whole_box() {
    let protocol = Protocol { exponent_cycles: 0, measured_cycles: 1, ..Protocol::default() };
    let (mut wrong, mut refused) = (0, 0);
    for case in draws::wide(120, 5, Resistance::CoulombStribeck) {
        let Case { parameters, start, section_phase: phase, .. } = &case;
        let seeing =
            capsulemap_models::capsule::settle(parameters, *phase, start.capsule(), &protocol);
        let blind = settle_as::<Blind>(&case, &protocol);
        let [right, found] = [&seeing, &blind].map(|it| it.outputs[Output::ProgressionSpeed]);
        let size = seeing.section.iter().flatten().fold(0.0_f64, |size, x| size.max(x.abs()));
        let is_isolated = seeing.certificate.proof == Proof::Newton;
        if is_isolated && (found - right).abs() > 1e-6 * size {
            wrong += 1;
            refused += usize::from(blind.certificate.proof == Proof::None);
        }
    }
    println!("{wrong} wrong speeds, {refused} of them refused");
    assert!(wrong >= 5 && refused == wrong, "{refused} of {wrong}");
}
