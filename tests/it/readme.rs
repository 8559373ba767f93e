//! What the README and the pages of the book claim is run: their commands, their studies and their Python.

use std::path::Path;
use std::process::Command;

use capsulemap::capsule::Parameter;
use capsulemap::quantity::parse_quantity;
use capsulemap::store;
use capsulemap::study::{DrawingKind, Study};

use super::explorer::Explorer;

const README: &str = include_str!("../../README.md");
const EXPLORE: &str = include_str!("../../docs/explore.md");
const FIRST_STEPS: &str = include_str!("../../docs/first-steps.md");
const LONG_RUNS: &str = include_str!("../../docs/long-runs.md");
const MAPS: &str = include_str!("../../docs/maps.md");
const MODEL: &str = include_str!("../../docs/model.md");

/// The blocks of a document in `language`.
fn blocks(document: &'static str, language: &str) -> Vec<&'static str> {
    let fence = format!("```{language}\n");
    document
        .split(&fence)
        .skip(1)
        .map(|rest| rest.split("```").next().expect("a block has an end").trim_end())
        .collect()
}

/// Runs the program of this build in `folder`; returns its standard output.
fn capsulemap(arguments: &[&str], folder: &Path) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_capsulemap"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// A folder with the studies, as in a clone.
fn clone() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let studies = folder.path().join("studies");
    std::fs::create_dir(&studies).expect("a folder");
    for entry in std::fs::read_dir("studies").expect("the studies") {
        let path = entry.expect("an entry").path();
        std::fs::copy(&path, studies.join(path.file_name().expect("a name"))).expect("a copy");
    }
    folder
}

#[test]
fn the_main_job_leaves_a_file_and_its_figures() {
    let command = blocks(README, "sh")[0];
    assert_eq!(command, blocks(FIRST_STEPS, "sh")[0]);
    assert_eq!(command, "scripts/setup.sh && cargo run --release -- sweep studies/overview.toml");
    let folder = clone();
    let summary = capsulemap(&["sweep", "studies/overview.toml"], folder.path());
    assert!(summary.contains("34 221 cases"), "{summary}");
    assert!(README.contains("34 221 cases") && FIRST_STEPS.contains("34 221 cases"));
    let results = folder.path().join("results/overview");
    for figure in ["bifurcation", "speed", "period", "trade-off"] {
        for extension in ["png", "svg", "pdf"] {
            assert!(
                results.join(format!("{figure}.{extension}")).is_file(),
                "{figure}.{extension}"
            );
        }
    }
    let dataset = store::read(&results.join("overview.h5")).expect("results");
    assert_eq!(dataset.coordinates[0].0, "p_d");
    a_click_shows_a_motion(folder.path());
}

/// Explores the results of the main job by the command of docs/explore.md.
fn a_click_shows_a_motion(folder: &Path) {
    let words: Vec<String> = split(blocks(EXPLORE, "sh")[0]);
    assert_eq!(words[..2], ["capsulemap", "explore"]);
    let mut command = Command::new(env!("CARGO_BIN_EXE_capsulemap"));
    command.args(&words[1..]).arg("--no-browser").current_dir(folder);
    let explorer = Explorer::begun(command).opened();
    let motion = explorer.object("/api/motion?omega=60&p_d=3.4");
    assert_eq!(motion["simulate"]["orbit"]["outcome"], "periodic", "{motion}");
}

#[test]
fn git_keeps_nothing_that_a_run_writes() {
    let kept = Command::new("git").args(["ls-files", "results"]).output().expect("git runs");
    let kept = String::from_utf8(kept.stdout).expect("names");
    // Outside a clone there are none.
    for name in kept.lines().filter(|name| !name.is_empty()) {
        assert_eq!(name, "results/README.md", "what runs write is kept");
    }
}

#[test]
fn the_tests_are_run_as_the_readme_says() {
    let check = std::fs::read_to_string("scripts/check.sh").expect("the list of checks");
    assert!(check.contains(blocks(README, "sh")[1]));
}

#[test]
fn the_case_of_the_first_steps_is_the_one_of_fig_6() {
    let words: Vec<String> = split(blocks(FIRST_STEPS, "sh")[1]);
    let words: Vec<&str> = words.iter().skip(1).map(String::as_str).collect();
    let printed = capsulemap(&words, Path::new("."));
    let object: serde_json::Value = serde_json::from_str(&printed).expect("JSON");
    let speed = object["orbit"]["progression_speed"].as_f64().expect("a speed");
    assert_eq!(format!("{:.6}", speed * 1e3), "0.255748");
}

