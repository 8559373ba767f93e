//! Curves of special points in two parameters.

use super::across::{Unknowns, across_section};
use super::arclength::{CurvePoint, Plane, between, corrected, dot, norm, tangent};
use super::codim2::{Met, met, sum_of_pair};
use super::corner::is_corner;
use super::locus::{Locus, LocusPoint, Seen};
use super::merger::HALF;
use super::orbits::{Orbits, STEEPEST};
use super::periodic::{Goal, Periodic, passes};
use super::step_control::{Advance, Bounds, StepControl};
use super::{Codim2, Codim2Kind, Curve, End, Request, Special, SpecialKind};
use crate::flow::System;
use crate::orbit::Varied;

/// A curve begins at its special point to within this, relative to each unknown.
const AT_SPECIAL: f64 = 1e-9;
/// Points of a curve closer together than this are one.
const ONE: f64 = 1e-12;
/// Grazings are followed beside the surface, at this margin on one side or the other, relative to the first coordinate.
const BESIDE: [f64; 2] = [1e-7, -1e-7];
/// A step across an orbit of half the period is shortened to this share of the longest.
const ACROSS: f64 = 0.03;
/// In such a step the displacement over half the period may turn round so fast, per length of the step; in a shorter one faster.
const GENTLE: f64 = 10.0;
/// Where the displacement over half the period still turns round in a shorter step, it jumps: an event passes the instant of the
/// section there.
const LEAST: f64 = 1e-6;

/// A curve with the orbits on it.
#[derive(Debug, Clone)]
pub struct Trace<M: System<D>, const D: usize, const W: usize> {
    locus: Locus<M, D, W>,
    through: (usize, usize),
    /// The solutions that were followed, and the special orbits that they stand for.
    points: Vec<[f64; W]>,
    special: Vec<[f64; W]>,
    /// The points of codimension 2, each after one of these.
    codim2: Vec<(usize, Met<W>)>,
    ends: [End; 2],
}

impl<M: System<D>, const D: usize, const W: usize> Trace<M, D, W> {
    /// What is kept of it.
    pub fn curve(&self) -> Curve {
        let points = self.special.iter().map(|at| self.parameters(at)).collect();
        let codim2 = self.codim2.iter().map(|(after, met)| Codim2 {
            kind: met.kind,
            after: *after,
            parameters: self.parameters(&met.at),
            section: (0..D).map(|i| met.at[i] * self.locus.units[i]).collect(),
            multipliers: met.multipliers.clone(),
        });
        let (kind, period) = (self.locus.kind, self.locus.family.period);
        let codim2 = codim2.collect();
        Curve { kind, through: self.through, period, points, codim2, ends: self.ends }
    }

    /// The two parameters of a solution, in their own units.
    fn parameters(&self, at: &[f64; W]) -> [f64; 2] {
        [D, D + 1].map(|i| at[i] * self.locus.units[i])
    }

    /// Whether it goes through an orbit, from whichever of its section points.
    fn passes(&self, point: &LocusPoint<W>) -> bool {
        let images = self.locus.images(point);
        self.points.windows(2).any(|ends| {
            images.iter().any(|image| passes(&self.locus, [&ends[0], &ends[1]], &image.at))
        })
    }
}

/// A solution, and the special orbit that it stands for.
type Both<const W: usize> = ([f64; W], [f64; W]);

/// Whether special points of a kind are followed as curves.
pub fn is_followed(kind: SpecialKind) -> bool {
    matches!(
        kind,
        SpecialKind::Fold
            | SpecialKind::PeriodDoubling
            | SpecialKind::NeimarkSacker
            | SpecialKind::Grazing
    )
}

