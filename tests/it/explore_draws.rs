//! What the page is told of cases that are drawn, and figures with the colours that the page sets.

use std::fs;

use super::explorer::{Explorer, coarse_overview};
use super::program::{TWO_MOTIONS, WorkDir};

/// Twelve cases drawn over two quantities.
const DRAWN: &str = r#"
outputs = ["progression_speed", "power"]
[draws]
kind = "low-discrepancy"
count = 12
[[axes]]
name = "omega"
from = "110 rad/s"
to = "180 rad/s"
[[axes]]
name = "k2"
from = "10 kN/m"
to = "100 kN/m"
spacing = "logarithmic"
"#;

/// The page of a map of so many amplitudes and frequencies.
fn explored_map(work: &WorkDir, cases: [usize; 2]) -> Explorer {
    work.put("map.toml", coarse_overview(cases));
    work.run(&["sweep", "map.toml", "--output", "map.h5", "--no-figures"]).done();
    Explorer::new(work, &["map.h5"])
}

#[test]
fn draws_are_told_with_what_came_of_them() {
    let work = WorkDir::new();
    // The keys at the top stand before the tables.
    let study = TWO_MOTIONS.replace("k2 = \"65.518 kN/m\"\n", "");
    let (top, rest) = DRAWN.split_once("[draws]").expect("a table");
    work.put("drawn.toml", format!("{top}{study}[draws]{rest}"));
    work.run(&["sweep", "drawn.toml", "--output", "d.h5", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["d.h5"]);
    let told = explorer.object("/api/draws");
    assert_eq!(told["cases"], 12);
    let draws = told["draws"].as_array().expect("a list");
    assert_eq!(draws[0]["name"], "omega");
    assert_eq!((&draws[1]["name"], &draws[1]["log"]), (&"k2".into(), &true.into()));
    // The speed of a case is that of the command for it.
    let outputs = told["outputs"].as_array().expect("a list");
    let speed = outputs.iter().find(|it| it["name"] == "progression_speed").expect("the speed");
    let number = |it: &serde_json::Value| it.as_f64().expect("a number");
    for case in [0, 5, 11] {
        let at = |of: usize| number(&draws[of]["values"][case]);
        let asked = format!("/api/motion?omega={:?}&k2={:?}&cycles=0", at(0), at(1));
        let orbit = &explorer.object(&asked)["simulate"]["orbit"];
        if orbit["outcome"] == "periodic" {
            let (kept, found) =
                (number(&speed["values"][case]), number(&orbit["progression_speed"]));
            assert!((kept - found).abs() <= 1e-9 * found.abs().max(1e-3), "{kept} {found}");
        }
    }
    let file = explorer.object("/api/file");
    assert_eq!(file["draws"][1]["name"], "k2");

    // Of a grid there is nothing to tell.
    let explorer = explored_map(&work, [3, 5]);
    let refused = explorer.get("/api/draws");
    assert!(refused.status == 400 && refused.text().contains("not drawn"), "{}", refused.text());
    assert_eq!(explorer.object("/api/file")["draws"], serde_json::json!([]));
}

#[test]
fn a_saved_map_has_the_colours_that_the_page_sets() {
    let work = WorkDir::new();
    let explorer = explored_map(&work, [5, 9]);
    let map = "/api/figure?kind=map&of=progression_speed&x=omega&y=p_d&format=svg";
    let asked = explorer.get(&format!("{map}&colour-map=cividis&scale=symlog&limits=-2,5"));
    assert_eq!(asked.status, 200, "{}", asked.text());
    let drawn = [
        "figure",
        "map.h5",
        "--kind",
        "map",
        "--of",
        "progression_speed",
        "--x",
        "omega",
        "--y",
        "p_d",
        "--colour-map",
        "progression_speed=cividis",
        "--scale",
        "progression_speed=symlog",
        "--limits",
        "progression_speed=-2 mm/s,5 mm/s",
        "--formats",
        "svg",
    ];
    work.run(&drawn).done();
    let files = work.files();
    let svg = files.iter().find(|it| it.ends_with(".svg")).expect("a figure");
    assert!(asked.text() == fs::read_to_string(work.path(svg)).expect("a figure"), "{svg} differs");
    for (wrong, told) in [
        ("limits=5,-2", "limits: expected two values, the lesser first"),
        ("limits=a,b", "limits: a number is expected"),
        ("colour-map=mauve", "colour-map: "),
        ("scale=log&limits=-1,2", "a logarithmic scale needs limits above zero"),
    ] {
        let refused = explorer.get(&format!("{map}&{wrong}"));
        assert!(refused.status == 400 && refused.text().contains(told), "{}", refused.text());
    }
}

#[test]
fn the_units_of_the_page_are_those_of_its_maps_and_of_saved_figures() {
    let work = WorkDir::new();
    let explorer = explored_map(&work, [5, 9]);
    let units = "units=Hz,mN,cm/s";
    let [usual, chosen] =
        ["", units].map(|it| explorer.object(&format!("/api/file?{it}"))["axes"].clone());
    for (axis, [before, label, unit], factor) in
        [(1, ["ω", "ω/2π", "Hz"], 1.0 / std::f64::consts::TAU), (0, ["p_d", "p_d", "mN"], 1e3)]
    {
        let told = |it: &serde_json::Value| it[axis]["label"].as_str().expect("words").to_owned();
        let plain = |it: String| it.replace('_', "").replace(['{', '}'], "");
        let [before, label] = [before, label].map(|it| plain(it.to_owned()));
        assert!(plain(told(&usual)).contains(&before), "{}", told(&usual));
        assert!(plain(told(&chosen)).contains(&label), "{}", told(&chosen));
        assert_eq!((&chosen[axis]["unit"], &chosen[axis]["asked"]), (&unit.into(), &unit.into()));
        let found = chosen[axis]["factor"].as_f64().expect("a number");
        assert!((found / factor - 1.0).abs() < 1e-12, "{unit}: {found}");
        assert_eq!(usual[axis]["values"], chosen[axis]["values"], "values stay in SI");
    }
    // The ends of the colours are in the unit shown.
    let map = "/api/figure?kind=map&of=progression_speed&x=omega&y=p_d&format=svg";
    let asked = explorer.get(&format!("{map}&{units}&limits=-0.2,0.5"));
    assert_eq!(asked.status, 200, "{}", asked.text());
    work.shell(
        "\"$0\" figure map.h5 --kind map --of progression_speed --x omega --y p_d --unit omega=Hz \
         --unit p_d=mN --unit progression_speed=cm/s --limits 'progression_speed=-0.2 cm/s,0.5 cm/s' \
         --formats svg",
    )
    .done();
    let files = work.files();
    let svg = files.iter().find(|it| it.ends_with(".svg")).expect("a figure");
    assert!(asked.text() == fs::read_to_string(work.path(svg)).expect("a figure"), "{svg} differs");
    for (wrong, told) in [
        ("units=parsec", "units: expected of rad/s, Hz"),
        ("units=mm,cm", "units: mm and cm are units of one dimension"),
        ("units=%00", "units: expected of"),
    ] {
        for place in ["/api/file?", &format!("{map}&"), "/api/map?of=power&x=omega&y=p_d&"] {
            let refused = explorer.get(&format!("{place}{wrong}"));
            let words = refused.text();
            assert!(refused.status == 400 && words.contains(told), "{place}{wrong}: {words}");
        }
    }
}
