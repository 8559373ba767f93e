//! Grazing orbits: those that just touch the surface of an impact, and how a branch goes on beyond them.

use crate::flow::{Event, System};
use crate::orbit::matrix::solve;

use super::SpecialKind;
use super::arc::{Arc, Placed};
use super::arclength::{CurvePoint, FARTHEST, Guess, between, corrected_by, dot, moved, norm};
use super::orbits::{OrbitPoint, Orbits, Seen, SpecialOrbit};

/// The orbit that just touches the surface lies so near to where contact was seen to begin.
const NEAR: f64 = 1e-5;
/// An orbit whose margin is below this touches the surface.
const TOUCHES: f64 = 1e-13;
/// A rigid grazing is passed from this margin on one side to as much on the other: the slope of the return map grows
/// as one over its root, and with it the rounding.
const CLOSE: f64 = 1e-9;
/// The margin of the first orbit that is looked for on the other side. Nearer to the surface Newton's method, which gets there
/// by the root of the margin, meets motions of the wrong side on its way.
const BEYOND: [f64; 4] = [CLOSE, 1e-7, 1e-5, 1e-3];
/// Where no step leads on, the margin of an orbit that is about to touch: of one that does not meet the surface, and
/// of one that meets it, near which the return map is too steep for steps.
const ABOUT_TO_TOUCH: [f64; 2] = [1e-6, 1e-2];
/// The margin that is tried next, as a share of the last, and the greatest such share.
const SHARE: f64 = 0.1;
const MOST: f64 = 0.7;
/// Beyond a grazing the margin grows by this factor until steps can be taken.
const GROWS: f64 = 4.0;

/// An orbit with its place on the arc.
type OnArc<E, const D: usize, const U: usize> = Placed<U, Seen<E, D, U>>;

/// The orbit that just touches a surface between two between which contact begins or ceases, or next to them;
/// none where the number of impacts is the same, and the events change in another way.
///
/// Beyond a grazing with a rigid surface no orbit may lie near, and Newton's method finds one far away even before
/// it: then the grazing is approached from the side of fewer impacts, and may be anywhere `within` the arc.
pub fn touching<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    arc: &Arc<'_, U, Orbits<'_, M, D, U>>,
    [a, b]: [&OnArc<M::Event, D, U>; 2],
    within: [f64; 2],
) -> Option<OnArc<M::Event, D, U>> {
    let impacts = [a, b].map(|it| it.1.seen.impacts());
    if impacts[0] == impacts[1] {
        return None;
    }
    if let Some(point) = [a, b].into_iter().find_map(|it| grazed(orbits, &it.1)) {
        return Some(arc.place(&point));
    }
    let fewer = if impacts[0] < impacts[1] { a } else { b };
    let placed = arc.place(&with_margins_down_to(orbits, &fewer.1, TOUCHES)?);
    (within[0] - NEAR..=within[1] + NEAR).contains(&placed.0).then_some(placed)
}

/// The orbit that just touches a surface next to another, if there is one.
pub fn grazed<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    near: &OrbitPoint<M::Event, D, U>,
) -> Option<OrbitPoint<M::Event, D, U>> {
    let found = with_margin(orbits, near, 0.0)?;
    (norm(&between(&near.at, &found.at)) < NEAR).then_some(found)
}

/// The orbit on the same side of a grazing with a margin no more than `least`, approached by orbits that each have a
/// tenth of the last one's, or more where that is too far for Newton's method.
fn with_margins_down_to<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
    least: f64,
) -> Option<OrbitPoint<M::Event, D, U>> {
    let mut left = from.seen.margin?.value;
    let mut here = from.clone();
    let mut share = SHARE;
    while left.abs() > least {
        let next = with_margin(orbits, &here, share * left);
        match next.or_else(|| with_margin(orbits, &by_root(&here, share * left)?, share * left)) {
            Some(next) => (here, left, share) = (next, share * left, SHARE),
            None if share < MOST => share = share.sqrt(),
            None => return None,
        }
    }
    (here.seen.events == from.seen.events).then_some(here)
}

