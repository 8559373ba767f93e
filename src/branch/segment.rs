//! A segment of a branch: a periodic orbit from one value of a parameter to another.

use crate::flow::{Metric, System};
use crate::orbit::matrix::Complex;
use crate::orbit::passage::Integrator;

use super::arclength::{Plane, ROUNDING, between, corrected, norm, tangent};
use super::family::Family;
use super::grazing::grazed;
use super::half_branch::HalfBranch;
use super::orbits::{OrbitPoint, Orbits, SpecialOrbit};
use super::periodic::{Goal, Periodic};
use super::scales::units;
use super::special::Sought;
use super::step_control::{Bounds, StepControl};
use super::{End, SpecialKind};

/// Values of the parameter closer together than this, relative to them and for each cycle of the period, are one
/// value: each cycle adds its rounding to the orbit's.
pub const ONE_VALUE: f64 = 2e-13;
/// Where events change without a grazing, the place is known to this share of a step.
const COARSE: f64 = 1e-6;
/// Cycles of the orbits of a segment at most: where a long orbit ends is not worth more.
const CYCLES: u64 = 800;
/// The longest step, in units of the way: where section and parameter change alike it is the whole way.
const WHOLE: f64 = 1.5;
/// An easy step is followed by one longer by this factor: most orbits change little over the whole way.
const LENGTHEN: f64 = 4.0;
/// Orbits of a segment at most, and at most where the orbit is long.
const MOST_AND_FEW: [u64; 2] = [200, 16];
/// A section that moves less over the way, relative to the motion, counts as if it moved so far.
pub(super) const LEAST_MOVE: f64 = 1e-4;
/// A fold and a period doubling nearer than this share of the way are one.
const SAME: f64 = 1e-6;
/// An unstable orbit is not worth steps shorter than this share of the distance.
const SHORTEST: f64 = 1e-3;

/// What is held while one parameter varies.
#[derive(Debug, Clone)]
pub struct Along<M: System<D>, const D: usize> {
    /// The system with the values of the other parameters.
    pub system: M,
    /// The parameter that varies.
    pub parameter: M::Parameter,
    /// Relative local error of a step of the integrator.
    pub tolerance: f64,
}

impl<M: System<D>, const D: usize> Along<M, D> {
    /// How far two section points are apart at a value of the parameter.
    pub fn metric(&self, value: f64) -> Metric<D> {
        self.system.with(self.parameter, value).metric()
    }
}

/// A periodic orbit at a value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicOrbit<const D: usize> {
    /// The value.
    pub value: f64,
    /// Its section points, one for each cycle of its period.
    pub points: Vec<[f64; D]>,
    /// Floquet multipliers of the period, the largest magnitude first.
    pub multipliers: [Complex; D],
    /// How far the section is from repeating, relative to the motion [-].
    pub residual: f64,
}

impl<const D: usize> PeriodicOrbit<D> {
    /// Whether small perturbations decay.
    pub fn is_stable(&self) -> bool {
        self.multipliers[0].abs() < 1.0
    }
}

/// A special point between two values of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecialValue<const D: usize> {
    /// What happens.
    pub kind: SpecialKind,
    /// The value of the parameter.
    pub value: f64,
    /// How far the true value may be.
    pub uncertainty: f64,
    /// Period of the orbit [cycles].
    pub period: u64,
    /// Its section point.
    pub section: [f64; D],
    /// Whether the branch goes on with stable orbits.
    pub is_stable_beyond: bool,
}

/// How a segment ends.
#[derive(Debug, Clone, PartialEq)]
pub enum SegmentEnd<const D: usize> {
    /// At the other value, with this orbit.
    Reached(PeriodicOrbit<D>),
    /// Before: the branch turns back, or has a corner.
    Ended,
    /// Before: it runs into an orbit of half its period, which continues it.
    Merged,
    /// Before, and it is not known why: the steps became too many, or too short for an unstable orbit.
    Lost,
}

