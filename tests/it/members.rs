//! The family of capsules in studies and on the command line: what is told, what is refused, and that files hold what is computed again.

use capsulemap::capsule::{CapsuleParameters as _, Form, Output, Parameter};
use capsulemap::study::Study;

use super::program::{FIG5, WorkDir};

/// A member on a slope, over the incline and the duty.
const OVER_INCLINE_AND_DUTY: &str = r#"
[parameters]
k2 = "2.42 kN/m"
delta = "3.5 mm"
p_d = "6 N"
p_low = "-6 N"
drive_period = "80 ms"
drive = "square"
[[axes]]
name = "incline"
from = "-5 deg"
to = "5 deg"
points = 5
[[axes]]
name = "duty"
from = 0.3
to = 0.7
points = 5
[protocol]
max_cycles = 300
exponent_cycles = 64
points = 2
impact_points = 0
[[branches]]
name = "b"
along = "duty"
at = { incline = "0 deg", duty = 0.5 }
from = 0.45
to = 0.55
"#;

#[test]
fn cases_of_members_come_out_the_same_from_their_file() {
    let dir = WorkDir::new();
    dir.put("member.toml", OVER_INCLINE_AND_DUTY);
    let swept = dir.run(&["sweep", "member.toml", "--output", "m.h5", "--threads", "1"]).done();
    assert!(swept.out.contains("25 cases"), "{}", swept.out);
    let verified = dir.run(&["verify", "m.h5", "--cases", "25"]).done();
    assert!(verified.out.contains("came out the same"), "{}", verified.out);
    let continued = dir.run(&["continue", "member.toml", "--output", "m.h5"]).done();
    assert!(continued.out.contains("period 1"), "{}", continued.out);
    // A case alone is that of the file, on even ground, too, where its incline is zero.
    let study = Study::parse("member.toml", OVER_INCLINE_AND_DUTY).expect("a study");
    for case in [0, 12, 24] {
        let parameters = study.case(case).parameters;
        assert_eq!(parameters.form(), Form::General);
        let told = dir.run(&["simulate", "--study", "m.h5", "--case", &case.to_string(), "--json"]);
        assert_eq!(told.json()["parameters"]["drive"], "square");
    }
}

#[test]
fn only_members_tell_of_what_the_family_has() {
    let plain = Study::parse("fig5.toml", FIG5).expect("a study");
    let member = Study::parse("m.toml", &format!("{FIG5}incline = \"2 deg\"")).expect("a study");
    let optional = |study: &Study| study.outputs.iter().filter(|it| it.is_optional()).count();
    assert_eq!((optional(&plain), optional(&member)), (0, 6));
    assert_ne!(plain.fingerprint(), member.fingerprint());

    let dir = WorkDir::new();
    let plain = dir.run(&["simulate"]).done().out;
    assert!(!plain.contains("family") && !plain.contains("lifting_work"), "{plain}");
    let member = ["simulate", "--drive", "trapezoid", "--drive-reaction", "capsule"];
    let member =
        dir.run(&[&member[..], &["--set", "k3=20 kN/m", "--set", "c1=0.2"]].concat()).done().out;
    for part in [
        "member of the family: trapezoid drive, its reaction on the capsule, a rear stop, drag beside friction",
        "rear_impacts_per_cycle",
        Output::DragLoss.name(),
    ] {
        assert!(member.contains(part), "{part:?} is missing from:\n{member}");
    }
}

#[test]
fn a_study_of_a_member_is_read_as_it_is_written() {
    let study = Study::parse("member.toml", OVER_INCLINE_AND_DUTY).expect("a study");
    let again = study.clone().validated("again.toml").expect("it is the same study");
    assert_eq!(study.fingerprint(), again.fingerprint());
    assert_eq!(again.base[Parameter::Period], 0.08);
    assert!(!again.base.is_given(Parameter::Omega.into()));
}

