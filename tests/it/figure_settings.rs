//! What is set of figures: limits, scales, units, words, colours, sizes, sweeps, and the data behind them.

use std::fs;

use capsulemap::figure::{Format, draw};
use capsulemap::store::dataset::Dataset;
use capsulemap::study::{
    ColourMap, Colouring, Drawing, DrawingKind, QuantitySettings, ScaleChoice, Settings, Sweep,
};

use super::figure::fixtures::{Fixture, OUTCOMES, steps, with_history};
use super::figure::{by_work, drawing, folder, into};

/// A figure with its text as text, and the data behind it.
pub fn drawn(dataset: &Dataset, request: &Drawing) -> (String, String) {
    let request = Drawing { svg_text: true, data: true, ..request.clone() };
    // A folder of its own: the figures of all tests here have one name.
    let folder = tempfile::tempdir().expect("a folder");
    let files = draw(dataset, &request, &into(folder.path(), &[Format::Svg])).expect("drawn");
    let [svg, csv] = [0, 1].map(|at| fs::read_to_string(&files.paths[at]).expect("a file"));
    (svg, csv)
}

/// What a request is told when it is drawn.
fn notes(dataset: &Dataset, request: &Drawing) -> Vec<String> {
    draw(dataset, request, &into(&folder("settings"), &[])).expect("a figure").notes
}

fn refused(dataset: &Dataset, request: &Drawing) -> String {
    let place = folder("settings");
    draw(dataset, request, &into(&place, &[])).expect_err("a fault").to_string()
}

pub fn settings(of: &[(&str, QuantitySettings)]) -> Settings {
    of.iter().map(|(name, set)| (name.to_string(), set.clone())).collect()
}

/// The labels of a figure.
pub fn labels(svg: &str) -> Vec<String> {
    let label = |text: &str| {
        let mut plain = String::new();
        let inside = text.split_once('>').and_then(|it| it.1.split_once("</text>"));
        for part in inside.expect("a label").0.split('<') {
            plain.push_str(part.split_once('>').map_or(part, |it| it.1));
        }
        plain.replace('\u{a0}', " ")
    };
    svg.split("<text ").skip(1).map(label).collect()
}

/// The number after `key` in a shape.
pub fn number(shape: &str, key: &str) -> f64 {
    let rest = shape.split_once(&format!(" {key}=\"")).expect("an attribute").1;
    rest.split('"').next().and_then(|it| it.parse().ok()).expect("a number")
}

/// The places of the discs of a figure.
fn discs(svg: &str) -> Vec<(f64, f64)> {
    let shapes = svg.split("<circle").skip(1);
    shapes.map(|it| (number(it, "cx"), number(it, "cy"))).collect()
}

/// Speeds over six frequencies.
pub fn speeds(of: [f64; 6]) -> Dataset {
    Fixture::default()
        .coordinate("omega", "rad/s", steps(10.0, 60.0, 6))
        .real("progression_speed", &["omega"], |at| of[at[0]])
        .integer("outcome", &["omega"], &OUTCOMES, |_| 0)
        .0
}

pub fn diagram(set: &[(&str, QuantitySettings)]) -> Drawing {
    let of = vec!["progression_speed".to_owned()];
    Drawing { of, settings: settings(set), ..drawing("it", DrawingKind::Bifurcation) }
}

