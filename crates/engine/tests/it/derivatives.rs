//! The linearised return map, jumps included, against differences of the map itself.

use capsulemap_engine::flow::Stroboscopic;

use capsulemap_engine::lane::Dual;
use capsulemap_engine::orbit::matrix::{Complex, Matrix, determinant, eigenvalues};
use capsulemap_engine::orbit::return_map::{Cycles, jacobian, returned, seeded};
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::{
    Capsule, CapsuleParameters as _, CapsuleState as _, Case, Parameter, Parameters,
    PrintedCapsule, State, settle,
};

use super::differences::{TOLERANCE, distance, followed, size, slope};
use super::draws;

/// What differences must agree among themselves to, relative to the map's largest slope.
const RESOLVED: f64 = 1e-8;

/// A case that has settled on a periodic orbit: where its section is met, and after how many cycles again.
pub struct Periodic {
    /// The case.
    pub case: Case,
    /// The point of the section.
    pub point: [f64; 3],
    /// Period [cycles].
    pub period: u64,
}

/// Random cases that settle on periodic orbits, as many as `count`.
pub fn periodic(count: usize, seed: u64, change: impl Fn(&mut Case)) -> Vec<Periodic> {
    let found = draws::cases(3 * count, seed).into_iter().filter_map(|mut case| {
        change(&mut case);
        let orbit = settle(&case.parameters, case.section_phase, &case.start, &Protocol::default());
        let State { r, y1, y2, .. } = orbit.end.capsule();
        let settles = orbit.outcome == Outcome::Periodic;
        settles.then_some(Periodic { case, point: [r, y1, y2], period: orbit.period })
    });
    let found: Vec<Periodic> = found.take(count).collect();
    assert_eq!(found.len(), count, "too few are periodic");
    found
}

/// The Jacobian of the k-cycle map by the linearised flow.
pub fn linearised<S>(system: &S, point: &[f64; 3], k: u64) -> Matrix<3>
where
    S: Stroboscopic<Dual<f64, 3>, 3>,
{
    let cycles = Cycles { count: k, tolerance: TOLERANCE };
    jacobian(&returned(system, seeded(point), &cycles, |_| ()).expect("the integration continues"))
}

/// The capsule of a case over numbers with derivatives along the section's coordinates.
pub fn dual_capsule(case: &Case) -> Capsule<Dual<f64, 3>> {
    let p = &case.parameters;
    Capsule::new(|q| Dual::constant(p[q]), p.shape(), case.section_phase)
}

/// What the coordinates of the section are multiplied with to be compared.
pub fn weights(parameters: &Parameters) -> [f64; 3] {
    [parameters[Parameter::Omega], 1.0, 1.0]
}

/// A matrix over coordinates that are multiplied with `weights`; its eigenvalues are the same.
fn weighted(a: &Matrix<3>, weights: &[f64; 3]) -> Matrix<3> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] * weights[i] / weights[j]))
}

fn largest(a: &Matrix<3>) -> f64 {
    a.iter().flatten().fold(0.0, |most, entry| entry.abs().max(most))
}

/// The weighted Jacobian by differences and its doubt; the column of y2 stays zero where the capsule rests.
fn by_differences<S: Stroboscopic<f64, 3>>(
    system: &S,
    weights: [f64; 3],
    point: &[f64; 3],
    k: u64,
) -> (Matrix<3>, f64) {
    let reach = 1e-3 * size(point, &weights);
    let (mut matrix, mut doubt) = ([[0.0; 3]; 3], 0.0_f64);
    for column in 0..3 {
        if column == 2 && point[2] == 0.0 {
            continue;
        }
        let image = |h: f64| {
            let mut from = *point;
            from[column] += h / weights[column];
            followed(system, from, k, |_| ())
        };
        let along = slope(image, reach, &weights);
        for row in 0..3 {
            matrix[row][column] = along.value[row] * weights[row];
        }
        doubt = doubt.max(along.doubt);
    }
    (matrix, doubt)
}

/// How far two sets of multipliers are apart, in the order that pairs them best.
fn apart(a: &[Complex; 3], b: &[Complex; 3]) -> f64 {
    let between = |i: usize, j: usize| (a[i].re - b[j].re).hypot(a[i].im - b[j].im);
    [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]]
        .iter()
        .map(|order| (0..3).map(|i| between(i, order[i])).fold(0.0, f64::max))
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn multipliers_are_those_of_differences() {
    let (mut agree, mut touched) = (0, 0);
    for Periodic { case, point, period: k } in periodic(100, 9, |_| ()) {
        let system = Capsule::single(&case.parameters, case.section_phase);
        let weights = weights(&case.parameters);
        let exact = weighted(&linearised(&dual_capsule(&case), &point, k), &weights);
        let (differences, doubt) = by_differences(&system, weights, &point, k);
        let (multipliers, second) = (eigenvalues(&exact), eigenvalues(&differences));
        let error = apart(&multipliers, &second) / multipliers[0].abs();
        if doubt > RESOLVED * largest(&exact) {
            touched += 1;
            continue;
        }
        agree += 1;
        assert!(error < 1e-6, "{error:e} of {multipliers:?} against {second:?}: {case:?}");
    }
    // Differences resolve every one of these cases: none is within rounding of a guard.
    assert_eq!((agree, touched), (100, 0));
}

