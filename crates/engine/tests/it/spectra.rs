//! All Lyapunov exponents: their sum by the divergence of the field, and published ones.

use capsulemap_engine::flow::{Event as _, Motion, Reason, Step, Stroboscopic as _, System};
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::matrix::Matrix;
use capsulemap_engine::orbit::passage::{Integrator, OneByOne, ReturnRequest};
use capsulemap_engine::orbit::passages::passages;
use capsulemap_engine::orbit::return_map::{Cycles, returned};
use capsulemap_engine::orbit::spectrum::{Spectrum, kaplan_yorke};
use capsulemap_engine::orbit::{
    Case, Exponents, Machine, OrbitOf, Outcome, Protocol, settle, settle_all,
};
use capsulemap_models::capsule::state::EventKind;
use capsulemap_models::capsule::{
    CapsuleParameters as _, CapsuleSystem, Filippov, General, Locomotion as _, OverFolds,
    Parameter, Parameters, Reading, Resistance, State,
};
use capsulemap_models::face::engine_case;
use capsulemap_models::motion;

use super::draws;
use super::exponents::Duffing;
use super::volumes::{Share, volume};

/// All exponents are asked for.
fn asking() -> Protocol {
    Protocol { exponents: Exponents::All, ..Protocol::default() }
}

/// The cycles over which volumes are compared.
const CYCLES: usize = 3;

/// A request for what so many cycles make of directions from a point on.
fn request<M: System<D>, const D: usize>(
    system: &M,
    point: [f64; D],
    count: u64,
) -> ReturnRequest<M, D> {
    // Orthonormal, and none along a coordinate.
    let length = D as f64;
    let reflected: Matrix<D> = std::array::from_fn(|i| {
        std::array::from_fn(|j| f64::from(u8::from(i == j)) - 2.0 / length)
    });
    ReturnRequest {
        system: system.clone(),
        along: None,
        point,
        units: system.metric().scales.map(|scale| 1.0 / scale),
        cycles: Cycles { count, tolerance: 1e-12 },
        watched: false,
        directions: Some(reflected),
    }
}

/// The logarithm of what some cycles make of a volume, by the directions that go with the motion.
fn stretched<M: System<D>, const D: usize>(system: &M, point: [f64; D]) -> Result<f64, Reason> {
    let passage = OneByOne.passage(request(system, point, CYCLES as u64))?;
    Ok(passage.stretches.iter().flat_map(|it| it.logs).sum())
}

/// The same by the equations: damped and elastic stops leave the field's normal part continuous, a rigid one multiplies with the square
/// of its restitution, a reversal with the acceleration after over that before; rest, and a contact that holds, leave nothing.
fn by_equations<R: Reading<D>, const D: usize>(system: &CapsuleSystem<R>, point: [f64; D]) -> f64 {
    let p: &Parameters = &system.parameters;
    let single = system.single();
    let is_rigid = p.shape().is_rigid();
    let mode = |step: &Step<f64, R::Single>| {
        let rests = single.direction(&step.mode) == 0.0;
        let motion = single.jet(&step.jet);
        let holds = is_rigid && motion.r[0] == p[Parameter::Delta] && motion.r[1] == 0.0;
        if rests || holds || p.shape().drive.is_prescribed() { Share::Lost } else { Share::Stays }
    };
    let event = |step: &Step<f64, R::Single>, _: &State<f64>| match EventKind::from_code(step.event)
    {
        Some(EventKind::Reversal) => Share::Turns(2),
        Some(EventKind::ContactClosed) if is_rigid => {
            Share::Times(p[Parameter::Restitution].powi(2))
        }
        _ => Share::Stays,
    };
    volume(&single, point, CYCLES, mode, event)
}

/// What has been compared.
#[derive(Debug, Default)]
struct Compared {
    all: usize,
    lost: usize,
    worst: f64,
    /// Motions that cannot be followed without directions either.
    unfollowed: usize,
}

impl Compared {
    /// Compares what becomes of volumes around the starts of cases.
    fn cases<R: Reading<D>, const D: usize>(&mut self, cases: &[motion::Case]) {
        for case in cases {
            let case: Case<CapsuleSystem<R>, D> = engine_case(case);
            let point = R::Single::point(&case.start);
            let found = match stretched(&case.system, point) {
                Ok(found) => found,
                Err(reason) => {
                    let single = case.system.single();
                    let cycles = Cycles { count: CYCLES as u64, tolerance: 1e-12 };
                    let plain = returned(&single, point, &cycles, |_| ());
                    assert_eq!(plain, Err(reason), "{case:?}");
                    self.unfollowed += 1;
                    continue;
                }
            };
            let expected = by_equations::<R, D>(&case.system, point);
            self.all += 1;
            if expected == f64::NEG_INFINITY {
                self.lost += 1;
                assert_eq!(found, expected, "{case:?}");
                continue;
            }
            let apart = (found - expected).abs() / (1.0 + expected.abs());
            self.worst = self.worst.max(apart);
            assert!(apart < 1e-6, "{found} {expected}: {case:?}");
        }
    }
}