#[test]
fn the_experiment_of_the_book_finds_its_rig() {
    let folder = clone();
    let experiment = include_str!("../../docs/experiment.md");
    let said: Vec<String> = blocks(experiment, "bash")[0]
        .lines()
        .map(|line| {
            let words = split(line);
            let words: Vec<&str> = words.iter().skip(1).map(String::as_str).collect();
            capsulemap(&words, folder.path())
        })
        .collect();
    assert_eq!(said.len(), 4);
    assert!(said[1].contains("k2 ") && said[1].contains("v_s "), "{}", said[1]);
    assert!(said[2].contains("mu_s  not determined by these data"), "{}", said[2]);
    assert!(said[3].contains("impacts:      1.00 per cycle recorded"), "{}", said[3]);
    for picture in ["comparison.png", "comparison.pdf", "comparison.csv", "figures/coasting.png"] {
        assert!(folder.path().join("rig").join(picture).is_file(), "{picture}");
    }
}

/// A command line as a shell would split it, quotes being all that it has.
fn split(line: &str) -> Vec<String> {
    let parts = line.split('"').enumerate();
    parts
        .flat_map(|(i, part)| match i % 2 {
            0 => part.split_whitespace().map(str::to_owned).collect(),
            _ => vec![part.to_owned()],
        })
        .collect()
}

#[test]
fn the_study_of_the_book_shows_hysteresis() {
    let kept = std::fs::read_to_string("studies/hysteresis.toml").expect("the study");
    let shown = Study::parse("maps.md", blocks(MAPS, "toml")[0]).expect("a study");
    let kept = Study::parse("studies/hysteresis.toml", &kept).expect("a study");
    assert_eq!(Study { text: String::new(), ..shown }, Study { text: String::new(), ..kept });

    let folder = clone();
    capsulemap(&["sweep", "studies/hysteresis.toml", "--formats", "png"], folder.path());
    let dataset = store::read(&folder.path().join("results/hysteresis/hysteresis.h5"));
    let dataset = dataset.expect("results");
    let omega = dataset.coordinate("omega").expect("the axis").values.to_real();
    let speed = dataset.variable("progression_speed").expect("the speed").values.to_real();
    for (i, omega) in omega.iter().enumerate() {
        let (up, down) = (speed[[i, 0]], speed[[i, 1]]);
        match omega {
            151.5..163.5 => assert!(up > 0.06 && down.abs() < 1e-10, "{omega}: {up} {down}"),
            125.0..150.5 => assert!((up - down).abs() < 1e-4 && up > 0.0, "{omega}: {up} {down}"),
            165.0.. => assert!(up.abs().max(down.abs()) < 1e-10, "{omega}: {up} {down}"),
            _ => {}
        }
    }
    let fastest = speed.iter().copied().fold(0.0, f64::max);
    assert_eq!(format!("{:.0}", fastest * 1e3), "73");
    read_in_python(folder.path());
}

/// Runs the Python of docs/results.md where a Python with the readers is at hand.
fn read_in_python(folder: &Path) {
    let Ok(python) = std::env::var("CAPSULEMAP_PYTHON") else {
        println!(
            "SKIPPED: the Python of docs/results.md (CAPSULEMAP_PYTHON names no Python with xarray)"
        );
        return;
    };
    let output = Command::new(python)
        .args(["-c", blocks(include_str!("../../docs/results.md"), "python")[0]])
        .current_dir(folder)
        .output()
        .expect("python starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let printed = String::from_utf8(output.stdout).expect("text");
    let speeds: Vec<f64> = printed
        .trim_matches(|c: char| "[]\n ".contains(c))
        .split_whitespace()
        .map(|word| word.parse().expect("a number"))
        .collect();
    assert!(speeds[0] > 0.06 && speeds[1].abs() < 1e-10, "{printed}");
}

#[test]
fn every_study_that_is_kept_can_be_read() {
    for entry in std::fs::read_dir("studies").expect("the studies") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("text");
        let study = Study::parse(&path.display().to_string(), &text);
        let study = study.unwrap_or_else(|faults| panic!("{faults}"));
        assert!(!study.title.is_empty() && !study.drawings.is_empty(), "{}", path.display());
    }
}

