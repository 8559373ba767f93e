//! Cases drawn at random over everything that users vary, and all of them settled side by side.

use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{Machine, Outcome, Protocol};
use capsulemap_models::capsule::{
    CapsuleParameters as _, Case, Orbit, Parameter, Parameters, Resistance, State, settle_all,
};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// The parameters along which neighbours and axes are drawn.
pub const ALONG: [Parameter; 6] = [
    Parameter::Omega,
    Parameter::Pd,
    Parameter::K2,
    Parameter::Delta,
    Parameter::C,
    Parameter::MuS,
];

/// Uniform random numbers.
pub struct Random(ChaCha8Rng);

impl Random {
    /// Those of a seed.
    pub fn new(seed: u64) -> Self {
        Random(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Uniform between these.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in the logarithm.
    pub fn logarithmic(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.uniform(libm::log(low), libm::log(high)))
    }

    /// Uniform, but for one draw in sixteen that is the lower bound itself.
    pub fn or_least(&mut self, low: f64, high: f64) -> f64 {
        if self.uniform(0.0, 16.0) < 1.0 { low } else { self.uniform(low, high) }
    }
}

/// Parameters, phases and starts over the whole box that users may set, under one law of resistance; its
/// sides, such as no friction, are drawn too.
pub fn wide(count: usize, seed: u64, law: Resistance) -> Vec<Case> {
    let mut random = Random::new(seed);
    let mut draw = || {
        let mut parameters = Parameters::with(&[
            (Parameter::Omega, random.logarithmic(1.0, 300.0)),
            (Parameter::Pd, random.or_least(0.0, 15.0)),
            (Parameter::K2, random.logarithmic(1e2, 1e6)),
            (Parameter::Delta, random.or_least(0.0, 1e-2)),
            (Parameter::C, random.logarithmic(0.05, 10.0)),
            (Parameter::MuS, random.or_least(0.0, 1.0)),
            (Parameter::MuD, random.or_least(0.0, 1.0)),
            (Parameter::M2, random.logarithmic(0.05, 3.0)),
            (Parameter::Vs, random.logarithmic(1e-4, 5.0)),
            (Parameter::C1, random.logarithmic(1e-2, 10.0)),
            (Parameter::C2, random.or_least(0.0, 30.0)),
        ]);
        parameters.resist_by(law);
        let phase = random.uniform(0.0, 2.0 * std::f64::consts::PI);
        let rests = random.uniform(0.0, 1.0) < 0.25;
        let y2 = random.uniform(-1.0, 1.0);
        let start = State {
            r: random.uniform(-1e-2, 1e-2),
            y1: random.uniform(-1.0, 1.0),
            x2: 0.0,
            y2: if rests { 0.0 } else { y2 },
        };
        Case::at_section(parameters, start, phase)
    };
    (0..count).map(|_| draw()).collect()
}

/// Parameters and starts over the ranges in which the motion is rich.
pub fn cases(count: usize, seed: u64) -> Vec<Case> {
    let mut random = Random::new(seed);
    let mut uniform = |low, high| random.uniform(low, high);
    let mut draw = || {
        let mu_s = uniform(0.02, 0.66);
        let parameters = Parameters::with(&[
            (Parameter::Omega, uniform(15.0, 180.0)),
            (Parameter::Pd, uniform(0.5, 8.0)),
            (Parameter::K2, 10_f64.powf(uniform(3.0, 5.0))),
            (Parameter::Delta, uniform(0.0, 5e-3)),
            (Parameter::C, uniform(0.35, 4.0)),
            (Parameter::MuS, mu_s),
            (Parameter::MuD, mu_s * uniform(0.4, 1.0)),
            (Parameter::M2, uniform(0.2, 1.0)),
        ]);
        let (r, y1) = (uniform(-2e-3, 2e-3), uniform(-0.2, 0.2));
        let y2 = if uniform(0.0, 1.0) < 0.5 { 0.0 } else { uniform(-0.2, 0.2) };
        Case::at_section(parameters, State { r, y1, x2: 0.0, y2 }, uniform(0.0, 6.0))
    };
    (0..count).map(|_| draw()).collect()
}

/// What each case settles to, on one thread.
pub fn settled(cases: &[Case], protocol: &Protocol, instructions: Instructions) -> Vec<Orbit> {
    let machine = Machine { threads: Some(1), instructions: Some(instructions) };
    settle_all(cases, protocol, machine)
}

/// Whether an orbit is periodic and stable, and all its points are kept.
pub fn is_kept(orbit: &Orbit) -> bool {
    orbit.outcome == Outcome::Periodic
        && orbit.certificate.is_stable()
        && orbit.section.len() == orbit.period as usize
}
