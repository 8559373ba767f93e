//! The special orbits of a branch between two neighbouring orbits.

use crate::flow::{Event, System};

use super::SpecialKind;
use super::arc::{Arc, Placed};
use super::arclength::{between, corrected_by, norm};
use super::orbits::{OrbitPoint, Orbits, Seen};

/// Changes of the event sequence between two neighbouring orbits at most.
const CHANGES: usize = 16;
/// The orbit that just touches the surface lies so near to where contact was seen to begin.
const NEAR: f64 = 1e-5;

/// A special orbit on its arc.
#[derive(Debug, Clone)]
pub struct SpecialOrbit<E, const D: usize, const U: usize> {
    /// What happens.
    pub kind: SpecialKind,
    /// How far along the arc.
    pub distance: f64,
    /// The orbit.
    pub point: OrbitPoint<E, D, U>,
}

/// The test function of a special orbit of this kind: it changes its sign there.
fn test<E: Event, const D: usize, const U: usize>(
    kind: SpecialKind,
    point: &OrbitPoint<E, D, U>,
) -> f64 {
    match kind {
        SpecialKind::Fold => point.tangent[D],
        SpecialKind::PeriodDoubling => point.seen.doubling(),
        _ => point.seen.torus(),
    }
}

/// The kinds that have a smooth test function.
const SMOOTH: [SpecialKind; 3] =
    [SpecialKind::Fold, SpecialKind::PeriodDoubling, SpecialKind::NeimarkSacker];

/// All special orbits between two neighbouring orbits, in order.
pub fn special_orbits<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
    to: &OrbitPoint<M::Event, D, U>,
) -> Vec<SpecialOrbit<M::Event, D, U>> {
    let arc = Arc::from(orbits, from);
    let ends = [arc.place(from), arc.place(to)];
    let mut found: Vec<SpecialOrbit<M::Event, D, U>> = SMOOTH
        .into_iter()
        .filter(|kind| test(*kind, from) * test(*kind, to) < 0.0)
        .filter_map(|kind| {
            let (distance, point) = arc.zero([&ends[0], &ends[1]], |it| test(kind, it))?;
            let holds = kind != SpecialKind::NeimarkSacker || turns(&point.seen);
            holds.then_some(SpecialOrbit { kind, distance, point })
        })
        .collect();
    found.extend(changes(orbits, &arc, ends));
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    found
}

/// Whether the pair of multipliers whose product is nearest to one is complex.
fn turns<E: Event, const D: usize, const U: usize>(seen: &Seen<E, D, U>) -> bool {
    let multipliers = seen.multipliers();
    let complex = multipliers.iter().filter(|multiplier| multiplier.im != 0.0);
    complex.map(|multiplier| (multiplier.abs() - 1.0).abs()).any(|away| away < NEAR)
}

/// An orbit with its place on the arc.
type OnArc<E, const D: usize, const U: usize> = Placed<U, Seen<E, D, U>>;

/// Where the sequence of events changes.
fn changes<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    arc: &Arc<'_, U, Orbits<M, D, U>>,
    [from, to]: [OnArc<M::Event, D, U>; 2],
) -> Vec<SpecialOrbit<M::Event, D, U>> {
    let (mut found, mut last) = (Vec::new(), from);
    while last.1.seen.events != to.1.seen.events && found.len() < CHANGES {
        let before = last.1.seen.events.clone();
        let same = |point: &OrbitPoint<M::Event, D, U>| point.seen.events == before;
        let Some([a, b]) = arc.change([&last, &to], same) else { break };
        found.push(changed(orbits, arc, &a, &b));
        last = b;
    }
    found
}

/// What the change from one orbit to the next, rounding apart, is: contact that begins or ceases, or another.
fn changed<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    arc: &Arc<'_, U, Orbits<M, D, U>>,
    a: &OnArc<M::Event, D, U>,
    b: &OnArc<M::Event, D, U>,
) -> SpecialOrbit<M::Event, D, U> {
    let (kind, point) = if a.1.seen.impacts() == b.1.seen.impacts() {
        (SpecialKind::EventSequence, a.1.clone())
    } else {
        let touching = grazed(orbits, &a.1).or_else(|| grazed(orbits, &b.1));
        (SpecialKind::Grazing, touching.unwrap_or_else(|| a.1.clone()))
    };
    SpecialOrbit { kind, distance: arc.place(&point).0, point }
}

/// The orbit near another whose nearest local extremum lies on the surface that it may touch: a maximum where
/// contact begins, a minimum where contact opens.
///
/// Method: Newton's on the orbit and that margin together, whose derivatives are exact and continuous there.
fn grazed<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    near: &OrbitPoint<M::Event, D, U>,
) -> Option<OrbitPoint<M::Event, D, U>> {
    let margin = |_: &[f64; U], seen: &Seen<M::Event, D, U>| {
        let nearest = seen.margin?;
        Some((nearest.value, nearest.gradient))
    };
    let (point, _) = corrected_by(orbits, margin, &near.at, &near.tangent)?;
    (norm(&between(&near.at, &point.at)) < NEAR).then_some(point)
}
