//! The joined run: from a study to its file and figures.

use std::fs;
use std::path::Path;

use capsulemap::capsule::{CapsuleState as _, Output, Parameter, State, settle};
use capsulemap::lane::Instructions;
use capsulemap::of::default_model;
use capsulemap::store::{self, Dataset, Values, Variable};
use capsulemap::study::{DrawingKind, Study};
use serde_json::Value;

use super::program::{FIG5, WorkDir};

/// Two axes of a few cases, with starts inherited in both directions, with every kind of figure and all they can show.
const RICH: &str = r#"title = "All there is"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
[[axes]]
name = "omega"
values = ["70 rad/s", "20.73 rad/s", "77.91 rad/s"]
[[axes]]
name = "p_d"
from = "2 N"
to = "8 N"
points = 3
spacing = "logarithmic"
[start]
inherit = "omega"
directions = ["upward", "downward"]
[history]
cycles = 2
samples_per_cycle = 20
"#;

/// Figures of `RICH`: name, kind, what it shows and where.
fn rich_figures() -> String {
    let outputs = Study::default().outputs.into_iter().map(|it| format!("\"{}\"", it.name()));
    let outputs = outputs.collect::<Vec<_>>().join(", ");
    let mut text = String::new();
    let mut figure = |name: &str, kind: &str, more: &str| {
        text += &format!("[[figures]]\nname = \"{name}\"\nkind = \"{kind}\"\n{more}\n");
    };
    let histories = DrawingKind::History.can_show(default_model(), &[]).join("\", \"");
    let histories = histories.replace("\", \"history_rear_contact", "");
    figure("h", "history", &format!("of = [\"{histories}\"]\nat = {{ p_d = \"4 N\" }}"));
    figure("p", "phase-portrait", "cycles = [0, 1]");
    figure("b", "bifurcation", &format!("of = [{outputs}]\nx = \"p_d\""));
    let points = "\"section_r\", \"section_y1\", \"section_y2\", \"impact_phase\", \"impact_y1\", \"impact_y2\", \"period\", \"outcome\", \"cycles\"";
    figure("points", "bifurcation", &format!("of = [{points}]"));
    for name in ["period", "outcome", "cycles", "cost_of_transport"] {
        figure(name, "map", &format!("of = [\"{name}\"]\ntitle = \"Map of {name}\""));
    }
    figure("t", "trade-off", "of = [\"work_net\"]");
    text
}

fn bits(variable: &Variable) -> Vec<u64> {
    variable.values.to_real().iter().map(|value| value.to_bits()).collect()
}

/// The dataset in a file as it compares with another: without when it was made.
fn timeless(path: &Path) -> Dataset {
    let mut dataset = store::read(path).expect("a result");
    dataset.attributes.remove("created").expect("a time");
    dataset
}

fn codes(dataset: &Dataset, name: &str) -> Vec<i64> {
    match &dataset.variable(name).expect(name).values {
        Values::Integer(codes) => codes.iter().copied().collect(),
        Values::Real(_) => panic!("{name} is not of integers"),
    }
}

#[test]
fn a_sweep_writes_what_simulate_says_bit_for_bit() {
    let dir = WorkDir::new();
    let frequencies = ["77.91", "20.73", "46"];
    let study = FIG5.replace("omega = \"77.91 rad/s\"\n", "")
        + "[[axes]]\nname = \"omega\"\nvalues = [\"77.91 rad/s\", \"20.73 rad/s\", \"46 rad/s\"]\n\
           [[axes]]\nname = \"start_r\"\nvalues = [\"0 mm\", \"-2 mm\"]\n";
    dir.put("two.toml", study);
    dir.run(&["sweep", "two.toml"]).done();
    let dataset = store::read(&dir.path("results/two/two.h5")).expect("a result");
    let shape = dataset.variable("outcome").map(|variable| variable.values.shape().to_vec());
    assert_eq!(shape, Some(vec![3, 2]));
    for (i, omega) in frequencies.iter().enumerate() {
        for (j, start) in ["r=0", "r=-2mm"].iter().enumerate() {
            let ran = dir
                .run(&["simulate", "--omega", omega, "--start", start, "--cycles", "0", "--json"])
                .done();
            for &output in Output::ALL.iter().filter(|it| !it.is_optional()) {
                let kept = dataset.variable(output.name()).expect("it").values.to_real()[[i, j]];
                let said = ran.printed(output.name());
                let alike = kept.to_bits() == said.to_bits() || said.is_nan() && !kept.is_finite();
                assert!(alike, "{} at {omega} {start}: {kept:e} {said:e}", output.name());
            }
            assert_eq!(codes(&dataset, "period")[2 * i + j], ran.json()["orbit"]["period"]);
            assert_eq!(codes(&dataset, "cycles")[2 * i + j], ran.json()["orbit"]["cycles"]);
        }
    }
}

