//! The equations of an orbit to which one thing happens, in two parameters.

use crate::capsule::Parameter;
use crate::lane::{Dual, Lane};
use crate::orbit::Reason;

use super::SpecialKind;
use super::arclength::{Equations, Linear, Station};
use super::family::{Extremum, Family, Passage, apart, nearest};
use super::orbits::PARAMETER;
use super::periodic::Periodic;

/// Place of the second parameter among the unknowns.
pub const SECOND: usize = 4;
/// The extremum that touches the stop moves in a step by no more than this share of a cycle.
const SAME_EXTREMUM: f64 = 0.02;
/// A maximum and a minimum this close in time are about to meet, as a share of a cycle.
const MEET: f64 = 1e-3;

/// A number with derivatives along the five unknowns.
type Five = Dual<f64, 5>;
/// The same, which carries a row of the Jacobian along, so that its derivatives are known too.
type Nested = Dual<Dual<f64, 3>, 5>;

/// How a grazing orbit touches the stop.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// When, after the section [cycles].
    time: f64,
    /// How far from there the next extremum of r is [cycles].
    alone: f64,
}

/// An orbit on a curve, and how it touches the stop, if it is a grazing.
pub type LocusStation = Station<5, Option<Touch>>;

/// Orbits to which one thing happens: P^k(s) - s = 0 and a test, in s and two parameters.
#[derive(Debug, Clone)]
pub struct Locus {
    /// The motions.
    pub family: Family,
    /// The followed parameter and the second.
    pub free: [Parameter; 2],
    /// Units of r, y1, y2 and of the two parameters.
    pub units: [f64; 5],
    /// What happens.
    pub kind: SpecialKind,
}

/// Where an orbit returns to, the test, and how it touches the stop.
type Tested = ([Five; 3], Five, Option<Touch>);

impl Locus {
    fn free<L: Copy>(&self, seeded: &[L; 5]) -> [(Parameter, L); 2] {
        [(self.free[0], seeded[PARAMETER]), (self.free[1], seeded[SECOND])]
    }

    /// The return and the test of grazing: the margin of the local extremum of r that is nearest to the stop.
    fn grazing(&self, at: &[f64; 5]) -> Result<Tested, Reason> {
        let seeded: [Five; 5] = std::array::from_fn(|i| {
            let mut seeded = Dual::constant(at[i] * self.units[i]);
            seeded.gradient[i] = self.units[i];
            seeded
        });
        let [r, y1, y2, ..] = seeded;
        let Passage { end, extrema, .. } = self.family.passage([r, y1, y2], &self.free(&seeded))?;
        let touch = nearest(&extrema).ok_or(Reason::NotFinite)?;
        let away = |other: &Extremum<Five>| apart(touch.time, other.time, self.family.period);
        let others = extrema.iter().filter(|other| other.time != touch.time);
        let alone = others.map(away).fold(f64::INFINITY, f64::min);
        let seen = Touch { time: touch.time, alone };
        Ok((end, touch.margin / Five::splat(self.units[0]), Some(seen)))
    }

    /// Whether the extremum of r that touches is about to vanish, with another that it meets.
    pub fn vanishes(&self, station: &LocusStation) -> bool {
        station.seen.is_some_and(|touch| touch.alone < MEET)
    }

    /// The return and the determinant of J + `shift` I.
    ///
    /// Derivatives: exact, by numbers whose derivatives have derivatives.
    fn multiplier(&self, at: &[f64; 5], shift: f64) -> Result<Tested, Reason> {
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
        Ok((std::array::from_fn(|i| inside(i, |dual, _| dual.value, 0)), determinant, None))
    }
}

impl Equations<5> for Locus {
    type Seen = Option<Touch>;

    fn at(&self, at: &[f64; 5]) -> Result<Linear<5, Option<Touch>>, Reason> {
        let allowed = |(place, parameter): (usize, Parameter)| {
            parameter.allowed().admits(at[place] * self.units[place])
        };
        if ![(PARAMETER, self.free[0]), (SECOND, self.free[1])].into_iter().all(allowed) {
            return Err(Reason::NotFinite);
        }
        let (end, test, seen) = match self.kind {
            SpecialKind::Fold => self.multiplier(at, -1.0)?,
            SpecialKind::PeriodDoubling => self.multiplier(at, 1.0)?,
            _ => self.grazing(at)?,
        };
        let (mut residual, mut rows) = ([0.0; 5], [[0.0; 5]; 5]);
        for (i, end) in end.iter().enumerate() {
            residual[i] = (end.value - at[i] * self.units[i]) / self.units[i];
            rows[i] = end.gradient.map(|part| part / self.units[i]);
            rows[i][i] -= 1.0;
        }
        (residual[3], rows[3]) = (test.value, test.gradient);
        Ok(Linear { residual, rows, seen })
    }

    /// Where two curves of grazings cross, another extremum is as near to the stop.
    fn belongs(&self, from: &LocusStation, met: &LocusStation) -> bool {
        let same = from.seen.zip(met.seen).is_none_or(|(before, after)| {
            apart(before.time, after.time, self.family.period) <= SAME_EXTREMUM
        });
        same && self.is_whole(&met.at)
    }
}

impl Periodic<5> for Locus {
    fn period(&self) -> u64 {
        self.family.period
    }

    fn with_period(&self, period: u64) -> Locus {
        let mut locus = self.clone();
        locus.family.period = period;
        locus
    }

    fn displacement(&self, at: &[f64; 5]) -> Option<[f64; 3]> {
        let raw: [f64; 5] = std::array::from_fn(|i| at[i] * self.units[i]);
        let [r, y1, y2, ..] = raw;
        let end = self.family.passage([r, y1, y2], &self.free(&raw)).ok()?.end;
        Some(std::array::from_fn(|i| (end[i] - raw[i]) / self.units[i]))
    }
}
