//! The motion over some cycles as the page draws it: dense enough that no curve is a polygon.

use std::f64::consts::{PI, TAU};

use crate::description::{Description, Parameters, State};
use crate::motion::{Case, Stretch};
use crate::of::model_of;

/// Points of half a cycle, beside its events, of motions over two cycles; those over more have fewer.
const POINTS: u32 = 150;
/// Points of half a cycle at least.
const LEAST_POINTS: u32 = 60;
/// Points of the histories at most: an answer of more than some megabytes is no click.
pub const MOST_POINTS: usize = 20_000;
/// How far a chord may be from the motion, as a share of what is drawn.
const BEND: f64 = 1e-3;
/// Parts into which the time from a point to the next is cut at most.
const MOST_PARTS: f64 = 24.0;
/// What takes less than this share of a cycle is drawn as it is.
const SHORTEST: f64 = 1e-6;
/// By how much of the largest the motion from a point may miss the next.
const MISSED: f64 = 1e-6;

/// The motion from a point of the section over some cycles, as far as the most points; none where the model tells no histories of its
/// motions.
pub fn followed(case: &Case, from: State, cycles: u64, tolerance: f64) -> Option<Stretch> {
    let parameters = &case.parameters;
    let model = parameters.model();
    if model.motion.histories.is_empty() {
        return None;
    }
    // Under a drive the motion is followed by halves of a cycle, so that the phases of both ends differ.
    let half = parameters.period_of_drive().map(|period| 0.5 * period);
    let parts = if half.is_some() { 2 * cycles } else { cycles };
    let count = ((4 * u64::from(POINTS) / parts.max(1)) as u32).clamp(LEAST_POINTS, POINTS);
    let mut stretch = Stretch::of(model);
    let (mut start, mut begins) = (from, 0.0);
    for number in 0..parts {
        let [start_phase, section_phase] = [number, number + 1].map(|halves| match half {
            Some(_) => case.section_phase + PI * (halves % 2) as f64,
            None => 0.0,
        });
        let part = Case { parameters: parameters.clone(), start, start_phase, section_phase };
        let part = model_of(parameters).arc(&part, count, tolerance).ok()?;
        let last = part.times.len() - 1;
        start = part.state(last);
        stretch.append(begins, &part);
        begins = half.map_or(begins + part.times[last], |half| (number + 1) as f64 * half);
        if stretch.times.len() >= MOST_POINTS {
            stretch.truncate(MOST_POINTS);
            break;
        }
    }
    Some(refined(case, stretch, tolerance))
}

/// A motion under a drive with points between those beside which a signal bends, as within a short contact.
///
/// Method: where a point lies off the chord of its neighbours, the intervals on both sides are followed again in so many parts that
/// their chords would not; error of a chord falls with the square of its length.
fn refined(case: &Case, coarse: Stretch, tolerance: f64) -> Stretch {
    let Some(period) = case.parameters.period_of_drive() else { return coarse };
    let parts = parts(&case.parameters, &coarse);
    let sizes: Vec<f64> = coarse.histories.iter().map(|column| largest(column)).collect();
    let model = case.parameters.model();
    let mut fine = Stretch::of(model);
    for (place, parts) in parts.into_iter().enumerate() {
        let chord = between(&coarse, place, model);
        let phase = |time: f64| case.section_phase + TAU * time / period;
        let part = Case {
            parameters: case.parameters.clone(),
            start: coarse.state(place),
            start_phase: phase(coarse.times[place]),
            section_phase: phase(coarse.times[place + 1]),
        };
        // From an event to the next at the same time a motion between equal phases would take a whole cycle.
        let is_long = coarse.times[place + 1] - coarse.times[place] > SHORTEST * period;
        let room = is_long && fine.times.len() + parts as usize <= MOST_POINTS;
        let arc =
            (parts > 1 && room).then(|| model_of(&part.parameters).arc(&part, parts, tolerance));
        let arc = arc.and_then(Result::ok).filter(|arc| meets(arc, &chord, &sizes, &part));
        fine.append(coarse.times[place], &arc.unwrap_or(chord));
    }
    fine
}

/// Into how many parts the time from each point to the next is cut.
fn parts(parameters: &Parameters, coarse: &Stretch) -> Vec<u32> {
    let times = &coarse.times;
    let mut parts = vec![1; times.len().saturating_sub(1)];
    let signals = parameters.model().motion.signals.iter();
    for signal in signals.filter(|it| (it.missing)(parameters).is_none()) {
        let values = signal.values(parameters, &coarse.histories);
        let bounds = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], it| {
            [low.min(*it), high.max(*it)]
        });
        let least = BEND * (bounds[1] - bounds[0]);
        for (before, it) in values.windows(3).enumerate() {
            let [from, to] = [times[before], times[before + 2]];
            let share = (times[before + 1] - from) / (to - from);
            let off = (it[1] - it[0] - share * (it[2] - it[0])).abs();
            if least > 0.0 && off > least {
                let wanted = (2.0 * (off / least).sqrt()).ceil().min(MOST_PARTS) as u32;
                for interval in [before, before + 1] {
                    parts[interval] = parts[interval].max(wanted);
                }
            }
        }
    }
    parts
}

/// Whether the motion followed again ends where the interval does; it may drift.
fn meets(arc: &Stretch, chord: &Stretch, sizes: &[f64], case: &Case) -> bool {
    let drift = case.parameters.model().drift;
    let ends = arc.histories.iter().zip(&chord.histories).zip(sizes).enumerate();
    ends.filter(|(column, _)| Some(*column) != drift).all(|(_, ((arc, chord), size))| {
        matches!((arc.last(), chord.last()), (Some(a), Some(b)) if (a - b).abs() <= MISSED * size)
    })
}

/// The largest magnitude.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// A motion from a point to the next, without what lies between.
fn between(coarse: &Stretch, place: usize, model: &'static Description) -> Stretch {
    let ends = place..place + 2;
    let mut chord = Stretch::of(model);
    chord.times = coarse.times[ends.clone()].iter().map(|it| it - coarse.times[place]).collect();
    chord.histories = coarse.histories.iter().map(|it| it[ends.clone()].to_vec()).collect();
    chord
}
