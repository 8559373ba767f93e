//! Recordings from a simulation, with noise, quantisation and sampling as stated, to try an identification without a rig.

use std::f64::consts::TAU;

use fastrand::Rng;

use super::friction::coast_down;
use crate::capsule::sampled::{Signal, Started, sampled};
use crate::capsule::{CapsuleParameters as _, Parameter};
use crate::description::Parameters;
use crate::flow::Reason;

/// Relative local error of the steps of the simulation.
const TOLERANCE: f64 = 1e-12;

/// A sensor: what it sees, and what it does to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// What it sees.
    pub signal: Signal,
    /// Standard deviation of its noise [SI].
    pub noise: f64,
    /// The steps of its values [SI]; none where it is zero.
    pub quantum: f64,
}

/// Independent normal numbers, the same for the same seed on any machine.
#[derive(Debug, Clone)]
pub struct Noise(Rng);

impl Noise {
    /// Those of a seed.
    pub fn new(seed: u64) -> Noise {
        Noise(Rng::with_seed(seed))
    }

    /// The next one, with this standard deviation, by Box and Muller.
    pub fn normal(&mut self, deviation: f64) -> f64 {
        let (radius, turn) = (1.0 - self.0.f64(), self.0.f64());
        deviation * libm::sqrt(-2.0 * libm::log(radius)) * libm::cos(TAU * turn)
    }
}

/// What sensors record of a motion at `times` since its start [s], by sensor.
///
/// Fails where the motion cannot be followed.
pub fn recorded(
    motion: &Started,
    times: &[f64],
    sensors: &[Sensor],
    seed: u64,
) -> Result<Vec<Vec<f64>>, Reason> {
    let signals: Vec<Signal> = sensors.iter().map(|it| it.signal).collect();
    let mut samples = sampled(motion, times, &signals, &[], TOLERANCE)?.values;
    let mut noise = Noise::new(seed);
    for (sensor, values) in sensors.iter().zip(&mut samples) {
        for value in values {
            let noisy = *value + noise.normal(sensor.noise);
            *value = match sensor.quantum > 0.0 {
                true => (noisy / sensor.quantum).round() * sensor.quantum,
                false => noisy,
            };
        }
    }
    Ok(samples)
}

/// The simple tests of a rig, as the paper's section 3 has them, with the scatter that a laboratory has.
#[derive(Debug, Clone, PartialEq)]
pub struct SimpleTests {
    /// Free vibration: times [s] and displacements [m] of the mass, held for a while and let go.
    pub free_vibration: [Vec<f64>; 2],
    /// Static test of the stop: loads [N] and deflections [m].
    pub static_force: [Vec<f64>; 2],
    /// Pull tests: the masses that just move the rig [kg].
    pub pull: Vec<f64>,
    /// Coasting tests: initial speeds [m/s] and distances [m].
    pub coasting: [Vec<f64>; 2],
    /// The motor: currents [A] and forces [N].
    pub motor: [Vec<f64>; 2],
}

/// How the simple tests are carried out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Laboratory {
    /// Samples of the free vibration per second [Hz].
    pub rate: f64,
    /// Noise of the sensor of r [m].
    pub r_noise: f64,
    /// Noise of the sensor of the deflection [m].
    pub deflection_noise: f64,
    /// Relative scatter of pulled masses.
    pub pull_scatter: f64,
    /// Relative scatter of speeds and distances.
    pub coasting_scatter: f64,
    /// Noise of the force on the motor [N].
    pub force_noise: f64,
    /// Force per current of the motor [N/A].
    pub motor_constant: f64,
}

impl Default for Laboratory {
    /// Hall sensors of 20 um, an LVDT of 10 um, scatters of 2 % and 1 %, a force gauge of 50 mN, a motor of 5 N/A.
    fn default() -> Self {
        Laboratory {
            rate: 1000.0,
            r_noise: 20e-6,
            deflection_noise: 10e-6,
            pull_scatter: 0.02,
            coasting_scatter: 0.01,
            force_noise: 0.05,
            motor_constant: 5.0,
        }
    }
}

/// Duration of a free vibration, and how long the mass is held before it [s].
const FREE_VIBRATION: [f64; 2] = [0.5, 0.05];
/// Where the mass is let go, and the largest deflection of the stop [m].
const DISPLACEMENTS: [f64; 2] = [2e-3, 3e-3];
/// Loads, pulls, coasting tests and currents.
const COUNTS: [u32; 4] = [15, 5, 12, 21];
/// Slowest and fastest start of a coasting test [m/s].
const SPEEDS: [f64; 2] = [0.05, 1.5];
/// Largest current [A].
const CURRENT: f64 = 1.0;

