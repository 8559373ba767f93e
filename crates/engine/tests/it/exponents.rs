//! Lyapunov exponents against a published one, against multipliers, and against two nearby trajectories.

use std::f64::consts::PI;

use capsulemap_engine::flow::{
    Field, Metric, NoEvent, Stroboscopic, Switched, System, Taylor, Zeros,
};
use capsulemap_engine::lane::{
    Dual, Instructions, Lane, Mask, ORDER, Series, SideBySide, elementary::sin_cos, series,
};
use capsulemap_engine::orbit::aperiodic::{Departure, follow_aperiodic, irregularity};
use capsulemap_engine::orbit::exponent::stretching;
use capsulemap_engine::orbit::return_map::Cycles;
use capsulemap_engine::orbit::{Outcome, Protocol, Trajectory};
use capsulemap_models::capsule::{
    Capsule, CapsuleCase as _, CapsuleParameters as _, CapsuleState as _, CapsuleSystem, Case,
    Filippov, Output, Parameter, State, settle,
};

use super::draws;

/// Duffing's oscillator with two wells, x'' = 0.3 cos t + x - x^3 - 0.2 x'; it has no modes and no guards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Duffing;

impl SideBySide for Duffing {
    type One = Duffing;
    fn splat(_one: &Duffing) -> Self {
        Duffing
    }
    fn lane(&self, _index: usize) -> Duffing {
        Duffing
    }
    fn put(&mut self, _index: usize, _one: &Duffing) {}
    fn take_lane(&mut self, _index: usize, _other: &Self) {}
}

impl<L: Lane> Switched<L> for Duffing {
    /// Place and velocity.
    type State = [L; 2];
    type Mode = ();
    /// Those and the square of the place.
    type Jet = Taylor<L, 3>;
    type Event = NoEvent;
    const GUARDS: usize = 0;

    #[inline(always)]
    fn period(&self) -> L {
        L::splat(2.0 * PI)
    }

    #[inline(always)]
    fn start(&self, _time: L, _state: &mut [L; 2]) {}

    #[inline(always)]
    fn expand(&self, _mode: &(), time: L, state: &[L; 2], jet: &mut Taylor<L, 3>) {
        let (mut s, mut c) = sin_cos(time);
        jet.begin(state);
        for k in 0..ORDER {
            let per = L::splat(series::INVERSE[k + 1]);
            jet[2][k] = series::product_term(&jet[0], &jet[0], k);
            let cube = series::product_term(&jet[2], &jet[0], k);
            let force = L::splat(0.3) * c + jet[0][k] - cube - L::splat(0.2) * jet[1][k];
            jet[0][k + 1] = jet[1][k] * per;
            jet[1][k + 1] = force * per;
            (c, s) = (-(s * per), c * per);
        }
    }

    #[inline(always)]
    fn pace<'a>(&self, jet: &'a Taylor<L, 3>) -> [&'a Series<L>; 2] {
        [&jet[0], &jet[1]]
    }

    #[inline(always)]
    fn watched(&self, _which: usize, _mode: &()) -> L::Mask {
        L::Mask::splat(false)
    }

    fn guard(&self, _which: usize, _mode: &(), _jet: &Taylor<L, 3>, _guard: &mut Series<L>) {}

    #[inline(always)]
    fn at(&self, jet: &Taylor<L, 3>, h: L) -> [L; 2] {
        jet.at(h)
    }

    #[inline(always)]
    fn motion(&self, jet: &Taylor<L, 3>, h: L) -> ([L; 2], [L; 2]) {
        jet.motion(h)
    }

    #[inline(always)]
    fn switch(
        &self,
        _which: usize,
        _due: L::Mask,
        _mode: &mut (),
        _state: &mut [L; 2],
        _zeros: &mut Zeros<L>,
        _time: L,
    ) -> L {
        L::splat(0.0)
    }

    #[inline(always)]
    fn lost(&self, [x, v]: &[L; 2]) -> L::Mask {
        !(*x + *v).abs().le(L::splat(f64::MAX))
    }
}

