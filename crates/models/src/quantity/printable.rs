//! Names and paths as messages show them: on one line, with nothing in them that a terminal obeys.

use std::borrow::Cow;
use std::fmt;
use std::path::Path;

/// Characters of a text from a file that a message shows at most.
const LONGEST: usize = 80;

/// Whether a terminal obeys a character rather than shows it: control characters, the ends of lines and tabs among them, and
/// those that change the direction of a text.
pub fn is_obeyed(c: char) -> bool {
    let turns =
        matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || c.is_control()
}

/// A character that a terminal obeys by its number, as JSON writes it.
pub fn numbered(c: char) -> String {
    format!("\\u{:04x}", u32::from(c))
}

/// A text on one line: line ends, tabs and all else that a terminal obeys are escaped.
pub fn one_line(text: &str) -> Cow<'_, str> {
    if !text.contains(is_obeyed) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.chars().map(escaped).collect())
}

fn escaped(c: char) -> String {
    match c {
        '\n' => "\\n".to_owned(),
        '\r' => "\\r".to_owned(),
        '\t' => "\\t".to_owned(),
        c if is_obeyed(c) => numbered(c),
        c => c.to_string(),
    }
}

/// The same of its first characters, for a text that may be long.
pub fn excerpt(text: &str) -> Cow<'_, str> {
    match text.char_indices().nth(LONGEST) {
        None => one_line(text),
        Some((end, _)) => Cow::Owned(format!("{} ...", one_line(&text[..end]))),
    }
}

/// A path as messages show it, on one line.
pub fn printable(path: &Path) -> Printable<'_> {
    Printable(path)
}

/// A path that is shown on one line.
#[derive(Debug, Clone, Copy)]
pub struct Printable<'p>(&'p Path);

impl fmt::Display for Printable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&one_line(&self.0.to_string_lossy()))
    }
}
