//! All Lyapunov exponents of texts: their sum by the divergence of the field and what events do to volumes.

use capsulemap_engine::flow::{Step, Switched as _, System};
use capsulemap_engine::orbit::matrix::Matrix;
use capsulemap_engine::orbit::passage::{Integrator, OneByOne, ReturnRequest};
use capsulemap_engine::orbit::return_map::Cycles;

use super::draws::Random;
use super::six::{D3, characters, program};
use super::volumes::{Share, volume};

type Single = <D3 as System<3>>::Single;

/// The cycles over which volumes are compared.
const CYCLES: usize = 3;

/// The logarithms of what some cycles make of three directions, of which as many are orthonormal as a text has coordinates: along the
/// others nothing is apart.
fn stretched(system: &D3, coordinates: usize, point: [f64; 3]) -> [f64; 3] {
    let reflected: Matrix<3> = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let own = i.max(j) < coordinates;
            f64::from(u8::from(i == j)) - if own { 2.0 / coordinates as f64 } else { 0.0 }
        })
    });
    let passage = OneByOne.passage(ReturnRequest {
        system: system.clone(),
        along: None,
        point,
        units: system.metric().scales.map(|scale| 1.0 / scale),
        cycles: Cycles { count: CYCLES as u64, tolerance: 1e-12 },
        watched: false,
        directions: Some(reflected),
    });
    let passage = passage.expect("the integration continues");
    std::array::from_fn(|j| passage.stretches.iter().map(|it| it.logs[j]).sum())
}

/// Compares volumes around random points; what a text has no state for is lost. Returns how many were lost, of how many.
fn compare(
    name: &str,
    coordinates: usize,
    mode: impl Fn(&Step<f64, Single>) -> Share,
    event: impl Fn(&Step<f64, Single>) -> Share,
) -> [usize; 2] {
    let long = std::env::var_os("LONG_PROOFS").is_some();
    let system = D3::new(program(&characters(name)));
    let single = system.single();
    let mut random = Random::new(331);
    let (mut lost, count) = (0, if long { 200 } else { 12 });
    for _ in 0..count {
        let mut point = [0.0; 3];
        point[..coordinates].iter_mut().for_each(|x| *x = random.uniform(-0.8, 0.8));
        let mut logs = stretched(&system, coordinates, point);
        logs.sort_by(|a, b| b.total_cmp(a));
        let (own, absent) = logs.split_at(coordinates);
        assert!(absent.iter().all(|it| *it == f64::NEG_INFINITY), "{logs:?}");
        let found: f64 = own.iter().sum();
        let expected = volume(&single, point, CYCLES, &mode, |step, _| event(step));
        if expected == f64::NEG_INFINITY {
            lost += 1;
            assert_eq!(found, expected, "{name} {point:?} {logs:?}");
        } else {
            let apart = (found - expected).abs() / (1.0 + expected.abs());
            assert!(apart < 1e-6, "{name} {point:?}: {found} {expected}");
        }
    }
    [lost, count]
}

#[test]
fn volumes_of_texts_shrink_by_the_divergence_and_by_events() {
    let stays = |_: &Step<f64, Single>| Share::Stays;
    // At a wall volumes are multiplied with the square of the restitution, which is 0.7.
    let bounces = |step: &Step<f64, Single>| match step.event {
        0.0 => Share::Stays,
        _ => Share::Times(0.7 * 0.7),
    };
    let rests = |step: &Step<f64, Single>| match step.mode.signs[0] {
        0.0 => Share::Lost,
        _ => Share::Stays,
    };
    // A velocity that reaches zero under dry friction turns back where the mass does not rest.
    let turns = |at: usize| {
        move |step: &Step<f64, Single>| match step.event {
            0.0 => Share::Stays,
            _ => Share::Turns(at),
        }
    };
    assert_eq!(compare("duffing.toml", 2, stays, stays)[0], 0);
    assert_eq!(compare("impact.toml", 2, stays, bounces)[0], 0);
    let [lost, all] = compare("friction.toml", 2, rests, turns(1));
    assert!(lost < all, "{lost} of {all}");
    let capsule = D3::new(program(&characters("capsule.toml"))).single();
    let [lost, _] = compare("capsule.toml", 3, rests, |step| {
        let y2 = capsule.at(&step.jet, step.length)[2];
        let ends_sliding = step.event != 0.0 && step.mode.signs[0] != 0.0 && y2.abs() < 1e-12;
        if ends_sliding { Share::Turns(2) } else { Share::Stays }
    });
    assert!(lost > 0, "{lost}");
}
