//! Half of a branch: from an orbit in one direction to where the branch ends.

use crate::flow::{Event, System};

use super::End;
use super::across::{Unknowns, across_section};
use super::arc::NARROW;
use super::arclength::{Equations, Linear, between, norm};
use super::corner::{is_corner, rounded};
use super::grazing::{Passed, past_grazing};
use super::merger::{is_merged, merger};
use super::orbits::{OrbitPoint, Orbits, Seen, SpecialOrbit};
use super::periodic::{Goal, Periodic, passes};
use super::special::{Sought, special_orbits};
use super::step_control::{Advance, StepControl};
use super::whole_step::{
    Flaw, JUMP, jumps_over, special_orbits_of_shortest, special_orbits_of_whole,
};

/// Corners that are passed on half of a branch at most.
const CORNERS: usize = 40;
/// So many steps before a corner are looked at for whether a branch turns back onto itself there.
const RETRACED: usize = 40;
/// Orbits closer together than this are one.
const ONE: f64 = 1e-12;
/// A branch merges with the one it left at a doubling that lies no farther from its end.
const MERGES: f64 = 1e-4;
/// A step that does not add up is halved down to this share of the longest, and on a coarse branch to this.
const LEAST: f64 = 1e-6;
const LEAST_OF_COARSE: f64 = 1e-3;

/// A step over a small jump of the return map, which shorter steps end at.
const LEAP: f64 = 10.0 * JUMP;

/// How a branch goes on where no step along its tangent leads on.
enum Onward<E, const D: usize, const U: usize> {
    /// Its next orbit is added already; why it ends there, if it does.
    Leaps(Option<End>),
    /// From the last orbit in another direction.
    Turns(OrbitPoint<E, D, U>, Advance<OrbitPoint<E, D, U>>),
}

/// A stretch of a branch.
#[derive(Debug, Clone)]
pub struct HalfBranch<E, const D: usize, const U: usize> {
    /// Its orbits in order, that at the beginning included.
    pub points: Vec<OrbitPoint<E, D, U>>,
    /// What happens, each between the orbit with this index and the next.
    pub special_orbits: Vec<(usize, SpecialOrbit<E, D, U>)>,
    /// Why it ends.
    pub end: End,
    /// Which of the doublings it ends at.
    pub merged: Option<usize>,
    /// Corners that may still be passed.
    corners: usize,
    /// Which special orbits are located.
    pub sought: Sought,
    /// A step that does not add up is halved down to this share of the longest.
    least: f64,
}

impl<E: Event, const D: usize, const U: usize> HalfBranch<E, D, U> {
    /// A half branch that begins with these orbits.
    pub fn new(points: Vec<OrbitPoint<E, D, U>>) -> Self {
        let (special_orbits, end) = (Vec::new(), End::MostPoints);
        let (merged, sought) = (None, Sought::Every(NARROW));
        HalfBranch { points, special_orbits, end, merged, corners: CORNERS, sought, least: LEAST }
    }

    /// The same without a look round corners, where these special orbits are located. Where steps have to add up they are halved
    /// less: where events change too often to be told one by one, the branch matters, and not each change.
    pub fn coarse(self, sought: Sought) -> Self {
        let least = if matches!(sought, Sought::Every(_)) { LEAST_OF_COARSE } else { LEAST };
        HalfBranch { corners: 0, sought, least, ..self }
    }

    /// Whether it ends before a merger, whose place then is not located.
    fn is_coarse(&self) -> bool {
        self.sought != Sought::Every(NARROW)
    }

    /// Follows the branch on until it ends, closes at `goal` or has `most` orbits.
    ///
    /// It ends at a bound, where it merges with a branch of half its period, and where no step leads on: at a
    /// discontinuity of the return map, say.
    pub fn follow<M: System<D, Event = E>>(
        &mut self,
        orbits: &Orbits<M, D, U>,
        control: &mut StepControl<U>,
        most: usize,
        goal: &Goal<U, Seen<E, D, U>>,
    ) {
        while self.points.len() < most {
            if let Some(end) = self.advance(orbits, control, goal) {
                self.end = end;
                return;
            }
        }
    }

