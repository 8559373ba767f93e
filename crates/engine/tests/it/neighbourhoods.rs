//! Neighbourhoods of orbits that the return map leads into themselves: what enters one tends to its orbit.

use capsulemap_engine::attractor::coincide;
use capsulemap_engine::flow::System;
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::neighbourhood::Neighbourhood;
use capsulemap_engine::orbit::return_map::{Cycles, returned};
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::{
    CapsuleCase as _, CapsuleParameters as _, Case, Filippov, Orbit, Parameter, Parameters, State,
};

use super::direct_links::points;
use super::draws::{Random, settled};

/// Starts of a capsule with two motions.
fn starts() -> Vec<Case> {
    let parameters = Parameters::with(&[
        (Parameter::M2, 0.2),
        (Parameter::C, 1.77),
        (Parameter::MuS, 0.33),
        (Parameter::MuD, 0.165),
        (Parameter::Pd, 2.79),
        (Parameter::K2, 65.518e3),
        (Parameter::Delta, 4.33e-3),
        (Parameter::Omega, 155.0),
    ]);
    let start = |r: f64, y1: f64| State::of([r, y1, 0.0, 0.0]);
    let all = [-6e-3, 0.0, 6e-3].iter().flat_map(|r| [-1.0, 0.0, 1.0].map(|y1| start(*r, y1)));
    all.map(|start| Case::at_section(parameters.clone(), start, 0.0)).collect()
}

#[test]
fn what_enters_a_neighbourhood_tends_to_its_orbit() {
    let cases = starts();
    let system = cases[0].read::<Filippov>().system;
    let metric = system.metric();
    let mut orbits: Vec<Orbit> = Vec::new();
    for orbit in settled(&cases, &Protocol::default(), Instructions::widest()) {
        let is_known = |it: &Orbit| coincide(&points(it), &points(&orbit), 1e-6, &metric);
        if orbit.outcome == Outcome::Periodic && !orbits.iter().any(is_known) {
            orbits.push(orbit);
        }
    }
    assert_eq!(orbits.len(), 2);
    let mut random = Random::new(15);
    for orbit in orbits {
        let (centre, period) = (orbit.section[0].array(), orbit.period);
        let of = |instructions| {
            Neighbourhood::of(&system, (centre, period), instructions, 1e-12).expect("it is stable")
        };
        let neighbourhood = of(Instructions::Scalar);
        assert!(Instructions::available().all(|it| of(it) == neighbourhood));
        // Points all over the ellipsoid, whose extent along each coordinate is found by doubling.
        let along = |i: usize, by: f64| {
            let mut point = centre;
            point[i] += by;
            point
        };
        let reach: [f64; 3] = std::array::from_fn(|i| {
            let mut by = 1e-9;
            while neighbourhood.contains(&along(i, by)) {
                by *= 2.0;
            }
            by
        });
        println!("period {period}: the neighbourhood reaches {reach:?}");
        assert!(reach.iter().zip(metric.scales).all(|(by, scale)| by * scale > 1e-3), "{reach:?}");
        let mut inside = 0;
        while inside < 200 {
            let point = std::array::from_fn(|i| centre[i] + reach[i] * random.uniform(-2.0, 2.0));
            if !neighbourhood.contains(&point) {
                continue;
            }
            inside += 1;
            let cycles = Cycles { count: 200 * period, tolerance: 1e-12 };
            let end = returned(&system.single(), point, &cycles, |_| ()).expect("it goes on");
            assert!(metric.distance(&end, &centre) < 1e-9, "{point:?} leads to {end:?}");
        }
    }
}