impl<L: Lane> Stroboscopic<L, 2> for Duffing {
    fn point(state: &[L; 2]) -> [L; 2] {
        *state
    }
    fn state(point: [L; 2]) -> [L; 2] {
        point
    }
}

impl Field for Duffing {
    type Coordinates = [f64; 2];

    fn coordinates(state: &[f64; 2]) -> [f64; 2] {
        *state
    }

    fn rates(&self, _mode: &(), time: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
        [v, 0.3 * libm::cos(time) + x - x * x * x - 0.2 * v]
    }

    fn weights(&self) -> [f64; 2] {
        [1.0, 1.0]
    }
}

impl System<2> for Duffing {
    /// It has none.
    type Parameter = ();
    type Event = NoEvent;
    type State<L: Lane> = [L; 2];
    type Mode<L: Lane> = ();
    type Single = Duffing;
    type In<L: Lane> = Duffing;
    type Observer = ();
    type Observers<L: Lane> = ();

    fn single(&self) -> Duffing {
        Duffing
    }

    fn system<L: Lane>(&self, _of: impl Fn(()) -> L) -> Duffing {
        Duffing
    }

    fn value(&self, _parameter: ()) -> f64 {
        f64::NAN
    }

    fn with(&self, _parameter: (), _value: f64) -> Self {
        Duffing
    }

    fn metric(&self) -> Metric<2> {
        Metric::new([1.0, 1.0])
    }

    fn observer(&self, _points: usize) {}
}

#[test]
fn the_duffing_oscillator_has_its_published_exponents() {
    let cycles = Cycles { count: 60_000, tolerance: 1e-10 };
    let (stretching, period) =
        stretching::<_, 2, 2>(&Duffing, Duffing.metric(), &[0.1, 0.1], &cycles)
            .expect("the integration continues");
    let [first, second] = stretching.exponents(period);
    assert!((first.value - 0.159).abs() < 0.001, "{first:?}");
    assert!(first.uncertainty < 0.001, "{first:?}");
    // The field's divergence is -0.2 everywhere.
    assert!((first.value + second.value + 0.2).abs() < 1e-6, "{first:?} {second:?}");
}

/// The period's exponent by stretching a direction cycle after cycle, without the multipliers.
#[test]
fn an_orbit_stretches_as_its_largest_multiplier_says() {
    let mut compared = 0;
    for case in draws::cases(120, 21) {
        let orbit = settle(&case.parameters, case.section_phase, &case.start, &Protocol::default());
        let &[first, second, _] = &orbit.certificate.multipliers[..] else { panic!("multipliers") };
        // A pair of equal magnitudes turns its directions for ever, and means settle slowly.
        if orbit.outcome != Outcome::Periodic || second.abs() > 0.7 * first.abs() {
            continue;
        }
        let p = &case.parameters;
        let capsule = case.read::<Filippov>().system;
        let system = capsule.constant::<Dual<f64, 1>>();
        let State { r, y1, y2, .. } = orbit.end.capsule();
        let count = 3200 * orbit.period;
        let cycles = Cycles { count, tolerance: 1e-12 };
        let metric = capsule.metric();
        let (stretching, period) = stretching::<_, 3, 1>(&system, metric, &[r, y1, y2], &cycles)
            .expect("the integration continues");
        let [exponent] = stretching.exponents(period);
        let ran = orbit.outputs[Output::LyapunovExponent];
        assert!(ran < 0.0, "{ran}");
        let scale = 1.0 / p.drive_period();
        assert!((exponent.value - ran).abs() < 1e-6 * scale, "{exponent:?} {ran}");
        compared += 1;
    }
    assert!(compared > 30, "{compared}");
}

