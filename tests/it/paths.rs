//! Axes along which several quantities vary together: cases, files, attractors, figures and refusals.

use std::process::Command;

use capsulemap::store::{self, Dataset, Values, Variable};
use capsulemap::study::Study;

use super::program::{TWO_MOTIONS, WorkDir};
use super::readers::python;

/// A quick look at each motion.
const PROTOCOL: &str = "[protocol]\npoints = 2\nimpact_points = 1\nexponent_cycles = 32\n";

/// The same capsule without a frequency and an amplitude.
const CAPSULE: &str = "[parameters]\nk2 = \"2.42 kN/m\"\ndelta = \"3.5 mm\"\n";

/// What is computed of a study by a sweep.
fn swept(dir: &WorkDir, name: &str, text: &str) -> Dataset {
    dir.put(&format!("{name}.toml"), text);
    let output = format!("{name}.h5");
    dir.run(&["sweep", &format!("{name}.toml"), "--output", &output]).done();
    store::read(&dir.path(&output)).expect("a result")
}

/// The numbers of a variable or a coordinate.
fn numbers(dataset: &Dataset, name: &str) -> Vec<f64> {
    let stored = dataset.variable(name).or_else(|| dataset.coordinate(name));
    let stored = stored.unwrap_or_else(|| panic!("no {name}"));
    stored.values.to_real().into_iter().collect()
}

/// Sure that two variables have the same bits.
fn assert_same(name: &str, some: &Variable, other: &Variable) {
    let bits = |values: &Values| -> Vec<u64> {
        values
            .to_real()
            .into_iter()
            .map(|it| if it.is_nan() { u64::MAX } else { it.to_bits() })
            .collect()
    };
    assert_eq!(bits(&some.values), bits(&other.values), "{name}");
    assert_eq!((&some.unit, &some.long_name), (&other.unit, &other.long_name), "{name}");
}

#[test]
fn cases_of_a_path_have_the_bits_of_single_cases_and_of_the_diagonal_of_a_grid() {
    let dir = WorkDir::new();
    let places = [
        ("60 rad/s", "2 N", "0 m/s"),
        ("64 rad/s", "3 N", "0.1 m/s"),
        ("70 rad/s", "2.5 N", "0.2 m/s"),
    ];
    let tables =
        places.map(|(w, p, v)| format!("{{ start_y1 = \"{v}\", omega = \"{w}\", p_d = \"{p}\" }}"));
    let axis = format!("[[axes]]\nname = \"line\"\nvalues = [{}]\n", tables.join(", "));
    let along = swept(&dir, "along", &format!("{CAPSULE}{axis}{PROTOCOL}"));
    assert_eq!(numbers(&along, "line"), [0.0, 1.0, 2.0]);
    assert_eq!(numbers(&along, "omega"), [60.0, 64.0, 70.0]);
    assert_eq!(along.variable("p_d").expect("it varies").dimensions, ["line"]);
    let outputs: Vec<&str> = along
        .model()
        .outputs()
        .map(|it| it.name())
        .filter(|it| along.variable(it).is_some())
        .collect();
    assert!(outputs.len() > 10);
    for (place, (w, p, v)) in places.into_iter().enumerate() {
        let single =
            format!("{CAPSULE}omega = \"{w}\"\np_d = \"{p}\"\n[start]\ny1 = \"{v}\"\n{PROTOCOL}");
        let alone = swept(&dir, &format!("single{place}"), &single);
        for name in &outputs {
            let [own, other] = [&along, &alone].map(|it| numbers(it, name));
            assert_eq!(own[place].to_bits(), other[0].to_bits(), "{name} at {w}");
        }
    }
    let each = [
        "omega\"\nvalues = [\"60 rad/s\", \"64 rad/s\", \"70 rad/s\"]",
        "p_d\"\nvalues = [\"2 N\", \"3 N\", \"2.5 N\"]",
    ];
    let grid: String = each.iter().map(|it| format!("[[axes]]\nname = \"{it}\n")).collect();
    let grid = swept(&dir, "grid", &format!("{CAPSULE}{grid}{PROTOCOL}"));
    let afresh = axis.replace("0.1 m/s", "0 m/s").replace("0.2 m/s", "0 m/s");
    let along = swept(&dir, "diagonal", &format!("{CAPSULE}{afresh}{PROTOCOL}"));
    for name in &outputs {
        let (own, all) = (numbers(&along, name), numbers(&grid, name));
        let of_grid = (0..3).map(|place| all[4 * place].to_bits());
        assert!(own.iter().map(|it| it.to_bits()).eq(of_grid), "{name}");
    }
}

