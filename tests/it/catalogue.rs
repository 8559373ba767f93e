//! The catalogue of variables: nothing else spells their names, and files of results hold what it says.

use std::collections::BTreeSet;

use capsulemap::capsule::Parameter;
use capsulemap::capsule::description::CAPSULE;
use capsulemap::store::catalogue::{
    self, ATTRACTOR_AXIS, ATTRACTOR_INTEGRITY_FACTOR, ATTRACTOR_MINIMAL_CRITICAL_SHOCK, Entry,
    Extent, Type,
};
use capsulemap::store::{self, Dataset, Values, Variable};
use capsulemap::study::appearance::dimension_of;
use capsulemap::study::{DrawingKind, Study};

use studies::STUDIES;

use super::house::{LIBRARY, sources, string_length};
use super::program::WorkDir;

mod studies;

/// The files that give parameters, starts, outputs and the dimensions of cases their names.
const DEFINING: [&str; 8] = [
    "crates/models/src/capsule/parameter.rs",
    "crates/models/src/capsule/output.rs",
    "crates/models/src/capsule/description.rs",
    "crates/models/src/capsule/quantities.rs",
    "crates/models/src/description/phases.rs",
    "crates/text/src/text/described.rs",
    "src/study/grid.rs",
    "src/study/draws.rs",
];

/// What is spelled like a variable elsewhere and is none: the file, the words, and what they are there.
const OTHERS: [(&str, &[&str], &str); 28] = [
    ("src/study/protocol_file.rs", &["cycles", "attractor"], "keys of a study"),
    ("src/study/study_text.rs", KEYS, "keys of a study"),
    ("src/study/start_file.rs", &["direction"], "keys of a study"),
    ("src/study/branch_file.rs", &["period"], "keys of a study"),
    ("src/study/drawing_file.rs", &["cycles"], "a key of a study"),
    ("src/study/drawing_text.rs", &["cycles"], "a key of a study"),
    ("src/study/drawing.rs", SHOWN, "what the key `of` may name, which a test here compares"),
    ("src/study/drawing.rs", &["attractor", "direction"], "what the key `colour_by` may name"),
    (
        "src/study/appearance.rs",
        SET,
        "what the keys of quantities may name, which a test here compares",
    ),
    ("src/experiment/header_columns.rs", &["time"], "what recordings call their times"),
    ("src/experiment/cells.rs", &["point"], "the decimal point"),
    ("crates/models/src/quantity/units.rs", &["g"], "the gram"),
    ("crates/text/src/text/unit.rs", &["g"], "the gram"),
    ("crates/text/src/text/fitting.rs", &["period", "duty"], "keys of a text"),
    ("crates/text/src/text/parts.rs", &["period", "duty"], "keys of a text"),
    ("crates/text/src/text/symbol.rs", &["delta", "omega"], "names of letters"),
    ("src/figure/text.rs", &["delta", "omega"], "names of symbols in TeX"),
    ("src/cli/simulate.rs", OPTIONS, "options of a command"),
    ("src/cli/phases.rs", &["start_phase", "section_phase"], "options of a command"),
    ("src/campaign/error.rs", &["block"], "a word of a message"),
    ("src/cli/branch_summary.rs", &["branch", "period", "point"], "words of a message"),
    ("src/cli/claim_text.rs", &["block"], "a word of a message"),
    ("src/cli/manifold_list.rs", &["attractor", "curve"], "keys, and words of a message"),
    ("crates/engine/src/attractor/manifold.rs", &["attractor"], "why a manifold ends"),
    ("src/explore/server/units.rs", &["g"], "a unit"),
    ("src/cli/dry_run.rs", &["block"], "a word of a message"),
    ("src/cli/join.rs", &["block"], "a word of a message"),
    ("src/cli/status.rs", &["block"], "a word of a message"),
];

/// Keys of a study.
const KEYS: &[&str] = &["period", "attractor", "cycles"];

/// Options that are called as parameters are.
const OPTIONS: &[&str] = &["omega", "p_d", "k2", "delta", "start_phase", "section_phase"];