    /// Adds the next orbit, and says why the branch ends if it does.
    pub fn advance<M: System<D, Event = E>>(
        &mut self,
        orbits: &Orbits<M, D, U>,
        control: &mut StepControl<U>,
        goal: &Goal<U, Seen<E, D, U>>,
    ) -> Option<End> {
        let last = self.points.last()?.clone();
        let (from, advance) = match control.advance(orbits, &last) {
            Advance::Nowhere if self.corners > 0 => match self.around(orbits, control, &last) {
                Some(Onward::Leaps(end)) => return end,
                Some(Onward::Turns(from, advance)) => (from, advance),
                None => (last.clone(), Advance::Nowhere),
            },
            advance => (last.clone(), advance),
        };
        match advance {
            Advance::Inside(next) => match self.add(orbits, control, &from, next, goal) {
                Added::Halved | Added::GoesOn => None,
                Added::Ends(end) => Some(end),
            },
            Advance::AtBound(next) => match self.add(orbits, control, &from, next, goal) {
                Added::Halved => None,
                Added::GoesOn | Added::Ends(End::Stopped) => Some(End::Bound),
                Added::Ends(end) => Some(end),
            },
            Advance::Nowhere if last.seen.is_smallest() => Some(End::Equilibrium),
            Advance::Nowhere if orbits.takes_longest(&last) => Some(End::LongestWait),
            Advance::Nowhere if is_corner(orbits, &last) => Some(End::Corner),
            Advance::Nowhere => Some(End::Stopped),
        }
    }

    /// How the branch goes on where no step leads on: the return map may jump by little, the section point jump, the branch turn
    /// at a corner, or pass a rigid grazing.
    fn around<M: System<D, Event = E>>(
        &mut self,
        orbits: &Orbits<M, D, U>,
        control: &StepControl<U>,
        last: &OrbitPoint<E, D, U>,
    ) -> Option<Onward<E, D, U>> {
        self.corners -= 1;
        let leap = control.attempt(orbits, last, LEAP).map(|(advance, _)| advance);
        if let Some(advance @ (Advance::Inside(next) | Advance::AtBound(next))) = &leap
            && special_orbits_of_whole(orbits, last, next, NARROW).is_ok()
        {
            return Some(Onward::Turns(last.clone(), advance.clone()));
        }
        let (family, units) = (&orbits.family, &orbits.units);
        let free = std::slice::from_ref(&orbits.along);
        match across_section(orbits, &Unknowns { family, units, free }, control, last) {
            Some(Advance::Inside(next)) => {
                self.points.push(next);
                return Some(Onward::Leaps(None));
            }
            Some(Advance::AtBound(next)) => {
                self.points.push(next);
                return Some(Onward::Leaps(Some(End::Bound)));
            }
            _ => {}
        }
        if let Some((from, advance)) = rounded(orbits, control, last)
            && !self.retraces(orbits, &advance)
        {
            return Some(Onward::Turns(from, advance));
        }
        let Passed { touching, beyond } = past_grazing(orbits, last)?;
        // Orbits may become those of half their period in the grazing: beyond it are the same, half a period later.
        let merges = is_merged(orbits, [&last.at, &touching.point.at]);
        let beyond = if merges { Err(End::Merged) } else { beyond.ok_or(End::Corner) };
        let end = beyond.as_ref().err().copied();
        let next = beyond.unwrap_or_else(|_| touching.point.clone());
        self.special_orbits.push((self.points.len() - 1, touching));
        self.points.push(next);
        Some(Onward::Leaps(end))
    }

    /// Whether a step leads back onto the orbits before.
    fn retraces<M: System<D, Event = E>>(
        &self,
        orbits: &Orbits<M, D, U>,
        advance: &Advance<OrbitPoint<E, D, U>>,
    ) -> bool {
        let (Advance::Inside(next) | Advance::AtBound(next)) = advance else { return false };
        let images = orbits.section_points(&next.at);
        let before = self.points.windows(2).rev().take(RETRACED);
        let mut pairs = before.flat_map(|pair| images.iter().map(move |image| (pair, image)));
        pairs.any(|(pair, image)| passes(orbits, [&pair[0].at, &pair[1].at], image))
    }

