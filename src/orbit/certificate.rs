//! What is proven of a periodic orbit: that it closes, how it answers to small pushes, and that its period
//! is the least.

use crate::lane::Dual;
use crate::model::{Locomotion, Parameter};

use super::matrix::{Complex, eigenvalues};
use super::newton::{Closed, close};
use super::return_map::Cycles;
use super::{Case, Protocol, Section};

/// How much farther an orbit may be than a residual and multipliers say, as they do not tell how oblique
/// the directions are that the multipliers belong to.
pub const OBLIQUE: f64 = 100.0;

/// The least distance of a multiplier from one, over which a residual is how far the orbit is.
pub fn least_from_one(multipliers: &[Complex; 3]) -> f64 {
    let from_one = multipliers.iter().map(|it| libm::hypot(1.0 - it.re, it.im));
    from_one.fold(f64::INFINITY, f64::min)
}

/// How a period was proven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Proof {
    /// It was not.
    None = 0,
    /// Newton's method on the return map ended on an orbit that closes to rounding.
    Newton,
    /// The orbit closes, but the mass just touches the stop, where the derivatives are those of one side.
    Grazing,
}

impl Proof {
    /// Every proof by its name in files, in the order of declaration.
    pub const NAMES: [(&str, Proof); 3] =
        [("none", Proof::None), ("newton", Proof::Newton), ("grazing", Proof::Grazing)];
}

/// What is proven of a periodic orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certificate {
    /// How.
    pub proof: Proof,
    /// How far the section is from repeating after a period, relative to the motion [-]; NaN without an
    /// orbit.
    pub residual: f64,
    /// Floquet multipliers of the period, the largest magnitude first [-]; NaN where they are not known.
    pub multipliers: [Complex; 3],
}

impl Certificate {
    /// Nothing is proven.
    pub fn none() -> Self {
        let unknown = Complex { re: f64::NAN, im: f64::NAN };
        Certificate { proof: Proof::None, residual: f64::NAN, multipliers: [unknown; 3] }
    }

    /// Whether small pushes die out; not where the multipliers are unknown.
    pub fn is_stable(&self) -> bool {
        self.multipliers[0].abs() < 1.0
    }
}

/// A periodic orbit that Newton's method has closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certified {
    /// The least period [cycles].
    pub period: u64,
    /// Its point of the section.
    pub section: Section,
    /// Its multipliers, the largest magnitude first [-].
    pub multipliers: [Complex; 3],
    /// Cycles followed to find it.
    pub cycles: u64,
}

/// The periodic orbit at `section`, which has been seen to repeat after so many cycles; none where the
/// return map does not close there.
///
/// Method: for each divisor of the cycles, the least first, Newton's method on the map over so many. An
/// orbit of a divisor counts if it is stable: the motion then tends to it and has only seemed to have a
/// longer period, as it does when a multiplier lies near -1. If it repels, the motion goes around it, as it
/// does after a period doubling, and the longer period is proven by the shorter one. What repeats without
/// divisor may repel, if the motion began on it to rounding; its multipliers say so. An orbit counts only
/// as near to the section as recurrence and multipliers foretell. `size` is that of the motion [m/s].
pub fn certify<S: Locomotion>(
    case: &Case,
    section: &Section,
    repeats_after: u64,
    size: f64,
    protocol: &Protocol,
) -> Option<Certified> {
    let parameters = &case.parameters;
    let constant = |parameter: Parameter| Dual::<f64, 3>::constant(parameters[parameter]);
    let system = S::with(constant, parameters.resistance, case.phase);
    let mut cycles = Cycles {
        drive_period: Dual::constant(parameters.drive_period()),
        count: 0,
        tolerance: protocol.tolerance,
    };
    let mut followed = 0;
    for period in (1..=repeats_after).filter(|&j| repeats_after.is_multiple_of(j)) {
        cycles.count = period;
        // What cannot be followed cannot be closed either.
        let Ok(Some(Closed { point, residual, jacobian, moved, cycles, .. })) =
            close(&system, section, &cycles, size)
        else {
            continue;
        };
        followed += cycles;
        let multipliers = eigenvalues(&jacobian);
        let attracts = multipliers[0].abs() < 1.0;
        let slowest =
            if attracts { 1.0 - multipliers[0].abs() } else { least_from_one(&multipliers) };
        let is_near = moved * slowest <= OBLIQUE * protocol.recurrence;
        let closes = residual <= protocol.recurrence && is_near;
        if closes && (attracts || period == repeats_after) {
            return Some(Certified { period, section: point, multipliers, cycles: followed });
        }
    }
    None
}
