//! Nonlinear least squares: parameters within bounds, robust losses, and what the data say of each.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::{DMatrix, DVector, Dyn, Owned};

use super::covariance::{Covariance, Data};
use super::estimate::Estimate;
pub use super::loss::Loss;

/// Residuals at some parameters, with their derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct Residuals {
    /// One per datum, divided by its standard deviation where that is known.
    pub values: Vec<f64>,
    /// Their derivatives in each parameter, by datum.
    pub slopes: Vec<Vec<f64>>,
}

impl Residuals {
    /// Adds a datum.
    pub fn push(&mut self, value: f64, slopes: Vec<f64>) {
        self.values.push(value);
        self.slopes.push(slopes);
    }
}

/// A model to be fitted: from parameters to residuals; none where it has no value.
pub trait Model {
    /// The residuals at `parameters`, with their derivatives.
    fn residuals(&self, parameters: &[f64]) -> Option<Residuals>;
}

impl<F: Fn(&[f64]) -> Option<Residuals>> Model for F {
    fn residuals(&self, parameters: &[f64]) -> Option<Residuals> {
        self(parameters)
    }
}

/// Where a parameter is looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The least value, infinite where there is none; then the greatest is, too.
    pub least: f64,
    /// The greatest value.
    pub greatest: f64,
}

impl Bounds {
    /// Any value.
    pub const NONE: Bounds = Bounds { least: f64::NEG_INFINITY, greatest: f64::INFINITY };

    /// Whether a value is one of the bounds, within a millionth of their distance.
    pub fn holds(self, value: f64) -> bool {
        let near = 1e-6 * (self.greatest - self.least);
        near.is_finite() && (value - self.least < near || self.greatest - value < near)
    }
}

/// How a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Termination {
    /// The sum of squares or the parameters no longer change.
    Converged,
    /// More evaluations are needed than are allowed.
    OutOfEvaluations,
    /// The model has no value where the search led, or at the start.
    NoValue,
}

/// The outcome of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The best parameters.
    pub parameters: Vec<f64>,
    /// The sum of squares of the residuals, as the loss weighs them.
    pub sum_of_squares: f64,
    /// Data less parameters.
    pub degrees_of_freedom: usize,
    /// What the data say of the parameters together; one that lies on a bound is left out.
    pub covariance: Covariance,
    /// How it ended.
    pub termination: Termination,
}

impl Fit {
    /// Whether only combinations of a parameter with others are determined.
    pub fn is_open(&self, parameter: usize) -> bool {
        self.covariance.is_combined[parameter]
    }

    /// A parameter with its standard error and interval.
    pub fn estimate(&self, parameter: usize) -> Estimate {
        let error = self.standard_error(parameter);
        Estimate::of_student(self.parameters[parameter], error, self.degrees_of_freedom)
    }

    /// The standard deviation of the residuals, estimated from them.
    pub fn residual_deviation(&self) -> f64 {
        (self.sum_of_squares / self.degrees_of_freedom as f64).sqrt()
    }

    /// The standard error of a parameter, with the scatter estimated from the residuals.
    pub fn standard_error(&self, parameter: usize) -> f64 {
        self.covariance.covariance[(parameter, parameter)].sqrt()
    }
}

/// How a fit is searched for.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// Where each parameter is looked for.
    pub bounds: Vec<Bounds>,
    /// How residuals are weighed.
    pub loss: Loss,
    /// How many data in turn have one distribution, where outliers count little; all have where it is empty.
    pub groups: Vec<usize>,
    /// Evaluations of the model per parameter at most.
    pub patience: usize,
    /// The search ends where a step changes the sum of squares or the parameters by less than this share.
    pub tolerance: f64,
}

impl Search {
    /// Without bounds, by squares.
    pub fn free(parameters: usize) -> Search {
        Search {
            bounds: vec![Bounds::NONE; parameters],
            loss: Loss::Squares,
            groups: Vec::new(),
            patience: 1000,
            tolerance: 1e-15,
        }
    }
}

/// The first steps that are tried, relative to the size of the parameters.
///
/// A long one converges soonest, but may lead where the data say nothing (an exponential that has decayed before the first
/// datum); so shorter ones are tried too, and the least sum of squares wins.
const FIRST_STEPS: [f64; 4] = [100.0, 1.0, 0.1, 0.01];
/// Sums of squares that differ by less than this share are the same minimum.
const SAME: f64 = 1e-9;
/// A residual where the model has no value.
const REFUSED: f64 = 1e100;

/// The parameters near `start` at which the sum of squares of the residuals is least.
///
/// # Method
///
/// Levenberg and Marquardt's with a trust region, from several lengths of the first step in turn until two end in the same minimum. A parameter
/// between bounds is written as `least + (greatest - least) (1 + sin u)/2`.
///
/// # Source
///
/// Moré, Lecture Notes in Mathematics 630 (1978); the bounds after James and Roos, Computer Physics Communications 10 (1975).
///
/// # Guarantees
///
/// Six digits and more of the certified values of NIST's problems of nonlinear regression, from both starts.
pub fn fit(model: &impl Model, start: &[f64], search: &Search) -> Option<Fit> {
    let mut best: Option<Fit> = None;
    for first_step in FIRST_STEPS {
        let Some(fit) = fit_once(model, start, search, first_step) else { continue };
        let same = best.as_ref().is_some_and(|best| {
            let apart = (fit.sum_of_squares - best.sum_of_squares).abs();
            let converged = [&fit, best].iter().all(|it| it.termination == Termination::Converged);
            converged && apart <= SAME * best.sum_of_squares
        });
        if best.as_ref().is_none_or(|best| fit.sum_of_squares < best.sum_of_squares) {
            best = Some(fit);
        }
        if same {
            break;
        }
    }
    best
}

