//! The laws of steps: guards keep their sign between events, and the polynomials of a step solve the equations.

use capsulemap_engine::flow::defect::defect;
use capsulemap_engine::flow::metric::greater;
use capsulemap_engine::flow::{
    Field, Motion, STEPS_PER_CYCLE, Step, Stroboscopic, Switched, System, cycle,
};
use capsulemap_engine::lane::{Dual, ORDER, Series, series};
use capsulemap_engine::orbit::Case;
use capsulemap_engine::orbit::return_map::{Cycles, returned};

use super::subject::{Subject, count};

const TOLERANCE: f64 = 1e-12;
/// Places within a step at which guards are evaluated.
const PLACES: u32 = 16;
/// A guard is known to so many roundings of the numbers that it is a difference of.
const ROUNDINGS: f64 = 64.0 * f64::EPSILON;

type StepOf<M, const D: usize> = Step<f64, <M as System<D>>::Single>;

/// The magnitude of the terms of a polynomial on [0, h], each weighted with the error of its power of time.
fn magnitude(polynomial: &Series<f64>, h: f64) -> f64 {
    let terms = (0..=ORDER).rev();
    terms.fold(0.0, |sum, k| sum * h + (k + 1) as f64 * polynomial[k].abs())
}

/// How far below zero each watched guard falls within a step, and how far from zero the nearest one is at its
/// end, in units of what rounding explains.
fn guards<M: Subject<D>, const D: usize>(
    case: &Case<M, D>,
    system: &M::Single,
    step: &StepOf<M, D>,
) -> (f64, f64) {
    let (mut deepest, mut nearest) = (0.0, f64::INFINITY);
    let begins = system.beginning(&step.jet);
    for which in 0..M::Single::GUARDS {
        if !system.watched(which, &step.mode) {
            continue;
        }
        let mut guard = series::zero();
        system.guard(which, &step.mode, &step.jet, &mut guard);
        let terms = case.system.terms(which, &step.mode, &begins);
        // A surface that the field of a mode keeps to, as creeping does, is left to the tolerance only.
        if guard[0] < 0.0 && -guard[0] <= TOLERANCE * terms {
            guard[0] = 0.0;
        }
        let rounding = |h: f64| ROUNDINGS * (magnitude(&guard, h) + terms);
        for place in 0..=PLACES {
            let h = step.length * f64::from(place) / f64::from(PLACES);
            let below = -series::value(&guard, h);
            deepest = greater(deepest, if below > 0.0 { below / rounding(h) } else { 0.0 });
        }
        let end = series::value(&guard, step.length).abs();
        nearest = nearest.min(if end == 0.0 { 0.0 } else { end / rounding(step.length) });
    }
    (deepest, nearest)
}

/// No guard is below zero between events, and one of them is at zero where an event is.
pub fn guard_signs<M: Subject<D>, const D: usize>() {
    let (mut steps, mut events) = (0, 0);
    for seed in 0..3 {
        for case in M::draws(count(40), 400 + seed) {
            let system = case.system.single();
            let mut motion = Motion::new(&system, case.begins, case.start);
            let mut step = Step::default();
            for _ in 0..6 {
                let ended =
                    cycle(&system, &mut motion, &mut step, (STEPS_PER_CYCLE, TOLERANCE), |step| {
                        let (deepest, nearest) = guards(&case, &system, step);
                        let at = step.start;
                        // A step without length is an event that is due at once, in a mode that does not last.
                        let lasts = step.length > 0.0;
                        assert!(!lasts || deepest <= 1.0, "{deepest:e} at {at}: {:?}", case.system);
                        if step.event != 0.0 {
                            assert!(nearest <= 1.0, "event {nearest:e} at {at}: {:?}", case.system);
                            events += 1;
                        }
                        steps += 1;
                    });
                if ended.is_err() {
                    break;
                }
            }
        }
    }
    assert!(steps > 1000, "{steps} steps");
    assert_eq!(events > 300, M::Single::GUARDS > 0, "{events} events");
}

