//! The study file: every form of it, and every fault with its line and key.

use capsulemap::capsule::CapsuleState as _;
use capsulemap::study::Study;

use super::program::{FIG5, WorkDir};

fn read(text: &str) -> Study {
    Study::parse("study.toml", text).unwrap_or_else(|faults| panic!("{faults}"))
}

/// What is said of `text`, one fault a line.
fn said(text: &str) -> Vec<String> {
    let faults = Study::parse("study.toml", text).expect_err(text).to_string();
    faults.lines().skip(1).map(|line| line.trim().to_owned()).collect()
}

/// Sure that exactly the faults that begin so are found, in this order.
fn assert_said(text: &str, expected: &[&str]) {
    let found = said(text);
    let fits = found.len() == expected.len()
        && found.iter().zip(expected).all(|(found, expected)| found.starts_with(expected));
    assert!(fits, "expected {expected:#?}\nfound {found:#?}\nin\n{text}");
}

/// Fig 5 with `omega` on an axis written as `axis`.
fn omega_axis(axis: &str) -> String {
    let fig5 = FIG5.replace("omega = \"77.91 rad/s\"\n", "");
    format!("{fig5}[[axes]]\nname = \"omega\"\n{axis}\n")
}

fn figures(lines: &str) -> String {
    omega_axis(&format!("values = [\"60 rad/s\", \"70 rad/s\"]\n{lines}"))
}

const MANY: &str = r#"titel = "x"
outputs = ["progresion_speed", 3]
[parameters]
omega = 77.91
p_d = "4 mm"
m1 = "-1 kg"
mu_s = -0.1
mud = 0.3
resistance = "colomb"
friction_switching = 3
[[axes]]
name = "k2"
from = "0 N/m"
to = "10 kN/m"
points = 3
spacing = "logarithmic"
[[axes]]
name = "k1"
values = []
[[axes]]
name = "m2"
from = "1 kg"
to = "2 kg"
points = 0
[[axes]]
name = "delta"
values = ["1 mm", "2 mm", "0.1 cm"]
[[axes]]
name = "delta"
values = ["1 mm", "2"]
[[axes]]
nam = "x"
[start]
inherit = "omega"
directions = ["up", "upward", "upward"]
r = "4"
[protocol]
tolerance = 1
max_cycles = -3
[history]
from = "end"
[[figures]]
name = "a"
kind = "mapp"
x = "dleta"
at = { k2 = "1 mm", zz = 3 }
cycles = [3, 1]
"#;

#[test]
fn many_faults_are_reported_at_once_each_with_line_and_key() {
    assert_said(
        MANY,
        &[
            "line 1: titel: unknown key \"titel\"; did you mean \"title\"?",
            "line 2: outputs[1]: unknown output \"progresion_speed\"; did you mean \"progression_s",
            "line 2: outputs[2]: expected a text in quotes, found 3",
            "line 4: parameters.omega: 77.91 has no unit; expected a frequency in rad/s, Hz",
            "line 5: parameters.p_d: \"4 mm\" is a length; expected a force in N",
            "line 6: parameters.m1: -1 kg must be a finite number above zero",
            "line 7: parameters.mu_s: -0.1 must be a finite number, zero or above",
            "line 8: parameters.mud: unknown key \"mud\"; did you mean \"mu_d\"?",
            "line 9: parameters.resistance: unknown resistance \"colomb\"; did you mean \"coulomb\"",
            "line 10: parameters.friction_switching: expected a text in quotes, found 3",
            "line 16: axes[1].spacing: needs both ends above zero",
            "line 19: axes[2].values: expected at least one value",
            "line 24: axes[3].points: expected a whole number, 1 to 10000000, found 0",
            "line 27: axes[4].values[3]: 0.001, in SI units, is given twice",
            "line 29: axes[5].name: a second axis \"delta\"",
            "line 30: axes[5].values[2]: \"2\" has no unit; expected a length in m, mm",
            "line 31: axes[6].name: missing; expected a parameter, start_r",
            "line 31: axes[6].from: missing",
            "line 31: axes[6].to: missing",
            "line 31: axes[6].points: missing",
            "line 32: axes[6].nam: unknown key \"nam\"; did you mean \"name\"?",
            "line 34: start.inherit: unknown axis of this study \"omega\"",
            "line 36: start.r: \"4\" has no unit; expected a length",
            "line 38: protocol.tolerance: 1 must lie between 1e-15 and 1e-3",
            "line 39: protocol.max_cycles: expected a whole number, 1 or above, found -3",
            "line 41: history.from: unknown beginning \"end\" (allowed: start, attractor)",
            "line 44: figures[1].kind: unknown kind \"mapp\"; did you mean \"map\"?",
            "line 45: figures[1].x: unknown axis of this study \"dleta\"; did you mean \"delta\"?",
            "line 46: figures[1].at.k2: \"1 mm\" is a length; expected a stiffness",
            "line 46: figures[1].at.zz: unknown axis of this study \"zz\"",
            "line 47: figures[1].cycles: expected two numbers of cycles, the lesser first",
        ],
    );
}

