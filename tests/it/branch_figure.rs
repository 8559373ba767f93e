//! Figures of branches: what they show, where, and what they leave out.

use std::collections::BTreeMap;
use std::fs;

use capsulemap::figure::{Format, draw};
use capsulemap::run::Continued;
use capsulemap::store::{self, Dataset};
use capsulemap::study::{Drawing, DrawingKind, Study};

use super::continuation::fixtures::{STUDY, branches_alone, continued, found, with_branches};
use super::figure::fixtures::Fixture;
use super::figure::{drawing, folder, into};
use super::program::FIG5;

const ALL: [Format; 3] = [Format::Png, Format::Svg, Format::Pdf];

/// A diagram at the drive of the first branch.
fn diagram(name: &str) -> Drawing {
    let at = BTreeMap::from([("p_d".to_owned(), 4.0)]);
    Drawing { at, ..drawing(name, DrawingKind::Bifurcation) }
}

/// The SVG of a figure, without the name that stands in it and the mark at its end.
fn svg(dataset: &Dataset, request: &Drawing) -> String {
    let files = draw(dataset, request, &into(&folder("branches"), &[Format::Svg]))
        .unwrap_or_else(|error| panic!("{error}"));
    let svg = fs::read_to_string(&files.paths[0]).expect("a figure");
    let (shown, _mark) = svg.trim_end().rsplit_once('\n').expect("several lines");
    shown.replace(&request.name, "")
}

/// `STUDY` with branches, and cases that settle to the stable orbits of the first.
fn swept() -> Dataset {
    let study = Study::parse("a", &STUDY.replace("points = 8", "points = 281")).expect("a study");
    let orbits = found().branches.remove(0).points;
    let height = move |place: usize, point: usize| {
        let omega = 110.0 + 0.25 * place as f64;
        let near = orbits.iter().filter(|orbit| {
            orbit.multipliers[0].re < 1.0 && (orbit.parameter - omega).abs() < 0.13
        });
        let near: Vec<f64> = near.map(|orbit| orbit.section[0][0]).collect();
        near.get((place + point) % near.len().max(1)).copied().unwrap_or(f64::NAN)
    };
    let speed = height.clone();
    let fixture = Fixture(with_branches(store::frame(&study), &study, &continued()));
    fixture
        .coordinate("point", "1", vec![0.0])
        .real("section_r", &["omega", "p_d", "point"], move |i| height(i[0], i[2]))
        .real("progression_speed", &["omega", "p_d"], move |i| speed(i[0], 0))
        .0
}

#[test]
fn branches_are_drawn_over_what_was_swept() {
    let swept = swept();
    let of = ["section_r", "progression_speed"].map(String::from).to_vec();
    draw(&swept, &diagram("overlay"), &into(&folder("branches"), &ALL)).expect("a figure");
    let wide = Drawing {
        title: Some("Continued and swept".into()),
        width_mm: Some(180.0),
        ..diagram("overlay-wide")
    };
    draw(&swept, &wide, &into(&folder("branches"), &ALL)).expect("a figure");
    let with = svg(&swept, &Drawing { of: of.clone(), ..diagram("with") });
    let without = svg(&swept, &Drawing { branches: false, of, ..diagram("without") });
    assert!(with.contains("stroke-dasharray") && !without.contains("stroke-dasharray"));
    let mut bare = swept;
    let lone = store::frame(&Study::parse("a", STUDY).expect("a study"));
    bare.coordinates.retain(|(name, _)| lone.coordinate(name).is_some() || name == "point");
    let prefixes = ["branch", "special", "request", "index", "curve"];
    bare.variables.retain(|name, _| !prefixes.iter().any(|prefix| name.starts_with(prefix)));
    assert_eq!(svg(&bare, &diagram("bare")), without);
}

#[test]
fn branches_alone_make_a_diagram() {
    let alone = branches_alone();
    let of = ["section_r", "section_y1", "work_net", "period"].map(String::from).to_vec();
    let every = Drawing { of, ..diagram("alone") };
    draw(&alone, &every, &into(&folder("branches"), &ALL)).expect("a figure");
    // Where the study has no axis, too.
    let text = format!(
        "{FIG5}[[branches]]\nname = \"a\"\nalong = \"p_d\"\nfrom = \"1 N\"\nto = \"5 N\"\n"
    );
    let study = Study::parse("a", &text).expect("a study");
    let second: Vec<Continued> = continued().drain(1..2).collect();
    let dataset = with_branches(store::frame(&study), &study, &second);
    let request = drawing("no-axis", DrawingKind::Bifurcation);
    assert!(svg(&dataset, &request).contains("progression_speed over p_d"));
    let wrong = Drawing { x: Some("omega".into()), ..request };
    let said = draw(&dataset, &wrong, &into(&folder("branches"), &[])).expect_err("no such axis");
    assert!(said.to_string().contains("`omega` is not an axis"), "{said}");
}