/// What the key `of` of a figure may name beside what the model describes.
const SHOWN: &[&str] = &["outcome", "period", "cycles"];

/// What the keys that set how a quantity is shown may name beside what the model describes.
const SET: &[&str] = &[
    "outcome",
    "period",
    "cycles",
    "attractor",
    "attractor_share",
    "attractor_integrity_factor",
    "spectrum_frequency",
    "time",
];

/// The contents of the string literals of `text`, comments and its tests left out.
fn literals(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut rest = text.split("#[cfg(test)]").next().unwrap_or(text);
    while let Some(first) = rest.chars().next() {
        let length = match rest.starts_with("//") {
            true => rest.find('\n').unwrap_or(rest.len()),
            false => string_length(rest).max(first.len_utf8()),
        };
        if first == '"' {
            found.push(&rest[1..length - 1]);
        }
        rest = &rest[length..];
    }
    found
}

/// The names of variables that a file spells by itself.
fn spelled(path: &str, text: &str) -> Vec<String> {
    let others = OTHERS.iter().filter(|(file, ..)| *file == path).flat_map(|(_, words, _)| *words);
    let others: Vec<&str> = others.copied().collect();
    let prefixes = ["event_{", "request_{", "branch_{", "special_{", "curve_{"];
    let is_name = |literal: &&str| {
        catalogue::named(literal, &CAPSULE).is_some()
            || prefixes.iter().any(|prefix| literal.starts_with(prefix))
    };
    let spelled = literals(text).into_iter().filter(is_name);
    spelled.filter(|it| !others.contains(it)).map(|it| format!("{path}: \"{it}\"")).collect()
}

#[test]
fn no_other_file_spells_the_name_of_a_variable() {
    let is_free = |path: &str| path.starts_with("src/store/catalogue/") || DEFINING.contains(&path);
    let all = sources(&LIBRARY);
    let others = all.iter().filter(|source| !is_free(&source.path));
    let faults: Vec<String> = others.flat_map(|it| spelled(&it.path, &it.text)).collect();
    assert!(faults.is_empty(), "names of variables by hand:\n{}", faults.join("\n"));
    for (file, words, _) in OTHERS {
        let source = all.iter().find(|source| source.path == file).expect(file);
        let literals = literals(&source.text);
        assert!(words.iter().all(|word| literals.contains(word)), "{file}: more is allowed");
    }
}

#[test]
fn a_name_by_hand_is_seen() {
    for code in ["f(\"section_r\")", "format!(\"event_{name}\")", "\"m\" + \"p_d\""] {
        assert_eq!(spelled("src/figure/a.rs", code).len(), 1, "{code}");
    }
    for code in ["f(\"section_q\")", "// \"p_d\"", "OUTCOME.name", "#[cfg(test)] f(\"p_d\")"] {
        assert!(spelled("src/figure/a.rs", code).is_empty(), "{code}");
    }
}

#[test]
fn what_a_study_may_draw_is_in_the_catalogue() {
    let outputs: Vec<_> = CAPSULE.outputs().collect();
    for (_, kind) in DrawingKind::NAMES {
        for name in kind.can_show(&CAPSULE, &outputs) {
            let extent = catalogue::named(name, &CAPSULE).expect(name).extent;
            let drawn = matches!(extent, Extent::Case | Extent::CaseRow(_) | Extent::Derived);
            assert!(drawn, "{name}");
        }
    }
}

#[test]
fn what_can_be_set_of_figures_is_in_the_catalogue_with_its_dimension() {
    for name in SET {
        let entry = catalogue::named(name, &CAPSULE).expect(name);
        assert_eq!(dimension_of(name, &CAPSULE).expect(name).unit(), entry.unit, "{name}");
    }
    let outputs: Vec<_> = CAPSULE.outputs().collect();
    for (_, kind) in DrawingKind::NAMES {
        for name in kind.can_show(&CAPSULE, &outputs) {
            assert!(dimension_of(name, &CAPSULE).is_ok(), "{name}");
        }
    }
}

