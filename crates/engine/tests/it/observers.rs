//! What is summed along a motion has the same bits in every lane form, and derivatives that are those of
//! differences.

use capsulemap_engine::flow::{Motion, Observer, Step, Stroboscopic, Switched};
use capsulemap_engine::lane::{Dual, Instructions, Lane, Mask, SideBySide, Work};
use capsulemap_engine::orbit::return_map::{Cycles, observed};
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::{
    Account, Capsule, CapsuleParameters as _, CapsuleState as _, Case, Parameter, Resistance,
    State, settle,
};

use super::differences::slope;
use super::draws;

const TOLERANCE: f64 = 1e-12;
const CYCLES: usize = 4;

/// Every sum of an account in lane `index`.
fn sums<L: Lane>(account: &Account<L>, index: usize) -> [f64; 17] {
    let energies = &account.energies;
    [
        account.time,
        energies.work_net,
        energies.work_positive,
        energies.work_absolute,
        energies.work_actuator,
        energies.friction_loss,
        energies.damper_loss,
        account.friction_impulse,
        account.stick_time,
        account.peak_contact_force,
        account.grazing_margin,
        account.touching_margin,
        account.impacts,
        account.forward_slips,
        account.backward_slips,
        account.reversals,
        account.impact_points.0.iter().fold(L::splat(0.0), |sum, (here, impact)| {
            sum + L::select(
                L::Mask::from_bits(*here),
                impact.phase * impact.y1 - impact.y2,
                L::splat(0.0),
            )
        }),
    ]
    .map(|sum| sum.lane(index))
}

/// The sums of a case over some cycles, alone.
fn alone(case: &Case) -> [u64; 17] {
    let system = Capsule::single(&case.parameters, case.section_phase);
    let mut account = Account::single(&case.parameters, 64);
    let mut motion = Motion::new(&system, 0.0, case.start.capsule());
    let mut step = Step::default();
    let mut cycles = 0;
    while cycles < CYCLES {
        motion.step(&system, system.period(), TOLERANCE, &mut step);
        account.see(&system, &step);
        if step.arrives {
            motion.begin_cycle(&system, true);
            cycles += 1;
        }
    }
    sums(&account, 0).map(f64::to_bits)
}

/// The same for cases side by side, each read where its own cycles end.
struct Together<'a>(&'a [Case]);

impl Work for Together<'_> {
    type Output = Vec<[u64; 17]>;

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

#[inline(always)]
fn side_by_side<L: Lane>(cases: &[Case]) -> Vec<[u64; 17]> {
    let of = |lane: usize| cases.get(lane).unwrap_or(&cases[0]);
    let one = |lane: usize| Capsule::single(&of(lane).parameters, of(lane).section_phase);
    let mut system = Capsule::<L>::splat(&one(0));
    let start = Motion::new(&one(0), 0.0, of(0).start.capsule());
    let mut motion = Motion::<L, Capsule<L>>::splat(&start);
    for lane in 0..L::WIDTH {
        system.put(lane, &one(lane));
        motion.put(lane, &Motion::new(&one(lane), 0.0, of(lane).start.capsule()));
    }
    let parameter = |parameter: Parameter| L::from_fn(|lane| of(lane).parameters[parameter]);
    let mut account = Account::<L>::new(parameter, of(0).parameters.shape(), 64);
    let mut step = Step::default();
    let mut cycles = vec![0; cases.len()];
    let mut found = vec![[0; 17]; cases.len()];
    while cycles.iter().any(|met| *met < CYCLES) {
        motion.step(&system, system.period(), TOLERANCE, &mut step);
        account.see(&system, &step);
        for (lane, met) in cycles.iter_mut().enumerate() {
            if step.arrives.lane(lane) {
                *met += 1;
                if *met == CYCLES {
                    found[lane] = sums(&account, lane).map(f64::to_bits);
                }
            }
        }
        motion.begin_cycle(&system, step.arrives);
    }
    found
}

#[test]
fn sums_have_the_same_bits_in_every_lane_form() {
    let mut cases = draws::cases(64, 77);
    // One law in all lanes.
    cases.retain(|case| case.parameters.resistance() == Resistance::CoulombStribeck);
    let expected: Vec<_> = cases.iter().map(alone).collect();
    for instructions in Instructions::available() {
        let found = instructions.run(Together(&cases));
        for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert_eq!(found, expected, "{}: {:?}", instructions.name(), cases[i]);
        }
    }
}

#[test]
fn the_derivatives_of_the_sums_are_those_of_differences() {
    let (mut compared, mut doubtful) = (0, 0);
    for case in draws::cases(60, 78) {
        let orbit = settle(&case.parameters, case.section_phase, &case.start, &Protocol::default());
        if orbit.outcome != Outcome::Periodic {
            continue;
        }
        let point = orbit.section[0];
        let cycles = Cycles { count: orbit.period, tolerance: 1e-13 };
        // Progression, work and losses over a period, as functions of the amplitude of the drive.
        let of = |p_d: Dual<f64, 1>| {
            let constant = |parameter| match parameter {
                Parameter::Pd => p_d,
                _ => Dual::constant(case.parameters[parameter]),
            };
            let shape = case.parameters.shape();
            let system = Capsule::new(constant, shape, case.section_phase);
            let mut account = Account::new(constant, shape, 0);
            let from = point.array().map(Dual::constant);
            observed(&system, from, &cycles, &mut account).expect("it goes on");
            let energies = account.energies;
            [
                energies.work_net,
                energies.work_positive,
                energies.work_absolute,
                energies.friction_loss,
                energies.damper_loss,
                account.friction_impulse,
            ]
        };
        let p_d = case.parameters[Parameter::Pd];
        let carried = of(Dual::variable(p_d, 0)).map(|sum| sum.gradient[0] * p_d);
        let moved = |h: f64| of(Dual::constant(p_d * (1.0 + h))).map(|sum| sum.value);
        let differences = slope(moved, 1e-3, &[1.0; 6]);
        let largest = carried.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
        if differences.doubt > 1e-8 * largest {
            doubtful += 1;
            continue;
        }
        for (carried, difference) in carried.iter().zip(differences.value) {
            let error = (carried - difference).abs();
            assert!(error < 1e-6 * largest, "{carried:e} {difference:e}: {case:?}");
        }
        compared += 1;
    }
    assert!(compared > 25, "{compared} compared, {doubtful} doubtful");
}

#[test]
fn a_point_of_the_section_is_what_the_state_shows_of_it() {
    let state = State::of([1.0, 2.0, 3.0, 4.0]);
    assert_eq!(Capsule::<f64>::point(&state), [1.0, 2.0, 4.0]);
    let moved = Capsule::<f64>::moved_to(state, [5.0, 6.0, 7.0]);
    assert_eq!(moved, State::of([5.0, 6.0, 3.0, 7.0]));
}
