//! A cell of a diagram: the cases with the same parameters, sorted by the attractor they ended on.

use crate::lane::Dual;
use crate::model::{Locomotion, Parameter};
use crate::orbit::certificate::{OBLIQUE, least_from_one};
use crate::orbit::recurrence::size;
use crate::orbit::return_map::{Cycles, returned, values};
use crate::orbit::{Case, Certificate, Orbit, Outcome, Protocol, Section};

use crate::branch::natural::apart;

/// Points by which two motions that do not repeat are compared.
const SAMPLE: usize = 64;
/// Two samples of one motion have half of all nearest neighbours in the same sample, those of two motions
/// all: half way between the two they are told apart.
const MIXED: f64 = 0.75;

/// An attractor as the cases of one cell show it.
#[derive(Debug, Clone, PartialEq)]
pub struct Attractor {
    /// The first of its cases.
    pub case: usize,
    /// Periodic, chaotic or quasi-periodic.
    pub outcome: Outcome,
    /// Section points: those of a period, or a sample.
    pub points: Vec<Section>,
    /// How far each point may be from the true orbit [m/s].
    pub bound: f64,
    /// Size of the motion [m/s].
    pub size: f64,
}

/// The cases with the same parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cell {
    /// The cases, in order.
    pub cases: Vec<usize>,
    /// The attractor of each, by its place in the list below; none where the case has none.
    pub of_case: Vec<Option<usize>>,
    /// The attractors in the order in which the cases show them.
    pub attractors: Vec<Attractor>,
}

impl Cell {
    /// Sorts `cases`, each with its orbit, by attractor.
    pub fn sort<S: Locomotion>(cases: &[(usize, Case, &Orbit)], protocol: &Protocol) -> Cell {
        let mut cell = Cell::default();
        for (index, case, orbit) in cases {
            let found = Attractor::of::<S>(*index, case, orbit, protocol);
            let place = found.map(|found| {
                let omega = case.parameters[Parameter::Omega];
                let known = cell.attractors.iter().position(|known| known.is(&found, omega));
                known.unwrap_or_else(|| {
                    cell.attractors.push(found);
                    cell.attractors.len() - 1
                })
            });
            cell.cases.push(*index);
            cell.of_case.push(place);
        }
        cell
    }
}

impl Attractor {
    /// What a case has ended on; none where that repels or is not known.
    ///
    /// The bound of a periodic orbit: its residual, or the error of the integrator if that is larger, over
    /// the least distance of a multiplier from one, is how far the true orbit is along the slowest
    /// direction.
    fn of<S: Locomotion>(
        index: usize,
        case: &Case,
        orbit: &Orbit,
        protocol: &Protocol,
    ) -> Option<Attractor> {
        let Certificate { residual, multipliers, .. } = orbit.certificate;
        let wanted = match orbit.outcome {
            Outcome::Periodic if orbit.certificate.is_stable() => orbit.period as usize,
            Outcome::Chaotic | Outcome::QuasiPeriodic => SAMPLE,
            Outcome::Periodic | Outcome::Undecided | Outcome::Failed => return None,
        };
        let points = points::<S>(case, orbit, wanted, protocol)?;
        let omega = case.parameters[Parameter::Omega];
        let size = points.iter().map(|point| size(omega, point)).fold(0.0, f64::max);
        let residual = residual.max(protocol.tolerance);
        let bound = OBLIQUE * residual / least_from_one(&multipliers) * size;
        Some(Attractor { case: index, outcome: orbit.outcome, points, bound, size })
    }

    /// Whether this is the same attractor as another at the same parameters.
    ///
    /// Periodic orbits: the periods are equal, and the points up to a cyclic shift, within the two bounds.
    /// Others: by the nearest neighbours of the two samples (Schilling 1986). It breaks where two
    /// attractors interleave more closely than their samples lie, and where a motion drifts so slowly that
    /// its two samples do not meet.
    fn is(&self, other: &Attractor, omega: f64) -> bool {
        if self.outcome != other.outcome {
            return false;
        }
        match self.outcome {
            Outcome::Periodic => {
                coincide(&self.points, &other.points, self.bound + other.bound, omega)
            }
            _ => same_neighbours(&self.points, &other.points, omega) <= MIXED,
        }
    }
}

/// Whether two orbits are one up to where they begin.
pub fn coincide(a: &[Section], b: &[Section], bound: f64, omega: f64) -> bool {
    let k = a.len();
    k == b.len()
        && (0..k).any(|shift| (0..k).all(|i| apart(&a[i], &b[(i + shift) % k], omega) <= bound))
}

/// The share of points, of both samples, whose nearest neighbour is of their own sample.
fn same_neighbours(a: &[Section], b: &[Section], omega: f64) -> f64 {
    let nearest = |i: usize, own: &[Section], point: &Section| {
        let others = own.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, other)| apart(point, other, omega)).fold(f64::INFINITY, f64::min)
    };
    let own = |own: &[Section], other: &[Section]| {
        let is_own = |(i, point): &(usize, &Section)| {
            nearest(*i, own, point) < nearest(usize::MAX, other, point)
        };
        own.iter().enumerate().filter(is_own).count()
    };
    (own(a, b) + own(b, a)) as f64 / (a.len() + b.len()) as f64
}

/// So many section points of what a case ended on: those that were kept, or else followed anew.
fn points<S: Locomotion>(
    case: &Case,
    orbit: &Orbit,
    wanted: usize,
    protocol: &Protocol,
) -> Option<Vec<Section>> {
    if orbit.section.len() >= wanted {
        return Some(orbit.section[..wanted].to_vec());
    }
    let parameters = &case.parameters;
    let of = |parameter| Dual::<f64, 0>::constant(parameters[parameter]);
    let system = S::with(of, parameters.resistance, case.phase);
    let drive_period = Dual::constant(parameters.drive_period());
    let cycles = Cycles { drive_period, count: 1, tolerance: protocol.tolerance };
    let mut points = vec![[orbit.end.r, orbit.end.y1, orbit.end.y2]];
    while points.len() < wanted {
        let from = points[points.len() - 1].map(Dual::constant);
        points.push(values(&returned(&system, from, &cycles, |_| ()).ok()?));
    }
    Some(points)
}