#[test]
fn any_threads_and_any_instructions_give_the_same_file() {
    let dir = WorkDir::new();
    dir.put("rich.toml", RICH);
    for threads in ["1", "2", "7"] {
        let output = format!("{threads}.h5");
        dir.run(&["sweep", "rich.toml", "--threads", threads, "--output", &output]).done();
    }
    let by: Vec<&str> = Instructions::available().map(Instructions::name).collect();
    for &name in &by {
        let output = format!("{name}.h5");
        dir.run(&["sweep", "rich.toml", "--instructions", name, "--output", &output]).done();
    }
    let one = timeless(&dir.path("1.h5"));
    let bytes = fs::read(dir.path("1.h5")).expect("a result");
    for other in ["2", "7"].iter().chain(&by) {
        let other = &format!("{other}.h5");
        let several = timeless(&dir.path(other));
        assert_eq!(store::difference(&one, &several), None);
        let names = |dataset: &Dataset| dataset.variables.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&one), names(&several));
        assert!(one.variables.iter().all(|(name, it)| bits(it) == bits(&several.variables[name])));
        // What is left are the digits of the time and the four bytes of the checksum.
        let again = fs::read(dir.path(other)).expect("a result");
        assert_eq!(bytes.len(), again.len());
        let apart = bytes.iter().zip(&again).filter(|(a, b)| a != b).count();
        assert!(apart <= 20 + 4, "{apart} bytes differ");
    }
    dir.run(&["sweep", "rich.toml", "--threads", "0"]).refused(&["--threads"]);
    dir.run(&["sweep", "rich.toml", "--instructions", "mmx"]).refused(&["mmx", "sse2", "avx512"]);
}

#[test]
fn an_inherited_start_is_the_final_state_of_the_neighbour() {
    let dir = WorkDir::new();
    dir.put("rich.toml", RICH);
    let study = Study::parse("rich.toml", RICH).expect("a study");
    let plain = RICH.split("[start]").next().expect("the head");
    dir.put("plain.toml", plain);
    for study in ["rich.toml", "plain.toml"] {
        dir.run(&["sweep", study, "--no-figures"]).done();
    }
    let followed = store::read(&dir.path("results/rich/rich.h5")).expect("a result");
    let fresh = store::read(&dir.path("results/plain/plain.h5")).expect("a result");
    let speed = |dataset: &Dataset| dataset.variables["progression_speed"].values.to_real();
    assert_eq!(speed(&followed).shape(), [3, 3, 2]);
    for p_d in 0..3 {
        for (first, direction) in [(0, 0), (2, 1)] {
            let (alone, followed) = (speed(&fresh), speed(&followed));
            let followed = followed[[first, p_d, direction]];
            assert_eq!(alone[[first, p_d]].to_bits(), followed.to_bits());
        }
    }
    let parameters = |omega: f64| {
        let mut parameters = study.base.clone();
        parameters[Parameter::Omega] = omega;
        parameters[Parameter::Pd] = study.axes()[1].varying[0].values[1];
        parameters
    };
    // The last case of the middle row: twice on from where the neighbour was left.
    let mut start = State::default();
    for (i, &omega) in study.axes()[0].varying[0].values.iter().enumerate() {
        let orbit = settle(&parameters(omega), 0.0, start, &study.protocol);
        start = State { x2: 0.0, ..orbit.end.capsule() };
        let expected = orbit.outputs[Output::ProgressionSpeed];
        assert_eq!(speed(&followed)[[i, 1, 0]].to_bits(), expected.to_bits());
    }
    // The same case by itself, with all that it follows.
    let ran = dir.run(&["simulate", "--study", "rich.toml", "--case", "14", "--json"]).done();
    let alone = ran.printed("progression_speed");
    assert_eq!(speed(&followed)[[2, 1, 0]].to_bits(), alone.to_bits());
    assert!(ran.err.contains("2 cases come before it"), "{}", ran.err);
    let direction = followed.coordinate("direction").expect("directions");
    assert_eq!(direction.flags, [(0, "upward".to_owned()), (1, "downward".to_owned())]);
}

