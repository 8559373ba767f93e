//! The equations of a special orbit of one kind, in two parameters.

use crate::flow::{Reason, System};
use crate::lane::{Dual, Lane};
use crate::orbit::matrix::{Matrix, expanded_determinant, solve};

use super::SpecialKind;
use super::arclength::{CurvePoint, Equations, Linear};
use super::bialternate::torus;
use super::family::{Family, Passage, apart};
use super::orbits::shifted;
use super::periodic::Periodic;
use super::scales::seeded;
use crate::orbit::extrema::{Extremum, nearest};

/// The extremum that touches the surface moves in a step by no more than this share of a cycle.
const SAME_EXTREMUM: f64 = 0.02;
/// A maximum and a minimum this close in time are about to meet, as a share of a cycle.
const MEET: f64 = 1e-3;

/// A number with derivatives along the unknowns, which carries a row of the Jacobian along, so that its
/// derivatives are known too.
type Nested<const D: usize, const W: usize> = Dual<Dual<f64, D>, W>;

/// How a grazing orbit touches its surface.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// When, after the section [cycles].
    pub time: f64,
    /// How far from there the next extremum is [cycles].
    alone: f64,
}

/// What is seen of an orbit on a curve.
#[derive(Debug, Clone)]
pub struct Seen {
    /// How it touches its surface, if it is a grazing.
    pub touch: Option<Touch>,
    /// How often the orbit meets the surface.
    pub impacts: usize,
    /// Each local extremum: when it is met after the section [cycles], and its distance in units of the first coordinate.
    pub margins: Vec<(f64, f64)>,
}

/// An orbit on a curve.
pub type LocusPoint<const W: usize> = CurvePoint<W, Seen>;

/// Special orbits of one kind: P^k(s) - s = 0 and a test function, in the `D` coordinates of s and two
/// parameters, which are the last of the `W` unknowns.
#[derive(Debug, Clone)]
pub struct Locus<M: System<D>, const D: usize, const W: usize> {
    /// The motions.
    pub family: Family<M, D>,
    /// The first parameter and the second.
    pub free: [M::Parameter; 2],
    /// Units of the coordinates and of the two parameters.
    pub units: [f64; W],
    /// The kind.
    pub kind: SpecialKind,
    /// Of grazings: the margin at which they are followed, in units of the first coordinate.
    pub margin: f64,
    /// Of grazings: near which time the extremum is met that touches [cycles]; that which is nearest to its surface where none is given.
    pub touches_near: Option<f64>,
}

/// Where an orbit returns to, the test, and what is seen of it.
type Tested<const D: usize, const W: usize> = ([Dual<f64, W>; D], Dual<f64, W>, Seen);

impl<M: System<D>, const D: usize, const W: usize> Locus<M, D, W> {
    fn free<L: Copy>(&self, seeded: &[L; W]) -> [(M::Parameter, L); 2] {
        [(self.free[0], seeded[D]), (self.free[1], seeded[D + 1])]
    }

    /// The return and the test of grazing: the margin of the local extremum that touches.
    fn grazing(&self, at: &[f64; W]) -> Result<Tested<D, W>, Reason> {
        let seeded = seeded(at, &self.units);
        let point = std::array::from_fn(|i| seeded[i]);
        let Passage { end, extrema, impacts } = self.family.passage(point, &self.free(&seeded))?;
        let touch = self.touching(&extrema).ok_or(Reason::NotFinite)?;
        let margin = touch.margin;
        let others = extrema.iter().filter(|other| other.time != touch.time);
        let away = others.map(|other| apart(touch.time, other.time, self.family.period));
        let alone = away.fold(f64::INFINITY, f64::min);
        let touch = Some(Touch { time: touch.time, alone });
        let left = margin / Dual::splat(self.units[0]) - Dual::splat(self.margin);
        Ok((end, left, Seen { touch, impacts, margins: self.margins(&extrema) }))
    }

