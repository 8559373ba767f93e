//! The laws of return maps: derivatives are those of differences, and tolerances agree where the map is tame.

use std::cell::Cell;

use capsulemap_engine::flow::{Motion, STEPS_PER_CYCLE, Step, Stroboscopic, cycle};
use capsulemap_engine::lane::{Dual, Lane};
use capsulemap_engine::orbit::Case;
use capsulemap_engine::orbit::matrix::Matrix;
use capsulemap_engine::orbit::return_map::{Cycles, jacobian, returned, seeded, values};

use super::super::differences::{TOLERANCE, slope};
use super::subject::{Subject, count};

/// What differences must agree among themselves to, relative to the largest slope of the map.
const RESOLVED: f64 = 1e-8;
/// How far derivatives may be from differences that are resolved, relative to the largest slope.
const AGREES: f64 = 1e-7;
/// A slope below this is none.
const FLAT: f64 = 1e-3;

/// The section point of a case after so many cycles, if it can be followed so far.
pub fn point_after<M: Subject<D>, const D: usize>(
    case: &Case<M, D>,
    cycles: usize,
) -> Option<[f64; D]> {
    let system = case.system.single();
    let mut motion = Motion::new(&system, case.begins, case.start);
    let mut step = Step::default();
    for _ in 0..cycles {
        cycle(&system, &mut motion, &mut step, (STEPS_PER_CYCLE, 1e-12), |_| ()).ok()?;
    }
    Some(M::Single::point(&motion.state))
}

/// A point followed for whole cycles.
fn image<M: Subject<D>, const D: usize>(
    system: &M,
    point: [f64; D],
    (count, tolerance): (u64, f64),
) -> Option<[f64; D]> {
    returned(&system.single(), point, &Cycles { count, tolerance }, |_| ()).ok()
}

/// The Jacobian of the map over whole cycles, over coordinates in the units of the metric.
fn linearised<M: Subject<D>, const D: usize>(
    system: &M,
    point: &[f64; D],
    (count, tolerance): (u64, f64),
) -> Option<Matrix<D>> {
    let dual = system.constant::<Dual<f64, D>>();
    let end = returned(&dual, seeded(point), &Cycles { count, tolerance }, |_| ()).ok()?;
    let scales = system.metric().scales;
    let plain = jacobian(&end);
    Some(std::array::from_fn(|i| std::array::from_fn(|j| plain[i][j] * scales[i] / scales[j])))
}

/// The largest entry of a matrix.
fn largest<const D: usize>(matrix: &Matrix<D>) -> f64 {
    matrix.iter().flatten().fold(0.0, |most, entry| entry.abs().max(most))
}

/// How a derivative compares with differences, both in the units of the metric; none where differences do not
/// resolve it.
fn compared<const D: usize>(
    exact: &[f64; D],
    steepest: f64,
    image: impl Fn(f64) -> Option<[f64; D]>,
    (reach, scales): (f64, &[f64; D]),
) -> Option<f64> {
    let lost = Cell::new(false);
    let followed = |h: f64| {
        image(h).unwrap_or_else(|| {
            lost.set(true);
            [0.0; D]
        })
    };
    let found = slope(followed, reach, scales);
    let steepest = steepest.max(FLAT);
    if lost.get() || found.doubt > RESOLVED * steepest {
        return None;
    }
    let errors = (0..D).map(|i| (exact[i] - scales[i] * found.value[i]).abs());
    Some(errors.fold(0.0, f64::max) / steepest)
}

/// The Jacobian of the return map is that of differences.
pub fn derivatives_along_points<M: Subject<D>, const D: usize>() {
    let (mut agree, mut doubtful) = (0, 0);
    for case in M::rich_draws(count(30), 700) {
        let (system, span) = (&case.system, (1, TOLERANCE));
        let Some(point) = point_after(&case, 3) else { continue };
        let scales = system.metric().scales;
        let reach = 1e-3 * system.metric().size(&point);
        let Some(exact) = linearised(system, &point, span) else { continue };
        for column in 0..D {
            // At rest a map has a corner along a velocity: there it is flat on either side.
            if point[column] == 0.0 && (0..D).all(|row| exact[row][column] == 0.0) {
                continue;
            }
            let moved = |h: f64| {
                let mut from = point;
                from[column] += h / scales[column];
                image(system, from, span)
            };
            let along = std::array::from_fn(|row| exact[row][column]);
            match compared(&along, largest(&exact), moved, (reach, &scales)) {
                None => doubtful += 1,
                Some(error) => {
                    assert!(error < AGREES, "{column} {error:e} {exact:?} {point:?}: {system:?}");
                    agree += 1;
                }
            }
        }
    }
    assert!(agree >= doubtful && agree >= 20, "{agree} agree, {doubtful} are doubtful");
}

