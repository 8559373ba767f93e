//! Attractors along an axis: grazing against its closed form, coexistence, period doubling, any number of
//! threads.

use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};

use capsulemap::branch::SpecialKind;
use capsulemap::capsule::{CapsuleSystem, Filippov, Output, Parameter};
use capsulemap::flow::System;
use capsulemap::orbit::matrix::eigenvalues;
use capsulemap::orbit::newton::close;
use capsulemap::orbit::passage::{OneByOne, image};
use capsulemap::orbit::return_map::Cycles;
use capsulemap::orbit::{Outcome, Proof, Protocol};
use capsulemap::run::{self, AttractorEvent, Attractors, FinalMotions, Machine, Record};
use capsulemap::store;
use capsulemap::study::Study;

use super::program::{TWO_MOTIONS, WorkDir};

fn study(text: &str) -> Study {
    Study::parse("study.toml", text).unwrap_or_else(|faults| panic!("{faults}"))
}

fn records(study: &Study) -> Vec<Record> {
    let records = std::sync::Mutex::new(Vec::new());
    run::run(study, Machine::default(), |record| records.lock().expect("a lock").push(record))
        .expect("the study runs");
    let mut records = records.into_inner().expect("a lock");
    records.sort_by_key(|record| record.index);
    records
}

fn found(study: &Study, records: &[Record]) -> Attractors {
    on(study, &run::final_motions(study, records), Machine::default())
}

fn on(study: &Study, final_motions: &FinalMotions, machine: Machine) -> Attractors {
    run::attractors(study, final_motions, machine, || ()).expect("the threads start")
}

/// The frequency of the two motions on an axis, with the starts that `start` says.
fn window(from: f64, to: f64, points: usize, start: &str) -> String {
    format!(
        "{TWO_MOTIONS}[[axes]]\nname = \"omega\"\nfrom = \"{from} rad/s\"\nto = \"{to} rad/s\"\n\
         points = {points}\n{start}\n"
    )
}

/// The capsule of `studies/cascade.toml` over the frequency.
fn cascade(omega: &str) -> String {
    format!(
        "[parameters]\nc = \"0.44 N s/m\"\nmu_s = 0.437\nmu_d = 0.2185\np_d = \"3.4 N\"\n\
         k2 = \"86.8 kN/m\"\ndelta = \"2.45 mm\"\n[[axes]]\nname = \"omega\"\n{omega}\n"
    )
}

const BOTH_DIRECTIONS: &str =
    "[start]\ninherit = \"omega\"\ndirections = [\"upward\", \"downward\"]";

#[test]
fn grazing_of_the_stuck_capsule_is_where_its_amplitude_is_the_gap() {
    let cases = [
        ("2.42", 77.91, 3.5),
        ("18.96", 20.73, 1.5),
        ("59.41", 26.58, 1.5),
        ("59.41", 37.33, 1.5),
        ("59.41", 46.0, 1.5),
        ("59.41", 54.6, 1.5),
    ];
    let mut left_out = Vec::new();
    for (k2, omega, delta) in cases {
        let (m1, m2, k1, c, mu_s, g) = (0.11, 0.53, 1420.0, 3.89, 0.66, 9.81);
        let gap = delta * 1e-3;
        let z = f64::hypot(k1 - m1 * omega * omega, c * omega);
        let contact = gap * z;
        let slip = mu_s * (m1 + m2) * g * z / f64::hypot(k1, c * omega);
        if slip < contact {
            left_out.push(omega);
            continue;
        }
        let study = study(&format!(
            "[parameters]\nk2 = \"{k2} kN/m\"\nomega = \"{omega} rad/s\"\ndelta = \"{delta} mm\"\n\
             [[axes]]\nname = \"p_d\"\nfrom = \"{} N\"\nto = \"{} N\"\npoints = 6\n",
            0.9 * contact,
            1.02 * contact
        ));
        let attractors = found(&study, &records(&study));
        assert!(attractors.of_case.iter().all(|it| *it == Some(0)), "{attractors:?}");
        let first = attractors.events.first().expect("an event");
        assert_eq!((first.kind, first.period), (SpecialKind::Grazing, 1), "{omega}");
        let off = (first.value / contact - 1.0).abs();
        assert!(off < 1e-8 && first.uncertainty < 1e-11 * contact, "{omega}: {off:e} {first:?}");
    }
    // In Fig 5 the capsule slips before the mass reaches the stop.
    assert_eq!(left_out, [77.91]);
}

