//! Derivatives along parameters, and derivatives of derivatives, against differences.

use capsulemap_engine::lane::{Dual, Lane};
use capsulemap_models::capsule::{Capsule, CapsuleParameters as _, Parameter};

use super::derivatives::{Periodic, dual_capsule, linearised, periodic, weights};
use super::differences::{distance, followed, size, slope};

/// What acts under the Coulomb-Stribeck law.
pub const DIRECTIONS: [Parameter; 12] = [
    Parameter::M1,
    Parameter::M2,
    Parameter::K1,
    Parameter::C,
    Parameter::K2,
    Parameter::Delta,
    Parameter::Pd,
    Parameter::Omega,
    Parameter::MuS,
    Parameter::MuD,
    Parameter::Vs,
    Parameter::G,
];

/// The section point of a case after its period, `direction` being `value`, from where its orbit was found.
fn image<L: Lane<Mask = bool>>(of: &Periodic, direction: Parameter, value: L) -> [L; 3] {
    let p = &of.case.parameters;
    let with = |q: Parameter| if q == direction { value } else { L::splat(p[q]) };
    let system = Capsule::new(with, p.shape(), of.case.section_phase);
    let from = of.point.map(L::splat);
    followed(&system, from, of.period, |_| ())
}

/// The derivative along a parameter, of that parameter's relative change, carried and by differences; the
/// doubt.
fn along(of: &Periodic, direction: Parameter) -> ([f64; 3], [f64; 3], f64) {
    let p = &of.case.parameters;
    let weights = [p[Parameter::Omega], 1.0, 1.0];
    let value = Dual::<f64, 1>::variable(p[direction], 0);
    let carried =
        image(of, direction, value).map(|coordinate| coordinate.gradient[0] * p[direction]);
    let moved = |h: f64| image(of, direction, p[direction] * (1.0 + h));
    let differences = slope(moved, 1e-3, &weights);
    (carried, differences.value, differences.doubt)
}

#[test]
fn parameters_are_directions() {
    let (mut acting, mut touched) = ([0; DIRECTIONS.len()], 0);
    // So little dynamic friction that rest ends at the static limit in most cases.
    for of in periodic(40, 41, |case| case.parameters[Parameter::MuD] *= 0.6) {
        let weights = [of.case.parameters[Parameter::Omega], 1.0, 1.0];
        let scale = size(&of.point, &weights);
        for (direction, acts) in DIRECTIONS.iter().zip(&mut acting) {
            let (carried, differences, doubt) = along(&of, *direction);
            if doubt > 1e-8 * scale {
                touched += 1;
                continue;
            }
            let error = distance(&carried, &differences, &weights);
            assert!(error < 1e-7 * scale, "{direction:?}: {error:e} {:?}", of.case);
            *acts += usize::from(size(&carried, &weights) > 1e-6 * scale);
        }
    }
    assert!(acting.iter().all(|&acts| acts >= 10), "{acting:?}");
    assert!(touched <= 24, "differences resolve too few: {touched} of 480 do not");
}

/// Second derivatives of the section point, that of coordinate `row` along `column` and `j` at
/// [row][column][j].
fn second_derivatives(of: &Periodic) -> [[[f64; 3]; 3]; 3] {
    type Twice = Dual<Dual<f64, 3>, 3>;
    let p = &of.case.parameters;
    let system = Capsule::<Twice>::new(|q| Twice::splat(p[q]), p.shape(), of.case.section_phase);
    let from: [Twice; 3] =
        std::array::from_fn(|i| Dual::variable(Dual::variable(of.point[i], i), i));
    let end = followed(&system, from, of.period, |_| ());
    end.map(|coordinate| coordinate.gradient.map(|derivative| derivative.gradient))
}

#[test]
fn second_derivatives_are_differences_of_first_ones() {
    for of in periodic(24, 43, |_| ()) {
        let Periodic { case, point, period } = &of;
        let carried = second_derivatives(&of);
        let weights = weights(&case.parameters);
        let reach = 1e-3 * size(point, &weights);
        // Along y2 a capsule at rest has a map with a corner.
        let moving = if point[2] == 0.0 { 2 } else { 3 };
        for j in 0..moving {
            let jacobian = |h: f64| -> [f64; 9] {
                let mut moved = *point;
                moved[j] += h / weights[j];
                let a = linearised(&dual_capsule(case), &moved, *period);
                std::array::from_fn(|e| a[e / 3][e % 3] * weights[e / 3] / weights[e % 3])
            };
            let second: [f64; 9] = std::array::from_fn(|e| {
                let (row, column) = (e / 3, e % 3);
                carried[row][column][j] * weights[row] / weights[column] / weights[j]
            });
            let differences = slope(jacobian, reach, &[1.0; 9]);
            let error = distance(&second, &differences.value, &[1.0; 9]);
            // A linear motion has none: there only the rounding of the differences is left.
            let bound = 1e-7 * size(&second, &[1.0; 9]) + 1e-11 / reach;
            assert!(differences.doubt < bound && error < bound, "{error:e} {bound:e}: {case:?}");
        }
    }
}
