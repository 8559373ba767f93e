//! The systems that the contract is checked on, and the contract of each.

use capsulemap_engine::orbit::{Case, Outcome, Protocol, settle};
use capsulemap_models::capsule::general::GeneralMode;
use capsulemap_models::capsule::{
    AsPrinted, CapsuleCase as _, CapsuleParameters as _, CapsuleSystem, Filippov, General,
    OverFolds, Parameter, Parameters, Reading, Resistance, State,
};
use capsulemap_models::face::engine_case;
use capsulemap_models::motion;

use super::super::directions::DIRECTIONS;
use super::super::draws::{self, Random};
use super::super::oscillators::{Impact, Of};
use super::subject::Subject;
use super::{lanes, maps, orbits, steps};

// Of an example only its system is used here, not its program.
#[path = "../../../examples/belt.rs"]
#[allow(dead_code)]
pub mod belt;
#[path = "../../../examples/duffing.rs"]
#[allow(dead_code)]
pub mod duffing;
#[path = "../../../examples/relief_valve.rs"]
#[allow(dead_code)]
mod relief_valve;

use belt::Belt;
use duffing::Duffing;
use relief_valve::Valve;

/// Cases from a random number generator.
fn drawn<M, const D: usize>(
    count: usize,
    seed: u64,
    mut one: impl FnMut(&mut Random) -> (M, M::State<f64>),
) -> Vec<Case<M, D>>
where
    M: Subject<D>,
{
    let mut random = Random::new(seed);
    let mut case = || {
        let (system, start) = one(&mut random);
        Case::new(system, start)
    };
    (0..count).map(|_| case()).collect()
}

/// A form of the capsule with random cases of it.
trait Drawn: Reading {
    /// The parameters along which its map is differentiated.
    fn along() -> Vec<Parameter>;
    /// Random cases over the whole box of one law, all of them alike.
    fn wide(count: usize, seed: u64, law: Resistance) -> Vec<motion::Case>;
    /// Random cases over the part of the box where motions are rich.
    fn rich(count: usize, seed: u64) -> Vec<motion::Case>;

    /// The size of the numbers that guard `which` is a small difference of.
    fn terms(p: &Parameters, which: usize, state: &State<f64>) -> f64 {
        let [r, y1, _, y2] = state.coordinates().map(f64::abs);
        let depth = r + p[Parameter::Delta].abs();
        if which == 0 {
            return depth;
        }
        p[Parameter::K1] * r + p[Parameter::K2] * depth + p[Parameter::C] * (y1 + y2)
    }
}

/// Those of capsules in which rest ends at the static limit in many cases.
fn rich(count: usize, seed: u64) -> Vec<motion::Case> {
    let mut cases = draws::cases(count, seed);
    for case in cases.iter_mut().step_by(2) {
        case.parameters[Parameter::MuD] *= 0.5;
    }
    cases
}

impl Drawn for Filippov {
    fn along() -> Vec<Parameter> {
        DIRECTIONS.to_vec()
    }
    fn wide(count: usize, seed: u64, law: Resistance) -> Vec<motion::Case> {
        draws::wide(count, seed, law)
    }
    fn rich(count: usize, seed: u64) -> Vec<motion::Case> {
        rich(count, seed)
    }
}

impl Drawn for AsPrinted {
    fn along() -> Vec<Parameter> {
        DIRECTIONS.to_vec()
    }
    /// As printed a capsule without static friction would switch at F = 0 without end.
    fn wide(count: usize, seed: u64, law: Resistance) -> Vec<motion::Case> {
        let sticks = |p: &Parameters| p.drag().static_limit > 0.0;
        let cases = draws::wide(2 * count, seed, law).into_iter();
        cases.filter(|case| law == Resistance::Medium || sticks(&case.parameters)).collect()
    }
    fn rich(count: usize, seed: u64) -> Vec<motion::Case> {
        rich(count, seed)
    }
}