    /// Ends at the one of these period doublings of the branch it left that it has run into, if it has.
    pub fn merge<M: System<D, Event = E>>(
        &mut self,
        orbits: &Orbits<M, D, U>,
        doublings: &[(usize, OrbitPoint<E, D, U>)],
    ) {
        let Some(last) = self.points.last() else { return };
        let parent = orbits.with_period(orbits.family.period / 2);
        let ends = doublings.iter().flat_map(|(place, point)| {
            let images = parent.section_points(&point.at).into_iter();
            images.map(|image| (*place, image, norm(&between(&last.at, &image))))
        });
        let Some((place, image, away)) = ends.min_by(|a, b| a.2.total_cmp(&b.2)) else { return };
        if away <= MERGES
            && let Ok(Linear { rows, seen, .. }) = orbits.at(&image)
        {
            (self.merged, self.end) = (Some(place), End::Merged);
            self.points.push(OrbitPoint { at: image, tangent: last.tangent, rows, seen });
        }
    }

    /// Adds the next orbit and what happens before it, unless the step does not add up, which then is halved.
    fn add<M: System<D, Event = E>>(
        &mut self,
        orbits: &Orbits<M, D, U>,
        control: &mut StepControl<U>,
        from: &OrbitPoint<E, D, U>,
        next: OrbitPoint<E, D, U>,
        goal: &Goal<U, Seen<E, D, U>>,
    ) -> Added {
        let before = self.points.len() - 1;
        let mut end = None;
        // Up to where special orbits are looked for.
        let (mut next, mut until) = (next.clone(), next);
        if orbits.halves(&from.at, &next.at) {
            match merger(orbits, from, &next) {
                Some(_) if self.is_coarse() => return Added::Ends(End::Merged),
                Some(merger) if merger.is_near => {
                    (next, until, end) = (merger.at, merger.before, Some(End::Merged));
                }
                _ if control.halve(self.least).is_some() => return Added::Halved,
                _ => {}
            }
        } else if let Some(closing) = goal.met(orbits, [from, &next], before) {
            (next, until, end) = (closing.clone(), closing, Some(End::Closed));
        }
        let Some(found) = self.located(orbits, control, from, &until) else {
            return Added::Halved;
        };
        self.special_orbits.extend(found.into_iter().map(|special| (before, special)));
        if norm(&between(&from.at, &next.at)) > ONE {
            self.points.push(next);
            return end.map_or(Added::GoesOn, Added::Ends);
        }
        // Steps no longer than rounding lead nowhere.
        Added::Ends(end.unwrap_or(End::Stopped))
    }

    /// The special orbits of a step that are sought; none where the step does not add up, and is halved.
    fn located<M: System<D, Event = E>>(
        &self,
        orbits: &Orbits<M, D, U>,
        control: &mut StepControl<U>,
        from: &OrbitPoint<E, D, U>,
        until: &OrbitPoint<E, D, U>,
    ) -> Option<Vec<SpecialOrbit<E, D, U>>> {
        let Sought::Every(narrow) = self.sought else {
            return Some(special_orbits(orbits, from, until, self.sought));
        };
        let flaw = match special_orbits_of_whole(orbits, from, until, narrow) {
            Ok(found) => return Some(found),
            Err(flaw) => flaw,
        };
        // No step is so short that a branch goes on beyond a jump.
        if flaw == Flaw::Jump && control.halve(0.0).is_some() || control.halve(self.least).is_some()
        {
            return None;
        }
        // Changes that a long step does not tell one by one may hide a jump.
        let jumps = self.is_coarse() && jumps_over(orbits, from, until, narrow);
        if jumps && control.halve(0.0).is_some() {
            return None;
        }
        Some(special_orbits_of_shortest(orbits, from, until, narrow))
    }
}

/// What came of an orbit that was to be added to a branch.
enum Added {
    /// The step is halved.
    Halved,
    /// The branch goes on.
    GoesOn,
    /// It ends with the orbit.
    Ends(End),
}