#[test]
fn points_stand_where_the_scale_that_is_set_has_them() {
    let values = [1e-4, -2e-3, 3e-2, 0.5, -0.7, 0.9];
    let dataset = speeds(values);
    // asinh(v/w) in another form.
    let symmetric = |value: f64| (value / 1e-3 + ((value / 1e-3).powi(2) + 1.0).sqrt()).ln();
    for scale in [ScaleChoice::Linear, ScaleChoice::Symlog(Some(1e-3))] {
        let place =
            |value: f64| if scale == ScaleChoice::Linear { value } else { symmetric(value) };
        let set = QuantitySettings { scale: Some(scale), ..Default::default() };
        let (svg, _) = drawn(&dataset, &diagram(&[("progression_speed", set)]));
        let found = discs(&svg);
        assert_eq!(found.len(), 6, "{scale:?}");
        // The page has 100 places in a point.
        let per = (found[5].1 - found[0].1) / (place(values[5]) - place(values[0]));
        for (at, value) in found.iter().zip(values) {
            let expected = found[0].1 + per * (place(value) - place(values[0]));
            assert!((at.1 - expected).abs() < 2.0, "{scale:?} {value} {at:?} {expected}");
        }
    }
    // On a logarithmic axis those above zero stand alone, and the others are told.
    let set = QuantitySettings { scale: Some(ScaleChoice::Log), ..Default::default() };
    let request = diagram(&[("progression_speed", set)]);
    let found = discs(&drawn(&dataset, &request).0);
    assert_eq!(found.len(), 4);
    let decades = |from: usize, to: usize| (found[to].1 - found[from].1).abs();
    let expected = (3e-2f64 / 1e-4).log10() / (0.9f64 / 0.5).log10();
    assert!((decades(0, 1) / decades(2, 3) / expected - 1.0).abs() < 0.01);
    let told = "2 values of progression_speed are not above zero and have no place on its logarithmic scale";
    assert_eq!(notes(&dataset, &request), [told]);
}

#[test]
fn limits_units_labels_and_decimals_are_those_that_are_set() {
    let dataset = speeds([1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3]);
    let omega = QuantitySettings {
        limits: Some([20.0, 45.0]),
        unit: Some("Hz"),
        decimals: Some(2),
        ..Default::default()
    };
    let speed = QuantitySettings {
        label: Some("Mean $v_x$".to_owned()),
        limits: Some([-0.01, 0.02]),
        ..Default::default()
    };
    let request = diagram(&[("omega", omega), ("progression_speed", speed)]);
    let request = Drawing { title: Some("Drive $\\omega_{1}^2$ at 5".to_owned()), ..request };
    let (svg, csv) = drawn(&dataset, &request);
    // Of the frequencies 10, 20, …, 60 rad/s three lie within the limits.
    assert_eq!(discs(&svg).len(), 3);
    let labels = labels(&svg);
    assert!(labels.contains(&"Frequency ω/2π (Hz)".to_owned()), "{labels:?}");
    assert!(labels.contains(&"Mean vx (mm/s)".to_owned()), "{labels:?}");
    assert!(labels.contains(&"Drive ω12 at 5".to_owned()), "{labels:?}");
    let numbers: Vec<f64> =
        labels.iter().filter(|it| it.contains('.')).flat_map(|it| it.parse()).collect();
    let ends = [20.0, 45.0].map(|omega| omega / std::f64::consts::TAU);
    assert!(numbers.len() > 2, "{labels:?}");
    assert!(numbers.iter().all(|it| *it >= ends[0] && *it <= ends[1]), "{numbers:?}");
    let decimals =
        |it: &&String| it.contains('.') && it.split('.').nth(1).is_some_and(|it| it.len() == 2);
    assert_eq!(labels.iter().filter(decimals).count(), numbers.len());
    // All data are behind it, in the units of the axes.
    let rows: Vec<Vec<&str>> =
        csv.lines().filter(|it| it.starts_with("1,")).map(|it| it.split(',').collect()).collect();
    assert_eq!(rows.len(), 6);
    for (number, row) in rows.iter().enumerate() {
        let [x, y] = [2, 3].map(|at| row[at].parse::<f64>().expect("a number"));
        let omega = 10.0 * (number + 1) as f64;
        assert!((x * std::f64::consts::TAU / omega - 1.0).abs() < 1e-12, "{row:?}");
        assert!((y - (number + 1) as f64).abs() < 1e-12, "{row:?}");
    }
    assert!(csv.contains("# panel 1: x is Frequency ω/2π (Hz), y is Mean vx (mm/s)\n"), "{csv}");
}

#[test]
fn frequencies_are_shown_relative_to_the_natural_one_where_it_is_the_same_for_all() {
    let natural = QuantitySettings { unit: Some("sqrt(k1/m1)"), ..Default::default() };
    let fixture = || Fixture(speeds([1e-3; 6])).real("m1", &[], |_| 0.5);
    let dataset = fixture().real("k1", &[], |_| 200.0).0;
    let (_, csv) = drawn(&dataset, &diagram(&[("omega", natural.clone())]));
    // sqrt(200/0.5) = 20 rad/s.
    assert!(csv.contains("\n1,cases,0.5,1,\n1,cases,1,1,\n"), "{csv}");
    assert!(csv.contains("x is Frequency ω/√(k1/m1), y"), "{csv}");
    let varied = fixture().coordinate("k1", "N/m", vec![100.0, 200.0]).0;
    let said = refused(&varied, &diagram(&[("omega", natural)]));
    assert!(
        said.contains("`unit` of omega: sqrt(k1/m1) needs k1 and m1 that do not vary"),
        "{said}"
    );
}