/// A segment of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment<const D: usize> {
    /// The special points up to the one at which the orbit ceases to be stable, or at which the branch ends.
    pub special: Vec<SpecialValue<D>>,
    /// How it ends.
    pub end: SegmentEnd<D>,
}

/// The segment of a branch from a periodic orbit, given by the value of the parameter there and its section
/// points, to another value; none where the orbit does not close.
///
/// Method: pseudo-arclength continuation as in [`follow`](super::follow()), which tells a fold from an orbit that
/// cannot be followed, with the distance of the two values as unit of the parameter. It goes on past the loss of
/// stability, as the orbit at the other value may be that of a neighbouring segment. Two special points of one kind
/// that undo each other between two orbits of the segment are not seen, such as two folds very near each other.
pub fn segment<M: System<D>, const D: usize>(
    integrator: &dyn Integrator<M, D>,
    along: &Along<M, D>,
    from: (f64, &[[f64; D]]),
    to: f64,
) -> Option<Segment<D>> {
    match const { D } {
        1 => segment_with::<M, D, 2>(integrator, along, from, to),
        2 => segment_with::<M, D, 3>(integrator, along, from, to),
        3 => segment_with::<M, D, 4>(integrator, along, from, to),
        4 => segment_with::<M, D, 5>(integrator, along, from, to),
        5 => segment_with::<M, D, 6>(integrator, along, from, to),
        6 => segment_with::<M, D, 7>(integrator, along, from, to),
        _ => panic!("a section has one to six coordinates, not {D}"),
    }
}

fn segment_with<M: System<D>, const D: usize, const U: usize>(
    integrator: &dyn Integrator<M, D>,
    along: &Along<M, D>,
    (from, points): (f64, &[[f64; D]]),
    to: f64,
) -> Option<Segment<D>> {
    let Along { system, parameter, tolerance } = along;
    let family =
        Family { system: system.clone(), period: points.len() as u64, tolerance: *tolerance };
    let range = [from.min(to), from.max(to)];
    let width = range[1] - range[0];
    let section = units(system, (*parameter, range), points);
    let units: [f64; U] = std::array::from_fn(|i| *section.get(i).unwrap_or(&width));
    let along = *parameter;
    let orbits = Orbits { family, integrator, along, units, oriented: true, exact: ROUNDING };
    let mut walk = Walk { orbits, from, to };
    let section = points.first()?;
    let start = walk.start(section)?;
    // Section and parameter count alike, or a fold is a bend too sharp for steps of the parameter's length.
    let moves = norm(&start.tangent.map(|part| part / start.tangent[D])).powi(2) - 1.0;
    walk.orbits.units[D] = width / moves.sqrt().clamp(LEAST_MOVE, 1.0);
    let start = walk.start(section)?;
    Some(walk.segment(start))
}

/// The way from one value of the parameter to another.
struct Walk<'a, M: System<D>, const D: usize, const U: usize> {
    orbits: Orbits<'a, M, D, U>,
    from: f64,
    to: f64,
}

