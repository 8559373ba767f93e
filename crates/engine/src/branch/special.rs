//! The special orbits of a branch between two neighbouring orbits.

use crate::flow::{Event, System};

use super::SpecialKind;
use super::arc::{Arc, Placed};
use super::arclength::{between, norm};
use super::bialternate::turns;
use super::grazing::touching;
use super::orbits::{OrbitPoint, Orbits, Seen, SpecialOrbit};

/// Changes of the event sequence between two neighbouring orbits at most.
pub(super) const CHANGES: usize = 16;
/// Changes of the event sequence that are no farther apart are one.
const ONE_PLACE: f64 = 1e-10;
/// A located orbit is known along the arc to this share of it: the rounding of a test function.
pub(super) const RESOLVED: f64 = 1e-12;

/// The test function of a special orbit of this kind: it changes its sign there.
pub(super) fn test<E: Event, const D: usize, const U: usize>(
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
pub(super) const SMOOTH: [SpecialKind; 3] =
    [SpecialKind::Fold, SpecialKind::PeriodDoubling, SpecialKind::NeimarkSacker];

/// Which special orbits are located.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sought {
    /// All, where each step adds up; where events change without a grazing to this share of the arc.
    Every(f64),
    /// All that two neighbouring orbits show; where events change likewise.
    Shown(f64),
    /// Folds alone.
    Folds,
}

/// The special orbits that are sought between two neighbouring orbits, in order.
pub fn special_orbits<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
    to: &OrbitPoint<M::Event, D, U>,
    sought: Sought,
) -> Vec<SpecialOrbit<M::Event, D, U>> {
    let exact = orbits.exactly();
    let arc = Arc::from(&exact, from);
    let ends = [arc.place(from), arc.place(to)];
    let rounding = RESOLVED * (ends[1].0 - ends[0].0);
    let mut found: Vec<SpecialOrbit<M::Event, D, U>> = SMOOTH
        .into_iter()
        .filter(|kind| sought != Sought::Folds || *kind == SpecialKind::Fold)
        .filter(|kind| test(*kind, from) * test(*kind, to) < 0.0)
        .filter_map(|kind| {
            let ((distance, point), apart) = arc.zero([&ends[0], &ends[1]], |it| test(kind, it))?;
            let holds = kind != SpecialKind::NeimarkSacker || turns(&point.seen.multipliers());
            let (uncertainty, is_stable_beyond) = (apart + rounding, false);
            holds.then_some(SpecialOrbit { kind, distance, uncertainty, point, is_stable_beyond })
        })
        .collect();
    if let Sought::Shown(narrow) = sought {
        found.extend(changes(orbits, from, ends, narrow));
    }
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    found
}

/// An orbit with its place on the arc.
pub(super) type OnArc<E, const D: usize, const U: usize> = Placed<U, Seen<E, D, U>>;

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
        let change = Change::first(&arc, [&last, &to], narrow);
        found.push(change.special(orbits, &arc, [from.0, to.0]));
        last = change.after;
    }
    found
}

/// A change of the sequence of events on an arc.
pub(super) struct Change<E, const D: usize, const U: usize> {
    /// The last orbit before it.
    pub before: OnArc<E, D, U>,
    /// The first one after it.
    pub after: OnArc<E, D, U>,
}

impl<E: Event, const D: usize, const U: usize> Change<E, D, U> {
    /// The first between two orbits, to the share `narrow` of their distance, with all that changes at its place: of a symmetric motion
    /// two events change at once, which rounding may tell apart.
    pub(super) fn first<M: System<D, Event = E>>(
        arc: &Arc<'_, U, Orbits<'_, M, D, U>>,
        ends: [&OnArc<E, D, U>; 2],
        narrow: f64,
    ) -> Self {
        let events = &ends[0].1.seen.events;
        let [before, after] = arc.change(ends, |point| point.seen.events == *events, narrow);
        if after.1.seen.events == ends[1].1.seen.events {
            return Change { before, after };
        }
        let after = arc.onward([&before, ends[1]], ONE_PLACE).unwrap_or(after);
        Change { before, after }
    }

    /// How far the two orbits are apart.
    pub(super) fn width(&self) -> f64 {
        norm(&between(&self.before.1.at, &self.after.1.at))
    }

    /// What happens there, on an arc of this range.
    pub(super) fn special<M: System<D, Event = E>>(
        &self,
        orbits: &Orbits<'_, M, D, U>,
        arc: &Arc<'_, U, Orbits<'_, M, D, U>>,
        range: [f64; 2],
    ) -> SpecialOrbit<E, D, U> {
        let Change { before, after } = self;
        let rounding = RESOLVED * (range[1] - range[0]);
        let grazing = touching(&orbits.exactly(), arc, [before, after], range);
        let (kind, (distance, point), uncertainty) = match grazing {
            Some(touching) => (SpecialKind::Grazing, touching, rounding),
            // Along the curve they are farther apart than along the tangent where the arc begins.
            None => (SpecialKind::EventSequence, before.clone(), self.width() + rounding),
        };
        let is_stable_beyond = after.1.seen.is_stable();
        SpecialOrbit { kind, distance, uncertainty, point, is_stable_beyond }
    }
}
