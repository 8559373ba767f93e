//! Returns that are followed side by side have the bits of those followed one by one.

use capsulemap::capsule::{CapsuleSystem, Case, Filippov, Parameter, Resistance};
use capsulemap::lane::Instructions;
use capsulemap::orbit::passage::{Integrator, OneByOne, ReturnRequest};
use capsulemap::orbit::passages::passages;
use capsulemap::orbit::return_map::Cycles;

use super::draws::{self, Random};

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
        point: [case.start.r, case.start.y1, case.start.y2],
        units: [1e-3, 0.5, 2.0],
        cycles: Cycles { count: random.logarithmic(1.0, 16.0) as u64, tolerance: 1e-12 },
        watched: random.uniform(0.0, 1.0) < 0.5,
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
                request.along = Some((parameter, value, 0.3));
                request
            };
            compare(&cases.iter().map(along).collect::<Vec<_>>());
        }
    }
}
