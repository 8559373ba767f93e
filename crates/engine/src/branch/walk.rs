//! The way of an orbit from one value of a parameter to another, and where its attractor goes on.

use super::arclength::{Plane, between, corrected, dot, moved, norm, tangent};
use super::doubling::doubled;
use super::grazing::grazed;
use super::half_branch::HalfBranch;
use super::limited::Limited;
use super::orbits::{OrbitPoint, Orbits, SpecialOrbit};
use super::periodic::{Goal, Periodic};
use super::segment::{ONE_VALUE, PeriodicOrbit, Segment, SegmentEnd, SpecialValue};
use super::special::Sought;
use super::step_control::{Bounds, StepControl};
use super::{End, SpecialKind};
use crate::flow::System;

/// Where events change without a grazing, the place is known to this share of a step.
pub const COARSE: f64 = 1e-6;
/// The longest step, in units of the way: where section and parameter change alike it is the whole way.
const WHOLE: f64 = 1.5;
/// An easy step is followed by one longer by this factor: most orbits change little over the whole way.
const LENGTHEN: f64 = 4.0;
/// A section that moves less over the way, relative to the motion, counts as if it moved so far.
pub const LEAST_MOVE: f64 = 1e-4;
/// A fold and a period doubling nearer than this share of the way are one.
const SAME: f64 = 1e-6;
/// An unstable orbit is not worth steps shorter than this share of the distance.
const SHORTEST: f64 = 1e-3;
/// Beyond a merger the shorter orbit is begun by this share of the distance on, where its stability is not rounding.
const BEYOND: f64 = 1e-6;

/// A special point with the section points of the engine.
type SpecialAt<const D: usize> = SpecialValue<[f64; D]>;

/// Where an attractor goes on that an orbit has ceased to be.
pub enum Onward<'a, M: System<D>, const D: usize, const U: usize> {
    /// With the orbit of twice the period, from this doubling on.
    Doubled(OrbitPoint<M::Event, D, U>),
    /// With the orbit of half the period, on this way, from its doubling on.
    Merged(Walk<'a, M, D, U>, OrbitPoint<M::Event, D, U>),
}

impl<'a, M: System<D>, const D: usize, const U: usize> Onward<'a, M, D, U> {
    /// The way of that orbit, with the first one; none where no such orbit is found.
    pub fn begin(self, before: &Walk<'a, M, D, U>) -> Option<Begun<'a, M, D, U>> {
        let ahead = (before.to - before.from).signum();
        let (walk, start) = match self {
            Onward::Doubled(at) => {
                let (orbits, [at, first]) = doubled(&before.orbits, &at)?;
                let sign = dot(&first.tangent, &between(&at.at, &first.at)).signum();
                let tangent = first.tangent.map(|part| sign * part);
                (Walk { orbits, ..*before }, OrbitPoint { tangent, ..first })
            }
            Onward::Merged(walk, at) => {
                let by = walk.in_units(BEYOND * (walk.to - walk.from));
                let guess = moved(&at.at, by / at.tangent[D], &at.tangent);
                let mut toward = [0.0; U];
                toward[D] = ahead;
                let plane = Plane::fixing(D, guess[D]);
                let (start, _) = corrected(&walk.orbits, &plane, &guess, &toward)?;
                (walk, start)
            }
        };
        let is_stable = start.seen.is_stable() && start.tangent[D] * ahead > 0.0;
        Some(Begun { walk, start, is_stable })
    }
}

/// A way with its first orbit.
pub struct Begun<'a, M: System<D>, const D: usize, const U: usize> {
    /// The way.
    pub walk: Walk<'a, M, D, U>,
    /// The orbit.
    pub start: OrbitPoint<M::Event, D, U>,
    /// Whether it is stable, and lies ahead.
    pub is_stable: bool,
}

/// The segment of an orbit, and where the attractor goes on that it has ceased to be.
pub type Followed<'a, M, const D: usize, const U: usize> =
    (Segment<[f64; D]>, Option<Onward<'a, M, D, U>>);

/// The way from one value of the parameter to another.
#[derive(Clone)]
pub struct Walk<'a, M: System<D>, const D: usize, const U: usize> {
    /// The orbits.
    pub orbits: Orbits<'a, M, D, U>,
    /// The value at which it begins.
    pub from: f64,
    /// The value to which it leads.
    pub to: f64,
    /// Which special orbits are located while the orbit is stable.
    pub sought: Sought,
    /// What follows the orbits.
    pub limited: &'a Limited<'a, M, D>,
}

impl<'a, M: System<D>, const D: usize, const U: usize> Walk<'a, M, D, U> {
    /// The value of the parameter in its unit on the way.
    fn in_units(&self, value: f64) -> f64 {
        value / self.orbits.units[D]
    }

    /// The orbit near a section point at the value where the way begins, with its tangent ahead.
    pub fn start(&self, section: &[f64; D]) -> Option<OrbitPoint<M::Event, D, U>> {
        let mut ahead = [0.0; U];
        ahead[D] = (self.to - self.from).signum();
        let guess = self.orbits.unknowns(section, self.from);
        let plane = Plane::fixing(D, guess[D]);
        let (start, _) = corrected(&self.orbits, &plane, &guess, &ahead)?;
        let tangent = tangent(start.rows, &ahead)?;
        Some(OrbitPoint { tangent, ..start })
    }

