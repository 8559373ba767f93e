//! From a request for a segment to the segment: of an orbit, or of the attractor that it becomes.

use super::arclength::{ROUNDING, norm};
use super::family::Family;
use super::limited::Limited;
use super::orbits::Orbits;
use super::scales::units;
use super::segment::{Along, Segment, SegmentEnd};
use super::special::Sought;
use super::walk::{COARSE, LEAST_MOVE, Walk};
use crate::flow::System;
use crate::orbit::passage::Integrator;

/// An attractor is followed through so many doublings and mergers at most.
const CHANGES_OF_PERIOD: usize = 4;
/// Cycles with derivatives that are computed for a segment at most: where an attractor ends is not worth more.
const CYCLES: u64 = 3000;

/// The segment of a branch from a periodic orbit, given by the value of the parameter there and its section
/// points, to another value; none where the orbit does not close, or the system has no such parameter.
///
/// Method: pseudo-arclength continuation as in [`follow`](super::follow()), which tells a fold from an orbit that
/// cannot be followed, with the distance of the two values as unit of the parameter. It goes on past the loss of stability,
/// as the orbit at the other value may be that of a neighbouring segment. After 3000 cycles with derivatives it is lost.
/// Breaks: two special points of one kind that undo each other between two orbits of the segment are not seen.
pub fn segment<M: System<D>, const D: usize>(
    integrator: &dyn Integrator<M, D>,
    along: &Along<M, D>,
    from: (f64, &[[f64; D]]),
    to: f64,
) -> Option<Segment<[f64; D]>> {
    segment_of(integrator, along, from, (to, 0))
}

/// The way of an attractor that begins with a periodic orbit, see [`segment`]: where the orbit doubles its period, it goes on
/// with the doubled orbit if that is stable beyond, and where it merges with one of half its period, with that one.
///
/// Every step has to add up, or is halved, down to a thousandth of the way, and further where the return map jumps on it.
/// An orbit that is stable again at the other value, after it has lost its stability, is the attractor as well. Where the
/// attractor changes its period more than four times, it is lost.
pub fn succession<M: System<D>, const D: usize>(
    integrator: &dyn Integrator<M, D>,
    along: &Along<M, D>,
    from: (f64, &[[f64; D]]),
    to: f64,
) -> Option<Segment<[f64; D]>> {
    segment_of(integrator, along, from, (to, CHANGES_OF_PERIOD))
}

fn segment_of<M: System<D>, const D: usize>(
    integrator: &dyn Integrator<M, D>,
    along: &Along<M, D>,
    from: (f64, &[[f64; D]]),
    to: (f64, usize),
) -> Option<Segment<[f64; D]>> {
    if !along.system.has(along.parameter) {
        return None;
    }
    match const { D } {
        1 => segment_with::<M, D, 2>(integrator, along, from, to),
        2 => segment_with::<M, D, 3>(integrator, along, from, to),
        3 => segment_with::<M, D, 4>(integrator, along, from, to),
        4 => segment_with::<M, D, 5>(integrator, along, from, to),
        5 => segment_with::<M, D, 6>(integrator, along, from, to),
        6 => segment_with::<M, D, 7>(integrator, along, from, to),
        _ => panic!("a section has one to six coordinates, not {D}"),
    }
}

fn segment_with<M: System<D>, const D: usize, const U: usize>(
    integrator: &dyn Integrator<M, D>,
    along: &Along<M, D>,
    (from, points): (f64, &[[f64; D]]),
    (to, changes): (f64, usize),
) -> Option<Segment<[f64; D]>> {
    let Along { system, parameter, tolerance } = along;
    let family =
        Family { system: system.clone(), period: points.len() as u64, tolerance: *tolerance };
    let range = [from.min(to), from.max(to)];
    let width = range[1] - range[0];
    let section = units(system, (*parameter, range), points);
    let units: [f64; U] = std::array::from_fn(|i| *section.get(i).unwrap_or(&width));
    let along = *parameter;
    let limited = &Limited::to(CYCLES, integrator);
    let orbits =
        Orbits { family, integrator: limited, along, units, oriented: true, exact: ROUNDING };
    let sought = if changes > 0 { Sought::Every(COARSE) } else { Sought::Shown(COARSE) };
    let mut walk = Walk { orbits, from, to, sought, limited };
    let section = points.first()?;
    let start = walk.start(section)?;
    // Section and parameter count alike, or a fold is a bend too sharp for steps of the parameter's length.
    let moves = norm(&start.tangent.map(|part| part / start.tangent[D])).powi(2) - 1.0;
    walk.orbits.units[D] = width / moves.sqrt().clamp(LEAST_MOVE, 1.0);
    let start = walk.start(section)?;
    let (mut found, mut onward) = walk.segment(start);
    for _ in 0..changes {
        let Some(begun) = onward.map(|it| it.begin(&walk)) else { return Some(found) };
        let Some(begun) = begun else { return Some(Segment { end: SegmentEnd::Lost, ..found }) };
        if !begun.is_stable {
            return Some(found);
        }
        let (later, further) = begun.walk.segment(begun.start);
        found.special.extend(later.special);
        (found.end, onward, walk) = (later.end, further, begun.walk);
    }
    if changes > 0 && onward.is_some() {
        found.end = SegmentEnd::Lost;
    }
    Some(found)
}
