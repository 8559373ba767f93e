//! Leaping to where the section tends reaches what waiting reaches.

use capsulemap::capsule::{Output, State, settle};
use capsulemap::lane::Instructions;
use capsulemap::orbit::{Outcome, Protocol};

use super::draws;

/// So many random cases; `CASES=100000 cargo test --release --test it -- acceleration --nocapture` for long.
fn count() -> usize {
    std::env::var("CASES").map_or(500, |text| text.parse().expect("CASES is a number"))
}

#[test]
fn a_leap_ends_on_the_attractor_of_plain_iteration() {
    let cases = draws::cases(count(), 3);
    let accelerated = Protocol::default();
    let plain = Protocol { accelerate: false, ..accelerated };
    let settled = |protocol: &Protocol| draws::settled(&cases, protocol, Instructions::widest());
    let (fast, slow) = (settled(&accelerated), settled(&plain));
    let (mut both, mut more, mut fewer, mut cycles) = (0, 0, 0, [0, 0]);
    let mut others = Vec::new();
    for (i, (fast, slow)) in fast.iter().zip(&slow).enumerate() {
        match (fast.outcome, slow.outcome) {
            (Outcome::Periodic, Outcome::Periodic) => both += 1,
            (Outcome::Periodic, _) => more += 1,
            (_, Outcome::Periodic) => fewer += 1,
            _ => {}
        }
        if (fast.outcome, slow.outcome) != (Outcome::Periodic, Outcome::Periodic) {
            continue;
        }
        cycles = [cycles[0] + fast.cycles, cycles[1] + slow.cycles];
        let of = |output: Output| (fast.outputs[output], slow.outputs[output]);
        let (speed, expected) = of(Output::ProgressionSpeed);
        let (work, expected_work) = of(Output::WorkNet);
        let alike = (speed - expected).abs() <= 1e-8 + 1e-6 * expected.abs()
            && (work - expected_work).abs() <= 1e-6 * expected_work.abs();
        if fast.period != slow.period || !alike {
            // Where attractors coexist, a start between their basins may lead to either: waiting, the
            // motion stays on the orbit that the leap has led to.
            let (case, [r, y1, y2]) = (&cases[i], fast.section[0]);
            let start = State { r, y1, x2: 0.0, y2 };
            let stays = settle(&case.parameters, case.section_phase, start, &plain);
            assert_eq!((stays.outcome, stays.period), (Outcome::Periodic, fast.period), "{i}");
            let away = (stays.outputs[Output::ProgressionSpeed] - speed).abs();
            assert!(away <= 1e-8 + 1e-6 * speed.abs(), "case {i}: {away}");
            others.push((i, fast.period, slow.period, speed, expected));
        }
    }
    println!(
        "{both} periodic with and without, in {} and {} cycles; {more} by leaping alone, {fewer} by waiting \
         alone; on another attractor: {:?}",
        cycles[0], cycles[1], others
    );
    assert!(both > cases.len() * 8 / 10 && cycles[0] * 2 < cycles[1]);
    assert!(fewer <= more, "leaping decides no fewer");
    // Of 198 188 such cases none did.
    assert!(others.len() * 100_000 <= cases.len(), "{others:?}");
}

#[test]
fn whoever_asks_for_period_one_alone_is_served_as_fast() {
    let cases = draws::cases(100, 4);
    let cycles = |protocol: &Protocol| -> u64 {
        let orbits = draws::settled(&cases, protocol, Instructions::widest());
        // Longer periods are found only after the budget of cycles, with and without acceleration.
        let periodic = orbits.iter().filter(|orbit| orbit.period == 1);
        periodic.map(|orbit| orbit.cycles).sum()
    };
    let leaping = Protocol { max_period: 1, ..Protocol::default() };
    let waiting = Protocol { accelerate: false, ..leaping };
    assert!(cycles(&leaping) * 2 < cycles(&waiting));
}