#[test]
fn a_faulty_study_is_reported_by_the_program_and_leaves_nothing() {
    let dir = WorkDir::new();
    dir.put("many.toml", MANY);
    dir.put("broken.toml", "title = \"x\"\nomega = [1\np_d = \"4 N\n");
    dir.put("twice.toml", FIG5.to_owned() + "omega = \"3 Hz\"\n");
    dir.put("binary.toml", b"title = \"fine\"\n\nnote = \"\xff\"\n");
    std::fs::create_dir(dir.path("folder.toml")).expect("a folder");
    let before = dir.files();
    dir.run(&["sweep", "many.toml"])
        .refused(&["many.toml: 31 faults", "line 47: figures[1].cycles"]);
    dir.run(&["sweep", "broken.toml"]).refused(&["broken.toml", "line 3"]);
    dir.run(&["sweep", "twice.toml"])
        .refused(&["1 fault\n", "line 6: duplicate key, in: omega = \"3 Hz\""]);
    dir.run(&["sweep", "binary.toml"]).refused(&["binary.toml: line 3: is not text in UTF-8"]);
    dir.run(&["sweep", "absent.toml"]).refused(&["absent.toml: cannot be read: No such file"]);
    dir.run(&["sweep", "folder.toml"]).refused(&["folder.toml: cannot be read: is a folder"]);
    assert_eq!(dir.files(), before);
}

#[test]
fn what_a_study_must_say_is_asked_for() {
    assert_said(
        "",
        &["parameters.k2: missing", "parameters.delta: missing", "parameters.p_d: missing"]
            .into_iter()
            .chain(["parameters.omega: missing; expected a value for the frequency of the drive"])
            .collect::<Vec<_>>(),
    );
    let on_axis = omega_axis("values = [\"60 rad/s\"]");
    let both = on_axis.replace("p_d =", "omega = \"3 Hz\"\np_d =");
    assert_said(&both, &["line 2: parameters.omega: is given here and on an axis"]);
    let start = on_axis + "[[axes]]\nname = \"start_r\"\nvalues = [\"0 m\"]\n[start]\nr = \"1 mm\"";
    assert_said(&start, &["line 12: start.r: is given here and on an axis"]);
    let kinds = "title = 4\nparameters = 4\naxes = 3\nstart = \"x\"\nprotocol = []\nfigures = {}";
    let found = said(kinds);
    for (line, key) in
        ["title", "parameters", "axes", "start", "protocol", "figures"].iter().enumerate()
    {
        let begin = format!("line {}: {key}: expected", line + 1);
        assert!(found.iter().any(|fault| fault.starts_with(&begin)), "{begin} in {found:?}");
    }
}

