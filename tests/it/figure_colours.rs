//! The colours of attractors, one for each in all figures, and the symbols and cases that figures count.

use std::collections::BTreeMap;

use capsulemap::figure::draw;
use capsulemap::store::dataset::Dataset;
use capsulemap::study::{AttractorColours, Colour, Drawing, DrawingKind, Study};

use super::figure::fixtures::{Fixture, steps};
use super::figure::{drawing, folder, into};
use super::figure_settings::{drawn, labels};
use super::program::WorkDir;

/// Two attractors over the frequency, of the second of which the starts are the lower half, with doublings so near to each other that
/// their symbols overlap.
fn two_attractors() -> Fixture {
    let axes = ["omega", "start_r"];
    let mut fixture = Fixture::default()
        .coordinate("omega", "rad/s", steps(10.0, 60.0, 6))
        .coordinate("start_r", "m", steps(-1e-3, 1e-3, 4))
        .coordinate("event", "1", steps(0.0, 3.0, 4))
        .real("progression_speed", &axes, |at| 1e-3 * (at[0] + 7 * (at[1] / 2)) as f64)
        .real("section_r", &axes, |at| 1e-3 * (at[0] + 7 * (at[1] / 2)) as f64)
        .integer("attractor", &axes, &[], |at| (at[1] / 2) as i64)
        .integer("outcome", &axes, &["periodic", "missing"], |at| i64::from(at[0] == 5))
        .integer("event_kind", &["event"], &["period-doubling", "fold"], |at| i64::from(at[0] == 3))
        .integer("event_attractor", &["event"], &[], |_| 1)
        .integer("event_period", &["event"], &[], |at| 1 << at[0])
        .real("event_omega", &["event"], |at| [30.0, 30.1, 30.12, 50.0][at[0]])
        .real("event_section_r", &["event"], |_| 2e-3)
        .real("event_section_y1", &["event"], |_| 0.0)
        .real("event_section_y2", &["event"], |_| 0.0);
    fixture.0.attributes.insert("attractor_axis".to_owned(), "omega".to_owned());
    fixture
}

fn diagram() -> Drawing {
    Drawing { of: vec!["section_r".to_owned()], ..drawing("d", DrawingKind::Bifurcation) }
}

fn colours(of: &[(u32, Colour)]) -> AttractorColours {
    of.iter().copied().collect()
}

fn notes(dataset: &Dataset, request: &Drawing) -> Vec<String> {
    draw(dataset, request, &into(&folder("colours"), &[])).expect("a figure").notes
}

#[test]
fn attractors_are_called_by_their_numbers_and_have_the_colours_that_are_set() {
    let dataset = two_attractors().0;
    let (svg, csv) = drawn(&dataset, &diagram());
    let words = labels(&svg);
    let svg = svg.to_lowercase();
    assert!(words.iter().any(|it| it == "attractor 0"), "{words:?}");
    assert!(csv.contains("1,attractor 0,10,0,") && csv.contains("1,attractor 1,10,7,"), "{csv}");
    assert!(svg.contains("#0072b2") && svg.contains("#d55e00"));
    let set = colours(&[(1, Colour([1, 2, 3]))]);
    let request = Drawing { colours: set, ..diagram() };
    let svg = drawn(&dataset, &request).0.to_lowercase();
    assert!(svg.contains("#0072b2") && svg.contains("#010203") && !svg.contains("#d55e00"));
    assert!(notes(&dataset, &request).is_empty());
    let alike = Drawing {
        colours: colours(&[(1, Colour([0, 114, 178])), (5, Colour([0, 0, 0]))]),
        ..diagram()
    };
    let told = [
        "`colours`: there is no attractor 5 here",
        "`colours`: attractors 1 and 0 have the same colour, blue",
    ];
    assert_eq!(notes(&dataset, &alike), told);
    let wrong = Drawing { colours: alike.colours, ..drawing("h", DrawingKind::Spectrum) };
    let said = draw(&dataset, &wrong, &into(&folder("colours"), &[])).expect_err("a fault");
    assert!(said.to_string().contains("`colours` does not go with a spectrum"), "{said}");
}

