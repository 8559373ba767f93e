//! No two files of the source use each other in a circle.

use std::collections::{BTreeMap, BTreeSet};

use super::house::{LIBRARY, Source, identifiers, sources};

/// The files of a crate by their module paths, and what each module re-exports from where.
struct Library {
    /// The file of a module, `flow::motion` for one.
    files: BTreeMap<String, usize>,
    /// The path that a name of a module stands for.
    exports: BTreeMap<(String, String), String>,
}

/// The module that a file is: `src/store/file.rs` is `store::file`, `src/lib.rs` the root.
fn module(source: &Source) -> String {
    let inside = source.inside().expect("a source file");
    let stem = inside.strip_suffix(".rs").expect("a source file");
    let stem = stem.strip_suffix("/mod").unwrap_or(stem);
    if stem == "lib" { String::new() } else { stem.replace('/', "::") }
}

fn joined(module: &str, name: &str) -> String {
    if module.is_empty() { name.to_owned() } else { format!("{module}::{name}") }
}

fn parent(module: &str) -> String {
    module.rsplit_once("::").map_or(String::new(), |(parent, _)| parent.to_owned())
}

/// Every path of a tree of paths such as `a::{b, c::d}`, and what follows the tree.
fn paths<'a>(tree: &'a str, before: &str, found: &mut Vec<String>) -> &'a str {
    let tree = tree.trim_start();
    if let Some(mut rest) = tree.strip_prefix('{') {
        loop {
            rest = paths(rest, before, found).trim_start();
            match rest.strip_prefix(',') {
                Some(after) if !after.trim_start().starts_with('}') => rest = after,
                Some(after) => return after.trim_start().strip_prefix('}').unwrap_or(after),
                None => return rest.strip_prefix('}').unwrap_or(rest),
            }
        }
    }
    let is_name = |c: char| c.is_alphanumeric() || c == '_' || c == '*';
    let end = tree.find(|c| !is_name(c)).unwrap_or(tree.len());
    let path = joined(before, &tree[..end]);
    match tree[end..].trim_start().strip_prefix("::") {
        Some(rest) if rest.starts_with(|c: char| is_name(c) || c == '{' || c == ' ') => {
            paths(rest, &path, found)
        }
        _ => {
            found.push(path);
            let rest = tree[end..].trim_start();
            let renamed = rest.strip_prefix("as ").map(str::trim_start);
            renamed.map_or(rest, |rest| rest.trim_start_matches(is_name))
        }
    }
}

/// The paths that a file names from the root or from the module that it lies in.
fn named(source: &Source, own: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (before, word, after) in identifiers(&source.code) {
        let start = match word {
            "crate" => String::new(),
            "super" if !before.ends_with("::") => parent(own),
            _ => continue,
        };
        let is_export = statement(before).starts_with("pub use");
        if let Some(tree) = after.strip_prefix("::").filter(|_| !is_export) {
            paths(tree, &start, &mut found);
        }
    }
    found.retain(|path| !path.ends_with('*'));
    found
}

/// The statement that `before` ends in.
fn statement(before: &str) -> &str {
    before[before.rfind([';', '}']).map_or(0, |place| place + 1)..].trim_start()
}

impl Library {
    fn new(all: &[Source]) -> Self {
        let mut library = Library { files: BTreeMap::new(), exports: BTreeMap::new() };
        for (place, source) in all.iter().enumerate() {
            let own = module(source);
            for (before, word, after) in identifiers(&source.code) {
                if word == "use" && statement(before) == "pub " {
                    let mut found = Vec::new();
                    paths(after, "", &mut found);
                    for path in found {
                        let name = path.rsplit("::").next().unwrap_or_default().to_owned();
                        library.exports.insert((own.clone(), name), path);
                    }
                }
            }
            library.files.insert(own, place);
        }
        library
    }

    /// The file in which what a path names is written.
    fn file_of(&self, path: &str) -> Option<usize> {
        let mut module = String::new();
        for (place, name) in path.split("::").enumerate() {
            let inner = joined(&module, name);
            if self.files.contains_key(&inner) {
                module = inner;
                continue;
            }
            if let Some(export) = self.exports.get(&(module.clone(), name.to_owned())) {
                let rest = path.split("::").skip(place + 1);
                let of_module = export.strip_prefix("crate::").map(str::to_owned);
                let mut whole = of_module.unwrap_or_else(|| joined(&module, export));
                for name in rest {
                    whole = joined(&whole, name);
                }
                return self.file_of(&whole);
            }
            break;
        }
        self.files.get(&module).copied()
    }
}

/// The circles among files: the sets of those that lead to each other.
fn circles(all: &[Source]) -> Vec<Vec<&str>> {
    let library = Library::new(all);
    let uses: Vec<BTreeSet<usize>> = (0..all.len())
        .map(|place| {
            let named = named(&all[place], &module(&all[place]));
            let used = named.iter().filter_map(|path| library.file_of(path));
            used.filter(|file| *file != place).collect()
        })
        .collect();
    let reached = |from: usize| {
        let (mut seen, mut next) = (BTreeSet::new(), vec![from]);
        while let Some(file) = next.pop() {
            next.extend(uses[file].iter().filter(|used| seen.insert(**used)));
        }
        seen
    };
    let reached: Vec<BTreeSet<usize>> = (0..all.len()).map(reached).collect();
    let together = |a: usize| -> Vec<&str> {
        let with = (0..all.len()).filter(|b| reached[a].contains(b) && reached[*b].contains(&a));
        with.map(|file| all[file].path.as_str()).collect()
    };
    let found: BTreeSet<Vec<&str>> = (0..all.len()).map(together).collect();
    found.into_iter().filter(|circle| circle.len() > 1).collect()
}

#[test]
fn no_two_files_use_each_other_in_a_circle() {
    for folder in LIBRARY {
        let all = sources(&[folder]);
        let found = circles(&all);
        assert!(found.is_empty(), "files in a circle:\n{}", report(&found));
    }
}

fn report(found: &[Vec<&str>]) -> String {
    found.iter().map(|circle| circle.join(", ")).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_circle_is_seen_through_groups_and_exports() {
    let exports = Source::new("src/a/mod.rs", "mod x; mod y; pub use x::One; pub use y::{Two, f};");
    let x = Source::new("src/a/x.rs", "use super::{Two, y::Three}; pub struct One;");
    let round = Source::new("src/a/y.rs", "fn f() { crate::a::One; }");
    let straight = Source::new("src/a/y.rs", "// crate::a::One\nuse std::fmt; use super::f;");
    let [round, straight] = [round, straight].map(|y| {
        let all = [exports.clone(), x.clone(), y];
        circles(&all).iter().map(|circle| circle.join(" ")).collect::<Vec<_>>()
    });
    assert_eq!(round, ["src/a/x.rs src/a/y.rs"]);
    assert!(straight.is_empty(), "{straight:?}");
}