#[test]
fn axes_are_linear_logarithmic_or_lists() {
    let values = |axis: &str| read(&omega_axis(axis)).axes()[0].varying[0].values.clone();
    let ends = "from = \"10 rad/s\"\nto = \"40 rad/s\"\n";
    assert_eq!(values(&format!("{ends}points = 4")), [10.0, 20.0, 30.0, 40.0]);
    let named = format!("{ends}points = 3\nspacing = \"logarithmic\"");
    let [low, middle, high] = values(&named)[..] else { panic!("three values") };
    assert!((low, high) == (10.0, 40.0) && (middle - 20.0).abs() < 1e-14);
    assert_eq!(values("values = [\"3 rad/s\", \"1 rad/s\", \"2e0 rad/s\"]"), [3.0, 1.0, 2.0]);
    let falling = "from = \"40 rad/s\"\nto = \"10 rad/s\"\npoints = 2\nspacing = \"linear\"";
    assert_eq!(values(falling), [40.0, 10.0]);
    let twice = "from = \"1 Hz\"\nto = \"1 Hz\"\npoints = 2";
    assert_said(&omega_axis(twice), &["line 8: axes[1].to: \"1 Hz\" is the same as `from`"]);
    assert_said(
        &omega_axis("values = [\"1 Hz\"]\npoints = 3"),
        &["line 8: axes[1].points: does not go with a list of values"],
    );
    for points in ["0", "-1", "1.5", "1000000000000000000"] {
        let axis = format!("{ends}points = {points}");
        assert_said(&omega_axis(&axis), &["line 9: axes[1].points: expected a whole number, 1"]);
    }
    for value in ["0 Hz", "-1 Hz", "inf Hz", "nan Hz", "1e308 kHz"] {
        let found = said(&omega_axis(&format!("values = [\"{value}\"]")));
        assert!(found[0].contains("must be a finite number above zero"), "{found:?}");
    }
}

#[test]
fn starts_and_the_phase_can_be_axes() {
    let mut text = FIG5.to_owned();
    for (name, unit) in
        [("start_r", "mm"), ("start_y1", "m/s"), ("start_y2", "m/s"), ("start_phase", "deg")]
    {
        text += &format!("[[axes]]\nname = \"{name}\"\nvalues = [\"1 {unit}\", \"2 {unit}\"]\n");
    }
    let study = read(&text);
    assert_eq!((study.cases(), study.shape()), (16, vec![2; 4]));
    let case = study.case(0b1010);
    assert_eq!(
        (case.start.capsule().r, case.start.capsule().y1, case.start.capsule().y2),
        (0.002, 1.0, 2.0)
    );
    assert!((case.start_phase - 1_f64.to_radians()).abs() < 1e-16 && case.section_phase == 0.0);
    assert!(
        said(&(text + "[start]\ninherit = \"start_phase\""))[0].contains("must be of parameters")
    );
}

#[test]
fn cases_inherit_their_start_upward_downward_or_both() {
    let inherit = |lines: &str| figures(&format!("[start]\n{lines}"));
    let chains = |lines: &str| chains(&read(&inherit(lines)));
    assert_eq!(chains(""), [[0], [1]]);
    assert_eq!(chains("inherit = \"omega\""), [[0, 1]]);
    assert_eq!(chains("inherit = \"omega\"\ndirections = [\"downward\"]"), [[1, 0]]);
    let both = "inherit = \"omega\"\ndirections = [\"upward\", \"downward\"]";
    assert_eq!(chains(both), [[0, 2], [3, 1]]);
    assert_said(
        &inherit("inherit = \"p_d\""),
        &["line 9: start.inherit: unknown axis of this study"],
    );
    assert_said(
        &inherit("inherit = \"omega\"\ndirections = [\"up\", \"upward\", \"upward\"]"),
        &[
            "line 10: start.directions[1]: unknown direction \"up\"",
            "line 10: start.directions[3]: \"upward\" is given twice",
        ],
    );
    assert_said(
        &inherit("directions = [\"upward\"]"),
        &["line 9: start.directions: needs `inherit`"],
    );
}

