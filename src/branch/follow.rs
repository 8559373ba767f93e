//! From a request to what is found: the first orbit, its branch both ways, the doubled branches and the
//! curves.

use crate::flow::{Event, System};
use crate::orbit::measured;
use crate::orbit::neutral::may_be_neutral;

use super::arclength::{Plane, corrected, tangent};
use super::curve::{Trace, trace};
use super::doubling::doubled;
use super::family::Family;
use super::orbits::{OrbitStation, Orbits};
use super::periodic::{Goal, Periodic};
use super::scales::units;
use super::walk::{Bounds, Walk};
use super::way::Way;
use super::{
    Branch, BranchOf, End, Found, FoundOf, NotFollowed, Point, PointOf, Request, Special,
    SpecialKind,
};

/// Cycles after which Newton's method is tried again from where the motion then is.
const APPROACH: u64 = 4;
/// Approaches to the first orbit at most.
const APPROACHES: u64 = 8;
/// An orbit that repeats this closely after a part of its period has that part for its period.
const REPEATS: f64 = 1e-8;

/// A branch with what is needed to go on from it.
struct Followed<M: System<D>, const D: usize, const U: usize> {
    orbits: Orbits<M, D, U>,
    level: u32,
    way: Way<M::Event, D, U>,
    /// Why it begins where it does.
    beginning: End,
}

/// Follows a branch of periodic orbits both ways from the one that is given, and what leaves it.
///
/// # Errors
/// Where no periodic orbit is found near the point that is given, or none that a branch goes through.
pub fn follow<M: System<D>, const D: usize>(
    request: &Request<M, D>,
) -> Result<FoundOf<M, D>, NotFollowed> {
    // The unknowns are one more than the coordinates, those of curves two more.
    match const { D } {
        1 => follow_with::<M, D, 2, 3>(request),
        2 => follow_with::<M, D, 3, 4>(request),
        3 => follow_with::<M, D, 4, 5>(request),
        4 => follow_with::<M, D, 5, 6>(request),
        5 => follow_with::<M, D, 6, 7>(request),
        6 => follow_with::<M, D, 7, 8>(request),
        _ => panic!("a section has one to six coordinates, not {D}"),
    }
}

fn follow_with<M: System<D>, const D: usize, const U: usize, const W: usize>(
    request: &Request<M, D>,
) -> Result<FoundOf<M, D>, NotFollowed> {
    let (orbits, first) = first_orbit::<M, D, U>(request)?;
    let mut found = Found { branches: Vec::new(), curves: Vec::new() };
    let (way, beginning) = both_ways(request, &orbits, first);
    let mut followed = vec![Followed { orbits, level: 0, way, beginning }];
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
    let mut doublings = doublings(&followed[parent].way);
    while let Some((place, at)) = doublings.pop() {
        let orbits = &followed[parent].orbits;
        let Some((twice, first)) = doubled(orbits, &at, request.longest_step) else { continue };
        let mut way = Way::new(first.to_vec());
        let goal = Goal::at(&twice, &way.stations[0]);
        way.follow(&twice, &mut walk(request, &twice), request.most_points, &goal);
        way.merge(&twice, &doublings);
        doublings.retain(|(other, _)| Some(*other) != way.merged);
        followed.push(Followed { orbits: twice, level, way, beginning: End::Merged });
        let newest = followed.last().map(|followed| branch(followed, Some((parent, place))));
        found.branches.extend(newest);
    }
}

/// The period doublings of a branch with their places, the first last.
fn doublings<E: Event, const D: usize, const U: usize>(
    way: &Way<E, D, U>,
) -> Vec<(usize, OrbitStation<E, D, U>)> {
    let happenings = way.happenings.iter().enumerate().rev();
    let doublings = happenings
        .filter(|(_, (_, happening))| happening.kind == SpecialKind::PeriodDoubling)
        .map(|(place, (_, happening))| (place, happening.station.clone()));
    doublings.collect()
}

fn walk<M: System<D>, const D: usize, const U: usize>(
    request: &Request<M, D>,
    orbits: &Orbits<M, D, U>,
) -> Walk<U> {
    let range = request.range.map(|end| end / orbits.units[D]);
    Walk::new(Bounds::none().with(D, range), request.longest_step)
}

/// The orbit near the point that is given, of the least period that it has.
fn first_orbit<M: System<D>, const D: usize, const U: usize>(
    request: &Request<M, D>,
) -> Result<(Orbits<M, D, U>, OrbitStation<M::Event, D, U>), NotFollowed> {
    let Request { system, range: [low, high], along, .. } = request;
    let value = system.value(*along);
    let width = high - low;
    if !(*low..=*high).contains(&value) || width <= 0.0 || request.period == 0 {
        return Err(NotFollowed::NoOrbit);
    }
    let Request { period, tolerance, .. } = *request;
    let family = Family { system: system.clone(), period, tolerance };
    let in_units = |section: &[f64; D]| -> [f64; U] {
        std::array::from_fn(|i| *section.get(i).unwrap_or(&width))
    };
    let mut orbits =
        Orbits { family, along: *along, units: in_units(&units(request, &[request.section])) };
    let plane = Plane::fixing(D, value / width);
    let mut section = request.section;
    for _ in 0..APPROACHES {
        let guess = orbits.unknowns(&section, value);
        if let Some((station, _)) = corrected(&orbits, &plane, &guess, &plane.normal) {
            orbits.family.period = least_period(&orbits, &station);
            // The guess may be far away: only the orbit knows the scale of its motion.
            let points = orbits.section_points(&station.at);
            let points: Vec<[f64; D]> = points.iter().map(|at| orbits.section(at)).collect();
            let section = orbits.section(&station.at);
            orbits.units = in_units(&units(request, &points));
            let met = corrected(&orbits, &plane, &orbits.unknowns(&section, value), &plane.normal);
            let (station, _) = met.ok_or(NotFollowed::NoOrbit)?;
            if may_be_neutral(&station.seen.multipliers()) {
                return Err(NotFollowed::Neutral);
            }
            return Ok((orbits, station));
        }
        let ahead = orbits.with_period(APPROACH * request.period).family;
        section = ahead.passage(section, &[]).map_err(NotFollowed::Failed)?.end;
    }
    Err(NotFollowed::NoOrbit)
}