/// The same from one first step.
pub fn fit_once(
    model: &impl Model,
    start: &[f64],
    search: &Search,
    first_step: f64,
) -> Option<Fit> {
    let inner: Vec<f64> =
        start.iter().zip(&search.bounds).map(|(&value, &bounds)| inner(value, bounds)).collect();
    let mut problem =
        Problem { model, search, inner: DVector::from_vec(inner), held: None, count: 0 };
    problem.evaluate();
    problem.count = problem.held.as_ref()?.values.len();
    let method = LevenbergMarquardt::new()
        .with_stepbound(first_step)
        .with_patience(search.patience)
        .with_tol(search.tolerance);
    let (problem, report) = method.minimize(problem);
    let termination = match report.termination {
        TerminationReason::LostPatience => Termination::OutOfEvaluations,
        TerminationReason::User(_) => Termination::NoValue,
        _ => Termination::Converged,
    };
    Some(problem.fit(termination))
}

/// The free variable of a parameter within bounds. A start on a bound has no slope there; it is moved off.
fn inner(value: f64, Bounds { least, greatest }: Bounds) -> f64 {
    if !least.is_finite() {
        return value;
    }
    let share = ((value - least) / (greatest - least)).clamp(1e-4, 1.0 - 1e-4);
    (2.0 * share - 1.0).asin()
}

/// The parameter of a free variable, and its slope in it.
fn outer(u: f64, Bounds { least, greatest }: Bounds) -> (f64, f64) {
    if !least.is_finite() {
        return (u, 1.0);
    }
    let half = 0.5 * (greatest - least);
    (least + half * (1.0 + u.sin()), half * u.cos())
}

struct Problem<'m, M> {
    model: &'m M,
    search: &'m Search,
    inner: DVector<f64>,
    /// The residuals at `inner`, as the loss weighs them, with slopes in the parameters themselves.
    held: Option<Residuals>,
    /// How many residuals there are.
    count: usize,
}

impl<M: Model> Problem<'_, M> {
    fn outer(&self) -> Vec<(f64, f64)> {
        self.inner.iter().zip(&self.search.bounds).map(|(&u, &bounds)| outer(u, bounds)).collect()
    }

    fn evaluate(&mut self) {
        let values: Vec<f64> = self.outer().into_iter().map(|(value, _)| value).collect();
        let residuals = self.model.residuals(&values);
        let finite = residuals.filter(|it| it.values.iter().all(|value| value.is_finite()));
        self.held = finite.map(|it| weighed(it, self.search.loss));
    }

    fn fit(&self, termination: Termination) -> Fit {
        let parameters: Vec<f64> = self.outer().into_iter().map(|(value, _)| value).collect();
        let held =
            self.held.clone().unwrap_or(Residuals { values: vec![f64::NAN], slopes: Vec::new() });
        let on_bound: Vec<bool> = parameters
            .iter()
            .zip(&self.search.bounds)
            .map(|(&value, it)| it.holds(value))
            .collect();
        // The covariance is that of the residuals as they are, not as the loss weighs them.
        let plain = match self.search.loss {
            Loss::Squares => None,
            Loss::SoftL1(_) => self.model.residuals(&parameters),
        };
        let plain = plain.as_ref().unwrap_or(&held);
        let groups = &self.search.groups;
        let data = Data { values: &plain.values, slopes: &plain.slopes, groups };
        Fit {
            sum_of_squares: held.values.iter().map(|it| it * it).sum(),
            degrees_of_freedom: held.values.len().saturating_sub(parameters.len()),
            covariance: Covariance::new(data, self.search.loss, &on_bound),
            parameters,
            termination,
        }
    }
}

impl<M: Model> LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_, M> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        self.inner.copy_from(x);
        self.evaluate();
    }

    fn params(&self) -> DVector<f64> {
        self.inner.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(match &self.held {
            Some(held) => DVector::from_column_slice(&held.values),
            // Residuals that are far too large turn the search back.
            None => DVector::from_element(self.count, REFUSED),
        })
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let held = self.held.as_ref()?;
        let by_inner: Vec<f64> = self.outer().into_iter().map(|(_, slope)| slope).collect();
        Some(DMatrix::from_fn(held.values.len(), by_inner.len(), |row, column| {
            held.slopes[row][column] * by_inner[column]
        }))
    }
}

/// Residuals whose squares are what the loss makes of them.
fn weighed(mut residuals: Residuals, loss: Loss) -> Residuals {
    let Loss::SoftL1(size) = loss else { return residuals };
    for (value, slopes) in residuals.values.iter_mut().zip(&mut residuals.slopes) {
        let share = *value / size;
        let root = (1.0 + share * share).sqrt();
        // 2 (root - 1) without the difference of near numbers.
        let squared = 2.0 * share * share / (root + 1.0);
        let weighed = squared.sqrt().copysign(share);
        let slope = if share == 0.0 { 1.0 } else { share / (root * weighed) };
        *value = size * weighed;
        slopes.iter_mut().for_each(|it| *it *= slope);
    }
    residuals
}
