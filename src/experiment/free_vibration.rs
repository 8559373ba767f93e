//! Stiffness and damping from the free vibration of the mass, in two methods.

use super::estimate::{Estimate, chance_of_ratio};
use super::least_squares::{Residuals, Search, fit};
use super::recording::median;
use super::smoothing::{Window, smoothed};

/// Crossings of the rest position and turning points count above so many standard deviations of the noise.
const CLEAR: f64 = 5.0;
/// So small a share of the largest displacement does not count: errors of the rest position are felt there.
const SMALL: f64 = 0.02;
/// The window in which turning points are read, as a share of half a period: it reaches from one turning point nearly to the
/// next zero on either side, so that windows of neighbouring turning points share no sample.
const WINDOW: f64 = 0.7;
/// The least error of a turning point, as a share of the largest: that of reading it between samples.
const BETWEEN_SAMPLES: f64 = 1e-4;
/// Turning points scatter more than the noise says where chance alone does so with a lower probability.
const SCATTERED: f64 = 0.01;
/// Turning points that a decay must have.
const LEAST_TURNS: usize = 4;

/// What free vibration says of the spring and the damper.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeVibration {
    /// Stiffness and damping by the times and heights of the turning points [N/m, N s/m].
    pub by_decrement: [Estimate; 2],
    /// The same by least squares on the whole decay.
    pub by_decay: [Estimate; 2],
    /// Where the mass comes to rest [m].
    pub rest: f64,
    /// Scatter of the record about the fitted decay [m].
    pub scatter: f64,
    /// Noise of the record, by its third differences [m]; the scatter is no larger where the model describes the record.
    pub noise: f64,
    /// When the fitted part of the record begins [s].
    pub begins: f64,
    /// Amplitudes of cos and sin of the fitted decay from there [m].
    pub amplitudes: [f64; 2],
    /// Turning points that the first method uses.
    pub turns: usize,
}

impl FreeVibration {
    /// The fitted decay at `time` of the record [m].
    pub fn decay(&self, m1: f64, time: f64) -> f64 {
        let [k1, c] = self.by_decay.map(|it| it.value);
        let parameters = [k1, c, self.amplitudes[0], self.amplitudes[1], self.rest];
        decay(m1, &parameters, time - self.begins).0
    }

    /// How far the first method's stiffness and damping lie above the second's, in standard errors of the first.
    ///
    /// The second method is the better one on the same record, so their difference has at most the variance of the first.
    pub fn disagreement(&self) -> [f64; 2] {
        [0, 1].map(|i| {
            let (first, second) = (self.by_decrement[i], self.by_decay[i]);
            let error = first.standard_error.max(second.standard_error);
            if error > 0.0 { (first.value - second.value) / error } else { 0.0 }
        })
    }
}

/// Stiffness and damping from a record of the displacement `r` [m] of the mass `m1` [kg] that was let go at rest, on a
/// capsule that does not move.
///
/// # Method
///
/// The first method is the paper's: with half a period D between turning points whose heights fall by the factor q,
/// `gamma = -ln(q)/D`, `omega_d = pi/D`, `k1 = m1 (omega_d^2 + gamma^2)`, `c = 2 m1 gamma`. D comes from the line through the
/// times of the turning points of the smoothed record, weighted by the squares of their heights, as times of small turns are
/// less certain; q from the least squares of their displacements, `rest + A (-q)^n`. Displacements have equal errors, but their
/// logarithms do not, and those of small ones are biased. Their errors are the noise of the record as the smoothing passes it,
/// or their own scatter where that is clearly larger. Smoothing changes all turning points by one factor. The second method
/// is the least squares of `r = rest + exp(-gamma t) (a cos(omega_d t) + b sin(omega_d t))` on every sample after the
/// mass has first passed its rest position; it uses all of the decay and is the better one.
///
/// # Assumes
///
/// Independent noise of equal scatter on r, exact times and an exact mass.
///
/// # Breaks
///
/// An error says so where the record has fewer than four turning points above its noise.
pub fn free_vibration(times: &[f64], r: &[f64], m1: f64) -> Result<FreeVibration, String> {
    let turns = turning_points(times, r)?;
    let by_decrement = |noise: f64| by_decrement(&turns, m1, (noise, r.len()));
    let start = by_decrement(noise(r))?;
    let first = turns.first_index;
    let begins = times[first];
    let model = |parameters: &[f64]| {
        let samples = times[first..].iter().zip(&r[first..]);
        let rows = samples.map(|(time, r)| {
            let (value, slopes) = decay(m1, parameters, time - begins);
            (value - r, slopes.to_vec())
        });
        let (values, slopes) = rows.unzip();
        Some(Residuals { values, slopes })
    };
    let [k1, c] = start.map(|it| it.value);
    let swing = turns.heights[0].abs() * -(r[first - 1] - turns.rest).signum();
    let start = [k1, c, 0.0, swing, turns.rest];
    let fit = fit(&model, &start, &Search::free(5)).ok_or("the decay cannot be fitted")?;
    let estimate = |i: usize| {
        Estimate::of_student(fit.parameters[i], fit.standard_error(i), fit.degrees_of_freedom)
    };
    let noise = noise(&r[first..]);
    Ok(FreeVibration {
        // Third differences of the motion itself count as noise where samples are few.
        by_decrement: by_decrement(noise.min(fit.residual_deviation()))?,
        by_decay: [estimate(0), estimate(1)],
        rest: fit.parameters[4],
        scatter: fit.residual_deviation(),
        noise,
        begins,
        amplitudes: [fit.parameters[2], fit.parameters[3]],
        turns: turns.times.len(),
    })
}

