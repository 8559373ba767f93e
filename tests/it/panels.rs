//! Figures of several panels: a map for each of several values of other axes, and the maps of a trade-off.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use capsulemap::figure::{Format, draw};
use capsulemap::store::dataset::Dataset;
use capsulemap::study::{Drawing, DrawingKind, QuantitySettings};

use super::figure::fixtures::{Fixture, OUTCOMES, steps};
use super::figure::{drawing, folder, into};
use super::program::WorkDir;

/// Speeds over stiffness, gap, force and frequency, each plane of force and frequency another one.
fn four_parameters() -> Dataset {
    let axes = ["k2", "delta", "p_d", "omega"];
    Fixture::default()
        .coordinate("k2", "N/m", vec![1e3, 1e4, 1e5])
        .coordinate("delta", "m", vec![1e-3, 2e-3])
        .coordinate("p_d", "N", steps(1.0, 4.0, 4))
        .coordinate("omega", "rad/s", steps(10.0, 50.0, 5))
        .real("progression_speed", &axes, |at| {
            1e-3 * (at[0] * 7 + at[1] * 3 + at[2] + at[3]) as f64
        })
        .real("power", &axes, |at| 1e-3 * (1 + at[0] + at[1] + at[2] * at[3]) as f64)
        .integer("outcome", &axes, &OUTCOMES, |_| 0)
        .integer("period", &axes, &[], |at| 1 + at[0] as i64)
        .0
}

/// The images in a figure, in their order: of each panel, and of the colour bars.
fn images(dataset: &Dataset, request: &Drawing) -> (String, Vec<String>) {
    let place = folder("panels");
    let paths = draw(dataset, request, &into(&place, &[Format::Svg])).expect("a figure").paths;
    let svg = fs::read_to_string(&paths[0]).expect("a file");
    let each = svg.split("base64,").skip(1).map(|it| it.split('"').next().unwrap_or("").to_owned());
    let found = each.collect();
    (svg, found)
}

fn map(of: &str, panels: &[(&str, &[f64])], at: &[(&str, f64)]) -> Drawing {
    let panels = panels.iter().map(|(name, values)| (name.to_string(), values.to_vec()));
    Drawing {
        x: Some("omega".to_owned()),
        y: Some("p_d".to_owned()),
        of: vec![of.to_owned()],
        at: at.iter().map(|(name, value)| (name.to_string(), *value)).collect::<BTreeMap<_, _>>(),
        panels: panels.collect(),
        ..drawing("panels", DrawingKind::Map)
    }
}

#[test]
fn a_map_has_a_panel_for_each_of_several_values_and_one_scale_for_all() {
    let dataset = four_parameters();
    let both: [(&str, &[f64]); 2] = [("k2", &[1e3, 1e4, 1e5]), ("delta", &[1e-3, 2e-3])];
    let (_, found) = images(&dataset, &map("progression_speed", &both, &[]));
    // Six panels that differ, and one bar.
    assert_eq!(found.len(), 7);
    assert_eq!(found.iter().collect::<BTreeSet<_>>().len(), 7);
    // The panel of a value held at all others shows what the same panel does beside them.
    let rows: [(&str, &[f64]); 1] = [("delta", &[1e-3, 2e-3])];
    let (_, held) = images(&dataset, &map("progression_speed", &rows, &[("k2", 1e4)]));
    assert_eq!(held.len(), 3);
    // The kinds of all panels are in one list: each is of one period, and no panel has the colour of another.
    let (_, periods) = images(&dataset, &map("period", &both[..1], &[("delta", 1e-3)]));
    assert_eq!(periods.len(), 3);
    assert_eq!(periods.iter().collect::<BTreeSet<_>>().len(), 3);
    // What is taken for a value is said of each.
    let near: [(&str, &[f64]); 1] = [("k2", &[1.1e3, 1e4])];
    let request = map("progression_speed", &near, &[("delta", 1e-3)]);
    let notes = draw(&dataset, &request, &into(&folder("panels"), &[])).expect("a figure").notes;
    assert_eq!(notes, ["k2 = 1000 N/m is taken for 1100 N/m, the nearest"]);
    let twice = Drawing { x: Some("k2".to_owned()), ..request };
    let said = draw(&dataset, &twice, &into(&folder("panels"), &[])).expect_err("a fault");
    assert!(said.to_string().contains("`k2` is both drawn and held"), "{said}");
}