impl Drawn for General {
    fn along() -> Vec<Parameter> {
        Parameter::ALL.to_vec()
    }
    fn wide(count: usize, seed: u64, law: Resistance) -> Vec<motion::Case> {
        draws::alike(count, seed, law)
    }
    fn rich(count: usize, seed: u64) -> Vec<motion::Case> {
        draws::rich_members(8 * count, seed)
    }
    /// The first guard is the time until an edge of the drive, the next two are those of the stops.
    fn terms(p: &Parameters, which: usize, state: &State<f64>) -> f64 {
        let [r, y1, _, y2] = state.coordinates().map(f64::abs);
        let depths = [Parameter::Delta, Parameter::Delta3].map(|gap| r + p[gap].abs());
        if which < 3 {
            return [p.drive_period(), depths[0], depths[1]][which];
        }
        let given = |it: Parameter| if p.is_given(it.into()) { p[it].abs() } else { 0.0 };
        let damping = p[Parameter::C] + given(Parameter::K2Damping) + given(Parameter::K3Damping);
        let cubic =
            given(Parameter::K1Cubic) * r.powi(3) + given(Parameter::K2Cubic) * depths[0].powi(3);
        let drive = p[Parameter::Pd]
            + [Parameter::P0, Parameter::PLow, Parameter::P2].map(given).iter().sum::<f64>();
        p[Parameter::K1] * (r + given(Parameter::PreloadGap))
            + p[Parameter::K2] * depths[0]
            + given(Parameter::K3) * depths[1]
            + damping * (y1 + y2)
            + cubic
            + drive
            + given(Parameter::Load)
            + p.normal_load()
    }
}

/// Members over folds.
impl Subject<4> for CapsuleSystem<OverFolds> {
    /// Where folds hold a capsule, some orbits lie at the end of places at which friction holds it.
    const CORNERS: usize = 2;

    /// Those of folds; the others are those of the family.
    fn directions() -> Vec<Parameter> {
        let of_folds = Parameter::OVER_FOLDS.iter().copied().filter(|it| it.is_of_folds());
        of_folds.chain([Parameter::Omega, Parameter::M2]).collect()
    }

    fn draws(count: usize, seed: u64) -> Vec<Case<Self, 4>> {
        let (_, law) = Resistance::NAMES[seed as usize % Resistance::NAMES.len()];
        let cases = draws::over_folds(draws::alike(4 * count, seed, law), seed);
        cases.iter().take(count).map(engine_case).collect()
    }

    fn rich_draws(count: usize, seed: u64) -> Vec<Case<Self, 4>> {
        let cases = draws::over_folds(draws::rich_members(8 * count, seed), seed);
        cases.iter().map(engine_case).collect()
    }

    /// Nothing is behind a rigid stop.
    fn may_start(&self, [r, ..]: &[f64; 4]) -> bool {
        !self.parameters.shape().is_rigid() || *r <= self.parameters[Parameter::Delta]
    }

    fn terms(&self, which: usize, _mode: &GeneralMode<f64>, state: &State<f64>) -> f64 {
        let folds = if which < 3 { 0.0 } else { self.parameters[Parameter::FoldForce] };
        let rise = 1.0 + self.parameters[Parameter::FoldFriction];
        rise * General::terms(&self.parameters, which, state) + folds
    }
}

impl<R: Drawn> Subject<3> for CapsuleSystem<R> {
    fn directions() -> Vec<Parameter> {
        R::along()
    }

    /// Every law of resistance has its turn.
    fn draws(count: usize, seed: u64) -> Vec<Case<Self, 3>> {
        let (_, law) = Resistance::NAMES[seed as usize % Resistance::NAMES.len()];
        let cases = R::wide(count, seed, law).into_iter();
        cases.take(count).map(|case| case.read()).collect()
    }

    fn rich_draws(count: usize, seed: u64) -> Vec<Case<Self, 3>> {
        R::rich(count, seed).iter().map(|case| case.read()).collect()
    }

    /// Nothing is behind a rigid stop.
    fn may_start(&self, [r, ..]: &[f64; 3]) -> bool {
        !self.parameters.shape().is_rigid() || *r <= self.parameters[Parameter::Delta]
    }

