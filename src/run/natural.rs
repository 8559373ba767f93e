//! Follows a periodic orbit along one parameter: Newton's method from each value to the next.

use std::marker::PhantomData;

use crate::capsule::{CapsuleSystem, Case, Parameter, Reading, Section};
use crate::flow::{Metric, System};
use crate::lane::Dual;
use crate::orbit::Protocol;
use crate::orbit::matrix::{Complex, Matrix, determinant, eigenvalues, solve};
use crate::orbit::newton::close;
use crate::orbit::precision::resolution;
use crate::orbit::return_map::{Cycles, jacobian, returned, seeded, values};

/// Values of the parameter closer together than this, relative to them, are one value.
pub const ROUNDING: f64 = 2e-13;
/// Values tried at most between two that are given.
const ATTEMPTS: usize = 200;
/// Cycles of orbits tried at most between two values: where a long orbit ends is not worth more.
const CYCLES: usize = 400;
/// Values tried between two however long the orbit is.
const FEW: usize = 8;
/// A repelling orbit is not worth steps shorter than this share of the distance.
const SHORTEST: f64 = 1e-3;

/// A periodic orbit at one value of the parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The value.
    pub value: f64,
    /// Its section points, one for each cycle of its period.
    pub points: Vec<Section>,
    /// Size of the motion [m/s].
    pub size: f64,
    /// How far the true orbit may be, relative to the motion [-].
    pub error: f64,
    /// The derivative of the map over a period.
    pub jacobian: Matrix<3>,
    /// The events of a period by their numbers, begun where that gives the least sequence.
    pub events: Vec<u8>,
}

impl Solution {
    /// Its period [cycles].
    pub fn period(&self) -> usize {
        self.points.len()
    }

    /// Its Floquet multipliers, the largest magnitude first.
    pub fn multipliers(&self) -> [Complex; 3] {
        eigenvalues(&self.jacobian)
    }

    /// Whether small pushes die out.
    pub fn attracts(&self) -> bool {
        self.multipliers()[0].abs() < 1.0
    }

    /// Whether an odd number of multipliers lies beyond `bound`, which is -1 or +1.
    pub fn passes(&self, bound: f64) -> bool {
        self.shifted_determinant(bound) * bound > 0.0
    }

    /// The product of all multipliers less `bound`; while all are stable it has the sign of -`bound`.
    pub fn shifted_determinant(&self, bound: f64) -> f64 {
        let mut shifted = self.jacobian;
        for (i, row) in shifted.iter_mut().enumerate() {
            row[i] -= bound;
        }
        determinant(shifted)
    }

    /// Whether a pair of complex multipliers lies beyond the unit circle.
    pub fn spirals(&self) -> bool {
        self.multipliers().iter().any(|it| it.im != 0.0 && it.abs() > 1.0)
    }
}

/// Where following an orbit has led.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// To the value that was asked for.
    Reached,
    /// To where the orbit ends: it does not go on for this much more of the parameter.
    Stopped(f64),
    /// Nowhere in particular: the steps became too many.
    Lost,
}

/// What is held while one parameter varies.
pub struct Along<'a, R> {
    /// A case with the values of the others.
    pub case: Case,
    /// The parameter that varies.
    pub parameter: Parameter,
    /// How closely orbits are computed.
    pub protocol: &'a Protocol,
    /// The reading of the switching.
    pub reading: PhantomData<R>,
}

