//! Outputs that a study defines over others: in files, fronts, figures, branches and tables of attractors as any other output.

use std::fs;

use capsulemap::campaign::read_study;
use capsulemap::model::{Sensitivity, Setting};
use capsulemap::store::{self, Dataset};
use capsulemap::study::Study;
use serde_json::Value;

use super::program::{CASES_AND_BRANCH, FIG5, WorkDir};

/// Cases that rest and that move both ways, with outputs of their own: the first is `energy_per_metre` by another formula, the last
/// has no finite value.
const STUDY: &str = r#"
[parameters]
c = "0.44 N s/m"
mu_s = 0.437
mu_d = 0.2185
k2 = "86.8 kN/m"
delta = "2.45 mm"
[[axes]]
name = "p_d"
values = ["0.2 N", "3 N"]
[[axes]]
name = "omega"
from = "30 rad/s"
to = "130 rad/s"
points = 7
[start]
inherit = "omega"
directions = ["upward", "downward"]
[protocol]
exponent_cycles = 0
max_cycles = 500
[outputs.own]
metres = "work_positive*omega/(2*pi)/abs(progression_speed)"
speed_per_power = "progression_speed/power"
heat = { value = "friction_loss + damper_loss", unit = "mJ", meaning = "work turned into heat" }
heat_share = "heat/(work_positive + 0)"
amplitude = "p_d/(m1 + m2)"
nowhere = "power/(power - power)"
"#;

/// What an output is of a case by the columns of a file.
type OfCase = fn(&Columns<'_>, usize) -> f64;

/// What the own outputs of that study are.
const OF_COLUMNS: [(&str, OfCase); 6] = [
    ("metres", |of, case| {
        of.at("work_positive", case) * of.at("omega", case)
            / (2.0 * std::f64::consts::PI)
            / of.at("progression_speed", case).abs()
    }),
    ("speed_per_power", |of, case| of.at("progression_speed", case) / of.at("power", case)),
    ("heat", |of, case| (of.at("friction_loss", case) + of.at("damper_loss", case)) * (1.0 / 1e-3)),
    ("heat_share", |of, case| of.at("heat", case) / (of.at("work_positive", case) + 0.0) * 1e-3),
    ("amplitude", |of, case| of.at("p_d", case) / (of.at("m1", case) + of.at("m2", case))),
    ("nowhere", |of, case| of.at("power", case) / (of.at("power", case) - of.at("power", case))),
];

/// The numbers of a file, those of axes and constants for every case.
struct Columns<'d>(&'d Dataset);

impl Columns<'_> {
    fn cases(&self) -> usize {
        self.0.variable("outcome").expect("outcomes").values.to_real().len()
    }

    fn at(&self, name: &str, case: usize) -> f64 {
        let shape = self.0.variable("outcome").expect("outcomes").values.shape().to_vec();
        let dimensions = &self.0.variable("outcome").expect("outcomes").dimensions;
        if let Some(along) = dimensions.iter().position(|it| it == name) {
            let behind: usize = shape[along + 1..].iter().product();
            let values = self.0.coordinate(name).expect(name).values.to_real();
            return values.iter().copied().nth(case / behind % shape[along]).expect("a value");
        }
        let values = self.0.variable(name).expect(name).values.to_real();
        let place = if values.len() == 1 { 0 } else { case };
        values.iter().copied().nth(place).expect("a value")
    }
}

fn swept(study: &str) -> WorkDir {
    let dir = WorkDir::new();
    dir.put("study.toml", study);
    dir.run(&["sweep", "study.toml"]).done();
    dir
}

const FILE: &str = "results/study/study.h5";

