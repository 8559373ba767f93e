//! Whether a branch leads from one known orbit to another in a single step: told from the derivatives of the two.

use crate::flow::{Metric, Switched, System};
use crate::orbit::matrix::{Matrix, determinant, solve};
use crate::orbit::passage::{Integrator, ReturnRequest};
use crate::orbit::return_map::Cycles;

use super::arclength::ROUNDING;
use super::bialternate::torus;
use super::family::{counterpart, cyclic};
use super::orbits::{STEEPEST, shifted};
use super::periodic::HALVES;
use super::scales::units;
use super::segment::Along;
use super::walk::LEAST_MOVE;

/// The orbit foretold by one from its derivatives may be so far from the other, relative to the distance of the two.
const CORRECTION: f64 = 0.05;
/// The other orbit may be so far from where the trapezoidal rule leads, from the directions at both, relative to the distance.
const TRAPEZOID: f64 = 0.005;
/// The cosine of the angle between the directions of the branch at the two orbits is at least this.
const LEAST_COSINE: f64 = 0.98;

/// A periodic orbit with the derivatives of its return map, in the units of the system.
#[derive(Debug, Clone, PartialEq)]
pub struct Linearised<E, const D: usize> {
    /// The value of the parameter.
    value: f64,
    /// Its section points.
    points: Vec<[f64; D]>,
    /// How fast each of them moves with the parameter.
    slopes: Vec<[f64; D]>,
    /// How far the return of each is from the next.
    residuals: Vec<[f64; D]>,
    /// The derivative of the return map over the period at the first point.
    jacobian: Matrix<D>,
    /// Its cyclic sequence of events.
    events: Vec<E>,
    /// Its local extrema: when they are met after the first point [cycles], and how far they are below the surface.
    margins: Vec<(f64, f64)>,
    metric: Metric<D>,
}

impl<E, const D: usize> Linearised<E, D> {
    /// How far it gets from one of its section points in so many cycles.
    fn moves(&self, first: usize, cycles: usize) -> [f64; D] {
        let [a, b] = [first, (first + cycles) % self.points.len()].map(|at| self.points[at]);
        self.metric.difference(&b, &a)
    }
}

/// A periodic orbit with its derivatives, given by the value of the parameter and its section points; none where the
/// motion cannot be followed, where the system has no such parameter, where a multiplier is one, and of an autonomous
/// system, whose orbits may vanish.
pub fn linearised<M: System<D>, const D: usize>(
    integrator: &dyn Integrator<M, D>,
    along: &Along<M, D>,
    value: f64,
    points: &[[f64; D]],
) -> Option<Linearised<M::Event, D>> {
    if M::Single::AUTONOMOUS || !along.varied.is_had(&along.system) {
        return None;
    }
    let metric = along.system.metric();
    let mut product: Matrix<D> = shifted(&[[0.0; D]; D], 1.0);
    let (mut events, mut margins) = (Vec::new(), Vec::new());
    let (mut residuals, mut cycles) = (Vec::new(), Vec::new());
    // How fast the end of the cycles so far moves with the parameter if their beginning does not.
    let mut of_end = [0.0; D];
    for (i, point) in points.iter().enumerate() {
        let followed = integrator.passage(ReturnRequest {
            system: along.system.clone(),
            along: Some((along.varied.clone(), value, 1.0)),
            point: *point,
            units: [1.0; D],
            cycles: Cycles { count: 1, tolerance: along.tolerance },
            watched: true,
            directions: None,
        });
        let passage = followed.ok()?;
        let (end, next) = (passage.end, points[(i + 1) % points.len()]);
        residuals.push(metric.difference(&end, &next));
        let of_cycle = (passage.jacobian, passage.by_parameter);
        (product, of_end) = (times(&of_cycle.0, &product), carried(&of_cycle, &of_end));
        cycles.push(of_cycle);
        events.extend(passage.events);
        margins.extend(passage.margins.into_iter().map(|(time, it)| (i as f64 + time, it)));
    }
    let first = solve(shifted(&product, -1.0), of_end.map(|part| -part))?;
    let mut slopes = vec![first];
    for cycle in &cycles[..cycles.len() - 1] {
        slopes.push(carried(cycle, &slopes[slopes.len() - 1]));
    }
    let (points, events) = (points.to_vec(), cyclic(&events));
    let jacobian = product;
    Some(Linearised { value, points, slopes, residuals, jacobian, events, margins, metric })
}

/// The product of two matrices.
fn times<const D: usize>(a: &Matrix<D>, b: &Matrix<D>) -> Matrix<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..D).map(|k| a[i][k] * b[k][j]).sum()))
}

/// How fast the end of a cycle moves with the parameter where its beginning moves so.
fn carried<const D: usize>(
    (jacobian, by_parameter): &(Matrix<D>, [f64; D]),
    slope: &[f64; D],
) -> [f64; D] {
    std::array::from_fn(|i| {
        by_parameter[i] + (0..D).map(|j| jacobian[i][j] * slope[j]).sum::<f64>()
    })
}

