//! What is set of figures on the command line and in studies, with what is wrong, and what their files tell.

use std::fs;

use capsulemap::figure::{Format, draw};
use capsulemap::study::{Drawing, DrawingKind, QuantitySettings};

use super::figure::fixtures::plane;
use super::figure::{folder, into};
use super::program::WorkDir;

/// What a study must say of the capsule.
const PARAMETERS: &str = "[parameters]\np_d = \"4 N\"\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\n";

#[test]
fn a_study_and_the_command_line_set_the_same() {
    let dir = WorkDir::new();
    let study = |figures: &str| {
        format!(
            "outputs = [\"progression_speed\"]\n{PARAMETERS}[protocol]\nmax_cycles = 30\nexponent_cycles = 0\n[[axes]]\nname = \"omega\"\n\
             from = \"20 rad/s\"\nto = \"30 rad/s\"\npoints = 4\n{figures}"
        )
    };
    let text = study(
        "[[figures]]\nname = \"own\"\nkind = \"bifurcation\"\nof = [\"progression_speed\"]\nwidth = \"3 in\"\n\
         height = \"60 mm\"\nmarker_size = \"2 pt\"\ndpi = 100\nlegend = false\ndata = true\nsvg_text = true\n\
         limits = { omega = [\"19 rad/s\", \"31 rad/s\"] }\nscale = { progression_speed = \"symlog 0.1 mm/s\" }\n\
         unit = { omega = \"Hz\" }\nlabel = { omega = \"Drive $f$\" }\ndecimals = { omega = 2 }\n\
         texts = { \"near $k_2$\" = { omega = \"22 rad/s\", progression_speed = \"0.5 mm/s\" } }\n",
    );
    dir.put("s.toml", text);
    dir.run(&["sweep", "s.toml", "--output", "s.h5", "--formats", "svg"]).done();
    let files = ["own.svg", "own.csv"];
    let before = files.map(|name| fs::read(dir.path(name)).expect(name));
    let options = "figure s.h5 --kind bifurcation --of progression_speed --name own --formats svg --height 60 \
        --dpi 100 --no-legend --data --svg-text --limits omega=19,31 --unit omega=Hz --decimals omega=2";
    let own = [
        "--width",
        "3 in",
        "--marker-size",
        "2 pt",
        "--scale",
        "progression_speed=symlog 0.1 mm/s",
        "--label",
        "omega=Drive $f$",
        "--text",
        "near $k_2$: omega=22, progression_speed=0.5 mm/s",
    ];
    let all: Vec<&str> = options.split_whitespace().chain(own).collect();
    dir.run(&all).done();
    let after = files.map(|name| fs::read(dir.path(name)).expect(name));
    assert!(before == after, "the command line sets other things");
    let svg = String::from_utf8_lossy(&before[0]);
    assert!(svg.contains(">near </tspan>") || svg.contains(">near "), "its words are missing");
    // Words have a place in the figure, or the figure says that they have none.
    let texts = ["a: omega=22 rad/s, progression_speed=100 m/s", "b: omega=22 rad/s, period=1"];
    let lost = [&all[..], &["--text", texts[0], "--text", texts[1], "--overwrite"]].concat();
    let said = dir.run(&lost).done().err;
    for words in ["a", "b"] {
        let note = format!("the words \"{words}\" stand outside its panels and are left out");
        assert!(said.contains(&note), "{said}");
    }
    let texts = [
        "a: omega=1",
        "omega=1, period=2",
        " : omega=1, period=2",
        "a: omga=1, period=1",
        "a: omega=1 N, period=1",
    ];
    let texts: Vec<&str> = texts.into_iter().flat_map(|it| ["--text", it]).collect();
    dir.run(&[&["figure", "s.h5", "--kind", "bifurcation"], &texts[..]].concat()).refused(&[
        "--text a: omega=1: expected values of the two quantities along its axes, found 1",
        "--text omega=1, period=2: expected WORDS: NAME=VALUE, NAME=VALUE",
        "--text  : omega=1, period=2: expected words that stand in the figure, found none",
        "--text a: omga=1, period=1: unknown quantity \"omga\"; did you mean \"omega\"?",
        "--text a: omega=1 N, period=1: \"1 N\" is a force",
    ]);
    // All that is wrong at once, with what is allowed.
    let wrong = "figure s.h5 --kind map --limits omega=3,2 --limits omga=1,2 --scale omega=loga --unit omega=m --decimals \
        omega=-1 --colour-map omega=jet --height 5km --centre progression_speed=1N --contours progression_speed=x";
    let wrong: Vec<&str> = wrong.split_whitespace().collect();
    dir.run(&wrong).refused(&[
        "--limits omega=3,2: expected two values, the lesser first",
        "--limits omga=1,2: unknown quantity \"omga\"; did you mean \"omega\"?",
        "--scale omega=loga: unknown scale \"loga\"; did you mean \"log\"? (allowed: linear, log, symlog)",
        "--unit omega=m: unknown unit \"m\"; expected that of a frequency in rad/s, Hz",
        "--decimals omega=-1: expected a whole number, 0 to 12",
        "--colour-map omega=jet: unknown colour map \"jet\"",
        "--height: \"5km\"",
        "--centre progression_speed=1N: \"1N\" is a force; expected a velocity in m/s",
        "--contours progression_speed=x: \"x\" does not begin with a number",
    ]);
    dir.put("w.toml", study(
        "[[figures]]\nname = \"own\"\nkind = \"map\"\nlimits = { omega = [\"1 rad/s\"], speed = [1, 2] }\nscale = { omega = 3 }\n\
         sweep = \"up\"\ncolour_by = \"period\"\nwidth = \"5\"\n",
    ));
    dir.run(&["sweep", "w.toml", "--dry-run"]).refused(&[
        "line 17: figures[1].limits.omega: expected two values, the lesser first",
        "line 17: figures[1].limits.speed: unknown quantity \"speed\"; did you mean \"progression_speed\"?",
        "line 18: figures[1].scale.omega: unknown scale \"3\"",
        "line 19: figures[1].sweep: unknown sweep \"up\"; did you mean \"upward\"?",
        "line 20: figures[1].colour_by: does not go with a figure of the kind map",
        "line 21: figures[1].width: \"5\" has no unit",
    ]);
}

