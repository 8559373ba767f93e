//! Where the orbits of a branch become orbits of half their period.

use crate::flow::System;

use super::arc::{Arc, NARROW};
use super::arclength::{dot, norm};
use super::orbits::{OrbitPoint, Orbits};
use super::periodic::Periodic;

/// The two halves of the period differ by less at a merger, or by a smaller share of what they did before.
pub const HALF: f64 = 1e-5;
const OF_BEFORE: f64 = 1e-2;
/// Where they differ by less at the beginning of a step, nothing else happens on it but what is located.
const NEAR: f64 = 2e-3;
/// Special orbits are looked for up to this share of the way to a merger: there the branch turns from one half of its orbits
/// to the other, which is no fold.
const UNTIL: f64 = 0.9;

/// An orbit of half the period at the end of a branch.
pub struct Merger<E, const D: usize, const U: usize> {
    /// The orbit.
    pub at: OrbitPoint<E, D, U>,
    /// One shortly before it.
    pub before: OrbitPoint<E, D, U>,
    /// Whether the step begins near it.
    pub is_near: bool,
}

/// The orbit at which those of an even period become orbits of half the period, between two whose displacements over half the
/// period point to opposite sides; none where the displacement turns round without vanishing, and the branch goes on.
pub fn merger<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
    to: &OrbitPoint<M::Event, D, U>,
) -> Option<Merger<M::Event, D, U>> {
    let first = orbits.halfway(&from.at)?;
    let arc = Arc::from(orbits, from);
    let ends = [from, to].map(|point| arc.place(point));
    let [last, _] = arc.change(
        ends.each_ref(),
        |point| orbits.halfway(&point.at).is_some_and(|apart| dot(&apart, &first) > 0.0),
        NARROW,
    );
    if !is_merged(orbits, [&from.at, &last.1.at]) {
        return None;
    }
    let until = ends[0].0 + UNTIL * (last.0 - ends[0].0);
    let (_, point) = arc.within([&ends[0], &last], until)?;
    Some(Merger { at: last.1, before: point, is_near: norm(&first) <= NEAR })
}

/// Whether the displacement over half the period has vanished at the second of two orbits.
pub fn is_merged<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    at: [&[f64; U]; 2],
) -> bool {
    let [Some(before), Some(left)] = at.map(|at| orbits.halfway(at).map(|it| norm(&it))) else {
        return false;
    };
    left <= HALF.max(OF_BEFORE * before) && left <= 0.5 * before
}