#[test]
fn every_figure_that_a_study_may_ask_for_can_be_drawn() {
    let dir = WorkDir::new();
    dir.put("rich.toml", RICH.to_owned() + &rich_figures());
    let ran = dir.run(&["sweep", "rich.toml", "--formats", "svg"]).done();
    let names = ["h", "p", "b", "points", "period", "outcome", "cycles", "cost_of_transport", "t"];
    for name in names {
        let path = format!("results/rich/{name}.svg");
        assert!(dir.path(&path).is_file() && ran.err.contains(&path), "{}", ran.err);
    }
    // The file alone suffices to draw them again.
    let moved = WorkDir::new();
    fs::copy(dir.path("results/rich/rich.h5"), moved.path("a.h5")).expect("a copy");
    moved.run(&["figure", "a.h5", "--folder", "there", "--formats", "svg,png"]).done();
    assert_eq!(moved.files().len(), 2 + 2 * names.len());
    let svg = |dir: &WorkDir, path: &str| fs::read(dir.path(path)).expect("a figure");
    assert_eq!(svg(&dir, "results/rich/t.svg"), svg(&moved, "there/t.svg"));
}

#[test]
fn a_figure_that_cannot_be_drawn_is_reported_before_the_run() {
    let dir = WorkDir::new();
    let figure = |more: &str| format!("{FIG5}[[figures]]\nname = \"a\"\n{more}\n");
    dir.put("history.toml", figure("kind = \"history\""));
    dir.put("map.toml", figure("kind = \"map\""));
    dir.put("glyph.toml", RICH.to_owned() + "[[figures]]\nname=\"a\"\nkind=\"map\"\ntitle=\"漢\"");
    let before = dir.files();
    dir.run(&["sweep", "history.toml"]).refused(&["figure `a`: the results hold no time hist"]);
    dir.run(&["sweep", "map.toml"]).refused(&["figure `a`: a map needs two axes"]);
    dir.run(&["sweep", "glyph.toml"]).refused(&["figure `a`", "漢"]);
    assert_eq!(dir.files(), before);
    dir.run(&["sweep", "history.toml", "--no-figures"]).done();
}

#[test]
fn one_figure_that_fails_does_not_keep_the_others() {
    let dir = WorkDir::new();
    dir.put("rich.toml", RICH.to_owned() + &rich_figures());
    fs::create_dir_all(dir.path("results/rich/p.svg/in-the-way")).expect("a folder in the way");
    dir.run(&["sweep", "rich.toml"]).refused(&["figure `p`: results/rich/p.svg: is a folder"]);
    dir.run(&["sweep", "rich.toml", "--no-figures"]).done();
    let ran = dir.run(&["figure", "results/rich/rich.h5", "--formats", "svg"]);
    ran.refused(&["figure `p`: results/rich/p.svg: is a folder"]);
    let drawn = dir.files().iter().filter(|name| name.ends_with(".svg")).count();
    assert_eq!(drawn, 9);
}

#[test]
fn results_are_not_overwritten_unasked() {
    let dir = WorkDir::new();
    dir.put("a.toml", FIG5);
    dir.put("b.toml", FIG5.replace("77.91", "46"));
    dir.run(&["sweep", "a.toml", "--output", "r.h5"]).done();
    let first = fs::read(dir.path("r.h5")).expect("a result");
    let again = dir.run(&["sweep", "a.toml", "--output", "r.h5"]).done();
    assert!(again.err.contains("r.h5: already computed") && again.out.is_empty(), "{}", again.err);
    dir.run(&["sweep", "b.toml", "--output", "r.h5"])
        .refused(&["r.h5: holds results of another study", "--overwrite"]);
    dir.put("other.h5", "not a result");
    dir.run(&["sweep", "b.toml", "--output", "other.h5"]).refused(&["other.h5 is kept"]);
    assert_eq!(fs::read(dir.path("r.h5")).expect("a result"), first);
    dir.run(&["sweep", "b.toml", "--output", "r.h5", "--overwrite"]).done();
    assert_ne!(fs::read(dir.path("r.h5")).expect("a result"), first);
}

