//! A try to locate the boundary between two neighbouring cases of a map: the orbit of each is continued to the other.

use super::map_plane::{Neighbours, values_along};
use crate::branch::is_followed;
use crate::description::{Parameter, Section, State};
use crate::motion::branch::{Branch, Found, Point};
use crate::of::model_of;
use crate::study::axis::range;
use crate::study::boundaries::parameters_of_map;
use crate::study::{Boundaries, CaseSet, Continuation, FirstOrbit, Study};

/// A branch begins so far before the first of two neighbours, as a share of their distance, so that it does not begin at its bound.
const BEFORE: f64 = 0.01;
/// It has reached the other where it comes so near to it, as a share of their distance: its bound is met to rounding.
const REACHED: f64 = 1e-6;

/// The kind of motion of a case: neighbours of the same kind lie in one region of the map.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MotionKind {
    /// Its period [cycles]; zero where it does not repeat.
    pub period: u64,
    /// Impacts in a period, on each surface; none where it does not repeat.
    pub impacts: Vec<i64>,
}

/// What came of a try.
pub enum Tried {
    /// Boundaries were located.
    Located(Vec<Located>),
    /// The orbit of one goes on to the other without a special point at which its stability or its impacts change.
    GoesOn,
    /// Neither.
    NotLocated,
}

/// What was followed from one of two neighbours.
pub struct Located {
    /// The branch from there to the other.
    pub continuation: Continuation,
    /// The branch with its special points, and the curves through them.
    pub found: Found,
    /// Those of the curves that are boundaries: where a stable orbit of the branch begins, ends, changes its stability or impacts.
    pub curves: Vec<usize>,
}

/// Two neighbours of different kinds.
pub struct Try<'a> {
    /// The study that has the map.
    pub study: &'a Study,
    /// How curves are followed.
    pub asked: &'a Boundaries,
    /// The neighbours.
    pub pair: Neighbours,
    /// Their kinds.
    pub kinds: [Option<&'a MotionKind>; 2],
    /// A section point of each that repeats.
    pub sections: [Option<Section>; 2],
}

impl Try<'_> {
    /// Continues the orbit of each to the other.
    pub fn result(&self) -> Tried {
        let mut located = Vec::new();
        let mut goes_on = false;
        for side in [0, 1] {
            let Some((continuation, period)) = self.continuation(side) else { continue };
            let request = continuation.request(
                continuation.start.section(),
                period,
                self.study.protocol.tolerance,
            );
            let Ok(found) = model_of(&continuation.parameters).follow(&request) else { continue };
            let curves = self.boundaries(&found);
            match curves.is_empty() {
                false => located.push(Located { continuation, found, curves }),
                true => goes_on |= self.goes_on(side, &found),
            }
        }
        match located.is_empty() {
            false => Tried::Located(located),
            true if goes_on => Tried::GoesOn,
            true => Tried::NotLocated,
        }
    }

    /// The parameter in which the two differ, with its values at them.
    fn along(&self) -> Option<(Parameter, [f64; 2])> {
        let CaseSet::Grid(grid) = &self.study.case_set else { return None };
        let parameter = parameters_of_map(grid)?[self.pair.axis];
        Some((parameter, self.pair.cases.map(|case| self.study.case(case).parameters[parameter])))
    }

    /// The branch through the orbit of one side to the other, with its period; none where it does not repeat.
    fn continuation(&self, side: usize) -> Option<(Continuation, u64)> {
        let CaseSet::Grid(grid) = &self.study.case_set else { return None };
        let period = self.kinds[side].map(|kind| kind.period).filter(|period| *period > 0)?;
        let section = self.sections[side]?;
        let (along, values) = self.along()?;
        let second = parameters_of_map(grid)?[1 - self.pair.axis];
        let [own, other] = [values[side], values[1 - side]];
        let before = own - BEFORE * (other - own);
        let case = self.study.case(self.pair.cases[side]);
        let ends = |axis: usize| range(values_along(grid, axis));
        let continuation = Continuation {
            name: String::new(),
            along,
            range: [before.min(other), before.max(other)],
            start: State::at_section(case.parameters.model(), &section),
            parameters: case.parameters.with_part(along).with_part(second),
            start_phase: case.section_phase,
            section_phase: case.section_phase,
            first: FirstOrbit::Newton { period },
            doublings: 0,
            second: Some((second, ends(1 - self.pair.axis))),
            curve_range: Some(ends(self.pair.axis)),
            longest_step: self.asked.longest_step,
            most_points: self.asked.most_points,
        };
        Some((continuation, period))
    }

    /// The curves through those special points between the two at which a stable orbit begins, ends or changes.
    fn boundaries(&self, found: &Found) -> Vec<usize> {
        let Some((_, values)) = self.along() else { return Vec::new() };
        let [low, high] = range(&values);
        let mut curves = Vec::new();
        for branch in &found.branches {
            for special in branch.special.iter().filter(|it| is_followed(it.kind)) {
                let is_between = (low..=high).contains(&special.point.parameter);
                let is_of_stable = beside(branch, special.after).any(is_stable);
                curves.extend(special.curve.filter(|_| is_between && is_of_stable));
            }
        }
        curves.sort_unstable();
        curves.dedup();
        curves
    }

    /// Whether the branch reaches the other side with a stable orbit.
    fn goes_on(&self, side: usize, found: &Found) -> bool {
        let Some((_, values)) = self.along() else { return false };
        let (other, distance) = (values[1 - side], (values[1] - values[0]).abs());
        let mut points = found.branches.iter().flat_map(|branch| &branch.points);
        points.any(|it| is_stable(it) && (it.parameter - other).abs() <= REACHED * distance)
    }
}

/// The orbits of a branch on the two sides of a special point.
fn beside(branch: &Branch, after: usize) -> impl Iterator<Item = &Point> {
    [after, after + 1].into_iter().filter_map(|place| branch.points.get(place))
}

fn is_stable(point: &Point) -> bool {
    point.multipliers.iter().all(|it| it.abs() < 1.0)
}