/// The simple tests of a capsule with these parameters.
///
/// The capsule breaks away at max(mu_s, 2 mu_d) times its weight, which is what a pull test sees; the stop is linear, and the
/// capsule coasts under the Coulomb-Stribeck law.
pub fn simple_tests(parameters: &Parameters, laboratory: &Laboratory, seed: u64) -> SimpleTests {
    let mut noise = Noise::new(seed);
    let [loads, pulls, coasts, currents] = COUNTS;

    let samples = (FREE_VIBRATION[0] * laboratory.rate) as u32;
    let times: Vec<f64> = (0..samples).map(|i| f64::from(i) / laboratory.rate).collect();
    let r = times.iter().map(|t| released(parameters, t - FREE_VIBRATION[1]));
    let r: Vec<f64> = r.map(|r| r + noise.normal(laboratory.r_noise)).collect();

    let greatest = parameters[Parameter::K2] * DISPLACEMENTS[1];
    let forces: Vec<f64> = (0..loads).map(|i| greatest * share(i, loads)).collect();
    let deflections = forces.iter().map(|force| force / parameters[Parameter::K2]);
    let deflections =
        deflections.map(|it| it + noise.normal(laboratory.deflection_noise)).collect();

    let breaking = parameters.break_away() / parameters[Parameter::G];
    let pull = (0..pulls).map(|_| breaking * (1.0 + noise.normal(laboratory.pull_scatter)));
    let pull: Vec<f64> = pull.collect();

    let coasting = coasting_tests(parameters, coasts, laboratory.coasting_scatter, &mut noise);

    let current: Vec<f64> =
        (0..currents).map(|i| CURRENT * (2.0 * share(i, currents) - 1.0)).collect();
    let force = current.iter().map(|it| laboratory.motor_constant * it);
    let force = force.map(|it| it + noise.normal(laboratory.force_noise)).collect();
    SimpleTests {
        free_vibration: [times, r],
        static_force: [forces, deflections],
        pull,
        coasting,
        motor: [current, force],
    }
}

/// Speeds and distances of so many coasting tests, each with this relative scatter.
fn coasting_tests(
    parameters: &Parameters,
    count: u32,
    scatter: f64,
    noise: &mut Noise,
) -> [Vec<f64>; 2] {
    let [mu_d, v_s, g] = [Parameter::MuD, Parameter::Vs, Parameter::G].map(|it| parameters[it]);
    let [mut speeds, mut distances] = [Vec::new(), Vec::new()];
    for i in 0..count {
        let speed = SPEEDS[0] * (SPEEDS[1] / SPEEDS[0]).powf(share(i, count));
        let (distance, _) = coast_down(speed, mu_d, v_s, g);
        speeds.push(speed * (1.0 + noise.normal(scatter)));
        distances.push(distance * (1.0 + noise.normal(scatter)));
    }
    [speeds, distances]
}

/// How far test `i` of so many is from the first to the last.
fn share(i: u32, count: u32) -> f64 {
    f64::from(i) / f64::from(count - 1)
}

/// The displacement of the mass that was let go at rest so long ago [s], on a capsule that is held [m].
fn released(parameters: &Parameters, time: f64) -> f64 {
    let [m1, k1, c] = [Parameter::M1, Parameter::K1, Parameter::C].map(|it| parameters[it]);
    let gamma = c / (2.0 * m1);
    let square = k1 / m1 - gamma * gamma;
    let time = time.max(0.0);
    let decay = libm::exp(-gamma * time);
    // Beyond critical damping sin and cos become sinh and cosh.
    let (cos, sin_over) = if square > 0.0 {
        let omega = square.sqrt();
        (libm::cos(omega * time), libm::sin(omega * time) / omega)
    } else {
        let rate = (-square).sqrt().max(1e-9);
        (libm::cosh(rate * time), libm::sinh(rate * time) / rate)
    };
    DISPLACEMENTS[0] * decay * (cos + gamma * sin_over)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_normal_and_the_same_for_a_seed() {
        let mut noise = Noise::new(3);
        let all: Vec<f64> = (0..20_000).map(|_| noise.normal(2.0)).collect();
        let mean = all.iter().sum::<f64>() / 2e4;
        let deviation = (all.iter().map(|it| it * it).sum::<f64>() / 2e4).sqrt();
        assert!(mean.abs() < 0.05 && (deviation - 2.0).abs() < 0.05, "{mean} {deviation}");
        let beyond = all.iter().filter(|it| it.abs() > 1.96 * 2.0).count();
        assert!((900..1100).contains(&beyond), "{beyond}");
        assert_eq!(Noise::new(3).normal(2.0), all[0]);
    }

    #[test]
    fn sensors_round_to_their_steps() {
        let motion =
            Started { parameters: Parameters::default(), start: Default::default(), phase: 0.0 };
        let times: Vec<f64> = (0..50).map(|i| 1e-3 * f64::from(i)).collect();
        let sensor = Sensor { signal: Signal::R, noise: 0.0, quantum: 1e-5 };
        let found = recorded(&motion, &times, &[sensor], 1).expect("followed");
        let exact =
            sampled(&motion, &times, &[Signal::R], &[], TOLERANCE).expect("followed").values;
        for (found, exact) in found[0].iter().zip(&exact[0]) {
            assert!((found - exact).abs() <= 0.5e-5 + 1e-12);
            assert!((found / 1e-5 - (found / 1e-5).round()).abs() < 1e-6);
        }
    }
}
