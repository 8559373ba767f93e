//! The house rules, checked on the source as text: the order of the floors and what each may use.

mod models;
mod names;
mod paths;
mod prints;

use std::fs;
use std::path::{Path, PathBuf};

/// The folders of the source: of the program with its library, and of the crates below it.
pub const LIBRARY: [&str; 5] =
    ["src", "crates/engine/src", "crates/models/src", "crates/text/src", "crates/commit/src"];
/// These, the tests and the benches.
pub const FOLDERS: [&str; 13] = [
    "src",
    "crates/engine/src",
    "crates/models/src",
    "crates/text/src",
    "crates/commit/src",
    "crates/oscillators/src",
    "crates/python/src",
    "crates/python/tests",
    "crates/engine/tests",
    "crates/models/tests",
    "crates/text/tests",
    "tests",
    "benches",
];

/// The floors from the ground up; a floor uses only those before it.
const FLOORS: [&str; 23] = [
    "lane",
    "flow",
    "orbit",
    "branch",
    "attractor",
    "quantity",
    "description",
    "motion",
    "samples",
    "face",
    "capsule",
    "model",
    "of",
    "text",
    "experiment",
    "study",
    "run",
    "tradeoff",
    "store",
    "campaign",
    "figure",
    "explore",
    "cli",
];

/// Crates that some floors alone may use.
const RESERVED: [(&[&str], &[&str]); 7] = [
    // They are for crates/python, which is none of the library's folders.
    (&[], &["pyo3", "numpy"]),
    (&["run"], &["rayon"]),
    (&["text", "study"], &["toml"]),
    (&["store"], &["hdf5", "hdf5_sys"]),
    (
        &["figure"],
        &[
            "plotters",
            "plotters_svg",
            "resvg",
            "krilla",
            "krilla_svg",
            "colorous",
            "typst_assets",
            "png",
        ],
    ),
    (&["explore"], &["axum", "hyper", "hyper_util", "tokio", "getrandom"]),
    (&["cli"], &["clap", "clap_complete", "indicatif"]),
];

/// The one file that calls a foreign library directly.
const UNSAFE_ALLOWED: [&str; 3] =
    ["crates/engine/src/lane/x86.rs", "src/main.rs", "src/store/scale.rs"];

const LONGEST_FILE: usize = 400;

/// A file of the repository: its path from the root, its text, and its text without comments and
/// the contents of strings.
#[derive(Clone)]
pub struct Source {
    /// Its path from the root.
    pub path: String,
    /// Its text.
    pub text: String,
    /// Its text without comments and the contents of strings.
    pub code: String,
}

impl Source {
    /// A file with this text.
    pub fn new(path: &str, text: &str) -> Self {
        Source { path: path.into(), text: text.into(), code: code_only(text) }
    }

    /// Its path from the root of its crate's source; `None` for tests and benches.
    pub fn inside(&self) -> Option<&str> {
        LIBRARY.iter().find_map(|folder| self.path.strip_prefix(folder)?.strip_prefix('/'))
    }

    /// The floor that the file belongs to; `None` for `lib.rs`, `main.rs`, tests and benches.
    fn floor(&self) -> Option<&str> {
        let inside = self.inside()?;
        let first = inside.split('/').next()?;
        let name = first.strip_suffix(".rs").unwrap_or(first);
        FLOORS.contains(&name).then_some(name)
    }
}

/// Every Rust file in these folders.
pub fn sources(folders: &[&str]) -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    for folder in folders {
        collect(&root.join(folder), &mut paths);
    }
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).expect("a source file can be read");
        let inside = path.strip_prefix(root).expect("it lies in the repository");
        Source::new(&inside.to_string_lossy().replace('\\', "/"), &text)
    };
    paths.into_iter().map(read).collect()
}

fn collect(folder: &Path, paths: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.expect("an entry of a folder").path();
        if path.is_dir() {
            collect(&path, paths);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            paths.push(path);
        }
    }
}

/// `text` with comments and the contents of strings left out.
fn code_only(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let skipped = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else {
            string_length(rest)
        };
        let taken = if skipped > 0 { skipped } else { first.len_utf8() };
        code.push_str(if skipped > 0 { " " } else { &rest[..taken] });
        rest = &rest[taken..];
    }
    code
}

