//! The capsule over folds in studies and on the command line: its coordinate on the way, locked motions, and what is refused.

use super::program::WorkDir;

/// A millimetre capsule that folds hold, let drift, or lock, by the force of its pulses.
const STEPS: &str = r#"
model = "capsule-over-folds"
[parameters]
m1 = "1.8 g"
m2 = "1.67 g"
k1 = "62 N/m"
c = "0.15 N s/m"
k2 = "27.9 kN/m"
delta = "1.6 mm"
k3 = "53.5 kN/m"
delta_3 = "0 mm"
preload_gap = "0.2 mm"
mu_s = 0.2293
mu_d = 0.2293
resistance = "coulomb"
drive = "square"
drive_reaction = "capsule"
omega = "30 Hz"
fold_spacing = "5 mm"
fold_friction = 0.5
fold_force = "3 mN"
fold_sharpness = 4
"#;

/// An axis of these values.
fn axis(name: &str, from: &str, to: &str, points: u32) -> String {
    format!("[[axes]]\nname = \"{name}\"\nfrom = \"{from}\"\nto = \"{to}\"\npoints = {points}\n")
}

#[test]
fn locked_motions_are_told_by_their_folds_and_come_out_the_same_from_their_file() {
    let dir = WorkDir::new();
    let history = "[history]\ncycles = 3\n[protocol]\nexponent_cycles = 64\n";
    dir.put("steps.toml", [STEPS, &axis("p_d", "90 mN", "100 mN", 11), history].concat());
    dir.run(&["sweep", "steps.toml", "--output", "s.h5", "--no-figures"]).done();
    let verified = dir.run(&["verify", "s.h5", "--cases", "11"]).done();
    assert!(verified.out.contains("came out the same"), "{}", verified.out);
    let mut locked = Vec::new();
    for case in 0..11 {
        let told = ["simulate", "--study", "s.h5", "--case", &case.to_string(), "--json"];
        let told = dir.run(&told).json();
        assert_eq!(told["model"], "capsule-over-folds");
        for sample in told["section"].as_array().expect("samples") {
            let place = sample["place"].as_f64().expect("a place");
            assert!((0.0..=1.0).contains(&place), "{place}");
        }
        if told["orbit"]["outcome"] != "periodic" {
            continue;
        }
        let outputs = &told["orbit"];
        let of = |name: &str| outputs[name].as_f64().expect(name);
        let period = told["orbit"]["period"].as_f64().expect("a period");
        let folds = of("folds_per_period");
        // n folds of 5 mm in k periods of a thirtieth of a second.
        let speed = folds / period * 5e-3 * 30.0;
        assert!((of("progression_speed") - speed).abs() < 1e-11, "{outputs}");
        assert!(of("energy_residual").abs() < 1e-9 && of("momentum_residual").abs() < 1e-9);
        locked.push((folds, period));
    }
    // Some get over a fold in seven cycles, others are held.
    assert!(locked.contains(&(-1.0, 7.0)) && locked.contains(&(0.0, 1.0)), "{locked:?}");
    for (kind, of) in [
        ("history", "history_place,history_folds,history_x2"),
        ("section", "section_place,section_y2"),
        ("bifurcation", "section_place,progression_speed"),
    ] {
        dir.run(&["figure", "s.h5", "--kind", kind, "--of", of, "--formats", "svg"]).done();
    }
}

#[test]
fn a_branch_of_a_locked_motion_ends_where_it_is_locked_no_more() {
    let dir = WorkDir::new();
    let branch = "[[branches]]\nname = \"of seven\"\nalong = \"p_d\"\nat = { p_d = \"92.5 mN\" }\nfrom = \"92 mN\"\nto = \"93 mN\"\n";
    dir.put("b.toml", [STEPS, &axis("p_d", "92 mN", "93 mN", 5), branch].concat());
    let continued = dir.run(&["continue", "b.toml", "--output", "b.h5"]).done().out;
    // One fold in seven cycles: -5 mm in 7/30 s, on all of the branch, which ends within its range, at a corner of the return map.
    let special = continued.lines().filter(|line| line.contains("-21.4285"));
    assert!(special.count() > 2 && continued.contains("to 0.0927860622"), "{continued}");
    assert!(continued.contains("last end at a corner of the return map"), "{continued}");
}

#[test]
fn starts_between_two_folds_have_basins_and_a_place() {
    let dir = WorkDir::new();
    let axes =
        [axis("start_place", "0", "1", 9), axis("start_y2", "-0.1 m/s", "0.1 m/s", 9)].concat();
    dir.put("basin.toml", [STEPS, "p_d = \"98 mN\"\n", &axes].concat());
    dir.run(&["sweep", "basin.toml", "--output", "b.h5", "--no-figures"]).done();
    dir.run(&["figure", "b.h5", "--kind", "basin", "--formats", "svg"]).done();
    let simulated = [
        "simulate",
        "--model",
        "capsule-over-folds",
        "--drive",
        "square",
        "--p-d",
        "5 N",
        "--set",
        "fold_force=0.3",
        "--start",
        "place=0.25",
        "--cycles",
        "0",
    ];
    let told = dir.run(&simulated).done().out;
    assert!(told.contains("folds across the way") && told.contains("0.250000"), "{told}");
    assert!(told.contains("folds_per_period"), "{told}");
    let idle = dir.run(&["simulate", "--model", "capsule-over-folds", "--cycles", "0"]).done();
    assert!(idle.err.contains("the folds have no effect"), "{}", idle.err);
}

#[test]
fn what_does_not_go_with_folds_is_refused_with_the_reason() {
    let dir = WorkDir::new();
    let refused = |text: &str, parts: &[&str]| {
        dir.put("no.toml", text);
        dir.run(&["sweep", "no.toml", "--dry-run"]).refused(parts);
    };
    let drive = "p_d = \"90 mN\"\n";
    let even = STEPS.replace("model = \"capsule-over-folds\"\n", "");
    refused(
        &[&even, drive].concat(),
        &["fold_force", "of the model capsule: it is one of the model capsule-over-folds"],
    );
    refused(
        &[STEPS, drive, "friction_switching = \"as-printed\"\n"].concat(),
        &["as-printed", "without folds"],
    );
    refused(&[STEPS, drive].concat().replace("= 4\n", "= 40\n"), &["fold_sharpness", "0 to 10"]);
    let spacing = STEPS.replace("fold_spacing = \"5 mm\"\n", "");
    refused(&[&spacing, drive].concat(), &["fold_spacing", "a value"]);
    let place = axis("start_place", "0", "1", 3);
    refused(
        &[super::program::FIG5, &place].concat(),
        &["axes[1].name", "start_place", "it is one of the model capsule-over-folds"],
    );
    refused(
        &[super::program::FIG5, &axis("k1", "1 kN/m", "2 kN/m", 2).replace("k1", "power")].concat(),
        &["unknown axis \"power\""],
    );
    dir.run(&["simulate", "--set", "fold_force=1"]).refused(&["capsule-over-folds"]);
    let recorded = ["synthesize", "no.toml", "--case", "0", "--output", "r.csv"];
    dir.put("no.toml", [STEPS, drive].concat());
    dir.run(&recorded).refused(&["capsule"]);
}