#[test]
fn a_path_of_one_quantity_is_an_axis_by_another_name() {
    let dir = WorkDir::new();
    let of = |axis: &str, name: &str| {
        format!(
            "{TWO_MOTIONS}[[axes]]\n{axis}points = 13\n[start]\ny1 = \"0.3 m/s\"\ninherit = \"{name}\"\ndirections = [\"upward\", \"downward\"]\n{PROTOCOL}"
        )
    };
    let plain = "name = \"omega\"\nfrom = \"140 rad/s\"\nto = \"180 rad/s\"\n";
    let along =
        "name = \"line\"\nfrom = { omega = \"140 rad/s\" }\nto = { omega = \"180 rad/s\" }\n";
    let plain = swept(&dir, "plain", &of(plain, "omega"));
    let along = swept(&dir, "along", &of(along, "line"));
    assert_same(
        "omega",
        plain.coordinate("omega").expect("an axis"),
        along.variable("omega").expect("it varies"),
    );
    assert!(numbers(&plain, "event_omega").len() > 1, "there are folds");
    for (name, variable) in &plain.variables {
        let other = along.variable(name).unwrap_or_else(|| panic!("no {name}"));
        assert_same(name, variable, other);
        let renamed = variable.dimensions.iter().map(|it| if it == "omega" { "line" } else { it });
        assert!(renamed.eq(other.dimensions.iter().map(String::as_str)), "{name}");
    }
    assert_eq!(along.variables.len(), plain.variables.len() + 1);
}

/// The capsule with two motions along a path on which frequency and amplitude rise.
fn oblique(points: usize) -> String {
    format!(
        "{}[[axes]]\nname = \"line\"\nfrom = {{ omega = \"140 rad/s\", p_d = \"2.6 N\" }}\nto = {{ omega = \"180 rad/s\", p_d = \"3 N\" }}\npoints = {points}\n[start]\ny1 = \"0.3 m/s\"\ninherit = \"line\"\ndirections = [\"upward\", \"downward\"]\n{PROTOCOL}",
        TWO_MOTIONS.replace("p_d = \"2.79 N\"\n", "")
    )
}

#[test]
fn attractors_are_followed_along_a_path_to_the_folds_of_branches() {
    let dir = WorkDir::new();
    let along = swept(&dir, "along", &oblique(25));
    assert_eq!(along.attributes["attractor_axis"], "line");
    let kinds = &along.variable("event_kind").expect("events").flags;
    let fold = kinds.iter().find(|(_, name)| name == "fold").expect("folds are a kind").0 as f64;
    let [kind, place, omega, force] =
        ["event_kind", "event_place", "event_omega", "event_p_d"].map(|name| numbers(&along, name));
    let folds: Vec<usize> = (0..kind.len()).filter(|it| kind[*it] == fold).collect();
    assert!(!folds.is_empty(), "{kind:?} {place:?}");
    for at in folds {
        assert!((omega[at] - (140.0 + 40.0 * place[at] / 24.0)).abs() < 1e-9);
        assert!((force[at] - (2.6 + 0.4 * place[at] / 24.0)).abs() < 1e-12);
        // The same fold on a branch in the frequency alone.
        let branch = format!(
            "{TWO_MOTIONS}[[axes]]\nname = \"omega\"\nvalues = [\"150 rad/s\", \"180 rad/s\"]\n[[branches]]\nname = \"b\"\nalong = \"omega\"\nfrom = \"138 rad/s\"\nto = \"185 rad/s\"\nat = {{ omega = \"140 rad/s\" }}\nstart = {{ y1 = \"0.3 m/s\" }}\n"
        );
        let text = branch.replace("p_d = \"2.79 N\"", &format!("p_d = \"{:?} N\"", force[at]));
        let name = format!("fold{at}");
        dir.put(&format!("{name}.toml"), text);
        let output = format!("{name}.h5");
        dir.run(&["continue", &format!("{name}.toml"), "--output", &output]).done();
        let branch = store::read(&dir.path(&output)).expect("a result");
        let found = numbers(&branch, "special_omega");
        let nearest = found.iter().map(|it| (it - omega[at]).abs()).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-6, "{} {found:?}", omega[at]);
    }
    // Each attractor keeps its number where a finer path shows it, too.
    let fine = swept(&dir, "fine", &oblique(49));
    let [coarse, fine] = [&along, &fine].map(|it| numbers(it, "attractor"));
    let of_fine: Vec<f64> = fine.chunks(4).map(|it| it[..2].to_vec()).collect::<Vec<_>>().concat();
    assert_eq!(coarse, of_fine);
}