/// The length of the string or character literal that `text` begins with, or 0.
pub fn string_length(text: &str) -> usize {
    let hashes = text.strip_prefix('r').map_or(0, |t| t.len() - t.trim_start_matches('#').len());
    if text.starts_with('r') && text[1 + hashes..].starts_with('"') {
        let open = hashes + 2;
        let close = format!("\"{}", "#".repeat(hashes));
        return text[open..].find(&close).map_or(text.len(), |end| open + end + close.len());
    }
    if text.starts_with("'\"'") {
        return 3;
    }
    if text.starts_with("'\\") {
        return text[3..].find('\'').map_or(text.len(), |end| 4 + end);
    }
    if !text.starts_with('"') {
        return 0;
    }
    let mut escaped = false;
    for (place, character) in text.char_indices().skip(1) {
        match character {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return place + 1,
            _ => {}
        }
    }
    text.len()
}

/// Every identifier or number of `code` with the text before and after it.
pub fn identifiers(code: &str) -> impl Iterator<Item = (&str, &str, &str)> {
    let is_part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    let starts = code.char_indices().filter(move |(place, c)| {
        is_part_of_name(*c) && !code[..*place].chars().next_back().is_some_and(is_part_of_name)
    });
    starts.map(move |(start, _)| {
        let length = code[start..].find(|c| !is_part_of_name(c)).unwrap_or(code.len() - start);
        (&code[..start], &code[start..start + length], &code[start + length..])
    })
}

/// Floors that `code` names as `crate::floor` or inside `crate::{...}`.
fn floors_used(code: &str) -> Vec<&str> {
    let mut used = Vec::new();
    for (_, _, after) in identifiers(code).filter(|(_, word, _)| *word == "crate") {
        let Some(path) = after.trim_start().strip_prefix("::").map(str::trim_start) else {
            continue;
        };
        let named = match path.strip_prefix('{') {
            Some(group) => group[..group.find(';').unwrap_or(group.len())].split(',').collect(),
            None => vec![path],
        };
        used.extend(
            named.into_iter().filter_map(|name| identifiers(name).next()).map(|(_, name, _)| name),
        );
    }
    used.retain(|name| FLOORS.contains(name));
    used
}

fn floor_faults(source: &Source) -> Vec<String> {
    let height = |name: &str| FLOORS.iter().position(|floor| *floor == name);
    let Some(floor) = source.floor() else { return Vec::new() };
    let used = floors_used(&source.code).into_iter();
    used.filter(|name| height(name) > height(floor))
        .map(|name| format!("{}: {floor} uses {name}, a floor above it", source.path))
        .collect()
}

fn crate_faults(source: &Source) -> Vec<String> {
    let mut faults = Vec::new();
    for (before, word, after) in identifiers(&source.code) {
        let is_path = after.starts_with("::") && !before.ends_with("::");
        let is_import = before.ends_with("use ") || before.ends_with("extern crate ");
        let owner = RESERVED.iter().find(|(_, crates)| crates.contains(&word));
        if let Some((owners, _)) = owner
            && (is_path || is_import)
            && !source.floor().is_some_and(|it| owners.contains(&it))
        {
            let owners = owners.join(" and ");
            faults.push(format!("{}: the crate {word} belongs to {owners}", source.path));
        }
    }
    faults
}

fn form_faults(source: &Source) -> Vec<String> {
    let mut faults = Vec::new();
    let opening: Vec<&str> = source.text.lines().map_while(|l| l.strip_prefix("//! ")).collect();
    if !opening.last().is_some_and(|line| line.ends_with('.')) {
        faults.push(format!("{}: does not open with a `//!` sentence", source.path));
    }
    let lines = source.text.lines().count();
    if lines > LONGEST_FILE {
        faults.push(format!("{}: {lines} lines, more than {LONGEST_FILE}", source.path));
    }
    let allowed = UNSAFE_ALLOWED.contains(&source.path.as_str());
    if !allowed && identifiers(&source.code).any(|(_, word, _)| word == "unsafe") {
        faults.push(format!("{}: unsafe outside {}", source.path, UNSAFE_ALLOWED.join(", ")));
    }
    faults
}

/// The modules that a file declares, in its order.
fn modules(code: &str) -> Vec<&str> {
    let after_mod = identifiers(code).filter(|(_, word, _)| *word == "mod");
    after_mod
        .filter_map(|(_, _, after)| identifiers(after).next())
        .map(|(_, name, _)| name)
        .collect()
}

