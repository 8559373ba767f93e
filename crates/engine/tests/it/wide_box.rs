//! Outcomes over the whole box of parameters that users may set: periods that hold, and few undecided.

use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{HistorySpan, Outcome, Proof, Protocol};
use capsulemap_models::capsule::{
    AsPrinted, CapsuleParameters as _, CapsuleState as _, CapsuleSystem, Case, Orbit, Output,
    Parameter, Resistance, State, Switching, simulate,
};
use capsulemap_models::face::samples;

use super::draws;
use super::second_method::follow;

/// Cases of each law; the long form takes 10 000 (CASES=10000).
fn count() -> usize {
    std::env::var("CASES").ok().and_then(|count| count.parse().ok()).unwrap_or(300)
}

/// How far two section points are apart, a displacement r counting as omega r [m/s].
fn apart(a: &[f64; 3], b: &[f64; 3], omega: f64) -> f64 {
    (omega * (a[0] - b[0]).abs()).max((a[1] - b[1]).abs()).max((a[2] - b[2]).abs())
}

/// The section points of the motion from the orbit's own, without derivatives and more accurately.
fn points(case: &Case, orbit: &Orbit) -> Vec<[f64; 3]> {
    let [r, y1, y2] = orbit.section[0].array();
    let start = State::of([r, y1, 0.0, y2]);
    let run = simulate(&case.parameters, case.section_phase, start, orbit.period, 1e-14);
    run.section.iter().map(|sample| [sample.r, sample.y1, sample.y2]).collect()
}

#[test]
fn no_period_is_wrong_and_few_cases_are_undecided() {
    let protocol = Protocol::default();
    for (name, law) in Resistance::NAMES {
        let cases = draws::wide(count(), 21, law);
        let orbits = draws::settled(&cases, &protocol, Instructions::widest());
        let (mut defects, mut undecided, mut failed) = (Vec::new(), Vec::new(), 0);
        for (number, (case, orbit)) in cases.iter().zip(&orbits).enumerate() {
            let about = || format!("{name}, case {number}: {case:?}");
            let defect = orbit.outputs[Output::IntegrationDefect];
            defects.push(defect);
            let is_sound = defect <= 1e4 * protocol.tolerance;
            assert!(is_sound || orbit.certificate.proof == Proof::None, "{}", about());
            match orbit.outcome {
                Outcome::Periodic => check_period(case, orbit, &about()),
                Outcome::Undecided => undecided.push(number),
                Outcome::Failed => failed += 1,
                Outcome::Chaotic | Outcome::QuasiPeriodic => {}
            }
        }
        defects.sort_by(f64::total_cmp);
        let share = |share: f64| defects[((defects.len() - 1) as f64 * share) as usize];
        println!(
            "{name}: defects: median {:.1e}, 90 % below {:.1e}, 99 % below {:.1e}, largest {:.1e}; \
             undecided {undecided:?}, failed {failed}",
            share(0.5),
            share(0.9),
            share(0.99),
            share(1.0)
        );
        assert_eq!(failed, 0, "{name}");
        // In a medium without a drive motion dies down without end, and slowly where the drag is weak.
        assert!(100 * undecided.len() <= 2 * cases.len(), "{name}: {undecided:?}");
    }
}

/// The friction as Eq. (1) of the paper prints it, where rest is held by more than f_s: motions that repeat are certified.
#[test]
fn as_printed_no_period_is_wrong_and_few_cases_that_repeat_are_undecided() {
    for law in [Resistance::CoulombStribeck, Resistance::Coulomb] {
        let mut cases = draws::wide(count(), 21, law);
        cases.iter_mut().for_each(|case| case.parameters.switch_by(Switching::AsPrinted));
        let orbits = draws::settled(&cases, &Protocol::default(), Instructions::widest());
        let (mut held, mut undecided) = (0, 0);
        for (number, (case, orbit)) in cases.iter().zip(&orbits).enumerate() {
            let about = format!("{}, case {number}: {case:?}", law.name());
            if orbit.outcome == Outcome::Periodic {
                check_period(case, orbit, &about);
            }
            // Held at rest: f_s < |F| < f_d(0+) in a part of the cycle.
            let drag = case.parameters.drag();
            let rests = orbit.outputs[Output::StickShare] == 1.0 && orbit.end.capsule().y2 == 0.0;
            if !rests || drag.static_limit >= drag.at_onset {
                continue;
            }
            undecided += usize::from(orbit.outcome == Outcome::Undecided);
            if orbit.outcome == Outcome::Periodic && orbit.period <= 4 && is_held(case, orbit) {
                held += 1;
                comes_back(case, orbit, &about);
            }
        }
        println!("{}: {held} held at rest, {undecided} undecided", law.name());
        assert!(held > 10 && undecided == 0, "{}: {held} {undecided}", law.name());
    }
}

