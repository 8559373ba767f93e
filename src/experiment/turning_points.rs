//! The turning points of the free vibration of the mass.

use std::ops::Range;

use super::noise::noise;
use super::recording::median;
use super::smoothing::{Unsuitable, Window, smoothed};

/// Crossings of the rest position and turning points count above so many standard deviations of the noise.
const CLEAR: f64 = 5.0;
/// So small a share of the largest displacement does not count: errors of the rest position are felt there.
const SMALL: f64 = 0.02;
/// The window in which turning points are read, as a share of half a period: it reaches from one turning point nearly to the
/// next zero on either side, so that windows of neighbouring turning points share no sample.
const WINDOW: f64 = 0.7;
/// Half waves, the first with its release, whose turning points tell a decay by themselves.
const LEAST_TURNS: usize = 4;

/// Why there is no decay to fit, and what can be done.
const NO_SWING: &str = "the record does not swing beyond its rest position above its noise, so that k1 and c cannot be told from it; is the \
     damping above critical (c of 2 sqrt(k1 m1) or more)? Then the mass creeps to rest and no vibration is seen: record with a \
     larger mass or less damping, or, if the noise hides the swing, with a larger release";

/// The turning points of a decaying record.
pub(super) struct Turns {
    /// Which half wave each is of: some may not be found.
    pub numbers: Vec<f64>,
    /// When each is [s].
    pub times: Vec<f64>,
    /// Displacements from the rest position [m].
    pub heights: Vec<f64>,
    /// The rest position [m].
    pub rest: f64,
    /// The sample after which the mass is certainly free: where it first passes its rest position.
    pub first_index: usize,
    /// The deviation of a height for a noise of one.
    pub height_deviation: f64,
    /// The deviation of a time for a noise of one, times the height [s].
    pub time_deviation: f64,
}

/// What stands clear of the noise of a decaying record.
pub(super) enum Clear {
    /// Turning points enough for a decay of their own.
    Turns(Turns),
    /// A swing or two to the other side, before the mass is at rest.
    Swing(Swing),
}

/// How a record that is soon at rest swings beyond its rest position.
pub(super) struct Swing {
    /// The sample after which the mass is certainly free: where it first passes its rest position.
    pub first_index: usize,
    /// How long it stays beyond [s].
    pub lasts: f64,
    /// The displacement that is the largest there [m].
    pub height: f64,
    /// The rest position [m].
    pub rest: f64,
}

/// What stands clear of the noise of a decaying record.
///
/// Fails where it does not swing beyond its rest position.
pub(super) fn turning_points(times: &[f64], r: &[f64]) -> Result<Clear, String> {
    let tail = &r[r.len() - (r.len() / 5).max(1)..];
    let rest = median(tail);
    let largest = r.iter().fold(0.0, |most: f64, value| most.max((value - rest).abs()));
    let clear = (CLEAR * noise(r)).max(SMALL * largest).max(f64::MIN_POSITIVE);
    let halves = half_waves(r, rest, clear);
    let Some(beyond) = halves.get(1) else {
        return Err(NO_SWING.to_owned());
    };
    let whole = turns(times, r, rest, &halves).transpose()?;
    Ok(whole.map_or_else(|| Clear::Swing(swing(times, r, rest, beyond)), Clear::Turns))
}

/// The swing beyond the rest position during these samples.
fn swing(times: &[f64], r: &[f64], rest: f64, beyond: &Range<usize>) -> Swing {
    let last = beyond.end.min(times.len() - 1);
    let away = r[beyond.start..=last].iter().map(|it| it - rest);
    Swing {
        first_index: beyond.start,
        lasts: times[last] - times[beyond.start],
        height: away.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0),
        rest,
    }
}

/// The turning points of half waves; none where they are too few.
fn turns(
    times: &[f64],
    r: &[f64],
    rest: f64,
    halves: &[Range<usize>],
) -> Option<Result<Turns, String>> {
    if halves.len() < LEAST_TURNS {
        return None;
    }
    let whole = &halves[1..halves.len() - 1];
    let half_period = median(&whole.iter().map(|it| it.len() as f64).collect::<Vec<_>>());
    let samples = ((WINDOW * half_period) as usize | 1).max(5).min(r.len() - 1 + r.len() % 2);
    let window = Window { samples, order: 2 };
    let smooth = match (smoothed(times, r, window, 0), smoothed(times, r, window, 1)) {
        (Ok(values), Ok(slopes)) => Smooth { times, values, slopes, rest },
        (Err(why), _) | (_, Err(why)) => return Some(Err(unsmoothed(why))),
    };
    let mut turns = smooth.turns(halves, samples / 2);
    turns.first_index = halves[1].start;
    let interval = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let n = samples as f64;
    // The variances of the value and of the slope of a parabola in the middle of n even samples.
    let value = 3.0 * (3.0 * n * n - 7.0) / (4.0 * n * (n * n - 4.0));
    let slope = 12.0 / (n * (n * n - 1.0)) / (interval * interval);
    turns.height_deviation = value.sqrt();
    turns.time_deviation *= slope.sqrt();
    (turns.times.len() + 1 >= LEAST_TURNS).then_some(Ok(turns))
}