#[test]
fn symbols_that_would_overlap_and_cases_that_are_not_computed_are_counted() {
    let (svg, csv) = drawn(&two_attractors().0, &diagram());
    let words = labels(&svg);
    let told = |part: &str| assert!(words.iter().any(|it| it == part), "{part}: {words:?}");
    told("left out where symbols would overlap: 2 × period doubling");
    told("not yet computed: 4 of 24");
    // The data have all of them.
    assert_eq!(csv.matches("1,period doubling,").count(), 3, "{csv}");
    let map =
        Drawing { of: vec!["progression_speed".to_owned()], ..drawing("m", DrawingKind::Map) };
    let mut fixture = two_attractors();
    fixture = fixture.real("progression_speed", &["omega", "start_r"], |at| {
        if at[0] == 5 { f64::NAN } else { at[1] as f64 }
    });
    let words = labels(&drawn(&fixture.0, &map).0);
    assert!(words.iter().any(|it| it == "not yet computed: 4 of 24"), "{words:?}");
}

#[test]
fn a_study_sets_the_colours_of_all_its_figures() {
    let text = "[colours]\n0 = \"black\"\n3 = \"#ff8000\"\n\n\
                [[axes]]\nname = \"omega\"\nfrom = \"10 rad/s\"\nto = \"60 rad/s\"\npoints = 6\n\n\
                [[axes]]\nname = \"start_r\"\nfrom = \"-1 mm\"\nto = \"1 mm\"\npoints = 4\n\n\
                [parameters]\nk2 = \"10 kN/m\"\ndelta = \"1 mm\"\np_d = \"3 N\"\n\n\
                [[figures]]\nname = \"a\"\nkind = \"bifurcation\"\ncolours = { 0 = \"sand\" }\n\n\
                [[figures]]\nname = \"b\"\nkind = \"shares\"\n\n\
                [[figures]]\nname = \"c\"\nkind = \"trade-off\"\nbudget = \"20 mJ\"\ncolour_by = \"attractor\"\n\n\
                [[figures]]\nname = \"d\"\nkind = \"history\"\n";
    let study = Study::parse("study.toml", text).expect("a study");
    let of = |place: usize| -> BTreeMap<u32, String> {
        let colours = &study.drawings[place].colours;
        colours.iter().map(|(number, colour)| (*number, colour.text())).collect()
    };
    let orange = "#ff8000".to_owned();
    assert_eq!(of(0), BTreeMap::from([(0, "sand".to_owned()), (3, orange.clone())]));
    assert_eq!(of(1), BTreeMap::from([(0, "black".to_owned()), (3, orange)]));
    assert!(study.drawings[2].budget.is_some_and(|it| (it - 0.02).abs() < 1e-15));
    assert!(of(3).is_empty());
    // What is drawn makes no difference to what is computed.
    let plain = text.split_once("[[axes]]").map(|it| format!("[[axes]]{}", it.1));
    let plain = plain.and_then(|it| it.split_once("[[figures]]").map(|it| it.0.to_owned()));
    let plain = Study::parse("study.toml", &plain.expect("axes")).expect("a study");
    assert_eq!(study.fingerprint(), plain.fingerprint());
}

#[test]
fn colours_that_are_none_are_told_all_at_once() {
    let folder = WorkDir::new();
    let study = "[colours]\none = \"blue\"\n1 = \"bleu\"\n2 = 3\n\n\
                 [[axes]]\nname = \"omega\"\nfrom = \"10 rad/s\"\nto = \"60 rad/s\"\npoints = 6\n\n\
                 [[figures]]\nname = \"h\"\nkind = \"history\"\ncolours = { 0 = \"#12\" }\n\n\
                 [[figures]]\nname = \"m\"\nkind = \"map\"\nbudget = \"20 mJ\"\n\n\
                 [[figures]]\nname = \"t\"\nkind = \"trade-off\"\nbudget = \"20 mm\"\n";
    folder.put("study.toml", study);
    folder.run(&["sweep", "study.toml", "--dry-run"]).refused(&[
        "colours.one: \"one\" is no number of an attractor",
        "colours.1: unknown colour \"bleu\"; did you mean \"blue\"?",
        "colours.2: expected a text in quotes, found 3",
        "does not go with a figure of the kind history",
        "\"#12\" is no colour",
        "budget: goes with a trade-off, not with a figure of the kind map",
        "figures[3].budget",
    ]);
}