#[test]
fn two_certified_attractors_coexist_between_two_folds() {
    let study = study(&window(150.0, 166.0, 33, BOTH_DIRECTIONS));
    let records = records(&study);
    let attractors = found(&study, &records);
    for (at, omega) in study.axes()[0].varying[0].values.iter().enumerate() {
        let here = [attractors.of_case[2 * at], attractors.of_case[2 * at + 1]];
        let expected = match *omega {
            omega if omega < 151.018 => [Some(0); 2],
            omega if omega < 164.1 => [Some(0), Some(1)],
            _ => [Some(1); 2],
        };
        assert_eq!(here, expected, "{omega}");
        for record in &records[2 * at..2 * at + 2] {
            assert_eq!((record.orbit.outcome, record.orbit.period), (Outcome::Periodic, 1));
            assert_eq!(record.orbit.certificate.proof, Proof::Newton);
        }
    }
    let folds: Vec<&AttractorEvent> =
        attractors.events.iter().filter(|event| event.kind == SpecialKind::Fold).collect();
    let [low, high] = folds[..] else { panic!("{folds:?}") };
    assert_eq!((low.attractor, high.attractor), (1, 0));
    assert!((low.value - 151.018).abs() < 1e-3 && (high.value - 164.1555).abs() < 1e-3);
}

#[test]
fn an_attractor_that_no_start_shows_in_between_keeps_its_number() {
    // An orbit of period 3 beside one of period 1 and 2, which only some starts from rest lead to.
    let study = study(&cascade(
        "from = \"39.3 rad/s\"\nto = \"40.1 rad/s\"\npoints = 81\n\
         [start]\ninherit = \"omega\"\ndirections = [\"upward\", \"afresh\"]",
    ));
    let records = records(&study);
    let linked = AtomicUsize::new(0);
    let note = || {
        linked.fetch_add(1, Ordering::Relaxed);
    };
    let final_motions = run::final_motions(&study, &records);
    let attractors = run::attractors(&study, &final_motions, Machine::default(), note)
        .expect("the threads start");
    assert_eq!((linked.into_inner(), run::links(&study)), (80, 80));
    let seen: Vec<usize> = (0..study.cases()).filter(|&i| records[i].orbit.period == 3).collect();
    assert!(seen.len() > 10 && seen.windows(2).any(|pair| pair[1] / 2 - pair[0] / 2 > 3));
    for (case, record) in records.iter().enumerate() {
        let expected = u32::from(record.orbit.period == 3);
        assert_eq!(attractors.of_case[case], Some(expected), "{case}");
    }
}

#[test]
fn a_case_that_falls_to_another_attractor_takes_its_number() {
    // From the orbit of period 3 the next case falls to that of period 1, while both go on attracting.
    let omegas =
        "values = [\"39.3 rad/s\", \"39.65 rad/s\"]\n[start]\ny1 = \"-0.2142857142857143 m/s\"";
    let study = study(&cascade(&format!("{omegas}\ninherit = \"omega\"")));
    let records = records(&study);
    let periods: Vec<u64> = records.iter().map(|record| record.orbit.period).collect();
    assert_eq!(periods, [3, 1]);
    assert_eq!(found(&study, &records).of_case, [Some(0), Some(1)]);
}

#[test]
fn a_period_doubling_among_cases_that_settle_too_slowly_is_located_once() {
    let study = study(&cascade(
        "from = \"39.7975 rad/s\"\nto = \"39.7987 rad/s\"\npoints = 61\n\
         [start]\ninherit = \"omega\"\ndirections = [\"upward\", \"downward\"]",
    ));
    let records = records(&study);
    let undecided = |record: &&Record| record.orbit.outcome == Outcome::Undecided;
    assert!(records.iter().filter(undecided).count() > 5);
    let attractors = found(&study, &records);
    assert!(attractors.of_case.iter().flatten().all(|number| *number == 0));
    let [event] = &attractors.events[..] else { panic!("{:?}", attractors.events) };
    assert_eq!((event.kind, event.period), (SpecialKind::PeriodDoubling, 1));
    assert!((event.value - 39.798_118_915).abs() < 1e-9 && event.uncertainty < 1e-10, "{event:?}");
}