#[test]
fn a_path_is_resumed_joined_verified_and_told_of() {
    let dir = WorkDir::new();
    let delta = "[[axes]]\nname = \"delta\"\nvalues = [\"4.33 mm\", \"4.5 mm\"]\n";
    let text = oblique(9).replace("delta = \"4.33 mm\"\n", "") + delta;
    let whole = swept(&dir, "whole", &text);
    assert_eq!(
        whole.variable("progression_speed").expect("an output").dimensions,
        ["line", "delta", "direction"]
    );
    dir.put("parts.toml", &text);
    for task in ["2/2", "1/2"] {
        dir.run(&["sweep", "parts.toml", "--task", task, "--output", "parts.h5"]).done();
    }
    dir.run(&["join", "parts.toml", "--output", "parts.h5"]).done();
    let parts = store::read(&dir.path("parts.h5")).expect("a result");
    for (name, variable) in &whole.variables {
        if !name.starts_with("block") {
            assert_same(name, variable, &parts.variables[name]);
        }
    }
    dir.run(&["verify", "whole.h5"]).done();
    dir.run(&["status", "parts.toml", "--output", "parts.h5"]).done();
    let told = dir.run(&["inspect", "whole.h5"]).done();
    assert!(told.out.contains("line") && told.out.contains("omega"), "{}", told.out);
    let checked = dir.run(&["check", "parts.toml"]).done();
    assert!(checked.out.contains("line of 9 places: p_d, omega"), "{}", checked.out);
    // A case by its number is that of the file.
    let case = dir.run(&["simulate", "--study", "whole.toml", "--case", "9", "--json"]).json();
    assert!(case["orbit"].is_object());
}

#[test]
fn figures_name_what_varies_along_a_path() {
    let dir = WorkDir::new();
    let figures = "[[figures]]\nname = \"by-place\"\nkind = \"bifurcation\"\nx = \"line\"\ndata = true\n\
        [[figures]]\nname = \"by-frequency\"\nkind = \"bifurcation\"\nx = \"omega\"\ndata = true\n\
        [[figures]]\nname = \"held\"\nkind = \"section\"\nat = { line = 3 }\n";
    swept(&dir, "along", &(oblique(25) + figures));
    let read = |name: &str| {
        std::fs::read_to_string(dir.path(name))
            .unwrap_or_else(|error| panic!("{name}: {error}; {:?}", dir.files()))
    };
    let data = |name: &str| {
        read(
            &dir.files().into_iter().find(|it| it.ends_with(&format!("{name}.csv"))).expect("data"),
        )
    };
    let by_place = data("by-place");
    assert!(by_place.contains("140 to 180"), "{}", &by_place[..600]);
    assert!(data("by-frequency").contains("2.6 to 3"));
    let drawn = |more: &[&str]| {
        dir.run(
            &[&["figure", "along.h5", "--kind", "bifurcation", "--formats", "svg"], more].concat(),
        )
    };
    drawn(&["--x", "p_d", "--name", "again"]).done();
    // A path is told by its own name, and by what goes along it.
    let all = "`delta` is not an axis of this study (its axes: line (a path along which go ";
    drawn(&["--x", "delta"]).refused(&[all, "p_d, omega)", ", direction)"]);
    dir.run(&[
        "figure",
        "along.h5",
        "--kind",
        "phase-portrait",
        "--at",
        "omega=160 rad/s",
        "--formats",
        "svg",
    ]);
    drawn(&["--at", "line=3"]).refused(&["axis"]);
}

