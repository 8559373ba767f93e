//! What is proven of a periodic orbit: that it closes, how it answers to small pushes, and that its period
//! is the least.

use super::Protocol;
use super::matrix::{Complex, Matrix, eigenvalues};
use super::neutral::{Neutral, close_neutral, may_be_neutral};
use super::newton::{Closed, close};
use super::passage::{Integrator, image};
use super::precision::{OBLIQUE, closes, same};
use super::recurrence::Settled;
use super::return_map::Cycles;
use crate::flow::System;

/// How a period was proven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Proof {
    /// It was not.
    None = 0,
    /// Newton's method on the return map ended on an orbit that closes to rounding.
    Newton,
    /// The orbit closes, but just touches a surface, where the derivatives are those of one side.
    Grazing,
    /// The orbit closes, and so do its neighbours on both sides along a direction whose multiplier is within
    /// 1e-7 of one: as far as rounding tells it belongs to a family of orbits, of which the start decides the
    /// member. A damping so small that it slows the motion by less than that in a period is not told from
    /// none.
    Neutral,
    /// The motion entered a neighbourhood that the return map leads into itself, of an orbit that was proven by
    /// Newton's method from another start; what is measured is measured on that orbit.
    Neighbourhood,
}

impl Proof {
    /// Every proof by its name in files, in the order of declaration.
    pub const NAMES: [(&str, Proof); 5] = [
        ("none", Proof::None),
        ("newton", Proof::Newton),
        ("grazing", Proof::Grazing),
        ("neutral", Proof::Neutral),
        ("neighbourhood", Proof::Neighbourhood),
    ];
}

/// What is proven of a periodic orbit.
#[derive(Debug, Clone, PartialEq)]
pub struct Certificate<P> {
    /// How.
    pub proof: Proof,
    /// How far the section is from repeating after a period, relative to the motion [-]; NaN without an
    /// orbit.
    pub residual: f64,
    /// Floquet multipliers of the period, the largest magnitude first [-]; NaN where they are not known.
    ///
    /// Of an orbit that sticks on a surface at the section one of them is 0: that of pushes off the surface,
    /// as far as they end on it again.
    pub multipliers: Vec<Complex>,
    /// The direction of the family that a neutral orbit belongs to, of length one in the units of the metric
    /// [-]; none of any other.
    pub neutral: Option<P>,
}

impl<const D: usize> Certificate<[f64; D]> {
    /// Nothing is proven.
    pub fn none() -> Self {
        let unknown = Complex { re: f64::NAN, im: f64::NAN };
        let multipliers = vec![unknown; D];
        Certificate { proof: Proof::None, residual: f64::NAN, multipliers, neutral: None }
    }
}

impl<P> Certificate<P> {
    /// Whether small pushes die out; not where the multipliers are unknown.
    pub fn is_stable(&self) -> bool {
        self.multipliers[0].abs() < 1.0
    }

    /// The same with section points held in another way.
    pub fn map<Q>(self, held: impl Fn(P) -> Q) -> Certificate<Q> {
        let Certificate { proof, residual, multipliers, neutral } = self;
        Certificate { proof, residual, multipliers, neutral: neutral.map(held) }
    }
}

/// A periodic orbit that Newton's method has closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certified<const D: usize> {
    /// The least period [cycles].
    pub period: u64,
    /// Its point of the section.
    pub section: [f64; D],
    /// Its multipliers, the largest magnitude first [-].
    pub multipliers: [Complex; D],
    /// The derivative of the return map over the period at that point.
    pub jacobian: Matrix<D>,
    /// The direction of the family that it belongs to, if it does.
    pub neutral: Option<[f64; D]>,
    /// Cycles followed to find it.
    pub cycles: u64,
}