#[test]
fn the_reference_of_studies_names_every_parameter_and_output() {
    use capsulemap::capsule::Output;
    use capsulemap::capsule::Parameter;
    use capsulemap::orbit::Protocol;
    let pages = ["study/parameters", "study/protocol", "family", "outputs"];
    let read = |page| std::fs::read_to_string(format!("docs/{page}.md")).expect("a page");
    let reference = pages.map(read).join("\n");
    let parameters = Parameter::ALL.iter().map(|parameter| parameter.symbol());
    for name in parameters.chain(Output::ALL.iter().map(|output| output.name())) {
        assert!(reference.contains(&format!("`{name}`")), "{name}");
    }
    for output in Output::ALL {
        let row = reference.lines().find(|line| line.contains(&format!("| `{}`", output.name())));
        let known = row.is_some_and(|row| row.contains(&format!("| {} |", output.unit())));
        assert!(known || output.name().starts_with("backward"), "{}", output.name());
    }
    let Protocol { max_cycles, max_steps, max_period, measured_cycles, .. } = Protocol::default();
    for (key, value) in [
        ("max_cycles", max_cycles),
        ("max_steps", max_steps),
        ("max_period", max_period as u64),
        ("measured_cycles", measured_cycles),
    ] {
        let row = reference.lines().find(|line| line.starts_with(&format!("| `{key}`")));
        assert!(row.is_some_and(|row| row.ends_with(&format!("| {value} |"))), "{key}");
    }
}

#[test]
fn the_table_of_the_model_is_the_tested_one() {
    let tested = include_str!("../../crates/engine/tests/it/paper.rs");
    for digits in ["10.298005", "25.39085", "0.008345", "1.119443", "0.528927", "3.575601"] {
        assert!(MODEL.contains(digits) && tested.contains(digits), "{digits}");
    }
}

#[test]
fn the_gallery_is_as_its_script_writes_it_and_shows_every_kind() {
    let (page, root) = ("docs/gallery.md", Path::new(env!("CARGO_MANIFEST_DIR")));
    let folder = clone();
    let script = "scripts/gallery.sh";
    for part in ["scripts", "docs"] {
        std::fs::create_dir_all(folder.path().join(part)).expect("a folder");
    }
    std::fs::copy(root.join(script), folder.path().join(script)).expect("the script");
    let mut bash = Command::new("bash");
    let ran = bash.args([script, "--page"]).current_dir(folder.path()).status().expect("bash");
    assert!(ran.success());
    let written = std::fs::read_to_string(folder.path().join(page)).expect("a page");
    let kept = std::fs::read_to_string(root.join(page)).expect("a page");
    assert!(written == kept, "run {script} --page");
    for (name, _) in DrawingKind::NAMES {
        assert!(kept.contains(&format!("## {name}\n")), "{name}");
        assert!(kept.contains(&format!("kind = \"{name}\"")), "{name}");
    }
    for picture in kept.split("](").skip(1).filter_map(|it| it.split(')').next()) {
        assert!(root.join("docs").join(picture).exists(), "{picture}");
    }
}

#[test]
fn the_defaults_of_the_model_are_those_of_the_program() {
    let cells = |line: &'static str| line.trim_matches('|').split('|').map(str::trim);
    let lines: Vec<&str> = MODEL.lines().collect();
    let at = lines.iter().position(|line| line.starts_with("| m1 |")).expect("a table");
    let (names, values) = (cells(lines[at]), cells(lines[at + 2]));
    let mut count = 0;
    for (name, value) in names.zip(values) {
        let parameter = Parameter::named(name).expect(name);
        let value = parse_quantity(value, parameter.dimension()).expect(name);
        assert_eq!(value, parameter.default_value(), "{name}");
        count += 1;
    }
    assert_eq!(count, 8);
}

#[test]
fn the_commands_of_a_long_run_do_what_is_said_of_them() {
    let lines = blocks(LONG_RUNS, "sh").into_iter().find(|block| block.contains("--dry-run"));
    let folder = tempfile::tempdir().expect("a folder");
    let study = blocks(MAPS, "toml")[0].replace("points = 351", "points = 15");
    std::fs::write(folder.path().join("long.toml"), study).expect("a study");
    let mut said = String::new();
    for line in lines.expect("the commands").lines() {
        let command = line.split('#').next().expect("a command").trim();
        let arguments: Vec<&str> = command.split_whitespace().skip(1).collect();
        said += &capsulemap(&arguments, folder.path());
    }
    for part in ["30 in 1 block", "30 cases, ", "all cases, written", "30 cases drawn"] {
        assert!(said.contains(part), "{part}: {said}");
    }
}
