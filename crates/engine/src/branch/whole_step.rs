//! Whether a step of a branch adds up: whether all that happens between its two orbits is found.

use crate::flow::{Event, System};

use super::SpecialKind;
use super::arc::{Arc, NARROW};
use super::arclength::{between, dot, norm};
use super::bialternate::turns;
use super::family::counterpart;
use super::orbits::{OrbitPoint, Orbits, Seen, SpecialOrbit};
use super::periodic::Periodic;
use super::special::{CHANGES, Change, OnArc, RESOLVED, SMOOTH, Sought, special_orbits, test};

/// The orbit in the middle of a step is so near to the cubic through its ends, relative to the step.
const BENT: f64 = 0.02;
/// A part of an arc that is shorter than this is none.
const NONE: f64 = 1e-9;
/// A test function that has no root comes no nearer to zero between its values than this share of what it changes by.
const AWAY: f64 = 0.25;
/// An extremum with a smaller margin touches its surface.
const TOUCHES: f64 = 1e-9;
/// Where an orbit merges with one of half its period the branch turns to the other half of its orbits. The share of the
/// parameter in its tangent is then known to this over the square of the displacement over half the period.
const ROUNDING: f64 = 1e-13;
/// A shorter step may hold several changes of the events, which are then told one by one.
const SHORT: f64 = 1e-6;
/// Where the return map jumps by less, relative to the motion, the branch goes on.
pub const JUMP: f64 = 1e-5;
/// A multiplier is so near to the unit circle that rounding may decide on which side it is.
const ON_CIRCLE: f64 = 1e-10;
/// An orbit that is no farther from one of half its period has a multiplier that cannot be told from one.
const BESIDE: f64 = 1e-3;

/// Why a step has to be halved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flaw {
    /// More may happen on it than is located.
    Unclear,
    /// The orbits at its ends are of different branches: the return map jumps between them.
    Jump,
}

/// The special orbits between two neighbouring orbits, in order, unless the step does not add up.
///
/// Method: the step is cut where the sequence of events changes, so that the return map is smooth on each part. On each, the
/// orbit in the middle must lie near the cubic through the ends and have their events; a margin and every test function may
/// have no more roots than their values at the three orbits show, as judged by the parabola through these, a margin none at all;
/// and each root is located. Test functions jump between parts alone, so that no jump hides a root. The orbits on the two sides of
/// a cut must not jump, and where nothing special is found as many multipliers must lie beyond the unit circle at both ends.
/// Breaks: where within a smooth part a test function turns twice or an event sequence changes and changes back, and the
/// orbit in the middle shows neither. A fold so near to a period doubling that rounding
/// decides the sign of the tangent is not told from it. Where a motion jumps elsewhere than at the section, as where a slip appears
/// with a length of its own by static friction above kinetic, the events change; with a section in that slip the branch ends.
pub fn special_orbits_of_whole<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
    to: &OrbitPoint<M::Event, D, U>,
    narrow: f64,
) -> Result<Vec<SpecialOrbit<M::Event, D, U>>, Flaw> {
    let exact = orbits.exactly();
    let step = WholeStep::of(&exact, [from, to], narrow);
    let mut found = step.special()?;
    if found.is_empty() && changes_stability(orbits, from, to) {
        return Err(Flaw::Unclear);
    }
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    Ok(found)
}

/// The same of a step that is not halved any more, where what is not located is told as unresolved.
pub fn special_orbits_of_shortest<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
    to: &OrbitPoint<M::Event, D, U>,
    narrow: f64,
) -> Vec<SpecialOrbit<M::Event, D, U>> {
    let mut found = special_orbits(orbits, from, to, Sought::Shown(narrow));
    // Where the events change, a test function may jump.
    let has_changed = from.seen.events != to.seen.events;
    let exact = orbits.exactly();
    let step = WholeStep::of(&exact, [from, to], narrow);
    let ends = step.ends.each_ref();
    let mut missing = SMOOTH.iter().filter(|kind| {
        test(**kind, from) * test(**kind, to) < 0.0
            && found.iter().all(|it| it.kind != **kind)
            && (**kind != SpecialKind::Fold || step.is_known(ends, to))
    });
    let is_silent = found.is_empty() && changes_stability(orbits, from, to);
    if is_silent || !has_changed && missing.next().is_some() {
        let uncertainty = norm(&between(&from.at, &to.at));
        let (kind, distance, point) = (SpecialKind::Unresolved, 0.5 * uncertainty, to.clone());
        let is_stable_beyond = to.seen.is_stable();
        found.push(SpecialOrbit { kind, distance, uncertainty, point, is_stable_beyond });
    }
    found
}

/// Whether the return map jumps between two neighbouring orbits, or the events change too often on the step to be looked at one
/// by one.
///
/// A step that does not add up for another reason may still lead over a jump onto another branch.
pub fn jumps_over<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
    to: &OrbitPoint<M::Event, D, U>,
    narrow: f64,
) -> bool {
    // What is shorter cannot jump.
    if norm(&between(&from.at, &to.at)) <= JUMP {
        return false;
    }
    let exact = orbits.exactly();
    WholeStep::of(&exact, [from, to], narrow).jumps_somewhere()
}