/// What is wrong in the order in which the root of a crate declares the floors that are present in it.
fn order_faults(library: &Source, present: &[&str]) -> Vec<String> {
    let right: Vec<&str> = FLOORS.into_iter().filter(|floor| present.contains(floor)).collect();
    let found = modules(&library.code);
    if found == right {
        return Vec::new();
    }
    vec![format!("{} declares {found:?} instead of {right:?}", library.path)]
}

fn assert_clean(faults: Vec<String>) {
    assert!(faults.is_empty(), "the house rules are broken:\n{}", faults.join("\n"));
}

#[test]
fn the_floors_are_declared_from_the_ground_up() {
    for folder in LIBRARY {
        let all = sources(&[folder]);
        let root = format!("{folder}/lib.rs");
        let library = all.iter().find(|source| source.path == root).expect(&root);
        let present: Vec<&str> = all.iter().filter_map(Source::floor).collect();
        assert_clean(order_faults(library, &present));
    }
}

#[test]
fn a_floor_uses_only_floors_below() {
    assert_clean(sources(&LIBRARY).iter().flat_map(floor_faults).collect());
}

#[test]
fn crates_stay_on_their_floor() {
    assert_clean(sources(&LIBRARY).iter().flat_map(crate_faults).collect());
}

#[test]
fn files_open_with_a_sentence_and_stay_short_and_safe() {
    let all = sources(&FOLDERS);
    assert!(all.len() > 5, "the source was not found");
    assert_clean(all.iter().flat_map(form_faults).collect());
}

#[test]
fn a_floor_that_looks_up_is_seen() {
    for code in [
        "use crate::figure::Style;",
        "use crate::{capsule, figure::{a, b}};",
        "fn f() { crate :: cli::run() }",
    ] {
        assert_eq!(floor_faults(&Source::new("src/store/a.rs", code)).len(), 1, "{code}");
    }
    for code in [
        "use crate::{capsule::A, store};",
        "// use crate::figure;",
        "let a = \"crate::figure\";",
        "use crate::figures;",
    ] {
        assert_clean(floor_faults(&Source::new("src/store/a.rs", code)));
    }
    let engine = Source::new("crates/engine/src/flow/a.rs", "use crate::orbit::Case;");
    assert_eq!(floor_faults(&engine).len(), 1);
}

#[test]
fn a_crate_on_the_wrong_floor_is_seen() {
    let cases = [
        ("src/cli/run.rs", "use rayon::prelude::*;"),
        ("src/figure/a.rs", "let file = hdf5::File::open(path);"),
        ("src/run/a.rs", "use png;"),
        ("src/main.rs", "use clap::Parser;"),
        ("src/orbit.rs", "#[derive(clap::Parser)] struct A;"),
    ];
    for (path, code) in cases {
        assert_eq!(crate_faults(&Source::new(path, code)).len(), 1, "{path}: {code}");
    }
    let fine = [
        ("src/figure/a.rs", "use png::Encoder;"),
        ("src/cli/a.rs", "crate::figure::png::write()"),
        ("src/cli/a.rs", "let toml = 3; let a = r#\"hdf5::\"#; // rayon::spawn"),
    ];
    for (path, code) in fine {
        assert_clean(crate_faults(&Source::new(path, code)));
    }
}

#[test]
fn bad_form_is_seen() {
    let long = format!("//! A sentence.\n{}", "\n".repeat(LONGEST_FILE));
    for text in ["fn f() {}", "//! no stop\n", "//! A sentence.\nunsafe fn f() {}", &long] {
        assert_eq!(form_faults(&Source::new("src/capsule/a.rs", text)).len(), 1, "{text}");
    }
    let fine =
        "//! A sentence.\n#![deny(unsafe_code)]\n// unsafe\nlet a = '\"'; let b = \"unsafe\";";
    assert_clean(form_faults(&Source::new("src/capsule/a.rs", fine)));
    let foreign = "//! A sentence.\nunsafe fn f() {}";
    assert_clean(form_faults(&Source::new(UNSAFE_ALLOWED[0], foreign)));
}

#[test]
fn a_wrong_order_of_floors_is_seen() {
    let present = ["store", "capsule", "cli"];
    let faults = |code: &str| order_faults(&Source::new("src/lib.rs", code), &present);
    assert_clean(faults("pub mod capsule; pub mod store; pub mod cli;"));
    for code in ["pub mod store; pub mod capsule; pub mod cli;", "pub mod capsule; pub mod store;"]
    {
        assert_eq!(faults(code).len(), 1, "{code}");
    }
    assert_eq!(faults("mod capsule; mod util; mod store; mod cli;").len(), 1);
}
