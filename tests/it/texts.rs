//! Oscillators given as text, through the program: they are simulated, swept, continued, drawn and explored by the same commands as the
//! models that the program has.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::explorer::Explorer;
use super::program::WorkDir;

/// A text of the repository.
fn system(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems").join(name);
    fs::read_to_string(path).expect("a text")
}

/// The mass at the wall over frequencies, with a branch.
const WALL: &str = r#"system = "impact.toml"
outputs = ["impact_per_cycle", "largest_part"]
[[axes]]
name = "w"
from = 1.41
to = 1.8
points = 14
[start]
inherit = "w"
[protocol]
points = 8
[[branches]]
name = "of the free motion"
along = "w"
from = 1.3
to = 2.0
at = { w = 1.3 }
[[figures]]
name = "section"
kind = "bifurcation"
x = "w"
of = ["section_x"]
"#;

/// A folder with the study `wall.toml` and its system.
fn work() -> WorkDir {
    let work = WorkDir::new();
    work.put("impact.toml", system("impact.toml"));
    work.put("wall.toml", WALL);
    work
}

fn number(told: &Value, key: &str) -> f64 {
    told[key].as_f64().unwrap_or_else(|| panic!("no number {key}: {told}"))
}

#[test]
fn the_capsule_as_a_text_has_the_speed_of_the_capsule() {
    let work = WorkDir::new();
    work.put("capsule.toml", system("capsule.toml"));
    let told = work.run(&["simulate", "--system", "capsule.toml", "--json"]).json();
    let own = work.run(&["simulate", "--json"]).json();
    assert_eq!(told["model"], "vibro-impact capsule");
    let (text, own) = (&told["orbit"], &own["orbit"]);
    let speeds = [number(text, "speed_of_x2"), number(own, "progression_speed")];
    assert!((speeds[0] - speeds[1]).abs() < 1e-13, "{speeds:?}");
    assert_eq!(text["period"], own["period"]);
    assert_eq!(text["certificate"], own["certificate"]);
    let refused = work.run(&["simulate", "--system", "capsule.toml", "--k2", "3", "--set", "k3=1"]);
    refused.refused(&["--k2: is an option of capsules", "--set: unknown parameter \"k3\""]);
}

#[test]
fn a_study_keeps_its_system_in_the_results() {
    let work = work();
    work.run(&["sweep", "wall.toml", "--output", "a.h5"]).done();
    work.run(&["continue", "wall.toml", "--output", "a.h5"]).done();
    fs::remove_file(work.path("impact.toml")).expect("the text");
    // All that follows is asked of the results alone.
    let inspected = work.run(&["inspect", "a.h5"]).done().out;
    assert!(inspected.contains("model: impact oscillator"), "{inspected}");
    work.run(&["verify", "a.h5"]).done();
    work.run(&["figure", "a.h5", "--kind", "bifurcation", "--x", "w", "--formats", "svg"]).done();
    let told = work.run(&["simulate", "--system", "a.h5", "--set", "w=1.3", "--json"]).json();
    // Grazing is at sqrt(1.99): slower, the wall is met.
    assert!(number(&told["orbit"], "impact_per_cycle") > 0.0, "{told}");
    let told = work.run(&["simulate", "--system", "a.h5", "--set", "w=1.9", "--json"]).json();
    assert_eq!(number(&told["orbit"], "impact_per_cycle"), 0.0);
    let again = work.run(&["sweep", "wall.toml", "--output", "b.h5"]);
    again.refused(&["impact.toml"]);
}

#[test]
fn a_branch_of_a_text_grazes_and_folds_where_it_is_known() {
    let work = work();
    work.run(&["sweep", "wall.toml", "--output", "a.h5", "--no-figures"]).done();
    let told = work.run(&["continue", "wall.toml", "--output", "a.h5"]).done().out;
    for (kind, place) in [("grazing", "1.410673598"), ("fold", "1.703193808")] {
        let line = told.lines().find(|it| it.trim_start().starts_with(kind)).expect(kind);
        assert!(line.contains(place), "{told}");
    }
}

#[test]
fn the_system_may_stand_in_the_study_and_is_the_same() {
    let work = work();
    work.run(&["sweep", "wall.toml", "--output", "a.h5", "--no-figures"]).done();
    let inline = WALL.replace("system = \"impact.toml\"\n", "") + "\n" + &system("impact.toml");
    work.put("inline.toml", &inline);
    // It is the same study, so that what is there already is kept.
    let kept = work.run(&["sweep", "inline.toml", "--output", "a.h5", "--no-figures"]).done();
    assert!(!kept.err.contains("another study"), "{}", kept.err);
    work.put("other.toml", inline.replace("-r*v", "-0.99*r*v"));
    let other = work.run(&["sweep", "other.toml", "--output", "a.h5", "--no-figures"]);
    other.refused(&["a.h5", "another study"]);
}

