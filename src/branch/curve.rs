//! Curves of special points in two parameters.

use crate::lane::{Dual, Lane};
use crate::model::Parameter;
use crate::orbit::Reason;

use super::arclength::{
    Equations, Linear, Plane, Station, between, corrected, dot, moved, norm, tangent,
};
use super::family::{Family, Passage};
use super::orbits::{Orbits, PARAMETER};
use super::walk::{Bounds, Stride, Walk};
use super::{Curve, Request, Special, SpecialKind};

/// Place of the second parameter among the unknowns.
const SECOND: usize = 4;
/// A curve goes through a point that lies beside one of its steps by no more than this share of it.
const SAME: f64 = 0.05;

/// A number with derivatives along the five unknowns.
type Five = Dual<f64, 5>;
/// The same, which carries a row of the Jacobian along, so that its derivatives are known too.
type Nested = Dual<Dual<f64, 3>, 5>;

/// Orbits to which one thing happens: P^k(s) - s = 0 and a test, in s and two parameters.
struct Locus {
    family: Family,
    free: [Parameter; 2],
    units: [f64; 5],
    kind: SpecialKind,
}

impl Locus {
    fn free<L: Copy>(&self, seeded: &[L; 5]) -> [(Parameter, L); 2] {
        [(self.free[0], seeded[PARAMETER]), (self.free[1], seeded[SECOND])]
    }

    /// The return and the test of grazing: the margin of the local maximum of r that is nearest to the stop.
    fn grazing(&self, at: &[f64; 5]) -> Result<Option<([Five; 3], Five)>, Reason> {
        let seeded: [Five; 5] = std::array::from_fn(|i| {
            let mut seeded = Dual::constant(at[i] * self.units[i]);
            seeded.gradient[i] = self.units[i];
            seeded
        });
        let [r, y1, y2, ..] = seeded;
        let Passage { end, margins, .. } = self.family.passage([r, y1, y2], &self.free(&seeded))?;
        let nearest = margins.into_iter().min_by(|a, b| a.value.abs().total_cmp(&b.value.abs()));
        let unit = Five::splat(self.units[0]);
        Ok(nearest.map(|margin| (end, margin / unit)))
    }

    /// The return and the determinant of J + `shift` I.
    ///
    /// Derivatives: exact, by numbers whose derivatives have derivatives.
    fn multiplier(&self, at: &[f64; 5], shift: f64) -> Result<([Five; 3], Five), Reason> {
        let seeded: [Nested; 5] = std::array::from_fn(|i| {
            let mut value = Dual::constant(at[i] * self.units[i]);
            if i < PARAMETER {
                value.gradient[i] = self.units[i];
            }
            let mut seeded = Dual::constant(value);
            seeded.gradient[i] = Dual::constant(self.units[i]);
            seeded
        });
        let [r, y1, y2, ..] = seeded;
        let Passage { end, .. } = self.family.passage([r, y1, y2], &self.free(&seeded))?;
        let inside = |i: usize, part: fn(&Dual<f64, 3>, usize) -> f64, j: usize| Dual {
            value: part(&end[i].value, j),
            gradient: end[i].gradient.map(|along| part(&along, j)),
        };
        let m: [[Five; 3]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let slope = inside(i, |dual, j| dual.gradient[j], j);
                let diagonal = if i == j { shift } else { 0.0 };
                slope / Five::splat(self.units[i]) + Five::splat(diagonal)
            })
        });
        let minor = |a: usize, b: usize| m[1][a] * m[2][b] - m[1][b] * m[2][a];
        let determinant = m[0][0] * minor(1, 2) - m[0][1] * minor(0, 2) + m[0][2] * minor(0, 1);
        Ok((std::array::from_fn(|i| inside(i, |dual, _| dual.value, 0)), determinant))
    }
}

impl Equations<5> for Locus {
    type Seen = ();

    fn at(&self, at: &[f64; 5]) -> Result<Linear<5, ()>, Reason> {
        let allowed = |(place, parameter): (usize, Parameter)| {
            parameter.allowed().admits(at[place] * self.units[place])
        };
        if ![(PARAMETER, self.free[0]), (SECOND, self.free[1])].into_iter().all(allowed) {
            return Err(Reason::NotFinite);
        }
        let (end, test) = match self.kind {
            SpecialKind::Fold => self.multiplier(at, -1.0)?,
            SpecialKind::PeriodDoubling => self.multiplier(at, 1.0)?,
            _ => self.grazing(at)?.ok_or(Reason::NotFinite)?,
        };
        let (mut residual, mut rows) = ([0.0; 5], [[0.0; 5]; 5]);
        for (i, end) in end.iter().enumerate() {
            residual[i] = (end.value - at[i] * self.units[i]) / self.units[i];
            rows[i] = end.gradient.map(|part| part / self.units[i]);
            rows[i][i] -= 1.0;
        }
        (residual[3], rows[3]) = (test.value, test.gradient);
        Ok(Linear { residual, rows, seen: () })
    }
}

