//! The data behind a figure: the points, lines and cells that it draws, as CSV in the units of its axes.

use std::fmt::Write as _;

/// What a row tells beside its place.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// Nothing.
    None,
    /// A number, in the unit that the name of its series tells.
    Number(f64),
    /// A kind.
    Name(String),
}

/// A point, a corner of a line or a cell.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    /// Which panel it is on, from 1.
    panel: usize,
    /// Which of the series.
    series: usize,
    at: (f64, f64),
    value: Value,
}

/// What the panels of a figure show.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Data {
    /// The heading of each panel, empty where there is none, and what its axes show.
    panels: Vec<(String, [String; 2])>,
    /// The names of what is drawn.
    series: Vec<String>,
    rows: Vec<Row>,
}

impl Data {
    /// Adds a panel with its heading and what its axes show.
    pub fn add_panel(&mut self, heading: &str, axes: [String; 2]) {
        self.panels.push((heading.replace('\u{a0}', " "), axes));
    }

    /// Adds the rows of a series on a panel.
    pub fn add(
        &mut self,
        panel: usize,
        series: &str,
        rows: impl Iterator<Item = ((f64, f64), Value)>,
    ) {
        let known = self.series.iter().position(|name| name == series);
        let place = known.unwrap_or(self.series.len());
        if known.is_none() {
            self.series.push(series.to_owned());
        }
        self.rows.extend(rows.map(|(at, value)| Row { panel, series: place, at, value }));
    }

    /// The rows as CSV below comments that tell what they are; a value that is missing has an empty field.
    pub fn text(&self, about: &str) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "# {}", on_line(about));
        for (number, (heading, [x, y])) in self.panels.iter().enumerate() {
            let number = number + 1;
            let heading = if heading.is_empty() { heading } else { &format!(" ({heading})") };
            let [heading, x, y] = [heading, x, y].map(|it| on_line(it));
            let _ = writeln!(text, "# panel {number}{heading}: x is {x}, y is {y}");
        }
        text.push_str("panel,series,x,y,value\n");
        for Row { panel, series, at: (x, y), value } in &self.rows {
            let value = match value {
                Value::None => String::new(),
                Value::Number(number) => field(*number),
                Value::Name(name) => quoted(name),
            };
            let series = quoted(&self.series[*series]);
            let _ = writeln!(text, "{panel},{series},{},{},{value}", field(*x), field(*y));
        }
        text
    }
}

/// A number with all its digits.
fn field(number: f64) -> String {
    if number.is_nan() { String::new() } else { number.to_string() }
}

/// A text without breaks of lines.
fn on_line(text: &str) -> String {
    text.replace(['\n', '\r'], " ")
}

/// A text as a field.
fn quoted(text: &str) -> String {
    let text = on_line(text);
    match text.contains([',', '"']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text,
    }
}