    fn terms(&self, which: usize, _mode: &R::Mode<f64>, state: &State<f64>) -> f64 {
        R::terms(&self.parameters, which, state)
    }
}

impl Subject<1> for Belt<f64> {
    fn directions() -> Vec<&'static str> {
        vec!["c", "a", "s", "v"]
    }

    fn draws(count: usize, seed: u64) -> Vec<Case<Self, 1>> {
        drawn(count, seed, |random| {
            let belt = Belt {
                c: random.or_least(0.0, 0.5),
                a: random.uniform(0.1, 2.0),
                s: random.logarithmic(0.05, 3.0),
                v: random.logarithmic(0.2, 3.0),
            };
            (belt, [random.uniform(-3.0, 3.0), random.uniform(-2.0, 3.0)])
        })
    }

    fn terms(&self, which: usize, _: &belt::Slip<f64>, [x, v]: &[f64; 2]) -> f64 {
        if which == 0 { v.abs() + self.v } else { 2.0 * self.a + self.c * self.v + x.abs() }
    }
}

impl Subject<2> for Impact<f64> {
    fn directions() -> Vec<Of> {
        vec![Of::K, Of::C, Of::Drive, Of::Omega, Of::Gravity, Of::Stop, Of::Restitution]
    }

    fn draws(count: usize, seed: u64) -> Vec<Case<Self, 2>> {
        drawn(count, seed, |random| {
            let impact = Impact {
                k: random.logarithmic(0.2, 5.0),
                c: random.logarithmic(0.02, 0.5),
                drive: random.or_least(0.0, 2.0),
                omega: random.logarithmic(0.3, 5.0),
                gravity: random.uniform(-0.5, 0.5),
                stop: random.uniform(-0.2, 1.5),
                restitution: random.uniform(0.3, 1.0),
            };
            let x = impact.stop - random.uniform(0.0, 2.0);
            (impact, [x, random.uniform(-2.0, 2.0)])
        })
    }

    fn terms(&self, _: usize, _: &(), [x, _]: &[f64; 2]) -> f64 {
        self.stop.abs() + x.abs()
    }
}

impl Subject<2> for Duffing<f64> {
    fn directions() -> Vec<&'static str> {
        vec!["c", "p"]
    }

    fn draws(count: usize, seed: u64) -> Vec<Case<Self, 2>> {
        drawn(count, seed, |random| {
            let duffing =
                Duffing { c: random.logarithmic(0.02, 0.5), p: random.or_least(0.0, 1.0) };
            (duffing, [random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0)])
        })
    }

    fn terms(&self, _: usize, _: &(), _: &[f64; 2]) -> f64 {
        0.0
    }
}

impl Subject<2> for Valve<f64, true> {
    fn directions() -> Vec<&'static str> {
        vec!["kappa", "delta", "beta", "r", "q"]
    }

    fn draws(count: usize, seed: u64) -> Vec<Case<Self, 2>> {
        drawn(count, seed, |random| {
            let valve = Valve {
                kappa: random.logarithmic(0.3, 3.0),
                delta: random.uniform(3.0, 20.0),
                beta: random.logarithmic(5.0, 40.0),
                r: random.uniform(0.3, 0.95),
                q: random.logarithmic(0.5, 12.0),
            };
            let start = [random.uniform(0.0, 6.0), random.uniform(-3.0, 3.0)];
            (valve, [start[0], start[1], random.uniform(1.0, 30.0)])
        })
    }

    fn terms(&self, _: usize, _: &(), [y1, ..]: &[f64; 3]) -> f64 {
        y1.abs()
    }
}