/// The number of the curve in two parameters through a special point of a branch, which is added to
/// `traces` unless one of them goes through it already.
///
/// None for what is not followed, where no second parameter is asked for, and where the equations of the
/// curve do not hold at the special point.
pub fn trace<M: System<D>, O, const D: usize, const U: usize, const W: usize>(
    request: &Request<M, D>,
    orbits: &Orbits<M, D, U>,
    through: (usize, usize),
    special: &Special<O, [f64; D]>,
    traces: &mut Vec<Trace<M, D, W>>,
) -> Option<usize> {
    let (second, range) = request.second?;
    let width = range[1] - range[0];
    let value = request.system.value(second);
    let inside = (range[0]..=range[1]).contains(&value) && width > 0.0;
    if !is_followed(special.kind) || !inside || second == request.along {
        return None;
    }
    let first_range = request.curve_range.unwrap_or(request.range);
    let along = first_range[1] - first_range[0];
    let mut units = [width; W];
    units[..D].copy_from_slice(&orbits.units[..D]);
    units[D] = along;
    let free = [request.along, second];
    let mut family = orbits.family.clone();
    family.period = period(orbits, special);
    let locus = Locus { family, free, units, kind: special.kind, margin: 0.0, touches_near: None };
    let (locus, start) = begun(locus, special, value)?;
    let known = traces.iter().position(|trace| {
        (trace.locus.kind, trace.locus.period()) == (locus.kind, locus.period())
            && trace.passes(&start)
    });
    if known.is_some() {
        return known;
    }
    let bounds = Bounds::none()
        .with(D, first_range.map(|end| end / along))
        .with(D + 1, range.map(|end| end / width));
    let control = StepControl::new(bounds, request.longest_step);
    let Joined { points, codim2, ends } =
        both_directions(&locus, &start, control, request.most_points);
    let (points, special) = points.into_iter().unzip();
    traces.push(Trace { locus, through, points, special, codim2, ends });
    Some(traces.len() - 1)
}

/// The equations of a curve with the point of it from which it is followed: of grazings beside the surface, on the side without
/// the impact if there is one, as the return map of a rigid surface is smooth there.
fn begun<M: System<D>, O, const D: usize, const W: usize>(
    locus: Locus<M, D, W>,
    special: &Special<O, [f64; D]>,
    second: f64,
) -> Option<(Locus<M, D, W>, LocusPoint<W>)> {
    let margins: &[f64] = if special.kind == SpecialKind::Grazing { &BESIDE } else { &[0.0] };
    let begun = margins.iter().filter_map(|&margin| {
        let locus = Locus { margin, ..locus.clone() };
        let start = start(&locus, special, second)?;
        Some((locus, start))
    });
    begun.min_by_key(|(_, start)| start.seen.impacts)
}

/// The period of a special orbit: half that of the branch where it merges in a grazing, and no other orbit lies on its curve.
fn period<M: System<D>, O, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    special: &Special<O, [f64; D]>,
) -> u64 {
    let Some(section) = special.point.section.first() else { return orbits.family.period };
    let at = orbits.unknowns(section, special.point.parameter);
    let is_half = special.kind == SpecialKind::Grazing
        && orbits.halfway(&at).is_some_and(|apart| norm(&apart) <= HALF);
    orbits.family.period / if is_half { 2 } else { 1 }
}

/// The special point as a point of its curve, with the tangent there.
fn start<M: System<D>, O, const D: usize, const W: usize>(
    locus: &Locus<M, D, W>,
    special: &Special<O, [f64; D]>,
    second: f64,
) -> Option<LocusPoint<W>> {
    let section = special.point.section.first()?;
    let parameters = [special.point.parameter, second];
    let at: [f64; W] = std::array::from_fn(|i| {
        let raw = section.get(i).unwrap_or_else(|| &parameters[i - D]);
        raw / locus.units[i]
    });
    let plane = Plane::fixing(D + 1, at[D + 1]);
    let (start, _) = corrected(locus, &plane, &at, &plane.normal)?;
    let away = between(&at, &locus.special(&start, &plane.normal)?);
    let tangent = tangent(start.rows, &plane.normal)?;
    let is_near = (0..W).all(|i| away[i].abs() <= AT_SPECIAL * at[i].abs().max(1.0));
    is_near.then_some(CurvePoint { tangent, ..start })
}

/// A curve from one end to the other.
struct Joined<const W: usize> {
    points: Vec<Both<W>>,
    codim2: Vec<(usize, Met<W>)>,
    ends: [End; 2],
}