#[test]
fn a_guard_nearly_touched_shows_in_the_differences() {
    // Stuck, the mass swings as a linear oscillator whose amplitude falls short of the stop by `short`.
    let doubt = |short: f64| {
        let (omega, delta) = (60.0, 1e-4);
        let mut p = Parameters::with(&[(Parameter::Omega, omega), (Parameter::Delta, delta)]);
        let spring = p[Parameter::K1] - p[Parameter::M1] * omega * omega;
        let damper = p[Parameter::C] * omega;
        let amplitude = delta * (1.0 - short);
        p[Parameter::Pd] = amplitude * libm::hypot(spring, damper);
        let lag = libm::atan2(damper, spring);
        let point = [amplitude * libm::cos(lag), omega * amplitude * libm::sin(lag), 0.0];
        let (matrix, doubt) = by_differences(&Capsule::single(&p, 0.0), weights(&p), &point, 1);
        doubt / largest(&matrix)
    };
    assert!(doubt(0.1) < 1e-2 * RESOLVED, "{:e}", doubt(0.1));
    assert!(doubt(1e-9) > RESOLVED, "{:e}", doubt(1e-9));
}

#[test]
fn a_push_at_rest_is_forgotten_to_second_order() {
    let mut seen = 0;
    for Periodic { case, point, period: k } in periodic(60, 9, |_| ()) {
        if point[2] != 0.0 {
            continue;
        }
        let jacobian = linearised(&dual_capsule(&case), &point, k);
        assert!(jacobian.iter().all(|row| row[2] == 0.0), "{case:?}");
        let system = Capsule::single(&case.parameters, case.section_phase);
        let weights = weights(&case.parameters);
        let pushed = |y2: f64| followed(&system, [point[0], point[1], y2], k, |_| ());
        let reach = size(&point, &weights);
        let still = pushed(0.0);
        for h in [1e-2, 1e-3, 1e-4, -1e-2, -1e-3, -1e-4].map(|share| share * reach) {
            let moved = distance(&pushed(h), &still, &weights);
            let quarter = distance(&pushed(0.25 * h), &still, &weights);
            // A sixteenth, but for the third order of the widest push and rounding.
            assert!(
                quarter < moved / 15.5 + 1e-13 * reach,
                "{h:e}: {moved:e} {quarter:e} {case:?}"
            );
        }
        seen += 1;
    }
    assert!(seen >= 15, "only {seen} are at rest where the section is");
}

#[test]
fn sticking_takes_a_direction_out() {
    let (mut at_rest, mut moving) = (0, 0);
    for Periodic { case, point, period: k } in periodic(100, 17, |_| ()) {
        let system = Capsule::single(&case.parameters, case.section_phase);
        let mut sticks = false;
        followed(&system, point, k, |step| {
            sticks |= step.jet.y2.iter().all(|term| *term == 0.0);
        });
        if !sticks {
            continue;
        }
        let weights = weights(&case.parameters);
        let jacobian = weighted(&linearised(&dual_capsule(&case), &point, k), &weights);
        if point[2] == 0.0 {
            assert_eq!(determinant(jacobian), 0.0, "{case:?}");
            assert_eq!(eigenvalues(&jacobian)[2], Complex::default(), "{case:?}");
            at_rest += 1;
        } else {
            // In the moment of rest it is zero; what follows mixes the coordinates with rounding.
            let rounding = 1e-14 * largest(&jacobian).powi(3);
            assert!(determinant(jacobian).abs() < rounding, "{case:?}");
            moving += 1;
        }
    }
    assert!(at_rest >= 20 && moving >= 20, "{at_rest} {moving}");
}

#[test]
fn the_equation_as_printed_is_linearised_too() {
    let (mut agree, mut creeping) = (0, 0);
    for mut case in draws::cases(100, 23) {
        let p = &mut case.parameters;
        // Little friction, so that it switches often, and a start that is not frozen for ever.
        p[Parameter::MuS] *= 0.3;
        p[Parameter::MuD] *= 0.3;
        let State { r, y1, y2, .. } = case.start.capsule();
        let point = [r, y1, if y2 == 0.0 { 0.05 } else { y2 }];
        let p = &case.parameters;
        let system = PrintedCapsule::single(p, case.section_phase);
        let carried = PrintedCapsule::<Dual<f64, 3>>::new(
            |q| Dual::constant(p[q]),
            p.shape(),
            case.section_phase,
        );
        let weights = weights(&case.parameters);
        let exact = weighted(&linearised(&carried, &point, 2), &weights);
        let (differences, doubt) = by_differences(&system, weights, &point, 2);
        if doubt > RESOLVED * largest(&exact) {
            continue;
        }
        let mut creeps = false;
        followed(&system, point, 2, |step| {
            creeps |= step.mode.creeps();
        });
        let rows = (0..3).map(|i| distance(&exact[i], &differences[i], &[1.0; 3]));
        let error = rows.fold(0.0, f64::max) / largest(&exact);
        assert!(error < 1e-7, "{error:e}: {case:?}");
        agree += 1;
        creeping += usize::from(creeps);
    }
    assert!(agree >= 97 && creeping >= 40, "{agree}, of which {creeping} creep along the limit");
}