#[test]
fn a_parameter_may_begin_at_zero() {
    let study = study(
        "[parameters]\nomega = \"77.91 rad/s\"\nk2 = \"2.42 kN/m\"\ndelta = \"0 mm\"\n\
         [[axes]]\nname = \"p_d\"\nvalues = [\"0 N\", \"0.5 N\", \"1 N\"]\n",
    );
    let records = records(&study);
    assert!(records.iter().all(|record| record.orbit.outcome == Outcome::Periodic));
    for event in found(&study, &records).events {
        assert!(event.uncertainty > 1e-15 && event.value.is_finite(), "{event:?}");
    }
    // At rest nothing is left but rounding, beside the motion that came to rest.
    let rest = &records[0].orbit.outputs;
    assert!(rest[Output::SectionResidual] < 1e-10 && rest[Output::EnergyResidual].abs() < 1e-10);
}

#[test]
fn attractors_do_not_depend_on_the_threads() {
    let study = study(&window(124.0, 126.0, 21, BOTH_DIRECTIONS));
    let final_motions = run::final_motions(&study, &records(&study));
    let with = |threads: usize| {
        on(&study, &final_motions, Machine { threads: Some(threads), ..Machine::default() })
    };
    let one = with(1);
    assert!(one.events.len() > 4, "{one:?}");
    assert_eq!(one, with(2));
    assert_eq!(one, with(7));
}

#[test]
fn a_line_among_others_has_the_attractors_that_it_has_alone() {
    // Frequencies within a line and forces across lines, with so many starts that threads share a cell.
    let omegas = "values = [\"39.3 rad/s\", \"39.65 rad/s\", \"40.1 rad/s\"]";
    let starts = "[[axes]]\nname = \"start_y1\"\nfrom = \"-0.3 m/s\"\nto = \"0.3 m/s\"\npoints = 40\n\
                  [start]\ninherit = \"omega\"\ndirections = [\"afresh\"]";
    let force = |values: &str| format!("[[axes]]\nname = \"p_d\"\nvalues = {values}\n{starts}");
    let text = cascade(omegas).replace("p_d = \"3.4 N\"\n", "");
    let study_at = |values: &str| study(&format!("{text}{}", force(values)));
    let both = study_at("[\"3.4 N\", \"3.41 N\"]");
    let final_motions = run::final_motions(&both, &records(&both));
    let with = |threads: usize| {
        on(&both, &final_motions, Machine { threads: Some(threads), ..Machine::default() })
    };
    let together = with(1);
    assert_eq!(together, with(2));
    let mut events = Vec::new();
    for (line, force) in ["[\"3.4 N\"]", "[\"3.41 N\"]"].into_iter().enumerate() {
        let study = study_at(force);
        let alone = found(&study, &records(&study));
        let cells = together.of_case.chunks(40).skip(line).step_by(2);
        assert!(cells.flatten().eq(&alone.of_case), "{force}");
        assert!(alone.of_case.contains(&Some(1)), "{force}: just one attractor");
        events.extend(alone.events);
    }
    let values = |events: &[AttractorEvent]| -> Vec<f64> {
        events.iter().map(|event| event.value).collect()
    };
    assert_eq!(values(&together.events), values(&events));
}

#[test]
fn a_case_that_is_missing_leaves_the_others_linked() {
    let study = study(&window(150.0, 166.0, 33, BOTH_DIRECTIONS));
    let records = records(&study);
    let whole = found(&study, &records);
    // Single cases of four cells, and both of a fifth: what attracts there is followed on to the next.
    let gone = [0, 9, 20, 21, 40, 65];
    let left: Vec<Record> =
        records.into_iter().filter(|record| !gone.contains(&record.index)).collect();
    let attractors = found(&study, &left);
    for (case, expected) in whole.of_case.iter().enumerate() {
        let expected = expected.filter(|_| !gone.contains(&case));
        assert_eq!(attractors.of_case[case], expected, "{case}");
    }
}

