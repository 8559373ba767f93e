//! Where an orbit changes its character along a parameter: located by bisection.

use crate::branch::SpecialKind;
use crate::capsule::{EventKind, Reading, Section};
use crate::flow::Metric;
use crate::orbit::matrix::least_from_one;

use super::natural::{Along, ROUNDING, Solution, left_to_fold};

/// Changes at most between two neighbouring values; a motion that changes more often is not resolved by them.
const MOST: usize = 16;
/// Sequences of events that change without an impact more or less are located to this, relative to the
/// parameter.
const COARSE: f64 = 1e-9;
/// How far beside the expected zero of a property to look, as a share of the distance between two orbits.
const BESIDE: f64 = 1e-3;
/// A multiplier this near to one belongs to an orbit that is about to end in a fold.
const NEAR_ONE: f64 = 0.01;

/// It has come nearer to one by this factor along the path.
const SHRINKS: f64 = 0.5;

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

/// The changes along a path of orbits that begins with one that attracts, up to where it ceases to.
///
/// Method: where a property differs between two neighbours on the path, the parameter is bisected, with an
/// orbit closed by Newton's method at each trial, until it is at rounding or no orbit closes; what is left
/// of the bracket is the uncertainty. Where the property is the sign of a smooth number, trials on both
/// sides of where the straight line through its values passes zero come before each bisection. The
/// properties: whether a real multiplier is below -1 (the sign of det(J + I)), whether a complex pair is
/// outside the unit circle, and the sequence of events in a period; if the number of impacts changes there
/// it is a grazing. Two changes of one property that undo each other between two neighbours are not seen.
pub fn changes<R: Reading>(along: &Along<'_, R>, path: &[Solution]) -> Vec<Change> {
    let spirals = |a: &Solution, b: &Solution| a.spirals() != b.spirals();
    let order = |a: &Solution, b: &Solution| a.events != b.events;
    let spiral = |_: &Solution, _: &Solution| SpecialKind::NeimarkSacker;
    let spiral = Property { differs: &spirals, measure: None, kind: &spiral };
    let sequence = Property { differs: &order, measure: None, kind: &of_events };
    let mut found = Vec::new();
    for pair in path.windows(2) {
        let [low, high] = pair else { continue };
        let losses = [&DOUBLING, &spiral].map(|property| property.first(along, low, high));
        let away = |it: &(Solution, Solution)| (it.0.value - low.value).abs();
        let loss = losses.into_iter().flatten().min_by(|a, b| away(a).total_cmp(&away(b)));
        let until = loss.as_ref().map_or(high, |(below, _)| below);
        found.extend(sequence.every(along, low, until));
        if let Some((below, above)) = loss {
            // Multipliers jump where the sequence of events changes; the change is then one of the sequence.
            let kind = match () {
                () if below.events != above.events => of_events(&below, &above),
                () if doubles(&below, &above) => SpecialKind::PeriodDoubling,
                () => SpecialKind::NeimarkSacker,
            };
            found.push(Change::between(kind, &below, &above));
            break;
        }
    }
    found
}

/// Whether a period doubling lies between two orbits.
fn doubles(a: &Solution, b: &Solution) -> bool {
    a.passes(-1.0) != b.passes(-1.0)
}

/// A real multiplier passes -1.
const DOUBLING: Property<'static> = Property {
    differs: &doubles,
    measure: Some(&|it| it.shifted_determinant(-1.0)),
    kind: &|_, _| SpecialKind::PeriodDoubling,
};

/// What may change between two orbits.
struct Property<'a> {
    /// Whether it differs between two orbits.
    differs: &'a dyn Fn(&Solution, &Solution) -> bool,
    /// A number that passes zero smoothly where it changes, if there is one.
    measure: Option<&'a dyn Fn(&Solution) -> f64>,
    /// What such a change is, from the orbits just before and after it.
    kind: &'a dyn Fn(&Solution, &Solution) -> SpecialKind,
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