/// The derivatives of the return map along parameters are those of differences.
pub fn derivatives_along_parameters<M: Subject<D>, const D: usize>() {
    let directions = M::directions();
    let (mut agree, mut doubtful, mut acting) = (0, 0, vec![0; directions.len()]);
    for case in M::rich_draws(count(16), 800) {
        let (system, cycles) = (&case.system, Cycles { count: 1, tolerance: TOLERANCE });
        let Some(point) = point_after(&case, 3) else { continue };
        let metric = system.metric();
        let size = metric.size(&point);
        for (&direction, acts) in directions.iter().zip(&mut acting) {
            if !system.has(direction) {
                continue;
            }
            let own = system.value(direction);
            let dual = system.system(|other| match other == direction {
                true => Dual::<f64, 1>::variable(own, 0),
                false => Dual::constant(system.value(other)),
            });
            let from = point.map(Dual::<f64, 1>::splat);
            let Ok(end) = returned(&dual, from, &cycles, |_| ()) else { continue };
            // Along the relative change of the parameter, relative to the motion.
            let scales = metric.scales.map(|scale| scale / size);
            let along = std::array::from_fn(|i| end[i].gradient[0] * own * scales[i]);
            let steepest = along.iter().fold(1.0_f64, |most, slope: &f64| most.max(slope.abs()));
            let moved = |h: f64| {
                let system = system.with(direction, own * (1.0 + h));
                image(&system, point, (1, TOLERANCE))
            };
            match compared(&along, steepest, moved, (1e-3, &scales)) {
                None => doubtful += 1,
                Some(error) => {
                    assert!(error < AGREES, "{direction:?} {error:e} {along:?}: {system:?}");
                    agree += 1;
                    *acts += usize::from(along.iter().any(|slope| slope.abs() > 1e-6));
                }
            }
        }
    }
    assert!(agree >= doubtful, "{agree} agree, {doubtful} are doubtful");
    let idle: Vec<_> = directions.iter().zip(&acting).filter(|(_, acts)| **acts == 0).collect();
    assert!(idle.is_empty(), "nothing depends on {idle:?}");
}

/// Two integrations of one motion, at tolerances a hundred times apart, end in one point.
pub fn two_tolerances<M: Subject<D>, const D: usize>() {
    let (mut agree, mut wild) = (0, 0);
    for case in M::draws(count(60), 900) {
        let system = &case.system;
        let Some(point) = point_after(&case, 2) else { continue };
        let metric = system.metric();
        let Some(jacobian) = linearised(system, &point, (3, 1e-12)) else { continue };
        // Where the map stretches, by chaos or near a grazing, it stretches errors too.
        if largest(&jacobian) > 100.0 {
            wild += 1;
            continue;
        }
        let [usual, strict] = [1e-12, 1e-14].map(|tolerance| image(system, point, (3, tolerance)));
        let (Some(usual), Some(strict)) = (usual, strict) else { continue };
        let size = metric.size(&point).max(metric.size(&strict));
        let error = metric.distance(&usual, &strict);
        assert!(error <= 1e-9 * size, "{:e} {point:?}: {system:?}", error / size);
        // With derivatives the steps are others, and the point is the same.
        let dual = system.constant::<Dual<f64, D>>();
        let cycles = Cycles { count: 3, tolerance: 1e-12 };
        let carried =
            returned(&dual, seeded::<D, D>(&point), &cycles, |_| ()).map(|it| values(&it));
        let error = carried.map_or(f64::NAN, |carried| metric.distance(&carried, &strict));
        assert!(error <= 1e-9 * size, "carried {:e} {point:?}: {system:?}", error / size);
        agree += 1;
    }
    assert!(agree > 2 * wild && agree > 20, "{agree} agree, {wild} are stretched");
}
