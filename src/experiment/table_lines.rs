//! The lines of a text and the cells of a line, as far as they are needed to find the table in a recording's file.

use csv::{ReaderBuilder, Trim};

/// A line of a text.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'t> {
    /// The byte at which it begins.
    pub at: usize,
    /// The byte at which the next one begins.
    pub next: usize,
    /// Its text without its end.
    pub text: &'t str,
}

impl Line<'_> {
    /// Whether there is nothing in it, or separators alone.
    pub fn is_blank(&self) -> bool {
        self.text.chars().all(|it| it.is_whitespace() || it == ';' || it == ',')
    }

    /// Whether it is a comment.
    pub fn is_comment(&self) -> bool {
        self.text.starts_with('#')
    }
}

/// The first lines of a text, so many at most; a line ends as on any system.
pub(super) fn first_lines(text: &str, most: usize) -> Vec<Line<'_>> {
    let (mut lines, mut at) = (Vec::new(), 0);
    while at < text.len() && lines.len() < most {
        let rest = &text[at..];
        let length = rest.find(['\n', '\r']).unwrap_or(rest.len());
        let end = match &rest.as_bytes()[length..] {
            [b'\r', b'\n', ..] => 2,
            [] => 0,
            _ => 1,
        };
        lines.push(Line { at, next: at + length + end, text: &rest[..length] });
        at += length + end;
    }
    lines
}

/// The cells of a line without those at its end that are empty.
pub(super) fn cells(line: &str, delimiter: u8) -> Vec<String> {
    let mut reader = ReaderBuilder::new()
        .delimiter(delimiter)
        .trim(Trim::All)
        .has_headers(false)
        .buffer_capacity(line.len().max(1))
        .from_reader(line.as_bytes());
    let record = reader.records().next().and_then(Result::ok).unwrap_or_default();
    let mut cells: Vec<String> = record.iter().map(str::to_owned).collect();
    while cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    cells
}

/// The name, the unit and what follows in a header's cell, written "name [unit] more", "name (unit) more", "name in unit" or "name / unit".
pub(super) fn name_and_unit(cell: &str) -> (&str, &str, &str) {
    for (open, close) in [(" [", "]"), ("[", "]"), (" (", ")"), ("(", ")")] {
        if let Some((name, rest)) = cell.split_once(open)
            && let Some((unit, more)) = rest.split_once(close)
        {
            return (name.trim(), unit.trim(), more.trim());
        }
    }
    for open in [" in ", "/"] {
        if let Some((name, unit)) = cell.split_once(open) {
            return (name.trim(), unit.trim(), "");
        }
    }
    (cell, "", "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_as_on_any_system() {
        let lines = first_lines("a\r\nb\rc\n\n", 9);
        let found: Vec<_> = lines.iter().map(|it| (it.at, it.next, it.text)).collect();
        assert_eq!(found, [(0, 3, "a"), (3, 5, "b"), (5, 7, "c"), (7, 8, "")]);
    }

    #[test]
    fn names_and_units_are_told_apart() {
        for (cell, expected) in [
            ("Time (s)", ("Time", "s", "")),
            ("T [s]", ("T", "s", "")),
            ("Time (s) Run #1", ("Time", "s", "Run #1")),
            ("x2 in mm", ("x2", "mm", "")),
            ("x2 / mm", ("x2", "mm", "")),
            ("x2", ("x2", "", "")),
            ("y2 [m/s]", ("y2", "m/s", "")),
        ] {
            assert_eq!(name_and_unit(cell), expected);
        }
        assert_eq!(cells("a;\"b;c\"; ;", b';'), ["a", "b;c"]);
    }
}
