//! The six texts that the form was designed with, against what is known of their oscillators.

use std::fs;
use std::path::Path;

use capsulemap_engine::attractor::attractors_of;
use capsulemap_engine::branch::{self, End, Found, FoundOf, SpecialKind};
use capsulemap_engine::flow::System;
use capsulemap_engine::orbit::{
    Case, Machine, OrbitOf, Outcome, Proof, Protocol, settle, settle_all,
};
use capsulemap_text::program::Program;
use capsulemap_text::read;
use capsulemap_text::system::{Autonomous, Driven};

pub type D3 = Driven<3, 5>;
pub type A3 = Autonomous<3, 5>;

/// The characters of a text of the repository.
pub fn characters(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../systems").join(name);
    fs::read_to_string(path).expect("a text")
}

/// The program of a text.
pub fn program(characters: &str) -> &'static Program {
    let text = read(characters).unwrap_or_else(|faults| {
        let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
        panic!("{}", faults.join("\n"))
    });
    Box::leak(Box::new(Program::new(text, 3)))
}

/// The driven oscillator of a text, with some values of its parameters.
fn driven(name: &str, values: &[(&str, f64)]) -> D3 {
    let system = D3::new(program(&characters(name)));
    values.iter().fold(system, |system, (name, value)| system.with_named(name, *value))
}

/// What a driven oscillator settles to from rest.
fn from_rest(system: &D3) -> OrbitOf<D3, 3> {
    settle(&Case::new(system.clone(), [0.0; 5]), &Protocol::default())
}

/// The mean speed of what drifts.
fn speed(orbit: &OrbitOf<D3, 3>) -> f64 {
    (orbit.end[4] - orbit.begins[4]) / (orbit.measured_cycles as f64 * orbit.duration)
}

/// The branch through an orbit of period 1 in the parameter of a name.
fn followed<M>(system: &M, section: [f64; 3], (along, range): (usize, [f64; 2])) -> FoundOf<M, 3>
where
    M: System<3, Parameter = usize>,
{
    let request = branch::Request {
        system: system.clone(),
        section,
        period: 1,
        along,
        range,
        doublings: 0,
        second: None,
        curve_range: None,
        longest_step: 0.02,
        most_points: 2000,
        tolerance: 1e-12,
    };
    branch::follow(&request).expect("a branch through the orbit")
}

/// Where the first special point of a kind is on the first branch.
fn special<O>(found: &Found<O, [f64; 3]>, kind: SpecialKind) -> f64 {
    let mut special = found.branches[0].special.iter().filter(|it| it.kind == kind);
    special.next().expect("the special point").point.parameter
}

/// Parameters of the capsule with the speed that the model's table gives [mm/s].
const SPEEDS: [(f64, f64, f64, f64, &str); 6] = [
    (2.42e3, 77.91, 4.0, 3.5e-3, "10.298005"),
    (18.96e3, 20.73, 4.0, 1.5e-3, "0.255748"),
    (59.41e3, 26.58, 2.5, 1.5e-3, "0.008345"),
    (59.41e3, 37.33, 2.5, 1.5e-3, "0.115158"),
    (59.41e3, 46.0, 2.5, 1.5e-3, "0.271341"),
    (59.41e3, 54.6, 2.5, 1.5e-3, "0.528927"),
];

#[test]
fn the_capsule_has_the_published_speeds() {
    for (k2, omega, p_d, delta, known) in SPEEDS {
        let values = [("k2", k2), ("omega", omega), ("p_d", p_d), ("delta", delta)];
        let orbit = from_rest(&driven("capsule.toml", &values));
        assert_eq!((orbit.outcome, orbit.certificate.proof), (Outcome::Periodic, Proof::Newton));
        assert_eq!(format!("{:.6}", 1e3 * speed(&orbit)), known);
    }
}

