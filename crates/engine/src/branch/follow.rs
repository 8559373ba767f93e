//! From a request to what is found: the first orbit, its branch both ways, the doubled branches and the
//! curves.

use super::arclength::{EXACT, Plane, corrected, tangent};
use super::curve::{Trace, trace};
use super::doubling::doubled;
use super::family::Family;
use super::half_branch::HalfBranch;
use super::orbits::{OrbitPoint, Orbits};
use super::periodic::{Goal, Periodic};
use super::scales::units;
use super::step_control::{Bounds, StepControl};
use super::{
    Branch, BranchOf, End, Found, FoundOf, NotFollowed, Point, PointOf, Request, Special,
    SpecialKind,
};
use crate::flow::{Event, System};
use crate::orbit::neutral::may_be_neutral;
use crate::orbit::passage::OneByOne;
use crate::orbit::{Varied, measured};

/// Cycles after which Newton's method is tried again from where the motion then is.
const APPROACH: u64 = 4;
/// Approaches to the first orbit at most.
const APPROACHES: u64 = 8;
/// An orbit that repeats this closely after a part of its period has that part for its period.
const REPEATS: f64 = 1e-8;

/// A branch with what is needed to go on from it.
struct Followed<M: System<D>, const D: usize, const U: usize> {
    orbits: Orbits<'static, M, D, U>,
    level: u32,
    half: HalfBranch<M::Event, D, U>,
    /// Why it begins where it does.
    beginning: End,
}

/// Follows a branch of periodic orbits both ways from the one that is given, and what leaves it.
///
/// # Errors
/// Where the system has no such parameter, and where no periodic orbit is found near the point that is given, or none that a
/// branch goes through.
pub fn follow<M: System<D>, const D: usize>(
    request: &Request<M, D>,
) -> Result<FoundOf<M, D>, NotFollowed> {
    let second = request.second.map(|(parameter, _)| parameter);
    if [Some(request.along), second].into_iter().flatten().any(|it| !request.system.has(it)) {
        return Err(NotFollowed::NoParameter);
    }
    // The unknowns are one more than the coordinates, those of curves two more.
    match const { D } {
        1 => follow_with::<M, D, 2, 3>(request),
        2 => follow_with::<M, D, 3, 4>(request),
        3 => follow_with::<M, D, 4, 5>(request),
        4 => follow_with::<M, D, 5, 6>(request),
        5 => follow_with::<M, D, 6, 7>(request),
        6 => follow_with::<M, D, 7, 8>(request),
        7 => follow_with::<M, D, 8, 9>(request),
        8 => follow_with::<M, D, 9, 10>(request),
        _ => panic!("a section has one to eight coordinates, not {D}"),
    }
}

fn follow_with<M: System<D>, const D: usize, const U: usize, const W: usize>(
    request: &Request<M, D>,
) -> Result<FoundOf<M, D>, NotFollowed> {
    let (orbits, first) = first_orbit::<M, D, U>(request)?;
    let mut found = Found { branches: Vec::new(), curves: Vec::new(), not_left: Vec::new() };
    let (half, beginning) = both_directions(request, &orbits, first);
    let mut followed = vec![Followed { orbits, level: 0, half, beginning }];
    found.branches.push(branch(&followed[0], None));
    let mut next = 0;
    while next < followed.len() {
        leave(request, &mut followed, next, &mut found);
        next += 1;
    }
    let mut traces: Vec<Trace<M, D, W>> = Vec::new();
    let branches = found.branches.iter_mut().zip(&followed);
    for (i, (branch, Followed { orbits, .. })) in branches.enumerate() {
        for (j, special) in branch.special.iter_mut().enumerate() {
            special.curve = trace(request, orbits, (i, j), special, &mut traces);
        }
    }
    found.curves = traces.iter().map(Trace::curve).collect();
    Ok(found)
}

/// Follows the branches that leave a branch at its period doublings.
fn leave<M: System<D>, const D: usize, const U: usize>(
    request: &Request<M, D>,
    followed: &mut Vec<Followed<M, D, U>>,
    parent: usize,
    found: &mut FoundOf<M, D>,
) {
    let level = followed[parent].level + 1;
    if level > request.doublings {
        return;
    }
    let mut doublings = doublings(&followed[parent].half);
    while let Some((place, at)) = doublings.pop() {
        let orbits = &followed[parent].orbits;
        let Some((twice, first)) = doubled(orbits, &at) else {
            found.not_left.push((parent, place));
            continue;
        };
        let mut half = HalfBranch::new(first.to_vec());
        let goal = Goal::at(&twice, &half.points[0]);
        half.follow(&twice, &mut control(request, &twice), request.most_points, &goal);
        half.merge(&twice, &doublings);
        doublings.retain(|(other, _)| Some(*other) != half.merged);
        followed.push(Followed { orbits: twice, level, half, beginning: End::Merged });
        let newest = followed.last().map(|followed| branch(followed, Some((parent, place))));
        found.branches.extend(newest);
    }
}