#[test]
fn what_does_not_go_along_a_path_says_so() {
    let dir = WorkDir::new();
    swept(&dir, "along", &oblique(5));
    dir.run(&["explore", "along.h5", "--no-browser"])
        .refused(&["the path `line`", "capsulemap figure"]);
    dir.run(&["tradeoff", "along.h5", "--refine"]).refused(&["the path `line`", "--refine"]);
    let plain = dir.run(&["tradeoff", "along.h5", "--json"]).json();
    let optimum = plain.to_string();
    assert!(optimum.contains("omega") && optimum.contains("p_d"), "{optimum}");
}

#[test]
fn a_reader_finds_what_varies_along_a_path_as_coordinates() {
    let Some(python) = python() else { return };
    let dir = WorkDir::new();
    let written = swept(&dir, "along", &oblique(5));
    super::readers::assert_readers_find(&python, &dir.path("along.h5"), &written);
    let script = "import sys, xarray\nds = xarray.open_dataset(sys.argv[1], engine='h5netcdf')\n\
        assert ds.omega.dims == ds.p_d.dims == ('line',), ds\nassert {'omega', 'p_d', 'line'} <= set(ds.coords), ds\n\
        assert set(ds.progression_speed.coords) >= {'omega', 'p_d'}\n\
        assert list(ds.swap_dims(line='omega').sel(omega=160.0).p_d.values.ravel()) == [2.8]\n";
    let ran = Command::new(python)
        .args(["-c", script])
        .arg(dir.path("along.h5"))
        .output()
        .expect("it runs");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
}

#[test]
fn every_fault_of_a_path_is_told() {
    let faults = |axes: &str| match Study::parse("s.toml", &format!("{CAPSULE}{axes}")) {
        Ok(_) => String::new(),
        Err(faults) => faults.to_string(),
    };
    let line = "[[axes]]\nname = \"line\"\n";
    let ends = "from = { omega = \"60 rad/s\", p_d = \"2 N\" }\nto = { omega = \"70 rad/s\", p_d = \"4 N\" }\npoints = 3\n";
    assert_eq!(faults(&format!("{line}{ends}")), "");
    let pair = "values = [{ omega = \"60 rad/s\", p_d = \"2 N\" }, { omega = \"70 rad/s\", p_d = \"3 N\" }]\n";
    for (axes, told) in [
        (format!("[[axes]]\n{ends}"), "axes[1].name: missing; expected a name of its own"),
        (format!("[[axes]]\nname = \"omega\"\n{ends}"), "\"omega\" is a quantity"),
        (format!("[[axes]]\nname = \"progression_speed\"\n{ends}"), "is a quantity"),
        (format!("[[axes]]\nname = \"direction\"\n{ends}"), "is a dimension already"),
        (format!("[[axes]]\nname = \"2 lines\"\n{ends}"), "cannot name a dimension"),
        (
            format!("{line}{pair}{line}values = [{{ delta = \"1 mm\" }}]\n"),
            "\"line\" is a dimension already",
        ),
        (
            format!("{line}{pair}[[axes]]\nname = \"p_d\"\nvalues = [\"2 N\"]\n"),
            "a second axis \"p_d\"",
        ),
        (
            format!("[[axes]]\nname = \"p_d\"\nvalues = [\"2 N\"]\n{line}{pair}"),
            "p_d on a second axis",
        ),
        (
            format!("{line}values = [{{ omega = \"60 rad/s\" }}, {{ p_d = \"2 N\" }}]\n"),
            "gives p_d; expected omega, as the first place",
        ),
        (format!("{line}values = [{{}}]\n"), "expected at least one quantity"),
        (format!("{line}values = [{{ omega = \"60 rad/s\" }}, 3]\n"), "expected a table, found"),
        (
            format!("{line}values = [{{ omega = \"60 N\", p_d = \"2 N\" }}]\n"),
            "axes[1].values[1].omega: ",
        ),
        (format!("{line}values = [{{ omega = \"-60 rad/s\", p_d = \"2 N\" }}]\n"), "must be"),
        (format!("{line}values = [{{ omgea = \"60 rad/s\" }}]\n"), "did you mean \"omega\"?"),
        (
            format!("{line}values = [{{ omega = \"60 rad/s\" }}, {{ omega = \"60 rad/s\" }}]\n"),
            "is the same as the place before",
        ),
        (
            format!(
                "{line}values = [{{ omega = \"60 rad/s\" }}, {{ omega = \"70 rad/s\" }}, {{ omega = \"65 rad/s\" }}]\n"
            ),
            "turns back along the path",
        ),
        (format!("{line}{pair}points = 3\n"), "does not go with a list of values"),
        (format!("{line}{}", ends.replace("points = 3\n", "")), "axes[1].points: missing"),
        (
            format!("{line}{}", ends.replace("points = 3", "points = 1")),
            "expected a whole number, 2",
        ),
        (
            format!("{line}{}", ends.replace(", p_d = \"4 N\"", "")),
            "gives omega; expected p_d, omega",
        ),
        (
            format!("{line}{}", ends.replace("70", "60").replace("4 N", "2 N")),
            "is the same as `from`",
        ),
        (
            format!("{line}{}spacing = \"logarithmic\"\n", ends.replace("2 N", "0 N")),
            "needs both ends of p_d above zero",
        ),
        (format!("{line}{}", ends.replace("to = {", "to = \"3 N\" #")), "expected a table"),
        (format!("{line}{ends}[draws]\ncount = 3\n"), "a path does not go with `[draws]`"),
        (format!("{line}{ends}omega = 3\n"), "unknown key \"omega\""),
        (
            format!("{line}{ends}[start]\ninherit = \"omega\"\n"),
            "unknown axis of this study \"omega\"",
        ),
        (
            format!(
                "{line}values = [{{ omega = \"60 rad/s\", p_d = \"2 N\", start_y1 = \"0 m/s\" }}]\n[start]\ny1 = \"0.3 m/s\"\ninherit = \"line\"\n"
            ),
            "must be of parameters",
        ),
        (
            format!("{line}{ends}[[figures]]\nname = \"f\"\nkind = \"map\"\nat = {{ line = 7 }}\n"),
            "expected a place along the path, counted from 0, its first, to 2, its last",
        ),
        (
            format!(
                "{line}{ends}[[figures]]\nname = \"f\"\nkind = \"map\"\nat = {{ line = 1, omega = \"60 rad/s\" }}\n"
            ),
            "a second value along `line`",
        ),
    ] {
        let found = faults(&axes);
        assert!(found.contains(told), "{told:?} is missing from {found:?} of\n{axes}");
    }
    let dir = WorkDir::new();
    dir.put("s.toml", format!("{CAPSULE}[[axes]]\nname = \"branch_point\"\n{ends}"));
    dir.run(&["check", "s.toml"]).refused(&["axes[1].name", "something else in results"]);
}