/// Whether the force on the capsule at rest exceeds f_s in a part of the period.
fn is_held(case: &Case, orbit: &Orbit) -> bool {
    let p = &case.parameters;
    let span = HistorySpan { cycles: orbit.period as u32, per_cycle: 400, from_start: true };
    let [r, y1, y2] = orbit.section[0].array();
    let from = Case::at_section(p.clone(), State::of([r, y1, 0.0, y2]), case.section_phase);
    let history =
        samples::<CapsuleSystem<AsPrinted>, 3>(&from, span, 1e-12).expect("it goes on").histories;
    let force = |state: &State<f64>| {
        let contact = p[Parameter::K2] * (state.r - p[Parameter::Delta]).max(0.0);
        p[Parameter::K1] * state.r + contact + p[Parameter::C] * (state.y1 - state.y2)
    };
    let limit = 1.01 * p.drag().static_limit;
    (0..history[0].len()).any(|at| force(&(&p.model().state_of(&history, at)).into()).abs() > limit)
}

/// A push of the capsule off rest, either way, has died after a period: without derivatives, the multiplier 0.
fn comes_back(case: &Case, orbit: &Orbit, about: &str) {
    let omega = case.parameters[Parameter::Omega];
    let [r, y1, _] = orbit.section[0].array();
    let size = points(case, orbit).iter().map(|it| apart(it, &[0.0; 3], omega)).fold(0.0, f64::max);
    for push in [1e-7, -1e-7] {
        let start = State::of([r, y1, 0.0, push * size]);
        let run = simulate(&case.parameters, case.section_phase, start, orbit.period, 1e-13);
        let end = run.section.last().expect("a section");
        assert_eq!(end.y2, 0.0, "{about}");
        // What is left is the push in (r, y1), which the damper has carried there.
        let moved = (omega * (end.r - r)).abs().max((end.y1 - y1).abs());
        assert!(moved <= 1e-7 * size * 10.0, "{moved:e}: {about}");
    }
    assert!(orbit.certificate.multipliers[2].abs() < 1e-9, "{about}");
}

/// The section repeats after the period, and after no divisor of it.
fn check_period(case: &Case, orbit: &Orbit, about: &str) {
    let omega = case.parameters[Parameter::Omega];
    let points = points(case, orbit);
    let size = |point: &[f64; 3]| apart(point, &[0.0; 3], omega);
    let largest = points.iter().map(size).fold(0.0, f64::max);
    if largest < 1e-12 {
        return; // at rest
    }
    let k = orbit.period as usize;
    let closes = apart(&points[0], &points[k], omega) / largest;
    assert!(closes < 1e-6, "{about}: {closes:e} after {k}");
    for divisor in (1..k).filter(|&j| k.is_multiple_of(j)) {
        let repeats = apart(&points[0], &points[divisor], omega) / largest;
        assert!(repeats > 1e-8 && repeats > 10.0 * closes, "{about}: {repeats:e} after {divisor}");
    }
}

#[test]
fn certified_orbits_are_those_of_a_second_method() {
    let (mut met, mut worst) = (0, 0.0_f64);
    for (_, law) in Resistance::NAMES {
        let cases = draws::wide(count() / 10, 22, law);
        for (case, orbit) in
            cases.iter().zip(draws::settled(&cases, &Protocol::default(), Instructions::widest()))
        {
            let p = &case.parameters;
            // The second method takes hundreds of times as long: fast drives only.
            let is_quick =
                p[Parameter::Omega] > 10.0 && orbit.period <= 4 && p[Parameter::Pd] > 0.0;
            if orbit.outcome != Outcome::Periodic || !is_quick {
                continue;
            }
            let [r, y1, y2] = orbit.section[0].array();
            let sections = follow(p, case.section_phase, State::of([r, y1, 0.0, y2]), orbit.period);
            let omega = p[Parameter::Omega];
            let end = sections.last().expect("the start");
            let size = apart(&orbit.section[0].array(), &[0.0; 3], omega);
            let gap = apart(&orbit.section[0].array(), &[end[0], end[1], end[3]], omega) / size;
            let speed = end[2] / (orbit.period as f64 * p.drive_period());
            let misses = (speed - orbit.outputs[Output::ProgressionSpeed]).abs() / size;
            assert!(gap < 1e-7 && misses < 1e-7, "{gap:e} {misses:e}: {case:?}");
            worst = worst.max(gap).max(misses);
            met += 1;
        }
    }
    println!("{met} orbits, the worst {worst:.1e} of the velocity off");
    assert!(met > count() / 10, "{met}");
}