/// The contract of each system, law by law.
macro_rules! contract {
    ($($name:ident: $system:ty, $coordinates:literal;)*) => {$(
        mod $name {
            use super::*;

            #[test]
            fn a_motion_has_the_same_bits_in_every_lane() {
                lanes::courses::<$system, $coordinates>();
            }
            #[test]
            fn returns_have_the_same_bits_on_every_machine() {
                lanes::all_returns::<$system, $coordinates>();
            }
            #[test]
            fn orbits_have_the_same_bits_on_every_machine() {
                lanes::all_orbits::<$system, $coordinates>();
            }
            #[test]
            fn guards_keep_their_sign_between_events() {
                steps::guard_signs::<$system, $coordinates>();
            }

            #[test]
            fn guards_without_derivatives_have_their_bits() {
                steps::plain_guards::<$system, $coordinates>();
            }
            #[test]
            fn steps_satisfy_the_equations() {
                steps::defects::<$system, $coordinates>();
            }
            #[test]
            fn sections_are_where_they_are_defined() {
                steps::sections::<$system, $coordinates>();
            }
            #[test]
            fn no_return_is_missed() {
                steps::every_return::<$system, $coordinates>();
            }
            #[test]
            fn the_jacobian_is_that_of_differences() {
                maps::derivatives_along_points::<$system, $coordinates>();
            }
            #[test]
            fn derivatives_along_parameters_are_those_of_differences() {
                maps::derivatives_along_parameters::<$system, $coordinates>();
            }
            #[test]
            fn tolerances_agree_on_a_tame_motion() {
                maps::two_tolerances::<$system, $coordinates>();
            }
            #[test]
            fn certificates_hold_by_brute_force() {
                orbits::certificates::<$system, $coordinates>();
            }
        }
    )*};
}

contract! {
    capsule: CapsuleSystem<Filippov>, 3;
    capsule_as_printed: CapsuleSystem<AsPrinted>, 3;
    family_of_capsules: CapsuleSystem<General>, 3;
    family_over_folds: CapsuleSystem<OverFolds>, 4;
    belt_oscillator: Belt<f64>, 1;
    impact_oscillator: Impact<f64>, 2;
    duffing_oscillator: Duffing<f64>, 2;
    valve: Valve<f64, true>, 2;
}

/// A mass that comes to rest in the room while its belt slides on: its maxima decay by the damping, in closed
/// form, and no certificate may say otherwise.
#[test]
fn an_equilibrium_is_certified_with_its_decay_or_not_at_all() {
    let belt = Belt { c: 0.16, a: 0.85, s: 0.2, v: 1.6 };
    let orbit = settle(&Case::new(belt, [1.0, 0.0]), &Protocol::default());
    let rate = 0.5 * (belt.c - belt.a / belt.s * libm::exp(-belt.v / belt.s));
    let turn = 2.0 * std::f64::consts::PI / (1.0 - rate * rate).sqrt();
    let &[found] = &orbit.certificate.multipliers[..] else { panic!("multipliers") };
    let exact = libm::exp(-rate * turn);
    let is_right = (found.abs() - exact).abs() < 1e-6 && (orbit.duration - turn).abs() < 1e-6;
    assert!(orbit.outcome != Outcome::Periodic || is_right, "{found:?} {exact}: {orbit:?} {turn}");
}

/// The valve at two flow rates at which an impact takes it across its section, against another code (DOP853 at 1e-12
/// with events): the returns of a period, the mean time of one, and y1 and y3 at the highest.
#[test]
fn impacts_across_the_section_lose_no_return() {
    for (q, period, time, [y1, y3]) in [
        (1.55, 1, 1.374_418_627_585, [1.002_483_819, 4.742_118_370]),
        (1.0, 4, 1.220_925_595_692, [0.871_922_853, 4.217_318_873]),
    ] {
        let valve = Valve { kappa: 1.25, delta: 10.0, beta: 20.0, r: 0.8, q };
        let start = [1.0, 0.0, 10.0];
        let orbit = settle::<Valve<f64, true>, 2>(&Case::new(valve, start), &Protocol::default());
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, period), "{q}");
        assert!((orbit.duration - time).abs() < 1e-11, "{} {q}", orbit.duration);
        let highest = orbit.section.iter().max_by(|a, b| a[0].total_cmp(&b[0])).expect("a return");
        assert!((highest[0] - y1).abs() < 2e-9 && (highest[1] - y3).abs() < 2e-9, "{highest:?}");
    }
}