#[test]
fn what_is_set_and_has_no_effect_is_told() {
    let limits = QuantitySettings { limits: Some([0.0, 1.0]), ..Default::default() };
    let centre = QuantitySettings { centre: Some(0.0), ..Default::default() };
    let request = diagram(&[("delta", limits), ("progression_speed", centre)]);
    let told = [
        "`limits` of delta has no effect here",
        "`centre` of progression_speed has no effect here",
    ];
    assert_eq!(notes(&speeds([1e-3; 6]), &request), told);
    let log = QuantitySettings { scale: Some(ScaleChoice::Log), ..Default::default() };
    let dataset = Fixture::default()
        .coordinate("start_y1", "m/s", steps(-1.0, 1.0, 5))
        .real("progression_speed", &["start_y1"], |_| 1.0)
        .0;
    let said = refused(&dataset, &diagram(&[("start_y1", log)]));
    assert!(said.contains("`scale` of start_y1: its axis is not above zero"), "{said}");
}

/// Speeds and periods over a plane, those of the downward sweep larger.
pub fn both_sweeps() -> Dataset {
    let axes = ["p_d", "omega", "direction"];
    Fixture::default()
        .coordinate("p_d", "N", steps(1.0, 4.0, 4))
        .coordinate("omega", "rad/s", steps(10.0, 50.0, 5))
        .directions()
        .real("progression_speed", &axes, |at| 1e-3 * (at[0] + 10 * at[1] * (1 + at[2])) as f64)
        .integer("outcome", &axes, &OUTCOMES, |at| if at[..2] == [0, 0] { 4 } else { 0 })
        .integer("period", &axes, &[], |at| 1 + ((at[0] + at[2]) % 2) as i64)
        .0
}

#[test]
fn a_map_shows_either_sweep_and_their_difference() {
    let dataset = both_sweeps();
    let map = |of: &str, sweep: Sweep| {
        let (of, sweep) = (vec![of.to_owned()], Some(sweep));
        let [x, y] = ["omega", "p_d"].map(|it| Some(it.to_owned()));
        Drawing { of, x, y, sweep, ..drawing("sweeps", DrawingKind::Map) }
    };
    let values = |sweep: Sweep| -> Vec<String> {
        let (_, csv) = drawn(&dataset, &map("progression_speed", sweep));
        let rows = csv.lines().filter(|it| it.starts_with("1,"));
        rows.map(|it| it.rsplit(',').next().unwrap_or("").to_owned()).collect()
    };
    for (sweep, factor) in [(Sweep::Upward, 1), (Sweep::Downward, 2)] {
        let expected = |cell: usize| (cell / 5 + 10 * factor * (cell % 5)) as f64;
        let found = values(sweep);
        assert_eq!(found.len(), 20);
        // The case that failed has no speed.
        assert_eq!(found[0], "");
        let is_right = |cell: usize| {
            found[cell].parse::<f64>().is_ok_and(|it| (it - expected(cell)).abs() < 1e-9)
        };
        assert!((1..20).all(is_right), "{sweep:?} {found:?}");
    }
    let difference: Vec<f64> =
        values(Sweep::Difference)[1..].iter().flat_map(|it| it.parse()).collect();
    assert_eq!(difference.len(), 19);
    let expected = |cell: usize| 10.0 * ((cell + 1) % 5) as f64;
    assert!((0..19).all(|cell| (difference[cell] - expected(cell)).abs() < 1e-9), "{difference:?}");
    let (svg, _) = drawn(&dataset, &map("progression_speed", Sweep::Difference));
    // The name may be broken into lines.
    let name = labels(&svg).concat().replace(' ', "");
    assert!(name.contains("Progressionspeed,downward−upward(mm/s)"), "{name}");
    // Every period is another one.
    let (_, csv) = drawn(&dataset, &map("period", Sweep::Difference));
    assert_eq!(csv.matches(",different\n").count(), 19, "{csv}");
    let upward_only = Fixture(dataset.clone());
    let mut upward_only = upward_only.0;
    upward_only.coordinates.retain(|(name, _)| name != "direction");
    let said = refused(&upward_only, &map("period", Sweep::Downward));
    assert!(said.contains("`sweep`: these results have no sweep downward"), "{said}");
    let wrong = Drawing { sweep: Some(Sweep::Difference), ..diagram(&[]) };
    assert!(refused(&dataset, &wrong).contains("only a map shows the difference"));
}