impl<M: System<D>, const D: usize, const U: usize> Walk<'_, M, D, U> {
    /// The value of the parameter in its unit on the way.
    fn in_units(&self, value: f64) -> f64 {
        value / self.orbits.units[D]
    }

    /// The orbit near a section point at the value where the way begins, with its tangent ahead.
    fn start(&self, section: &[f64; D]) -> Option<OrbitPoint<M::Event, D, U>> {
        let mut ahead = [0.0; U];
        ahead[D] = (self.to - self.from).signum();
        let guess = self.orbits.unknowns(section, self.from);
        let plane = Plane::fixing(D, guess[D]);
        let (start, _) = corrected(&self.orbits, &plane, &guess, &ahead)?;
        let tangent = tangent(start.rows, &ahead)?;
        Some(OrbitPoint { tangent, ..start })
    }

    /// The segment from its first orbit on.
    fn segment(&self, start: OrbitPoint<M::Event, D, U>) -> Segment<D> {
        let mut control = self.control();
        let mut is_stable = start.seen.is_stable();
        let ahead = start.tangent[D].signum();
        let mut half = HalfBranch::new(vec![start]).coarse(COARSE);
        let mut special = Vec::new();
        loop {
            if !is_stable {
                control.shortest = SHORTEST;
                // Of an unstable orbit only the end of its branch matters.
                half.sought = Sought::Folds;
            }
            let known = half.special_orbits.len();
            let end = half.advance(&self.orbits, &mut control, &Goal::none());
            for (_, orbit) in &half.special_orbits[known..] {
                let value = special_value(&self.orbits, orbit);
                if orbit.kind == SpecialKind::Fold {
                    let doubling = self.doubling_at(orbit, &value);
                    let end =
                        if doubling.is_some() { SegmentEnd::Merged } else { SegmentEnd::Ended };
                    special.push(doubling.unwrap_or(value));
                    return Segment { special, end };
                }
                if is_stable {
                    special.push(value);
                }
                is_stable &= orbit.is_stable_beyond;
            }
            let Some(last) = half.points.last() else { break };
            // Where derivatives jump, a branch may turn back without a fold.
            if last.tangent[D] * ahead <= 0.0 {
                if is_stable && half.special_orbits.len() == known {
                    let before = &half.points[half.points.len().saturating_sub(2)];
                    let step = norm(&between(&before.at, &last.at));
                    special.push(self.discontinuity(before, step));
                }
                return Segment { special, end: SegmentEnd::Ended };
            }
            is_stable &= last.seen.is_stable();
            match end {
                Some(End::Bound) => {
                    return Segment { special, end: SegmentEnd::Reached(self.reached(last)) };
                }
                _ if control.attempts == 0 => break,
                None => {}
                Some(_) => {
                    let (found, end) = self.ended(last, is_stable);
                    special.extend(found);
                    return Segment { special, end };
                }
            }
        }
        Segment { special, end: SegmentEnd::Lost }
    }

    /// Steps that begin with the whole way.
    fn control(&self) -> StepControl<U> {
        let [low, high] = [self.from.min(self.to), self.from.max(self.to)];
        let bounds = Bounds::none().with(D, [low, high].map(|end| self.in_units(end)));
        let longest = WHOLE * self.in_units(high - low);
        let [most, few] = MOST_AND_FEW;
        let attempts = (CYCLES / self.orbits.family.period).clamp(few, most) as usize;
        let new = StepControl::new(bounds, longest);
        StepControl { next: longest, lengthen: LENGTHEN, attempts, ..new }
    }

    /// The orbit at the end of the way.
    fn reached(&self, last: &OrbitPoint<M::Event, D, U>) -> PeriodicOrbit<D> {
        let points = self.orbits.section_points(&last.at);
        PeriodicOrbit {
            value: self.to,
            points: points.iter().map(|at| self.orbits.section(at)).collect(),
            multipliers: last.seen.multipliers(),
            residual: self.orbits.displacement(&last.at).map_or(f64::NAN, |apart| norm(&apart)),
        }
    }

    /// What happens where no step leads on from an orbit, and how the segment ends.
    ///
    /// It is a period doubling if the orbit runs into one of half its period, which then is located on that
    /// shorter orbit; else its events change, at a discontinuity of the return map.
    fn ended(
        &self,
        last: &OrbitPoint<M::Event, D, U>,
        is_stable: bool,
    ) -> (Option<SpecialValue<D>>, SegmentEnd<D>) {
        if let Some((shorter, start)) = self.half_period(last) {
            return (shorter.doubling(start), SegmentEnd::Merged);
        }
        if !is_stable {
            return (None, SegmentEnd::Lost);
        }
        let StepControl { shortest, longest, .. } = self.control();
        (Some(self.discontinuity(last, shortest * longest)), SegmentEnd::Ended)
    }

    /// The special point of an orbit at which the return map is discontinuous, within so much of the way.
    fn discontinuity(&self, at: &OrbitPoint<M::Event, D, U>, within: f64) -> SpecialValue<D> {
        let (kind, point, uncertainty) = match grazed(&self.orbits, at) {
            Some(point) => (SpecialKind::Grazing, point, ONE_VALUE),
            None => (SpecialKind::EventSequence, at.clone(), within),
        };
        let distance = norm(&between(&at.at, &point.at));
        let special = SpecialOrbit { kind, distance, uncertainty, point, is_stable_beyond: false };
        special_value(&self.orbits, &special)
    }

    /// The way of the orbit of half the period in the middle of an orbit, if there is one, towards its period
    /// doubling, with the orbit where it begins.
    fn half_period(
        &self,
        last: &OrbitPoint<M::Event, D, U>,
    ) -> Option<(Self, OrbitPoint<M::Event, D, U>)> {
        let apart = self.orbits.halfway(&last.at)?;
        let orbits = self.orbits.with_period(self.orbits.period() / 2);
        let middle =
            std::array::from_fn(|i| last.at[i] + 0.5 * apart.get(i).copied().unwrap_or(0.0));
        let plane = Plane::fixing(D, last.at[D]);
        let (met, _) = corrected(&orbits, &plane, &middle, &last.tangent)?;
        if norm(&between(&middle, &met.at)) >= 0.5 * norm(&apart) {
            return None;
        }
        // The longer orbit exists where the shorter one is unstable. Near the doubling the two are hard to tell
        // apart, so that it may lie before or behind.
        let toward = if met.seen.doubling() < 0.0 { 1.0 } else { -1.0 };
        let mut ahead = [0.0; U];
        ahead[D] = toward * (self.to - self.from).signum();
        let tangent = tangent(met.rows, &ahead)?;
        Some((Walk { orbits, from: self.from, to: self.to }, OrbitPoint { tangent, ..met }))
    }

    /// The period doubling at which an orbit seems to fold, if it does: beyond it are the same orbits, half a period
    /// later.
    fn doubling_at(
        &self,
        fold: &SpecialOrbit<M::Event, D, U>,
        value: &SpecialValue<D>,
    ) -> Option<SpecialValue<D>> {
        let (shorter, start) = self.half_period(&fold.point)?;
        let doubling = shorter.doubling(start)?;
        let near = SAME * (self.to - self.from).abs();
        ((doubling.value - value.value).abs() <= near).then_some(doubling)
    }

    /// The first period doubling from an orbit on.
    fn doubling(&self, start: OrbitPoint<M::Event, D, U>) -> Option<SpecialValue<D>> {
        let mut control = self.control();
        let mut half = HalfBranch::new(vec![start]).coarse(COARSE);
        while control.attempts > 0 {
            let end = half.advance(&self.orbits, &mut control, &Goal::none());
            let mut special = half.special_orbits.iter();
            let doubling = special.find(|(_, it)| it.kind == SpecialKind::PeriodDoubling);
            if let Some((_, orbit)) = doubling {
                return Some(special_value(&self.orbits, orbit));
            }
            if end.is_some() {
                return None;
            }
        }
        None
    }
}

/// A special orbit by the value of its parameter.
fn special_value<M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<M, D, U>,
    orbit: &SpecialOrbit<M::Event, D, U>,
) -> SpecialValue<D> {
    let SpecialOrbit { kind, uncertainty, point, is_stable_beyond, .. } = orbit;
    let value = orbits.parameter(&point.at);
    let along = uncertainty * point.tangent[D].abs() * orbits.units[D];
    SpecialValue {
        kind: *kind,
        value,
        uncertainty: along + ONE_VALUE * orbits.family.period as f64 * value.abs(),
        period: orbits.family.period,
        section: orbits.section(&point.at),
        is_stable_beyond: *is_stable_beyond,
    }
}
