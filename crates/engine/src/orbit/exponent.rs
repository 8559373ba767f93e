//! How fast neighbouring motions part: Lyapunov exponents from the linearised flow.

use crate::flow::{Metric, Motion, Reason, STEPS_PER_CYCLE, Step, Stroboscopic, cycle};
use crate::lane::{Dual, Lane};

use super::return_map::Cycles;

/// Stretches are averaged in so many batches, whose spread tells the uncertainty.
pub const BATCHES: usize = 16;

/// An exponent with its statistical uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponent {
    /// Mean rate of stretching [1/s]; minus infinity where a direction is lost altogether.
    pub value: f64,
    /// Standard error of that mean [1/s].
    pub uncertainty: f64,
}

/// The stretching of `N` directions, cycle by cycle.
#[derive(Debug, Clone)]
pub struct Stretching<const D: usize, const N: usize> {
    metric: Metric<D>,
    /// Logarithm of the stretch in each cycle.
    logs: Vec<[f64; N]>,
}

impl<const D: usize, const N: usize> Stretching<D, N> {
    /// Nothing met yet.
    pub fn new(metric: Metric<D>) -> Self {
        Stretching { metric, logs: Vec::new() }
    }

    /// Directions to begin with: orthogonal, and none of them along a coordinate.
    pub fn first(&self) -> [[f64; N]; D] {
        let mut directions: [[f64; N]; D] = std::array::from_fn(|i| {
            std::array::from_fn(
                |j| if i == j { 2.0 } else { 1.0 / (i + j + 1) as f64 } / self.metric.scales[i],
            )
        });
        self.normalise(&mut directions);
        directions
    }

    /// Takes the directions as a cycle has stretched them, notes by how much, and makes them orthonormal
    /// again.
    ///
    /// Method: Gram and Schmidt's, as Benettin and others (1980) have it.
    pub fn meet(&mut self, directions: &mut [[f64; N]; D]) {
        let stretch = self.normalise(directions);
        self.logs.push(stretch.map(libm::log));
    }

    /// Makes the directions orthonormal; tells the length of each before.
    fn normalise(&self, directions: &mut [[f64; N]; D]) -> [f64; N] {
        for (row, scale) in directions.iter_mut().zip(&self.metric.scales) {
            row.iter_mut().for_each(|x| *x *= scale);
        }
        let lengths = std::array::from_fn(|j| {
            for before in 0..j {
                let along: f64 = directions.iter().map(|row| row[before] * row[j]).sum();
                directions.iter_mut().for_each(|row| row[j] -= along * row[before]);
            }
            let length = directions.iter().map(|row| row[j] * row[j]).sum::<f64>().sqrt();
            if length > 0.0 {
                directions.iter_mut().for_each(|row| row[j] /= length);
            }
            length
        });
        for (row, scale) in directions.iter_mut().zip(&self.metric.scales) {
            row.iter_mut().for_each(|x| *x /= scale);
        }
        lengths
    }

    /// Logarithm of the stretch of direction `j` over all cycles.
    pub fn total(&self, j: usize) -> f64 {
        self.logs.iter().map(|logs| logs[j]).sum()
    }

    /// Notes by how much a cycle has stretched directions that were orthonormal when it began.
    pub fn note(&mut self, logs: [f64; N]) {
        self.logs.push(logs);
    }

    /// The rates of each batch but the first, for cycles of this mean duration [s]: in the first the directions turn to where
    /// they belong.
    pub fn rates(&self, duration: f64) -> Vec<[f64; N]> {
        let length = self.logs.len() / BATCHES;
        let batches = self.logs[self.logs.len() - length * BATCHES..].chunks_exact(length.max(1));
        let rate = |batch: &[[f64; N]], j: usize| {
            batch.iter().map(|logs| logs[j]).sum::<f64>() / (length as f64 * duration)
        };
        batches.skip(1).map(|batch| std::array::from_fn(|j| rate(batch, j))).collect()
    }

    /// The exponents for cycles of this mean duration [s], the first that of the direction that grows most.
    ///
    /// The first batch is left out. The uncertainty is the standard error over the other batches, which are long against the
    /// memory of the motion or should be.
    pub fn exponents(&self, duration: f64) -> [Exponent; N] {
        exponents_of(&self.rates(duration))
    }
}

/// The exponents by their rates in batches of cycles.
pub fn exponents_of<const N: usize>(batches: &[[f64; N]]) -> [Exponent; N] {
    let count = batches.len() as f64;
    std::array::from_fn(|j| {
        let rates = batches.iter().map(|rates| rates[j]);
        let value = rates.clone().sum::<f64>() / count;
        if value == f64::NEG_INFINITY {
            return Exponent { value, uncertainty: 0.0 };
        }
        let squares: f64 = rates.map(|rate| (rate - value) * (rate - value)).sum();
        Exponent { value, uncertainty: (squares / (count * (count - 1.0))).sqrt() }
    })
}

/// The stretching of `N` directions over whole cycles from a point of the section, and the mean duration of a
/// cycle [s].
pub fn stretching<S, const D: usize, const N: usize>(
    system: &S,
    metric: Metric<D>,
    from: &[f64; D],
    cycles: &Cycles,
) -> Result<(Stretching<D, N>, f64), Reason>
where
    S: Stroboscopic<Dual<f64, N>, D>,
{
    let mut stretching = Stretching::new(metric);
    let directions = stretching.first();
    let start = std::array::from_fn(|i| Dual { value: from[i], gradient: directions[i] });
    let mut motion = Motion::new(system, Dual::splat(0.0), S::state(start));
    let mut step = Step::default();
    let mut elapsed = 0.0;
    for _ in 0..cycles.count {
        elapsed +=
            cycle(system, &mut motion, &mut step, (STEPS_PER_CYCLE, cycles.tolerance), |_| ())?
                .value;
        let mut point = S::point(&motion.state);
        let mut directions = point.map(|coordinate| coordinate.gradient);
        stretching.meet(&mut directions);
        for (coordinate, gradient) in point.iter_mut().zip(directions) {
            coordinate.gradient = gradient;
        }
        motion.state = S::state(point);
    }
    let mean = elapsed / cycles.count as f64;
    Ok((stretching, if S::AUTONOMOUS { mean } else { system.period().value }))
}