/// The curve through an orbit from one end to the other, of so many points at most.
fn both_directions<M: System<D>, const D: usize, const W: usize>(
    locus: &Locus<M, D, W>,
    start: &LocusPoint<W>,
    control: StepControl<W>,
    most: usize,
) -> Joined<W> {
    let back = turned(start);
    let goal = Goal::at(locus, &back);
    let (backward, end) = Direction::begun(locus, &back, control).follow(most.div_ceil(2), &goal);
    let Direction { mut points, mut codim2, last, .. } = backward;
    if end == End::Closed {
        return Joined { points, codim2, ends: [end; 2] };
    }
    // A closed curve that is longer than one half meets the end of that half.
    let left = most + 1 - points.len();
    let goal = Goal::at(locus, &turned(&last));
    let (forward, other_end) = Direction::begun(locus, start, control).follow(left, &goal);
    let begins = points.len() - 1;
    points.reverse();
    points.extend(forward.points.into_iter().skip(1));
    codim2.reverse();
    codim2.iter_mut().for_each(|(after, _)| *after = begins - 1 - *after);
    codim2.extend(forward.codim2.into_iter().map(|(after, met)| (begins + after, met)));
    let ends = if other_end == End::Closed { [other_end; 2] } else { [end, other_end] };
    Joined { points, codim2, ends }
}

/// A point of a curve with its tangent reversed.
fn turned<const W: usize>(point: &LocusPoint<W>) -> LocusPoint<W> {
    CurvePoint { tangent: point.tangent.map(|part| -part), ..point.clone() }
}

/// A curve from a point on along its tangent, as far as it has been followed.
struct Direction<'l, M: System<D>, const D: usize, const W: usize> {
    locus: &'l Locus<M, D, W>,
    control: StepControl<W>,
    points: Vec<Both<W>>,
    /// Its points of codimension 2, each after one of these.
    codim2: Vec<(usize, Met<W>)>,
    /// The last point with its tangent.
    last: LocusPoint<W>,
}

impl<'l, M: System<D>, const D: usize, const W: usize> Direction<'l, M, D, W> {
    /// The point at which it begins; the special point that it was begun from lies on it.
    fn begun(locus: &'l Locus<M, D, W>, start: &LocusPoint<W>, control: StepControl<W>) -> Self {
        let begun = locus.special(start, &Plane::fixing(D + 1, start.at[D + 1]).normal);
        let points = vec![(start.at, begun.unwrap_or(start.at))];
        Direction { locus, control, points, codim2: Vec::new(), last: start.clone() }
    }

    /// Follows the curve until it ends, closes at `goal` or has `most` points.
    fn follow(mut self, most: usize, goal: &Goal<W, Seen>) -> (Self, End) {
        while self.points.len() < most {
            if let Some(end) = self.advance(goal) {
                return (self, end);
            }
        }
        (self, End::MostPoints)
    }

    /// Adds the next point, unless the step is halved, and says why the curve ends if it does.
    fn advance(&mut self, goal: &Goal<W, Seen>) -> Option<End> {
        let (next, at_bound) = match self.control.advance(self.locus, &self.last) {
            Advance::Inside(next) => (next, false),
            Advance::AtBound(next) => (next, true),
            Advance::Nowhere => return self.beyond_section(),
        };
        if let Some(goal) = goal.met(self.locus, [&self.last, &next], self.points.len()) {
            self.note(&goal, false);
            self.points.push(self.with_special(&goal, false));
            self.last = goal;
            return Some(End::Closed);
        }
        let step = norm(&between(&self.last.at, &next.at));
        if let Some(apart) = comes_back(self.locus, &self.last, &next) {
            let [short, shortest] =
                [ACROSS, LEAST].map(|share| step <= share * self.control.longest);
            // The curve turns where its orbits halve, which a short step comes near enough.
            if short && apart <= if shortest { STEEPEST } else { GENTLE } * step {
                return Some(End::Merged);
            }
            if !shortest {
                self.control.next = 0.5 * step;
                return None;
            }
        }
        if let Some(end) = self.note(&next, false) {
            return Some(end);
        }
        if step > ONE {
            self.points.push(self.with_special(&next, at_bound));
        }
        self.last = next;
        // Steps no longer than rounding lead nowhere.
        let stops = (step <= ONE).then_some(End::Stopped);
        if at_bound { Some(End::Bound) } else { stops }
    }