#[test]
fn what_cannot_be_is_refused_with_the_reason() {
    let dir = WorkDir::new();
    let refused = |text: &str, parts: &[&str]| {
        dir.put("no.toml", format!("{FIG5}{text}"));
        dir.run(&["sweep", "no.toml", "--dry-run"]).refused(parts);
    };
    refused(
        "drive = \"trapezoid\"\nduty = 0.2\nrise = 0.3\n",
        &["no.toml", "rise", "no longer than the pulse"],
    );
    refused(
        "drive = \"trapezoid\"\nrise = 0.3\n[[axes]]\nname = \"duty\"\nfrom = 0.2\nto = 0.6\npoints = 5\n",
        &["rise", "no longer than the pulse"],
    );
    refused(
        "drive = \"square\"\nduty = 0.25\n[start]\nsection_phase = \"90 deg\"\n",
        &["lies on the edge of the drive at 0.25 of its period"],
    );
    refused("drive = \"square\"\nfriction_switching = \"as-printed\"\n", &["as-printed", "family"]);
    refused("drive = \"sqare\"\n", &["drive", "square", "trapezoid"]);
    refused("duty = 1.0\ndrive = \"square\"\n", &["duty", "above 0 and below 1"]);
    dir.run(&["simulate", "--drive", "trapezoid", "--set", "rise=0.6"]).refused(&["rise = 0.6"]);
    refused("restitution = 0.5\n", &["`restitution` stands in place of `k2`"]);
    refused("drive_period = \"80 ms\"\n", &["`drive_period` stands in place of `omega`"]);
    refused(
        "drive = \"three-phase\"\nshare_1 = 0.25\n[start]\nsection_phase = \"90 deg\"\n",
        &["share_1", "lies on the edge of the drive at 0.25 of its period"],
    );
    refused("restitution = 1.5\n", &["restitution", "from 0 to 1"]);
    dir.run(&["simulate", "--k2", "3 kN/m", "--set", "restitution=0.5"])
        .refused(&["restitution stands in place of k2"]);
    refused(
        "drive = \"three-phase\"\nshare_1 = 0.6\nshare_2 = 0.5\n",
        &["share_1", "below 1", "third phase"],
    );
    let two_phase = ["simulate", "--drive", "two-phase", "--section-phase"];
    dir.run(&[&two_phase[..], &["0"]].concat()).refused(&["the velocities jump there"]);
    dir.run(&[&two_phase[..], &["90 deg"]].concat()).done();
    // What an axis replaces is no case: the duty of 0.5 that the drive has otherwise.
    let halfway =
        "drive = \"square\"\n[start]\nsection_phase = \"180 deg\"\n[[axes]]\nname = \"duty\"\n";
    let values = "values = [0.1, 0.3, 0.4]\n";
    dir.put("yes.toml", format!("{FIG5}{halfway}{values}"));
    let checked = dir.run(&["check", "yes.toml"]).done().out;
    assert!(checked.contains("member      square drive"), "{checked}");
    refused(
        &format!("{halfway}values = [0.1, 0.5]\n"),
        &["axes.duty", "the edge of the drive at 0.5"],
    );
}

/// Where the motion of the mass is prescribed, and where its stop is rigid, a study need not say what has no effect.
#[test]
fn what_has_no_effect_is_not_asked_for() {
    let dir = WorkDir::new();
    let text = r#"
[parameters]
drive = "prescribed"
xi_1 = "5 mm"
mu_d_backward = 0.5
omega = "30 rad/s"
[[axes]]
name = "xi_1"
from = "5 mm"
to = "9 mm"
points = 3
"#;
    dir.put("both.toml", text);
    dir.run(&["sweep", "both.toml", "--dry-run"]).refused(&["xi_1", "here and on an axis"]);
    dir.put("p.toml", text.replacen("xi_1 = \"5 mm\"\n", "", 1));
    dir.run(&["sweep", "p.toml", "--output", "p.h5", "--no-figures"]).done();
    let verified = dir.run(&["verify", "p.h5", "--cases", "3"]).done();
    assert!(verified.out.contains("came out the same"), "{}", verified.out);
    let rigid =
        "[parameters]\nrestitution = 0.4\nomega = \"60 rad/s\"\np_d = \"5 N\"\ndelta = \"1 mm\"\n";
    dir.put("r.toml", rigid);
    dir.run(&["sweep", "r.toml", "--output", "r.h5"]).done();
    let told = dir.run(&["simulate", "--study", "r.h5", "--case", "0", "--json"]).json();
    assert_eq!(told["parameters"]["restitution"], 0.4);
    assert!(told["parameters"].get("k2").is_none(), "{told}");
}