#[test]
fn points_have_the_colours_of_their_periods() {
    let dataset = Fixture(speeds([1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3]))
        .integer("period", &["omega"], &[], |at| [1, 1, 2, 4, 2, 1][at[0]])
        .0;
    let request = Drawing { colour_by: Some("period".to_owned()), ..diagram(&[]) };
    let (svg, _) = drawn(&dataset, &request);
    let fill = |shape: &str| shape.split_once("fill=\"").map(|it| it.1[..7].to_owned());
    let colours: Vec<String> = svg.split("<circle").skip(1).flat_map(fill).collect();
    assert_eq!(colours.len(), 6);
    let same = |a: usize, b: usize| colours[a] == colours[b];
    assert!(same(0, 1) && same(0, 5) && same(2, 4) && !same(0, 2) && !same(0, 3) && !same(2, 3));
    // The list has the periods that occur, and no scale of numbers between them.
    let labels = labels(&svg);
    let at = labels.iter().position(|it| it == "Period").expect("a heading");
    assert_eq!(labels[at + 1..at + 4], ["1", "2", "4"]);
    let none = Drawing { colour_by: Some("attractor".to_owned()), ..diagram(&[]) };
    assert!(refused(&dataset, &none).contains("the results tell no attractors"));
    let map = Drawing { colour_by: Some("period".to_owned()), ..drawing("m", DrawingKind::Map) };
    assert!(refused(&both_sweeps(), &map).contains("`colour_by` does not go with a map"));
}

#[test]
fn pages_have_the_size_that_is_set() {
    let dataset = both_sweeps();
    let map = Drawing {
        width_mm: Some(86.0),
        height_mm: Some(60.0),
        dpi: Some(100.0),
        sweep: Some(Sweep::Upward),
        ..drawing("sized", DrawingKind::Map)
    };
    let (svg, _) = drawn(&dataset, &map);
    let size = |svg: &str| {
        ["width", "height"].map(|key| {
            let text = svg.split_once(&format!(" {key}=\"")).expect("a size").1;
            text.split_once("pt").and_then(|it| it.0.parse::<f64>().ok()).expect("points") / 72.0
                * 25.4
        })
    };
    let [width, height] = size(&svg);
    assert!((width - 86.0).abs() < 0.01 && (height - 60.0).abs() < 0.01, "{width} {height}");
    let place = folder("settings");
    let png = draw(&dataset, &map, &into(&place, &[Format::Png])).expect("drawn").paths;
    let bytes = fs::read(&png[0]).expect("a file");
    let pixels = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four"));
    // 86 mm and 60 mm at 100 dots per inch.
    assert!(pixels(16).abs_diff(339) <= 1 && pixels(20).abs_diff(236) <= 1);
    // Without a height set, the page is another.
    assert!(
        (size(&drawn(&dataset, &Drawing { height_mm: None, ..map.clone() }).0)[1] - 60.0).abs()
            > 2.0
    );
    let of = ["progression_speed"; 9].map(str::to_owned).to_vec();
    let low = Drawing { of, height_mm: Some(60.0), ..drawing("low", DrawingKind::Bifurcation) };
    assert!(refused(&dataset, &low).contains("its panels need a height of"));
    for wrong in [
        Drawing { height_mm: Some(5.0), ..map.clone() },
        Drawing { dpi: Some(5e4), ..map.clone() },
        Drawing { marker_mm: Some(0.0), ..map.clone() },
    ] {
        assert!(refused(&dataset, &wrong).contains("is not within"));
    }
}

