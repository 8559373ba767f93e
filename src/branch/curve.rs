//! Curves of special points in two parameters.

use crate::flow::System;

use super::arclength::{CurvePoint, Plane, between, corrected, norm, tangent};
use super::corner::is_corner;
use super::locus::{Locus, LocusPoint, Touch};
use super::orbits::Orbits;
use super::periodic::{Goal, Periodic, passes};
use super::step_control::{Advance, Bounds, StepControl};
use super::{Curve, End, Request, Special, SpecialKind};

/// A curve begins at its special point to within this, relative to each unknown.
const AT_SPECIAL: f64 = 1e-9;
/// Points of a curve closer together than this are one.
const ONE: f64 = 1e-12;
/// A step across an orbit of half the period is shortened to this share of the longest.
const ACROSS: f64 = 0.03;

/// A curve with the orbits on it.
#[derive(Debug, Clone)]
pub struct Trace<M: System<D>, const D: usize, const W: usize> {
    locus: Locus<M, D, W>,
    through: (usize, usize),
    points: Vec<[f64; W]>,
    ends: [End; 2],
}

impl<M: System<D>, const D: usize, const W: usize> Trace<M, D, W> {
    /// What is kept of it.
    pub fn curve(&self) -> Curve {
        let value = |at: &[f64; W]| [D, D + 1].map(|i| at[i] * self.locus.units[i]);
        let points = self.points.iter().map(value).collect();
        let (kind, period) = (self.locus.kind, self.locus.family.period);
        Curve { kind, through: self.through, period, points, ends: self.ends }
    }

    /// Whether it goes through an orbit, from whichever of its section points.
    fn passes(&self, point: &LocusPoint<W>) -> bool {
        let images = self.locus.images(point);
        let through = |ends: &[[f64; W]], at| passes(&self.locus, [&ends[0], &ends[1]], at);
        self.points.windows(2).any(|ends| images.iter().any(|image| through(ends, &image.at)))
    }
}

/// Whether special points of a kind are followed as curves.
pub fn is_followed(kind: SpecialKind) -> bool {
    matches!(kind, SpecialKind::Fold | SpecialKind::PeriodDoubling | SpecialKind::Grazing)
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
    special: &Special<O, D>,
    traces: &mut Vec<Trace<M, D, W>>,
) -> Option<usize> {
    let (second, range) = request.second?;
    let width = range[1] - range[0];
    let value = request.system.value(second);
    let inside = (range[0]..=range[1]).contains(&value) && width > 0.0;
    if !is_followed(special.kind) || !inside || second == request.along {
        return None;
    }
    let along = orbits.units[D];
    let units = std::array::from_fn(|i| *orbits.units.get(i).unwrap_or(&width));
    let free = [request.along, second];
    let locus = Locus { family: orbits.family.clone(), free, units, kind: special.kind };
    let start = start(&locus, special, value)?;
    let alike = |trace: &Trace<M, D, W>| {
        (trace.locus.kind, trace.locus.period()) == (locus.kind, locus.period())
    };
    if let Some(known) = traces.iter().position(|trace| alike(trace) && trace.passes(&start)) {
        return Some(known);
    }
    let bounds = Bounds::none()
        .with(D, request.range.map(|end| end / along))
        .with(D + 1, range.map(|end| end / width));
    let control = StepControl::new(bounds, request.longest_step);
    let (points, ends) = both_directions(&locus, &start, control, request.most_points);
    traces.push(Trace { locus, through, points, ends });
    Some(traces.len() - 1)
}

/// The special point as a point of its curve, with the tangent there.
fn start<M: System<D>, O, const D: usize, const W: usize>(
    locus: &Locus<M, D, W>,
    special: &Special<O, D>,
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
    let away = between(&at, &start.at);
    let near = |i: usize| away[i].abs() <= AT_SPECIAL * at[i].abs().max(1.0);
    let tangent = tangent(start.rows, &plane.normal)?;
    (0..W).all(near).then_some(CurvePoint { tangent, ..start })
}

/// The curve through an orbit from one end to the other, of so many points at most.
fn both_directions<M: System<D>, const D: usize, const W: usize>(
    locus: &Locus<M, D, W>,
    start: &LocusPoint<W>,
    control: StepControl<W>,
    most: usize,
) -> (Vec<[f64; W]>, [End; 2]) {
    let back = turned(start);
    let (mut points, last, end) =
        one_direction(locus, &back, control, most.div_ceil(2), &Goal::at(locus, &back));
    if end == End::Closed {
        return (points, [end; 2]);
    }
    // A closed curve that is longer than one half meets the end of that half.
    let left = most + 1 - points.len();
    let goal = Goal::at(locus, &turned(&last));
    let (forward, _, other_end) = one_direction(locus, start, control, left, &goal);
    points.reverse();
    points.extend(forward.into_iter().skip(1));
    (points, if other_end == End::Closed { [other_end; 2] } else { [end, other_end] })
}

/// A point of a curve with its tangent reversed.
fn turned<const W: usize>(point: &LocusPoint<W>) -> LocusPoint<W> {
    CurvePoint { tangent: point.tangent.map(|part| -part), ..point.clone() }
}

/// The curve from a point on along its tangent, its last point with the tangent, and why it ends.
fn one_direction<M: System<D>, const D: usize, const W: usize>(
    locus: &Locus<M, D, W>,
    start: &LocusPoint<W>,
    mut control: StepControl<W>,
    most: usize,
    goal: &Goal<W, Option<Touch>>,
) -> (Vec<[f64; W]>, LocusPoint<W>, End) {
    let mut points = vec![start.at];
    let mut last = start.clone();
    while points.len() < most {
        let advance = control.advance(locus, &last);
        let at_bound = matches!(advance, Advance::AtBound(_));
        let (Advance::Inside(next) | Advance::AtBound(next)) = advance else {
            let end = dead_end(locus, &last);
            return (points, last, end);
        };
        if let Some(goal) = goal.met(locus, [&last, &next], points.len()) {
            points.push(goal.at);
            return (points, goal, End::Closed);
        }
        let step = norm(&between(&last.at, &next.at));
        if comes_back(locus, &last, &next) {
            // The curve turns where its orbits halve, which a short step comes near enough.
            if step <= ACROSS * control.longest {
                return (points, last, End::Merged);
            }
            control.next = 0.5 * step;
            continue;
        }
        if step > ONE {
            points.push(next.at);
        }
        last = next;
        if at_bound {
            return (points, last, End::Bound);
        }
        // Steps no longer than rounding lead nowhere.
        if step <= ONE {
            return (points, last, End::Stopped);
        }
    }
    (points, last, End::MostPoints)
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

/// Whether a curve passes an orbit of half the period and leads back as the other half of its orbits.
///
/// A grazing does not: half a period later another extremum touches.
fn comes_back<M: System<D>, const D: usize, const W: usize>(
    locus: &Locus<M, D, W>,
    from: &LocusPoint<W>,
    to: &LocusPoint<W>,
) -> bool {
    locus.kind != SpecialKind::Grazing && locus.halves(&from.at, &to.at)
}