/// How many of each kind are compared; LONG_PROOFS=1 compares 200 of each.
fn count(usual: usize) -> usize {
    if std::env::var_os("LONG_PROOFS").is_some() { 200 } else { usual }
}

/// Whether a capsule at rest slips backward at once: derivatives at its start are those of one side.
fn slips_backward_from_rest(case: &motion::Case) -> bool {
    let case: Case<CapsuleSystem<Filippov>, 3> = engine_case(case);
    let single = case.system.single();
    let begun = Motion::new(&single, 0.0, case.start);
    case.start.y2 == 0.0 && single.direction(&begun.mode) < 0.0
}

#[test]
fn volumes_shrink_by_the_divergence_and_by_events_over_the_whole_box() {
    let mut compared = Compared::default();
    for (_, law) in Resistance::NAMES {
        compared.cases::<Filippov, 3>(&draws::wide(count(10), 301, law));
        let members = draws::members(count(12), 302, law);
        compared.cases::<General, 3>(&members);
        compared.cases::<OverFolds, 4>(&draws::over_folds(members, 303));
        let mut at_rest = draws::wide(200, 304, law);
        at_rest.retain(slips_backward_from_rest);
        let before = compared.all - compared.lost;
        compared.cases::<Filippov, 3>(&at_rest);
        assert!(compared.all - compared.lost >= before + 3, "{law:?} {compared:?}");
    }
    println!("{compared:?}");
    assert!(compared.lost > compared.all / 10 && compared.lost < compared.all, "{compared:?}");
    assert!(compared.unfollowed <= compared.all / 100, "{compared:?}");
}

/// The sum of all exponents of an orbit [1/s].
fn sum<const D: usize>(spectrum: &Spectrum<D>) -> f64 {
    spectrum.exponents.iter().map(|it| it.value).sum()
}

#[test]
fn the_exponents_of_periodic_orbits_have_the_sum_of_the_divergence() {
    let (mut lost, mut alive) = (0, 0);
    let cases = draws::cases(count(20), 311).into_iter().chain(draws::wide(
        count(20),
        312,
        Resistance::CoulombStribeck,
    ));
    for case in cases {
        let case: Case<CapsuleSystem<Filippov>, 3> = engine_case(&case);
        let orbit = settle(&case, &asking());
        if orbit.outcome != Outcome::Periodic {
            continue;
        }
        let spectrum = orbit.spectrum.expect("all exponents");
        assert_eq!(spectrum.exponents[0].value, orbit.exponent.value);
        assert!(spectrum.exponents.is_sorted_by(|a, b| a.value >= b.value), "{spectrum:?}");
        assert_eq!(spectrum.dimension.value, 0.0);
        let single = case.system.single();
        let mode = |step: &Step<f64, _>| {
            if single.direction(&step.mode) == 0.0 { Share::Lost } else { Share::Stays }
        };
        let event = |step: &Step<f64, _>, _: &State<f64>| match EventKind::from_code(step.event) {
            Some(EventKind::Reversal) => Share::Turns(2),
            _ => Share::Stays,
        };
        let cycles = orbit.period as usize;
        let time = orbit.period as f64 * orbit.duration;
        let expected = volume(&single, orbit.section[0], cycles, mode, event) / time;
        if expected == f64::NEG_INFINITY {
            lost += 1;
            assert_eq!(spectrum.exponents[2].value, expected, "{spectrum:?} {case:?}");
        } else {
            alive += 1;
            let apart = (sum(&spectrum) - expected).abs() * time;
            assert!(
                apart < 1e-5 * (1.0 + expected.abs() * time),
                "{spectrum:?} {expected} {case:?}"
            );
        }
    }
    println!("{lost} lost, {alive} alive");
    assert!(lost > 3 && alive > 3, "{lost} {alive}");
}

