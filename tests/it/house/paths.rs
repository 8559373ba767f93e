//! Paths stand in messages by one function, which shows them on one line.

use super::{LIBRARY, Source, assert_clean, sources};

/// Where a path is part of a command for a shell, of a page or of JSON, which have rules of their own.
const OTHER_RULES: [&str; 3] =
    ["src/campaign/trade_off.rs", "src/explore/server/described.rs", "src/explore/report.rs"];

/// Where a file shows a path as it is.
fn raw_paths(source: &Source) -> Option<String> {
    let is_raw = source.code.contains(".display()") && !OTHER_RULES.contains(&&*source.path);
    is_raw.then(|| format!("{}: .display(); use quantity::printable", source.path))
}

#[test]
fn paths_are_shown_on_one_line() {
    assert_clean(sources(&LIBRARY).iter().filter_map(raw_paths).collect());
    assert!(raw_paths(&Source::new("src/cli/a.rs", "let shown = path.display();")).is_some());
    assert!(raw_paths(&Source::new("src/cli/a.rs", "let shown = printable(path);")).is_none());
}
