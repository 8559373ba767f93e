//! What a comparison tells of a record holds for records with gaps, of another frequency, and too short or too coarse to count.

use std::fs;

use serde_json::Value;

use super::program::WorkDir;

/// A folder with recordings of the paper's Fig 5 in `rig`, and its study.
fn rig() -> (WorkDir, Vec<String>) {
    let work = WorkDir::new();
    work.put("fig5.toml", super::program::FIG5);
    work.run(&["synthesize", "fig5.toml", "--output", "rig"]).done();
    let text = fs::read_to_string(work.path("rig/motion.csv")).expect("recorded");
    let lines = text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect();
    (work, lines)
}

/// The comparison with a record of the rows whose times [s] are `kept`, every so many of them.
fn compared(
    (work, lines): (&WorkDir, &[String]),
    study: &str,
    (every, kept): (usize, fn(f64) -> bool),
) -> Value {
    let time =
        |line: &&String| line.split(',').next().and_then(|it| it.parse().ok()).is_some_and(kept);
    let rows = lines[1..].iter().filter(time).step_by(every);
    let rows: Vec<&str> = [&lines[0]].into_iter().chain(rows).map(String::as_str).collect();
    work.put("part.csv", rows.join("\n") + "\n");
    work.run(&["compare", "part.csv", study, "--json"]).done().json()
}

#[test]
fn a_record_with_a_gap_is_counted_where_it_has_none() {
    let (work, lines) = rig();
    let found = compared((&work, &lines), "fig5.toml", (1, |t| !(0.3..0.5).contains(&t)));
    assert_eq!(found["gaps"].as_array().map(Vec::len), Some(1), "{found}");
    assert_eq!(found["period_recorded"], 1);
    assert_eq!(found["impacts_per_cycle_recorded"], 1.0);
    assert_eq!(found["spikes_per_cycle"], serde_json::json!([1.0, 1.0]));
}

#[test]
fn a_record_has_the_cycles_of_its_own_drive() {
    let (work, lines) = rig();
    work.put("slow.toml", super::program::FIG5.replace("77.91 rad/s", "20.73 rad/s"));
    let found = compared((&work, &lines), "slow.toml", (1, |_| true));
    assert!((found["cycles"].as_f64().expect("a number") - 20.0).abs() < 0.1, "{found}");
    assert_eq!(found["period_recorded"], 1);
    assert_eq!(found["impacts_per_cycle_recorded"], 1.0);
}

#[test]
fn what_cannot_be_counted_is_not() {
    let (work, lines) = rig();
    for (every, kept) in [(1, (|t| t < 0.2) as fn(f64) -> bool), (20, |_| true)] {
        let found = compared((&work, &lines), "fig5.toml", (every, kept));
        assert_eq!(found["countable"], false, "{found}");
        assert!(found["impacts_per_cycle_recorded"].is_null(), "{found}");
        assert!(found["spikes_per_cycle"].is_null(), "{found}");
    }
}

#[test]
fn a_motion_that_does_not_repeat_is_not_explained() {
    let work = WorkDir::new();
    let chaos = include_str!("../../studies/chaos.toml");
    work.put("chaos.toml", chaos);
    work.run(&["synthesize", "chaos.toml", "--output", "rig"]).done();
    let ran =
        work.run(&["compare", "rig/motion.csv", "chaos.toml", "--explain", "k2=30 kN/m..90 kN/m"]);
    assert!(ran.code == 2 && ran.err.contains("so that no difference is explained"), "{}", ran.err);
}

#[test]
fn a_record_of_x2_alone_has_its_period_and_an_error_of_its_speed() {
    let (work, lines) = rig();
    let rows: Vec<String> = lines
        .iter()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            [cells[0], cells[1], cells[4]].join(",")
        })
        .collect();
    work.put("x2.csv", rows.join("\n") + "\n");
    let found = work.run(&["compare", "x2.csv", "fig5.toml", "--json"]).done().json();
    assert_eq!(found["period_recorded"], 1);
    let error = found["speed_recorded_error"].as_f64().expect("known");
    assert!((0.2e-6..1.2e-6).contains(&error), "{error}");
}

#[test]
fn a_jump_of_the_clock_is_named_and_not_simulated() {
    let (work, lines) = rig();
    let jumped = |from: f64, by: f64| {
        let row = |line: &String| {
            let (time, rest) = line.split_once(',')?;
            let time: f64 = time.parse().ok()?;
            Some(format!("{},{rest}", if time < from { time } else { time + by }))
        };
        let rows = lines[1..].iter().filter_map(row);
        [lines[0].clone()].into_iter().chain(rows).collect::<Vec<_>>().join("\n") + "\n"
    };
    work.put("jump.csv", jumped(0.8, 1.8e9));
    for arguments in [
        &["compare", "jump.csv", "fig5.toml"][..],
        &["fit", "jump.csv", "--study", "fig5.toml", "--vary", "k2=1 kN/m..10 kN/m"],
    ] {
        let begun = std::time::Instant::now();
        work.run(arguments).refused(&[
            "jump.csv: a gap of 1800000000",
            "s at t = 0.799",
            "cut the file there",
        ]);
        assert!(begun.elapsed().as_secs() < 60, "{arguments:?}");
    }
    // One that can be simulated is, and every gap is told with its place and its length.
    work.put("short.csv", jumped(0.8, 3.0));
    let found = work.run(&["compare", "short.csv", "fig5.toml", "--json"]).done().json();
    let gap = &found["gaps"][0];
    assert!((gap[0].as_f64().expect("a time") - 0.799).abs() < 1e-6, "{found}");
    assert!((gap[1].as_f64().expect("a length") - 3.001).abs() < 1e-6, "{found}");
    let told = work.run(&["compare", "short.csv", "fig5.toml"]).done().out;
    assert!(told.contains("a gap of 3.0010 s at t = 0.799000 s"), "{told}");
}

#[test]
fn residuals_are_what_is_recorded_less_what_is_simulated() {
    let (work, _) = rig();
    let asked = ["compare", "rig/motion.csv", "fig5.toml", "--output", "rig/left", "--residuals"];
    let told = work.run(&asked).done().out;
    assert!(told.contains("rig/left.png") && told.contains("rig/left.pdf"), "{told}");
    let data = fs::read_to_string(work.path("rig/left.csv")).expect("data");
    assert!(data.contains("with the differences below each signal"), "{data}");
    let column = |series: &str| -> Vec<f64> {
        let rows = data.lines().map(|line| line.split(',').collect::<Vec<_>>());
        // The first signal and its residuals.
        let own = rows.filter(|row| ["1", "2"].contains(&row[0]) && row.get(1) == Some(&series));
        own.map(|row| row[3].parse().expect("a number")).collect()
    };
    let (recorded, simulated) = (column("recorded"), column("simulated"));
    let left = column("recorded less simulated");
    assert!(left.len() > 100 && left.len() == recorded.len(), "{}", left.len());
    for ((left, recorded), simulated) in left.iter().zip(&recorded).zip(&simulated) {
        assert!((left - (recorded - simulated)).abs() < 1e-9, "{left} {recorded} {simulated}");
    }
}
