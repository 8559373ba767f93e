//! What surrounds the continuation of branches: the study's keys, the columns of the file, and the command.

use std::fs;
use std::path::Path;
use std::process::Command;

use capsulemap::branch::SpecialKind;
use capsulemap::capsule::{CapsuleState as _, Parameter};
use capsulemap::run::continue_branches;
use capsulemap::store::{self, Dataset, Values};
use capsulemap::study::{FirstOrbit, Study};

use super::program::{FIG5, WorkDir};

pub mod fixtures;

use fixtures::{STUDY, branches_alone, continued, found, study};

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

/// Fig 5 with frequencies on an axis and a branch written as `lines`, from line 9 on.
fn branch(lines: &str) -> String {
    let fig5 = FIG5.replace("omega = \"77.91 rad/s\"\n", "");
    let axis = "[[axes]]\nname = \"omega\"\nvalues = [\"70 rad/s\", \"50 rad/s\"]\n";
    format!("{fig5}{axis}[[branches]]\n{lines}")
}

const PLAIN: &str = "name = \"a\"\nalong = \"omega\"\nat = { omega = \"60 rad/s\" }\n";

#[test]
fn a_branch_has_the_rest_of_its_study() {
    let plain = Study::parse("a", &branch(PLAIN)).expect("a study").branches.remove(0);
    assert_eq!((plain.range, plain.first), ([50.0, 70.0], FirstOrbit::Settle));
    assert_eq!((plain.longest_step, plain.most_points, plain.doublings), (0.02, 2000, 0));
    assert_eq!((plain.parameters[Parameter::Omega], plain.parameters[Parameter::Pd]), (60.0, 4.0));
    assert_eq!((plain.second, plain.start.capsule().r, plain.section_phase), (None, 0.0, 0.0));
    let more = "from = \"65 rad/s\"\nto = \"40 rad/s\"\norbit = \"newton\"\nperiod = 3\n\
                start = { r = \"1 mm\", phase = \"90 deg\" }\nlongest_step = 0.5\nmost_points = 9\n\
                second = { name = \"p_d\", from = \"1 N\", to = \"5 N\" }\n";
    let start = "[start]\nr = \"3 mm\"\ny1 = \"0.2 m/s\"\n";
    let text = branch(&format!("{PLAIN}{more}{start}"));
    let full = Study::parse("a", &text).expect("a study").branches.remove(0);
    assert_eq!((full.range, full.first), ([40.0, 65.0], FirstOrbit::Newton { period: 3 }));
    let start = full.start.capsule();
    assert_eq!((start.r, start.y1), (1e-3, 0.2));
    assert!((full.section_phase - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert_eq!(full.start_phase, full.section_phase, "`phase` is both");
    assert_eq!(full.second, Some((Parameter::Pd.into(), [1.0, 5.0])));
    assert_eq!((full.longest_step, full.most_points), (0.5, 9));
    let alone = format!(
        "{FIG5}[[branches]]\nname = \"a\"\nalong = \"p_d\"\n\
                         from = \"1 N\"\nto = \"6 N\"\n"
    );
    let alone = Study::parse("a", &alone).expect("a study");
    assert_eq!((alone.axes().len(), alone.branches[0].parameters[Parameter::Omega]), (0, 77.91));
}

#[test]
fn the_faults_of_branches_are_reported_at_once() {
    assert_said(
        &branch("along = \"omga\"\nform = \"3\"\nat = { p_d = \"4 N\", omega = \"60 N\" }\n"),
        &[
            "line 8: branches[1].name: missing",
            "line 9: branches[1].along: unknown parameter \"omga\"; did you mean \"omega\"?",
            "line 10: branches[1].form: unknown key \"form\"; did you mean \"from\"?",
            "line 11: branches[1].at.omega: \"60 N\" is a force; expected a frequency",
            "line 11: branches[1].at.p_d: unknown parameter that varies \"p_d\"",
        ],
    );
    let wrong = "name = \"a\"\nalong = \"omega\"\nfrom = \"0 rad/s\"\norbit = \"newtn\"\nperiod = 0\n\
                 doublings = -1\nlongest_step = 2\nmost_points = 1\nstart = { x = 3 }\n\
                 second = { name = \"omega\", from = \"1 rad/s\" }\n";
    assert_said(
        &branch(wrong),
        &[
            "line 8: branches[1].at.omega: missing; expected the frequency of the drive of the",
            "line 11: branches[1].from: 0 rad/s must be a finite number above zero",
            "line 12: branches[1].orbit: unknown method to find the orbit \"newtn\"; did you mean \"newt",
            "line 13: branches[1].period: expected a whole number, 1 to",
            "line 14: branches[1].doublings: expected a whole number, 0 to 20",
            "line 15: branches[1].longest_step: 2 must lie between 1e-9 and 1",
            "line 16: branches[1].most_points: expected a whole number, 2 to",
            "line 17: branches[1].start.x: unknown key \"x\"",
            "line 18: branches[1].second.name: is the parameter that the orbit is continued in",
        ],
    );
    let twice = branch(&format!("{PLAIN}[[branches]]\n{PLAIN}"));
    assert_said(&twice, &["line 13: branches[2].name: a second branch \"a\""]);
    let outside = PLAIN.replace("60 rad", "80 rad");
    assert_said(
        &branch(&outside),
        &[
            "line 11: branches[1].at.omega: the first orbit, at omega = 80 rad/s, lies outside 50 to",
        ],
    );
    let no_axis = PLAIN.replace("\"omega\"", "\"p_d\"");
    let missing = "line 8: branches[1].from: missing; expected a value, as no axis varies the ampl";
    assert_said(&branch(&no_axis), &[missing, "line 8: branches[1].to: missing"]);
    let period = branch(&format!("{PLAIN}period = 2\n"));
    assert_said(&period, &["line 12: branches[1].period: goes with `orbit = \"newton\"`"]);
    let newton = branch(&format!("{PLAIN}orbit = \"newton\"\n"));
    assert_said(&newton, &["line 8: branches[1].period: missing"]);
    let printed =
        branch(PLAIN).replace("[[axes]]", "friction_switching = \"as-printed\"\n[[axes]]");
    assert!(Study::parse("a", &printed).is_ok(), "the equation as printed is continued too");
    let name = branch(&PLAIN.replace("\"a\"", "\" \""));
    assert_said(&name, &["line 9: branches[1].name: must be one line, not empty"]);
}

#[test]
fn figures_run_along_the_parameters_of_branches() {
    let figure = |kind: &str, more: &str| {
        format!("{STUDY}[[figures]]\nname = \"x\"\nkind = \"{kind}\"\n{more}\n")
    };
    let drawings = |text: &str| Study::parse("a", text).expect("a study").drawings;
    assert!(drawings(&figure("curves", "x = \"p_d\"\ny = \"omega\""))[3].branches);
    assert!(!drawings(&figure("bifurcation", "branches = false"))[3].branches);
    assert!(said(&figure("curves", "of = [\"work_net\"]"))[0].contains("does not go with"));
    assert!(said(&figure("bifurcation", "branches = 3"))[0].contains("expected true or false"));
    let alone = format!(
        "{FIG5}[[branches]]\nname = \"a\"\nalong = \"p_d\"\nfrom = \"1 N\"\n\
                         to = \"6 N\"\n[[figures]]\nname = \"x\"\nx = \"p_d\"\nkind = "
    );
    assert_eq!(drawings(&format!("{alone}\"bifurcation\""))[0].x.as_deref(), Some("p_d"));
    assert!(said(&format!("{alone}\"map\""))[0].contains("unknown axis of this study \"p_d\""));
}

fn reals(dataset: &Dataset, name: &str) -> Vec<f64> {
    dataset.variable(name).expect(name).values.to_real().into_iter().collect()
}

#[test]
fn every_number_of_every_branch_is_in_the_file() {
    let dataset = branches_alone();
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path().join("a.h5");
    store::write(&dataset, &path).expect("it is written");
    let back = store::read(&path).expect("it is read");
    assert_eq!(store::difference(&dataset, &back), None);
    let (first, lengths) = (found(), [121, 40, 30]);
    let branch = reals(&back, "branch");
    let counts = [0.0, 1.0, 2.0].map(|n| branch.iter().filter(|&&it| it == n).count());
    assert_eq!(counts, lengths);
    let omega = reals(&back, "branch_omega");
    for (value, point) in omega.iter().zip(first.branches.iter().flat_map(|it| &it.points)) {
        assert_eq!(value.to_bits(), point.parameter.to_bits());
    }
    assert!(omega[161..].iter().all(|value| value.is_nan()));
    assert!((reals(&back, "branch_p_d")[161] - 1.0).abs() < 1e-15);
    assert!(reals(&back, "branch_p_d")[..161].iter().all(|value| value.is_nan()));
    let stable = reals(&back, "branch_stable").iter().sum::<f64>();
    let expected = first.branches.iter().flat_map(|it| &it.points);
    let expected = expected.filter(|it| it.multipliers[0].re.abs() < 1.0).count() + 30;
    assert_eq!(stable, expected as f64);
    let r = back.variable("branch_section_r").expect("sections").values.to_real();
    assert_eq!(r.shape(), [191, 2]);
    assert!(r[[0, 1]].is_nan() && r[[121, 1]] == first.branches[1].points[0].section[1][0]);
    let speeds = reals(&back, "branch_progression_speed");
    assert!(speeds.iter().all(|speed| speed.is_finite()));
    assert!(back.variable("branch_damper_loss").is_none(), "an output that is not asked for");
    assert_eq!(reals(&back, "branch_multiplier_real")[..3], [0.8, 0.1, 0.0]);
    let kinds = reals(&back, "special_kind");
    for (code, special) in kinds.iter().zip(&first.branches[0].special) {
        assert_eq!(*code, f64::from(special.kind as u8));
    }
    assert_eq!((kinds.len(), reals(&back, "curve").len()), (6, 6 * 41));
    assert_eq!(reals(&back, "special_curve"), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    let named = |name: &str| -> Vec<String> {
        let variable = back.variable(name).expect(name);
        let codes = variable.values.to_real();
        let flag = |code: &f64| variable.flags.iter().find(|(it, _)| *it as f64 == *code);
        codes.iter().map(|code| flag(code).map_or(String::new(), |it| it.1.clone())).collect()
    };
    assert_eq!(named("index_end_first"), ["edge-of-range", "half-period", "edge-of-range"]);
    assert_eq!(named("index_end_last"), ["edge-of-range", "most-points", "edge-of-range"]);
    assert_eq!(named("curve_end_last"), ["corner"; 6]);
    assert_eq!(reals(&back, "index_parent"), [-1.0, 0.0, -1.0]);
    let doubling = reals(&back, "index_parent_special")[1] as usize;
    assert_eq!(kinds[doubling], f64::from(SpecialKind::PeriodDoubling as u8));
    assert_eq!(reals(&back, "index_request"), [0.0, 0.0, 1.0]);
    let results = back.variable("request_result").expect("results");
    let Values::Integer(codes) = &results.values else { panic!("codes") };
    let name = |code: i64| results.flags.iter().find(|(it, _)| *it == code).map(|it| &it.1[..]);
    assert_eq!(name(codes[[2]]), Some("no-orbit"));
    assert_eq!(back.texts["branch_names"], "moving on\nin amplitude\nlost");
    assert_eq!(reals(&back, "request_p_d"), [4.0, 3.0, 4.0]);
}

#[test]
fn branches_are_kept_beside_the_cases_of_a_sweep() {
    let study = study();
    let mut both = store::dataset(&study, &[]);
    let swept = both.clone();
    assert!(store::has_cases(&both) && !store::has_branches(&both));
    store::keep_branches(&mut both, &branches_alone());
    let mut added = swept;
    store::add_branches(&mut added, &study, &study.branches, &continued());
    added.attributes.clone_from(&both.attributes);
    assert_eq!(store::difference(&both, &added), None);
    assert!(store::has_branches(&both) && !store::has_cases(&branches_alone()));
    let place = tempfile::tempdir().expect("a folder");
    store::write(&both, &place.path().join("a.h5")).expect("it is written");
}

#[test]
fn a_python_reader_finds_branches() {
    let Ok(python) = std::env::var("CAPSULEMAP_PYTHON") else {
        println!("SKIPPED: branches in Python (CAPSULEMAP_PYTHON names no Python with xarray)");
        return;
    };
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path().join("a.h5");
    store::write(&branches_alone(), &path).expect("it is written");
    let script = "import sys, xarray\n\
                  data = xarray.open_dataset(sys.argv[1], engine='h5netcdf')\n\
                  own = data.where(data.branch == 1, drop=True)\n\
                  assert own.sizes['branch_point'] == 40, own.sizes\n\
                  assert data.branch_omega.attrs['units'] == 'rad/s'\n\
                  assert data.branch_section_r.dims == ('branch_point', 'branch_cycle')\n\
                  assert 'fold' in data.special_kind.attrs['flag_meanings'].split()\n\
                  assert data.branch_names.item().split('\\n')[0] == 'moving on'\n";
    let done = Command::new(python).args(["-c", script]).arg(&path).output().expect("it runs");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn any_number_of_threads_gives_the_same_branches() {
    let study = study();
    let one = continue_branches(&study, Some(1), || ()).expect("a run");
    // As they are shown, with all digits: outputs that are not computed on branches are no numbers, which equal none.
    for threads in [Some(2), Some(5), None] {
        let other = continue_branches(&study, threads, || ()).expect("a run");
        assert!(format!("{one:?}") == format!("{other:?}"), "{threads:?}");
    }
    assert_eq!(one.len(), 3);
}

fn kept(path: &Path) -> Dataset {
    store::read(path).expect("a result")
}

#[test]
fn branches_and_cases_share_a_file_in_either_order() {
    let dir = WorkDir::new();
    dir.put("s.toml", STUDY);
    let ran = dir.run(&["continue", "s.toml", "--formats", "svg"]).done();
    let path = "results/s/s.h5";
    assert!(ran.out.starts_with(&format!("{path}: ")), "{}", ran.out);
    assert!(ran.err.contains("figure `m`: waits for `capsulemap sweep`"), "{}", ran.err);
    let alone = kept(&dir.path(path));
    assert!(store::has_branches(&alone) && !store::has_cases(&alone));
    let again = dir.run(&["continue", "s.toml", "--formats", "svg"]).done();
    assert!(
        again.err.contains("s.h5: branches and ramps are there already") && again.out.is_empty(),
        "{}",
        again.err
    );
    let ran = dir.run(&["sweep", "s.toml", "--formats", "svg"]).done();
    assert!(ran.out.contains("16 cases") && ran.err.contains("m.svg"), "{}", ran.err);
    let mut both = kept(&dir.path(path));
    assert!(store::has_branches(&both) && store::has_cases(&both));
    let again = dir.run(&["sweep", "s.toml", "--no-figures"]).done();
    assert!(again.err.contains("already computed"), "{}", again.err);
    // In the other order, the same is in the file.
    let ran = dir.run(&["sweep", "s.toml", "--output", "o.h5", "--formats", "svg"]).done();
    assert!(ran.err.contains("figure `c`: waits for `capsulemap continue`"), "{}", ran.err);
    dir.run(&["continue", "s.toml", "--output", "o.h5", "--no-figures"]).done();
    let mut other = kept(&dir.path("o.h5"));
    for dataset in [&mut both, &mut other] {
        dataset.attributes.remove("created").expect("a time");
    }
    assert_eq!(store::difference(&both, &other), None);
    dir.run(&["figure", "o.h5", "--formats", "svg", "--folder", "again"]).done();
    assert!(dir.path("again/c.svg").is_file());
}

#[test]
fn a_figure_along_the_parameter_of_a_branch_waits_for_it() {
    let dir = WorkDir::new();
    let (before, _) = STUDY.split_once("[[branches]]").expect("branches");
    let along =
        "[[branches]]\nname = \"k\"\nalong = \"k2\"\nfrom = \"18 kN/m\"\nto = \"20 kN/m\"\n";
    let at = "at = { omega = \"155 rad/s\", p_d = \"4 N\" }\n";
    let figure = "[[figures]]\nname = \"f\"\nkind = \"bifurcation\"\nx = \"k2\"\n";
    dir.put("s.toml", format!("{before}{along}{at}{figure}"));
    let ran = dir.run(&["sweep", "s.toml", "--formats", "svg"]).done();
    assert!(ran.err.contains("figure `f`: waits for `capsulemap continue`"), "{}", ran.err);
    let ran = dir.run(&["continue", "s.toml", "--formats", "svg"]).done();
    assert!(ran.err.contains("f.svg"), "{}", ran.err);
    dir.run(&["figure", "results/s/s.h5", "--formats", "svg", "--folder", "again"]).done();
    assert!(dir.path("again/f.svg").is_file());
}

#[test]
fn another_text_of_the_same_cases_keeps_them() {
    let dir = WorkDir::new();
    dir.put("s.toml", STUDY);
    dir.run(&["sweep", "s.toml", "--no-figures"]).done();
    let other = format!("# Another figure.\n{STUDY}").replace("name = \"m\"", "name = \"other\"");
    dir.put("s.toml", &other);
    let ran = dir.run(&["sweep", "s.toml", "--formats", "svg"]).done().err;
    assert!(ran.contains("from a study with the same cases") && ran.contains("other.svg"), "{ran}");
    let continue_branches =
        |more: &[&str]| dir.run(&[&["continue", "s.toml", "--no-figures"], more].concat());
    continue_branches(&[]).done();
    let both = kept(&dir.path("results/s/s.h5"));
    assert!(store::has_branches(&both) && store::has_cases(&both));
    assert_eq!(both.texts["study"], other);
    // Branches belong to the text of their study.
    dir.put("s.toml", STUDY);
    continue_branches(&[])
        .refused(&["holds branches or ramps of a study with another text", "--overwrite"]);
    continue_branches(&["--overwrite"]).done();
    dir.put("s.toml", other);
    dir.run(&["continue", "s.toml", "--output", "b.h5", "--no-figures"]).done();
    dir.put("s.toml", STUDY);
    dir.run(&["sweep", "s.toml", "--output", "b.h5"])
        .refused(&["branches or ramps of a study with another text"]);
}

#[test]
fn results_of_others_receive_no_branches() {
    let dir = WorkDir::new();
    dir.put("s.toml", STUDY);
    dir.put("plain.toml", FIG5);
    dir.run(&["sweep", "plain.toml", "--output", "r.h5"]).done();
    let before = fs::read(dir.path("r.h5")).expect("a result");
    let into = |more: &[&str]| {
        dir.run(&[&["continue", "s.toml", "--output", "r.h5", "--no-figures"], more].concat())
    };
    into(&[]).refused(&["r.h5: holds results of another study", "--overwrite"]);
    assert_eq!(fs::read(dir.path("r.h5")).expect("a result"), before);
    into(&["--overwrite"]).done();
    assert!(!store::has_cases(&kept(&dir.path("r.h5"))));
    // What the other command left of the same study stays.
    let sweep = ["sweep", "s.toml", "--output", "r.h5", "--no-figures", "--overwrite"];
    dir.run(&sweep).done();
    assert!(!into(&["--overwrite"]).done().out.is_empty());
    let both = kept(&dir.path("r.h5"));
    assert!(store::has_cases(&both) && store::has_branches(&both));
    let ran = dir.run(&["inspect", "r.h5"]).done().out;
    assert!(ran.contains("branch_point") && ran.contains("16 periodic"), "{ran}");
    // The older name of the command is the same command.
    for command in ["continue", "follow"] {
        dir.run(&[command, "plain.toml"]).refused(&["plain.toml: asks for no [[branches]]"]);
    }
    dir.run(&["continue", "s.toml", "--threads", "0"]).refused(&["--threads"]);
}
