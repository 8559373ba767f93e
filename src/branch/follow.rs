//! From a request to what is found: the first orbit, its branch both ways, the doubled branches and the
//! curves.

use crate::capsule::{Capsule, EventKind, Switching};
use crate::orbit::neutral::may_be_neutral;
use crate::orbit::{Output, Outputs, Section, over_cycles};

use super::arclength::{Plane, corrected, tangent};
use super::curve::{Trace, trace};
use super::doubling::doubled;
use super::family::Family;
use super::orbits::{OrbitStation, Orbits, PARAMETER};
use super::periodic::{Goal, Periodic};
use super::scales::units;
use super::walk::{Bounds, Walk};
use super::way::Way;
use super::{Branch, End, Found, NotFollowed, Point, Request, Special, SpecialKind};

/// Cycles after which Newton's method is tried again from where the motion then is.
const APPROACH: u64 = 4;
/// Approaches to the first orbit at most.
const APPROACHES: u64 = 8;
/// An orbit that repeats this closely after a part of its period has that part for its period.
const REPEATS: f64 = 1e-8;

/// A branch with what is needed to go on from it.
struct Followed {
    orbits: Orbits,
    level: u32,
    way: Way,
    /// Why it begins where it does.
    beginning: End,
}

/// Follows a branch of periodic orbits both ways from the one that is given, and what leaves it.
pub fn follow(request: &Request) -> Result<Found, NotFollowed> {
    if request.parameters.switching == Switching::AsPrinted {
        return Err(NotFollowed::AsPrinted);
    }
    let (orbits, first) = first_orbit(request)?;
    let mut found = Found::default();
    let (way, beginning) = both_ways(request, &orbits, first);
    let mut followed = vec![Followed { orbits, level: 0, way, beginning }];
    found.branches.push(branch(&followed[0], None));
    let mut next = 0;
    while next < followed.len() {
        leave(request, &mut followed, next, &mut found);
        next += 1;
    }
    let mut traces = Vec::new();
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
fn leave(request: &Request, followed: &mut Vec<Followed>, parent: usize, found: &mut Found) {
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
fn doublings(way: &Way) -> Vec<(usize, OrbitStation)> {
    let happenings = way.happenings.iter().enumerate().rev();
    let doublings = happenings
        .filter(|(_, (_, happening))| happening.kind == SpecialKind::PeriodDoubling)
        .map(|(place, (_, happening))| (place, happening.station.clone()));
    doublings.collect()
}

fn walk(request: &Request, orbits: &Orbits) -> Walk<4> {
    let range = request.range.map(|end| end / orbits.units[PARAMETER]);
    Walk::new(Bounds::none().with(PARAMETER, range), request.longest_step)
}

/// The orbit near the point that is given, of the least period that it has.
fn first_orbit(request: &Request) -> Result<(Orbits, OrbitStation), NotFollowed> {
    let Request { parameters, range: [low, high], along, .. } = request;
    let value = parameters[*along];
    let width = high - low;
    if !(*low..=*high).contains(&value) || width <= 0.0 || request.period == 0 {
        return Err(NotFollowed::NoOrbit);
    }
    let family = Family {
        parameters: parameters.clone(),
        phase: request.phase,
        period: request.period,
        tolerance: request.tolerance,
    };
    let [r, y1, y2] = units(request, &[request.section]);
    let mut orbits = Orbits { family, along: *along, units: [r, y1, y2, width] };
    let plane = Plane::fixing(PARAMETER, value / width);
    let mut section = request.section;
    for _ in 0..APPROACHES {
        let guess = orbits.unknowns(&section, value);
        if let Some((station, _)) = corrected(&orbits, &plane, &guess, &plane.normal) {
            orbits.family.period = least_period(&orbits, &station);
            // The guess may be far away: only the orbit knows the scale of its motion.
            let points = orbits.section_points(&station.at);
            let points: Vec<Section> = points.iter().map(|at| orbits.section(at)).collect();
            let [r, y1, y2] = units(request, &points);
            let section = orbits.section(&station.at);
            orbits.units = [r, y1, y2, width];
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
fn least_period(orbits: &Orbits, station: &OrbitStation) -> u64 {
    let period = orbits.family.period;
    let repeats = |part: &u64| {
        let apart = orbits.with_period(*part).displacement(&station.at);
        apart.is_some_and(|apart| apart.iter().all(|part| part.abs() < REPEATS))
    };
    (1..period).filter(|part| period.is_multiple_of(*part)).find(repeats).unwrap_or(period)
}

/// The branch through an orbit, down to the lesser end first, and why it begins there.
fn both_ways(request: &Request, orbits: &Orbits, first: OrbitStation) -> (Way, End) {
    let most = request.most_points.div_ceil(2);
    let mut rising = [0.0; 4];
    rising[PARAMETER] = 1.0;
    let ahead = tangent(first.rows, &rising).unwrap_or(rising);
    let turned = |station: &OrbitStation, ahead: [f64; 4], sign: f64| OrbitStation {
        tangent: ahead.map(|part| sign * part),
        ..station.clone()
    };
    let leaving = |start: OrbitStation, most: usize, goal: &OrbitStation| {
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
fn joined(mut downward: Way, upward: Way) -> Way {
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
fn branch(followed: &Followed, parent: Option<(usize, usize)>) -> Branch {
    let Followed { orbits, way, .. } = followed;
    let mut sequences = Vec::new();
    let points: Vec<Point> =
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

/// An orbit with what the plain motion from it costs and yields.
fn point(orbits: &Orbits, station: &OrbitStation, sequences: &mut Vec<Vec<EventKind>>) -> Point {
    let Family { parameters, phase, period, tolerance } = &orbits.family;
    let parameter = orbits.parameter(&station.at);
    let mut parameters = parameters.clone();
    parameters[orbits.along] = parameter;
    let from = orbits.section(&station.at);
    let system = Capsule::single(&parameters, *phase);
    let multipliers = station.seen.multipliers();
    let cycles = (*period, multipliers);
    let (outputs, section) = over_cycles(&system, &parameters, from, cycles, *tolerance)
        .unwrap_or_else(|_| (Outputs::unknown(), vec![from]));
    let residual = outputs[Output::SectionResidual];
    let events = station.seen.events.clone();
    let sequence = sequences.iter().position(|known| *known == events).unwrap_or_else(|| {
        sequences.push(events);
        sequences.len() - 1
    });
    Point { parameter, section, multipliers, residual, outputs, sequence }
}