#[test]
fn an_output_that_cannot_be_written_is_reported_and_leaves_nothing() {
    let dir = WorkDir::new();
    dir.put("a.toml", FIG5);
    fs::create_dir(dir.path("folder.h5")).expect("a folder in the way");
    let before = dir.files();
    let sweep = |output: &str| dir.run(&["sweep", "a.toml", "--overwrite", "--output", output]);
    sweep("folder.h5").refused(&["folder.h5: is a folder; name a file"]);
    sweep("a.toml").refused(&["a.toml: is the study itself"]);
    sweep("a.toml/b/c.h5").refused(&["a.toml is a file, not a folder"]);
    if cfg!(target_os = "linux") {
        sweep("/dev/null").refused(&["/dev/null: is not a plain file"]);
        let ran = sweep("/proc/here.h5");
        assert_eq!((ran.code, ran.out.as_str()), (3, ""), "{}", ran.err);
        // A file that may not grow stands for a full disk.
        let script = "trap '' XFSZ; ulimit -f 4; exec \"$0\" sweep a.toml";
        let ran = dir.shell(script);
        assert_eq!((ran.code, ran.out.as_str()), (3, ""), "{}", ran.err);
        assert!(ran.err.contains("File too large"), "{}", ran.err);
        let left = dir.files();
        assert!(
            left.iter()
                .all(|name| !name.ends_with(".tmp") && !name.ends_with(".h5")
                    || before.contains(name)),
            "{left:?}"
        );
        fs::remove_dir_all(dir.path("results")).expect("what is left goes on with more room");
    }
    assert_eq!(dir.files(), before);
}

#[test]
fn a_case_that_fails_is_a_record_and_can_be_replayed() {
    let dir = WorkDir::new();
    let axis = "[[axes]]\nname = \"start_r\"\nvalues = [\"0 m\", \"1e300 m\", \"1 mm\"]\n";
    dir.put("a.toml", FIG5.to_owned() + axis + "[protocol]\ntolerance = 1e-10\n");
    let ran = dir.run(&["sweep", "a.toml"]).done();
    let dataset = store::read(&dir.path("results/a/a.h5")).expect("a result");
    assert_eq!(codes(&dataset, "outcome"), [0, 4, 0]);
    assert_eq!(codes(&dataset, "failure_reason"), [0, 2, 0]);
    let failed_at = dataset.variables["failure_time"].values.to_real();
    assert!(failed_at[[0]].is_nan() && failed_at[[1]] >= 0.0);
    let speeds = dataset.variables["progression_speed"].values.to_real();
    assert!(speeds[[0]].is_finite() && speeds[[1]].is_nan() && speeds[[2]].is_finite());
    assert!(ran.out.contains("3 cases") && ran.out.contains("failed         1"), "{}", ran.out);
    let replay = ran.out.split("replay: capsulemap ").nth(1).expect("how to replay").trim();
    assert_eq!(replay, "simulate --study a.toml --case 1");
    let again = dir.shell(&format!("\"$0\" {replay} --json")).json();
    assert_eq!(again["orbit"]["outcome"], "failed");
    assert!(ran.out.contains("case 1 failed: not-finite, at t = "), "{}", ran.out);
}

#[test]
fn a_log_of_a_run_holds_plain_lines() {
    let dir = WorkDir::new();
    dir.put("rich.toml", RICH);
    let ran = dir.run(&["sweep", "rich.toml"]).done();
    let first = ran.err.lines().next().expect("a line of progress");
    assert!(first.starts_with("block 0: 18 cases, ") && first.ends_with(" s left"), "{first}");
    assert!(!ran.err.contains(['\u{1b}', '\r']) && !ran.out.contains(['\u{1b}', '\r']));
    assert!(ran.out.starts_with("results/rich/rich.h5: 18 cases, "), "{}", ran.out);
}