/// The smallest divisor of the period after which the orbit repeats.
fn least_period<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    station: &OrbitStation<M::Event, D, U>,
) -> u64 {
    let period = orbits.family.period;
    let repeats = |part: &u64| {
        let apart = orbits.with_period(*part).displacement(&station.at);
        apart.is_some_and(|apart| apart.iter().all(|part| part.abs() < REPEATS))
    };
    (1..period).filter(|part| period.is_multiple_of(*part)).find(repeats).unwrap_or(period)
}

/// The branch through an orbit, down to the lesser end first, and why it begins there.
fn both_ways<M: System<D>, const D: usize, const U: usize>(
    request: &Request<M, D>,
    orbits: &Orbits<M, D, U>,
    first: OrbitStation<M::Event, D, U>,
) -> (Way<M::Event, D, U>, End) {
    let most = request.most_points.div_ceil(2);
    let mut rising = [0.0; U];
    rising[D] = 1.0;
    let ahead = tangent(first.rows, &rising).unwrap_or(rising);
    let turned = |station: &OrbitStation<M::Event, D, U>, ahead: [f64; U], sign: f64| {
        OrbitStation { tangent: ahead.map(|part| sign * part), ..station.clone() }
    };
    let leaving = |start: OrbitStation<_, D, U>, most: usize, goal: &OrbitStation<_, D, U>| {
        let mut way = Way::new(vec![start]);
        way.follow(orbits, &mut walk(request, orbits), most, &Goal::at(orbits, goal));
        way
    };
    let start = turned(&first, ahead, -1.0);
    let downward = leaving(start.clone(), most, &start);
    let end = downward.end;
    let Some(last) = downward.stations.last().filter(|_| end != End::Closed) else {
        return (downward, end);
    };
    // What closes farther round than one way goes meets the end of that way.
    let goal = turned(last, last.tangent, -1.0);
    let left = request.most_points + 1 - downward.stations.len();
    let upward = leaving(turned(&first, ahead, 1.0), left, &goal);
    let beginning = if upward.end == End::Closed { End::Closed } else { end };
    (joined(downward, upward), beginning)
}

/// Two ways from one orbit as one, the first turned round.
fn joined<E: Event, const D: usize, const U: usize>(
    mut downward: Way<E, D, U>,
    upward: Way<E, D, U>,
) -> Way<E, D, U> {
    let last = downward.stations.len() - 1;
    downward.end = upward.end;
    downward.stations.reverse();
    downward.happenings.reverse();
    for (after, _) in &mut downward.happenings {
        *after = last - 1 - *after;
    }
    downward.stations.extend(upward.stations.into_iter().skip(1));
    let later = upward.happenings.into_iter();
    downward.happenings.extend(later.map(|(after, happening)| (after + last, happening)));
    downward
}

/// A way as a branch: every orbit measured by the plain motion.
fn branch<M: System<D>, const D: usize, const U: usize>(
    followed: &Followed<M, D, U>,
    parent: Option<(usize, usize)>,
) -> BranchOf<M, D> {
    let Followed { orbits, way, .. } = followed;
    let mut sequences = Vec::new();
    let points: Vec<PointOf<M, D>> =
        way.stations.iter().map(|station| point(orbits, station, &mut sequences)).collect();
    let special = way.happenings.iter().map(|(after, happening)| Special {
        kind: happening.kind,
        after: *after,
        point: point(orbits, &happening.station, &mut sequences),
        curve: None,
    });
    let special = special.collect();
    let ends = [followed.beginning, way.end];
    Branch { period: orbits.family.period, parent, points, special, ends }
}

/// An orbit with what is measured of it by the plain motion from it.
fn point<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    station: &OrbitStation<M::Event, D, U>,
    sequences: &mut Vec<Vec<M::Event>>,
) -> PointOf<M, D> {
    let Family { system, period, tolerance } = &orbits.family;
    let parameter = orbits.parameter(&station.at);
    let from = orbits.section(&station.at);
    let multipliers = station.seen.multipliers();
    let system = system.with(orbits.along, parameter);
    let orbit = measured(&system, from, (*period, multipliers), *tolerance).ok();
    let section = orbit.as_ref().map_or_else(|| vec![from], |orbit| orbit.section.clone());
    let residual = orbit.as_ref().map_or(f64::NAN, |orbit| orbit.residual);
    let events = station.seen.events.clone();
    let sequence = sequences.iter().position(|known| *known == events).unwrap_or_else(|| {
        sequences.push(events);
        sequences.len() - 1
    });
    Point { parameter, section, multipliers, residual, measured: orbit, sequence }
}
