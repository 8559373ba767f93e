//! Clicks on the page of `capsulemap explore`: a motion that does not repeat is drawn before it is judged, and all is told as before.

use capsulemap::store;
use serde_json::Value;

use super::explorer::{Explorer, coarse_overview};
use super::program::WorkDir;

/// The parts of an answer as one, the later over the earlier.
fn merged(parts: &[Value]) -> Value {
    let mut whole = serde_json::Map::new();
    for part in parts {
        let fields = part.as_object().expect("an object").iter();
        // What was sent is not sent again.
        let fields = fields.filter(|(name, value)| !(*name == "history" && value.is_null()));
        whole.extend(fields.map(|(name, value)| (name.clone(), value.clone())));
    }
    Value::Object(whole)
}

#[test]
fn a_click_is_told_in_parts_that_are_the_motion() {
    let work = WorkDir::new();
    work.put("map.toml", coarse_overview([5, 15]));
    work.run(&["sweep", "map.toml", "--output", "map.h5", "--no-figures"]).done();
    let file = store::read(&work.path("map.h5")).expect("results");
    let numbers = |name: &str| -> Vec<f64> {
        let values = file.variable(name).or_else(|| file.coordinate(name)).expect("it is there");
        values.values.to_real().into_iter().collect()
    };
    let (forces, frequencies, outcomes) = (numbers("p_d"), numbers("omega"), numbers("outcome"));
    let explorer = Explorer::new(&work, &["map.h5"]);
    let mut seen = [0; 2];
    // The numbers of the file are read for all cases after the first click: it and those after it tell the same.
    for (case, outcome) in outcomes.iter().enumerate().chain(outcomes.iter().enumerate()) {
        // Periodic is 0, chaotic 1.
        let kind = *outcome as usize;
        if kind > 1 || seen[kind] >= 6 {
            continue;
        }
        seen[kind] += 1;
        let (p_d, omega) =
            (forces[case / frequencies.len()], frequencies[case % frequencies.len()]);
        let asked = format!("p_d={p_d:?}&omega={omega:?}&cycles=3");
        let parts = explorer.lines(&format!("/api/click?{asked}"));
        assert_eq!(parts.len(), 1 + kind, "case {case}");
        let whole = explorer.object(&format!("/api/motion?{asked}"));
        // Not printed where it fails: it is long.
        assert!(merged(&parts) == whole, "case {case}");
        assert!(parts[0]["history"]["t"].as_array().expect("times").len() > 100);
    }
    assert!(seen.iter().all(|count| *count >= 2), "{seen:?}");
    let refused = explorer.get("/api/click?p_d=nan&omega=60");
    assert_eq!(refused.status, 400, "{}", refused.text());
}

/// Sobol indices are those of `capsulemap sensitivity`.
#[test]
fn indices_are_those_of_the_command() {
    let work = WorkDir::new();
    let axes = "[[axes]]\nname = \"omega\"\nfrom = \"70 rad/s\"\nto = \"86 rad/s\"\n\
                [[axes]]\nname = \"p_d\"\nfrom = \"3.5 N\"\nto = \"4.5 N\"\n";
    let capsule = "[parameters]\nk2 = \"2.42 kN/m\"\ndelta = \"3.5 mm\"\n";
    let study = format!("{capsule}[draws]\nkind = \"saltelli\"\nbase_samples = 16\n{axes}");
    work.put("s.toml", study);
    work.run(&["sweep", "s.toml", "--output", "s.h5", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["s.h5"]);
    assert_eq!(explorer.object("/api/file")["is_design"], true);
    let told = explorer.object("/api/sensitivity");
    let text = work.run(&["sensitivity", "s.h5", "--of", "progression_speed", "--csv"]).done().out;
    let outputs = told["outputs"].as_array().expect("a list");
    let speed = outputs.iter().find(|it| it["name"] == "progression_speed").expect("the speed");
    assert_eq!(speed["rows"], 16);
    let cells: Vec<f64> = text.split([',', '\n']).filter_map(|it| it.trim().parse().ok()).collect();
    let mut found = 0;
    for kind in ["first", "total"] {
        for index in speed[kind].as_array().expect("indices") {
            for part in index.as_array().expect("a value and half a width") {
                let part = part.as_f64().expect("a number");
                let is_told = cells.iter().any(|it| (it - part).abs() <= 1e-9 * part.abs());
                assert!(is_told, "{part} in {text}");
                found += 1;
            }
        }
    }
    assert_eq!(found, 8);
}