    /// The segment from its first orbit on; lost where the integrator is spent.
    pub fn segment(&self, start: OrbitPoint<M::Event, D, U>) -> Followed<'a, M, D, U> {
        let mut stretch = Stretch::new(self, start);
        loop {
            let known = stretch.special.len();
            let end = stretch.advance(self);
            if self.limited.is_spent() {
                stretch.special.truncate(known);
                return (Segment { special: stretch.special, end: SegmentEnd::Lost }, None);
            }
            if let Some(end) = end {
                return (Segment { special: stretch.special, end }, stretch.onward);
            }
        }
    }

    /// Steps that begin with the whole way.
    fn control(&self) -> StepControl<U> {
        let [low, high] = [self.from.min(self.to), self.from.max(self.to)];
        let bounds = Bounds::none().with(D, [low, high].map(|end| self.in_units(end)));
        let longest = WHOLE * self.in_units(high - low);
        let new = StepControl::new(bounds, longest);
        StepControl { next: longest, lengthen: LENGTHEN, ..new }
    }

    /// The orbit at the end of the way.
    fn reached(&self, last: &OrbitPoint<M::Event, D, U>) -> PeriodicOrbit<[f64; D]> {
        let points = self.orbits.section_points(&last.at);
        PeriodicOrbit {
            value: self.to,
            points: points.iter().map(|at| self.orbits.section(at)).collect(),
            multipliers: last.seen.multipliers().to_vec(),
            residual: self.orbits.displacement(&last.at).map_or(f64::NAN, |apart| norm(&apart)),
        }
    }

    /// The period doubling at which an orbit, from which no step leads on, merges with one of half its period, and where that
    /// goes on, as far as they are found; none where there is no such orbit.
    fn merged(
        &self,
        last: &OrbitPoint<M::Event, D, U>,
    ) -> Option<(Option<SpecialAt<D>>, Option<Onward<'a, M, D, U>>)> {
        let (shorter, start) = self.half_period(last)?;
        let doubling = shorter.doubling(start);
        let value = doubling.as_ref().map(|it| shorter.special_value(it));
        Some((value, doubling.map(|it| Onward::Merged(shorter, it.point))))
    }

    /// The special point of an orbit at which the return map is discontinuous, within so much of the way.
    fn discontinuity(&self, at: &OrbitPoint<M::Event, D, U>, within: f64) -> SpecialAt<D> {
        let (kind, point, uncertainty) = match grazed(&self.orbits, at) {
            Some(point) => (SpecialKind::Grazing, point, ONE_VALUE),
            None => (SpecialKind::EventSequence, at.clone(), within),
        };
        let distance = norm(&between(&at.at, &point.at));
        let special = SpecialOrbit { kind, distance, uncertainty, point, is_stable_beyond: false };
        self.special_value(&special)
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
        Some((Walk { orbits, ..*self }, OrbitPoint { tangent, ..met }))
    }

    /// The period doubling at which an orbit seems to fold, if it does, and where the shorter orbit goes on: beyond it are the
    /// same orbits, half a period later.
    fn doubling_at(
        &self,
        fold: &SpecialOrbit<M::Event, D, U>,
        value: &SpecialAt<D>,
    ) -> Option<(SpecialAt<D>, Onward<'a, M, D, U>)> {
        let (doubling, onward) = self.merged(&fold.point)?;
        let (doubling, onward) = (doubling?, onward?);
        let near = SAME * (self.to - self.from).abs();
        ((doubling.value - value.value).abs() <= near).then_some((doubling, onward))
    }

    /// The first period doubling from an orbit on.
    fn doubling(&self, start: OrbitPoint<M::Event, D, U>) -> Option<SpecialOrbit<M::Event, D, U>> {
        let mut control = self.control();
        let mut half = HalfBranch::new(vec![start]).coarse(self.sought);
        while !self.limited.is_spent() {
            let end = half.advance(&self.orbits, &mut control, &Goal::none());
            let mut special = half.special_orbits.iter();
            let doubling = special.find(|(_, it)| it.kind == SpecialKind::PeriodDoubling);
            if let Some((_, orbit)) = doubling {
                return Some(orbit.clone());
            }
            if end.is_some() {
                return None;
            }
        }
        None
    }

    /// A special orbit by the value of its parameter.
    fn special_value(&self, orbit: &SpecialOrbit<M::Event, D, U>) -> SpecialAt<D> {
        let SpecialOrbit { kind, uncertainty, point, is_stable_beyond, .. } = orbit;
        let Walk { orbits, from, to, .. } = self;
        let (value, period) = (orbits.parameter(&point.at), orbits.family.period);
        let along = uncertainty * point.tangent[D].abs() * orbits.units[D];
        let rounding = ONE_VALUE * period as f64 * value.abs().max((to - from).abs());
        SpecialValue {
            kind: *kind,
            value,
            uncertainty: along + rounding,
            period,
            section: orbits.section(&point.at),
            is_stable_beyond: *is_stable_beyond,
        }
    }
}