impl<R: Reading> Along<'_, R> {
    /// The orbit that repeats after `period` cycles, and not before, nearest to `from` at a value of the
    /// parameter; `size` is about that of the motion [m/s].
    pub fn close(&self, value: f64, from: &Section, period: usize, size: f64) -> Option<Solution> {
        let system = self.system(Dual::<f64, 3>::constant(value));
        let cycles = self.cycles(period);
        let closed = close(&system, &self.metric(value), from, &cycles, size).ok()??;
        if closed.residual > self.protocol.recurrence {
            return None;
        }
        let solution = self.trace(value, closed.point, period)?;
        let solution = Solution { error: closed.error, jacobian: closed.jacobian, ..solution };
        self.is_least(&solution).then_some(solution)
    }

    /// The orbit at `value` between two orbits of a branch, begun from the straight line between them.
    pub fn between(&self, low: &Solution, high: &Solution, value: f64) -> Option<Solution> {
        let share = (value - low.value) / (high.value - low.value);
        let [a, b] = [low, high].map(|solution| solution.points[0]);
        let from = std::array::from_fn(|i| a[i] + share * (b[i] - a[i]));
        let size = low.size.max(high.size);
        self.close(value, &from, low.period(), size).or_else(|| {
            let (mut path, end) = self.follow(low, value);
            path.pop().filter(|_| end == End::Reached)
        })
    }

    /// The orbit that is known to have these section points.
    pub fn known(&self, value: f64, points: &[Section], error: f64) -> Option<Solution> {
        let cycles = self.cycles(points.len());
        let system = self.system(Dual::<f64, 3>::constant(value));
        let image = returned(&system, seeded(&points[0]), &cycles, |_| ()).ok()?;
        let solution = self.trace(value, points[0], points.len())?;
        let jacobian = jacobian(&image);
        let is_finite = jacobian.iter().flatten().all(|part| part.is_finite());
        is_finite.then_some(Solution { error, jacobian, ..solution })
    }

    /// Follows an orbit to another value of the parameter; returns the orbits of the path, itself the first.
    ///
    /// Method: natural continuation, with the slope of the orbit over the parameter from the linearised
    /// flow as predictor and Newton's method as corrector; steps are halved where it does not close, and
    /// doubled where it does. A step that lands beyond a fold, where the determinant of I - J has changed
    /// its sign, counts as one that does not close. Where steps have shrunk to rounding the orbit has
    /// ended; one that repels is given up before. It breaks where another orbit is nearer than the error of
    /// the prediction.
    pub fn follow(&self, from: &Solution, to: f64) -> (Vec<Solution>, End) {
        let mut path = vec![from.clone()];
        let mut step = to - from.value;
        let most = ATTEMPTS.min(CYCLES / from.period()).max(FEW);
        let rounding = ROUNDING * from.value.abs().max(to.abs());
        let mut attempts = 0;
        while let Some(here) = path.last().filter(|here| here.value != to) {
            let Some(slope) = self.slope(here) else { return (path, End::Lost) };
            let next = loop {
                attempts += 1;
                if attempts > most {
                    return (path, End::Lost);
                }
                let left = to - here.value;
                let target = if left.abs() <= step.abs() { to } else { here.value + step };
                if let Some(next) = self.step(here, &slope, target) {
                    break next;
                }
                if step.abs() <= rounding {
                    return (path, End::Stopped(step));
                }
                if step.abs() <= SHORTEST * (to - from.value).abs() && !here.attracts() {
                    return (path, End::Lost);
                }
                step = 0.5 * (target - here.value);
            };
            step = ahead(here, &next, rounding);
            path.push(next);
        }
        (path, End::Reached)
    }

    fn step(&self, here: &Solution, slope: &Section, target: f64) -> Option<Solution> {
        let change = target - here.value;
        let from = std::array::from_fn(|i| here.points[0][i] + slope[i] * change);
        // An orbit that begins at rest has no size of its own yet.
        let size = here.size.max(self.metric(target).size(&from));
        let next = self.close(target, &from, here.period(), size)?;
        (next.passes(1.0) == here.passes(1.0)).then_some(next)
    }

    /// How fast the first section point moves with the parameter: (I - J)^-1 dP/dp.
    fn slope(&self, here: &Solution) -> Option<Section> {
        let value = Dual::<f64, 4>::variable(here.value, 3);
        let cycles = self.cycles(here.period());
        let start = seeded(&here.points[0]);
        let image = returned(&self.system(value), start, &cycles, |_| ()).ok()?;
        let mut less = jacobian(&image);
        for (i, row) in less.iter_mut().enumerate() {
            row.iter_mut().for_each(|x| *x = -*x);
            row[i] += 1.0;
        }
        solve(less, image.map(|coordinate| coordinate.gradient[3]))
    }

    /// The system at a value of the parameter.
    fn system<const N: usize>(
        &self,
        value: Dual<f64, N>,
    ) -> <CapsuleSystem<R> as System<3>>::In<Dual<f64, N>> {
        let Case { parameters, section_phase, .. } = &self.case;
        let of = |parameter: Parameter| match parameter == self.parameter {
            true => value,
            false => Dual::constant(parameters[parameter]),
        };
        R::capsule(of, parameters.resistance, *section_phase)
    }

    fn cycles(&self, count: usize) -> Cycles {
        Cycles { count: count as u64, tolerance: self.protocol.tolerance }
    }

    /// The points and events of a period from a section point, without derivatives.
    fn trace(&self, value: f64, start: Section, period: usize) -> Option<Solution> {
        let system = self.system(Dual::<f64, 0>::constant(value));
        let cycles = self.cycles(1);
        let mut events = Vec::new();
        let mut points = vec![start];
        for n in 0..period {
            let from = points[n].map(Dual::constant);
            let see =
                |step: &crate::flow::Step<Dual<f64, 0>, _>| events.push(step.event.value as u8);
            points.push(values(&returned(&system, from, &cycles, see).ok()?));
        }
        points.pop();
        events.retain(|&event| event > 0);
        let metric = self.metric(value);
        let size = points.iter().map(|point| metric.size(point)).fold(0.0, f64::max);
        let events = least_rotation(&events);
        Some(Solution { value, points, size, error: 0.0, jacobian: Matrix::default(), events })
    }

    /// How far two section points are apart at a value of the parameter.
    pub fn metric(&self, value: f64) -> Metric<3> {
        let system = self.case.read::<R>().system;
        system.with(self.parameter, value).metric()
    }

    /// Whether an orbit does not repeat after a divisor of its period already.
    fn is_least(&self, solution: &Solution) -> bool {
        let (points, metric) = (&solution.points, self.metric(solution.value));
        let near = resolution(self.protocol.recurrence) * solution.size;
        let repeats = |d: usize| {
            points.len().is_multiple_of(d)
                && (d..points.len()).all(|i| metric.distance(&points[i], &points[i - d]) <= near)
        };
        !(1..points.len()).any(repeats)
    }
}

/// How far to go on from the second of two orbits: twice as far as between them, or nearly to the fold that
/// they foretell.
fn ahead(before: &Solution, here: &Solution, rounding: f64) -> f64 {
    let advance = here.value - before.value;
    let left = left_to_fold(before, here);
    let step =
        if left > 0.0 && left < 2.0 * advance.abs() { 0.9 * left } else { 2.0 * advance.abs() };
    step.max(rounding).copysign(advance)
}

/// How far beyond the second of two orbits a fold is, where the determinant of I - J vanishes as the root
/// of what is left of the parameter; not positive where none is foretold.
pub fn left_to_fold(before: &Solution, here: &Solution) -> f64 {
    let square = |it: &Solution| it.shifted_determinant(1.0) * it.shifted_determinant(1.0);
    let [first, second] = [before, here].map(square);
    (here.value - before.value).abs() * second / (first - second)
}

/// A cyclic sequence, begun where that makes it the least.
fn least_rotation(events: &[u8]) -> Vec<u8> {
    let rotated = |by: usize| [&events[by..], &events[..by]].concat();
    (0..events.len()).map(rotated).min().unwrap_or_default()
}