/// The period doublings of a branch with their places, the first last.
fn doublings<E: Event, const D: usize, const U: usize>(
    half: &HalfBranch<E, D, U>,
) -> Vec<(usize, OrbitPoint<E, D, U>)> {
    let special_orbits = half.special_orbits.iter().enumerate().rev();
    let doublings = special_orbits
        .filter(|(_, (_, special))| special.kind == SpecialKind::PeriodDoubling)
        .map(|(place, (_, special))| (place, special.point.clone()));
    doublings.collect()
}

fn control<M: System<D>, const D: usize, const U: usize>(
    request: &Request<M, D>,
    orbits: &Orbits<M, D, U>,
) -> StepControl<U> {
    let range = request.range.map(|end| end / orbits.units[D]);
    StepControl::new(Bounds::none().with(D, range), request.longest_step)
}

/// The orbit near the point that is given, of the least period that it has.
fn first_orbit<M: System<D>, const D: usize, const U: usize>(
    request: &Request<M, D>,
) -> Result<(Orbits<'static, M, D, U>, OrbitPoint<M::Event, D, U>), NotFollowed> {
    let Request { system, range: [low, high], along, .. } = request;
    let value = system.value(*along);
    let width = high - low;
    if !(*low..=*high).contains(&value) || width <= 0.0 {
        return Err(NotFollowed::OutOfRange);
    }
    if request.period == 0 {
        return Err(NotFollowed::NoOrbit);
    }
    let Request { period, tolerance, .. } = *request;
    let family = Family { system: system.clone(), period, tolerance };
    let mut orbits = Orbits {
        family,
        integrator: &OneByOne,
        along: Varied::One(*along),
        units: measured_by(request, &[request.section]),
        oriented: false,
        exact: EXACT,
    };
    let plane = Plane::fixing(D, value / width);
    let mut section = request.section;
    for _ in 0..APPROACHES {
        let guess = orbits.unknowns(&section, value);
        if let Some((point, _)) = corrected(&orbits, &plane, &guess, &plane.normal) {
            let point = in_own_units(request, &mut orbits, &point)?;
            return Ok((orbits, point));
        }
        let ahead = orbits.with_period(APPROACH * request.period).family;
        section = ahead.passage(section, &[]).map_err(NotFollowed::Failed)?.end;
    }
    Err(NotFollowed::NoOrbit)
}

/// The first orbit by its own scale and of its own period: the guess may be far away, and only the orbit knows the scale of its
/// motion.
fn in_own_units<M: System<D>, const D: usize, const U: usize>(
    request: &Request<M, D>,
    orbits: &mut Orbits<'static, M, D, U>,
    found: &OrbitPoint<M::Event, D, U>,
) -> Result<OrbitPoint<M::Event, D, U>, NotFollowed> {
    orbits.family.period = least_period(orbits, found);
    let points = orbits.section_points(&found.at);
    let points: Vec<[f64; D]> = points.iter().map(|at| orbits.section(at)).collect();
    let section = orbits.section(&found.at);
    orbits.units = measured_by(request, &points);
    let value = request.system.value(request.along);
    let plane = Plane::fixing(D, value / orbits.units[D]);
    let met = corrected(orbits, &plane, &orbits.unknowns(&section, value), &plane.normal);
    let (point, _) = met.ok_or(NotFollowed::NoOrbit)?;
    match may_be_neutral(&point.seen.multipliers()) {
        true => Err(NotFollowed::Neutral),
        false => Ok(point),
    }
}

/// Units of the section by the size of a motion with these section points, and of the parameter by its range.
fn measured_by<M: System<D>, const D: usize, const U: usize>(
    request: &Request<M, D>,
    points: &[[f64; D]],
) -> [f64; U] {
    let Request { system, along, range, .. } = request;
    let section = units(system, &Varied::One(*along), *range, points);
    let width = range[1] - range[0];
    std::array::from_fn(|i| *section.get(i).unwrap_or(&width))
}

