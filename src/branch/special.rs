//! What happens on a branch between two neighbouring orbits, and where.

use super::SpecialKind;
use super::arc::{Arc, Placed};
use super::arclength::{between, corrected_by, norm};
use super::orbits::{OrbitStation, Orbits, PARAMETER, Seen};

/// Changes of the event sequence between two neighbouring orbits at most.
const CHANGES: usize = 16;
/// The orbit that just touches the stop lies so near to where contact was seen to begin.
const NEAR: f64 = 1e-5;

/// A special orbit on its arc.
#[derive(Debug, Clone)]
pub struct Happening {
    /// What happens.
    pub kind: SpecialKind,
    /// How far along the arc.
    pub distance: f64,
    /// The orbit.
    pub station: OrbitStation,
}

type Test = fn(&OrbitStation) -> f64;

/// What happens smoothly, with the function that changes its sign there.
const TESTS: [(SpecialKind, Test); 3] = [
    (SpecialKind::Fold, |station| station.tangent[PARAMETER]),
    (SpecialKind::PeriodDoubling, |station| station.seen.doubling()),
    (SpecialKind::NeimarkSacker, |station| station.seen.torus()),
];

/// Everything that happens between two neighbouring orbits, in order.
pub fn happenings(orbits: &Orbits, from: &OrbitStation, to: &OrbitStation) -> Vec<Happening> {
    let arc = Arc::from(orbits, from);
    let ends = [arc.place(from), arc.place(to)];
    let mut found: Vec<Happening> = TESTS
        .iter()
        .filter(|(_, test)| test(from) * test(to) < 0.0)
        .filter_map(|&(kind, test)| {
            let (distance, station) = arc.zero([&ends[0], &ends[1]], test)?;
            let holds = kind != SpecialKind::NeimarkSacker || turns(&station.seen);
            holds.then_some(Happening { kind, distance, station })
        })
        .collect();
    found.extend(changes(orbits, &arc, ends));
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    found
}

/// Whether the pair of multipliers whose product is nearest to one is complex.
fn turns(seen: &Seen) -> bool {
    let multipliers = seen.multipliers();
    let complex = multipliers.iter().filter(|multiplier| multiplier.im != 0.0);
    complex.map(|multiplier| (multiplier.abs() - 1.0).abs()).any(|away| away < NEAR)
}

/// Where the sequence of events changes.
fn changes(
    orbits: &Orbits,
    arc: &Arc<'_, 4, Orbits>,
    [from, to]: [Placed<4, Seen>; 2],
) -> Vec<Happening> {
    let (mut found, mut last) = (Vec::new(), from);
    while last.1.seen.events != to.1.seen.events && found.len() < CHANGES {
        let before = last.1.seen.events.clone();
        let same = |station: &OrbitStation| station.seen.events == before;
        let Some([a, b]) = arc.change([&last, &to], same) else { break };
        found.push(changed(orbits, arc, &a, &b));
        last = b;
    }
    found
}

/// What the change from one orbit to the next, rounding apart, is: contact that begins or ceases, or another.
fn changed(
    orbits: &Orbits,
    arc: &Arc<'_, 4, Orbits>,
    a: &Placed<4, Seen>,
    b: &Placed<4, Seen>,
) -> Happening {
    let (kind, station) = if a.1.seen.impacts() == b.1.seen.impacts() {
        (SpecialKind::EventSequence, a.1.clone())
    } else {
        let touching = grazed(orbits, &a.1).or_else(|| grazed(orbits, &b.1));
        (SpecialKind::Grazing, touching.unwrap_or_else(|| a.1.clone()))
    };
    Happening { kind, distance: arc.place(&station).0, station }
}

/// The orbit near another whose nearest local extremum of r lies on the stop: a maximum where contact
/// begins, a minimum where contact opens.
///
/// Method: Newton's on the orbit and that margin together, whose derivatives are exact and continuous there.
fn grazed(orbits: &Orbits, near: &OrbitStation) -> Option<OrbitStation> {
    let margin = |_: &[f64; 4], seen: &Seen| {
        let nearest = seen.margin?;
        Some((nearest.value, nearest.gradient))
    };
    let (station, _) = corrected_by(orbits, margin, &near.at, &near.tangent)?;
    (norm(&between(&near.at, &station.at)) < NEAR).then_some(station)
}