/// The periodic orbit at `section`, where the motion has been seen to repeat; none where the return map does
/// not close there.
///
/// Method: for each divisor of the cycles after which it repeats, the least first, Newton's method on the
/// map over so many. An orbit of a divisor counts if it is stable: the motion then tends to it and has only
/// seemed to have a longer period, as it does when a multiplier lies near -1. If it repels, the motion goes
/// around it, as it does after a period doubling, and the longer period is proven by the shorter one. What
/// repeats without divisor may repel, if the motion began on it to rounding; its multipliers say so.
/// An orbit counts only as near to the section as its multipliers foretell from how closely the motion was
/// seen to repeat. That is the recurrence met, or the first residual with derivatives where it is no more
/// than two integrations may differ by. Where a multiplier is one, the orbit counts if it belongs to a
/// family and its other multipliers are stable.
pub fn certify<M: System<D>, const D: usize>(
    system: &M,
    section: &[f64; D],
    settled: &Settled,
    protocol: &Protocol,
    integrator: &dyn Integrator<M, D>,
) -> Option<Certified<D>> {
    let metric = system.metric();
    let repeats_after = settled.repeats_after as u64;
    let mut followed = 0;
    for period in (1..=repeats_after).filter(|&j| repeats_after.is_multiple_of(j)) {
        let cycles = Cycles { count: period, tolerance: protocol.tolerance };
        // What cannot be followed cannot be closed either.
        let image_of = |point: &[f64; D]| image(integrator, system, point, &cycles);
        let Ok(closed) = close(image_of, period, &metric, section, settled.size) else { continue };
        let multipliers = closed.map(|it| eigenvalues(&it.jacobian));
        followed += closed.map_or(0, |it| it.cycles);
        let found = match (closed, multipliers) {
            (Some(closed), Some(multipliers)) if !may_be_neutral(&multipliers) => {
                Found::isolated(&closed, multipliers)
            }
            // A singular matrix has left Newton's method without a step.
            _ => {
                let accuracy = (settled.size, closes(protocol.recurrence));
                let Ok(Some(it)) = close_neutral(image_of, period, &metric, section, accuracy)
                else {
                    continue;
                };
                followed += it.cycles;
                let multipliers = with_one(eigenvalues(&it.jacobian));
                let neutral = Some(it.direction);
                let Neutral { point, residual, moved, first_residual, jacobian, .. } = it;
                Found { point, residual, moved, first_residual, multipliers, jacobian, neutral }
            }
        };
        let within = settled
            .within
            .max(protocol.recurrence)
            .max(found.first_residual.min(same(protocol.tolerance)));
        let is_near = found.moved * found.slowest() <= OBLIQUE * within;
        let closes = found.residual <= closes(protocol.recurrence) && is_near;
        // A motion that only approaches an orbit, and is not on it to rounding, does not stay near one that repels.
        let stays = period == repeats_after && settled.within <= protocol.recurrence;
        if closes && (found.attracts() || stays) {
            let Found { point: section, multipliers, jacobian, neutral, .. } = found;
            let cycles = followed;
            return Some(Certified { period, section, multipliers, jacobian, neutral, cycles });
        }
    }
    None
}

/// An orbit that closes, isolated or of a family.
struct Found<const D: usize> {
    point: [f64; D],
    residual: f64,
    moved: f64,
    first_residual: f64,
    multipliers: [Complex; D],
    jacobian: Matrix<D>,
    neutral: Option<[f64; D]>,
}

impl<const D: usize> Found<D> {
    fn isolated(closed: &Closed<D>, multipliers: [Complex; D]) -> Self {
        let Closed { point, residual, moved, first_residual, jacobian, .. } = *closed;
        Found { point, residual, moved, first_residual, multipliers, jacobian, neutral: None }
    }

    /// The multipliers across the family, or all.
    fn across(&self) -> impl Iterator<Item = &Complex> {
        let one = Complex { re: 1.0, im: 0.0 };
        let neutral = self.neutral.is_some();
        self.multipliers.iter().filter(move |&&it| !(neutral && it == one))
    }

    /// Whether small pushes die out, those along a family apart.
    fn attracts(&self) -> bool {
        self.across().all(|it| it.abs() < 1.0)
    }

    /// The share of a distance that goes in a period along the slowest direction.
    fn slowest(&self) -> f64 {
        let from_one = |it: &Complex| {
            if self.attracts() { 1.0 - it.abs() } else { libm::hypot(1.0 - it.re, it.im) }
        };
        self.across().map(from_one).fold(f64::INFINITY, f64::min)
    }
}

/// The multipliers of an orbit of a family: the one nearest to one is one.
fn with_one<const D: usize>(mut multipliers: [Complex; D]) -> [Complex; D] {
    let from_one = |it: &Complex| libm::hypot(1.0 - it.re, it.im);
    let nearest =
        (0..D).min_by(|&i, &j| from_one(&multipliers[i]).total_cmp(&from_one(&multipliers[j])));
    if let Some(nearest) = nearest {
        multipliers[nearest] = Complex { re: 1.0, im: 0.0 };
    }
    multipliers.sort_by(|a, b| b.abs().total_cmp(&a.abs()));
    multipliers
}