#[test]
fn own_outputs_are_what_their_expressions_say_of_the_columns() {
    let dir = swept(STUDY);
    let dataset = store::read(&dir.path(FILE)).expect("a file of results");
    let columns = Columns(&dataset);
    let (mut finite, mut others) = (0, 0);
    for (name, of) in OF_COLUMNS {
        for case in 0..columns.cases() {
            let (found, expected) = (columns.at(name, case), of(&columns, case));
            let same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
            assert!(same, "{name} of {case}: {found} {expected}");
            *if found.is_finite() { &mut finite } else { &mut others } += 1;
        }
    }
    assert!(finite > 80 && others > 28, "{finite} {others}");
    let labels = |name: &str| {
        let variable = dataset.variable(name).expect(name);
        [variable.unit.clone(), variable.long_name.clone()]
    };
    assert_eq!(labels("speed_per_power"), ["m/J", "progression_speed/power"]);
    assert_eq!(labels("heat"), ["mJ", "work turned into heat"]);
    dir.run(&["verify", FILE]).done();
    // The same bits in one lane and one thread as in all.
    let other = WorkDir::new();
    other.put("study.toml", STUDY);
    other.run(&["sweep", "study.toml", "--threads", "1"]).done();
    let alone = store::read(&other.path(FILE)).expect("a file of results");
    for (name, _) in OF_COLUMNS {
        let bits = |of: &Dataset| {
            let values = of.variable(name).expect(name).values.to_real();
            values.iter().map(|it| it.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(bits(&alone), bits(&dataset), "{name}");
    }
    commands_take_them(&dir);
}

/// Commands that name outputs take own ones.
fn commands_take_them(dir: &WorkDir) {
    let front = |arguments: &[&str]| {
        let ran = dir.run(&[&["tradeoff", FILE, "--json"], arguments].concat()).json();
        let cases: Vec<Value> = ran["front"]
            .as_array()
            .expect("a front")
            .iter()
            .map(|point| point["case"].clone())
            .collect();
        assert!(!cases.is_empty());
        cases
    };
    let known = ["--where", "outcome != undecided", "--direction", "backward", "--of"];
    let by = |cost: &'static str| front(&[&known[..], &[cost]].concat());
    assert_eq!(by("metres"), by("energy_per_metre"));
    let limited =
        front(&["--of", "power", "--where", "heat_share < 0.9 and speed_per_power > 0 m/J"]);
    assert!(!limited.is_empty());
    let csv = dir.run(&["tradeoff", FILE, "--of", "heat", "--csv"]).done().out;
    assert!(csv.lines().next().expect("a line").contains("heat"), "{csv}");
    let drawn = dir.run(&[
        "figure",
        FILE,
        "--kind",
        "bifurcation",
        "--of",
        "speed_per_power",
        "--formats",
        "svg",
    ]);
    assert!(drawn.done().err.contains(".svg"));
    let told = dir.run(&["simulate", "--study", FILE, "--case", "20"]).done().out;
    assert!(told.contains("speed_per_power"), "{told}");
    dir.run(&["report", FILE]).done();
}

#[test]
fn derivatives_of_own_outputs_are_those_of_the_same_outputs_of_the_model() {
    let study = "[parameters]\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\np_d = \"4 N\"\nomega = \"26 rad/s\"\n\
         [outputs.own]\npowered = \"work_positive*omega/(2*pi)\"\n\
         metres = \"powered/sqrt(progression_speed^2)\"\n";
    let study = Study::parse("study.toml", study).expect("no fault");
    let (model, case) = (study.model(), study.case(0));
    let orbit = model.settle(&case, &study.protocol, None);
    let of = |name: &str| study.base.model().output(name).expect(name);
    for (own, known) in [("powered", "power"), ("metres", "energy_per_metre")] {
        let (own, known) = (of(own), of(known));
        assert!(own.is_smooth());
        for parameter in ["omega", "delta", "p_d"] {
            let parameter = study.base.model().parameter(parameter).expect(parameter);
            let found = model.sensitivity(
                &Setting::of(&case),
                &orbit.section[0],
                orbit.period,
                study.protocol.tolerance,
                parameter,
            );
            let Sensitivity { outputs, slopes, .. } = found.expect("it is smooth");
            for values in [outputs, slopes] {
                let (found, expected) = (values[own], values[known]);
                assert!((found - expected).abs() < 1e-11 * expected.abs(), "{found} {expected}");
                assert!(expected != 0.0);
            }
        }
    }
}

#[test]
fn branches_and_attractors_have_own_outputs() {
    let study = format!(
        "{CASES_AND_BRANCH}[outputs]\nkeep = [\"progression_speed\", \"per_cycle\"]\n\
         [outputs.own]\nper_cycle = \"2*pi*progression_speed/omega\"\n"
    )
    .replace("points = 40", "points = 3");
    let dir = WorkDir::new();
    dir.put("study.toml", study);
    dir.run(&["sweep", "study.toml"]).done();
    dir.run(&["continue", "study.toml"]).done();
    let file = dir.files().into_iter().find(|it| it.ends_with(".h5") && it.contains("branch"));
    let file = file.unwrap_or_else(|| FILE.to_owned());
    let dataset = store::read(&dir.path(&file)).expect("a file of branches");
    let column = |name: &str| -> Vec<f64> {
        dataset.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    let [speeds, own, omega] =
        ["branch_progression_speed", "branch_per_cycle", "branch_omega"].map(column);
    assert!(speeds.len() > 20);
    for ((speed, own), omega) in speeds.iter().zip(own).zip(omega) {
        assert_eq!(own, 2.0 * std::f64::consts::PI * speed / omega);
    }
    // Starts that lead to several motions, whose outputs the table of attractors has.
    let study = format!(
        "{FIG5}[[axes]]\nname = \"start_y1\"\nfrom = \"-1 m/s\"\nto = \"1 m/s\"\npoints = 5\n\
         [[axes]]\nname = \"start_r\"\nfrom = \"-5 mm\"\nto = \"5 mm\"\npoints = 5\n\
         [outputs.own]\nspeed_per_power = \"progression_speed/power\"\n"
    );
    let dir = swept(&study);
    let dataset = store::read(&dir.path(FILE)).expect("a file of results");
    let column = |name: &str| -> Vec<f64> {
        dataset.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    let of = ["attractor_progression_speed", "attractor_power", "attractor_speed_per_power"];
    let [speeds, power, own] = of.map(column);
    assert!(!own.is_empty());
    for ((speed, power), own) in speeds.iter().zip(power).zip(own) {
        assert_eq!(own, speed / power);
    }
}

#[test]
fn a_study_with_own_outputs_is_written_and_read_back() {
    let study = Study::parse("study.toml", STUDY).expect("no fault");
    let again = study.clone().validated("again").expect("no fault");
    assert_eq!(again.fingerprint(), study.fingerprint());
    assert!(again.text.contains("[outputs.own]\nmetres = "), "{}", again.text);
    let fewer = STUDY.replace(
        "[outputs.own]",
        "[outputs]\nkeep = [\"heat\", \"progression_speed\"]\n[outputs.own]",
    );
    let fewer = Study::parse("study.toml", &fewer).expect("no fault");
    assert_eq!(
        fewer.outputs.iter().map(|it| it.name()).collect::<Vec<_>>(),
        ["heat", "progression_speed"]
    );
    let again = fewer.clone().validated("again").expect("no fault");
    assert_eq!(again.fingerprint(), fewer.fingerprint());
    // Another definition is another study, and without own outputs a study is as it was.
    let other = STUDY.replace("progression_speed/power", "progression_speed/(2*power)");
    let other = Study::parse("study.toml", &other).expect("no fault");
    assert_ne!(other.fingerprint(), study.fingerprint());
    let [listed, table] = ["outputs = [\"power\"]\n", "[outputs]\nkeep = [\"power\"]\n"]
        .map(|it| Study::parse("study.toml", &format!("{it}{FIG5}")).expect("no fault"));
    assert_eq!(listed.fingerprint(), table.fingerprint());
}

#[test]
fn wrong_own_outputs_are_refused() {
    let dir = WorkDir::new();
    let refused = |lines: &str, parts: &[&str]| {
        dir.put("study.toml", format!("{FIG5}{lines}"));
        dir.run(&["sweep", "study.toml"]).refused(parts);
        assert_eq!(dir.files(), ["study.toml"]);
    };
    refused(
        "[outputs.own]\nit = \"delta + omega\"\nother = \"pwer\"\n",
        &[
            "2 faults",
            "line 7: outputs.own: column 15: m and 1/s cannot be added",
            "line 8",
            "did you mean \"power\"?",
        ],
    );
    refused(
        "[outputs.own]\ndraw = \"2*power\"\n",
        &["outputs.own: ", "two things called `draw`", "call the own output otherwise"],
    );
    refused("[outputs.own]\nshare = \"2*power\"\n", &["two things called `attractor_share`"]);
    refused(
        "[outputs]\nkeep = [\"sped\"]\n[outputs.own]\nspeed = \"progression_speed\"\n",
        &["unknown output \"sped\"", "did you mean \"speed\"?"],
    );
    refused("[outputs]\nkept = [\"power\"]\n", &["unknown key \"kept\"", "did you mean \"keep\"?"]);
    refused("[outputs]\nown = 3\n", &["own must be a table"]);
    // What has no value, as another parameter stands for it, or as it is not given.
    refused(
        "[outputs.own]\nit = \"work_net*omega + power*k3/k2*rad/m^2\"\n"
            .replace("*rad/m^2", "")
            .as_str(),
        &["outputs.own"],
    );
    let by_period = FIG5.replace("omega = \"77.91 rad/s\"", "drive_period = \"80 ms\"");
    dir.put("study.toml", format!("{by_period}[outputs.own]\nit = \"2*omega\"\n"));
    dir.run(&["check", "study.toml"])
        .refused(&["outputs.own.it: uses omega", "drive_period stands for it"]);
    dir.put("study.toml", format!("{FIG5}[outputs.own]\nit = \"2*drive_period\"\n"));
    dir.run(&["check", "study.toml"]).refused(&["uses drive_period", "it is not given"]);
    dir.put("study.toml", format!("{by_period}[outputs.own]\nit = \"2*drive_period\"\n"));
    dir.run(&["check", "study.toml"]).done();
}

#[test]
fn a_text_has_own_outputs_in_its_units() {
    let belt = fs::read_to_string("systems/belt.toml").expect("a text");
    let dir = WorkDir::new();
    dir.put("belt.toml", belt);
    dir.put("study.toml", "system = \"belt.toml\"\n[outputs.own]\nhalf = \"cycle_duration/2\"\n");
    dir.run(&["sweep", "study.toml"]).done();
    let dataset = store::read(&dir.path(FILE)).expect("a file of results");
    let [whole, half] = ["cycle_duration", "half"].map(|name| {
        dataset.variable(name).expect(name).values.to_real().into_iter().next().expect("a case")
    });
    assert!(whole > 0.0 && half == whole / 2.0);
    let study = read_study(&dir.path("study.toml")).expect("no fault");
    assert_eq!(
        study.clone().validated("again").expect("no fault").fingerprint(),
        study.fingerprint()
    );
    dir.run(&["verify", FILE]).done();
}

#[test]
fn the_study_of_the_document_is_one() {
    let document = include_str!("../../docs/own-outputs.md");
    let study = document.split("```toml\n").nth(1).and_then(|it| it.split("```").next());
    let study = Study::parse("study.toml", study.expect("a study")).expect("no fault");
    let own = study.base.model().own_outputs().map(|it| format!("{} [{}]", it.name(), it.unit()));
    assert_eq!(own.collect::<Vec<_>>(), ["speed_per_power [m/J]", "heat [mJ]", "heat_share [1]"]);
}