#[test]
fn a_legend_goes_on_request_and_what_is_left_out_is_still_told() {
    let dataset = both_sweeps();
    let request =
        Drawing { of: vec!["progression_speed".into()], ..drawing("l", DrawingKind::Bifurcation) };
    let words = |request: &Drawing| labels(&drawn(&dataset, request).0).concat();
    assert!(words(&request).contains("upward"));
    assert!(!words(&Drawing { legend: false, ..request.clone() }).contains("upward"));
    let trade_off = Fixture(speeds([1e-3, 2e-3, f64::NAN, 4e-3, 5e-3, 6e-3]))
        .real("work_positive", &["omega"], |at| at[0] as f64 + 1.0)
        .0;
    let request = Drawing { legend: false, ..by_work("t") };
    let words = labels(&drawn(&trade_off, &request).0).concat();
    assert!(words.contains("without values, left out: 1") && !words.contains("Pareto"), "{words}");
}

#[test]
fn colours_have_the_range_and_the_centre_that_are_set() {
    let dataset = both_sweeps();
    let images = |set: QuantitySettings| {
        let request = Drawing {
            sweep: Some(Sweep::Upward),
            settings: settings(&[("progression_speed", set)]),
            ..drawing("colours", DrawingKind::Map)
        };
        let (svg, _) = drawn(&dataset, &request);
        (svg.matches("<polygon").count(), svg)
    };
    let map = |map: ColourMap, reversed: bool| Some(Colouring { map, reversed });
    let plain = images(QuantitySettings::default());
    // Arrows at the ends of the bar tell that there are values beyond them.
    assert_eq!(plain.0, 0);
    for (limits, arrows) in [([0.01, 0.02], 2), ([-1.0, 0.02], 1), ([-1.0, 1.0], 0)] {
        let set = QuantitySettings { limits: Some(limits), ..Default::default() };
        assert_eq!(images(set).0, arrows, "{limits:?}");
    }
    let all = [
        QuantitySettings { colour_map: map(ColourMap::Cividis, false), ..Default::default() },
        QuantitySettings { colour_map: map(ColourMap::Cividis, true), ..Default::default() },
        QuantitySettings { centre: Some(0.02), ..Default::default() },
        QuantitySettings { contours: vec![0.015, 0.025], ..Default::default() },
    ];
    let found: Vec<String> = all.into_iter().map(|set| images(set).1).chain([plain.1]).collect();
    let different = |a: usize| (0..a).all(|b| found[a] != found[b]);
    assert!((0..found.len()).all(different));
    // Each contour has its own entry and its own dashes.
    let words = labels(&found[3]).concat();
    assert!(words.contains("15 mm/s") && words.contains("25 mm/s"), "{words}");
}

#[test]
fn marks_that_are_hidden_are_neither_drawn_nor_explained() {
    let fixture = Fixture::default().real("omega", &[], |_| 20.0);
    let dataset = with_history(fixture, &[], 2.0, 300).0;
    let portrait = |hide: &[&str]| {
        let hide = hide.iter().map(|it| (*it).to_owned()).collect();
        Drawing { hide, ..drawing("p", DrawingKind::PhasePortrait) }
    };
    let (all, csv) = drawn(&dataset, &portrait(&[]));
    assert!(csv.contains("\n1,impact,") && csv.contains("\n1,stroboscopic,"));
    for (mark, words) in
        [("impacts", "impact"), ("stroboscopic", "stroboscopic"), ("contact", "contact, from δ")]
    {
        assert!(labels(&all).contains(&words.to_owned()), "{mark}");
        let (svg, csv) = drawn(&dataset, &portrait(&[mark]));
        assert!(!labels(&svg).contains(&words.to_owned()), "{mark}");
        assert!(!csv.contains(&format!("\n1,{words},")), "{mark}");
    }
    let said = refused(&dataset, &portrait(&["saddles"]));
    assert!(
        said.contains("`hide`: a phase-portrait has no mark saddles (it has: strobo"),
        "{said}"
    );
    // Without fronts and optima the motions alone are left of a trade-off.
    let dataset = Fixture(speeds([1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3]))
        .real("work_positive", &["omega"], |at| at[0] as f64 + 1.0)
        .0;
    let hide = ["fronts", "optima"].map(str::to_owned).to_vec();
    let request = Drawing { hide, ..by_work("t") };
    let words = labels(&drawn(&dataset, &request).0).concat();
    assert!(!words.contains("Pareto") && !words.contains("knee"), "{words}");
}