    /// The extremum that touches.
    fn touching<'e, L: Lane>(&self, extrema: &'e [Extremum<L>]) -> Option<&'e Extremum<L>> {
        let Some(time) = self.touches_near else { return nearest(extrema) };
        let away = |it: &Extremum<L>| apart(it.time, time, self.family.period);
        extrema.iter().min_by(|a, b| away(a).total_cmp(&away(b)))
    }

    /// The extrema with their times and distances.
    fn margins<L: Lane>(&self, extrema: &[Extremum<L>]) -> Vec<(f64, f64)> {
        extrema.iter().map(|it| (it.time, it.margin.lane(0) / self.units[0])).collect()
    }

    /// The special orbit that a solution stands for, on a plane of this normal: of grazings the one that touches, beside which
    /// they are followed.
    ///
    /// Method: along the derivatives, by the margin; the error is of second order in it.
    pub fn special(&self, point: &LocusPoint<W>, normal: &[f64; W]) -> Option<[f64; W]> {
        let (mut rows, mut by) = (point.rows, [0.0; W]);
        rows[W - 1] = *normal;
        by[D] = self.margin;
        let step = solve(rows, by)?;
        Some(std::array::from_fn(|i| point.at[i] - step[i]))
    }

    /// Whether the extremum that touches is about to vanish, with another that it meets.
    pub fn vanishes(&self, point: &LocusPoint<W>) -> bool {
        point.seen.touch.is_some_and(|touch| touch.alone < MEET)
    }

    /// The return and the test of the multipliers: det(J - I) at folds, det(J + I) at period doublings, and [`torus`] at
    /// Neimark-Sacker points.
    ///
    /// Derivatives: exact, by numbers whose derivatives have derivatives.
    fn multiplier(&self, at: &[f64; W]) -> Result<Tested<D, W>, Reason> {
        let seeded: [Nested<D, W>; W] = std::array::from_fn(|i| {
            let mut value = Dual::constant(at[i] * self.units[i]);
            if i < D {
                value.gradient[i] = self.units[i];
            }
            let mut seeded = Dual::constant(value);
            seeded.gradient[i] = Dual::constant(self.units[i]);
            seeded
        });
        let point = std::array::from_fn(|i| seeded[i]);
        let Passage { end, extrema, impacts } = self.family.passage(point, &self.free(&seeded))?;
        let mut j: [[Dual<f64, W>; D]; D] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let slope = part_of(&end[i], |dual| dual.gradient[j]);
                slope / Dual::splat(self.units[i])
            })
        });
        let test = match self.kind {
            SpecialKind::NeimarkSacker => torus(&j),
            kind => {
                let shift = if kind == SpecialKind::Fold { -1.0 } else { 1.0 };
                (0..D).for_each(|i| j[i][i] = j[i][i] + Dual::splat(shift));
                expanded_determinant(&j, &std::array::from_fn::<usize, D, _>(|j| j))
            }
        };
        let seen = Seen { touch: None, impacts, margins: self.margins(&extrema) };
        Ok((end.map(|it| part_of(&it, |dual| dual.value)), test, seen))
    }

    /// The derivative of the return map at an orbit, in units of the section.
    pub fn jacobian(point: &LocusPoint<W>) -> Matrix<D> {
        let less: Matrix<D> = std::array::from_fn(|i| std::array::from_fn(|j| point.rows[i][j]));
        shifted(&less, 1.0)
    }
}

/// A part of a nested number, with its derivatives along the unknowns.
fn part_of<const D: usize, const W: usize>(
    nested: &Nested<D, W>,
    part: impl Fn(&Dual<f64, D>) -> f64,
) -> Dual<f64, W> {
    Dual { value: part(&nested.value), gradient: nested.gradient.map(|along| part(&along)) }
}

impl<M: System<D>, const D: usize, const W: usize> Equations<W> for Locus<M, D, W> {
    type Seen = Seen;

    fn at(&self, at: &[f64; W]) -> Result<Linear<W, Seen>, Reason> {
        let mut free = self.free.into_iter().zip(D..);
        let system = &self.family.system;
        if !free.all(|(parameter, place)| system.admits(parameter, at[place] * self.units[place])) {
            return Err(Reason::NotFinite);
        }
        let (end, test, seen) = match self.kind {
            SpecialKind::Fold | SpecialKind::PeriodDoubling | SpecialKind::NeimarkSacker => {
                self.multiplier(at)?
            }
            _ => self.grazing(at)?,
        };
        let (mut residual, mut rows) = ([0.0; W], [[0.0; W]; W]);
        let point: [f64; D] = std::array::from_fn(|i| at[i] * self.units[i]);
        let moved = system.metric().difference(&std::array::from_fn(|i| end[i].value), &point);
        for (i, end) in end.iter().enumerate() {
            residual[i] = moved[i] / self.units[i];
            rows[i] = end.gradient.map(|part| part / self.units[i]);
            rows[i][i] -= 1.0;
        }
        (residual[D], rows[D]) = (test.value, test.gradient);
        Ok(Linear { residual, rows, seen })
    }

    /// Where two curves of grazings cross, another extremum is as near to its surface.
    fn belongs(&self, from: &LocusPoint<W>, met: &LocusPoint<W>) -> bool {
        let same = from.seen.touch.zip(met.seen.touch).is_none_or(|(before, after)| {
            apart(before.time, after.time, self.family.period) <= SAME_EXTREMUM
        });
        same && self.is_whole(&met.at)
    }
}

impl<M: System<D>, const D: usize, const W: usize> Periodic<D, W> for Locus<M, D, W> {
    fn period(&self) -> u64 {
        self.family.period
    }

    fn with_period(&self, period: u64) -> Self {
        let mut locus = self.clone();
        locus.family.period = period;
        locus
    }

    fn displacement(&self, at: &[f64; W]) -> Option<[f64; D]> {
        let raw: [f64; W] = std::array::from_fn(|i| at[i] * self.units[i]);
        let point = std::array::from_fn(|i| raw[i]);
        let end = self.family.passage(point, &self.free(&raw)).ok()?.end;
        let moved = self.family.system.metric().difference(&end, &point);
        Some(std::array::from_fn(|i| moved[i] / self.units[i]))
    }
}