/// The decay of stiffness, damping, two amplitudes and the rest position so long after its beginning, with its slopes in them.
fn decay(m1: f64, parameters: &[f64], time: f64) -> (f64, [f64; 5]) {
    let [k1, c, a, b, rest] = [0, 1, 2, 3, 4].map(|i| parameters[i]);
    let gamma = c / (2.0 * m1);
    // Where the search has left the oscillating decays, the least frequency stands for the others.
    let omega = (k1 / m1 - gamma * gamma).max(1e-12).sqrt();
    let (sin, cos) = (omega * time).sin_cos();
    let envelope = (-gamma * time).exp();
    let wave = a * cos + b * sin;
    let by_omega = envelope * time * (b * cos - a * sin);
    let by_k1 = by_omega / (2.0 * m1 * omega);
    let by_c = -time * envelope * wave / (2.0 * m1) - by_omega * gamma / (2.0 * m1 * omega);
    (rest + envelope * wave, [by_k1, by_c, envelope * cos, envelope * sin, 1.0])
}

struct Turns {
    /// Which half wave each is of: some may not be found.
    numbers: Vec<f64>,
    times: Vec<f64>,
    /// Displacements from the rest position [m].
    heights: Vec<f64>,
    rest: f64,
    /// The sample after which the mass is certainly free: where it first passes its rest position.
    first_index: usize,
    /// The deviation of a height for a noise of one.
    height_deviation: f64,
    /// The deviation of a time for a noise of one, times the height [s].
    time_deviation: f64,
}

