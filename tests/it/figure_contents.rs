//! What figures show is so: both sweeps, only what is seen in legends, the data with what colours tell, and no words that cannot be set.

use std::fs;

use super::program::{TWO_MOTIONS, WorkDir};

/// A sweep in both directions through hysteresis, and a small plane.
fn results() -> WorkDir {
    let work = WorkDir::new();
    let axis =
        "[[axes]]\nname = \"omega\"\nfrom = \"110 rad/s\"\nto = \"180 rad/s\"\npoints = 36\n";
    let start = "[start]\ninherit = \"omega\"\ndirections = [\"upward\", \"downward\"]\n";
    work.put(
        "sweep.toml",
        format!("{TWO_MOTIONS}{axis}{start}[history]\ncycles = 3\nsamples_per_cycle = 60\n"),
    );
    let plane = "[[axes]]\nname = \"omega\"\nvalues = [\"115 rad/s\", \"120 rad/s\", \"170 rad/s\"]\n[[axes]]\nname = \"c\"\n\
                 values = [\"1.7 N s/m\", \"1.8 N s/m\"]\n";
    work.put("plane.toml", format!("{}{plane}", TWO_MOTIONS.replace("c = \"1.77 N s/m\"\n", "")));
    for study in ["sweep", "plane"] {
        work.run(&["sweep", &format!("{study}.toml"), "--output", &format!("{study}.h5")]).done();
    }
    work
}

/// Draws a figure of a file with its data; what was said of it, its SVG and its data.
fn drawn(work: &WorkDir, file: &str, arguments: &[&str]) -> (String, String, String) {
    let common = [
        "--name",
        "it",
        "--folder",
        ".",
        "--formats",
        "svg",
        "--svg-text",
        "--data",
        "--overwrite",
    ];
    let ran = work.run(&[&["figure", file][..], arguments, &common].concat()).done();
    let text = |name: &str| fs::read_to_string(work.path(name)).expect("written");
    (ran.out + &ran.err, text("it.svg"), text("it.csv"))
}

/// The words of a figure, without markup.
fn words(svg: &str) -> String {
    let mut words = String::new();
    for part in svg.split('<').skip(1) {
        words.push_str(part.split_once('>').map_or("", |it| it.1));
    }
    words.replace('\u{a0}', " ")
}

/// The rows of the data of a series.
fn rows<'d>(data: &'d str, series: &str) -> Vec<Vec<&'d str>> {
    let cells =
        data.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(',').collect());
    cells.filter(|cells: &Vec<&str>| cells[1] == series).collect()
}

#[test]
fn figures_show_what_they_say() {
    let work = results();
    let speed = ["--kind", "bifurcation", "--of", "progression_speed"];
    let with = |more: &[&'static str]| [&speed[..], more].concat();

    // Both sweeps have all their points, where they find the same motion too.
    let (_, _, data) = drawn(&work, "sweep.h5", &with(&["--colour-by", "direction"]));
    assert_eq!((rows(&data, "upward").len(), rows(&data, "downward").len()), (36, 36));

    // The data tell what the colours do; kinds that are not seen are not listed.
    let (_, svg, data) = drawn(&work, "sweep.h5", &with(&["--colour-by", "period"]));
    let told = |data: &str| -> Vec<(f64, String)> {
        let cells = data.lines().filter(|line| !line.starts_with('#')).skip(1);
        let cell = |line: &str, at: usize| line.split(',').nth(at).expect("a cell").to_owned();
        cells.map(|line| (cell(line, 2).parse().expect("a number"), cell(line, 4))).collect()
    };
    let all = told(&data);
    let long = all.iter().find(|(_, kind)| kind == "9 or more").expect("a long period").0;
    assert!(
        all.iter().all(|(_, kind)| ["1", "4", "9 or more"].contains(&kind.as_str())),
        "{all:?}"
    );
    assert!(words(&svg).contains("9 or more"));
    let beside =
        if long < 145.0 { "omega=150 rad/s,175 rad/s" } else { "omega=112 rad/s,140 rad/s" };
    let (_, svg, _) = drawn(
        &work,
        "sweep.h5",
        &[&speed[..], &["--colour-by", "period", "--limits", beside]].concat(),
    );
    assert!(words(&svg).contains("Period") && !words(&svg).contains("9 or more"));

    // A range without a case, and a contour without a line, are said.
    let (said, ..) = drawn(&work, "sweep.h5", &with(&["--limits", "omega=200 rad/s,300 rad/s"]));
    assert!(said.contains("no case lies within the limits of omega"), "{said}");
    let map =
        ["--kind", "map", "--of", "progression_speed", "--contours", "progression_speed=-900 mm/s"];
    let (said, svg, _) = drawn(&work, "plane.h5", &map);
    assert!(said.contains("no contour at -900 mm/s"), "{said}");
    assert!(!words(&svg).contains("900"), "{}", words(&svg));

    // Words that cannot be set, and several cases where one is shown, are refused.
    for (label, fault) in [
        (
            "progression_speed=$\\bar{v}$",
            "\"$\\bar{v}$\" has the unknown \\bar; known are _, ^, {} and \\alpha",
        ),
        ("progression_speed=Speed $v", "\"Speed $v\" has a dollar sign without a second one"),
    ] {
        let ran = work.run(&[&["figure", "sweep.h5"][..], &speed, &["--label", label]].concat());
        ran.refused(&[fault]);
    }
    let ran = work.run(
        &[&["figure", "sweep.h5"][..], &speed, &["--at", "omega=110 rad/s,120 rad/s"]].concat(),
    );
    ran.refused(&["--at omega: has 2 values; a bifurcation takes one, several are for history, "]);

    // Kinds have no limits, and it is said why.
    let (said, ..) =
        drawn(&work, "plane.h5", &["--kind", "map", "--of", "period", "--limits", "period=1,4"]);
    assert!(said.contains("`limits` of period has no effect here: kinds have fixed"), "{said}");
}

#[test]
fn chosen_cases_have_a_panel_each() {
    let work = results();
    let at = ["--sweep", "upward", "--unit", "omega=Hz", "--at"];
    let portraits = |at_: &str| {
        let kind = ["--kind", "phase-portrait"];
        drawn(&work, "sweep.h5", &[&kind[..], &at, &[at_]].concat()).2
    };
    let lines = |data: &str, panel: &str| -> Vec<String> {
        let ours = data.lines().filter_map(|line| line.strip_prefix(panel));
        ours.map(str::to_owned).collect()
    };
    let (both, first) = (portraits("omega=18 Hz,20 Hz"), portraits("omega=18 Hz"));
    let second = portraits("omega=20 Hz");
    assert!(lines(&first, "1,").len() > 1000);
    assert_eq!(lines(&both, "1,"), lines(&first, "1,"));
    assert_eq!(lines(&both, "2,"), lines(&second, "1,"));
    assert_ne!(lines(&first, "1,"), lines(&second, "1,"));
    // What is held is told in the units of the figure, and by name.
    let told = both.lines().next().expect("a line");
    assert!(told.ends_with(" Hz, direction = upward"), "{told}");
    assert!(both.contains("\n# panel 2 (ω/2π = "), "{both}");

    // Spectra side by side have the same abscissa, and each says which case it is.
    let spectra = [&["--kind", "spectrum"][..], &at, &["omega=18 Hz,20 Hz"]].concat();
    let svg = words(&drawn(&work, "sweep.h5", &spectra).1);
    assert!(svg.matches("ω/2π = ").count() == 2 && svg.contains("upward in ω/2π"), "{svg}");
}
