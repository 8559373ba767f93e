//! What is proven of a periodic orbit: that it closes, how it answers to small pushes, and that its period
//! is the least.

use crate::capsule::{Locomotion, Parameter};
use crate::lane::Dual;

use super::matrix::{Complex, eigenvalues};
use super::neutral::{Neutral, close_neutral, may_be_neutral};
use super::newton::{Closed, close};
use super::recurrence::Settled;
use super::return_map::Cycles;
use super::{Case, Protocol, Section};

/// How much farther an orbit may be than a residual and multipliers say, as they do not tell how oblique
/// the directions are that the multipliers belong to.
pub const OBLIQUE: f64 = 100.0;

/// How far two integrations of one orbit may differ at this tolerance, relative to the motion; where they
/// differ by more, one of them is wrong.
///
/// Steps with derivatives are shorter than those without. Of 13 000 random orbits at 1e-12 one differed by
/// 1.5e-8, after some sixty events a cycle, and all others by less than 4e-9.
pub fn same(tolerance: f64) -> f64 {
    let usual = 1e5 * tolerance.max(1e-14);
    usual.min((1e2 * tolerance).max(1e-3))
}

/// An orbit closes if its residual is below so many recurrence tolerances: that of a cycle of hundreds of
/// events is rounding of ten of them.
const CLOSES: f64 = 10.0;

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
    /// The orbit closes, and so do its neighbours on both sides along a direction whose multiplier is within
    /// 1e-7 of one: as far as rounding tells it belongs to a family of orbits, of which the start decides the
    /// member. A resistance so small that it slows the capsule by less than that in a period is not told
    /// from none.
    Neutral,
}

impl Proof {
    /// Every proof by its name in files, in the order of declaration.
    pub const NAMES: [(&str, Proof); 4] = [
        ("none", Proof::None),
        ("newton", Proof::Newton),
        ("grazing", Proof::Grazing),
        ("neutral", Proof::Neutral),
    ];
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
    ///
    /// Of an orbit that is at rest on the ground at the section one of them is 0. It is that of pushes along
    /// y2 as far as they end on the stick surface y2 = 0, |F| <= f_b again; where |F| is above the friction
    /// of sliding, f_d(0+) < |F| <= f_b, a push off the surface, however small, makes the capsule slide away.
    pub multipliers: [Complex; 3],
    /// The direction (r, y1, y2) of the family that a neutral orbit belongs to, of length one with r counted
    /// as omega r [-]; none of any other.
    pub neutral: Option<Section>,
}

impl Certificate {
    /// Nothing is proven.
    pub fn none() -> Self {
        let unknown = Complex { re: f64::NAN, im: f64::NAN };
        let multipliers = [unknown; 3];
        Certificate { proof: Proof::None, residual: f64::NAN, multipliers, neutral: None }
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
    /// The direction of the family that it belongs to, if it does.
    pub neutral: Option<Section>,
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
pub fn certify<S: Locomotion>(
    case: &Case,
    section: &Section,
    settled: &Settled,
    protocol: &Protocol,
) -> Option<Certified> {
    let parameters = &case.parameters;
    let constant = |parameter: Parameter| Dual::<f64, 3>::constant(parameters[parameter]);
    let system = S::with(constant, parameters.resistance, case.section_phase);
    let repeats_after = settled.repeats_after as u64;
    let mut cycles = Cycles {
        drive_period: Dual::constant(parameters.drive_period()),
        count: 0,
        tolerance: protocol.tolerance,
    };
    let mut followed = 0;
    for period in (1..=repeats_after).filter(|&j| repeats_after.is_multiple_of(j)) {
        cycles.count = period;
        // What cannot be followed cannot be closed either.
        let Ok(closed) = close(&system, section, &cycles, settled.size) else { continue };
        let multipliers = closed.map(|it| eigenvalues(&it.jacobian));
        followed += closed.map_or(0, |it| it.cycles);
        let found = match (closed, multipliers) {
            (Some(closed), Some(multipliers)) if !may_be_neutral(&multipliers) => {
                Found::isolated(&closed, multipliers)
            }
            // A singular matrix has left Newton's method without a step.
            _ => {
                let accuracy = (settled.size, CLOSES * protocol.recurrence);
                let Ok(Some(it)) = close_neutral(&system, section, &cycles, accuracy) else {
                    continue;
                };
                followed += it.cycles;
                let multipliers = with_one(eigenvalues(&it.jacobian));
                let neutral = Some(it.direction);
                let Neutral { point, residual, moved, first_residual, .. } = it;
                Found { point, residual, moved, first_residual, multipliers, neutral }
            }
        };
        let within = settled
            .within
            .max(protocol.recurrence)
            .max(found.first_residual.min(same(protocol.tolerance)));
        let is_near = found.moved * found.slowest() <= OBLIQUE * within;
        let closes = found.residual <= CLOSES * protocol.recurrence && is_near;
        // What is on the way to an orbit only, and not there to rounding, does not stay near one that repels.
        let stays = period == repeats_after && settled.within <= protocol.recurrence;
        if closes && (found.attracts() || stays) {
            let Found { point: section, multipliers, neutral, .. } = found;
            return Some(Certified { period, section, multipliers, neutral, cycles: followed });
        }
    }
    None
}

/// An orbit that closes, isolated or of a family.
struct Found {
    point: Section,
    residual: f64,
    moved: f64,
    first_residual: f64,
    multipliers: [Complex; 3],
    neutral: Option<Section>,
}

impl Found {
    fn isolated(closed: &Closed<3>, multipliers: [Complex; 3]) -> Found {
        let Closed { point, residual, moved, first_residual, .. } = *closed;
        Found { point, residual, moved, first_residual, multipliers, neutral: None }
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
fn with_one(mut multipliers: [Complex; 3]) -> [Complex; 3] {
    let from_one = |it: &Complex| libm::hypot(1.0 - it.re, it.im);
    let nearest =
        (0..3).min_by(|&i, &j| from_one(&multipliers[i]).total_cmp(&from_one(&multipliers[j])));
    if let Some(nearest) = nearest {
        multipliers[nearest] = Complex { re: 1.0, im: 0.0 };
    }
    multipliers.sort_by(|a, b| b.abs().total_cmp(&a.abs()));
    multipliers
}
