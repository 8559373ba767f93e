//! The equations of a periodic orbit in one parameter, and the test functions of what may happen to it.

use crate::capsule::{EventKind, Parameter};
use crate::lane::Dual;
use crate::orbit::matrix::{Complex, Matrix, determinant, eigenvalues};
use crate::orbit::{Reason, Section};

use super::arclength::{Equations, Linear, Station};
use super::family::{Family, cyclic, nearest};
use super::periodic::Periodic;

/// Place of the parameter among the unknowns r, y1, y2 and parameter.
pub const PARAMETER: usize = 3;

/// Periodic orbits in one parameter: a zero of P^k(s) - s, with s = (r, y1, y2) and P the return map.
#[derive(Debug, Clone)]
pub struct Orbits {
    /// The motions.
    pub family: Family,
    /// The parameter they are followed in.
    pub along: Parameter,
    /// Units of r, y1, y2 and of the parameter.
    pub units: [f64; 4],
}

/// Where the return map is steeper than this, rounding makes too much of an orbit to follow it.
const STEEPEST: f64 = 1e3;

/// What is seen of an orbit.
#[derive(Debug, Clone)]
pub struct Seen {
    /// Derivative of P^k in units of the section.
    pub jacobian: Matrix<3>,
    /// Its cyclic sequence of events.
    pub events: Vec<EventKind>,
    /// Distance of the local extremum of r that is nearest to the stop from it in units of r, with its
    /// derivatives along the unknowns.
    pub margin: Option<Dual<f64, 4>>,
}

/// An orbit on a branch.
pub type OrbitStation = Station<4, Seen>;

impl Orbits {
    /// The parameter's value in its own unit.
    pub fn parameter(&self, at: &[f64; 4]) -> f64 {
        at[PARAMETER] * self.units[PARAMETER]
    }

    /// The section point in its own units.
    pub fn section(&self, at: &[f64; 4]) -> Section {
        std::array::from_fn(|i| at[i] * self.units[i])
    }

    /// The unknowns of an orbit.
    pub fn unknowns(&self, section: &Section, parameter: f64) -> [f64; 4] {
        let [r, y1, y2] = *section;
        let raw = [r, y1, y2, parameter];
        std::array::from_fn(|i| raw[i] / self.units[i])
    }

    /// The unknowns at every section point of an orbit, in order.
    pub fn section_points(&self, at: &[f64; 4]) -> Vec<[f64; 4]> {
        let once = self.with_period(1);
        let next = |at: &[f64; 4]| {
            let [r, y1, y2] = once.displacement(at)?;
            Some([at[0] + r, at[1] + y1, at[2] + y2, at[3]])
        };
        std::iter::successors(Some(*at), next).take(self.family.period as usize).collect()
    }
}

impl Periodic<4> for Orbits {
    fn period(&self) -> u64 {
        self.family.period
    }

    fn with_period(&self, period: u64) -> Orbits {
        let mut orbits = self.clone();
        orbits.family.period = period;
        orbits
    }

    fn displacement(&self, at: &[f64; 4]) -> Option<[f64; 3]> {
        let section = self.section(at);
        let passage = self.family.passage(section, &[(self.along, self.parameter(at))]).ok()?;
        Some(std::array::from_fn(|i| (passage.end[i] - section[i]) / self.units[i]))
    }
}

impl Equations<4> for Orbits {
    type Seen = Seen;

    fn at(&self, at: &[f64; 4]) -> Result<Linear<4, Seen>, Reason> {
        if !self.along.allowed().admits(self.parameter(at)) {
            return Err(Reason::NotFinite);
        }
        let seeded: [Dual<f64, 4>; 4] = std::array::from_fn(|i| {
            let mut seeded = Dual::constant(at[i] * self.units[i]);
            seeded.gradient[i] = self.units[i];
            seeded
        });
        let [r, y1, y2, parameter] = seeded;
        let passage = self.family.passage([r, y1, y2], &[(self.along, parameter)])?;
        let (mut residual, mut rows, mut jacobian) = ([0.0; 4], [[0.0; 4]; 4], [[0.0; 3]; 3]);
        for (i, end) in passage.end.iter().enumerate() {
            residual[i] = (end.value - at[i] * self.units[i]) / self.units[i];
            rows[i] = end.gradient.map(|part| part / self.units[i]);
            jacobian[i].copy_from_slice(&rows[i][..3]);
            rows[i][i] -= 1.0;
        }
        let in_unit = |part: f64| part / self.units[0];
        let margin = nearest(&passage.extrema).map(|extremum| Dual {
            value: in_unit(extremum.margin.value),
            gradient: extremum.margin.gradient.map(in_unit),
        });
        let seen = Seen { jacobian, events: cyclic(&passage.events), margin };
        Ok(Linear { residual, rows, seen })
    }

    fn belongs(&self, _: &OrbitStation, met: &OrbitStation) -> bool {
        let steep = met.seen.jacobian.iter().flatten().any(|slope| slope.abs() > STEEPEST);
        !steep && self.is_whole(&met.at)
    }
}

impl Seen {
    /// det(J + I), which vanishes at a period doubling.
    pub fn doubling(&self) -> f64 {
        determinant(shifted(&self.jacobian, 1.0))
    }

    /// The product of one less than each product of two multipliers, which vanishes where a complex pair
    /// passes the unit circle: det(C - I), C the second compound of J.
    pub fn torus(&self) -> f64 {
        let j = &self.jacobian;
        let pairs = [(0, 1), (0, 2), (1, 2)];
        let compound =
            pairs.map(|(a, b)| pairs.map(|(c, d)| j[a][c] * j[b][d] - j[a][d] * j[b][c]));
        determinant(shifted(&compound, -1.0))
    }

    /// The Floquet multipliers, the largest magnitude first.
    pub fn multipliers(&self) -> [Complex; 3] {
        eigenvalues(&self.jacobian)
    }

    /// How often contact closes in a period.
    pub fn impacts(&self) -> usize {
        self.events.iter().filter(|&&kind| kind == EventKind::ContactClosed).count()
    }
}

/// A matrix with `by` added to its diagonal.
pub fn shifted(matrix: &Matrix<3>, by: f64) -> Matrix<3> {
    let mut shifted = *matrix;
    for (i, row) in shifted.iter_mut().enumerate() {
        row[i] += by;
    }
    shifted
}