#[test]
fn the_maps_of_a_trade_off_show_the_fastest_motion_of_each_cell() {
    let dataset = four_parameters();
    let axes = [Some("omega".to_owned()), Some("p_d".to_owned())];
    let request = |of: &str| {
        let [x, y] = axes.clone();
        Drawing { x, y, of: vec![of.to_owned()], ..drawing("maps", DrawingKind::TradeOffMaps) }
    };
    let (svg, all) = images(&dataset, &request("power"));
    // Two maps, each with its bar.
    assert_eq!(all.len(), 4);
    let said = "over k2, delta, p_d, omega; in each cell over omega, p_d the fastest motion over k2, delta";
    assert!(svg.contains(said));
    // Here the fastest has the greatest stiffness and gap: the same cells as where these are held there.
    let at = BTreeMap::from([("k2".to_owned(), 1e5), ("delta".to_owned(), 2e-3)]);
    let (_, held) = images(&dataset, &Drawing { at, ..request("power") });
    assert_eq!(all, held);
}

#[test]
fn panels_that_cannot_be_drawn_are_refused_with_all_that_is_wrong() {
    let folder = WorkDir::new();
    let axis = |name: &str, unit: &str| {
        format!("[[axes]]\nname = \"{name}\"\nfrom = \"1 {unit}\"\nto = \"3 {unit}\"\npoints = 3\n")
    };
    let axes = [axis("k2", "kN/m"), axis("delta", "mm"), axis("p_d", "N"), axis("omega", "rad/s")];
    let refused = |figure: &str, parts: &[&str]| {
        let study = format!("{}[[figures]]\nname = \"it\"\n{figure}\n", axes.concat());
        folder.put("study.toml", study);
        folder.run(&["sweep", "study.toml", "--dry-run"]).refused(parts);
    };
    refused(
        "kind = \"trade-off\"\nat = { k2 = [\"1 kN/m\", \"2 kN/m\"] }",
        &["at.k2", "expected one value for this kind of figure"],
    );
    refused(
        "kind = \"map\"\nat = { k2 = [\"1 kN/m\", \"9 kN/m\"] }",
        &["at.k2[2]", "expected a value within the axis"],
    );
    refused("kind = \"map\"\nat = { k2 = [] }", &["0 panels"]);
    let three = "k2 = [\"1 kN/m\"], delta = [\"1 mm\"], p_d = [\"1 N\"]";
    refused(&format!("kind = \"map\"\nat = {{ {three} }}"), &["panels lie along 2 at most"]);
    let values = "\"1 kN/m\", ".repeat(17);
    refused(&format!("kind = \"map\"\nat = {{ k2 = [{values}] }}"), &["17 panels"]);
}

#[test]
fn a_contour_bounds_a_plateau_on_both_sides() {
    // Speeds of −1 on the left, of exactly 0 in the middle, of 1 mm/s on the right.
    let speed = |at: usize| match at {
        0..3 => -1e-3,
        3..7 => 0.0,
        _ => 1e-3,
    };
    let dataset = Fixture::default()
        .coordinate("p_d", "N", steps(1.0, 4.0, 4))
        .coordinate("omega", "rad/s", steps(10.0, 100.0, 10))
        .real("progression_speed", &["p_d", "omega"], |at| speed(at[1]))
        .integer("outcome", &["p_d", "omega"], &OUTCOMES, |_| 0)
        .0;
    let drawn = |level: f64| {
        let set = QuantitySettings { contours: vec![level], ..Default::default() };
        let settings = BTreeMap::from([("progression_speed".to_owned(), set)]);
        let request = Drawing { settings, ..map("progression_speed", &[], &[]) };
        images(&dataset, &request).0
    };
    // Each line has a light one below it.
    let lines = |svg: &str| svg.matches("stroke=\"#ffffff\"").count();
    assert_eq!(lines(&drawn(0.0)) - lines(&drawn(0.5e-3)), 1);
    assert_eq!(lines(&drawn(0.5e-3)), lines(&drawn(-0.5e-3)));
}
