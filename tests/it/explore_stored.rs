//! The diagram and the basins that a file has, as the page of `capsulemap explore` is told of them, against the data of their figures
//! and the tables of the file.

use std::fs;

use capsulemap::store::{self, Dataset};
use serde_json::Value;

use super::explorer::Explorer;
use super::program::{TWO_MOTIONS, WorkDir};

/// Both sweeps through hysteresis, and a branch through it.
pub(super) fn hysteresis(work: &WorkDir) {
    let axis =
        "[[axes]]\nname = \"omega\"\nfrom = \"110 rad/s\"\nto = \"180 rad/s\"\npoints = 36\n";
    let start = "[start]\ninherit = \"omega\"\ndirections = [\"upward\", \"downward\"]\n";
    let branch = "[[branches]]\nname = \"progression\"\nalong = \"omega\"\nat = { omega = \"140 rad/s\" }\n\
                  start = { y1 = \"0.3 m/s\" }\n";
    work.put("s.toml", format!("{TWO_MOTIONS}{axis}{start}{branch}"));
    work.run(&["sweep", "s.toml", "--output", "s.h5", "--no-figures"]).done();
    work.run(&["continue", "s.toml", "--output", "s.h5", "--no-figures"]).done();
}

/// Basins with the manifolds of the saddle between them.
pub(super) fn basins(work: &WorkDir) {
    let axis = |name: &str, most: &str| {
        format!("[[axes]]\nname = \"{name}\"\nfrom = \"-{most}\"\nto = \"{most}\"\npoints = 40\n")
    };
    let axes = axis("start_r", "6 mm") + &axis("start_y1", "1.5 m/s");
    let text = format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{axes}[basin]\nmanifolds = true\n");
    work.put("b.toml", text);
    work.run(&["sweep", "b.toml", "--output", "b.h5", "--no-figures"]).done();
}

/// A row of the data of a figure: its panel, its series, where it is, and what its colour tells.
type Row = (usize, String, [f64; 2]);

/// The data of a figure.
fn data(work: &WorkDir, file: &str, arguments: &[&str]) -> Vec<Row> {
    let common = ["--name", "it", "--folder", ".", "--formats", "svg", "--data", "--overwrite"];
    work.run(&[&["figure", file][..], arguments, &common].concat()).done();
    let text = fs::read_to_string(work.path("it.csv")).expect("written");
    let rows = text.lines().filter(|line| !line.starts_with('#') && !line.starts_with("panel"));
    let row = |line: &str| {
        let line = line.replace("\"", "").replace("orbits, line", "orbits line");
        let cells: Vec<&str> = line.split(',').collect();
        let number = |cell: &str| cell.parse().unwrap_or(f64::NAN);
        (
            cells[0].parse().expect("a panel"),
            cells[1].to_owned(),
            [number(cells[2]), number(cells[3])],
        )
    };
    rows.map(row).collect()
}

fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("no list: {value}"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn pair(value: &Value) -> [f64; 2] {
    [number(&value[0]), number(&value[1])]
}

/// The places in both, in order, to the digits of a number of four bytes.
fn assert_same(told: Vec<[f64; 2]>, drawn: Vec<[f64; 2]>, what: &str) {
    let sorted = |mut all: Vec<[f64; 2]>| {
        all.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        all
    };
    let (told, drawn) = (sorted(told), sorted(drawn));
    assert_eq!(told.len(), drawn.len(), "{what}");
    for (a, b) in told.iter().zip(&drawn) {
        assert!(are_near(*a, *b), "{what}: {a:?} and {b:?}");
    }
}

fn are_near(a: [f64; 2], b: [f64; 2]) -> bool {
    (0..2).all(|i| (a[i] - b[i]).abs() <= 1e-6 * b[i].abs().max(1e-3))
}

/// Whether all numbers are the same, but for the last digit that a text may lose.
fn are_same(told: &[f64], kept: &[f64]) -> bool {
    let pairs = told.iter().zip(kept);
    told.len() == kept.len() && pairs.into_iter().all(|(a, b)| (a - b).abs() <= 1e-15 * b.abs())
}

/// The points of a sort on a panel of a diagram.
fn points(told: &Value, panel: usize, sort: usize) -> Vec<[f64; 2]> {
    let factor = number(&told["x"]["factor"]);
    let values = list(&told["panels"][panel]["values"]);
    let cases = list(&told["cases"]).iter().zip(values);
    let own = cases.filter(|(case, _)| case["sort"] == sort);
    own.flat_map(|(case, values)| {
        let x = number(&case["at"][0]) * factor;
        list(values).iter().map(move |value| [x, number(value)])
    })
    .collect()
}

#[test]
fn a_diagram_of_the_file_is_that_of_its_figure() {
    let work = WorkDir::new();
    hysteresis(&work);
    let explorer = Explorer::new(&work, &["s.h5"]);
    let file = explorer.object("/api/file");
    assert_eq!(file["diagrams"][0]["name"], "omega");
    let kind = ["--kind", "bifurcation", "--x", "omega"];
    for (asked, more) in [
        ("", &[][..]),
        ("?colour-by=direction", &["--colour-by", "direction"][..]),
        ("?of=progression_speed", &["--of", "progression_speed"][..]),
        ("?limits-x=120,150", &["--limits", "omega=120 rad/s,150 rad/s"][..]),
    ] {
        let told = explorer.object(&format!("/api/diagram{asked}"));
        let drawn = data(&work, "s.h5", &[&kind[..], more].concat());
        let panels = list(&told["panels"]).len();
        assert_eq!(drawn.iter().map(|it| it.0).max(), Some(panels), "{asked}");
        let [low, high] = pair(&told["x"]["range"]);
        let is_seen = |at: &[f64; 2]| (low..=high).contains(&at[0]);
        for panel in 0..panels {
            let of = |series: &dyn Fn(&str) -> bool| -> Vec<[f64; 2]> {
                let ours = drawn.iter().filter(|it| it.0 == panel + 1 && series(&it.1));
                ours.map(|it| it.2).filter(is_seen).collect()
            };
            let mut all = 0;
            for (sort, told_as) in list(&told["sorts"]).iter().enumerate() {
                let name = told_as[0].as_str().expect("a name");
                let ours: Vec<[f64; 2]> =
                    points(&told, panel, sort).into_iter().filter(is_seen).collect();
                all += ours.len();
                assert_same(ours, of(&|it| it == name), &format!("{asked}, {panel}: {name}"));
            }
            assert!(all > 10, "{all}");
            for kind in ["stable", "unstable"] {
                let lines = list(&told["panels"][panel][kind]).iter().flat_map(list);
                let begins = format!("{kind} orbits");
                let drawn = of(&|it| it.starts_with(&begins));
                let ours: Vec<[f64; 2]> = lines.map(pair).filter(is_seen).collect();
                assert_same(ours, drawn, kind);
            }
            // Symbols of one kind that hide each other are drawn once.
            let words = list(&told["special"]).iter().chain(list(&told["panels"][panel]["events"]));
            let words = words.map(|it| it["words"].as_str().expect("words")).collect::<Vec<_>>();
            for (_, series, at) in drawn.iter().filter(|it| it.0 == panel + 1) {
                if !words.contains(&series.as_str()) {
                    continue;
                }
                let branches = list(&told["special"]).iter().flat_map(|it| {
                    let values = list(&it["values"][panel]).iter();
                    values.map(|value| (&it["words"], [number(&it["x"]), number(value)]))
                });
                let events = list(&told["panels"][panel]["events"]).iter();
                let mut all = branches.chain(events.map(|it| (&it["words"], pair(&it["at"]))));
                assert!(all.any(|it| it.0 == series && are_near(it.1, *at)), "{series} at {at:?}");
            }
        }
    }
}

#[test]
fn cases_and_special_points_are_told_as_the_file_has_them() {
    let work = WorkDir::new();
    hysteresis(&work);
    let file = store::read(&work.path("s.h5")).expect("results");
    let explorer = Explorer::new(&work, &["s.h5"]);
    let told = explorer.object("/api/diagram?colour-by=direction");
    let cases = list(&told["cases"]);
    let (omegas, periods) = (reals(&file, "omega"), reals(&file, "period"));
    let speeds = reals(&file, "progression_speed");
    let sweeps = cases.len() / omegas.len();
    assert_eq!((sweeps, cases.len()), (2, periods.len()));
    let panel = list(&told["panels"]).iter().position(|it| it["name"] == "progression_speed");
    let values = list(&told["panels"][panel.expect("a panel")]["values"]);
    for (number_of, case) in cases.iter().enumerate() {
        assert!(are_same(&[number(&case["at"][0])], &[omegas[number_of / 2]]));
        assert_eq!(case["sweep"], ["upward", "downward"][number_of % 2]);
        assert_eq!(case["period"].as_f64().unwrap_or(0.0), periods[number_of]);
        let shown = number(&values[number_of][0]);
        assert!((shown - 1e3 * speeds[number_of]).abs() < 1e-4, "{shown}");
    }
    // A click on a point of either sweep gives its own motion.
    let both = |it: &usize| periods[2 * it] > 0.0 && periods[2 * it + 1] > 0.0;
    let differ = |it: &usize| (speeds[2 * it] - speeds[2 * it + 1]).abs() > 1e-3;
    let apart = (0..omegas.len()).filter(both).find(differ);
    let apart = apart.expect("hysteresis");
    for (place, sweep) in ["upward", "downward"].iter().enumerate() {
        let omega = omegas[apart];
        let motion = explorer.object(&format!("/api/motion?omega={omega:?}&sweep={sweep}"));
        let speed = number(&motion["simulate"]["orbit"]["progression_speed"]);
        assert!((speed - speeds[2 * apart + place]).abs() < 1e-7, "{sweep}: {speed}");
    }
    // The special points of the branch, with their multipliers.
    let special = list(&told["special"]);
    let (at, real) = (reals(&file, "special_omega"), reals(&file, "special_multiplier_real"));
    assert!(!special.is_empty() && special.len() == at.len());
    let width = real.len() / at.len();
    for (row, it) in special.iter().enumerate() {
        assert!(are_same(&[number(&it["x"])], &at[row..=row]));
        let parts: Vec<f64> = list(&it["multipliers"]).iter().map(|it| number(&it[0])).collect();
        assert!(are_same(&parts, &real[row * width..row * width + parts.len()]));
        if it["words"] == "fold" {
            assert!(parts.iter().any(|it| (it - 1.0).abs() < 1e-3), "{parts:?}");
        }
    }
    let branches = list(&told["branches"]);
    assert_eq!(branches[0]["name"], "progression");
    let orbits: u64 = branches.iter().map(|it| it["orbits"].as_u64().expect("a count")).sum();
    assert_eq!(orbits as usize, reals(&file, "branch_omega").len());
}

fn reals(dataset: &Dataset, name: &str) -> Vec<f64> {
    let values = dataset.variable(name).or_else(|| dataset.coordinate(name));
    values.unwrap_or_else(|| panic!("{name}")).values.to_real().into_iter().collect()
}

#[test]
fn basins_of_the_file_have_their_attractors_saddles_and_manifolds() {
    let work = WorkDir::new();
    basins(&work);
    let file = store::read(&work.path("b.h5")).expect("results");
    let explorer = Explorer::new(&work, &["b.h5"]);
    let told = explorer.object("/api/stored-basin?x=start_r&y=start_y1");
    let drawn = data(&work, "b.h5", &["--kind", "basin", "--x", "start_r", "--y", "start_y1"]);
    let of = |series: &str| -> Vec<[f64; 2]> {
        let ours = drawn.iter().filter(|it| it.1 == series && it.2[0].is_finite());
        ours.map(|it| it.2).collect()
    };
    let places = |all: &Value| -> Vec<[f64; 2]> {
        list(all).iter().flat_map(|it| list(&it["points"])).map(pair).collect()
    };
    for (kind, series) in [
        ("attractors", "section points of the attractors"),
        ("saddles", "saddles on the boundary"),
        ("stable", "boundary as a curve"),
        ("unstable", "unstable manifolds of the saddles"),
    ] {
        let drawn = of(series);
        assert!(!drawn.is_empty(), "{series}");
        assert_same(places(&told[kind]), drawn, series);
    }
    let attractors = list(&told["attractors"]);
    let [shares, errors, cases] = ["attractor_share", "attractor_share_error", "attractor_case"]
        .map(|name| reals(&file, name));
    assert_eq!(attractors.len(), shares.len());
    let speed = list(&told["outputs"]).iter().position(|it| it["name"] == "progression_speed");
    for (place, it) in attractors.iter().enumerate() {
        assert!(are_same(&pair(&it["share"]), &[shares[place], errors[place]]));
        assert_eq!(it["case"].as_f64(), Some(cases[place]));
        let speeds = reals(&file, "attractor_progression_speed");
        let told = number(&it["outputs"][speed.expect("it is a key number")]);
        assert!(are_same(&[told], &speeds[place..=place]), "{told}");
        // The cells of the map have the same colour.
        assert_eq!(list(&it["colour"]).len(), 3);
    }
    let map = explorer.packed("/api/map?of=attractor&x=start_r&y=start_y1");
    let kinds = list(&map.head["key"]["kinds"]).iter().map(|it| &it[1]);
    let kinds: Vec<&Value> = kinds.collect();
    attractors.iter().for_each(|it| assert!(kinds.contains(&&it["colour"]), "{it}"));
    let saddle = &told["saddles"][0];
    assert_eq!([number(&saddle["between"][0]), number(&saddle["between"][1])], [0.0, 1.0]);
    let real = reals(&file, "edge_multiplier_real");
    let parts: Vec<f64> = list(&saddle["multipliers"]).iter().map(|it| number(&it[0])).collect();
    assert!(are_same(&parts, &real[..parts.len()]));
    assert!(parts.iter().any(|it| it.abs() > 1.0), "a saddle is not stable: {parts:?}");
    // Of a plane that has none of them it is refused.
    let refused = explorer.get("/api/stored-basin?x=start_r&y=omega");
    assert_eq!(refused.status, 400, "{}", refused.text());
}

/// What is seen goes into the figure that is saved.
#[test]
fn limits_go_into_saved_figures() {
    let work = WorkDir::new();
    basins(&work);
    let explorer = Explorer::new(&work, &["b.h5"]);
    let axes = "x=start_r&y=start_y1";
    let saved = |kind: &str| {
        let limits = "limits-x=-3,1.5&limits-y=-0.5,0.75";
        let answered = explorer.get(&format!("/api/figure?{kind}&{axes}&{limits}&format=svg"));
        assert_eq!(answered.status, 200, "{}", answered.text());
        answered.text()
    };
    let limits = ["--limits", "start_r=-3 mm,1.5 mm", "--limits", "start_y1=-0.5 m/s,0.75 m/s"];
    for (kind, of) in [("kind=map&of=attractor", "map"), ("kind=basin&stored=1", "basin")] {
        let of_map: &[&str] = if of == "map" { &["--of", "attractor"] } else { &[] };
        let figure = ["figure", "b.h5", "--kind", of, "--x", "start_r", "--y", "start_y1"];
        let place = ["--name", of, "--folder", ".", "--formats", "svg"];
        work.run(&[&figure[..], of_map, &limits, &place].concat()).done();
        let drawn = fs::read_to_string(work.path(&format!("{of}.svg"))).expect("written");
        // Their names differ, and with these the sum over their bytes.
        let body = |svg: &str| {
            let body = svg.split_once("<path").and_then(|it| it.1.split_once("<!--"));
            body.expect("a drawing").0.to_owned()
        };
        assert_eq!(body(&saved(kind)), body(&drawn), "{of}");
    }
    for wrong in ["limits-x=3,1", "limits-x=1", "limits-y=a,b", "limits-x=nan,1"] {
        let refused = explorer.get(&format!("/api/figure?kind=map&{axes}&{wrong}&format=svg"));
        assert_eq!(refused.status, 400, "{wrong}: {}", refused.text());
    }
}

#[test]
fn ramps_of_the_file_are_shown_without_cases_along_them() {
    let work = WorkDir::new();
    let ramp = "omega = \"155 rad/s\"\n[start]\ny1 = \"0.3 m/s\"\n[[ramps]]\nname = \"up\"\nalong = \"omega\"\n\
                from = \"150 rad/s\"\nto = \"172 rad/s\"\nrate = \"5 rad/s^2\"\n";
    work.put("r.toml", format!("{TWO_MOTIONS}{ramp}"));
    work.run(&["sweep", "r.toml", "--output", "r.h5", "--no-figures"]).done();
    work.run(&["continue", "r.toml", "--output", "r.h5", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["r.h5"]);
    assert_eq!(explorer.object("/api/file")["diagrams"][0]["name"], "omega");
    let told = explorer.object("/api/diagram?of=section_r,progression_speed");
    let asked = ["--kind", "bifurcation", "--x", "omega", "--of", "section_r,progression_speed"];
    let drawn = data(&work, "r.h5", &asked);
    let ramp = &told["ramps"][0];
    assert_eq!(ramp["name"], "up");
    for panel in 0..2 {
        let ours = list(&ramp["panels"][panel]).iter().map(pair).collect();
        let figure = drawn.iter().filter(|it| it.0 == panel + 1 && it.1 == "up").map(|it| it.2);
        assert_same(ours, figure.collect(), "ramp");
    }
    let jumps = drawn.iter().filter(|it| it.0 == 1 && it.1 == "up: jump").map(|it| it.2[0]);
    let jumps: Vec<f64> = jumps.collect();
    assert!(are_same(&list(&ramp["jumps"]).iter().map(number).collect::<Vec<_>>(), &jumps));
    assert!(!jumps.is_empty());
    for wrong in ["x=p_d", "x=", "of=nothing", "limits-x=1", "y=omega"] {
        let refused = explorer.get(&format!("/api/diagram?{wrong}"));
        let expected = if wrong == "x=" { 200 } else { 400 };
        assert_eq!(refused.status, expected, "{wrong}: {}", refused.text());
    }
}