#[test]
fn the_impact_oscillator_has_its_attractors_its_fold_and_its_grazing() {
    let system = driven("impact.toml", &[]);
    let cases =
        [[-0.8, 0.0], [0.0, 0.0]].map(|[x, v]| Case::new(system.clone(), [x, v, 0.0, 0.0, 0.0]));
    let orbits = settle_all(&cases, &Protocol::default(), Machine::default());
    assert!(orbits.iter().all(|it| it.certificate.proof == Proof::Newton));
    assert_eq!(attractors_of(&system, &orbits, &Protocol::default()).attractors.len(), 2);
    // Areas of the section shrink by e^(-c T) in a cycle and by r^2 at an impact.
    for (orbit, impacts) in orbits.iter().zip([0.0, 1.0]) {
        let [a, b, padding] = orbit.certificate.multipliers[..] else { panic!("three") };
        let shrinks = -0.1 * orbit.duration + 2.0 * impacts * libm::log(0.7);
        assert!((libm::log(a.abs() * b.abs()) - shrinks).abs() < 1e-9);
        assert_eq!(padding.abs(), 0.0);
    }
    let w = system.parameter("w").expect("a parameter");
    let found = followed(&system, orbits[1].section[0], (w, [0.8, 1.8]));
    assert_eq!(found.branches[0].ends, [End::Bound; 2]);
    // Without impacts the amplitude is 1/sqrt((1 - w^2)^2 + (c w)^2), which is one at w^2 = 2 - c^2.
    let grazing = special(&found, SpecialKind::Grazing);
    assert!((grazing - libm::sqrt(1.99)).abs() < 1e-11, "{grazing}");
    let fold = special(&found, SpecialKind::Fold);
    assert!((fold - 1.703_193_808_401_035).abs() < 1e-10, "{fold}");
}

#[test]
fn the_belts_cycle_ends_where_it_fails_to_stick() {
    let system = A3::new(program(&characters("belt.toml")));
    let case = Case::new(system.clone(), [2.0, 0.0, 0.0, 0.0, 0.0]);
    let orbit = settle(&case, &Protocol::default());
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    // What came before is forgotten while the mass sticks.
    assert!(orbit.certificate.multipliers[0].abs() < 1e-12);
    let belt = system.parameter("belt").expect("a parameter");
    let found = followed(&system, orbit.section[0], (belt, [1.0, 2.5]));
    let ends = special(&found, SpecialKind::EventSequence);
    assert!((ends - 1.836_600_971).abs() < 1e-8, "{ends}");
    // Beyond, the branch is of the unstable cycle, which shrinks onto steady sliding where v = s ln(a/(c s)).
    assert_eq!(found.branches[0].ends[1], End::Equilibrium);
    let last = found.branches[0].points.last().expect("an orbit").parameter;
    let exact = 0.5 * libm::log(0.5 / (0.1 * 0.5));
    assert!((last - exact).abs() < 1e-7, "{last} {exact}");
}

#[test]
fn the_valve_loses_its_stability_and_has_its_first_impact() {
    let text = characters("valve.toml");
    // The equilibrium, seen at equal times, is a fixed point.
    let at_equal_times = text.replace("{ when = \"y2 falls\", within = 200.0 }", "{ every = 0.5 }");
    let system = D3::new(program(&at_equal_times));
    let q = system.parameter("q").expect("a parameter");
    // y2 = 0, y3 = y1 + delta, q = y1 sqrt(y3).
    let flow = |y1: f64| y1 * libm::sqrt(y1 + 10.0);
    let at_rest = system.with_named("q", flow(4.0));
    let found = followed(&at_rest, [4.0, 0.0, 14.0], (q, [4.0, 20.0]));
    let loss = special(&found, SpecialKind::NeimarkSacker);
    assert!((loss - 8.491_117_635_183).abs() < 1e-9, "{loss}");

    let system = A3::new(program(&text)).with_named("q", 8.0);
    let case = Case::new(system.clone(), [4.0, 15.0, 0.0, 0.0, 0.0]);
    let orbit = settle(&case, &Protocol::default());
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    let found = followed(&system, orbit.section[0], (q, [5.0, 9.0]));
    let touch = special(&found, SpecialKind::Grazing);
    assert!((touch - 7.557_210_972).abs() < 1e-8, "{touch}");
}

#[test]
fn the_mirror_image_moves_backward_to_the_bit() {
    let [there, back] = [1.0, -1.0].map(|sign| {
        let mut values = vec![("sgn", sign)];
        if sign < 0.0 {
            // The stops change places, and the preload its sign.
            values.extend([("k2", 53_500.0), ("k3", 27_900.0), ("delta", 0.0), ("delta3", 1.6e-3)]);
            values.push(("G", -1e-4));
        }
        let orbit = from_rest(&driven("two_stops.toml", &values));
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
        speed(&orbit)
    });
    assert_eq!(there, -back);
    assert_eq!(format!("{:.6}", 1e3 * there), "22.502937");
}

#[test]
fn pulses_between_mass_and_capsule_move_it_as_known() {
    let orbit = from_rest(&driven("pulse.toml", &[]));
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    // A pulse and what is left of the period exchange their parts: v(1 - D) = -v(D).
    let other = from_rest(&driven("pulse.toml", &[("D", 0.65)]));
    assert!((speed(&orbit) + speed(&other)).abs() < 1e-12);
    let half = from_rest(&driven("pulse.toml", &[("D", 0.5)]));
    assert!(speed(&half).abs() < 1e-13, "{}", speed(&half));
}
