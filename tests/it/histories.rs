//! Histories and phase portraits: what they derive from the stored motion, and a panel for each case.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fs;

use capsulemap::figure::{Format, draw};
use capsulemap::store;
use capsulemap::study::{Drawing, DrawingKind};

use super::figure::fixtures::{Fixture, with_history};
use super::figure::into;
use super::program::{FIG5, WorkDir};

/// The numbers of each series of each panel.
type Series = BTreeMap<(usize, String), Vec<(f64, f64)>>;

fn series(csv: &str) -> Series {
    let mut found = Series::new();
    for line in csv.lines().filter(|it| it.starts_with(|first: char| first.is_ascii_digit())) {
        let fields: Vec<&str> = line.split(',').collect();
        let [x, y] = [2, 3].map(|at| fields[at].parse().expect("a number"));
        let key = (fields[0].parse().expect("a panel"), fields[1].to_owned());
        found.entry(key).or_default().push((x, y));
    }
    found
}

#[test]
fn displacements_and_forces_follow_from_the_stored_motion() {
    let dir = WorkDir::new();
    let study = format!(
        "outputs = [\"peak_contact_force\", \"progression_per_cycle\"]\n{FIG5}\
         [history]\ncycles = 4\nsamples_per_cycle = 2000\n"
    );
    dir.put("s.toml", study);
    dir.run(&["sweep", "s.toml", "--output", "s.h5"]).done();
    let dataset = store::read(&dir.path("s.h5")).expect("a result");
    let of = ["history_x1", "history_x2", "history_r", "history_contact", "history_friction"];
    let of = of.map(str::to_owned).to_vec();
    let request = Drawing { of, data: true, ..Drawing::new("h", DrawingKind::History) };
    let files = draw(&dataset, &request, &into(dir.folder(), &[Format::Svg])).expect("drawn");
    let found = series(&fs::read_to_string(&files.paths[1]).expect("a file"));
    let of = |panel: usize, name: &str| found[&(panel, name.to_owned())].clone();
    let [x1, x2] = [of(1, "history_x1"), of(2, "history_x2")];
    let [r, contact] = [of(3, "history_r"), of(4, "history_contact")];
    let friction = of(5, "history_friction");
    assert_eq!(x1.len(), 8001);
    // In millimetres and newtons, as the axes have them; k2 and delta are those of Fig 5.
    let (mut largest, mut pressed) = (0.0_f64, 0);
    for at in 0..x1.len() {
        assert!((x1[at].1 - x2[at].1 - r[at].1).abs() < 1e-12 * (1.0 + x1[at].1.abs()));
        let expected = 2.42e3 * (1e-3 * r[at].1 - 3.5e-3).max(0.0);
        assert!((contact[at].1 - expected).abs() < 1e-9, "{at}");
        largest = largest.max(contact[at].1);
        pressed += usize::from(contact[at].1 > 0.0);
    }
    let output = |name: &str| dataset.variable(name).expect(name).values.to_real().sum();
    let peak = output("peak_contact_force");
    // A sample lies within 1/4000 of a cycle of the peak.
    assert!(pressed > 100 && largest <= peak * (1.0 + 1e-9) && largest > 0.999 * peak);
    // What the capsule gains in a period is what all forces give it: the friction averages to zero, up to the jumps
    // between two samples.
    let mean =
        |values: &[(f64, f64)]| values.iter().map(|it| it.1).sum::<f64>() / values.len() as f64;
    let size = friction.iter().map(|it| it.1.abs()).fold(0.0, f64::max);
    assert!(
        size > 1.0 && mean(&friction[..8000]).abs() < 2e-3 * size,
        "{} {size}",
        mean(&friction)
    );
    // The mass advances as the capsule does.
    let advance = 1e3 * 4.0 * output("progression_per_cycle");
    for x in [&x1, &x2] {
        assert!((x[8000].1 - x[0].1 - advance).abs() < 1e-6 * advance.abs(), "{advance}");
    }
}