/// What is wrong with a variable, or with a coordinate; nothing if it is as the catalogue says.
fn fault(dataset: &Dataset, name: &str, variable: &Variable) -> Option<String> {
    let Some(entry) = catalogue::named(name, &CAPSULE) else {
        return Some(format!("{name}: unknown"));
    };
    let of_axis = dataset.attributes.get(ATTRACTOR_AXIS).and_then(|it| dataset.coordinate(it));
    let unit = match entry.unit {
        "" => of_axis.map_or("1", |axis| axis.unit.as_str()),
        unit => unit,
    };
    let is_whole = matches!(variable.values, Values::Integer(_));
    let is_category = !variable.flags.is_empty();
    let (whole, category) = match entry.numbers {
        Type::Real => (false, false),
        Type::Whole => (true, false),
        Type::Category(_) | Type::CategoryOfFile => (true, true),
    };
    let known = entry.flags();
    // What has not been computed has no outcome.
    let is_known = |flag: &(i64, String)| known.contains(flag) || flag.1 == "inferred";
    let of_file = matches!(entry.numbers, Type::CategoryOfFile);
    let flags_fit = of_file || variable.flags.iter().all(is_known);
    let dimensions = variable.dimensions.iter().map(String::as_str);
    let inner: Vec<&str> = dimensions.filter(|dimension| !is_axis(dimension)).collect();
    // Distances between section points are told as the model compares these.
    let is_distance =
        [ATTRACTOR_MINIMAL_CRITICAL_SHOCK, ATTRACTOR_INTEGRITY_FACTOR].map(|it| it.name);
    let meaning = match is_distance.contains(&entry.name) {
        true => format!("{}, by omega r, y1 and y2", entry.meaning),
        false => entry.meaning.to_owned(),
    };
    let right = (variable.unit.as_str(), &variable.long_name) == (unit, &meaning)
        && (is_whole, is_category) == (whole, category)
        && flags_fit
        && inner == entry.dimensions();
    (!right).then(|| format!("{name}: {variable:?} is not {entry:?}"))
}

/// The path among the axes of the studies, which names it.
const PATH: &str = "line";

/// Whether a dimension is an axis of the study.
fn is_axis(dimension: &str) -> bool {
    dimension == PATH
        || catalogue::named(dimension, &CAPSULE).is_some_and(|entry| entry.extent == Extent::Study)
}

#[test]
fn files_hold_what_the_catalogue_says() {
    let mut seen = BTreeSet::new();
    for text in STUDIES {
        let dir = WorkDir::new();
        dir.put("a.toml", text);
        dir.run(&["sweep", "a.toml", "--no-figures"]).done();
        let study = Study::parse("a.toml", text).expect("a study");
        if study.has_more_than_cases() {
            dir.run(&["continue", "a.toml", "--no-figures"]).done();
        }
        let dataset = store::read(&dir.path("results/a/a.h5")).expect("a result");
        let coordinates = dataset.coordinates.iter().map(|(name, it)| (name, it));
        let all = coordinates.chain(&dataset.variables);
        for (name, variable) in all.filter(|(name, _)| *name != PATH) {
            let fault = fault(&dataset, name, variable);
            assert!(fault.is_none(), "{}", fault.unwrap_or_default());
            seen.insert(name.clone());
        }
    }
    // A column called after a parameter is there where that parameter varies.
    let is_stored = |entry: &&Entry| !matches!(entry.extent, Extent::Block | Extent::Derived);
    let of_parameter = |entry: &&Entry| {
        let symbols = Parameter::ALL.iter().map(|parameter| format!("_{}", parameter.symbol()));
        symbols.into_iter().any(|symbol| entry.name.ends_with(&symbol))
    };
    let stored = catalogue::all(&CAPSULE).iter().filter(is_stored).filter(|it| !of_parameter(it));
    let never: Vec<&str> = stored.map(|it| it.name).filter(|it| !seen.contains(*it)).collect();
    assert!(never.is_empty(), "no file has {never:?}");
}