fn unsmoothed(why: Unsuitable) -> String {
    format!("cannot be smoothed: {why}")
}

/// A smoothed record.
struct Smooth<'t> {
    times: &'t [f64],
    values: Vec<f64>,
    slopes: Vec<f64>,
    rest: f64,
}

impl Smooth<'_> {
    /// The turning points of half waves, as far as the window reaches over samples on both sides. The first half wave is where
    /// the mass was let go, perhaps held before: it has no turning point of the decay.
    fn turns(&self, halves: &[Range<usize>], reach: usize) -> Turns {
        let mut turns = Turns {
            numbers: Vec::new(),
            times: Vec::new(),
            heights: Vec::new(),
            rest: self.rest,
            first_index: 0,
            height_deviation: 0.0,
            time_deviation: 0.0,
        };
        for (number, half) in halves.iter().enumerate().skip(1) {
            let Some((at, time, height)) = self.turn(half, reach) else { continue };
            if turns.times.is_empty() {
                // The slope falls by this for a unit of time and of height, in all turns alike.
                let steepness = (self.slopes[at + 1] - self.slopes[at]).abs()
                    / (self.times[at + 1] - self.times[at]);
                turns.time_deviation = height.abs() / steepness;
            }
            turns.numbers.push(number as f64);
            turns.times.push(time);
            turns.heights.push(height);
        }
        turns
    }

    /// How far a sample is from the rest position [m].
    fn away(&self, sample: usize) -> f64 {
        (self.values[sample] - self.rest).abs()
    }

    /// Whether the slope changes its sign between a sample and the next.
    fn turns_after(&self, sample: usize) -> bool {
        let [this, next] = [self.slopes[sample], self.slopes[sample + 1]];
        this * next <= 0.0 && this != next
    }

    /// The sample before the turning point of a half wave, its time, and its height above the rest position.
    fn turn(&self, half: &Range<usize>, reach: usize) -> Option<(usize, f64, f64)> {
        let top = half.clone().max_by(|a, b| self.away(*a).total_cmp(&self.away(*b)))?;
        let slopes = &self.slopes;
        let ends = half.start..half.end.min(slopes.len() - 1);
        let at = ends.filter(|i| self.turns_after(*i)).min_by_key(|i| i.abs_diff(top))?;
        if at < reach.max(1) || at + 1 + reach.max(1) >= self.values.len() {
            return None;
        }
        let share = slopes[at] / (slopes[at] - slopes[at + 1]);
        let time = self.times[at] + share * (self.times[at + 1] - self.times[at]);
        // The parabola through the three samples about it.
        let middle = if share < 0.5 { at } else { at + 1 };
        let [a, b, c] = [middle - 1, middle, middle + 1].map(|i| (self.times[i], self.values[i]));
        let first = (b.1 - a.1) / (b.0 - a.0);
        let second = ((c.1 - b.1) / (c.0 - b.0) - first) / (c.0 - a.0);
        let value = a.1 + (time - a.0) * (first + (time - b.0) * second);
        Some((at, time, value - self.rest))
    }
}

/// The parts of a record between crossings of its rest position, by sample, as far as each goes clear of the noise.
fn half_waves(r: &[f64], rest: f64, clear: f64) -> Vec<Range<usize>> {
    let mut halves: Vec<Range<usize>> = Vec::new();
    let (mut side, mut crossed) = (0.0, 0);
    for (i, value) in r.iter().enumerate() {
        let away = value - rest;
        if away * side < 0.0 && r[i - 1] * side - rest * side >= 0.0 {
            crossed = i;
        }
        if away.abs() > clear && away * side <= 0.0 {
            if let Some(last) = halves.last_mut() {
                last.end = crossed.max(last.start + 1);
            }
            halves.push(crossed..r.len());
            side = away.signum();
        }
    }
    if let Some(last) = halves.last_mut() {
        let beyond = r[last.start..].iter().position(|value| (value - rest) * side < -0.2 * clear);
        last.end = beyond.map_or(r.len(), |count| last.start + count);
    }
    halves
}