#[test]
fn branches_that_lie_elsewhere_are_left_out() {
    let alone = branches_alone();
    let nothing = |request: Drawing| !svg(&alone, &request).contains("stroke-dasharray");
    assert!(!nothing(diagram("here")));
    let at = BTreeMap::from([("p_d".to_owned(), 2.0)]);
    let elsewhere = Drawing { at, ..diagram("elsewhere") };
    let notes = |request: &Drawing| {
        draw(&alone, request, &into(&folder("branches"), &[])).expect("a figure").notes
    };
    assert_eq!(notes(&elsewhere), ["2 of 2 branches lie at other values"]);
    assert_eq!(notes(&diagram("here")), Vec::<String>::new());
    assert!(nothing(elsewhere));
    // Along the other axis lies the other branch, at one of the frequencies.
    let along = |omega: f64| {
        let at = BTreeMap::from([("omega".to_owned(), omega)]);
        notes(&Drawing { x: Some("p_d".into()), at, ..diagram("other") })
    };
    assert_eq!(along(120.0), Vec::<String>::new());
    assert_eq!(along(150.0), ["1 of 1 branches lie at other values"]);
}

#[test]
fn the_cycles_of_an_orbit_may_begin_anywhere() {
    let study = Study::parse("a", STUDY).expect("a study");
    let mut straight = found();
    for (step, point) in straight.branches[1].points.iter_mut().enumerate() {
        point.section.rotate_right(usize::from(step % 7 == 3));
    }
    let apart =
        |point: &capsulemap::capsule::branch::Point| point.section[0][0] - point.section[1][0];
    assert!(straight.branches[1].points.iter().all(|point| apart(point) >= 0.0));
    let mut others = continued();
    assert_ne!(others[0], Ok(straight.clone()));
    others[0] = Ok(straight);
    let straight = with_branches(store::frame(&study), &study, &others);
    assert_eq!(svg(&straight, &diagram("straight")), svg(&branches_alone(), &diagram("turned")));
}

#[test]
fn curves_lie_over_two_parameters() {
    let alone = branches_alone();
    let request = drawing("curves", DrawingKind::Curves);
    draw(&alone, &request, &into(&folder("branches"), &ALL)).expect("a figure");
    assert!(svg(&alone, &request).contains("grazing, neimark-sacker, period-doubling, fold over"));
    let turned = Drawing { x: Some("p_d".into()), y: Some("omega".into()), ..request.clone() };
    assert!(svg(&alone, &turned).contains("fold over p_d, omega"));
    assert_ne!(svg(&alone, &request), svg(&alone, &turned));
    let study = Study::parse("a", STUDY).expect("a study");
    let said = draw(&store::frame(&study), &request, &into(&folder("branches"), &[]));
    let said = said.expect_err("there are no curves").to_string();
    assert!(said.contains("no curves in two parameters"), "{said}");
    // A second parameter that no branch varies, beside the columns that say what the curves are.
    let (first, rest) = STUDY.split_once("[[branches]]\nname = \"in amplitude\"").expect("two");
    let figures = rest.find("[[figures]]").expect("figures");
    let lone = Study::parse("a", &format!("{first}{}", &rest[figures..])).expect("a study");
    let lone = with_branches(store::frame(&lone), &lone, &continued()[..1]);
    assert!(svg(&lone, &drawing("lone", DrawingKind::Curves)).contains("fold over omega, p_d"));
    // Every special point that a curve goes through is marked on it.
    let mut unmarked = continued();
    if let Ok(found) = &mut unmarked[0] {
        found.branches[0].special.last_mut().expect("one").curve = None;
    }
    let unmarked = with_branches(store::frame(&study), &study, &unmarked);
    assert!(svg(&unmarked, &request).len() < svg(&alone, &request).len());
    // So is every point of codimension 2, and neither is where they are hidden.
    let mut smooth = continued();
    if let Ok(found) = &mut smooth[0] {
        found.curves[0].codim2.clear();
    }
    let smooth = with_branches(store::frame(&study), &study, &smooth);
    assert!(svg(&smooth, &request).len() + 1000 < svg(&alone, &request).len());
    let hidden = Drawing { hide: vec!["special-points".to_owned()], ..request.clone() };
    assert_eq!(svg(&smooth, &hidden), svg(&alone, &hidden));
    let mut doubled = continued();
    if let Ok(found) = &mut doubled[0] {
        found.curves[1].period = 2;
    }
    let doubled = with_branches(store::frame(&study), &study, &doubled);
    let request = drawing("curves-doubled", DrawingKind::Curves);
    draw(&doubled, &request, &into(&folder("branches"), &ALL)).expect("a figure");
}

#[test]
fn curves_lie_over_a_map_of_their_parameters() {
    let map = |curves: bool| {
        let [x, y] = ["omega", "p_d"].map(|name| Some(name.to_owned()));
        let of = vec!["progression_speed".to_owned()];
        Drawing { of, x, y, curves, ..drawing("over", DrawingKind::Map) }
    };
    let swept = swept();
    let (plain, with_curves) = (svg(&swept, &map(false)), svg(&swept, &map(true)));
    assert!(with_curves.len() > plain.len() + 1000);
    let notes = |dataset: &Dataset| {
        let place = folder("branches");
        draw(dataset, &map(true), &into(&place, &[])).expect("a figure").notes
    };
    assert!(notes(&swept).is_empty());
    let mut without = swept.clone();
    without.variables.retain(|name, _| !name.starts_with("curve"));
    let told = "there are no curves in omega and p_d; `capsulemap continue` finds them";
    assert_eq!(notes(&without), [told]);
}