/// Special orbits, as far as they are known to be all.
type All<E, const D: usize, const U: usize> = Option<Vec<SpecialOrbit<E, D, U>>>;

/// Whether two orbits have different numbers of multipliers beyond the unit circle, as far as rounding does not decide, as it
/// does beside an orbit of half the period.
///
/// Where nothing special is found between them two branches may cross, or meet at a corner.
fn changes_stability<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    from: &OrbitPoint<M::Event, D, U>,
    to: &OrbitPoint<M::Event, D, U>,
) -> bool {
    let beyond = beyond_circle(&from.seen).zip(beyond_circle(&to.seen));
    let is_other = beyond.is_some_and(|(from, to)| from != to);
    is_other
        && [from, to]
            .into_iter()
            .all(|point| orbits.halfway(&point.at).is_none_or(|apart| norm(&apart) > BESIDE))
}

/// How many multipliers lie beyond the unit circle; none where rounding may decide it.
fn beyond_circle<E: Event, const D: usize, const U: usize>(seen: &Seen<E, D, U>) -> Option<usize> {
    let moduli = seen.multipliers().map(|it| it.abs());
    let is_clear = moduli.iter().all(|modulus| (modulus - 1.0).abs() > ON_CIRCLE);
    is_clear.then(|| moduli.iter().filter(|modulus| **modulus > 1.0).count())
}

/// A step with the arc on which its orbits lie.
struct WholeStep<'a, 'b, M: System<D>, const D: usize, const U: usize> {
    orbits: &'a Orbits<'b, M, D, U>,
    arc: Arc<'a, U, Orbits<'b, M, D, U>>,
    ends: [OnArc<M::Event, D, U>; 2],
    /// Where events change without a grazing, the place is known to this share of the arc.
    narrow: f64,
}

impl<'a, 'b, M: System<D>, const D: usize, const U: usize> WholeStep<'a, 'b, M, D, U> {
    fn of(
        orbits: &'a Orbits<'b, M, D, U>,
        ends: [&OrbitPoint<M::Event, D, U>; 2],
        narrow: f64,
    ) -> Self {
        let arc = Arc::from(orbits, ends[0]);
        let ends = ends.map(|point| arc.place(point));
        WholeStep { orbits, arc, ends, narrow }
    }

    /// The places of its ends on the arc.
    fn range(&self) -> [f64; 2] {
        self.ends.each_ref().map(|it| it.0)
    }

    fn special(&self) -> Result<Vec<SpecialOrbit<M::Event, D, U>>, Flaw> {
        let [from, to] = &self.ends;
        let mut found = Vec::new();
        let mut last = from.clone();
        while last.1.seen.events != to.1.seen.events {
            let is_short = norm(&between(&from.1.at, &to.1.at)) <= SHORT;
            let change = Change::first(&self.arc, [&last, to], self.narrow);
            if self.jumps(&change) {
                // Before it may lie orbits that are not on the arc, as those behind a corner.
                let adds_up = self.smooth([&last, &change.before]).is_some();
                return Err(if adds_up { Flaw::Jump } else { Flaw::Unclear });
            }
            // Of a longer step nothing more is looked at where another change follows.
            let goes_on = change.after.1.seen.events != to.1.seen.events;
            if goes_on && !is_short || found.len() >= CHANGES {
                return Err(Flaw::Unclear);
            }
            found.extend(self.smooth([&last, &change.before]).ok_or(Flaw::Unclear)?);
            found.push(change.special(self.orbits, &self.arc, self.range()));
            last = change.after;
        }
        found.extend(self.smooth([&last, to]).ok_or(Flaw::Unclear)?);
        Ok(found)
    }

    /// Whether it jumps at one of the changes of its events, or has more of them than are looked at.
    fn jumps_somewhere(&self) -> bool {
        let [from, to] = &self.ends;
        let mut last = from.clone();
        for _ in 0..CHANGES {
            if last.1.seen.events == to.1.seen.events {
                return false;
            }
            let change = Change::first(&self.arc, [&last, to], self.narrow);
            if self.jumps(&change) {
                return true;
            }
            last = change.after;
        }
        true
    }

    /// Whether the return map jumps where events change, as where a capsule that rests breaks away by more static than kinetic
    /// friction: then the orbits on both sides are of different branches.
    fn jumps(&self, change: &Change<M::Event, D, U>) -> bool {
        if change.width() <= JUMP {
            return false;
        }
        let closer = Change::first(&self.arc, [&change.before, &change.after], NARROW);
        closer.width() > JUMP
    }

