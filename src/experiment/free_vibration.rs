//! Stiffness and damping from the free vibration of the mass, in two methods.

use super::estimate::Estimate;
use super::least_squares::{Residuals, Search, fit};
use super::line::line;
use super::recording::median;
use super::smoothing::{Window, smoothed};

/// Crossings of the rest position and turning points count above so many standard deviations of the noise.
const CLEAR: f64 = 5.0;
/// So small a share of the largest displacement does not count: errors of the rest position are felt there.
const SMALL: f64 = 0.02;
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

    /// How far the two methods differ in stiffness and in damping, in standard errors of the first.
    pub fn disagreement(&self) -> [f64; 2] {
        [0, 1].map(|i| {
            let (first, second) = (self.by_decrement[i], self.by_decay[i]);
            (first.value - second.value).abs() / first.standard_error.hypot(second.standard_error)
        })
    }
}

/// Stiffness and damping from a record of the displacement `r` [m] of the mass `m1` [kg] that was let go at rest, on a
/// capsule that does not move.
///
/// # Method
///
/// The first method is the paper's: with half a period D between turning points whose heights fall by the factor q,
/// `gamma = -ln(q)/D`, `omega_d = pi/D`, `k1 = m1 (omega_d^2 + gamma^2)`, `c = 2 m1 gamma`. D and q come from straight
/// lines through the times and the logarithms of the heights of the turning points of the smoothed record. The second method
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
    let by_decrement = by_decrement(&turns, m1)?;
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
    let [k1, c] = by_decrement.map(|it| it.value);
    let swing = turns.heights[0] * -(r[first - 1] - turns.rest).signum();
    let start = [k1, c, 0.0, swing, turns.rest];
    let fit = fit(&model, &start, &Search::free(5)).ok_or("the decay cannot be fitted")?;
    let estimate = |i: usize| {
        Estimate::of_student(fit.parameters[i], fit.standard_error(i), fit.degrees_of_freedom)
    };
    Ok(FreeVibration {
        by_decrement,
        by_decay: [estimate(0), estimate(1)],
        rest: fit.parameters[4],
        scatter: fit.residual_deviation(),
        noise: noise(&r[first..]),
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
    /// Distances from the rest position [m].
    heights: Vec<f64>,
    rest: f64,
    /// The sample after which the mass is certainly free: where it first passes its rest position.
    first_index: usize,
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
    let shortest = halves.iter().skip(1).map(|half| half.1 - half.0).min().unwrap_or(0);
    let samples = ((shortest / 3) | 1).max(5).min(r.len() - 1 + r.len() % 2);
    let window = Window { samples, order: 3 };
    let read = |derivative| {
        smoothed(times, r, window, derivative).map_err(|why| format!("cannot be smoothed: {why}"))
    };
    let (smooth, slopes) = (read(0)?, read(1)?);
    let mut turns = Turns {
        numbers: Vec::new(),
        times: Vec::new(),
        heights: Vec::new(),
        rest,
        first_index: halves[1].0,
    };
    // The first is where the mass was let go, perhaps held before: it is no turning point of the decay.
    for (number, &(from, to)) in halves.iter().enumerate().skip(1) {
        let away = |i: &usize| (smooth[*i] - rest).abs();
        let Some(top) = (from..to).max_by(|a, b| away(a).total_cmp(&away(b))) else { continue };
        let Some(at) = [top.saturating_sub(1), top].into_iter().find(|&i| {
            i + 1 < r.len() && slopes[i] * slopes[i + 1] <= 0.0 && slopes[i] != slopes[i + 1]
        }) else {
            continue;
        };
        let share = slopes[at] / (slopes[at] - slopes[at + 1]);
        let time = times[at] + share * (times[at + 1] - times[at]);
        let height = smooth[at] + share * (smooth[at + 1] - smooth[at]) - rest;
        turns.numbers.push(number as f64);
        turns.times.push(time);
        turns.heights.push(height.abs());
    }
    if turns.times.len() + 1 < LEAST_TURNS { Err(few.to_owned()) } else { Ok(turns) }
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

/// Stiffness and damping by the lines through times and logarithms of heights.
fn by_decrement(turns: &Turns, m1: f64) -> Result<[Estimate; 2], String> {
    let logs: Vec<f64> = turns.heights.iter().map(|it| it.ln()).collect();
    let few = "the turning points lie at one time";
    let half = line(&turns.numbers, &turns.times).ok_or(few)?.slope;
    let fall = line(&turns.numbers, &logs).ok_or(few)?.slope;
    let pi = std::f64::consts::PI;
    let gamma = -fall.value / half.value;
    let omega = pi / half.value;
    let gamma_error =
        (fall.standard_error / half.value).hypot(gamma * half.standard_error / half.value);
    let omega_error = omega * half.standard_error / half.value;
    let k1 = m1 * (omega * omega + gamma * gamma);
    let k1_error = 2.0 * m1 * (omega * omega_error).hypot(gamma * gamma_error);
    let freedom = turns.times.len() - 2;
    let c = Estimate::of_student(2.0 * m1 * gamma, 2.0 * m1 * gamma_error, freedom);
    Ok([Estimate::of_student(k1, k1_error, freedom), c])
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
