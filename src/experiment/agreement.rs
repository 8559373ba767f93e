//! How a recorded and a simulated signal differ: in all, in shape, in sign and in unit.

use super::progression::own_progression;
use crate::capsule::sampled::Signal;

/// A signal varies if its standard deviation is above this share of its largest value.
const VARIES: f64 = 1e-9;
/// Signals whose correlation is below this have opposite signs, and above its magnitude one shape.
const OPPOSITE: f64 = -0.8;
/// Ratios of standard deviations that look like a unit a thousand times larger.
const THOUSAND: [f64; 2] = [400.0, 2500.0];

/// How a recording and a simulation differ in one signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Which signal.
    pub signal: Signal,
    /// As recorded [SI].
    pub recorded: Vec<f64>,
    /// As simulated, at the same times [SI].
    pub simulated: Vec<f64>,
    /// How far they are apart; none where the record does not vary.
    pub errors: Option<Errors>,
    /// What the record may have wrong.
    pub doubt: Option<Doubt>,
}

/// Root mean squares of what differs, over the standard deviation of the record; that of a displacement is about its own mean
/// progression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Of the difference.
    pub all: f64,
    /// Of the difference of displacements that are both without their own mean progression; the same as that of all where the
    /// signal is no displacement of the mass or the capsule.
    pub shape: f64,
}

/// What a record may have wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Doubt {
    /// Its sign: it goes down where the simulation goes up.
    Sign,
    /// Its unit: its values are so many times as large.
    Unit(f64),
}

/// Whether a signal advances with the capsule.
pub fn advances(signal: Signal) -> bool {
    matches!(signal, Signal::X1 | Signal::X2)
}

impl Difference {
    /// Between these samples under a drive of this `cycle` [s].
    pub fn new(
        signal: Signal,
        times: &[f64],
        cycle: f64,
        recorded: Vec<f64>,
        simulated: Vec<f64>,
    ) -> Difference {
        let own = [&recorded, &simulated].map(|values| {
            let slope = if advances(signal) { own_progression(times, values, cycle) } else { 0.0 };
            without_line(times, values, slope)
        });
        let spread = own.each_ref().map(|it| mean_square(it).sqrt());
        let varies = [(&recorded, spread[0]), (&simulated, spread[1])].map(|(values, spread)| {
            spread > VARIES * values.iter().fold(0.0, |most: f64, it| most.max(it.abs()))
        });
        let all = apart(&recorded, &simulated);
        let shape = if advances(signal) { apart(&own[0], &own[1]) } else { all };
        let errors = varies[0].then(|| Errors { all: all / spread[0], shape: shape / spread[0] });
        let doubt = (varies == [true; 2]).then(|| doubt(&own, spread)).flatten();
        Difference { signal, recorded, simulated, errors, doubt }
    }
}

/// What is wrong with a record beside a simulation, both about their means.
fn doubt([recorded, simulated]: &[Vec<f64>; 2], spread: [f64; 2]) -> Option<Doubt> {
    let product = recorded.iter().zip(simulated).map(|(a, b)| a * b).sum::<f64>();
    let correlation = product / (recorded.len() as f64 * spread[0] * spread[1]);
    let ratio = spread[0] / spread[1];
    let [least, greatest] = THOUSAND;
    if [ratio, 1.0 / ratio].iter().any(|it| (least..=greatest).contains(it)) {
        return Some(Doubt::Unit(ratio));
    }
    (correlation < OPPOSITE).then_some(Doubt::Sign)
}

/// Values less a line through the origin of this slope, and less the mean of what is left.
fn without_line(times: &[f64], values: &[f64], slope: f64) -> Vec<f64> {
    let left: Vec<f64> = times.iter().zip(values).map(|(t, value)| value - slope * t).collect();
    let mean = left.iter().sum::<f64>() / left.len() as f64;
    left.into_iter().map(|it| it - mean).collect()
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|it| it * it).sum::<f64>() / values.len() as f64
}

/// The root mean square of the differences.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    (a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / a.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The errors of a displacement beside one that advances by 10 mm/s, and what it may have wrong.
    fn of(signal: Signal, recorded: impl Fn(f64, f64) -> f64) -> (Option<Errors>, Option<Doubt>) {
        let times: Vec<f64> = (0..1000).map(|i| 2e-3 * f64::from(i)).collect();
        let wave = |t: &f64| 1e-3 * (std::f64::consts::TAU * t / 0.1).sin();
        let simulated: Vec<f64> = times.iter().map(|t| 0.01 * t + wave(t)).collect();
        let recorded = times.iter().map(|t| recorded(*t, wave(t))).collect();
        let difference = Difference::new(signal, &times, 0.1, recorded, simulated);
        (difference.errors, difference.doubt)
    }

    #[test]
    fn another_speed_is_told_apart_from_another_shape() {
        let errors = of(Signal::X2, |t, wave| 0.05 * t + wave).0.expect("it varies");
        // 40 mm/s over two seconds about nothing: 46.2 mm rms over 0.707 mm.
        assert!(
            (errors.all / (0.04 * (4.0 / 3.0_f64).sqrt() / 1e-3 * 2f64.sqrt()) - 1.0).abs() < 0.01
        );
        assert!(errors.shape < 0.01, "{errors:?}");
        let errors = of(Signal::X2, |t, wave| 0.01 * t + 2.0 * wave).0.expect("it varies");
        assert!((errors.shape - 0.5).abs() < 0.01 && (errors.all - 0.5).abs() < 0.01);
    }

    #[test]
    fn constant_signals_and_wrong_signs_and_units_are_told() {
        assert_eq!(of(Signal::X2, |_, _| 1e-3), (None, None));
        assert_eq!(of(Signal::R, |_, _| 1e-3), (None, None));
        assert_eq!(of(Signal::X2, |t, wave| -0.01 * t - wave).1, Some(Doubt::Sign));
        assert!(
            matches!(of(Signal::X2, |t, wave| 10.0 * t + 1e3 * wave).1, Some(Doubt::Unit(it)) if (it - 1e3).abs() < 1.0)
        );
        assert_eq!(of(Signal::X2, |t, wave| 0.05 * t + 1.5 * wave).1, None);
    }
}