    /// Whether a fold between two orbits is far enough from an orbit of half its period for its tangent to be known.
    fn is_known(
        &self,
        ends: [&OnArc<M::Event, D, U>; 2],
        point: &OrbitPoint<M::Event, D, U>,
    ) -> bool {
        let slopes = ends.map(|it| test(SpecialKind::Fold, &it.1).abs());
        let steepest = slopes[0].max(slopes[1]);
        let apart = self.orbits.halfway(&point.at);
        apart.is_none_or(|apart| steepest * dot(&apart, &apart) > ROUNDING)
    }

    /// Those of a part on which the events are the same.
    fn smooth(&self, ends: [&OnArc<M::Event, D, U>; 2]) -> All<M::Event, D, U> {
        let length = norm(&between(&ends[0].1.at, &ends[1].1.at));
        if length <= NONE {
            return Some(Vec::new());
        }
        let (middle, away) = self.arc.middle(ends)?;
        let is_same = middle.1.seen.events == ends[0].1.seen.events && away <= BENT * length;
        let part = SmoothPart { places: [ends[0], &middle, ends[1]] };
        if !is_same || !part.keeps_its_margins(self.orbits.period()) {
            return None;
        }
        let mut found = Vec::new();
        for kind in SMOOTH {
            let Some(half) = part.root(kind)? else { continue };
            let (ends, size) = (part.half(half), self.range());
            let ((distance, point), apart) = self.arc.zero(ends, |it| test(kind, it))?;
            let is_told = match kind {
                SpecialKind::NeimarkSacker => turns(&point.seen.multipliers()),
                SpecialKind::Fold => self.is_known(ends, &point),
                _ => true,
            };
            if is_told {
                let uncertainty = apart + RESOLVED * (size[1] - size[0]);
                let is_stable_beyond = false;
                found.push(SpecialOrbit { kind, distance, uncertainty, point, is_stable_beyond });
            }
        }
        Some(found)
    }
}

/// A part of a step on which the events are the same: its ends, and the orbit in the middle.
struct SmoothPart<'a, E, const D: usize, const U: usize> {
    places: [&'a OnArc<E, D, U>; 3],
}

impl<'a, E: Event, const D: usize, const U: usize> SmoothPart<'a, E, D, U> {
    /// The ends of its first half, or of its second.
    fn half(&self, number: usize) -> [&'a OnArc<E, D, U>; 2] {
        [self.places[number], self.places[number + 1]]
    }

    /// Which half holds the only root of a test function, if one does; none where it may have more roots than its three values
    /// show.
    fn root(&self, kind: SpecialKind) -> Option<Option<usize>> {
        let values = self.places.map(|it| test(kind, &it.1));
        match [values[0] * values[1] < 0.0, values[1] * values[2] < 0.0] {
            [true, true] => None,
            [true, false] => Some(Some(0)),
            [false, true] => Some(Some(1)),
            [false, false] => stays_away(&values).then_some(None),
        }
    }

    /// Whether every extremum that is there at all three places stays on its side of the surface that it may touch, and the
    /// nearest one at each.
    ///
    /// Where one touches at an end, a change of the events has been located there.
    fn keeps_its_margins(&self, period: u64) -> bool {
        let nearest = self.places.map(|it| it.1.seen.margin.map(|margin| margin.value));
        if let [Some(first), Some(middle), Some(last)] = nearest
            && !keeps_its_side(&[first, middle, last])
        {
            return false;
        }
        let [first, middle, last] = self.places.map(|it| &it.1.seen.margins[..]);
        middle.iter().all(|here| {
            match [first, last].map(|there| counterpart(here, [middle, there], period)) {
                [Some((_, first)), Some((_, last))] => does_not_cross(&[first, here.1, last]),
                _ => true,
            }
        })
    }
}

/// Whether an extremum with these margins at three places evenly apart stays on its side of the surface; where the events are the
/// same, one that does not has crossed it while another did the contrary.
fn does_not_cross(values: &[f64; 3]) -> bool {
    touches(values) || is_on_one_side(values) && stays_away(values)
}

/// The same of the nearest extremum at each place, which are several where they lie on different sides.
fn keeps_its_side(values: &[f64; 3]) -> bool {
    !is_on_one_side(values) || does_not_cross(values)
}

/// Whether these margins are all below the surface, or all above it.
fn is_on_one_side([first, middle, last]: &[f64; 3]) -> bool {
    first * middle > 0.0 && middle * last > 0.0
}

/// Whether an extremum with these margins touches the surface at one of the ends.
fn touches([first, _, last]: &[f64; 3]) -> bool {
    first.abs().min(last.abs()) <= TOUCHES
}

/// Whether the parabola through three values of one sign, evenly spaced, keeps clear of zero.
fn stays_away([first, middle, last]: &[f64; 3]) -> bool {
    let slope = 0.5 * (last - first);
    // The vertex is this far from the middle, in halves of the part.
    let vertex = -slope / (first - 2.0 * middle + last);
    if vertex.is_nan() || vertex.abs() >= 1.0 {
        return true;
    }
    let extreme = middle + 0.5 * slope * vertex;
    let range = (first - extreme).abs().max((last - extreme).abs());
    extreme * middle > 0.0 && extreme.abs() >= AWAY * range
}