/// A guard that is written without derivatives has the bits of the one with them.
pub fn plain_guards<M: Subject<D>, const D: usize>() {
    let mut compared = 0;
    for case in M::draws(count(20), 450) {
        let system = case.system.constant::<Dual<f64, 1>>();
        let point = M::Single::point(&case.start).map(|x| Dual { value: x, gradient: [1.0] });
        let cycles = Cycles { count: 3, tolerance: TOLERANCE };
        // A motion that cannot be followed has been compared as far as it goes.
        let _ = returned(&system, point, &cycles, |step| {
            for which in 0..M::Single::GUARDS {
                let (mut guard, mut room) = (series::zero(), series::zero());
                let mut plain: Series<f64> = series::zero();
                system.guard(which, &step.mode, &step.jet, &mut guard);
                system.plain_guard(which, &step.mode, &step.jet, &mut room, &mut plain);
                let bits = |series: &Series<f64>| series.map(f64::to_bits);
                assert_eq!(
                    bits(&plain),
                    bits(&series::plain(&guard)),
                    "{which}: {:?}",
                    case.system
                );
                compared += 1;
            }
        });
    }
    assert_eq!(compared > 300, M::Single::GUARDS > 0, "{compared} guards");
}

/// Every step satisfies the equations to the order of the tolerance, relative to the motion.
pub fn defects<M: Subject<D>, const D: usize>() {
    let mut followed = 0;
    for seed in 0..3 {
        let cases = M::draws(count(40), 500 + seed);
        for case in &cases {
            let system = case.system.single();
            let mut motion = Motion::new(&system, case.begins, case.start);
            let mut step = Step::default();
            let (mut largest, mut size) = (0.0, 0.0_f64);
            let weights = system.weights();
            let lasts = (0..6).all(|_| {
                let ended =
                    cycle(&system, &mut motion, &mut step, (STEPS_PER_CYCLE, TOLERANCE), |step| {
                        largest = greater(largest, defect(&system, step));
                        let begins = M::Single::coordinates(&system.beginning(&step.jet));
                        for (x, weight) in begins.as_ref().iter().zip(weights.as_ref()) {
                            size = size.max((weight * x).abs());
                        }
                    });
                ended.is_ok()
            });
            followed += usize::from(lasts);
            assert!(largest <= 1e4 * TOLERANCE * size, "{:e}: {:?}", largest / size, case.system);
        }
    }
    assert!(followed > 60, "only {followed} can be followed");
}

/// The function of the section of an autonomous system falls through zero only where a return is told: it is looked
/// at 32 times in each step. An event that moves the state may take it across.
pub fn every_return<M: Subject<D>, const D: usize>() {
    let mut told = 0;
    for case in M::draws(count(60), 700) {
        let system = case.system.single();
        let mut motion = Motion::new(&system, case.begins, case.start);
        let mut step = Step::default();
        for _ in 0..if M::Single::AUTONOMOUS { 20 } else { 0 } {
            let mut above = false;
            let ended =
                cycle(&system, &mut motion, &mut step, (STEPS_PER_CYCLE, TOLERANCE), |step| {
                    let mut section = series::zero();
                    system.section(&step.jet, &mut section);
                    let rounding = ROUNDINGS * magnitude(&section, step.length);
                    for i in 0..=32 {
                        let value = series::value(&section, step.length * f64::from(i) / 32.0);
                        assert!(
                            !above || value >= -rounding,
                            "a return is missed: {:?}",
                            case.system
                        );
                        above = value > rounding;
                    }
                    above &= step.event == 0.0 && !step.arrives;
                });
            if ended.is_err() {
                break;
            }
            told += 1;
        }
    }
    assert!(!M::Single::AUTONOMOUS || told > 300, "{told} returns");
}

/// The section of an autonomous system is where its function vanishes, to rounding; that of a driven one is a
/// period after the one before.
pub fn sections<M: Subject<D>, const D: usize>() {
    let mut met = 0;
    for case in M::draws(count(60), 600) {
        let system = case.system.single();
        let mut motion = Motion::new(&system, case.begins, case.start);
        let mut step = Step::default();
        for _ in 0..6 {
            let ended =
                cycle(&system, &mut motion, &mut step, (STEPS_PER_CYCLE, TOLERANCE), |_| ());
            let Ok(duration) = ended else { break };
            met += 1;
            if !M::Single::AUTONOMOUS {
                assert_eq!(duration.to_bits(), system.period().to_bits());
                continue;
            }
            let mut section = series::zero();
            system.section(&step.jet, &mut section);
            let value = series::value(&section, step.length);
            let rounding = ROUNDINGS * magnitude(&section, step.length);
            assert!(value.abs() <= rounding, "{value:e} {rounding:e}: {:?}", case.system);
        }
    }
    assert!(met > 100, "{met} sections");
}
