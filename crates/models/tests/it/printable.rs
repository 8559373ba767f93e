//! Names and paths on one line.

use std::path::Path;

use capsulemap_models::quantity::printable::{excerpt, printable};

#[test]
fn names_are_shown_on_one_line_and_cut() {
    assert_eq!(printable(Path::new("a b/\u{b5}.csv")).to_string(), "a b/\u{b5}.csv");
    assert_eq!(
        printable(Path::new("a\nb\t\u{1b}[2J\u{202e}")).to_string(),
        "a\\nb\\t\\u001b[2J\\u202e"
    );
    assert_eq!(excerpt(&"\u{b5}".repeat(80)), "\u{b5}".repeat(80));
    assert_eq!(excerpt(&"\u{b5}\n".repeat(41)), "\u{b5}\\n".repeat(40) + " ...");
}