/// A curve with the orbits on it.
#[derive(Debug, Clone)]
pub struct Trace {
    kind: SpecialKind,
    period: u64,
    through: (usize, usize),
    units: [f64; 5],
    points: Vec<[f64; 5]>,
}

impl Trace {
    /// What is kept of it.
    pub fn curve(&self) -> Curve {
        let value = |at: &[f64; 5]| [PARAMETER, SECOND].map(|i| at[i] * self.units[i]);
        let points = self.points.iter().map(value).collect();
        Curve { kind: self.kind, through: self.through, period: self.period, points }
    }

    /// Whether it comes by a point.
    fn passes(&self, point: &[f64; 5]) -> bool {
        self.points.windows(2).any(|ends| {
            let step = between(&ends[0], &ends[1]);
            let toward = between(&ends[0], point);
            let share = dot(&step, &toward) / dot(&step, &step);
            let aside = norm(&between(&moved(&ends[0], share, &step), point));
            (0.0..=1.0).contains(&share) && aside <= SAME * norm(&step)
        })
    }
}

/// The curve in two parameters through a special point of a branch; none for what is not followed, where no
/// second parameter is asked for, or if one of the curves `before` goes through it.
pub fn trace(
    request: &Request,
    orbits: &Orbits,
    through: (usize, usize),
    special: &Special,
    before: &[Trace],
) -> Option<Trace> {
    let (second, range) = request.second?;
    let followed = matches!(
        special.kind,
        SpecialKind::Fold | SpecialKind::PeriodDoubling | SpecialKind::Grazing
    );
    let width = range[1] - range[0];
    let value = request.parameters[second];
    let inside = (range[0]..=range[1]).contains(&value) && width > 0.0;
    if !followed || !inside || second == request.along {
        return None;
    }
    let [r, y1, y2, along] = orbits.units;
    let units = [r, y1, y2, along, width];
    let free = [request.along, second];
    let locus = Locus { family: orbits.family.clone(), free, units, kind: special.kind };
    let (period, kind) = (orbits.family.period, special.kind);
    let guess = guess(&locus, special, value)?;
    let known =
        |trace: &Trace| (trace.kind, trace.period) == (kind, period) && trace.passes(&guess);
    if before.iter().any(known) {
        return None;
    }
    let bounds = Bounds::none()
        .with(PARAMETER, request.range.map(|end| end / along))
        .with(SECOND, range.map(|end| end / width));
    let points = both_ways(&locus, request, &guess, bounds)?;
    Some(Trace { kind, period, through, units, points })
}

/// The unknowns at a special point.
fn guess(locus: &Locus, special: &Special, second: f64) -> Option<[f64; 5]> {
    let [r, y1, y2] = *special.point.section.first()?;
    let raw = [r, y1, y2, special.point.parameter, second];
    Some(std::array::from_fn(|i| raw[i] / locus.units[i]))
}

fn both_ways(
    locus: &Locus,
    request: &Request,
    guess: &[f64; 5],
    bounds: Bounds<5>,
) -> Option<Vec<[f64; 5]>> {
    let plane = Plane::fixing(SECOND, guess[SECOND]);
    let (start, _) = corrected(locus, &plane, guess, &plane.normal)?;
    let ahead = tangent(start.rows, &plane.normal)?;
    let most = request.most_points / 2;
    let way = |sign: f64| {
        let start = Station { tangent: ahead.map(|part| sign * part), ..start.clone() };
        one_way(locus, start, Walk::new(bounds, request.longest_step), most)
    };
    let (mut points, forward) = (way(-1.0), way(1.0));
    points.reverse();
    points.extend(forward.into_iter().skip(1));
    Some(points)
}

fn one_way(locus: &Locus, start: Station<5, ()>, mut walk: Walk<5>, most: usize) -> Vec<[f64; 5]> {
    let mut points = vec![start.at];
    let mut last = start;
    while points.len() < most {
        match walk.stride(locus, &last) {
            Stride::Inside(next) => {
                points.push(next.at);
                last = next;
            }
            Stride::AtBound(next) => {
                points.push(next.at);
                break;
            }
            Stride::Nowhere => break,
        }
    }
    points
}