#[test]
fn faults_of_a_system_are_told_with_file_and_line() {
    let work = work();
    work.put("impact.toml", system("impact.toml").replace("- x - c*v", "- x - d*v"));
    let refused = work.run(&["sweep", "wall.toml", "--output", "a.h5"]);
    refused.refused(&["impact.toml: 1 fault", "line 15", "nothing is called \"d\""]);
    work.put("impact.toml", system("impact.toml"));
    work.put("wall.toml", WALL.replace("\"w\"", "\"omega\""));
    let refused = work.run(&["sweep", "wall.toml", "--output", "a.h5"]);
    refused.refused(&["wall.toml", "unknown axis \"omega\"", "c, f, w, r, wall, start_x"]);
    work.put("wall.toml", format!("model = \"capsule\"\n{WALL}"));
    work.run(&["check", "wall.toml"]).refused(&["not both"]);
    work.put("wall.toml", WALL.replace("impact.toml", "nothing.toml"));
    work.run(&["check", "wall.toml"]).refused(&["nothing.toml", "cannot be read"]);
    work.put("inline.toml", "[system]\nname = \"x\"\n");
    work.run(&["check", "inline.toml"]).refused(&["needs states", "needs a section"]);
    // What results call otherwise is told before anything is computed.
    let outputs = "[system.outputs]\nperiod = \"max(x)\"\nkind = \"min(x)\"\n";
    work.put("impact.toml", system("impact.toml") + outputs);
    work.put("wall.toml", WALL);
    for file in ["wall.toml", "impact.toml"] {
        let parts = ["6 faults", "two things called `attractor_kind`", "called `period`"];
        work.run(&["check", file]).refused(&parts);
    }
}

#[test]
fn the_page_shows_a_text_and_hands_over_its_command() {
    let work = work();
    work.run(&["sweep", "wall.toml", "--output", "a.h5", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["a.h5"]);
    let told = explorer.object("/api/motion?w=1.5&cycles=3");
    let command = told["command"].as_str().expect("a command");
    assert!(command.contains("--system "), "{command}");
    let arguments = command.strip_prefix("capsulemap").expect("a command of the program");
    let printed = work.shell(&format!("\"$0\" {arguments} --json")).json();
    assert_eq!(told["simulate"], printed);
}

#[test]
fn new_studies_are_checked_and_computed_as_they_stand() {
    let work = WorkDir::new();
    for (options, file, parts) in [
        (&[][..], "gap.toml", ["1 000 cases (25 x 40)", "capsule"]),
        (&["--system"][..], "wall.toml", ["121 cases (121)", "driven mass at a wall"]),
    ] {
        let written = work.run(&[&["new", file][..], options].concat()).done().out;
        assert!(written.contains(&format!("capsulemap check {file}")), "{written}");
        let checked = work.run(&["check", file]).done().out;
        assert!(parts.iter().all(|it| checked.contains(it)), "{checked}");
        work.run(&["sweep", file, "--output", "a.h5", "--overwrite"]).done();
        work.run(&["new", file]).refused(&[file]);
    }
}

#[test]
fn a_start_behind_a_bound_is_told_as_one() {
    let work = WorkDir::new();
    work.put("impact.toml", system("impact.toml"));
    let start = ["simulate", "--system", "impact.toml", "--start", "x=1.5"];
    let told = work.run(&start).done().out;
    assert!(told.contains("no motion starts there"), "{told}");
    // Nothing of it has a unit.
    assert!(!told.contains("(SI)") && !told.contains("[s]"), "{told}");
}

#[test]
fn what_follows_from_a_text_is_told() {
    let work = WorkDir::new();
    work.put("capsule.toml", system("capsule.toml"));
    let checked = work.run(&["check", "capsule.toml"]).done().out;
    for part in [
        "x2 drifts",
        "up to 6, by switches touch; frictions",
        "impact, touch ends, slip forward, slip backward, stick, reversal",
        "speed_of_x2",
        "3 of 8",
    ] {
        assert!(checked.contains(part), "{part}: {checked}");
    }
    let [own, of_capsule] = ["cost", "as a text takes"].map(|before| {
        let rest = checked.split(before).nth(1).expect(before).trim_start();
        let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
        digits.parse::<usize>().expect("a number")
    });
    assert_eq!(own, of_capsule, "{checked}");
}

#[test]
fn every_system_of_the_repository_is_checked_without_a_fault() {
    let work = WorkDir::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems");
    let mut count = 0;
    for entry in fs::read_dir(folder).expect("the folder of systems") {
        let name = entry.expect("a file").file_name().into_string().expect("a name");
        if name.ends_with(".toml") {
            work.put(&name, system(&name));
            let checked = work.run(&["check", &name]).done().out;
            assert!(checked.contains("no fault"), "{checked}");
            count += 1;
        }
    }
    assert!(count >= 11, "{count}");
}
