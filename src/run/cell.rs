//! A cell of a diagram: the cases with the same parameters, sorted by the attractor they ended on.

use rayon::prelude::*;

use crate::capsule::{Locomotion, Parameter};
use crate::lane::Dual;
use crate::orbit::certificate::OBLIQUE;
use crate::orbit::recurrence::size;
use crate::orbit::return_map::{Cycles, returned, values};
use crate::orbit::{Case, Outcome, Protocol, Section};

use super::Ending;
use crate::branch::natural::apart;

/// Points by which two motions that do not repeat are compared.
const SAMPLE: usize = 64;
/// Two samples of one motion have half of all nearest neighbours in the same sample, those of two motions
/// all: half way between the two they are told apart.
const MIXED: f64 = 0.75;
/// So many cases are followed before they are sorted in turn, as a cell may have millions.
const TOGETHER: usize = 4096;
/// A thread takes so many of them at least: fewer are not worth sharing out.
const SHARE: usize = 16;

/// An attractor as the cases of one cell show it.
#[derive(Debug, Clone, PartialEq)]
pub struct Attractor {
    /// The first of its cases.
    pub case: usize,
    /// Periodic, chaotic or quasi-periodic.
    pub outcome: Outcome,
    /// Section points of a period, or a sample, which is held only until the cell is sorted.
    pub points: Vec<Section>,
    /// How far each point may be from the true orbit [m/s].
    pub bound: f64,
    /// Size of the motion [m/s].
    pub size: f64,
}

/// The cases with the same parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cell {
    /// The attractor of each case, by its place in the list below; none where the case has none.
    pub of_case: Vec<Option<u32>>,
    /// The attractors in the order in which the cases show them.
    pub attractors: Vec<Attractor>,
}

impl Cell {
    /// Sorts so many cases by attractor: `ending` tells the index and the ending of each, and `case` their
    /// parameters.
    ///
    /// The threads follow many cases at a time and compare each with the attractors that are known by then;
    /// what is new is sorted in turn. A case belongs to the first attractor that it matches, and attractors
    /// are only added at the end, so that it does not matter how many were known.
    pub fn sort<S: Locomotion>(
        cases: usize,
        ending: impl Fn(usize) -> (usize, Option<Ending>) + Sync,
        case: &Case,
        protocol: &Protocol,
    ) -> Cell {
        let omega = case.parameters[Parameter::Omega];
        let mut cell = Cell { of_case: Vec::with_capacity(cases), attractors: Vec::new() };
        for first in (0..cases).step_by(TOGETHER) {
            let meet = |place: usize| {
                let (index, ending) = ending(place);
                let found = Attractor::of::<S>(index, case, &ending?, protocol)?;
                Some(cell.place(&found, omega).ok_or(found))
            };
            let places = first..cases.min(first + TOGETHER);
            let places = places.into_par_iter().with_min_len(SHARE);
            let met: Vec<Option<Result<usize, Attractor>>> = places.map(meet).collect();
            for met in met {
                let place = met.map(|met| met.unwrap_or_else(|new| cell.add(new, omega)));
                cell.of_case.push(place.map(|place| place as u32));
            }
        }
        for attractor in &mut cell.attractors {
            if attractor.outcome != Outcome::Periodic {
                attractor.points = Vec::new();
            }
        }
        cell
    }

    /// The place of an attractor, if it is known.
    fn place(&self, found: &Attractor, omega: f64) -> Option<usize> {
        self.attractors.iter().position(|known| known.is(found, omega))
    }

    /// The place of an attractor, which is added if it is not known.
    fn add(&mut self, found: Attractor, omega: f64) -> usize {
        self.place(&found, omega).unwrap_or_else(|| {
            self.attractors.push(found);
            self.attractors.len() - 1
        })
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
        ending: &Ending,
        protocol: &Protocol,
    ) -> Option<Attractor> {
        let wanted = match ending.outcome {
            Outcome::Periodic if ending.is_stable => ending.period as usize,
            Outcome::Chaotic | Outcome::QuasiPeriodic => SAMPLE,
            Outcome::Periodic | Outcome::Undecided | Outcome::Failed => return None,
        };
        let points = points::<S>(case, ending.section, wanted, protocol)?;
        let omega = case.parameters[Parameter::Omega];
        let size = points.iter().map(|point| size(omega, point)).fold(0.0, f64::max);
        let residual = ending.residual.max(protocol.tolerance);
        let bound = OBLIQUE * residual / ending.from_one * size;
        Some(Attractor { case: index, outcome: ending.outcome, points, bound, size })
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

/// So many section points of the motion from one of them on.
fn points<S: Locomotion>(
    case: &Case,
    from: Section,
    wanted: usize,
    protocol: &Protocol,
) -> Option<Vec<Section>> {
    let parameters = &case.parameters;
    let of = |parameter| Dual::<f64, 0>::constant(parameters[parameter]);
    let system = S::with(of, parameters.resistance, case.section_phase);
    let drive_period = Dual::constant(parameters.drive_period());
    let cycles = Cycles { drive_period, count: 1, tolerance: protocol.tolerance };
    let mut points = Vec::with_capacity(wanted);
    points.push(from);
    while points.len() < wanted {
        let from = points[points.len() - 1].map(Dual::constant);
        points.push(values(&returned(&system, from, &cycles, |_| ()).ok()?));
    }
    Some(points)
}