/// Whether the branch through an orbit leads to another one of the same period, and no special point lies between.
///
/// Method: the first step of [`segment`](super::segment()) with its end known. What a step asks of the orbit that it
/// meets is asked of the other one, more strictly: that it lies where the derivatives foretell, those of the first orbit
/// and those of both, that the branch keeps its direction, and that neither a test function nor the distance of an extremum
/// from its surface changes its sign. Where the answer is no, nothing is said.
/// Breaks: where a segment does, which does not see what happens twice within a step.
pub fn leads_to<M: System<D>, const D: usize>(
    along: &Along<M, D>,
    from: &Linearised<M::Event, D>,
    to: &Linearised<M::Event, D>,
) -> bool {
    let range = [from.value.min(to.value), from.value.max(to.value)];
    let units = units(&along.system, &along.varied, range, &from.points);
    let step = Step { from, to, units };
    from.points.len() == to.points.len()
        && from.events == to.events
        && step.keeps_its_signs()
        && [from, to].iter().all(|orbit| step.is_exact(orbit) && step.is_followed(orbit))
        && (0..to.points.len()).any(|shift| {
            step.is_foretold(shift) && step.is_whole(shift) && step.crosses_nothing(shift)
        })
}

/// The step from one orbit to another, in units of the section.
struct Step<'a, E, const D: usize> {
    from: &'a Linearised<E, D>,
    to: &'a Linearised<E, D>,
    units: [f64; D],
}

impl<E, const D: usize> Step<'_, E, D> {
    /// The length of a vector of the section.
    fn length(&self, vector: &[f64; D]) -> f64 {
        self.inner(vector, vector).sqrt()
    }

    /// The inner product of two vectors of the section.
    fn inner(&self, a: &[f64; D], b: &[f64; D]) -> f64 {
        (0..D).map(|i| a[i] * b[i] / (self.units[i] * self.units[i])).sum()
    }

    /// Whether an orbit closes to rounding.
    fn is_exact(&self, orbit: &Linearised<E, D>) -> bool {
        orbit.residuals.iter().all(|residual| self.length(residual) <= ROUNDING)
    }

    /// Whether the return map of an orbit is not too steep to be followed.
    fn is_followed(&self, orbit: &Linearised<E, D>) -> bool {
        orbit.jacobian.iter().zip(&self.units).all(|(row, unit)| {
            row.iter().zip(&self.units).all(|(it, by)| (it * by / unit).abs() <= STEEPEST)
        })
    }

    /// Whether no test function of a special point changes its sign.
    fn keeps_its_signs(&self) -> bool {
        let [a, b] = [self.from, self.to].map(|orbit| &orbit.jacobian);
        let tests: [fn(&Matrix<D>) -> f64; 3] =
            [|it| determinant(shifted(it, -1.0)), |it| determinant(shifted(it, 1.0)), torus];
        tests.iter().all(|test| test(a) * test(b) > 0.0)
    }

    /// Whether the other orbit, begun at another of its points, lies where this one foretells and where the two do, in a
    /// direction that stays.
    fn is_foretold(&self, shift: usize) -> bool {
        let (from, to) = (self.from, self.to);
        let change = to.value - from.value;
        let [here, there] = [from.slopes[0], to.slopes[shift]].map(|it| it.map(|x| x * change));
        let mean = std::array::from_fn(|i| 0.5 * (here[i] + there[i]));
        let section = self.length(&here);
        // The units of a segment: the parameter changes as the section does, within limits.
        let parameter = section.max(LEAST_MOVE);
        let lengths = [&here, &there].map(|it| libm::hypot(self.length(it), parameter));
        let inner = self.inner(&here, &there) + parameter * parameter;
        section <= 1.0
            && inner >= LEAST_COSINE * lengths[0] * lengths[1]
            && self.error(shift, &here) <= CORRECTION * lengths[0]
            && self.error(shift, &mean) <= TRAPEZOID * lengths[0]
    }

    /// How far the other orbit is from where this one, moved so, would be.
    fn error(&self, shift: usize, by: &[f64; D]) -> f64 {
        let (here, there) = (self.from.points[0], self.to.points[shift]);
        let apart = self.from.metric.difference(&there, &here);
        self.length(&std::array::from_fn(|i| apart[i] - by[i]))
    }

    /// Whether no extremum crosses its surface: of the same events one may begin where another ceases.
    fn crosses_nothing(&self, shift: usize) -> bool {
        let period = self.to.points.len() as u64;
        let shifted = self.to.margins.iter().map(|(time, it)| (time - shift as f64, *it));
        let (from, to) = (&self.from.margins, shifted.collect::<Vec<_>>());
        from.iter().all(|extremum| {
            let other = counterpart(extremum, [from, &to], period);
            other.is_none_or(|(_, margin)| extremum.1 * margin > 0.0)
        })
    }

    /// Whether the orbits repeat after no part of their period, and the step leads to no point half a period later.
    fn is_whole(&self, shift: usize) -> bool {
        (1..self.to.points.len()).all(|cycles| {
            let (before, behind) = (self.from.moves(0, cycles), self.to.moves(shift, cycles));
            self.length(&behind) > HALVES && self.inner(&before, &behind) > 0.0
        })
    }
}
