//! The curve in a plane of starts on which two basins meet, followed from a point of it.

use super::crossing::{Ahead, Crossing};
use super::manifold::{CurveEnd, StableCurve};
use super::saddle_frame::SaddleFrame;
use super::start_plane::{Approach, NoApproach, StartPlane};

/// The longest step, the sides of the plane being one.
const LONGEST: f64 = 0.02;
/// The first step.
const FIRST: f64 = 1e-3;
/// The shortest step by derivatives: where it fails, the curve has a corner or ends.
const SHORTEST: f64 = 1e-5;
/// The chord is so far from the curve at most, by its turn, and the step is chosen for half as far.
const CHORD: f64 = 2e-4;
/// The curve turns by so much in a step at most [rad].
const TURN: f64 = 0.3;
/// A correction is at most this share of the step.
const CORRECTION: f64 = 0.5;
/// A point is found where its correction is so small, the sides of the plane being one.
const FOUND: f64 = 1e-9;
/// Corrections at most.
const CORRECTIONS: usize = 9;
/// The correction must not be nearly along the curve: the least cosine with the normal.
const ACROSS: f64 = 0.05;
/// A curve has so many points at most, and so many of them that are found by division.
const MOST_POINTS: usize = 4000;
const MOST_DIVIDED: usize = 400;
/// The radii of the circles on which the next point is sought by division, the sides of the plane being one.
const RADII: [f64; 5] = [1.6e-2, 4e-3, 1e-3, 2e-4, 4e-5];
/// A curve is given up where so many steps in a row are shorter than this: it is wound up too narrowly.
const SHORT_STEPS: usize = 60;
const SHORT: f64 = 1e-4;
/// A curve begins to be able to close after so many points.
const CAN_CLOSE: usize = 8;
/// Motions are followed so many periods of the saddle longer than those of the point before.
const PERIODS: usize = 2;

/// A point of a curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurvePoint {
    /// Where it is.
    pub at: [f64; 2],
    /// The direction in which the curve goes on, of size one.
    pub tangent: [f64; 2],
    /// Cycles after which a motion from there is nearest to the saddle.
    cycles: usize,
    /// How far it may be from the manifold.
    error: f64,
    /// Whether it was found by division.
    divided: bool,
}

/// An end of a curve at which nothing more was found.
#[derive(Debug, Clone, Copy)]
pub(super) struct OpenEnd {
    /// Where it is.
    pub at: [f64; 2],
    /// The direction in which the curve would go on.
    pub outward: [f64; 2],
}

/// What follows one curve.
pub(super) struct Follower<'a, const D: usize> {
    /// The plane.
    pub plane: &'a StartPlane<'a, D>,
    /// The saddle whose stable manifold it is, if it is known, and its place among all.
    pub saddle: Option<(usize, &'a SaddleFrame<D>)>,
    /// The attractors on the left and on the right of the curve.
    pub sides: [u32; 2],
    /// Ends of other curves that are open.
    pub open: &'a [OpenEnd],
    /// Points that it may still have.
    pub most: usize,
}

/// A step that fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Failed {
    /// The motions do not come near the saddle.
    Far,
    /// For another reason.
    Other,
}