impl Property<'_> {
    /// Every place between two orbits where it changes.
    fn every<R: Reading>(
        &self,
        along: &Along<'_, R>,
        low: &Solution,
        high: &Solution,
    ) -> Vec<Change> {
        let mut found = Vec::new();
        let mut low = low.clone();
        while let Some((below, above)) = self.first(along, &low, high) {
            found.push(Change::between((self.kind)(&below, &above), &below, &above));
            if found.len() == MOST {
                break;
            }
            low = above;
        }
        found
    }

    /// The orbits just before and after the first place between two orbits where it changes.
    fn first<R: Reading>(
        &self,
        along: &Along<'_, R>,
        low: &Solution,
        high: &Solution,
    ) -> Option<(Solution, Solution)> {
        (self.differs)(low, high).then(|| self.bisect(along, low.clone(), high.clone()))
    }

    /// The narrowest pair of orbits between which it begins to differ from the first.
    fn bisect<R: Reading>(
        &self,
        along: &Along<'_, R>,
        mut low: Solution,
        mut high: Solution,
    ) -> (Solution, Solution) {
        // A parameter that passes zero is measured against its change.
        let scale = low.value.abs().max(high.value.abs());
        loop {
            let width = high.value - low.value;
            let coarse = (self.kind)(&low, &high) == SpecialKind::EventSequence;
            let narrow = if coarse { COARSE } else { ROUNDING };
            if width.abs() <= 2.0 * narrow * scale {
                return (low, high);
            }
            let (from, share) = (low.value, self.shares(&low, &high));
            for value in share.map(|share| from + share * width) {
                let inside = (value - low.value) / (high.value - low.value);
                if !(inside > 0.0 && inside < 1.0) {
                    continue;
                }
                let Some(between) = along.between(&low, &high, value) else { return (low, high) };
                match (self.differs)(&low, &between) {
                    true => high = between,
                    false => low = between,
                }
            }
        }
    }

    /// Where to try between two orbits, as shares of the distance: on both sides of where the measure passes
    /// zero if it is straight, and then in the middle.
    fn shares(&self, low: &Solution, high: &Solution) -> [f64; 3] {
        let Some(measure) = self.measure else { return [0.5, 1.0, 1.0] };
        let (a, b) = (measure(low), measure(high));
        let zero = a / (a - b);
        [zero - BESIDE, zero + BESIDE, 0.5]
    }
}

/// The change at which the last orbit of a path towards the value `to` does not continue for `step`
/// more of the parameter.
///
/// It is a period doubling if the orbit runs into one of half its period, which then is located on that
/// shorter orbit, and a fold if a multiplier tends to +1; else it ends at a change of its events. Near a
/// fold Newton's method gives up before the orbit ends: the last two orbits foretell how much is left,
/// which then is the uncertainty if it is more than the step.
pub fn branch_end<R: Reading>(
    along: &Along<'_, R>,
    path: &[Solution],
    (to, step): (f64, f64),
) -> Option<Change> {
    let last = path.last()?;
    if let Some(shorter) = merged(along, last) {
        return doubling(along, &shorter, [path[0].value, to]);
    }
    let from_one = |it: &Solution| least_from_one(&it.multipliers());
    let (kind, left) = match path {
        [.., before, last] if from_one(last) <= NEAR_ONE.min(SHRINKS * from_one(&path[0])) => {
            let foretold = left_to_fold(before, last);
            let within = foretold > 0.0 && foretold <= (to - last.value).abs();
            (SpecialKind::Fold, if within { foretold } else { 0.0 })
        }
        _ => (SpecialKind::EventSequence, 0.0),
    };
    let left = left.max(0.5 * step.abs());
    Some(Change {
        kind,
        value: last.value + left.copysign(step),
        uncertainty: left,
        period: last.period(),
        section: last.points[0],
    })
}

/// The period doubling of the orbit that a longer one between the first value and the second has run
/// into. Near it the two are hard to tell apart, so that it may lie before or behind.
fn doubling<R: Reading>(
    along: &Along<'_, R>,
    shorter: &Solution,
    [from, to]: [f64; 2],
) -> Option<Change> {
    let toward = if shorter.passes(-1.0) { to } else { from };
    let (path, _) = along.follow(shorter, toward);
    let (below, above) =
        path.windows(2).find_map(|pair| DOUBLING.first(along, &pair[0], &pair[1]))?;
    Some(Change::between(SpecialKind::PeriodDoubling, &below, &above))
}

/// The orbit of half the period in the middle of this one, if there is one.
fn merged<R: Reading>(along: &Along<'_, R>, orbit: &Solution) -> Option<Solution> {
    let half = orbit.period() / 2;
    if half == 0 || !orbit.period().is_multiple_of(2) {
        return None;
    }
    let middle = std::array::from_fn(|i| 0.5 * (orbit.points[0][i] + orbit.points[half][i]));
    let shorter = along.close(orbit.value, &middle, half, orbit.size)?;
    let metric = along.metric(orbit.value);
    straddles(&orbit.points, &shorter.points, &metric).then_some(shorter)
}

/// Whether an orbit of twice the period lies on both sides of the shorter one, up to where they begin, as
/// it does beside a period doubling.
pub fn straddles(longer: &[Section], shorter: &[Section], metric: &Metric<3>) -> bool {
    let k = shorter.len();
    let beside = |shift: usize| {
        (0..k).all(|i| {
            let (a, b) = (&longer[(i + shift) % k], &longer[(i + shift) % k + k]);
            let middle = std::array::from_fn(|j| 0.5 * (a[j] + b[j]));
            metric.distance(&middle, &shorter[i]) < 0.5 * metric.distance(a, b)
        })
    };
    longer.len() == 2 * k && (0..k).any(beside)
}