#[test]
fn the_text_of_a_path_keeps_its_form_and_its_bits() {
    let ends = "[[axes]]\nname = \"line\"\nfrom = { omega = \"60 rad/s\", p_d = \"2 N\" }\nto = { omega = \"90 rad/s\", p_d = \"2 N\" }\npoints = 7\nspacing = \"logarithmic\"\n";
    let study = Study::parse("s.toml", &format!("{CAPSULE}{ends}")).expect("a study");
    let text = study.to_toml();
    assert!(text.contains("points = 7\nspacing = \"logarithmic\""), "{text}");
    let again = Study::parse("s.toml", &text).expect("a study");
    assert_eq!(again.axes(), study.axes());
    assert_eq!(again.fingerprint(), study.fingerprint());
    assert_eq!(study.axes()[0].varying[0].values, [2.0; 7]);
}

#[test]
fn the_study_of_the_document_is_one() {
    let document = include_str!("../../docs/paths.md");
    let text = document.split("```toml\n").nth(1).and_then(|it| it.split("```").next());
    let study = Study::parse("study.toml", text.expect("a study")).expect("no fault");
    assert_eq!(study.shape(), [81, 2]);
    assert_eq!(study.dimensions(), ["line", "direction"]);
    let places = format!(
        "{}[[axes]]\nname = \"line\"\n{}\n",
        CAPSULE,
        document
            .split("one for each place: `")
            .nth(1)
            .and_then(|it| it.split('`').next())
            .map(|it| format!("values = {it}"))
            .expect("a list")
    );
    assert_eq!(Study::parse("s.toml", &places).expect("no fault").shape(), [2]);
}