#[test]
fn what_has_no_effect_or_runs_away_is_told_before_it_is_computed() {
    let dir = WorkDir::new();
    let told = |text: &str, parts: &[&str]| {
        dir.put("note.toml", format!("{FIG5}{text}"));
        let ran = dir.run(&["sweep", "note.toml", "--dry-run"]).done();
        let checked = dir.run(&["check", "note.toml"]).done();
        for part in parts {
            assert!(ran.err.contains(part), "{part:?} is missing from:\n{}", ran.err);
            assert!(checked.out.contains(part), "{part:?} is missing from:\n{}", checked.out);
        }
    };
    told(
        "[[axes]]\nname = \"duty\"\nfrom = 0.2\nto = 0.6\npoints = 5\n",
        &["duty has no effect with the drive `harmonic`", "all its values give the same motion"],
    );
    told(
        "drive = \"square\"\nduty = 0.9\n",
        &[
            "the mean force along the ground, 3.6000 N, exceeds the friction of fast sliding, 2.0719 N",
            "not the force at which rest ends, 4.1437 N",
        ],
    );
    told("release = \"force\"\n", &["release = \"force\" has no effect"]);
    told(
        "drive = \"square\"\nrise = 0.1\np_2 = \"1 N\"\nxi_1 = \"5 mm\"\n",
        &[
            "rise has no effect with the drive `square`: it belongs to `trapezoid`",
            "p_2 has no effect with the drive `square`: it belongs to `two-harmonics`",
            "xi_1 has no effect with the drive `square`: it belongs to `prescribed`",
        ],
    );
    told(
        "resistance = \"coulomb\"\nv_s = \"0.1 m/s\"\nstribeck = 0.5\n",
        &["v_s, stribeck have no effect under the law `coulomb`"],
    );
    told("delta_3 = \"4 mm\"\n", &["delta_3 has no effect without `k3` or `k3_damping`"]);
    dir.put(
        "rigid.toml",
        format!("{FIG5}restitution = 0.5\nk2_damping = \"1 N s/m\"\n")
            .replace("k2 = \"2.42 kN/m\"\n", ""),
    );
    let rigid = dir.run(&["check", "rigid.toml"]).done().out;
    assert!(rigid.contains("k2_damping has no effect beside `restitution`"), "{rigid}");
    told(
        "drive = \"three-phase\"\ndrive_reaction = \"capsule\"\n",
        &[
            "drive_reaction = \"capsule\" has no effect",
            "k2, delta have no effect with the drive `three-phase`",
        ],
    );
    told(
        "[draws]\ncount = 4\n[[axes]]\nname = \"duty\"\nfrom = 0.2\nto = 0.4\n",
        &["duty has no effect with the drive `harmonic`"],
    );
    told("incline = \"-60 deg\"\n", &["and what holds the capsule at rest", "`runaway`"]);
    // Near rest friction holds the first, which creeps on; nothing holds the second.
    let pulses = ["simulate", "--drive", "square", "--set", "duty=0.9"];
    assert!(dir.run(&pulses).done().out.contains("outcome: periodic (1)"));
    let ran = dir.run(&["simulate", "--set", "incline=-60 deg"]).done().out;
    assert!(ran.contains("nothing holds the mean force"), "{ran}");
}

/// `simulate` says of its options what a study says of its keys.
#[test]
fn what_has_no_effect_is_told_of_options() {
    let dir = WorkDir::new();
    let told =
        |options: &[&str]| dir.run(&[&["simulate", "--cycles", "1"], options].concat()).done().err;
    let duty = told(&["--set", "duty=0.3"]);
    assert!(duty.contains("note: duty has no effect with the drive `harmonic`"), "{duty}");
    assert_eq!(told(&["--set", "duty=0.3", "--drive", "square"]), "");
    let chosen = ["simulate", "--set", "drive_reaction=capsule"];
    dir.run(&chosen).refused(&["--set drive_reaction", "write --drive-reaction capsule"]);
    // Where both directions have their coefficient, neither follows from that at rest.
    let [forward, backward] = ["mu_d_forward=0.2", "mu_d_backward=0.5"];
    let law = ["--resistance", "coulomb", "--set", "mu_s=0.4", "--set", forward];
    assert!(told(&law).contains("so mu_d = mu_s = 0.4"));
    assert_eq!(told(&[&law[..], &["--set", backward]].concat()), "");
    let both = ["--set", forward, "--set", backward, "--set", "mu_d=0.3"];
    let idle = "note: mu_d has no effect beside `mu_d_forward` and `mu_d_backward`";
    assert!(told(&both).contains(idle), "{}", told(&both));
}

/// Both stops are drawn in histories, phase portraits and basins: a dashed line for each.
#[test]
fn both_stops_are_drawn() {
    let dir = WorkDir::new();
    let figures = r#"
k3 = "20 kN/m"
delta_3 = "4 mm"
[[axes]]
name = "start_r"
from = "-5 mm"
to = "5 mm"
points = 4
[[axes]]
name = "start_y1"
from = "-1 m/s"
to = "1 m/s"
points = 4
[history]
cycles = 2
[[figures]]
name = "history"
kind = "history"
of = ["history_r"]
at = { start_r = "5 mm", start_y1 = "1 m/s" }
[[figures]]
name = "portrait"
kind = "phase-portrait"
at = { start_r = "5 mm", start_y1 = "1 m/s" }
[[figures]]
name = "basin"
kind = "basin"
"#;
    dir.put("stops.toml", format!("{FIG5}{figures}"));
    dir.run(&["sweep", "stops.toml", "--formats", "svg"]).done();
    // The legend of histories and basins has one more.
    for (figure, lines) in [("history", 3), ("portrait", 2), ("basin", 3)] {
        let svg = std::fs::read_to_string(dir.path(&format!("results/stops/{figure}.svg")));
        let dashed = svg.expect("a figure").matches("stroke-dasharray").count();
        assert_eq!(dashed, lines, "{figure}");
    }
}
