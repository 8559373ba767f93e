//! Sizes of files of results as a dry run estimates them, against those of files that are written.

use std::sync::Mutex;

use capsulemap::run::{self, Machine, Record};
use capsulemap::store::{self, file_bytes, refined_file_bytes};
use capsulemap::study::Study;

use super::program::WorkDir;

const PARAMETERS: &str = "[parameters]\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\n[protocol]\nmax_cycles = 60\n\
    exponent_cycles = 0\n";

/// Two axes with so many values.
fn axes([slow, fast]: [usize; 2]) -> String {
    format!(
        "[[axes]]\nname = \"p_d\"\nfrom = \"2 N\"\nto = \"6 N\"\npoints = {slow}\n\
         [[axes]]\nname = \"omega\"\nfrom = \"18 rad/s\"\nto = \"80 rad/s\"\npoints = {fast}\n"
    )
}

/// So many draws from the ranges of these axes.
fn draws(count: usize) -> String {
    format!("[draws]\ncount = {count}\n{}", axes([0, 0]).replace("points = 0\n", ""))
}

fn parsed(text: &str) -> Study {
    Study::parse("study.toml", text).unwrap_or_else(|faults| panic!("{faults}"))
}

fn computed(study: &Study) -> Vec<Record> {
    let records = Mutex::new(Vec::new());
    let keep = |record| records.lock().expect("a lock").push(record);
    run::run(study, Machine::default(), keep).expect("the study runs");
    let mut records = records.into_inner().expect("a lock");
    records.sort_by_key(|record: &Record| record.index);
    records
}

/// The size that the records of a study have in a file.
fn written(study: &Study, records: &[Record]) -> f64 {
    let dir = WorkDir::new();
    let path = dir.path("s.h5");
    store::write(&store::dataset(study, records), &path).expect("it can be written");
    std::fs::metadata(path).expect("a file").len() as f64
}

#[test]
fn a_sample_of_the_cases_tells_the_size_of_the_file() {
    let few = "points = 1\nimpact_points = 0\n";
    let studies = [("", axes([40, 100])), (few, axes([40, 100])), (few, draws(4000))];
    for (points, cases) in studies {
        let study = parsed(&format!("{PARAMETERS}{points}{cases}"));
        let records = computed(&study);
        let exact = written(&study, &records);
        // The checksum at its end is the only difference.
        let whole = file_bytes(&study, &records).expect("a size");
        assert!((whole - exact).abs() <= 64.0, "{whole} {exact}");
        let sample: Vec<Record> = records.iter().step_by(7).cloned().collect();
        let estimate = file_bytes(&study, &sample).expect("a size");
        assert!((estimate / exact - 1.0).abs() < 0.1, "{estimate} {exact}");
    }
}

#[test]
fn a_tile_tells_the_size_of_the_file_of_a_refined_map() {
    let refine = "[map]\nrefine = { progression_speed = \"1 m/s\" }\n";
    let study = parsed(&format!("{PARAMETERS}points = 1\n{refine}{}", axes([65, 65])));
    // Of its cases those on a coarser grid, as a refinement has them that finds nothing between.
    let records: Vec<Record> = computed(&study).into_iter().step_by(4).collect();
    let exact = written(&study, &records);
    let tiles = [((0..study.cases()).collect(), records.clone())];
    let computed = records.len() as f64 / study.cases() as f64;
    let estimate = refined_file_bytes(&study, &tiles, computed).expect("a size");
    assert!((estimate / exact - 1.0).abs() < 0.1, "{estimate} {exact}");
}

/// The size before these words in what a dry run says [bytes].
fn said(out: &str, words: &str) -> f64 {
    let (before, _) = out.split_once(words).unwrap_or_else(|| panic!("{out}"));
    let words: Vec<&str> = before.split_whitespace().rev().take(2).collect();
    let factor = match words[0] {
        "kB" => 1e3,
        "MB" => 1e6,
        "GB" => 1e9,
        other => panic!("{other}: {out}"),
    };
    factor * words[1].parse::<f64>().unwrap_or_else(|_| panic!("{out}"))
}