/// The turning points of a decaying record that stand clear of its noise.
fn turning_points(times: &[f64], r: &[f64]) -> Result<Turns, String> {
    let few =
        "the record has fewer than four turning points above its noise; is it a free vibration?";
    let tail = &r[r.len() - (r.len() / 5).max(1)..];
    let rest = median(tail);
    let largest = r.iter().fold(0.0, |most: f64, value| most.max((value - rest).abs()));
    let clear = (CLEAR * noise(r)).max(SMALL * largest).max(f64::MIN_POSITIVE);
    let halves = half_waves(r, rest, clear);
    if halves.len() < LEAST_TURNS {
        return Err(few.to_owned());
    }
    let whole = &halves[1..halves.len() - 1];
    let half_period = median(&whole.iter().map(|it| (it.1 - it.0) as f64).collect::<Vec<_>>());
    let samples = ((WINDOW * half_period) as usize | 1).max(5).min(r.len() - 1 + r.len() % 2);
    let window = Window { samples, order: 2 };
    let read = |derivative| {
        smoothed(times, r, window, derivative).map_err(|why| format!("cannot be smoothed: {why}"))
    };
    let smooth = Smooth { times, values: read(0)?, slopes: read(1)?, rest };
    let mut turns = smooth.turns(&halves, samples / 2);
    turns.first_index = halves[1].0;
    let interval = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let n = samples as f64;
    // The variances of the value and of the slope of a parabola in the middle of n even samples.
    let value = 3.0 * (3.0 * n * n - 7.0) / (4.0 * n * (n * n - 4.0));
    let slope = 12.0 / (n * (n * n - 1.0)) / (interval * interval);
    turns.height_deviation = value.sqrt();
    turns.time_deviation *= slope.sqrt();
    if turns.times.len() + 1 < LEAST_TURNS { Err(few.to_owned()) } else { Ok(turns) }
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
    fn turns(&self, halves: &[(usize, usize)], reach: usize) -> Turns {
        let mut turns = Turns {
            numbers: Vec::new(),
            times: Vec::new(),
            heights: Vec::new(),
            rest: self.rest,
            first_index: 0,
            height_deviation: 0.0,
            time_deviation: 0.0,
        };
        for (number, &half) in halves.iter().enumerate().skip(1) {
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

    /// The sample before the turning point of a half wave, its time, and its height above the rest position.
    fn turn(&self, (from, to): (usize, usize), reach: usize) -> Option<(usize, f64, f64)> {
        let away = |i: &usize| (self.values[*i] - self.rest).abs();
        let top = (from..to).max_by(|a, b| away(a).total_cmp(&away(b)))?;
        let slopes = &self.slopes;
        let turns = |i: &usize| slopes[*i] * slopes[i + 1] <= 0.0 && slopes[*i] != slopes[i + 1];
        let ends = from..to.min(slopes.len() - 1);
        let at = ends.filter(turns).min_by_key(|i| i.abs_diff(top))?;
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
fn half_waves(r: &[f64], rest: f64, clear: f64) -> Vec<(usize, usize)> {
    let mut halves: Vec<(usize, usize)> = Vec::new();
    let (mut side, mut crossed) = (0.0, 0);
    for (i, value) in r.iter().enumerate() {
        let away = value - rest;
        if away * side < 0.0 && r[i - 1] * side - rest * side >= 0.0 {
            crossed = i;
        }
        if away.abs() > clear && away * side <= 0.0 {
            if let Some(last) = halves.last_mut() {
                last.1 = crossed.max(last.0 + 1);
            }
            halves.push((crossed, r.len()));
            side = away.signum();
        }
    }
    if let Some(last) = halves.last_mut() {
        let beyond = r[last.0..].iter().position(|value| (value - rest) * side < -0.2 * clear);
        last.1 = beyond.map_or(r.len(), |count| last.0 + count);
    }
    halves
}

/// The standard deviation of the noise of a record: that of its third differences, which a smooth motion hardly has.
pub fn noise(values: &[f64]) -> f64 {
    let third: Vec<f64> =
        values.windows(4).map(|it| (it[3] - 3.0 * it[2] + 3.0 * it[1] - it[0]).abs()).collect();
    if third.is_empty() {
        return 0.0;
    }
    // Third differences of independent noise have 20 times its variance; 0.6745 is the median of |x| of a normal x.
    median(&third) / (0.674_489_75 * 20.0_f64.sqrt())
}

/// Stiffness and damping by the times and the displacements of turning points, with the noise of the record and its samples.
fn by_decrement(turns: &Turns, m1: f64, noise: (f64, usize)) -> Result<[Estimate; 2], String> {
    let least = BETWEEN_SAMPLES * turns.heights[0].abs();
    let noise = (noise.0.hypot(least), noise.1);
    let (fall, heights) = fall(turns, noise)?;
    let half = half_period(turns, &heights, noise).ok_or("the turning points lie at one time")?;
    let pi = std::f64::consts::PI;
    let gamma = fall.value / half.value;
    let omega = pi / half.value;
    let gamma_error =
        (fall.standard_error / half.value).hypot(gamma * half.standard_error / half.value);
    let omega_error = omega * half.standard_error / half.value;
    let k1 = m1 * (omega * omega + gamma * gamma);
    let k1_error = 2.0 * m1 * (omega * omega_error).hypot(gamma * gamma_error);
    let c = Estimate::of_student(2.0 * m1 * gamma, 2.0 * m1 * gamma_error, noise.1);
    Ok([Estimate::of_student(k1, k1_error, noise.1), c])
}

/// The logarithmic decrement of half a period, with the fitted heights.
fn fall(turns: &Turns, (noise, samples): (f64, usize)) -> Result<(Estimate, Vec<f64>), String> {
    let first = turns.numbers[0];
    let places = || turns.numbers.iter().zip(&turns.heights);
    let wave = |number: f64, it: &[f64]| {
        let sign = if (number - first) % 2.0 == 0.0 { 1.0 } else { -1.0 };
        (sign, sign * (-it[1] * (number - first)).exp())
    };
    let model = |it: &[f64]| {
        let rows = places().map(|(&number, height)| {
            let (_, share) = wave(number, it);
            let by_fall = -it[0] * (number - first) * share;
            (it[0] * share + it[2] - height, vec![share, by_fall, 1.0])
        });
        let (values, slopes) = rows.unzip();
        Some(Residuals { values, slopes })
    };
    let last = turns.heights.len() - 1;
    let ratio = (turns.heights[0] / turns.heights[last]).abs();
    let start = [turns.heights[0], ratio.ln() / (turns.numbers[last] - first), 0.0];
    let none = "no decay can be fitted to the turning points";
    let fit = fit(&model, &start, &Search::free(3)).ok_or(none)?;
    let deviation = noise * turns.height_deviation;
    let spread = spread(fit.sum_of_squares, fit.degrees_of_freedom, (deviation, samples));
    let error = fit.covariance.inverse_curvature[(1, 1)].sqrt() * spread;
    let heights = turns.numbers.iter().map(|it| fit.parameters[0] * wave(*it, &fit.parameters).1);
    let heights = heights.map(f64::abs).collect();
    Ok((Estimate::of_student(fit.parameters[1], error, samples), heights))
}

/// Half a period, by the line through the times of turning points, weighted by the squares of their heights.
fn half_period(turns: &Turns, heights: &[f64], (noise, samples): (f64, usize)) -> Option<Estimate> {
    let weights: Vec<f64> = heights.iter().map(|it| it * it).collect();
    let all: f64 = weights.iter().sum();
    let mean = |of: &[f64]| weights.iter().zip(of).map(|(w, it)| w * it).sum::<f64>() / all;
    let (number, time) = (mean(&turns.numbers), mean(&turns.times));
    let each = || weights.iter().zip(turns.numbers.iter().zip(&turns.times));
    let square: f64 = each().map(|(w, (n, _))| w * (n - number).powi(2)).sum();
    let product: f64 = each().map(|(w, (n, t))| w * (n - number) * (t - time)).sum();
    let half = product / square;
    let left: f64 = each().map(|(w, (n, t))| w * (t - time - half * (n - number)).powi(2)).sum();
    let deviation = noise * turns.time_deviation;
    let spread = spread(left, turns.times.len() - 2, (deviation, samples));
    let error = spread / square.sqrt();
    (half > 0.0 && error.is_finite()).then(|| Estimate::of_student(half, error, samples))
}

/// The standard deviation of what was fitted with this sum of squares: the expected one, or that of the residuals where they are
/// too large for it.
fn spread(sum: f64, freedom: usize, (expected, samples): (f64, usize)) -> f64 {
    if freedom == 0 {
        return expected;
    }
    let found = sum / freedom as f64;
    let chance = chance_of_ratio(found / (expected * expected), [freedom, samples]);
    if chance < SCATTERED { found.sqrt() } else { expected }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_of_the_decay_are_those_of_differences() {
        let at = [1420.0, 3.89, 2e-3, -5e-4, 1e-4];
        let (_, slopes) = decay(0.11, &at, 0.0321);
        for i in 0..5 {
            let step = 1e-6 * at[i].abs();
            let [mut above, mut below] = [at, at];
            above[i] += step;
            below[i] -= step;
            let by = (decay(0.11, &above, 0.0321).0 - decay(0.11, &below, 0.0321).0) / (2.0 * step);
            assert!((by - slopes[i]).abs() <= 1e-7 * slopes[i].abs(), "{i}: {by} {}", slopes[i]);
        }
    }

    #[test]
    fn an_exact_decay_gives_its_constants() {
        let times: Vec<f64> = (0..800).map(|i| 5e-4 * f64::from(i)).collect();
        let rest = 1e-4;
        // Held, then let go at t = 0.02 s.
        let (k1, c, m1): (f64, f64, f64) = (1420.0, 3.89, 0.11);
        let gamma = c / (2.0 * m1);
        let omega = (k1 / m1 - gamma * gamma).sqrt();
        let r: Vec<f64> = times
            .iter()
            .map(|t| {
                let (value, _) =
                    decay(m1, &[k1, c, 2e-3, 2e-3 * gamma / omega, rest], (t - 0.02).max(0.0));
                value
            })
            .collect();
        let found = free_vibration(&times, &r, m1).expect("a decay");
        assert!((found.by_decay[0].value / k1 - 1.0).abs() < 1e-8, "{found:?}");
        assert!((found.by_decay[1].value / c - 1.0).abs() < 1e-8, "{found:?}");
        assert!((found.by_decrement[0].value / k1 - 1.0).abs() < 0.01, "{found:?}");
        assert!((found.by_decrement[1].value / c - 1.0).abs() < 0.02, "{found:?}");
        assert!((found.decay(m1, 0.05) - r[100]).abs() < 1e-9);
        let flat = vec![0.0; times.len()];
        assert!(free_vibration(&times, &flat, m1).is_err());
    }
}