#[test]
fn a_capsule_at_rest_answers_as_the_linear_oscillator_it_is() {
    let mut case = draws::cases(1, 1).remove(0);
    case.parameters[Parameter::Pd] = 0.0;
    let p = &case.parameters;
    let orbit = settle(p, 0.0, State::default(), &Protocol::default());
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    // Free vibration of the mass on the resting capsule decays at the rate c / (2 m1).
    let rate = -p[Parameter::C] / (2.0 * p[Parameter::M1]);
    let ran = orbit.outputs[Output::LyapunovExponent];
    assert!((ran / rate - 1.0).abs() < 1e-10, "{ran} {rate}");
}

/// Cases of a kind, with what they settle to.
fn chaotic(count: usize) -> Vec<(Case, [f64; 3])> {
    let protocol = Protocol::default();
    let cases = draws::cases(3000, 3);
    let orbits = draws::settled(&cases, &protocol, Instructions::widest());
    let chaotic = cases.into_iter().zip(orbits).filter(|(_, it)| it.outcome == Outcome::Chaotic);
    chaotic
        .map(|(case, it)| (case, [it.end.capsule().r, it.end.capsule().y1, it.end.capsule().y2]))
        .take(count)
        .collect()
}

/// Where systems depart from their points, with no limit of steps.
fn departures<'a>(
    starts: impl Iterator<Item = (&'a CapsuleSystem<Filippov>, [f64; 3])>,
) -> Vec<Departure<'a, CapsuleSystem<Filippov>, 3>> {
    starts.map(|(system, point)| Departure { system, point, max_steps: u64::MAX }).collect()
}

#[test]
fn neighbouring_trajectories_part_at_the_rate_of_the_exponent() {
    let cases = chaotic(6);
    let systems: Vec<CapsuleSystem<Filippov>> =
        cases.iter().map(|(case, _)| case.read().system).collect();
    let starts = cases.iter().map(|(_, start)| *start);
    let capsules = departures(systems.iter().zip(starts));
    let protocol = Protocol::default();
    let followed = follow_aperiodic(Instructions::widest(), &capsules, &protocol);
    for ((case, start), followed) in cases.iter().zip(followed) {
        let exponent = followed.expect("the integration continues").exponent;
        let (rate, spread) = parting(case, *start, 3000);
        let apart = (rate - exponent.value).abs();
        let allowed = 4.0 * exponent.uncertainty.hypot(spread);
        assert!(apart < allowed, "{rate} +- {spread}, {exponent:?}");
        assert!(rate > 0.0);
    }
}

#[test]
fn an_exponent_is_as_exact_as_the_study_wants_it() {
    let cases = chaotic(3);
    let systems: Vec<CapsuleSystem<Filippov>> =
        cases.iter().map(|(case, _)| case.read().system).collect();
    let starts = cases.iter().map(|(_, start)| *start);
    let capsules = departures(systems.iter().zip(starts));
    let with = |exponent_error: f64| {
        let protocol = Protocol { exponent_error, exponent_cycles: 100_000, ..Protocol::default() };
        let all = follow_aperiodic(Instructions::widest(), &capsules, &protocol);
        all.into_iter().map(|it| it.expect("the integration continues")).collect::<Vec<_>>()
    };
    let (coarse, fine) = (with(0.1), with(0.015));
    for (((case, start), coarse), fine) in cases.iter().zip(coarse).zip(fine) {
        for (found, wanted) in [(&coarse, 0.1), (&fine, 0.015)] {
            let exponent = found.exponent;
            assert!(exponent.uncertainty < wanted * exponent.value, "{exponent:?}");
            assert!(found.cycles < 100_000 && found.cycles % 128 == 0, "{}", found.cycles);
        }
        assert!(fine.cycles >= 2 * coarse.cycles, "{} {}", fine.cycles, coarse.cycles);
        // Two neighbouring trajectories know nothing of the linearised flow.
        let (rate, spread) = parting(case, *start, 10_000);
        let apart = (rate - fine.exponent.value).abs();
        assert!(
            apart < 4.0 * fine.exponent.uncertainty.hypot(spread),
            "{rate} +- {spread}, {fine:?}"
        );
    }
}

