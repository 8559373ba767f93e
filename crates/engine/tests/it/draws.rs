//! Cases drawn at random over everything that users vary, and all of them settled side by side.

use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{Machine, Outcome, Protocol};
use capsulemap_models::capsule::description::CAPSULE_OVER_FOLDS;
use capsulemap_models::capsule::general::balance::Balance;
use capsulemap_models::capsule::{
    CapsuleParameters as _, CapsuleState as _, Case, DriveKind, Orbit, Parameter, Parameters,
    Reaction, Release, Resistance, State, settle_all,
};
use capsulemap_models::description;
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
        ]);
        let drag = [random.logarithmic(1e-2, 10.0), random.or_least(0.0, 30.0)];
        if law == Resistance::Medium {
            (parameters[Parameter::C1], parameters[Parameter::C2]) = (drag[0], drag[1]);
        }
        parameters.resist_by(law);
        let phase = random.uniform(0.0, 2.0 * std::f64::consts::PI);
        let rests = random.uniform(0.0, 1.0) < 0.25;
        let y2 = random.uniform(-1.0, 1.0);
        let start = State::of([
            random.uniform(-1e-2, 1e-2),
            random.uniform(-1.0, 1.0),
            0.0,
            if rests { 0.0 } else { y2 },
        ]);
        Case::at_section(parameters, start, phase)
    };
    (0..count).map(|_| draw()).collect()
}

/// Members of the family over the whole box that users may set, under one law of resistance: each key is given in some of them.
pub fn members(count: usize, seed: u64, law: Resistance) -> Vec<Case> {
    let (mut shapes, mut values) = (Random::new(seed ^ 0x5ead), Random::new(seed ^ 0x7a1e));
    let mut cases = wide(count, seed, law);
    for case in &mut cases {
        draw_member(&mut case.parameters, &mut shapes, &mut values);
        start_before_stop(case);
    }
    cases
}

/// Puts a start behind a rigid stop as far before it.
fn start_before_stop(case: &mut Case) {
    let gap = case.parameters[Parameter::Delta];
    if case.parameters.shape().is_rigid() {
        let State { r, y1, x2, y2, .. } = State::from(&case.start);
        case.start = State::of([if r > gap { 2.0 * gap - r } else { r }, y1, x2, y2]).into();
    }
}

/// The same of one shape, which the seed decides.
pub fn alike(count: usize, seed: u64, law: Resistance) -> Vec<Case> {
    let mut values = Random::new(seed ^ 0x7a1e);
    let mut cases = wide(count, seed, law);
    for case in &mut cases {
        draw_member(&mut case.parameters, &mut Random::new(seed ^ 0x5ead), &mut values);
        start_before_stop(case);
    }
    cases
}

/// The same capsules over folds, at random places of them, but those that get too fast: each fold that is passed takes steps.
pub fn over_folds(cases: Vec<Case>, seed: u64) -> Vec<Case> {
    let mut random = Random::new(seed ^ 0xf01d);
    let cases = cases.into_iter().filter(|case| stays_slow(&case.parameters));
    cases.map(|case| over_folds_of(case, &mut random)).collect()
}

/// Whether a capsule gains at most a tenth of a metre per second in a period from what is not held, and its periods are short.
fn stays_slow(p: &Parameters) -> bool {
    let (balance, mass) = (Balance::of(p), p[Parameter::M1] + p[Parameter::M2]);
    let gained = balance.mean.abs() * p.drive_period() / mass;
    p.frequency() >= 10.0 && balance.holds() && (gained < 0.1 || balance.sliding.is_finite())
}

/// The same capsule over random folds.
fn over_folds_of(case: Case, random: &mut Random) -> Case {
    let mut parameters = case.parameters.of_extension(&CAPSULE_OVER_FOLDS);
    // A motion of 1 m/s passes one to ten of them in a period.
    parameters[Parameter::FoldSpacing] = parameters.drive_period() * random.logarithmic(0.1, 1.0);
    parameters[Parameter::FoldFriction] = random.or_least(0.0, 2.0);
    parameters[Parameter::FoldForce] = random.or_least(0.0, 0.5) * parameters.normal_load();
    parameters[Parameter::FoldSharpness] = random.or_least(0.0, 10.0);
    let State { r, y1, x2, y2, .. } = case.start.capsule();
    let start =
        description::State::new(&CAPSULE_OVER_FOLDS, &[r, y1, x2, y2, random.uniform(0.0, 1.0)]);
    Case { parameters, start, ..case }
}

/// Makes a capsule a member of the family: what its equations have from `shapes`, with what from `values`.
fn draw_member(p: &mut Parameters, shapes: &mut Random, values: &mut Random) {
    draw_drive(p, shapes, values);
    draw_parts(p, shapes, values);
}