    /// Adds the point beyond the instant of the section, where no step leads on and the section point jumps there.
    fn beyond_section(&mut self) -> Option<End> {
        let Locus { family, units, free, .. } = self.locus;
        let free = free.map(Varied::One);
        let unknowns = Unknowns { family, units, free: &free };
        let beyond = across_section(self.locus, &unknowns, &self.control, &self.last);
        let (next, at_bound) = match beyond {
            Some(Advance::Inside(next)) => (next, false),
            Some(Advance::AtBound(next)) => (next, true),
            _ => return Some(dead_end(self.locus, &self.last)),
        };
        self.note(&next, true);
        self.points.push(self.with_special(&next, at_bound));
        self.last = next;
        at_bound.then_some(End::Bound)
    }

    /// Takes note of the points of codimension 2 before the next point, across which the section point may jump, and says why the
    /// curve ends at one of them if it does: where the pair of a Neimark-Sacker point becomes real.
    fn note(&mut self, next: &LocusPoint<W>, jumps: bool) -> Option<End> {
        let after = self.points.len() - 1;
        let mut met = met(self.locus, [&self.last, next], jumps);
        let is_torus = self.locus.kind == SpecialKind::NeimarkSacker;
        if !is_torus || sum_of_pair::<M, D, W>(next).abs() < 2.0 {
            self.codim2.extend(met.into_iter().map(|it| (after, it)));
            return None;
        }
        let is_resonance =
            |it: &Met<W>| matches!(it.kind, Codim2Kind::Resonance1 | Codim2Kind::Resonance2);
        let place = met.iter().position(is_resonance);
        met.truncate(place.map_or(met.len(), |place| place + 1));
        let resonance = place.and_then(|_| met.last()).cloned();
        self.codim2.extend(met.into_iter().map(|it| (after, it)));
        let Some(Met { at, point, .. }) = resonance else { return Some(End::Stopped) };
        self.points.push((at, at));
        self.last = point;
        Some(End::StrongResonance)
    }

    /// A point with the special orbit that it stands for, which lies at the bound, too, where the point does.
    fn with_special(&self, point: &LocusPoint<W>, at_bound: bool) -> Both<W> {
        let bounds = &self.control.bounds;
        let fixed =
            (D..W).find(|&i| at_bound && [bounds.low[i], bounds.high[i]].contains(&point.at[i]));
        let normal = fixed.map_or(point.tangent, |i| Plane::fixing(i, point.at[i]).normal);
        (point.at, self.locus.special(point, &normal).unwrap_or(point.at))
    }
}

/// Why no step leads on from an orbit.
fn dead_end<M: System<D>, const D: usize, const W: usize>(
    locus: &Locus<M, D, W>,
    last: &LocusPoint<W>,
) -> End {
    if locus.vanishes(last) {
        End::Vanishes
    } else if is_corner(locus, last) {
        End::Corner
    } else {
        End::Stopped
    }
}

/// Whether a curve seems to pass an orbit of half the period, and to lead back as the other half of its orbits: then by how much
/// the displacement over half the period changes. At a merger it vanishes, so that this goes down with the step.
///
/// A grazing does not: half a period later another extremum touches.
fn comes_back<M: System<D>, const D: usize, const W: usize>(
    locus: &Locus<M, D, W>,
    from: &LocusPoint<W>,
    to: &LocusPoint<W>,
) -> Option<f64> {
    if locus.kind == SpecialKind::Grazing {
        return None;
    }
    let (before, after) = (locus.halfway(&from.at)?, locus.halfway(&to.at)?);
    (dot(&before, &after) < 0.0).then(|| norm(&between(&before, &after)))
}