impl<const D: usize> Follower<'_, D> {
    /// The curve through a crossing of the boundary, both ways from it; none where it has no second point.
    ///
    /// Method: where the motions pass near the saddle, steps along the tangent, each corrected by Newton's method across it; a
    /// step is repeated with half its length where it turns by more than is allowed or does not converge. Where that fails the
    /// next point is where the attractors of the starts on a circle around the last point change from those on the left to those
    /// on the right.
    pub fn curve(&self, crossing: &Crossing) -> Option<StableCurve> {
        let first = self.first(crossing)?;
        let (mut points, mut end) = self.half(first);
        let mut ends = [end, end];
        if end != CurveEnd::Closed {
            let [x, y] = first.tangent;
            let back = CurvePoint { tangent: [-x, -y], ..first };
            let turned = Follower { sides: [self.sides[1], self.sides[0]], ..*self };
            let mut before;
            (before, end) = turned.half(back);
            before.reverse();
            before.pop();
            before.append(&mut points);
            (points, ends[0]) = (before, end);
        }
        if points.len() < 2 {
            return None;
        }
        let pairs = points.windows(2);
        let length = pairs.map(|pair| distance(&pair[0].at, &pair[1].at)).sum();
        let found = points.iter().filter(|it| !it.divided);
        Some(StableCurve {
            saddle: self.saddle.map(|it| it.0),
            sides: self.sides,
            points: points.iter().map(|it| it.at).collect(),
            divided: points.iter().map(|it| it.divided).collect(),
            ends,
            length,
            error: found.map(|it| it.error).fold(0.0, f64::max),
        })
    }

    /// The point of the curve at a crossing.
    fn first(&self, crossing: &Crossing) -> Option<CurvePoint> {
        let at = crossing.at();
        if self.saddle.is_some() {
            let across = crossing.across();
            return self.corrected(&at, &across, crossing.width(), 0).ok();
        }
        let tangent = crossing.along();
        Some(CurvePoint { at, tangent, cycles: 0, error: 0.0, divided: true })
    }

    /// One half of the curve from its first point on.
    fn half(&self, first: CurvePoint) -> (Vec<CurvePoint>, CurveEnd) {
        let mut points = vec![first];
        let (mut step, mut divided, mut short) = (FIRST, 0, 0);
        loop {
            let last = points[points.len() - 1];
            let is_full = points.len() >= MOST_POINTS.min(self.most) || divided > MOST_DIVIDED;
            if is_full || self.plane.is_spent() {
                return (points, CurveEnd::Length);
            }
            let mut next = Err(Failed::Other);
            if self.saddle.is_some() {
                next = self.next(&last, &mut step);
            }
            let next = next.or_else(|failed| {
                step = FIRST;
                divided += 1;
                let found = self.divided(&last);
                found.or_else(|| self.divided(&along_chord(&points)?)).ok_or(failed)
            });
            let point = match next {
                Ok(point) => point,
                Err(Failed::Far) => return (points, CurveEnd::Far),
                Err(Failed::Other) => return (points, CurveEnd::Lost),
            };
            short = if distance(&last.at, &point.at) < SHORT { short + 1 } else { 0 };
            if short > SHORT_STEPS {
                return (points, CurveEnd::Lost);
            }
            if let Some(end) = self.take(&mut points, point) {
                return (points, end);
            }
        }
    }

    /// Takes a point as the next of a curve; why the curve ends there, if it does.
    fn take(&self, points: &mut Vec<CurvePoint>, point: CurvePoint) -> Option<CurveEnd> {
        let (first, last) = (points[0], points[points.len() - 1]);
        if points.len() > CAN_CLOSE && passes(&last, &point, &first.at, &first.tangent) {
            points.push(first);
            return Some(CurveEnd::Closed);
        }
        let is_on_border = is_on_border(&point.at);
        if is_on_border && distance(&last.at, &point.at) <= FOUND && points.len() > 1 {
            points.pop();
        }
        if is_on_border {
            points.push(point);
            return Some(CurveEnd::Border);
        }
        let met = self.open.iter().map(|it| (it.at, it.outward.map(|part| -part)));
        for (at, tangent) in met {
            if passes(&last, &point, &at, &tangent) {
                points.push(CurvePoint { at, tangent, ..point });
                return Some(CurveEnd::Meets);
            }
        }
        points.push(point);
        None
    }

    /// The next point by derivatives; `step` is how far it is tried first, and then the length for the one after.
    fn next(&self, last: &CurvePoint, step: &mut f64) -> Result<CurvePoint, Failed> {
        let mut failed = Failed::Other;
        while *step >= SHORTEST {
            match self.stepped(last, *step) {
                Ok(point) => {
                    let length = distance(&last.at, &point.at);
                    let (turn, chord) = bend(last, &point);
                    if turn <= TURN && chord <= CHORD {
                        let by_chord = (0.5 * CHORD / chord.max(1e-12)).sqrt();
                        let by_turn = 0.5 * TURN / turn.max(1e-12);
                        *step = (length * by_chord.min(by_turn).clamp(0.3, 2.0)).min(LONGEST);
                        *step = step.max(2.0 * SHORTEST);
                        return Ok(point);
                    }
                }
                Err(why) => failed = why,
            }
            *step *= 0.5;
        }
        Err(failed)
    }

    /// The point a step farther along the tangent, or where the curve meets the border before.
    fn stepped(&self, last: &CurvePoint, step: f64) -> Result<CurvePoint, Failed> {
        let within = self.within(last);
        let tried = [0, 1].map(|side| last.at[side] + step * last.tangent[side]);
        let most = CORRECTION * step;
        let mut met = is_inside(&tried).then_some(tried);
        if met.is_some() {
            let [x, y] = last.tangent;
            let point = self.corrected(&tried, &[-y, x], most, within)?;
            if is_inside(&point.at) {
                return Ok(point);
            }
            met = Some(point.at);
        }
        let beyond = met.unwrap_or(tried);
        let (border, side) = border_between(&last.at, &beyond);
        let across = if side == 0 { [0.0, 1.0] } else { [1.0, 0.0] };
        let point = self.corrected(&border, &across, most, within)?;
        if is_inside(&point.at) { Ok(point) } else { Err(Failed::Other) }
    }

    /// Cycles that motions beside a point are followed.
    fn within(&self, last: &CurvePoint) -> usize {
        let period = self.saddle.map_or(0, |(_, saddle)| saddle.points.len());
        last.cycles + PERIODS * period
    }

    /// The point of the manifold on a line, by Newton's method.
    fn corrected(
        &self,
        start: &[f64; 2],
        line: &[f64; 2],
        most: f64,
        within: usize,
    ) -> Result<CurvePoint, Failed> {
        let Some((_, saddle)) = self.saddle else { return Err(Failed::Other) };
        let mut shift = 0.0;
        for _ in 0..CORRECTIONS {
            let at = [0, 1].map(|side| start[side] + shift * line[side]);
            let approach = self.plane.approach(saddle, &at, within).map_err(|why| match why {
                NoApproach::Far => Failed::Far,
                NoApproach::Broken => Failed::Other,
            })?;
            let [x, y] = approach.gradient;
            let slope = x * line[0] + y * line[1];
            let steepest = libm::hypot(x, y);
            if slope.abs() < ACROSS * steepest {
                return Err(Failed::Other);
            }
            let correction = -approach.value / slope;
            shift += correction;
            if shift.is_nan() || shift.abs() > most {
                return Err(Failed::Other);
            }
            if correction.abs() <= FOUND && approach.error <= FOUND {
                let at = [0, 1].map(|side| start[side] + shift * line[side]);
                // The value is positive on the side of the saddle's first attractor: that is on the left, or on the right.
                let sign = if self.sides[0] == saddle.sides[0] { 1.0 } else { -1.0 };
                let tangent = [sign * y / steepest, -sign * x / steepest];
                let Approach { cycles, error, .. } = approach;
                return Ok(CurvePoint { at, tangent, cycles, error, divided: false });
            }
        }
        Err(Failed::Other)
    }

    /// The next point by division on a circle around the last, the largest on which the curve leaves once, or on the border.
    fn divided(&self, last: &CurvePoint) -> Option<CurvePoint> {
        for radius in RADII {
            let (centre, tangent) = (last.at, last.tangent);
            let circle = Ahead::Circle { centre, tangent, radius };
            let crossing = circle.crossing(self.plane, self.sides);
            let Some(crossing) = crossing.or_else(|| self.on_border(last, radius)) else {
                continue;
            };
            let at = crossing.at();
            let chord = [0, 1].map(|side| at[side] - last.at[side]);
            let length = distance(&at, &last.at);
            if length == 0.0 {
                continue;
            }
            let found = self.corrected(&at, &crossing.across(), 0.1 * radius, self.within(last));
            if let Ok(point) = found
                && is_inside(&point.at)
                && point.tangent[0] * chord[0] + point.tangent[1] * chord[1] > 0.0
                && length * angle(&last.tangent, &point.tangent) / 4.0 <= CHORD
            {
                return Some(point);
            }
            let tangent = chord.map(|it| it / length);
            // A corner is passed on a small circle.
            if length * angle(&last.tangent, &tangent) / 4.0 <= CHORD {
                return Some(CurvePoint { at, tangent, error: 0.0, divided: true, ..*last });
            }
        }
        None
    }

    /// Where the curve comes to the border within a distance, by division.
    fn on_border(&self, last: &CurvePoint, within: f64) -> Option<Crossing> {
        let ahead = [0, 1].map(|side| last.at[side] + within * last.tangent[side]);
        if is_inside(&ahead) {
            return None;
        }
        let (at, side) = border_between(&last.at, &ahead);
        let along = 1 - side;
        // The left of the direction in which the curve goes.
        let left = if side == 0 { last.tangent[0] } else { -last.tangent[1] };
        let [mut from, mut to] = [at, at];
        from[along] = (at[along] - within * left.signum()).clamp(0.0, 1.0);
        to[along] = (at[along] + within * left.signum()).clamp(0.0, 1.0);
        Ahead::Line { from, to }.crossing(self.plane, self.sides)
    }
}

