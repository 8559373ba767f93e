//! The equations of a periodic orbit in one parameter, and the test functions of special orbits.

use crate::flow::{Event, Reason, Switched, System};
use crate::lane::Dual;
use crate::orbit::Varied;
use crate::orbit::matrix::{Complex, Matrix, determinant, eigenvalues};
use crate::orbit::passage::{Integrator, Passage, PlainRequest, ReturnRequest};
use crate::orbit::return_map::Cycles;

use super::SpecialKind;
use super::arclength::{CurvePoint, EXACT, Equations, Linear};
use super::bialternate::torus;
use super::family::{Family, cyclic};
use super::periodic::Periodic;

/// Periodic orbits in one parameter: a zero of P^k(s) - s, with s the section point and P the return map.
///
/// The `U` unknowns are the `D` coordinates of s and, last, the parameter.
#[derive(Debug, Clone)]
pub struct Orbits<'a, M: System<D>, const D: usize, const U: usize> {
    /// The motions.
    pub family: Family<M, D>,
    /// What follows them with derivatives.
    pub integrator: &'a dyn Integrator<M, D>,
    /// What varies.
    pub along: Varied<M::Parameter>,
    /// Units of the coordinates and of the parameter.
    pub units: [f64; U],
    /// Whether an orbit belongs to the branch of another only if the determinant of J - I and the direction in the
    /// parameter change their signs together, as they do on every branch of a continuous map. Round a corner the
    /// derivatives beside it are not known, so that it cannot be asked there.
    pub oriented: bool,
    /// A residual below this is not worth another step of Newton's method.
    pub exact: f64,
}

/// Where the return map is steeper than this, rounding makes too much of an orbit to follow it.
pub const STEEPEST: f64 = 1e3;
/// An autonomous orbit smaller than this, relative to the units, cannot be told from an equilibrium that attracts
/// weakly: its residual would be rounding.
const SMALLEST: f64 = 1e-4;
/// An autonomous orbit with a cycle that takes more than this share of the time for which a return is waited for comes back
/// too late a little farther on.
const LONGEST: f64 = 0.999;
/// An event so near to the section [cycles] may be met on one side of it by the orbit's point and on the other by its return, which
/// differ by rounding, as where a capsule at rest has a velocity of 1e-20.
const AT_SECTION: f64 = 1e-4;

/// What is seen of an orbit.
#[derive(Debug, Clone)]
pub struct Seen<E, const D: usize, const U: usize> {
    /// Derivative of P^k in units of the section.
    pub jacobian: Matrix<D>,
    /// Its cyclic sequence of events.
    pub events: Vec<E>,
    /// Distance of the local extremum that is nearest to the surface that it may touch, in units of the first
    /// coordinate, with its derivatives along the unknowns.
    pub margin: Option<Dual<f64, U>>,
    /// Each local extremum: when it is met after the section [cycles], and its distance.
    pub margins: Vec<(f64, f64)>,
    /// How far an autonomous motion gets from where it begins, relative to the units; infinite for a driven one.
    pub excursion: f64,
}

/// An orbit on a branch.
pub type OrbitPoint<E, const D: usize, const U: usize> = CurvePoint<U, Seen<E, D, U>>;

/// A special orbit on its arc.
#[derive(Debug, Clone)]
pub struct SpecialOrbit<E, const D: usize, const U: usize> {
    /// What happens.
    pub kind: SpecialKind,
    /// How far along the arc.
    pub distance: f64,
    /// How far the true one may be, along the arc.
    pub uncertainty: f64,
    /// The orbit.
    pub point: OrbitPoint<E, D, U>,
    /// Of a change of events: whether the orbit just beyond it is stable.
    pub is_stable_beyond: bool,
}

impl<M: System<D>, const D: usize, const U: usize> Orbits<'_, M, D, U> {
    /// The same orbits down to rounding.
    pub fn exactly(&self) -> Self {
        Orbits { exact: EXACT, ..self.clone() }
    }

    /// The parameter's value in its own unit.
    pub fn parameter(&self, at: &[f64; U]) -> f64 {
        at[D] * self.units[D]
    }

    /// The section point in its own units.
    pub fn section(&self, at: &[f64; U]) -> [f64; D] {
        std::array::from_fn(|i| at[i] * self.units[i])
    }

    /// The unknowns of an orbit.
    pub fn unknowns(&self, section: &[f64; D], parameter: f64) -> [f64; U] {
        std::array::from_fn(|i| section.get(i).unwrap_or(&parameter) / self.units[i])
    }

    /// The unknowns at every section point of an orbit, in order.
    pub fn section_points(&self, at: &[f64; U]) -> Vec<[f64; U]> {
        let once = self.with_period(1);
        let points = std::iter::successors(Some(*at), |at| {
            let step = once.displacement(at)?;
            Some(std::array::from_fn(|i| at[i] + step.get(i).unwrap_or(&0.0)))
        });
        points.take(self.family.period as usize).collect()
    }

    /// The cyclic sequence of events of an orbit with this passage.
    ///
    /// Method: where an event lies at the section, that of the motion from the return on, whose mode is the one in which the orbit
    /// came there.
    fn events(&self, at: &[f64; U], passage: &Passage<M::Event, D>) -> Vec<M::Event> {
        let events = cyclic(&passage.events);
        if passage.nearest_event >= AT_SECTION {
            return events;
        }
        let Family { system, period, tolerance } = &self.family;
        let again = self.integrator.plain_returns(PlainRequest {
            system: self.along.of(system, self.parameter(at)),
            points: vec![passage.end],
            cycles: Cycles { count: *period, tolerance: *tolerance },
        });
        again.into_iter().flatten().next().map_or(events, |it| cyclic(&it.events))
    }

    /// Whether a cycle of an autonomous orbit takes nearly as long as it may, or to rounding too long.
    pub fn takes_longest(&self, point: &OrbitPoint<M::Event, D, U>) -> bool {
        if !M::Single::AUTONOMOUS {
            return false;
        }
        let free = self.along.at(self.parameter(&point.at));
        let longest = self.family.longest_cycle(self.section(&point.at), &free);
        longest.is_none_or(|longest| longest > LONGEST)
    }
}

