//! Where an orbit changes its character along a parameter: located by bisection.

use crate::branch::SpecialKind;
use crate::model::{EventKind, Locomotion};
use crate::orbit::Section;

use super::continuation::{Along, ROUNDING, Solution, apart};

/// Changes at most between two neighbouring values; a motion that changes more often is not resolved by them.
const MOST: usize = 16;
/// A multiplier this near to one belongs to an orbit that is about to end in a fold.
const NEAR_ONE: f64 = 0.01;

/// A change of an orbit, located.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// What happens.
    pub kind: SpecialKind,
    /// The value of the parameter.
    pub value: f64,
    /// How far the true value may be, as bisection has it.
    pub uncertainty: f64,
    /// Period of the orbit that changes [cycles].
    pub period: usize,
    /// Its section point there.
    pub section: Section,
}

impl Change {
    fn between(kind: SpecialKind, low: &Solution, high: &Solution) -> Change {
        Change {
            kind,
            value: 0.5 * (low.value + high.value),
            uncertainty: 0.5 * (high.value - low.value).abs(),
            period: low.period(),
            section: low.points[0],
        }
    }
}

/// The changes along a path of orbits, in its order.
///
/// Method: where a property differs between two neighbours on the path, the parameter is bisected, with an orbit
/// closed by Newton's method at each trial, until it is at rounding or no orbit closes; what is left
/// of the bracket is the uncertainty. The properties: whether a real multiplier is below -1 (the sign of det(J +
/// I)), whether a complex pair is outside the unit circle, and the sequence of events in a period; if the number of
/// impacts changes there it is a grazing. Two changes of one property that undo each other between two neighbours
/// are not seen.
pub fn changes<S: Locomotion>(along: &Along<'_, S>, path: &[Solution]) -> Vec<Change> {
    let mut found = Vec::new();
    for pair in path.windows(2) {
        let [low, high] = pair else { continue };
        let doubles = |a: &Solution, b: &Solution| a.passes(-1.0) != b.passes(-1.0);
        let spirals = |a: &Solution, b: &Solution| a.spirals() != b.spirals();
        let order = |a: &Solution, b: &Solution| a.events != b.events;
        let doubling = |_: &Solution, _: &Solution| SpecialKind::PeriodDoubling;
        let spiral = |_: &Solution, _: &Solution| SpecialKind::NeimarkSacker;
        let mut here = locate(along, low, high, doubles, doubling);
        here.extend(locate(along, low, high, spirals, spiral));
        here.extend(locate(along, low, high, order, of_events));
        here.sort_by(|a, b| (a.value - low.value).abs().total_cmp(&(b.value - low.value).abs()));
        found.extend(here);
    }
    found
}

/// A grazing if the number of impacts differs, another change of the sequence of events if not.
fn of_events(low: &Solution, high: &Solution) -> SpecialKind {
    let closes = EventKind::ContactClosed as u8;
    let impacts = |it: &Solution| it.events.iter().filter(|&&event| event == closes).count();
    match impacts(low) == impacts(high) {
        true => SpecialKind::EventSequence,
        false => SpecialKind::Grazing,
    }
}

/// Every place between two orbits where they begin to differ.
fn locate<S: Locomotion>(
    along: &Along<'_, S>,
    low: &Solution,
    high: &Solution,
    differ: impl Fn(&Solution, &Solution) -> bool,
    kind: impl Fn(&Solution, &Solution) -> SpecialKind,
) -> Vec<Change> {
    let mut found = Vec::new();
    let mut low = low.clone();
    while differ(&low, high) && found.len() < MOST {
        let (below, above) = bisect(along, low, high.clone(), &differ);
        found.push(Change::between(kind(&below, &above), &below, &above));
        low = above;
    }
    found
}

/// The narrowest pair of orbits between which they begin to differ from the first.
fn bisect<S: Locomotion>(
    along: &Along<'_, S>,
    mut low: Solution,
    mut high: Solution,
    differ: impl Fn(&Solution, &Solution) -> bool,
) -> (Solution, Solution) {
    while (high.value - low.value).abs() > 2.0 * ROUNDING * low.value.abs() {
        let middle = 0.5 * (low.value + high.value);
        let Some(between) = along.between(&low, &high, middle) else { break };
        if differ(&low, &between) {
            high = between;
        } else {
            low = between;
        }
    }
    (low, high)
}

/// What happens where an orbit does not go on for the last `step` of the parameter.
///
/// It is a fold if a multiplier tends to +1 there, and a period doubling if the orbit runs into one of half its
/// period; else it ends at a change of its events.
pub fn ending<S: Locomotion>(along: &Along<'_, S>, last: &Solution, step: f64) -> Change {
    let from_one =
        last.multipliers().iter().map(|it| libm::hypot(1.0 - it.re, it.im)).fold(1.0, f64::min);
    let kind = match () {
        () if merges(along, last) => SpecialKind::PeriodDoubling,
        () if from_one <= NEAR_ONE => SpecialKind::Fold,
        () => SpecialKind::EventSequence,
    };
    Change {
        kind,
        value: last.value + 0.5 * step,
        uncertainty: 0.5 * step.abs(),
        period: last.period(),
        section: last.points[0],
    }
}

/// Whether an orbit of half the period lies in the middle of this one.
fn merges<S: Locomotion>(along: &Along<'_, S>, orbit: &Solution) -> bool {
    let half = orbit.period() / 2;
    if half == 0 || !orbit.period().is_multiple_of(2) {
        return false;
    }
    let middle = std::array::from_fn(|i| 0.5 * (orbit.points[0][i] + orbit.points[half][i]));
    let shorter = along.close(orbit.value, &middle, half, orbit.size);
    let omega = along.omega(orbit.value);
    shorter.is_some_and(|shorter| straddles(&orbit.points, &shorter.points, omega))
}

/// Whether an orbit of twice the period lies on both sides of the shorter one, up to where they begin, as it does
/// beside a period doubling.
pub fn straddles(longer: &[Section], shorter: &[Section], omega: f64) -> bool {
    let k = shorter.len();
    let beside = |shift: usize| {
        (0..k).all(|i| {
            let (a, b) = (&longer[(i + shift) % k], &longer[(i + shift) % k + k]);
            let middle = std::array::from_fn(|j| 0.5 * (a[j] + b[j]));
            apart(&middle, &shorter[i], omega) < 0.5 * apart(a, b, omega)
        })
    };
    longer.len() == 2 * k && (0..k).any(beside)
}