#[test]
fn the_older_key_of_an_inherited_start_is_accepted_alone() {
    let start = |lines: &str| figures(&format!("[start]\n{lines}"));
    let [older, now] = ["follow", "inherit"].map(|key| read(&start(&format!("{key} = \"omega\""))));
    assert!(older.inherit().is_some());
    assert_eq!(older.inherit(), now.inherit());
    assert_said(
        &start("inherit = \"omega\"\nfollow = \"omega\""),
        &["line 10: start.follow: is an older name of `inherit`"],
    );
}

#[test]
fn a_study_without_axes_is_one_case() {
    let study = read(FIG5);
    assert_eq!((study.cases(), study.shape(), chains(&study)), (1, vec![], vec![vec![0]]));
    assert_eq!(study.title, "");
}

#[test]
fn names_of_figures_are_checked_before_the_run() {
    let named = |name: &str| figures(&format!("[[figures]]\nname = {name}\nkind = \"map\"\n"));
    for name in ["''", "' '", "'../x'", "'a/b'", "'a\\b'", "'.hidden'", "\"a\\nb\"", "\"\\u0000\""]
    {
        assert_said(&named(name), &["line 9: figures[1].name: "]);
    }
    let long = format!("'{}'", "x".repeat(201));
    assert_said(&named(&long), &["line 9: figures[1].name: "]);
    let twice = named("'speed'") + "[[figures]]\nname = 'Speed'\nkind = \"map\"\n";
    assert_said(&twice, &["line 13: figures[2].name: the name \"Speed\" is used twice"]);
    assert_said(
        &figures("[[figures]]\n"),
        &["line 8: figures[1].name: missing", "line 8: figures[1].kind: missing"],
    );
}

#[test]
fn what_a_figure_cannot_show_is_reported_before_the_run() {
    let shown = |kind: &str, of: &str| {
        figures(&format!("[[figures]]\nname = 'a'\nkind = '{kind}'\nof = [{of}]\n"))
    };
    for (kind, of) in [
        ("map", "'progresion_speed'"),
        ("map", "'section_r'"),
        ("map", "'history_r'"),
        ("history", "'progression_speed'"),
        ("trade-off", "'period'"),
        ("bifurcation", "'velocities'"),
    ] {
        let begin = "line 11: figures[1].of[1]: unknown output for this kind of figure";
        assert_said(&shown(kind, of), &[begin]);
    }
    assert!(said(&shown("map", "'progresion_speed'"))[0].contains("did you mean \"progression_sp"));
    assert_said(
        &shown("map", "'period', 'outcome'"),
        &["line 11: figures[1].of: expected one output for this kind of figure, found 2"],
    );
    assert_said(&shown("basin", "'section_r'"), &["line 11: figures[1].of: does not go"]);
    for (kind, of) in [("phase-portrait", "'history_r'"), ("section", "'section_y2'")] {
        let one = "line 11: figures[1].of: expected the coordinates of both axes, found one";
        assert_said(&shown(kind, of), &[one]);
    }
    let dropped = "outputs = ['progression_speed']\n".to_owned() + &shown("map", "'work_net'");
    assert_said(&dropped, &["line 12: figures[1].of[1]: unknown output"]);
}

#[test]
fn sizes_that_no_machine_holds_are_refused() {
    let axes = "[[axes]]\nname = \"start_r\"\nfrom = \"0 m\"\nto = \"1 m\"\npoints = 9000000\n";
    let more = axes.replace("start_r", "start_y1").replace(" m\"", " m/s\"");
    let found = said(&(FIG5.to_owned() + axes + &more));
    assert!(found.len() == 1 && found[0].starts_with("axes: 81000000000000 cases"), "{found:?}");
    let protocol = "[protocol]\npoints = 1000000000000\nmax_period = 1000000000000\n";
    assert_said(
        &(FIG5.to_owned() + protocol),
        &["line 7: protocol.points: expected", "line 8: protocol.max_period: expected"],
    );
    let title = "title = \"a\\u0000b\"\n".to_owned() + FIG5;
    assert_said(&title, &["line 1: title: must be one line without control characters"]);
}

fn chains(study: &Study) -> Vec<Vec<usize>> {
    (0..study.chains()).map(|number| study.chain(number).collect()).collect()
}
