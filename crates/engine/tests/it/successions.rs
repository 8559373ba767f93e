//! The way of an attractor from one value of a parameter to another costs no more than it may, and what it tells is what
//! branches tell that are followed with small steps.

use std::cell::Cell;
use std::env;

use capsulemap_engine::branch::{Along, End, SegmentEnd, SpecialKind, SpecialValue, succession};
use capsulemap_engine::flow::{Reason, System};
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::measuring::{MeasureRequest, Measured};
use capsulemap_engine::orbit::passage::{
    Integrator, OneByOne, Passage, PlainRequest, PlainReturns, ReturnRequest,
};
use capsulemap_engine::orbit::{Protocol, Varied};
use capsulemap_models::capsule::branch::{Request, follow};

use super::direct_links::points;
use super::draws::{self, ALONG, Random};
use capsulemap_models::capsule::{CapsuleCase, Case, Filippov, Orbit, Parameter};
use capsulemap_models::motion::Setting;

/// Capsules that are drawn.
const CAPSULES: usize = 400;
/// Cycles with derivatives that may be computed, as `docs/attractors.md` says.
const MOST_CYCLES: u64 = 3000;

/// Counts the cycles with derivatives.
#[derive(Debug, Default)]
struct Counting(Cell<u64>);

impl<M: System<D>, const D: usize> Integrator<M, D> for Counting {
    fn passage(&self, request: ReturnRequest<M, D>) -> Result<Passage<M::Event, D>, Reason> {
        self.0.set(self.0.get() + request.cycles.count);
        OneByOne.passage(request)
    }

    fn measured(&self, request: MeasureRequest<M, D>) -> Measured<M, D> {
        OneByOne.measured(request)
    }

    fn plain_returns(&self, request: PlainRequest<M, D>) -> PlainReturns<M::Event, D> {
        OneByOne.plain_returns(request)
    }
}

#[test]
fn attractors_are_followed_for_so_many_cycles_and_tell_no_special_point_that_is_none() {
    let protocol = Protocol::default();
    let mut random = Random::new(29);
    let capsules = env::var("CAPSULES").map_or(CAPSULES, |it| it.parse().expect("a number"));
    let mut cases = draws::cases(capsules, 30);
    // With little damping most ways are long.
    cases.iter_mut().for_each(|case| case.parameters[Parameter::C] *= 0.1);
    let orbits = draws::settled(&cases, &protocol, Instructions::widest());
    let chosen = cases.iter().zip(&orbits).filter(|(case, orbit)| {
        draws::is_kept(orbit) && orbit.period <= 4 && case.parameters[Parameter::Pd] > 0.0
    });
    let (mut lost, mut told, mut wrong) = (0, 0, Vec::new());
    for (i, (case, orbit)) in chosen.enumerate() {
        let parameter = ALONG[i % ALONG.len()];
        let from = case.parameters[parameter];
        let to = from * (1.0 + random.uniform(-0.3, 0.3));
        // Of zero every share is zero.
        if from == to {
            continue;
        }
        let system = case.read::<Filippov>().system;
        let along = Along { system, varied: Varied::One(parameter), tolerance: protocol.tolerance };
        let counting = Counting::default();
        let about = format!("{case:?} along {parameter:?} to {to:?}");
        let found = succession(&counting, &along, (from, &points(orbit)), to).expect(&about);
        assert!(counting.0.get() <= MOST_CYCLES, "{about}: {} cycles", counting.0.get());
        lost += usize::from(found.end == SegmentEnd::Lost);
        let range = [from.min(to), from.max(to)];
        let Some(known) = of_branches(case, orbit, (parameter, range)) else { continue };
        // Of the orbit of half the period there is no branch here, of what is not resolved no place, and of an orbit that has
        // lost its stability only the end is looked for, without a look at what is before it.
        let is_known = |it: &SpecialValue<[f64; 3]>| {
            let periods = [orbit.period, 2 * orbit.period];
            periods.contains(&it.period) && it.kind != SpecialKind::Unresolved
        };
        let lost_at = found.special.iter().position(|it| !it.is_stable_beyond);
        let stable = lost_at.map_or(found.special.len(), |place| place + 1);
        for it in found.special[..stable].iter().filter(|it| is_known(it)) {
            told += 1;
            let near = it.uncertainty + 1e-9 * (to - from).abs();
            let is_it = |(kind, value): &(SpecialKind, f64)| {
                [it.kind, SpecialKind::Unresolved].contains(kind)
                    && (value - it.value).abs() <= near
            };
            if !known.iter().any(is_it) {
                wrong.push(format!("{about}: {it:?} {known:?}"));
            }
        }
    }
    println!("{told} special points, {lost} ways lost");
    assert!(told > 20 && lost > 0, "{told} special points, {lost} ways lost");
    assert!(wrong.is_empty(), "{} of {told}: {wrong:#?}", wrong.len());
}

/// The special points of the branch of an orbit and of those that leave it at period doublings, in small steps; where they end
/// the events change, too; none where a branch has too many orbits.
fn of_branches(
    case: &Case,
    orbit: &Orbit,
    (along, range): (Parameter, [f64; 2]),
) -> Option<Vec<(SpecialKind, f64)>> {
    let found = follow(&Request {
        setting: Setting::of(case),
        section: orbit.section[0],
        period: orbit.period,
        along: along.into(),
        range,
        doublings: 1,
        second: None,
        curve_range: None,
        longest_step: 0.03,
        most_points: 4000,
        tolerance: 1e-12,
    });
    let branches = found.expect("a branch").branches;
    if branches.iter().any(|branch| branch.ends.contains(&End::MostPoints)) {
        return None;
    }
    let special = branches.iter().flat_map(|branch| &branch.special);
    let special = special.map(|it| (it.kind, it.point.parameter));
    let ends = branches.iter().flat_map(|branch| [branch.points.first(), branch.points.last()]);
    let ends = ends.flatten().map(|it| (SpecialKind::EventSequence, it.parameter));
    Some(special.chain(ends).collect())
}