/// The last point of a curve that goes on as its last chord does, not as derivatives say: those of a start that the system moves at
/// once, as one beyond a rigid stop, are not those of the map.
fn along_chord(points: &[CurvePoint]) -> Option<CurvePoint> {
    let [.., before, last] = points else { return None };
    let length = distance(&before.at, &last.at);
    let tangent = [0, 1].map(|side| (last.at[side] - before.at[side]) / length);
    (length > 0.0).then_some(CurvePoint { tangent, ..*last })
}

/// How far two starts are apart.
pub(super) fn distance(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

/// The angle between two directions.
fn angle(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    libm::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]).abs()
}

/// By how much a curve turns between two points, and how far it may be from the chord: by its turn, and by how far the second
/// point is from the tangent at the first.
fn bend(last: &CurvePoint, point: &CurvePoint) -> (f64, f64) {
    let turn = angle(&last.tangent, &point.tangent);
    let chord = [0, 1].map(|side| point.at[side] - last.at[side]);
    let aside = (last.tangent[0] * chord[1] - last.tangent[1] * chord[0]).abs();
    (turn, (distance(&last.at, &point.at) * turn / 8.0).max(0.25 * aside))
}

/// Whether a curve between two of its points passes a point at which another goes on in a direction.
fn passes(last: &CurvePoint, point: &CurvePoint, at: &[f64; 2], direction: &[f64; 2]) -> bool {
    let chord = [0, 1].map(|side| point.at[side] - last.at[side]);
    let length = libm::hypot(chord[0], chord[1]);
    let away = [0, 1].map(|side| at[side] - last.at[side]);
    let along = (chord[0] * away[0] + chord[1] * away[1]) / length;
    let aside = (chord[0] * away[1] - chord[1] * away[0]).abs() / length;
    let same = (chord[0] * direction[0] + chord[1] * direction[1]) / length;
    (0.0..=length).contains(&along) && aside <= CHORD.max(0.05 * length) && same > 0.8
}

/// Whether a start lies in the plane.
fn is_inside(at: &[f64; 2]) -> bool {
    at.iter().all(|it| (0.0..=1.0).contains(it))
}

/// Whether a start lies on the border of the plane.
fn is_on_border(at: &[f64; 2]) -> bool {
    at.iter().any(|it| *it <= 0.0 || *it >= 1.0)
}

/// Where the way from a start inside to one beyond leaves the plane, and across which side's ends.
fn border_between(from: &[f64; 2], to: &[f64; 2]) -> ([f64; 2], usize) {
    let mut least = (1.0, 0);
    for side in (0..2).filter(|side| !(0.0..=1.0).contains(&to[*side])) {
        let end = if to[side] > from[side] { 1.0 } else { 0.0 };
        let share = (end - from[side]) / (to[side] - from[side]);
        if share <= least.0 {
            least = (share, side);
        }
    }
    let (share, side) = least;
    let mut at = [0, 1].map(|it| from[it] + share * (to[it] - from[it]));
    at[side] = at[side].round();
    (at, side)
}
