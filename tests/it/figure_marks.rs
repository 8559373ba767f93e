//! What stands on figures and beside them: marks of cases without a period, colours of what is seen, and where legends stand.

use capsulemap::study::{Drawing, DrawingKind, QuantitySettings};

use super::figure::drawing;
use super::figure::fixtures::{Fixture, OUTCOMES, steps};
use super::figure_settings::{both_sweeps, diagram, drawn, labels, number, settings, speeds};

#[test]
fn what_has_no_period_has_a_place_of_its_own_among_periods() {
    let dataset = Fixture::default()
        .coordinate("omega", "rad/s", steps(10.0, 60.0, 6))
        .integer("period", &["omega"], &[], |at| [1, 2, 0, 0, 4, 0][at[0]])
        .integer("outcome", &["omega"], &OUTCOMES, |at| [0, 0, 1, 2, 0, 3][at[0]])
        .0;
    let request = Drawing { of: vec!["period".into()], ..drawing("p", DrawingKind::Bifurcation) };
    let (svg, csv) = drawn(&dataset, &request);
    let words = labels(&svg).concat();
    for (kind, omega) in [("chaotic", "30"), ("quasi-periodic", "40"), ("undecided", "60")] {
        assert!(words.contains(&format!("{kind}: no period")), "{words}");
        assert!(csv.contains(&format!("1,\"{kind}, no period\",{omega},,\n")), "{csv}");
    }
    // No period is 0.
    assert!(!csv.contains(",0,"), "{csv}");
    // Beside other outputs nothing is marked.
    let words = labels(&drawn(&speeds([0.0, 1.0, 2.0, 3.0, 4.0, 5.0]), &diagram(&[])).0).concat();
    assert!(!words.contains("no period"), "{words}");
}

#[test]
fn colours_span_the_cells_that_are_seen() {
    let dataset = Fixture::default()
        .coordinate("omega", "rad/s", steps(10.0, 60.0, 6))
        .coordinate("p_d", "N", steps(1.0, 2.0, 3))
        .real("progression_speed", &["omega", "p_d"], |at| [1.0, 2.0, 3.0, 4.0, 5.0, 90.0][at[0]])
        .integer("outcome", &["omega", "p_d"], &OUTCOMES, |_| 0)
        .0;
    let numbers = |limits: Option<[f64; 2]>| {
        let set = settings(&[("omega", QuantitySettings { limits, ..Default::default() })]);
        let request = Drawing { settings: set, ..drawing("m", DrawingKind::Map) };
        labels(&drawn(&dataset, &request).0)
    };
    // Speeds are shown in mm/s, in thousands where they are many.
    assert!(numbers(None).iter().any(|it| it == "80" || it == "80000"), "{:?}", numbers(None));
    let seen = numbers(Some([10.0, 50.0]));
    assert!(!seen.iter().any(|it| it == "80" || it == "80000"), "{seen:?}");
    assert!(seen.iter().any(|it| it == "4" || it == "4000"), "{seen:?}");
}

#[test]
fn a_long_legend_stands_below_its_panels() {
    let dataset = both_sweeps();
    let is_below = |levels: u32| {
        let contours = (0..levels).map(|it| 1e-3 * (f64::from(it) + 1.5)).collect();
        let set = QuantitySettings { contours, ..Default::default() };
        let request = Drawing {
            settings: settings(&[("progression_speed", set)]),
            x: Some("omega".to_owned()),
            y: Some("p_d".to_owned()),
            ..drawing("l", DrawingKind::Map)
        };
        let svg = drawn(&dataset, &request).0;
        let height = |words: &str| {
            let place = labels(&svg).iter().position(|it| it.contains(words));
            let place = place.unwrap_or_else(|| panic!("{words}: {:?}", labels(&svg)));
            let text = svg.split("<text ").nth(1 + place);
            number(&format!(" {}", text.expect("a text")), "y")
        };
        height("1.5 mm/s") > height("Frequency")
    };
    assert!(!is_below(3));
    assert!(is_below(14));
}