/// A segment as far as it has come.
struct Stretch<'a, M: System<D>, const D: usize, const U: usize> {
    half: HalfBranch<M::Event, D, U>,
    control: StepControl<U>,
    /// The sign of the parameter in the tangent that leads to the other value.
    ahead: f64,
    /// Whether all its orbits are stable.
    is_stable: bool,
    special: Vec<SpecialAt<D>>,
    /// From the period doubling on at which the orbit has ceased to be stable, say.
    onward: Option<Onward<'a, M, D, U>>,
}

impl<'a, M: System<D>, const D: usize, const U: usize> Stretch<'a, M, D, U> {
    fn new(walk: &Walk<'a, M, D, U>, start: OrbitPoint<M::Event, D, U>) -> Self {
        let (ahead, is_stable) = (start.tangent[D].signum(), start.seen.is_stable());
        let half = HalfBranch::new(vec![start]).coarse(walk.sought);
        let (control, special, onward) = (walk.control(), Vec::new(), None);
        Stretch { half, control, ahead, is_stable, special, onward }
    }

    /// Adds the next orbit, and says how the segment ends if it does.
    fn advance(&mut self, walk: &Walk<'a, M, D, U>) -> Option<SegmentEnd<[f64; D]>> {
        if !self.is_stable {
            self.control.shortest = SHORTEST;
            // Of an unstable orbit only the end of its branch matters.
            self.half.sought = Sought::Folds;
        }
        let known = self.half.special_orbits.len();
        let end = self.half.advance(&walk.orbits, &mut self.control, &Goal::none());
        let found = self.half.special_orbits[known..].to_vec();
        if let Some(end) = found.iter().find_map(|(_, orbit)| self.passes(walk, orbit)) {
            return Some(end);
        }
        let Some(last) = self.half.points.last() else { return Some(SegmentEnd::Lost) };
        if last.tangent[D] * self.ahead <= 0.0 {
            return Some(if found.is_empty() { self.turns(walk) } else { SegmentEnd::Ended });
        }
        self.is_stable &= last.seen.is_stable();
        match end? {
            End::Bound => {
                let reached = walk.reached(last);
                self.onward = self.onward.take().filter(|_| !reached.is_stable());
                Some(SegmentEnd::Reached(reached))
            }
            _ => {
                let last = last.clone();
                Some(self.merges(walk, &last).unwrap_or_else(|| self.stops(walk, &last)))
            }
        }
    }

    /// Notes a special orbit on the way, and says whether the segment ends there.
    fn passes(
        &mut self,
        walk: &Walk<'a, M, D, U>,
        orbit: &SpecialOrbit<M::Event, D, U>,
    ) -> Option<SegmentEnd<[f64; D]>> {
        let value = walk.special_value(orbit);
        if orbit.kind == SpecialKind::Fold {
            let Some((doubling, merged)) = walk.doubling_at(orbit, &value) else {
                self.special.push(value);
                return Some(SegmentEnd::Ended);
            };
            self.special.push(doubling);
            self.onward = Some(merged);
            return Some(SegmentEnd::Merged);
        }
        if self.is_stable {
            self.special.push(value);
            if orbit.kind == SpecialKind::PeriodDoubling {
                self.onward = Some(Onward::Doubled(orbit.point.clone()));
            }
        }
        self.is_stable &= orbit.is_stable_beyond;
        None
    }

    /// How it ends where it turns back without a fold: at a merger, or where derivatives jump.
    fn turns(&mut self, walk: &Walk<'a, M, D, U>) -> SegmentEnd<[f64; D]> {
        let [.., before, last] = &self.half.points[..] else { return SegmentEnd::Lost };
        let (before, step) = (before.clone(), norm(&between(&before.at, &last.at)));
        if let Some(end) = self.merges(walk, &before) {
            return end;
        }
        if self.is_stable {
            self.special.push(walk.discontinuity(&before, step));
        }
        SegmentEnd::Ended
    }

    /// How it ends where no step leads on.
    fn stops(
        &mut self,
        walk: &Walk<'a, M, D, U>,
        last: &OrbitPoint<M::Event, D, U>,
    ) -> SegmentEnd<[f64; D]> {
        if !self.is_stable {
            return SegmentEnd::Lost;
        }
        let StepControl { shortest, longest, .. } = walk.control();
        // The last step that failed is shorter than two of the shortest.
        self.special.push(walk.discontinuity(last, 2.0 * shortest * longest));
        SegmentEnd::Ended
    }

    /// Whether it ends in an orbit of half its period.
    fn merges(
        &mut self,
        walk: &Walk<'a, M, D, U>,
        last: &OrbitPoint<M::Event, D, U>,
    ) -> Option<SegmentEnd<[f64; D]>> {
        let (doubling, merged) = walk.merged(last)?;
        self.special.extend(doubling);
        self.onward = self.onward.take().or(merged);
        Some(SegmentEnd::Merged)
    }
}
