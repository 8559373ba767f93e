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
    segment_of(integrator, along, from, to, 0)
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
    segment_of(integrator, along, from, to, CHANGES_OF_PERIOD)
}

fn segment_of<M: System<D>, const D: usize>(
    integrator: &dyn Integrator<M, D>,
    along: &Along<M, D>,
    from: (f64, &[[f64; D]]),
    to: f64,
    changes: usize,
) -> Option<Segment<[f64; D]>> {
    if !along.varied.is_had(&along.system) {
        return None;
    }
    let limited = Limited::to(CYCLES, integrator);
    match const { D } {
        1 => segment_with::<M, D, 2>(&limited, along, from, to, changes),
        2 => segment_with::<M, D, 3>(&limited, along, from, to, changes),
        3 => segment_with::<M, D, 4>(&limited, along, from, to, changes),
        4 => segment_with::<M, D, 5>(&limited, along, from, to, changes),
        5 => segment_with::<M, D, 6>(&limited, along, from, to, changes),
        6 => segment_with::<M, D, 7>(&limited, along, from, to, changes),
        7 => segment_with::<M, D, 8>(&limited, along, from, to, changes),
        8 => segment_with::<M, D, 9>(&limited, along, from, to, changes),
        _ => panic!("a section has one to eight coordinates, not {D}"),
    }
}

fn segment_with<M: System<D>, const D: usize, const U: usize>(
    limited: &Limited<'_, M, D>,
    along: &Along<M, D>,
    from: (f64, &[[f64; D]]),
    to: f64,
    changes: usize,
) -> Option<Segment<[f64; D]>> {
    let sought = if changes > 0 { Sought::Every(COARSE) } else { Sought::Shown(COARSE) };
    let mut walk = walk_from::<M, D, U>(limited, along, from, to, sought)?;
    let start = walk.start(from.1.first()?)?;
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

/// The way from an orbit to another value, in units in which section and parameter count alike: or a fold is a bend too sharp for
/// steps of the parameter's length.
fn walk_from<'a, M: System<D>, const D: usize, const U: usize>(
    limited: &'a Limited<'a, M, D>,
    along: &Along<M, D>,
    from: (f64, &[[f64; D]]),
    to: f64,
    sought: Sought,
) -> Option<Walk<'a, M, D, U>> {
    let Along { system, varied, tolerance } = along;
    let (value, points) = from;
    let family =
        Family { system: system.clone(), period: points.len() as u64, tolerance: *tolerance };
    let range = [value.min(to), value.max(to)];
    let width = range[1] - range[0];
    let section = units(system, varied, range, points);
    let units: [f64; U] = std::array::from_fn(|i| *section.get(i).unwrap_or(&width));
    let along = varied.clone();
    let orbits =
        Orbits { family, integrator: limited, along, units, oriented: true, exact: ROUNDING };
    let mut walk = Walk { orbits, from: value, to, sought, limited };
    let start = walk.start(points.first()?)?;
    let moves = norm(&start.tangent.map(|part| part / start.tangent[D])).powi(2) - 1.0;
    walk.orbits.units[D] = width / moves.sqrt().clamp(LEAST_MOVE, 1.0);
    Some(walk)
}
