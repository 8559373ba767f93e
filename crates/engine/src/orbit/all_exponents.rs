//! All Lyapunov exponents of what a case has settled to: its directions are followed for them.

use crate::flow::{Metric, System};

use super::aperiodic::regular_rate;
use super::exponent::{BATCHES, Exponent, Stretching, exponents_of};
use super::passage::{Integrator, ReturnRequest};
use super::return_map::Cycles;
use super::spectrum::{Spectrum, dimension, of_multipliers, sorted};
use super::{OrbitOf, Outcome};

/// Cycles that are asked for at a time, so that none in a lane is followed much longer than those beside it.
const AT_A_TIME: u64 = 128;
/// What all exponents of a case are computed from.
#[derive(Debug)]
pub(super) struct AllExponents<'a, M, const D: usize> {
    pub system: &'a M,
    /// A point of the section on the attractor.
    pub point: [f64; D],
    /// Cycles over which the largest exponent of a motion that does not repeat has been followed.
    pub followed: u64,
    /// Cycles at most.
    pub affordable: u64,
    pub tolerance: f64,
    pub integrator: &'a dyn Integrator<M, D>,
}

impl<M: System<D>, const D: usize> AllExponents<'_, M, D> {
    /// All exponents of an orbit; none where the steps that are left do not suffice, or its directions cannot be followed.
    ///
    /// Method: directions are made orthonormal step by step, and the logarithms of how much they are stretched are averaged over the
    /// cycles (Benettin and others 1980; Dieci and Van Vleck 2002). Of a periodic orbit they are those of its multipliers
    /// ([`of_multipliers`]).
    pub(super) fn of(&self, orbit: &OrbitOf<M, D>) -> Option<Spectrum<D>> {
        let repeats = orbit.outcome == Outcome::Periodic;
        let cycles = match repeats {
            true => BATCHES as u64 * orbit.period,
            false => self.followed,
        };
        if cycles < BATCHES as u64 || cycles > self.affordable {
            return None;
        }
        let batches = self.stretching(cycles)?.rates(orbit.duration);
        if repeats {
            let period = orbit.period as f64 * orbit.duration;
            return Some(of_multipliers(&orbit.certificate.multipliers, period, &batches));
        }
        let zero = if orbit.outcome == Outcome::QuasiPeriodic {
            regular_rate(cycles as f64 * orbit.duration)
        } else {
            0.0
        };
        let dimension = match orbit.outcome {
            Outcome::Chaotic | Outcome::QuasiPeriodic => dimension(&batches, zero),
            _ => Exponent { value: f64::NAN, uncertainty: f64::NAN },
        };
        Some(Spectrum { exponents: sorted(exponents_of(&batches)), dimension })
    }

    /// How much as many directions as there are coordinates are stretched over so many cycles.
    fn stretching(&self, cycles: u64) -> Option<Stretching<D, D>> {
        let metric: Metric<D> = self.system.metric();
        let mut stretching = Stretching::new(metric);
        let (mut point, mut columns) = (self.point, stretching.first());
        let mut left = cycles;
        while left > 0 {
            let count = left.min(AT_A_TIME);
            let passage = self.integrator.passage(ReturnRequest {
                system: self.system.clone(),
                along: None,
                point,
                units: metric.scales.map(|scale| 1.0 / scale),
                cycles: Cycles { count, tolerance: self.tolerance },
                watched: false,
                directions: Some(std::array::from_fn(|i| columns[i].map(|x| x * metric.scales[i]))),
            });
            let passage = passage.ok()?;
            passage.stretches.iter().for_each(|it| stretching.note(it.logs));
            (point, columns) = (passage.end, passage.jacobian);
            left -= count;
        }
        Some(stretching)
    }
}