#[test]
fn a_multiplier_is_minus_one_where_the_period_doubles() {
    let study = study(&window(124.6, 125.0, 5, BOTH_DIRECTIONS));
    let attractors = found(&study, &records(&study));
    let doubles = |event: &&AttractorEvent| event.kind == SpecialKind::PeriodDoubling;
    let events: Vec<&AttractorEvent> = attractors.events.iter().filter(doubles).collect();
    assert!(events.iter().any(|event| event.period == 1), "{events:?}");
    for event in events {
        let mut parameters = study.base.clone();
        parameters[Parameter::Omega] = event.value;
        let capsule = CapsuleSystem::<Filippov>::new(parameters, 0.0);
        let metric = capsule.metric();
        let tolerance = Protocol::default().tolerance;
        let cycles = Cycles { count: event.period, tolerance };
        let orbit = close(
            |point| image(&OneByOne, &capsule, point, &cycles),
            cycles.count,
            &metric,
            &event.section.array(),
            0.5,
        )
        .expect("the integration continues");
        let orbit = orbit.expect("an orbit");
        assert!(orbit.residual < 1e-11, "{orbit:?}");
        let from = |it: &capsulemap::orbit::matrix::Complex| f64::hypot(it.re + 1.0, it.im);
        let nearest = eigenvalues(&orbit.jacobian).iter().map(from).fold(1.0, f64::min);
        assert!(nearest < 1e-6, "{event:?}: {nearest:e}");
    }
}

#[test]
fn given_starts_and_both_directions_meet_in_one_study() {
    let start = "[[axes]]\nname = \"start_y1\"\nvalues = [\"0 m/s\", \"0.5 m/s\", \"-1 m/s\"]\n\
                 [start]\ninherit = \"omega\"\ndirections = [\"upward\", \"downward\", \"afresh\"]";
    let study = study(&window(150.0, 165.0, 16, start));
    assert_eq!(study.cases(), 16 * 3 * 3);
    let mut seen: Vec<usize> = (0..study.chains()).flat_map(|number| study.chain(number)).collect();
    assert_eq!(study.chains(), 3 * (2 + 16));
    seen.sort_unstable();
    assert!(seen.into_iter().eq(0..study.cases()));
    let attractors = found(&study, &records(&study));
    for (at, here) in attractors.of_case.chunks(9).enumerate() {
        let omega = study.axes()[0].varying[0].values[at];
        let mut known: Vec<u32> = here.iter().map(|it| it.expect("an attractor")).collect();
        known.sort_unstable();
        known.dedup();
        let several = (151.1..164.1).contains(&omega);
        assert_eq!(known.len(), if several { 2 } else { 1 }, "{omega}: {here:?}");
    }
}

#[test]
fn the_file_lists_the_events_and_the_figure_shows_them() {
    let dir = WorkDir::new();
    let figure = "[[figures]]\nname = \"diagram\"\nkind = \"bifurcation\"";
    dir.put("two.toml", window(150.0, 166.0, 33, &format!("{BOTH_DIRECTIONS}\n{figure}")));
    dir.run(&["sweep", "two.toml", "--formats", "svg,png"]).done();
    let dataset = store::read(&dir.path("results/two/two.h5")).expect("a file of results");
    let column = |name: &str| dataset.variable(name).expect(name).values.to_real();
    let kinds = column("event_kind");
    let events = column("event_omega");
    assert_eq!(kinds.len(), events.len());
    assert!(events.iter().any(|omega| (omega - 164.1555).abs() < 1e-3), "{events}");
    assert_eq!(column("attractor").shape(), [33, 2]);
    assert_eq!(dataset.attributes.get("attractor_axis").map(String::as_str), Some("omega"));
    let svg = fs::read_to_string(dir.path("results/two/diagram.svg")).expect("a figure");
    assert!(svg.contains("section_r, progression_speed, work_positive, lyapunov_exponent"));
    // The light shading of the window.
    assert!(svg.contains("#f4edda"), "no window is shaded");
}