/// The rate at which a trajectory and another, put back to a distance of 1e-8 each cycle, part, and its
/// standard error over ten batches [1/s].
fn parting(case: &Case, start: [f64; 3], cycles: usize) -> (f64, f64) {
    let p = &case.parameters;
    let system = Capsule::single(p, case.section_phase);
    let period = p.drive_period();
    let scales = [p[Parameter::Omega], 1.0, 1.0];
    let distance = |difference: &[f64; 3]| {
        (0..3).map(|i| (difference[i] * scales[i]).powi(2)).sum::<f64>().sqrt()
    };
    let state = |[r, y1, y2]: [f64; 3]| State::of([r, y1, 0.0, y2]);
    let apart = 1e-8;
    let mut neighbour = start;
    neighbour[1] += apart;
    let mut first = Trajectory::new(&system, state(start), 1e-13);
    let mut second = Trajectory::new(&system, state(neighbour), 1e-13);
    let mut logs = Vec::new();
    for _ in 0..cycles {
        first.cycle(|_| ()).expect("the integration continues");
        second.cycle(|_| ()).expect("the integration continues");
        let (a, b) = (first.section(), second.section());
        let difference: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
        let now = distance(&difference);
        // Two motions that have become one are parted anew, along y1.
        let (stretch, direction) = if now == 0.0 {
            (1e-12, [0.0, 1.0, 0.0])
        } else {
            (now / apart, difference.map(|x| x / now))
        };
        logs.push(stretch.ln());
        second.leap(std::array::from_fn(|i| a[i] + apart * direction[i]));
    }
    let rates: Vec<f64> = logs
        .chunks(cycles / 10)
        .map(|batch| batch.iter().sum::<f64>() / (batch.len() as f64 * period))
        .collect();
    let mean = rates.iter().sum::<f64>() / rates.len() as f64;
    let squares: f64 = rates.iter().map(|rate| (rate - mean).powi(2)).sum();
    (mean, (squares / (rates.len() * (rates.len() - 1)) as f64).sqrt())
}

#[test]
fn smooth_means_tell_a_rotation_from_chaos() {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let rotation = |n: usize| {
        let angle = 2.0 * PI * golden * n as f64;
        [angle.cos() + 0.3 * (2.0 * angle).sin(), angle.sin(), (angle.cos()).exp()]
    };
    let rotation: Vec<[f64; 3]> = (0..2048).map(rotation).collect();
    let mut x = 0.3;
    let logistic: Vec<[f64; 3]> = (0..2048)
        .map(|_| {
            x = 4.0 * x * (1.0 - x);
            [x, 0.0, 0.0]
        })
        .collect();
    let metric = Metric::new([1.0; 3]);
    assert!(irregularity(&rotation, &metric, 1.0) < 1e-9);
    assert!(irregularity(&logistic, &metric, 1.0) > 1e-3);
}

#[test]
fn a_stretch_has_the_same_bits_by_any_instructions() {
    let cases = draws::cases(20, 13);
    let systems: Vec<CapsuleSystem<Filippov>> =
        cases.iter().map(|case| case.read().system).collect();
    let start =
        |case: &Case| [case.start.capsule().r, case.start.capsule().y1, case.start.capsule().y2];
    let capsules = departures(systems.iter().zip(cases.iter().map(start)));
    let protocol = Protocol { exponent_cycles: 200, ..Protocol::default() };
    let alone = follow_aperiodic(Instructions::Scalar, &capsules, &protocol);
    for instructions in Instructions::available() {
        let among = follow_aperiodic(instructions, &capsules, &protocol);
        assert_eq!(format!("{alone:?}"), format!("{among:?}"), "{}", instructions.name());
    }
}
