//! What the derivatives of two orbits say of the branch between them is what a continuation finds there.

use capsulemap_engine::attractor::coincide;
use capsulemap_engine::branch::{Along, Linearised, SegmentEnd, leads_to, linearised, segment};
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::passage::OneByOne;
use capsulemap_engine::orbit::{Protocol, Varied};
use capsulemap_models::capsule::{
    CapsuleCase as _, CapsuleState as _, Case, Filippov, Orbit, Parameter, Resistance, State,
};

use super::draws::{self, ALONG, Random};
use capsulemap_models::description::Section;

/// Capsules of each law.
const CAPSULES: usize = 400;
/// The same capsule with another value of a parameter, started where the first has settled.
fn neighbour(case: &Case, orbit: &Orbit, parameter: Parameter, factor: f64) -> Case {
    let mut next = case.clone();
    next.parameters[parameter] *= factor;
    next.start = State { x2: 0.0, ..orbit.end.capsule() }.into();
    next
}

/// The section points of an orbit for the engine.
pub fn points(orbit: &Orbit) -> Vec<[f64; 3]> {
    orbit.section.iter().map(Section::array).collect()
}

#[test]
fn a_branch_that_is_said_to_lead_straight_on_does() {
    let mut random = Random::new(83);
    let protocol = Protocol { points: 8, ..Protocol::default() };
    let (mut pairs, mut direct) = (0, 0);
    for (_, law) in Resistance::NAMES {
        let cases = draws::wide(CAPSULES, 84, law);
        let orbits = draws::settled(&cases, &protocol, Instructions::widest());
        let chosen: Vec<(&Case, &Orbit)> =
            cases.iter().zip(&orbits).filter(|(_, orbit)| draws::is_kept(orbit)).collect();
        let drawn: Vec<(Parameter, f64)> = (0..chosen.len())
            .map(|i| (ALONG[i % ALONG.len()], 1.0 + random.uniform(-1.0, 1.0) * 0.01))
            .collect();
        let next: Vec<Case> = chosen
            .iter()
            .zip(&drawn)
            .map(|((case, orbit), (parameter, factor))| neighbour(case, orbit, *parameter, *factor))
            .collect();
        let reached = draws::settled(&next, &protocol, Instructions::widest());
        for (i, (case, orbit)) in chosen.into_iter().enumerate() {
            let (parameter, other) = (drawn[i].0, &reached[i]);
            if !draws::is_kept(other) || other.period != orbit.period {
                continue;
            }
            let system = case.read::<Filippov>().system;
            let along =
                Along { system, varied: Varied::One(parameter), tolerance: protocol.tolerance };
            let values = [case.parameters[parameter], next[i].parameters[parameter]];
            // Of zero every share is zero.
            if values[0] == values[1] {
                continue;
            }
            let linear =
                |value: f64, orbit: &Orbit| linearised(&OneByOne, &along, value, &points(orbit));
            let (Some(a), Some(b)) = (linear(values[0], orbit), linear(values[1], other)) else {
                continue;
            };
            pairs += 1;
            let ends_in_turn: [(&Linearised<_, 3>, _, _, _, _); 2] = [
                (&a, &b, values, points(orbit), points(other)),
                (&b, &a, [values[1], values[0]], points(other), points(orbit)),
            ];
            for (from, to, [begins, ends], first, last) in ends_in_turn {
                if !leads_to(&along, from, to) {
                    continue;
                }
                direct += 1;
                let about = format!("{case:?} along {parameter:?} from {begins:?} to {ends:?}");
                let found = segment(&OneByOne, &along, (begins, &first), ends).expect(&about);
                assert!(found.special.is_empty(), "{about}: {:?}", found.special);
                let SegmentEnd::Reached(met) = found.end else {
                    panic!("{about}: {:?}", found.end)
                };
                let metric = along.metric(ends);
                let near = 1e-8 * metric.largest(&last);
                assert!(coincide(&met.points, &last, near, &metric), "{about}");
            }
        }
    }
    println!("{direct} of {} are direct", 2 * pairs);
    assert!(pairs > 500 && direct > pairs, "{direct} of {}", 2 * pairs);
}