#[test]
fn files_say_where_they_come_from() {
    let dir = WorkDir::new();
    let more = "[protocol]\nmax_cycles = 20\nexponent_cycles = 0\n[[axes]]\nname = \"omega\"\nvalues = [\"20 rad/s\", \"21 rad/s\"]\n";
    dir.put("s.toml", format!("{PARAMETERS}{more}"));
    dir.run(&["sweep", "s.toml", "--output", "s.h5"]).done();
    let files_at = |time: &str| {
        let figure = ["figure", "s.h5", "--kind", "bifurcation", "--name", "it", "--data"];
        let ran = dir.command(&figure).env("SOURCE_DATE_EPOCH", time).output().expect("it runs");
        assert!(ran.status.success());
        ["png", "svg", "pdf", "csv"].map(|end| fs::read(dir.path(&format!("it.{end}"))).expect(end))
    };
    let [png, svg, pdf, csv] = files_at("951782400");
    let has = |bytes: &[u8], text: &str| bytes.windows(text.len()).any(|it| it == text.as_bytes());
    let version = concat!("capsulemap ", env!("CARGO_PKG_VERSION"));
    for text in [version, "2000-02-29T00:00:00Z", "study "] {
        assert!(has(&png, text), "{text}");
    }
    assert!(has(&pdf, "D:20000229000000") && has(&pdf, version), "PDF");
    // The time alone makes the files of another run others, and a figure of this program is replaced.
    assert_eq!(files_at("951782400"), [png.clone(), svg.clone(), pdf, csv.clone()]);
    let [later, same_svg, _, same_csv] = files_at("951782401");
    assert!(later != png && same_svg == svg && same_csv == csv);
    // Data that were changed by hand are kept.
    fs::write(dir.path("it.csv"), "my notes\n").expect("written");
    let figure = ["figure", "s.h5", "--kind", "bifurcation", "--name", "it", "--data"];
    dir.run(&figure).refused(&["it.csv"]);
    assert_eq!(fs::read(dir.path("it.csv")).expect("kept"), b"my notes\n");
}

#[test]
fn the_legend_of_a_map_lists_the_kinds_within_its_limits() {
    let dataset = plane(40, 30);
    let drawn = |limits: Option<[f64; 2]>| {
        let of_axis = QuantitySettings { limits, ..QuantitySettings::default() };
        let settings = [("omega".to_owned(), of_axis)].into();
        let of = vec!["period".to_owned()];
        let map = Drawing { of, settings, svg_text: true, ..Drawing::new("m", DrawingKind::Map) };
        let files = draw(&dataset, &map, &into(&folder("kinds"), &[Format::Svg])).expect("drawn");
        fs::read_to_string(&files.paths[0]).expect("a file")
    };
    let listed = |svg: &str, name: &str| svg.contains(&format!(">{name}</tspan>"));
    let (all, part) = (drawn(None), drawn(Some([20.0, 40.0])));
    for name in ["failed", "chaotic", "quasi-periodic", "1"] {
        assert!(listed(&all, name), "{name}");
    }
    // The cases that failed have frequencies above 105 rad/s.
    assert!(!listed(&part, "failed") && listed(&part, "1"));
}
