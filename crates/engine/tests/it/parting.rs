//! All Lyapunov exponents beside the rates at which neighbours part that are followed by themselves.

use capsulemap_engine::flow::{Switched as _, System};
use capsulemap_engine::orbit::return_map::{Cycles, returned};
use capsulemap_engine::orbit::{Case, Exponents, OrbitOf, Outcome, Protocol, settle};
use capsulemap_models::capsule::{CapsuleSystem, Filippov};
use capsulemap_models::face::engine_case;

use super::draws;
use super::oscillators::Impact;

/// The rates of stretching of as many neighbours as there are coordinates, which a return map in plain numbers leads cycle by cycle and
/// which are put back to a small distance at right angles to each other [1/s].
fn by_neighbours<M: System<D>, const D: usize>(
    system: &M,
    from: [f64; D],
    (cycles, apart): (usize, f64),
) -> [f64; D] {
    let (single, scales) = (system.single(), system.metric().scales);
    let one = Cycles { count: 1, tolerance: 1e-14 };
    let next = |point| returned(&single, point, &one, |_| ()).expect("the integration continues");
    let mut point = from;
    let first: [[f64; D]; D] = std::array::from_fn(|j| {
        std::array::from_fn(|i| f64::from(u8::from(i == j)) - 2.0 / D as f64)
    });
    let mut columns = first;
    let mut logs = [0.0; D];
    let turning = cycles / 16;
    for cycle in 0..cycles {
        let end = next(point);
        for column in &mut columns {
            let beside = std::array::from_fn(|i| point[i] + apart * column[i] / scales[i]);
            let returned = next(beside);
            *column = std::array::from_fn(|i| (returned[i] - end[i]) * scales[i] / apart);
        }
        for j in 0..D {
            for before in 0..j {
                let along: f64 = (0..D).map(|i| columns[before][i] * columns[j][i]).sum();
                let other = columns[before];
                columns[j].iter_mut().zip(other).for_each(|(own, other)| *own -= along * other);
            }
            let length = columns[j].iter().map(|x| x * x).sum::<f64>().sqrt();
            // Neighbours that have become one are parted anew.
            if length > 1e-12 {
                columns[j].iter_mut().for_each(|x| *x /= length);
            } else {
                columns[j] = first[j];
            }
            if cycle >= turning {
                logs[j] += length.max(1e-16).ln();
            }
        }
        point = end;
    }
    logs.map(|log| log / ((cycles - turning) as f64 * single.period()))
}

/// Compares all exponents of a chaotic case with those of neighbours; directions that are lost leave only rounding there.
fn compare_with_neighbours<M: System<D>, const D: usize>(case: &Case<M, D>, cycles: usize) {
    let protocol = Protocol {
        exponents: Exponents::All,
        exponent_error: 0.02,
        exponent_cycles: 8192,
        ..Protocol::default()
    };
    let orbit = settle(case, &protocol);
    assert_eq!(orbit.outcome, Outcome::Chaotic);
    let spectrum = orbit.spectrum.expect("all exponents");
    let found = by_neighbours(&case.system, orbit.section[0], (cycles, 1e-7));
    println!("{spectrum:?} {:?} {found:?}", orbit.exponent);
    let [largest, same] = [spectrum.exponents[0], orbit.exponent];
    let allowed = 5.0 * largest.uncertainty.hypot(same.uncertainty);
    assert!((largest.value - same.value).abs() < allowed, "{largest:?} {same:?}");
    for (exponent, rate) in spectrum.exponents.iter().zip(found) {
        if exponent.value == f64::NEG_INFINITY {
            assert!(rate * orbit.duration < -5.0, "{spectrum:?} {found:?}");
            continue;
        }
        // The neighbours go as many cycles, and their means are as uncertain.
        let allowed = 6.0 * exponent.uncertainty + 2e-3 * exponent.value.abs();
        assert!((exponent.value - rate).abs() < allowed, "{spectrum:?} {found:?}");
    }
    assert!(spectrum.dimension.value > 1.0 && spectrum.dimension.uncertainty > 0.0);
}

#[test]
fn neighbours_of_a_mass_at_a_rigid_stop_part_at_these_rates() {
    let system = Impact {
        k: 1.0,
        c: 0.1,
        drive: 1.0,
        omega: 2.67,
        gravity: 0.0,
        stop: 0.0,
        restitution: 0.8,
    };
    compare_with_neighbours(&Case::new(system, [-0.1, 0.3]), 2000);
}

/// A capsule at its place among random ones, and what it settles to.
fn capsule(
    place: usize,
) -> (Case<CapsuleSystem<Filippov>, 3>, OrbitOf<CapsuleSystem<Filippov>, 3>) {
    let case = engine_case(&draws::cases(place + 1, 3)[place]);
    let orbit: OrbitOf<CapsuleSystem<Filippov>, 3> = settle(&case, &Protocol::default());
    assert!(
        orbit.outcome == Outcome::Chaotic && orbit.observed.impacts > 0.0,
        "{:?}",
        orbit.outcome
    );
    (case, orbit)
}

#[test]
fn neighbours_of_a_capsule_that_sticks_and_slips_part_at_these_rates() {
    let (case, orbit) = capsule(107);
    assert!(orbit.observed.stick_time > 0.1 * orbit.observed.time);
    compare_with_neighbours(&case, 1500);
}

#[test]
fn neighbours_of_a_capsule_that_slides_part_at_these_rates() {
    let (case, orbit) = capsule(378);
    assert_eq!(orbit.observed.stick_time, 0.0);
    compare_with_neighbours(&case, 1500);
}
