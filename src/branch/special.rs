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
/// An orbit whose margin is below this touches the surface.
const TOUCHES: f64 = 1e-13;
/// A located orbit is known along the arc to this share of it: the rounding of a test function.
const RESOLVED: f64 = 1e-12;

/// A special orbit on its arc.
#[derive(Debug, Clone)]
pub struct SpecialOrbit<E, const D: usize, const U: usize> {
    /// What happens.
    pub kind: SpecialKind,
    /// How far along the arc.
    pub distance: f64,
    /// How far the true one may be, along the arc.
    pub uncertainty: f64,
    /// The orbit.
    pub point: OrbitPoint<E, D, U>,
    /// Of a change of events: whether the orbit just beyond it is stable.
    pub is_stable_beyond: bool,
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

/// All special orbits between two neighbouring orbits, in order; where events change without a grazing they are
/// located to the share `narrow` of the arc.
pub fn special_orbits<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
    to: &OrbitPoint<M::Event, D, U>,
    narrow: f64,
) -> Vec<SpecialOrbit<M::Event, D, U>> {
    let exact = orbits.exactly();
    let arc = Arc::from(&exact, from);
    let ends = [arc.place(from), arc.place(to)];
    let rounding = RESOLVED * (ends[1].0 - ends[0].0);
    let mut found: Vec<SpecialOrbit<M::Event, D, U>> = SMOOTH
        .into_iter()
        .filter(|kind| test(*kind, from) * test(*kind, to) < 0.0)
        .filter_map(|kind| {
            let ((distance, point), apart) = arc.zero([&ends[0], &ends[1]], |it| test(kind, it))?;
            let holds = kind != SpecialKind::NeimarkSacker || turns(&point.seen);
            let (uncertainty, is_stable_beyond) = (apart + rounding, false);
            holds.then_some(SpecialOrbit { kind, distance, uncertainty, point, is_stable_beyond })
        })
        .collect();
    found.extend(changes(orbits, from, ends, narrow));
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
    begins: &OrbitPoint<M::Event, D, U>,
    [from, to]: [OnArc<M::Event, D, U>; 2],
    narrow: f64,
) -> Vec<SpecialOrbit<M::Event, D, U>> {
    let arc = Arc::from(orbits, begins);
    let (mut found, mut last) = (Vec::new(), from.clone());
    while last.1.seen.events != to.1.seen.events && found.len() < CHANGES {
        let before = last.1.seen.events.clone();
        let same = |point: &OrbitPoint<M::Event, D, U>| point.seen.events == before;
        let [a, b] = arc.change([&last, &to], same, narrow);
        let rounding = RESOLVED * (to.0 - from.0);
        let grazing = touching(&orbits.exactly(), &arc, [&a, &b], [from.0, to.0]);
        let (kind, (distance, point), uncertainty) = match grazing {
            Some(touching) => (SpecialKind::Grazing, touching, rounding),
            None => (SpecialKind::EventSequence, a.clone(), b.0 - a.0 + rounding),
        };
        let is_stable_beyond = b.1.seen.is_stable();
        found.push(SpecialOrbit { kind, distance, uncertainty, point, is_stable_beyond });
        last = b;
    }
    found
}

/// The orbit that just touches a surface between two between which contact begins or ceases, or next to them;
/// none where the number of impacts is the same, and the events change in another way.
///
/// Beyond a grazing with a rigid surface no orbit may lie near, and Newton's method finds one far away even before
/// it: then the grazing is approached from the side of fewer impacts, and may be anywhere `within` the arc.
fn touching<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    arc: &Arc<'_, U, Orbits<M, D, U>>,
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
    let placed = arc.place(&approached(orbits, &fewer.1)?);
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

/// The orbit that touches a surface, approached by orbits that each have a tenth of the last one's margin.
fn approached<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
) -> Option<OrbitPoint<M::Event, D, U>> {
    let mut left = from.seen.margin?.value;
    let mut here = from.clone();
    while left.abs() > TOUCHES {
        left *= 0.1;
        here = with_margin(orbits, &here, left)?;
    }
    (here.seen.events == from.seen.events).then_some(here)
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
    let margin = |_: &[f64; U], seen: &Seen<M::Event, D, U>| {
        let nearest = seen.margin?;
        Some((nearest.value - value, nearest.gradient))
    };
    corrected_by(orbits, margin, &near.at, &near.tangent).map(|(point, _)| point)
}
