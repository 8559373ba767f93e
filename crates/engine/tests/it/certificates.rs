//! Periods are what they are called: against a stricter run, a known false one, and the motion itself.

use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{Outcome, Proof, Protocol};
use capsulemap_models::capsule::{Case, Output, State, settle, simulate};

use super::draws;

/// Cases to re-run; the long form takes 2000 (CASES=2000).
fn count() -> usize {
    std::env::var("CASES").ok().and_then(|count| count.parse().ok()).unwrap_or(400)
}

#[test]
fn a_stricter_run_finds_the_same_periods() {
    let cases = draws::cases(count(), 77);
    let usual = Protocol::default();
    let strict = Protocol {
        tolerance: 0.1 * usual.tolerance,
        recurrence: 0.1 * usual.recurrence,
        max_cycles: 10 * usual.max_cycles,
        exponent_cycles: 10 * usual.exponent_cycles,
        ..usual
    };
    let [once, again] =
        [usual, strict].map(|protocol| draws::settled(&cases, &protocol, Instructions::widest()));
    let (mut periodic, mut elsewhere, mut undecided, mut decided) = (0, 0, 0, 0);
    let mut transient = 0;
    for (number, (once, again)) in once.iter().zip(&again).enumerate() {
        match once.outcome {
            Outcome::Periodic => {
                periodic += 1;
                if (again.outcome, again.period) != (Outcome::Periodic, once.period) {
                    // Where attractors coexist, the tolerance may decide where the start leads to: then
                    // the motion on the orbit that was found must keep the period.
                    elsewhere += 1;
                    let Case { parameters, section_phase: phase, .. } = &cases[number];
                    let [r, y1, y2] = once.section[0].array();
                    let kept = settle(parameters, *phase, State::of([r, y1, 0.0, y2]), &strict);
                    let same = (kept.outcome, kept.period) == (Outcome::Periodic, once.period);
                    assert!(same, "case {number}: {} then {}", once.period, kept.period);
                }
            }
            Outcome::Undecided => {
                undecided += 1;
                decided += usize::from(again.outcome != Outcome::Undecided);
            }
            // Chaos may be a transient that outlasts the usual budget.
            Outcome::Chaotic => transient += usize::from(again.outcome != Outcome::Chaotic),
            Outcome::QuasiPeriodic | Outcome::Failed => {}
        }
    }
    println!(
        "{periodic} periodic, of which {elsewhere} starts led elsewhere in the stricter run; \
         {undecided} undecided, of which {decided} were decided by it; {transient} chaotic only for a while"
    );
    assert!(periodic > cases.len() * 9 / 10);
    assert!(1000 * (elsewhere + transient) <= cases.len());
}

#[test]
fn a_multiplier_near_minus_one_is_no_period_two() {
    // Its section repeats after two cycles to 1e-11 while it is still 4e-9 from repeating after one: a pair
    // of multipliers of magnitude 0.989 turns it by nearly half a turn each cycle.
    let case = draws::cases(104_983, 3).pop().expect("a case");
    for accelerate in [true, false] {
        let protocol = Protocol { accelerate, ..Protocol::default() };
        let orbit = settle(&case.parameters, case.section_phase, &case.start, &protocol);
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
        let &[first, ..] = &orbit.certificate.multipliers[..] else { panic!("multipliers") };
        assert!(first.re < -0.9 && first.abs() < 1.0, "{first:?}");
    }
}

#[test]
fn a_certified_orbit_closes_and_answers_pushes_as_its_multipliers_say() {
    let cases = draws::cases(100, 31);
    for case in &cases {
        let orbit = settle(&case.parameters, case.section_phase, &case.start, &Protocol::default());
        if orbit.outcome != Outcome::Periodic {
            continue;
        }
        assert_eq!(orbit.certificate.proof, Proof::Newton);
        assert!(orbit.outputs[Output::SectionResidual] < 1e-10);
        assert!(orbit.certificate.is_stable());
        assert_eq!(
            orbit.outputs[Output::LargestMultiplier],
            orbit.certificate.multipliers[0].abs()
        );
        // Continued by the plain flow, the section repeats after the period and after no divisor of it.
        let [r, y1, y2] = orbit.section[0].array();
        let start = State::of([r, y1, 0.0, y2]);
        let run = simulate(&case.parameters, case.section_phase, start, orbit.period, 1e-13);
        let gap = |n: usize| {
            let (a, b) = (&run.section[0], &run.section[n]);
            (a.y1 - b.y1).abs().max((a.y2 - b.y2).abs()).max((a.r - b.r).abs())
        };
        let k = orbit.period as usize;
        for divisor in (1..k).filter(|&j| k.is_multiple_of(j)) {
            assert!(gap(divisor) > 100.0 * gap(k), "period {k}, divisor {divisor}");
        }
    }
}
