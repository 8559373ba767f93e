//! The product rule: the determinant of the return map is what the divergence of the field makes of volumes.

use capsulemap_engine::lane::{Series, quadrature, series};
use capsulemap_engine::orbit::matrix::determinant;
use capsulemap_models::capsule::{
    Capsule, CapsuleParameters as _, Parameter, Parameters, Resistance,
};

use super::derivatives::{Periodic, dual_capsule, linearised, periodic};
use super::differences::followed;

/// The slope of the resistance over the speed, by the law as the paper writes it [N s/m].
fn resistance_slope(p: &Parameters, y2: f64) -> f64 {
    match p.resistance() {
        Resistance::CoulombStribeck => {
            let v_s = p[Parameter::Vs];
            -p[Parameter::MuD] * p.normal_load() / v_s * libm::exp(-y2.abs() / v_s)
        }
        Resistance::Coulomb => 0.0,
        Resistance::Medium => p[Parameter::C1] + 2.0 * p[Parameter::C2] * y2.abs(),
    }
}

/// The integral of the divergence -c/m1 - (c + slope of f_d)/m2 over a step of this speed.
fn shrinkage(p: &Parameters, y2: &Series<f64>, length: f64) -> f64 {
    let speeds = quadrature::values(y2, length);
    let divergence = speeds.map(|speed| {
        -p[Parameter::C] / p[Parameter::M1]
            - (p[Parameter::C] + resistance_slope(p, speed)) / p[Parameter::M2]
    });
    quadrature::integral_of_product(&divergence, &[1.0; quadrature::NODES], length)
}

/// What a volume around the orbit is multiplied with over a period.
struct Volume {
    /// By the flow between events.
    shrunk: f64,
    /// By the jumps of the field.
    jumps: f64,
}

/// What becomes of a volume around the orbit: the flow between events, and the jumps of the field at
/// reversals.
///
/// The compliant stop leaves the field continuous. Where y2 passes zero, volumes are multiplied with the
/// acceleration after over that before. None where the capsule sticks.
fn volume(of: &Periodic) -> Option<Volume> {
    let p = &of.case.parameters;
    let system = Capsule::single(p, of.case.section_phase);
    let (mut exponent, mut jumps, mut before, mut sticks) = (0.0, 1.0, None, false);
    followed(&system, of.point, of.period, |step| {
        let (y2, acceleration) = (&step.jet.y2, series::derivative(&step.jet.y2));
        sticks |= acceleration.iter().all(|term| *term == 0.0);
        if let Some(before) = before.take() {
            jumps *= acceleration[0] / before;
        }
        exponent += shrinkage(p, y2, step.length);
        let reverses = step.event != 0.0 && series::value(y2, step.length).abs() < 1e-12;
        before = reverses.then(|| series::value(&acceleration, step.length));
    });
    (!sticks).then(|| Volume { shrunk: libm::exp(exponent), jumps })
}

/// Cases that slide without rest, so seldom that volumes shrink too far to be compared.
fn sliding(resistance: Resistance) -> Vec<Periodic> {
    periodic(40, 31, |case| {
        let p = &mut case.parameters;
        p.resist_by(resistance);
        p[Parameter::Omega] += 40.0;
        p[Parameter::C] *= 0.5;
        p[Parameter::MuS] *= 0.15;
        p[Parameter::MuD] *= 0.15;
        (p[Parameter::C1], p[Parameter::C2]) = (0.8, 3.0);
    })
}

#[test]
fn volumes_shrink_by_the_divergence() {
    for resistance in [Resistance::Medium, Resistance::CoulombStribeck, Resistance::Coulomb] {
        let (mut met, mut jumping) = (0, 0);
        for orbit in sliding(resistance) {
            let Some(volume) = volume(&orbit) else { continue };
            let Periodic { case, point, period } = &orbit;
            let jacobian = linearised(&dual_capsule(case), point, *period);
            let error = determinant(jacobian) / (volume.shrunk * volume.jumps) - 1.0;
            assert!(error.abs() < 1e-10, "{error:e}: {case:?}");
            met += 1;
            jumping += usize::from((volume.jumps - 1.0).abs() > 1e-3);
        }
        assert!(met >= 35, "{resistance:?}: only {met} slide all the time");
        // A medium resists no more on one side of rest than on the other.
        assert_eq!(jumping > 30, resistance != Resistance::Medium, "{resistance:?}: {jumping}");
    }
}