#[test]
fn figures_of_ones_own_come_from_the_file_alone() {
    let dir = WorkDir::new();
    dir.put("rich.toml", RICH);
    dir.run(&["sweep", "rich.toml", "--output", "r.h5"]).done();
    let figure = |more: &[&str]| dir.run(&[&["figure", "r.h5"], more].concat());
    figure(&["--kind", "bifurcation", "--at", "p_d=3.9 N", "--name", "at-4", "--formats", "pdf"])
        .done();
    figure(&["--kind", "map", "--of", "work_net", "--width", "120", "--folder", "x"]).done();
    for path in ["at-4.pdf", "x/map-work_net.png", "x/map-work_net.svg", "x/map-work_net.pdf"] {
        assert!(dir.path(path).is_file(), "{path}");
    }
    let before = dir.files();
    figure(&[]).refused(&["r.h5: its study asks for no figures; name a --kind"]);
    figure(&["--kind", "mapp"]).refused(&["mapp", "map"]);
    figure(&["--of", "work_net"]).refused(&["--kind"]);
    figure(&["--kind", "map", "--of", "work_nett"]).refused(&["did you mean `work_net`?"]);
    figure(&["--kind", "map", "--x", "omga"]).refused(&["`omga`", "did you mean `omega`?"]);
    figure(&["--kind", "map", "--at", "omga=3", "--at", "p_d=3 mm", "--at", "p_d", "--at", "k2=1"])
        .refused(&[
            "--at: unknown axis of these results \"omga\"; did you mean \"omega\"? (allowed: omega, p_d)",
            "--at p_d: \"3 mm\" is a length; expected a force",
            "--at p_d: expected AXIS=VALUE",
            "--at: unknown axis of these results \"k2\"",
        ]);
    figure(&["--kind", "map", "--at", "p_d=4"]).refused(&["a map needs two axes"]);
    figure(&["--kind", "map", "--name", "../x"]).refused(&["stem of a file name"]);
    figure(&["--kind", "map", "--width", "3"]).refused(&["40 to 1000 mm"]);
    figure(&["--kind", "map", "--title", "漢"]).refused(&["漢"]);
    figure(&["--kind", "history", "--cycles", "5,3"]).refused(&["cycles"]);
    assert_eq!(dir.files(), before);
}

#[test]
fn files_that_are_no_results_are_reported_apart() {
    let dir = WorkDir::new();
    dir.put("a.toml", FIG5);
    dir.run(&["sweep", "a.toml", "--output", "a.h5"]).done();
    let whole = fs::read(dir.path("a.h5")).expect("a result");
    dir.put("cut.h5", &whole[..whole.len() / 2]);
    let mut changed = whole.clone();
    changed[whole.len() / 2] ^= 1;
    dir.put("changed.h5", changed);
    dir.put("empty.h5", "");
    for command in ["inspect", "figure"] {
        let ran = |file: &str| dir.run(&[command, file]);
        ran("a.toml").refused(&["a.toml: not a result of capsulemap: it is not an HDF5 file"]);
        ran("empty.h5").refused(&["empty.h5: not a result"]);
        ran("cut.h5").refused(&["cut.h5", "cut short"]);
        ran("changed.h5").refused(&["changed.h5: the file has changed since it was written"]);
        ran("absent.h5").refused(&["absent.h5", "No such file"]);
        ran(".").refused(&["folder"]);
    }
}

#[test]
fn inspect_tells_what_is_in_a_file() {
    let dir = WorkDir::new();
    // As an editor elsewhere writes it: a mark at the beginning, other ends of lines, none at last.
    let study = format!("\u{feff}# µ\n{}", RICH.trim_end()).replace('\n', "\r\n");
    dir.put("rich.toml", &study);
    dir.run(&["sweep", "rich.toml", "--output", "r.h5"]).done();
    let ran = dir.run(&["inspect", "r.h5"]).done().out;
    for part in
        ["title: All there is", "outcomes: 18 periodic\n", "source: capsulemap", "3 x 3 x 2"]
    {
        assert!(ran.contains(part), "{part} is missing from:\n{ran}");
    }
    let object = dir.run(&["inspect", "r.h5", "--json"]).json();
    assert_eq!(object["outcomes"]["periodic"], 18);
    assert_eq!(object["attributes"]["title"], "All there is");
    let speed = &object["variables"]["progression_speed"];
    assert_eq!(speed["dimensions"], Value::from(vec!["omega", "p_d", "direction"]));
    assert_eq!((&speed["unit"], &speed["missing"]), (&Value::from("m/s"), &Value::from(0)));
    assert_eq!(object["coordinates"]["omega"]["range"], Value::from(vec![20.73, 77.91]));
    let back = dir.run(&["inspect", "r.h5", "--study"]).done().out;
    assert_eq!(back, study);
    dir.run(&["inspect", "r.h5", "--study", "--json"]).refused(&["--json"]);
}

#[test]
fn a_study_needs_no_title() {
    let dir = WorkDir::new();
    for (name, title) in [("none", ""), ("empty", "title = \"\"\n"), ("some", "title = \"µ\"\n")] {
        dir.put("a.toml", title.to_owned() + FIG5);
        let output = format!("{name}.h5");
        dir.run(&["sweep", "a.toml", "--output", &output]).done();
        let ran = dir.run(&["inspect", &output, "--json"]).json();
        assert_eq!(ran["attributes"]["title"], if name == "some" { "µ" } else { "" });
    }
}