impl<M: System<D>, const D: usize, const U: usize> Periodic<D, U> for Orbits<'_, M, D, U> {
    fn period(&self) -> u64 {
        self.family.period
    }

    fn with_period(&self, period: u64) -> Self {
        let mut orbits = self.clone();
        orbits.family.period = period;
        orbits
    }

    fn displacement(&self, at: &[f64; U]) -> Option<[f64; D]> {
        let section = self.section(at);
        let passage = self.family.passage(section, &self.along.at(self.parameter(at))).ok()?;
        let moved = self.family.system.metric().difference(&passage.end, &section);
        Some(std::array::from_fn(|i| moved[i] / self.units[i]))
    }
}

impl<M: System<D>, const D: usize, const U: usize> Equations<U> for Orbits<'_, M, D, U> {
    type Seen = Seen<M::Event, D, U>;

    fn exact(&self) -> f64 {
        self.exact
    }

    fn at(&self, at: &[f64; U]) -> Result<Linear<U, Self::Seen>, Reason> {
        if !self.along.admits(&self.family.system, self.parameter(at)) {
            return Err(Reason::NotFinite);
        }
        let Family { system, period, tolerance } = &self.family;
        let point = self.section(at);
        let passage = self.integrator.passage(ReturnRequest {
            system: system.clone(),
            along: Some((self.along.clone(), self.parameter(at), self.units[D])),
            point,
            units: std::array::from_fn(|i| self.units[i]),
            cycles: Cycles { count: *period, tolerance: *tolerance },
            watched: true,
            directions: None,
        })?;
        let (mut residual, mut rows, mut jacobian) = ([0.0; U], [[0.0; U]; U], [[0.0; D]; D]);
        let moved = system.metric().difference(&passage.end, &point);
        for i in 0..D {
            residual[i] = moved[i] / self.units[i];
            jacobian[i] = passage.jacobian[i].map(|part| part / self.units[i]);
            rows[i][..D].copy_from_slice(&jacobian[i]);
            rows[i][D] = passage.by_parameter[i] / self.units[i];
            rows[i][i] -= 1.0;
        }
        let unit = self.units[0];
        let margin = passage.margin.map(|margin| {
            let mut gradient = [margin.by_parameter / unit; U];
            gradient[..D].copy_from_slice(&margin.gradient.map(|part| part / unit));
            Dual { value: margin.value / unit, gradient }
        });
        let excursion = passage.excursion / system.metric().size(&self.section(&[1.0; U]));
        let events = self.events(at, &passage);
        let margins = passage.margins.into_iter().map(|(time, it)| (time, it / unit)).collect();
        let seen = Seen { jacobian, events, margin, margins, excursion };
        Ok(Linear { residual, rows, seen })
    }

    fn belongs(&self, from: &CurvePoint<U, Self::Seen>, met: &CurvePoint<U, Self::Seen>) -> bool {
        let turns = self.oriented && orientation(from) * orientation(met) < 0.0;
        let vanishes = met.seen.excursion <= SMALLEST;
        !met.seen.is_steep(1.0) && !turns && !vanishes && self.is_whole(&met.at)
    }
}

/// What keeps its sign along a branch of a continuous map.
fn orientation<E, const D: usize, const U: usize>(point: &OrbitPoint<E, D, U>) -> f64 {
    point.tangent[D] * determinant(shifted(&point.seen.jacobian, -1.0))
}

impl<E: Event, const D: usize, const U: usize> Seen<E, D, U> {
    /// det(J + I), which vanishes at a period doubling.
    pub fn doubling(&self) -> f64 {
        determinant(shifted(&self.jacobian, 1.0))
    }

    /// The test function of a Neimark-Sacker bifurcation.
    pub fn torus(&self) -> f64 {
        torus(&self.jacobian)
    }

    /// The Floquet multipliers, the largest magnitude first.
    pub fn multipliers(&self) -> [Complex; D] {
        eigenvalues(&self.jacobian)
    }

    /// Whether an autonomous orbit is about to vanish in an equilibrium.
    pub fn is_smallest(&self) -> bool {
        self.excursion < 2.0 * SMALLEST
    }

    /// Whether small perturbations decay.
    pub fn is_stable(&self) -> bool {
        self.multipliers()[0].abs() < 1.0
    }

    /// Whether the return map is steeper than this share of what can be followed.
    pub fn is_steep(&self, share: f64) -> bool {
        self.jacobian.iter().flatten().any(|slope| slope.abs() > share * STEEPEST)
    }

    /// How often the surface is met in a period that a grazing only touches.
    pub fn impacts(&self) -> usize {
        self.events.iter().filter(|event| event.is_impact()).count()
    }
}

/// A matrix with `by` added to its diagonal.
pub fn shifted<const D: usize>(matrix: &Matrix<D>, by: f64) -> Matrix<D> {
    let mut shifted = *matrix;
    for (i, row) in shifted.iter_mut().enumerate() {
        row[i] += by;
    }
    shifted
}