#[test]
fn a_dry_run_tells_the_size_of_the_file_that_the_run_writes() {
    let dir = WorkDir::new();
    let inherit = "[start]\ninherit = \"omega\"\n";
    let studies = [
        ("a", "", axes([3, 60])),
        ("b", inherit, axes([3, 60])),
        ("c", "", axes([2, 2])),
        ("d", "", draws(180)),
    ];
    for (name, start, cases) in studies {
        let [study, file] = ["toml", "h5"].map(|end| format!("{name}.{end}"));
        dir.put(&study, format!("{PARAMETERS}{start}{cases}"));
        let sweep = ["sweep", &study, "--output", &file];
        let out = dir.run(&[&sweep[..], &["--dry-run"]].concat()).done().out;
        let said = said(&out, " for the file");
        dir.run(&sweep).done();
        let size = std::fs::metadata(dir.path(&file)).expect("a file").len() as f64;
        assert!((said / size - 1.0).abs() < 0.1, "{said} {size} {cases} {start}");
    }
}

/// Tiles of a probe are smaller than those of the run, of which the first few are nearly all of a study.
#[test]
fn a_dry_run_of_a_refined_study_tells_its_size_after_a_part_of_it() {
    let dir = WorkDir::new();
    let few = "points = 1\nimpact_points = 0\n";
    let refine = "[map]\nrefine = { progression_speed = \"1 mm/s\" }\n";
    dir.put("s.toml", format!("{PARAMETERS}{few}{refine}{}", axes([129, 129])));
    let out = dir.run(&["sweep", "s.toml", "--dry-run"]).done().out;
    assert!(out.contains(" for the cases, ") && out.contains(" to write the file\n"), "{out}");
    dir.run(&["sweep", "s.toml", "--output", "s.h5", "--no-figures"]).done();
    let size = std::fs::metadata(dir.path("s.h5")).expect("a file").len() as f64;
    let factor = said(&out, " for the file") / size;
    assert!((1.0 / 1.5..=1.5).contains(&factor), "{factor}: {out}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_dry_run_tells_the_memory_of_the_run() {
    let dir = WorkDir::new();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/memory.sh");
    let one = "[parameters]\np_d = \"4 N\"\nomega = \"60 rad/s\"\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\n";
    let start = |name: &str, ends: [&str; 2], points: &str| {
        let [from, to] = ends;
        format!("[[axes]]\nname = \"{name}\"\nfrom = \"{from}\"\nto = \"{to}\"\n{points}\n")
    };
    let starts = |points: &str| {
        start("start_r", ["-2 mm", "2 mm"], points)
            + &start("start_y1", ["-0.3 m/s", "0.3 m/s"], points)
    };
    let history = "[history]\ncycles = 5\nsamples_per_cycle = 100\n";
    let studies = [
        ("refined", format!("{one}[basin]\nrefine = true\n{}", starts("points = 257"))),
        ("draws", format!("{one}[draws]\ncount = 3000\n{}", starts(""))),
        ("grid", format!("{PARAMETERS}{history}{}", axes([20, 30]))),
    ];
    // The program and its tables, without a study.
    let bare = {
        dir.put("bare.toml", format!("{PARAMETERS}{}", axes([2, 2])));
        most_memory(&dir, script, "bare")
    };
    for (name, study) in studies {
        dir.put(&format!("{name}.toml"), study);
        let file = format!("{name}.toml");
        let out = dir.run(&["sweep", &file, "--dry-run"]).done().out;
        let phases = [" while cases are computed", " while they are joined"];
        let [computing, joining] = phases.map(|words| said(&out, words));
        let (told, held) = (computing.max(joining), most_memory(&dir, script, name));
        // A program without optimisation is larger itself than the estimate has it.
        let told = told + (bare - 3e7).max(0.0);
        let factor = told / held;
        assert!((1.0 / 1.5..=1.5).contains(&factor), "{name}: {told} {held}\n{out}");
    }
}

/// The most memory that a sweep holds [bytes].
#[cfg(target_os = "linux")]
fn most_memory(dir: &WorkDir, script: &str, name: &str) -> f64 {
    let command = format!("'{script}' \"$0\" sweep {name}.toml --output {name}.h5 --no-figures");
    let err = dir.shell(&command).done().err;
    let (_, said) = err.split_once("memory.sh: at most ").unwrap_or_else(|| panic!("{err}"));
    let number = said.split_whitespace().next().and_then(|it| it.parse::<f64>().ok());
    number.unwrap_or_else(|| panic!("{err}")) * f64::from(1 << 20)
}