/// Draws how a member is driven.
fn draw_drive(p: &mut Parameters, shapes: &mut Random, random: &mut Random) {
    let (_, kind) = DriveKind::NAMES[shapes.uniform(0.0, 7.0) as usize];
    p.drive_by(kind);
    if shapes.uniform(0.0, 1.0) < 0.5 {
        p.react_on(Reaction::Capsule);
    }
    let p_d = p[Parameter::Pd];
    let duty = random.uniform(0.02, 0.98);
    let rise = random.uniform(0.02, 0.98) * duty.min(1.0 - duty);
    let first = random.uniform(0.02, 0.98);
    let all = [
        (Parameter::Xi1, random.uniform(-1e-2, 1e-2)),
        (Parameter::Xi2, random.uniform(-5e-3, 5e-3)),
        (Parameter::Stroke, random.uniform(1e-3, 2e-2)),
        (Parameter::Share1, first),
        (Parameter::Share2, random.uniform(0.02, 0.98) * (1.0 - first)),
        (Parameter::Duty, duty),
        (Parameter::Rise, rise),
        (Parameter::PLow, random.uniform(-1.0, 0.5) * p_d),
        (Parameter::P0, random.uniform(-0.3, 0.3) * p_d),
        (Parameter::P2, random.uniform(-1.0, 1.0) * p_d),
        (Parameter::Phase2, random.uniform(-10.0, 10.0)),
    ];
    for (parameter, value) in all {
        if p.shape().no_effect(parameter).is_none() {
            p[parameter] = value;
        }
    }
    let period = p.drive_period() * random.uniform(0.5, 2.0);
    if shapes.uniform(0.0, 1.0) < 0.3 {
        p[Parameter::Period] = period;
    }
}

/// Draws stops, springs and ground of a member; each part is there in a third of them.
fn draw_parts(p: &mut Parameters, shapes: &mut Random, random: &mut Random) {
    let load = p.normal_load();
    let all: [(Parameter, f64); 21] = [
        (Parameter::Incline, random.uniform(-0.6, 0.6)),
        (Parameter::Load, random.uniform(-0.4, 0.4) * load),
        (Parameter::PreloadGap, random.uniform(-2e-3, 2e-3)),
        (Parameter::Restitution, random.or_least(0.0, 1.0)),
        (Parameter::K3, random.logarithmic(1e2, 1e6)),
        (Parameter::Delta3, random.or_least(0.0, 1e-2)),
        (Parameter::K2Damping, random.logarithmic(1e-2, 30.0)),
        (Parameter::K3Damping, random.logarithmic(1e-2, 30.0)),
        (Parameter::K1Cubic, random.logarithmic(1e5, 1e8)),
        (Parameter::K2Cubic, random.logarithmic(1e6, 1e9)),
        (Parameter::MuSForward, random.or_least(0.0, 1.0)),
        (Parameter::MuSBackward, random.or_least(0.0, 1.0)),
        (Parameter::MuDForward, random.or_least(0.0, 1.0)),
        (Parameter::MuDBackward, random.or_least(0.0, 1.0)),
        (Parameter::Stribeck, random.or_least(0.0, 3.0)),
        (Parameter::C1, random.logarithmic(1e-2, 10.0)),
        (Parameter::C2, random.or_least(0.0, 30.0)),
        (Parameter::C1Forward, random.logarithmic(1e-2, 10.0)),
        (Parameter::C1Backward, random.logarithmic(1e-2, 10.0)),
        (Parameter::C2Forward, random.or_least(0.0, 30.0)),
        (Parameter::C2Backward, random.or_least(0.0, 30.0)),
    ];
    if shapes.uniform(0.0, 1.0) < 0.5 {
        p.release_by(Release::Force);
    }
    for (parameter, value) in all {
        let is_there = shapes.uniform(0.0, 1.0) < 0.3;
        let is_drag = matches!(parameter, Parameter::C1 | Parameter::C2);
        if is_there && (is_drag || p.shape().no_effect(parameter).is_none()) {
            p[parameter] = value;
        }
    }
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
        Case::at_section(parameters, State::of([r, y1, 0.0, y2]), uniform(0.0, 6.0))
    };
    (0..count).map(|_| draw()).collect()
}

/// Members of the family over the ranges in which the motion is rich.
pub fn rich_members(count: usize, seed: u64) -> Vec<Case> {
    let (mut shapes, mut values) = (Random::new(seed ^ 0x5ead), Random::new(seed ^ 0x7a1e));
    let mut cases = cases(count, seed);
    for case in &mut cases {
        draw_member(&mut case.parameters, &mut shapes, &mut values);
        start_before_stop(case);
    }
    cases
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