/// Where an orbit beside a rigid surface leads to as its margin changes to a value: it is smooth in the root of the margin.
fn by_root<E: Event, const D: usize, const U: usize>(
    from: &OrbitPoint<E, D, U>,
    value: f64,
) -> Option<OrbitPoint<E, D, U>> {
    let margin = from.seen.margin?;
    let (mut rows, mut by) = (from.rows, [0.0; U]);
    (rows[U - 1], by[U - 1]) = (margin.gradient, value - margin.value);
    let linear = solve(rows, by)?;
    let roots = [margin.value, value].map(|it| it.abs().sqrt());
    let at = moved(&from.at, 2.0 * roots[0] / (roots[0] + roots[1]), &linear);
    Some(CurvePoint { at, ..from.clone() })
}

/// The orbit near another whose nearest local extremum is so far from the surface that it may touch: a maximum
/// where contact begins, a minimum where contact opens.
///
/// Method: Newton's on the orbit and that margin together, whose derivatives are exact and continuous there.
fn with_margin<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    near: &OrbitPoint<M::Event, D, U>,
    value: f64,
) -> Option<OrbitPoint<M::Event, D, U>> {
    let found = corrected_by(
        orbits,
        |_, seen| seen.margin.map(|nearest| (nearest.value - value, nearest.gradient)),
        Guess { at: &near.at, farthest: FARTHEST },
        &near.tangent,
    );
    found.map(|(point, _)| point)
}

/// A rigid grazing at which no step leads on, and the first orbit beyond it, if one is found.
#[derive(Debug, Clone)]
pub struct Passed<E, const D: usize, const U: usize> {
    /// The orbit that touches the surface.
    pub touching: SpecialOrbit<E, D, U>,
    /// The first orbit beyond, with the tangent away from it.
    pub beyond: Option<OrbitPoint<E, D, U>>,
}

/// The grazing that an orbit is about to reach where no step leads on.
///
/// At a rigid surface the return map is continuous, but on the side of the impact its slope grows without bounds,
/// and the branch may turn back there. Method: the margin, which is smooth, is the parameter of the branch near the
/// grazing; on its other side the first guess is the orbit moved along the gradient of the margin.
pub fn past_grazing<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    last: &OrbitPoint<M::Event, D, U>,
) -> Option<Passed<M::Event, D, U>> {
    let margin = last.seen.margin?.value;
    let [smooth, steep] = ABOUT_TO_TOUCH;
    let reach = if last.seen.is_steep(0.5) { steep } else { smooth };
    if margin.abs() > reach {
        return None;
    }
    let orbits = &orbits.exactly();
    let close = with_margins_down_to(orbits, last, CLOSE)?;
    let left = close.seen.margin?.value;
    let other = BEYOND.into_iter().find_map(|margin| {
        displaced(orbits, &close, -margin.copysign(left))
            .filter(|it| it.seen.impacts() != close.seen.impacts())
    });
    let without =
        [Some(&close), other.as_ref()].into_iter().flatten().min_by_key(|it| it.seen.impacts())?;
    let point = with_margins_down_to(orbits, without, TOUCHES)?;
    let beyond = other.and_then(|other| gentle(orbits, other)).map(|beyond| {
        let away = between(&point.at, &beyond.at);
        let sign = if dot(&beyond.tangent, &away) < 0.0 { -1.0 } else { 1.0 };
        CurvePoint { tangent: beyond.tangent.map(|part| sign * part), ..beyond }
    });
    let touching = SpecialOrbit {
        kind: SpecialKind::Grazing,
        distance: norm(&between(&last.at, &point.at)),
        uncertainty: TOUCHES,
        is_stable_beyond: beyond.as_ref().is_some_and(|it| it.seen.is_stable()),
        point,
    };
    Some(Passed { touching, beyond })
}

/// The orbit on the other side of a grazing.
fn displaced<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
    margin: f64,
) -> Option<OrbitPoint<M::Event, D, U>> {
    let nearest = from.seen.margin?;
    let share = (margin - nearest.value) / dot(&nearest.gradient, &nearest.gradient);
    let at = moved(&from.at, share, &nearest.gradient);
    with_margin(orbits, &CurvePoint { at, ..from.clone() }, margin)
}

/// The first orbit with a greater margin at which the return map is not too steep for steps.
fn gentle<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    mut from: OrbitPoint<M::Event, D, U>,
) -> Option<OrbitPoint<M::Event, D, U>> {
    while from.seen.is_steep(0.5) {
        let margin = GROWS * from.seen.margin?.value;
        from = with_margin(orbits, &from, margin).filter(|_| margin.abs() < ABOUT_TO_TOUCH[1])?;
    }
    Some(from)
}
