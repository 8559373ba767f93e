//! The pages of the book that the program has with it, and what they say of a key or an output.

/// Name and text of each page, as its file in docs/ has them.
macro_rules! pages {
    ($($name:literal),* $(,)?) => {
        &[$(Page { name: $name, text: include_str!(concat!("../../docs/", $name, ".md")) }),*]
    };
}

/// A page of the book.
#[derive(Debug, Clone, Copy)]
pub struct Page {
    /// Its file, without folder and ending of docs/.
    pub name: &'static str,
    text: &'static str,
}

/// The pages, in the order of the book.
pub const PAGES: &[Page] = pages![
    "first-steps",
    "model",
    "family",
    "published",
    "maps",
    "basins",
    "tradeoff",
    "branches",
    "ramps",
    "experiment",
    "sensitivity",
    "exponents",
    "own-outputs",
    "systems",
    "explore",
    "python",
    "long-runs",
    "clusters",
    "study/file",
    "study/parameters",
    "study/axes",
    "paths",
    "study/start",
    "study/protocol",
    "study/branches",
    "study/basin",
    "study/map",
    "study/figures",
    "results",
    "outputs",
    "attractors",
    "gallery",
    "errors",
    "glossary",
    "accuracy",
    "speed",
    "algorithms",
];

/// The page of the outputs.
pub const OUTPUTS: &str = "outputs";

/// A row of a table that begins with names, and where it stands.
pub struct Row {
    /// The heading above its table.
    pub heading: String,
    /// The names, between backticks in the first cell.
    pub names: Vec<&'static str>,
    /// What heads the other cells, and what is in them.
    pub cells: Vec<(String, String)>,
    /// The paragraphs that begin with one of the names.
    pub more: Vec<String>,
}

/// The page called `name`.
pub fn page(name: &str) -> Option<Page> {
    PAGES.iter().copied().find(|it| it.name == name || it.name.rsplit('/').next() == Some(name))
}

/// The pages that have tables of keys of a study, those of the study file first.
pub fn of_studies() -> impl Iterator<Item = Page> {
    let in_folder = PAGES.iter().copied().filter(|it| it.name.starts_with("study/"));
    in_folder.chain(["paths", "ramps", "family"].into_iter().filter_map(page))
}

impl Page {
    /// Its first heading.
    pub fn title(self) -> String {
        plain(self.text.lines().next().unwrap_or("").trim_start_matches('#').trim())
    }

    /// Its text without links and pictures.
    pub fn plain(self) -> String {
        let lines = self.text.lines().filter(|line| !line.starts_with("!["));
        lines.map(|line| plain(line) + "\n").collect()
    }

    /// The rows of its tables whose first column is headed by a word that begins with `head`.
    pub fn rows(self, head: &str) -> Vec<Row> {
        let mut rows = Vec::new();
        let (mut heading, mut heads) = (String::new(), None::<Vec<String>>);
        for line in self.text.lines() {
            if line.starts_with('#') {
                heading = plain(line.trim_start_matches('#').trim());
            }
            let Some(cells) = cells(line) else {
                heads = None;
                continue;
            };
            match &heads {
                None => heads = Some(cells.into_iter().map(plain).collect()),
                Some(heads) if heads[0].starts_with(head) && !line.starts_with("|--") => {
                    let names = quoted(cells[0]);
                    let more = self.paragraphs(&names);
                    let others = heads.iter().cloned().zip(cells.into_iter().map(plain)).skip(1);
                    let cells = others.filter(|it| !it.1.is_empty()).collect();
                    rows.push(Row { heading: heading.clone(), names, cells, more });
                }
                Some(_) => {}
            }
        }
        rows
    }

    /// The paragraphs that begin with one of these names in bold.
    fn paragraphs(self, names: &[&str]) -> Vec<String> {
        let begins = |it: &&str| {
            let bold = it.strip_prefix("**`");
            bold.is_some_and(|it| names.iter().any(|name| it.starts_with(&format!("{name}`"))))
        };
        let paragraphs = self.text.split("\n\n").map(str::trim).filter(begins);
        paragraphs.map(|it| plain(&it.replace('\n', " "))).collect()
    }
}

/// The cells of a row of a table.
fn cells(line: &'static str) -> Option<Vec<&'static str>> {
    let inner = line.strip_prefix('|')?.trim_end().strip_suffix('|')?;
    let (mut cells, mut from) = (Vec::new(), 0);
    for (at, _) in inner.match_indices('|') {
        // A bar of a formula is written with a backslash.
        if !inner[..at].ends_with('\\') {
            cells.push(inner[from..at].trim());
            from = at + 1;
        }
    }
    cells.push(inner[from..].trim());
    Some(cells)
}

/// What stands between backticks.
fn quoted(cell: &'static str) -> Vec<&'static str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// A line as text: links are their words, and what is bold is not.
fn plain(line: &str) -> String {
    let mut text = String::new();
    let mut rest = line;
    while let Some(open) = rest.find('[') {
        let link = rest[open..].split_once("](").and_then(|(words, after)| {
            let (_, after) = after.split_once(')')?;
            (!words[1..].contains('\n')).then_some((&words[1..], after))
        });
        // Tables are named in brackets, too.
        let Some((words, after)) = link.filter(|(words, _)| is_closed(words)) else {
            text.push_str(&rest[..=open]);
            rest = &rest[open + 1..];
            continue;
        };
        text.push_str(&rest[..open]);
        text.push_str(words);
        rest = after;
    }
    text.push_str(rest);
    text.replace("**", "").replace("\\|", "|")
}

/// Whether each bracket that a text opens is closed in it.
fn is_closed(text: &str) -> bool {
    let mut depth = 0_i32;
    for c in text.chars() {
        depth += i32::from(c == '[') - i32::from(c == ']');
        if depth < 0 {
            return false;
        }
    }
    depth == 0
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn links_are_their_words() {
        assert_eq!(
            plain("see [the `[basin]`](basin.md#a) and [two](b.md)."),
            "see the `[basin]` and two."
        );
        assert_eq!(plain("[`[map]`](map.md) has **no** \\|x\\|"), "`[map]` has no |x|");
        assert_eq!(plain("an axis [m/s] of [[axes]]"), "an axis [m/s] of [[axes]]");
    }

    #[test]
    fn every_page_is_with_the_program() {
        let docs = concat!(env!("CARGO_MANIFEST_DIR"), "/docs");
        let mut there = BTreeSet::new();
        for (folder, before) in [(docs.to_owned(), ""), (format!("{docs}/study"), "study/")] {
            for entry in std::fs::read_dir(folder).expect("the book") {
                let path = entry.expect("an entry").path();
                let stem = path.file_stem().and_then(|it| it.to_str()).expect("a name");
                if path.extension().is_some_and(|it| it == "md") {
                    there.insert(format!("{before}{stem}"));
                }
            }
        }
        for index in ["README", "SUMMARY"] {
            assert!(there.remove(index), "{index}");
        }
        assert_eq!(there, PAGES.iter().map(|it| it.name.to_owned()).collect());
    }
}