#[test]
fn errors_cover_what_other_cycles_tell_of_duffings_exponents() {
    let long = std::env::var_os("LONG_PROOFS").is_some();
    let (starts, exponent_cycles) = if long { (16, 60_000) } else { (8, 1024) };
    let protocol = Protocol {
        exponent_cycles,
        exponent_error: 1e-4,
        max_cycles: 100,
        tolerance: 1e-10,
        ..asking()
    };
    let cases: Vec<Case<Duffing, 2>> =
        (0..starts).map(|it| Case::new(Duffing, [0.1 + 0.05 * f64::from(it), 0.1])).collect();
    let machine = Machine { threads: Some(1), instructions: None };
    let orbits = settle_all(&cases, &protocol, machine);
    let spectra: Vec<Spectrum<2>> =
        orbits.iter().map(|it| it.spectrum.expect("all exponents")).collect();
    for spectrum in &spectra {
        let largest = spectrum.exponents[0];
        assert!((largest.value - 0.159).abs() < 0.001 + 4.0 * largest.uncertainty, "{largest:?}");
        // The divergence is -0.2 everywhere.
        assert!((sum(spectrum) + 0.2).abs() < 1e-9, "{spectrum:?}");
        let dimension = 1.0 + largest.value / (0.2 + largest.value);
        assert!((spectrum.dimension.value - dimension).abs() < 1e-9, "{spectrum:?}");
    }
    println!("{:?}", spectra[0]);
    for of in [|it: &Spectrum<2>| it.exponents[0], |it: &Spectrum<2>| it.dimension] {
        let count = spectra.len() as f64;
        let mean = spectra.iter().map(|it| of(it).value).sum::<f64>() / count;
        let squares: f64 = spectra.iter().map(|it| (of(it).value - mean).powi(2)).sum();
        let spread = (squares / (count - 1.0)).sqrt();
        let told = spectra.iter().map(|it| of(it).uncertainty).sum::<f64>() / count;
        assert!((0.4..2.5).contains(&(spread / told)), "{spread} {told}");
    }
}

#[test]
fn dimensions_follow_from_exponents() {
    let lost = f64::NEG_INFINITY;
    for (exponents, expected) in [
        (&[0.9, 0.0, -14.5][..], 2.0 + 0.9 / 14.5),
        (&[0.4, -0.1, -1.0], 2.3),
        (&[-0.1, -0.2], 0.0),
        (&[0.5, lost], 1.0),
        (&[0.5, -0.2, lost], 2.0),
        (&[0.0, lost, lost], 1.0),
        (&[lost, lost], 0.0),
        (&[0.2, -0.1], 2.0),
    ] {
        assert!((kaplan_yorke(exponents) - expected).abs() < 1e-12, "{exponents:?}");
    }
}

#[test]
fn directions_side_by_side_have_the_bits_of_one_by_one() {
    let mut cases = draws::wide(30, 321, Resistance::CoulombStribeck);
    cases.extend(draws::cases(30, 322));
    let requests: Vec<_> = (1..)
        .zip(&cases)
        .map(|(number, case)| {
            let case: Case<CapsuleSystem<Filippov>, 3> = engine_case(case);
            let State { r, y1, y2, .. } = case.start;
            let own = request(&case.system, [r, y1, y2], 1 + number % 5);
            // Others are derivatives along the coordinates, in the lanes beside.
            let directions = own.directions.filter(|_| number % 3 > 0);
            ReturnRequest { directions, watched: number % 2 == 0, ..own }
        })
        .collect();
    let alone: Vec<String> =
        requests.iter().map(|it| format!("{:?}", OneByOne.passage(it.clone()))).collect();
    for instructions in Instructions::available() {
        let found = passages(instructions, &requests.iter().collect::<Vec<_>>());
        for (found, alone) in found.iter().zip(&alone) {
            assert_eq!(format!("{found:?}"), *alone, "{}", instructions.name());
        }
    }
}

#[test]
fn all_exponents_have_the_same_bits_in_any_order_by_any_instructions() {
    let cases: Vec<Case<CapsuleSystem<Filippov>, 3>> =
        draws::cases(24, 323).iter().map(engine_case).collect();
    let protocol = Protocol { max_cycles: 200, exponent_cycles: 256, ..asking() };
    let told = |orbit: &OrbitOf<CapsuleSystem<Filippov>, 3>| format!("{:?}", orbit.spectrum);
    let alone: Vec<String> = cases.iter().map(|case| told(&settle(case, &protocol))).collect();
    assert!(alone.iter().all(|it| it != "None"));
    let largest: Vec<_> = cases
        .iter()
        .map(|case| settle(case, &Protocol { exponents: Exponents::Largest, ..protocol }))
        .collect();
    for (instructions, threads) in Instructions::available().zip([1, 2].into_iter().cycle()) {
        let machine = Machine { threads: Some(threads), instructions: Some(instructions) };
        let reversed: Vec<_> = cases.iter().rev().cloned().collect();
        let mut found = settle_all(&reversed, &protocol, machine);
        found.reverse();
        for ((found, alone), largest) in found.into_iter().zip(&alone).zip(&largest) {
            assert_eq!(told(&found), *alone, "{}", instructions.name());
            // Nothing else of an orbit is changed by what is computed beside it.
            let same = OrbitOf::<CapsuleSystem<Filippov>, 3> { spectrum: None, ..found };
            assert_eq!(format!("{same:?}"), format!("{largest:?}"));
        }
    }
}