#[test]
fn portraits_of_several_cases_are_panels_with_the_coordinates_that_are_asked_for() {
    let dir = WorkDir::new();
    let study = "[parameters]\np_d = \"4 N\"\ndelta = \"3.5 mm\"\nomega = \"77.91 rad/s\"\n[[axes]]\nname = \"k2\"\n\
        values = [\"2.42 kN/m\", \"5 kN/m\", \"10 kN/m\"]\n[history]\ncycles = 1\nsamples_per_cycle = 100\n\
        [protocol]\npoints = 4\nimpact_points = 4\n";
    dir.put("s.toml", study);
    dir.run(&["sweep", "s.toml", "--output", "s.h5"]).done();
    let dataset = store::read(&dir.path("s.h5")).expect("a result");
    let drawn = |of: &[&str], name: &str| {
        let of = of.iter().map(|it| (*it).to_owned()).collect();
        let request = Drawing { of, data: true, ..Drawing::new(name, DrawingKind::PhasePortrait) };
        let files = draw(&dataset, &request, &into(dir.folder(), &[Format::Png]))?;
        Ok::<_, capsulemap::figure::FigureError>(series(
            &fs::read_to_string(&files.paths[1]).expect("a file"),
        ))
    };
    let usual = drawn(&[], "usual").expect("drawn");
    let other = drawn(&["history_y2", "history_r"], "other").expect("drawn");
    let displacements = drawn(&["history_x2", "history_x1"], "displacements").expect("drawn");
    let numbers = |name: &str| -> Vec<f64> {
        dataset.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    let [r, y1, y2] = ["history_r", "history_y1", "history_y2"].map(numbers);
    let near = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9;
    for panel in 1..=3 {
        let of = |found: &Series, name: &str| found[&(panel, name.to_owned())].clone();
        let (first, second) = (of(&usual, "motion"), of(&other, "motion"));
        // The samples in their order, with what is computed between them.
        assert!(first.len() > 8 * 100 && first.len() == second.len());
        let mut both = first.iter().zip(&second);
        for at in 0..101 {
            let case = (panel - 1) * 101 + at;
            let (x, y) = ((1e3 * r[case], y1[case] - y2[case]), (y2[case], 1e3 * r[case]));
            assert!(both.any(|(a, b)| near(*a, x) && near(*b, y)), "{panel} {at}");
        }
        // A history begins on the section, and the impacts lie at the gap.
        assert!(of(&usual, "stroboscopic").iter().any(|it| near(*it, first[0])), "{panel}");
        assert!(of(&usual, "impact").iter().all(|it| (it.0 - 3.5).abs() < 1e-9), "{panel}");
        assert!(of(&other, "impact").iter().all(|it| (it.1 - 3.5).abs() < 1e-9), "{panel}");
        assert!(!displacements.contains_key(&(panel, "stroboscopic".to_owned())), "{panel}");
    }
    let said = drawn(&["history_r"], "one").expect_err("a fault").to_string();
    assert!(said.contains("`of` names the coordinates of both axes"), "{said}");
}

#[test]
fn a_spectrum_has_the_amplitudes_of_the_sinusoids_that_make_a_motion() {
    // r = 1.3 cos + 0.35 sin 3 + 0.15 [mm], with the phase of a drive of 20 rad/s, over 6 cycles.
    let fixture = Fixture::default().real("omega", &[], |_| 20.0);
    let dataset = with_history(fixture, &[], 6.0, 3001).0;
    let folder = super::figure::folder("spectrum");
    let drawn = |of: &str| {
        let of = vec![of.to_owned()];
        let request = Drawing { of, data: true, ..Drawing::new("s", DrawingKind::Spectrum) };
        let files = draw(&dataset, &request, &into(&folder, &[Format::Png])).expect("drawn");
        series(&fs::read_to_string(&files.paths[1]).expect("a file"))
    };
    let lines = drawn("history_r")[&(1, "history_r".to_owned())].clone();
    let drive = 20.0 / TAU;
    for (at, (frequency, amplitude)) in lines.iter().enumerate() {
        // Six lines to a multiple of the drive; the window has half of an amplitude on both sides.
        assert!((frequency - (at + 1) as f64 / 6.0 * drive).abs() < 1e-9 * frequency);
        let expected = match at + 1 {
            6 => 1.3,
            5 | 7 => 0.65,
            18 => 0.35,
            17 | 19 => 0.175,
            _ => 0.0,
        };
        assert!((amplitude - expected).abs() < 1e-9, "{frequency} {amplitude} {expected}");
    }
    // A displacement is shown without its mean advance.
    let advance = drawn("history_x2")[&(1, "history_x2".to_owned())].clone();
    assert!(advance[0].1 < 1e-2, "{:?}", advance[0]);
    let short = with_history(Fixture::default().real("omega", &[], |_| 20.0), &[], 0.5, 200).0;
    let request = Drawing::new("s", DrawingKind::Spectrum);
    let said = draw(&short, &request, &into(&folder, &[])).expect_err("a fault").to_string();
    assert!(said.contains("a spectrum needs the history of a whole cycle"), "{said}");
}

#[test]
fn a_spectrum_of_what_repeats_has_the_terms_of_its_fourier_series() {
    let folder = super::figure::folder("terms");
    let drawn = |period: i64| {
        let fixture =
            Fixture::default().real("omega", &[], |_| 20.0).integer("period", &[], &[], |_| period);
        let dataset = with_history(fixture, &[], 6.0, 3001).0;
        let of = vec!["history_r".to_owned()];
        let request = Drawing { of, data: true, ..Drawing::new("s", DrawingKind::Spectrum) };
        let files = draw(&dataset, &request, &into(&folder, &[Format::Svg])).expect("drawn");
        series(&fs::read_to_string(&files.paths[1]).expect("a file"))[&(1, "history_r".to_owned())]
            .clone()
    };
    // The motion repeats after each cycle, and so after two; a period of more cycles than the history has does not show.
    for period in [1, 2] {
        for (at, (frequency, amplitude)) in drawn(period).into_iter().enumerate() {
            let multiple = (at + 1) as f64 / period as f64;
            assert!((frequency - multiple * 20.0 / TAU).abs() < 1e-9 * frequency);
            let expected = match multiple {
                1.0 => 1.3,
                3.0 => 0.35,
                _ => 0.0,
            };
            assert!((amplitude - expected).abs() < 1e-12, "{frequency} {amplitude} {expected}");
        }
    }
    assert_eq!(drawn(7)[4].1, drawn(0)[4].1);
    assert!((drawn(7)[4].1 - 0.65).abs() < 1e-9);
}

#[test]
fn between_samples_the_motion_is_computed_and_not_joined_by_lines() {
    let dir = WorkDir::new();
    let variables = ["history_r", "history_y1", "history_y2"].map(str::to_owned);
    let swept = |name: &str, samples: usize| {
        let start = "[start]\ny2 = \"0.05 m/s\"\n";
        let history =
            format!("[history]\nfrom = \"start\"\ncycles = 2\nsamples_per_cycle = {samples}\n");
        dir.put("s.toml", format!("{FIG5}{start}{history}"));
        let file = format!("{name}.h5");
        dir.run(&["sweep", "s.toml", "--output", &file, "--no-figures"]).done();
        store::read(&dir.path(&file)).expect("a result")
    };
    let (coarse, fine) = (swept("coarse", 40), swept("fine", 8 * 40));
    let request =
        Drawing { of: variables.to_vec(), data: true, ..Drawing::new("h", DrawingKind::History) };
    let files = draw(&coarse, &request, &into(dir.folder(), &[Format::Svg])).expect("drawn");
    let drawn = series(&fs::read_to_string(&files.paths[1]).expect("a file"));
    for (panel, name) in variables.into_iter().enumerate() {
        let points = &drawn[&(panel + 1, name.clone())];
        let factor = if name == "history_r" { 1e3 } else { 1.0 };
        let exact = fine.variable(&name).expect("a history").values.to_real();
        let size = exact.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        assert!(points.is_sorted_by(|a, b| a.0 <= b.0));
        // There are events besides the even times.
        assert!(points.len() > 2 * 8 * 40 + 4, "{name}: {}", points.len());
        for (at, exact) in exact.iter().enumerate() {
            let time = at as f64 / 320.0 * TAU / 77.91;
            let near: Vec<f64> =
                points.iter().filter(|it| (it.0 - time).abs() < 1e-9).map(|it| it.1).collect();
            let meets = near.iter().any(|it| (it / factor - exact).abs() < 1e-8 * size);
            assert!(meets, "{name} {time}: {near:?} {exact}");
        }
    }
}
