//! Returns that are followed, and cycles that are measured, side by side have the bits of those one by one.

use capsulemap_engine::flow::{Motion, System};
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::Varied;
use capsulemap_engine::orbit::measuring::{MeasureRequest, Measured};
use capsulemap_engine::orbit::measuring_all::measured_side_by_side;
use capsulemap_engine::orbit::passage::{Integrator, OneByOne, ReturnRequest};
use capsulemap_engine::orbit::passages::passages;
use capsulemap_engine::orbit::return_map::Cycles;
use capsulemap_engine::orbit::trajectory::Progress;

use super::draws::{self, Random};
use capsulemap_models::capsule::{
    AsPrinted, CapsuleCase, CapsuleState as _, CapsuleSystem, Case, Filippov, Parameter, Reading,
    Resistance,
};

/// Capsules of each law.
const CAPSULES: usize = 126;
/// Returns that are asked for together: fewer than some lanes, and more than all.
const GROUPS: [usize; 2] = [3, 42];

type Capsule = ReturnRequest<CapsuleSystem<Filippov>, 3>;

/// A return from the start of a case, over a few cycles.
fn request(random: &mut Random, case: &Case) -> Capsule {
    let read = case.read::<Filippov>();
    ReturnRequest {
        system: read.system,
        along: None,
        point: [case.start.capsule().r, case.start.capsule().y1, case.start.capsule().y2],
        units: [1e-3, 0.5, 2.0],
        cycles: Cycles { count: random.logarithmic(1.0, 16.0) as u64, tolerance: 1e-12 },
        watched: random.uniform(0.0, 1.0) < 0.5,
        directions: None,
    }
}

/// Compares the returns of every group, as text: what is not a number does not equal itself.
fn compare(requests: &[Capsule]) {
    let alone: Vec<String> =
        requests.iter().map(|it| format!("{:?}", OneByOne.passage(it.clone()))).collect();
    for instructions in Instructions::available() {
        for size in GROUPS {
            let mut expected = alone.iter().zip(requests);
            for group in requests.chunks(size) {
                let group: Vec<&Capsule> = group.iter().collect();
                let found = passages(instructions, &group);
                assert_eq!(found.len(), group.len());
                for found in found {
                    let (alone, request) = expected.next().expect("as many as are asked for");
                    let name = instructions.name();
                    assert_eq!(format!("{found:?}"), *alone, "{name}: {request:?}");
                }
            }
        }
    }
}

#[test]
fn returns_side_by_side_have_the_bits_of_one_by_one() {
    let mut random = Random::new(91);
    for (_, law) in Resistance::NAMES {
        let cases = draws::wide(CAPSULES, 92, law);
        let requests: Vec<Capsule> = cases.iter().map(|case| request(&mut random, case)).collect();
        let phases = requests.iter().map(|it| it.system.phase.to_bits());
        assert!(phases.collect::<std::collections::BTreeSet<_>>().len() > CAPSULES / 2);
        compare(&requests);
    }
}

#[test]
fn so_do_their_derivatives_along_a_parameter() {
    let mut random = Random::new(93);
    for (_, law) in Resistance::NAMES {
        for shared in [true, false] {
            let cases = draws::wide(CAPSULES / 2, 94, law);
            let along = |case: &Case| {
                let mut request = request(&mut random, case);
                if shared {
                    request.system.phase = 0.7;
                }
                let of = random.uniform(0.0, Parameter::ALL.len() as f64);
                let parameter = Parameter::ALL[of as usize];
                let value = request.system.parameters[parameter];
                request.along = Some((Varied::One(parameter), value, 0.3));
                request
            };
            compare(&cases.iter().map(along).collect::<Vec<_>>());
        }
    }
}

/// Cycles to be measured from the start of a case; some are more than the steps allow.
fn measure_request<R: Reading>(number: u64, case: &Case) -> MeasureRequest<CapsuleSystem<R>, 3> {
    let mut random = Random::new(95 + number);
    let system = case.read::<R>().system;
    let motion = Motion::new(&system.single(), 0.0, case.start.capsule());
    let steps = if random.uniform(0.0, 1.0) < 0.2 { 40.0 } else { 1e6 };
    MeasureRequest {
        system,
        motion,
        progress: Progress::default(),
        cycles: random.logarithmic(1.0, 16.0) as u64,
        batches: random.uniform(0.0, 5.0) as u64,
        max_steps: steps as u64,
        tolerance: 1e-12,
        points: random.uniform(0.0, 4.0) as usize,
        observed_points: 3,
    }
}

/// All that has been measured, as text.
fn told<R: Reading>(measured: &Measured<CapsuleSystem<R>, 3>) -> String {
    let Measured { motion, progress, observed, batches, kept, failure } = measured;
    let at = (motion.time, motion.state);
    format!("{at:?} {progress:?} {observed:?} {batches:?} {kept:?} {failure:?}")
}

fn compare_measured<R: Reading>() {
    let (mut failed, mut impacts) = (0, 0);
    for (_, law) in Resistance::NAMES {
        let cases = draws::wide(CAPSULES / 2, 96, law);
        let request = |number: usize| measure_request::<R>(number as u64, &cases[number]);
        let alone: Vec<_> =
            (0..cases.len()).map(|number| OneByOne.measured(request(number))).collect();
        failed += alone.iter().filter(|it| it.failure.is_some()).count();
        impacts += alone.iter().map(|it| it.observed.impact_points.0.len()).sum::<usize>();
        for instructions in Instructions::available() {
            for size in GROUPS {
                for first in (0..cases.len()).step_by(size) {
                    let group = first..cases.len().min(first + size);
                    let requests = group.clone().map(request).collect();
                    let found = measured_side_by_side(instructions, requests);
                    assert_eq!(found.len(), group.len());
                    for (found, number) in found.iter().zip(group) {
                        let (name, case) = (instructions.name(), &cases[number]);
                        assert_eq!(told(found), told(&alone[number]), "{name}: {case:?}");
                    }
                }
            }
        }
    }
    assert!(failed > 10 && impacts > 100, "{failed} failed, {impacts} impacts");
}

#[test]
fn measured_cycles_side_by_side_have_the_bits_of_one_by_one() {
    compare_measured::<Filippov>();
    compare_measured::<AsPrinted>();
}