/// The smallest divisor of the period after which the orbit repeats.
fn least_period<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    point: &OrbitPoint<M::Event, D, U>,
) -> u64 {
    let period = orbits.family.period;
    let mut divisors = (1..period).filter(|part| period.is_multiple_of(*part));
    let least = divisors.find(|part| {
        let apart = orbits.with_period(*part).displacement(&point.at);
        apart.is_some_and(|apart| apart.iter().all(|part| part.abs() < REPEATS))
    });
    least.unwrap_or(period)
}

/// The branch through an orbit, down to the lesser end first, and why it begins there.
fn both_directions<M: System<D>, const D: usize, const U: usize>(
    request: &Request<M, D>,
    orbits: &Orbits<M, D, U>,
    first: OrbitPoint<M::Event, D, U>,
) -> (HalfBranch<M::Event, D, U>, End) {
    let most = request.most_points.div_ceil(2);
    let mut rising = [0.0; U];
    rising[D] = 1.0;
    let ahead = tangent(first.rows, &rising).unwrap_or(rising);
    let start = OrbitPoint { tangent: ahead.map(|part| -part), ..first.clone() };
    let mut downward = HalfBranch::new(vec![start.clone()]);
    downward.follow(orbits, &mut control(request, orbits), most, &Goal::at(orbits, &start));
    let end = downward.end;
    let Some(last) = downward.points.last().filter(|_| end != End::Closed) else {
        return (downward, end);
    };
    // A closed branch that is longer than one half meets the end of that half.
    let goal = OrbitPoint { tangent: last.tangent.map(|part| -part), ..last.clone() };
    let left = request.most_points + 1 - downward.points.len();
    let mut upward = HalfBranch::new(vec![OrbitPoint { tangent: ahead, ..first }]);
    upward.follow(orbits, &mut control(request, orbits), left, &Goal::at(orbits, &goal));
    let beginning = if upward.end == End::Closed { End::Closed } else { end };
    (joined(downward, upward), beginning)
}

/// Two half branches from one orbit as one, the first in reverse.
fn joined<E: Event, const D: usize, const U: usize>(
    mut downward: HalfBranch<E, D, U>,
    upward: HalfBranch<E, D, U>,
) -> HalfBranch<E, D, U> {
    let last = downward.points.len() - 1;
    downward.end = upward.end;
    downward.points.reverse();
    downward.special_orbits.reverse();
    for (after, _) in &mut downward.special_orbits {
        *after = last - 1 - *after;
    }
    downward.points.extend(upward.points.into_iter().skip(1));
    let later = upward.special_orbits.into_iter();
    downward.special_orbits.extend(later.map(|(after, special)| (after + last, special)));
    downward
}

/// A half branch, or two joined, as a branch: every orbit is measured by the plain motion.
fn branch<M: System<D>, const D: usize, const U: usize>(
    followed: &Followed<M, D, U>,
    parent: Option<(usize, usize)>,
) -> BranchOf<M, D> {
    let Followed { orbits, half, .. } = followed;
    let mut sequences = Vec::new();
    let points: Vec<PointOf<M, D>> =
        half.points.iter().map(|orbit| point(orbits, orbit, &mut sequences)).collect();
    let special = half.special_orbits.iter().map(|(after, special)| Special {
        kind: special.kind,
        after: *after,
        point: point(orbits, &special.point, &mut sequences),
        curve: None,
    });
    let special = special.collect();
    let ends = [followed.beginning, half.end];
    Branch { period: orbits.family.period, parent, points, special, ends }
}

/// An orbit with what is measured of it by the plain motion from it.
fn point<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    point: &OrbitPoint<M::Event, D, U>,
    sequences: &mut Vec<Vec<M::Event>>,
) -> PointOf<M, D> {
    let Family { system, period, tolerance } = &orbits.family;
    let parameter = orbits.parameter(&point.at);
    let from = orbits.section(&point.at);
    let multipliers = point.seen.multipliers();
    let system = orbits.along.of(system, parameter);
    let orbit = measured(&system, from, (*period, multipliers), *tolerance).ok();
    let section = orbit.as_ref().map_or_else(|| vec![from], |orbit| orbit.section.clone());
    let residual = orbit.as_ref().map_or(f64::NAN, |orbit| orbit.residual);
    let events = point.seen.events.clone();
    let sequence = sequences.iter().position(|known| *known == events).unwrap_or_else(|| {
        sequences.push(events);
        sequences.len() - 1
    });
    let multipliers = multipliers.to_vec();
    Point { parameter, section, multipliers, residual, measured: orbit, sequence }
}
