//! Links of the documents lead somewhere: to files that are there, and to headings in them; no page of the book is left out of its list.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

/// The folders in which a code span that looks like a path names a file.
const FOLDERS: [&str; 8] =
    ["benches/", "crates/", "docs/", "scripts/", "src/", "studies/", "systems/", "tests/"];

/// Folders that have documents beside those at the root.
const WITH_DOCUMENTS: [&str; 6] = ["benches", "crates", "docs", "python", "studies", "systems"];

/// The documents in `folder`, and in the folders in it.
fn documents_in(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            documents_in(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path);
        }
    }
}

/// A document: its text without code, its headings, its links and the code spans in it.
#[derive(Default)]
struct Document {
    anchors: BTreeSet<String>,
    links: Vec<String>,
    spans: Vec<String>,
}

impl Document {
    fn read(text: &str) -> Document {
        let mut document = Document::default();
        let mut times: BTreeMap<String, usize> = BTreeMap::new();
        let mut is_code = false;
        for line in text.lines() {
            if line.trim_start().starts_with("```") {
                is_code = !is_code;
            } else if !is_code && !line.starts_with("    ") {
                if line.starts_with('#') {
                    let anchor = anchor(line.trim_start_matches('#'));
                    let before = times.entry(anchor.clone()).or_default();
                    let number = if *before == 0 { String::new() } else { format!("-{before}") };
                    *before += 1;
                    document.anchors.insert(anchor + &number);
                }
                document.take(line);
            }
        }
        document
    }

    /// Takes the links and the code spans of a line; what stands in a span is no link.
    fn take(&mut self, line: &str) {
        let mut words = String::new();
        for (i, part) in line.split('`').enumerate() {
            match i % 2 {
                0 => words.push_str(part),
                _ => self.spans.push(part.to_owned()),
            }
        }
        let targets = words.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        self.links.extend(targets.map(str::to_owned));
    }
}

/// The anchor of a heading, as pages of repositories and of mdBook have it.
fn anchor(heading: &str) -> String {
    let words = link_text(heading).trim().to_lowercase();
    let kept = words.chars().filter(|&c| c.is_alphanumeric() || " -_".contains(c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// A heading without the addresses of its links.
fn link_text(heading: &str) -> String {
    let parts: Vec<&str> = heading.split("](").collect();
    let rests = parts.iter().skip(1).map(|it| it.split_once(')').map_or("", |(_, rest)| rest));
    parts.iter().take(1).copied().chain(rests).collect()
}

/// A path without `..` and `.` in it; none if it leaves the repository.
fn plain(path: &Path) -> Option<PathBuf> {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => plain.pop().then_some(())?,
            Component::Normal(name) => plain.push(name),
            _ => {}
        }
    }
    Some(plain)
}

/// What is wrong with a link of the document at `path`.
fn fault(path: &Path, link: &str, documents: &BTreeMap<PathBuf, Document>) -> Option<String> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (file, heading) = link.split_once('#').unwrap_or((link, ""));
    let folder = path.parent().unwrap_or(Path::new(""));
    let target = if file.is_empty() { Some(path.to_owned()) } else { plain(&folder.join(file)) };
    let why = match target.filter(|target| target.exists()) {
        None => "there is no such file",
        Some(target) => {
            let headings = documents.get(&target).map(|document| &document.anchors);
            let is_there = headings.is_none_or(|headings| headings.contains(heading));
            if heading.is_empty() || is_there {
                return None;
            }
            "there is no such heading"
        }
    };
    Some(format!("{}: {link}: {why}", path.display()))
}

/// All documents, by their paths from the root.
fn documents() -> BTreeMap<PathBuf, Document> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(".").expect("the root") {
        let name = PathBuf::from(entry.expect("an entry").file_name());
        if name.extension().is_some_and(|extension| extension == "md") {
            paths.push(name);
        }
    }
    WITH_DOCUMENTS.iter().for_each(|folder| documents_in(Path::new(folder), &mut paths));
    let texts = paths.iter().map(|path| fs::read_to_string(path).expect("a document"));
    let read: Vec<Document> = texts.map(|text| Document::read(&text)).collect();
    paths.into_iter().zip(read).collect()
}

/// Whether a code span names a file of the repository.
fn names_a_file(span: &str) -> bool {
    let begins = FOLDERS.iter().any(|folder| span.starts_with(folder));
    begins && span.contains('.') && !span.contains(['*', ' ', '<', '>'])
}

#[test]
fn every_link_of_every_document_leads_somewhere() {
    let documents = documents();
    let mut faults = Vec::new();
    let mut count = 0;
    for (path, document) in &documents {
        count += document.links.len();
        faults.extend(document.links.iter().filter_map(|link| fault(path, link, &documents)));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(count > 200, "{count} links");
}

#[test]
fn files_that_documents_name_are_there() {
    let mut faults = Vec::new();
    for (path, document) in documents() {
        if path.starts_with("benches") || path.ends_with("CHANGELOG.md") {
            continue; // They tell of what was.
        }
        let named = document.spans.iter().filter(|span| names_a_file(span));
        let missing = named.filter(|span| !Path::new(span.as_str()).exists());
        faults.extend(missing.map(|span| format!("{}: `{span}`", path.display())));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_list_of_the_book_has_every_page_once() {
    let text = fs::read_to_string("docs/SUMMARY.md").expect("the list");
    let mut listed: Vec<PathBuf> =
        Document::read(&text).links.iter().map(|link| Path::new("docs").join(link)).collect();
    listed.sort();
    let is_page = |path: &PathBuf| path.starts_with("docs") && !path.ends_with("SUMMARY.md");
    let mut pages: Vec<PathBuf> = documents().into_keys().filter(is_page).collect();
    pages.sort();
    assert_eq!(listed, pages);
}

#[test]
fn a_link_that_leads_nowhere_is_seen() {
    let text = "# One `two`, three\n\n## One `two`, three\n[a](#one-two-three-1) `[b](c)`\n```\n# No\n```\n";
    let document = Document::read(text);
    let anchors: Vec<&str> = document.anchors.iter().map(String::as_str).collect();
    assert_eq!(anchors, ["one-two-three", "one-two-three-1"]);
    assert_eq!(document.links, ["#one-two-three-1"]);
    let path = PathBuf::from("README.md");
    let documents = BTreeMap::from([(path.clone(), document)]);
    for (link, is_fault) in [
        ("#one-two-three-1", false),
        ("#no", true),
        ("Cargo.toml", false),
        ("docs/../Cargo.toml", false),
        ("nothing.md", true),
        ("../../../../../../../../outside.md", true),
        ("https://nowhere.invalid", false),
    ] {
        assert_eq!(fault(&path, link, &documents).is_some(), is_fault, "{link}");
    }
}
