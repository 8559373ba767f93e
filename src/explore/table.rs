//! A table of a report: headings with units, numbers aligned at their points, unknown values as empty cells.

use super::escaped::escaped;
use super::numbers::signed;

/// A table of up to so many rows is not torn between pages.
const SHORT: usize = 30;
/// A table of more columns than this is set smaller on paper.
const MANY: usize = 8;

/// A table with a line of headings.
#[derive(Debug, Default)]
pub struct Table {
    /// What is seen in it.
    pub caption: String,
    /// The columns; the first names the rows.
    pub columns: Vec<Column>,
    /// The cells of each row.
    pub rows: Vec<Vec<Cell>>,
}

/// A column of a table.
#[derive(Debug, Clone)]
pub struct Column {
    heading: String,
    is_number: bool,
    is_long: bool,
}

/// A cell of a table.
#[derive(Debug, Clone, Default)]
pub struct Cell {
    /// What it shows.
    html: String,
    /// By what it is sorted among numbers, where what it shows is more than a number.
    value: Option<f64>,
}

impl Column {
    /// A column of words.
    pub fn text(heading: &str) -> Column {
        Column { heading: heading.to_owned(), is_number: false, is_long: false }
    }

    /// A column of sentences, which are broken into lines.
    pub fn long(heading: &str) -> Column {
        Column { is_long: true, ..Column::text(heading) }
    }

    /// A column of numbers.
    pub fn number(heading: &str) -> Column {
        Column { is_number: true, ..Column::text(heading) }
    }

    /// Its class of style, as an attribute.
    fn class(&self) -> &'static str {
        match (self.is_number, self.is_long) {
            (true, _) => "",
            (false, true) => " class=\"text long\"",
            (false, false) => " class=\"text\"",
        }
    }
}

impl Cell {
    /// A text, or a number as it is written; an empty one where nothing is known.
    pub fn text(text: impl AsRef<str>) -> Cell {
        Cell { html: escaped(&signed(text.as_ref())), value: None }
    }

    /// What is HTML already.
    pub fn html(html: String) -> Cell {
        Cell { html, value: None }
    }

    /// A number with something beside it, sorted by the number; NaN for none that is known.
    pub fn valued(text: &str, value: f64) -> Cell {
        Cell { value: Some(value), ..Cell::text(text) }
    }

    fn is_empty(&self) -> bool {
        self.html.is_empty()
    }

    /// How many decimals the number has that it shows; none where it shows no plain number.
    fn decimals(&self) -> Option<usize> {
        let plain = self.html.trim_start_matches('\u{2212}');
        let is_plain = plain.chars().all(|it| it.is_ascii_digit() || it == '.' || it == ' ');
        let decimals = plain.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        (is_plain && !plain.is_empty()).then_some(decimals)
    }
}

impl Table {
    /// Leaves out the columns behind the first in which nothing is known.
    pub fn without_empty_columns(mut self) -> Table {
        let is_kept = |column: usize| {
            column == 0
                || self.rows.iter().any(|row| row.get(column).is_some_and(|it| !it.is_empty()))
        };
        let kept: Vec<bool> = (0..self.columns.len()).map(is_kept).collect();
        retain(&mut self.columns, &kept);
        self.rows.iter_mut().for_each(|row| retain(row, &kept));
        self
    }

    /// Its classes of style.
    pub fn class(&self) -> String {
        let short = if self.rows.len() <= SHORT { " short" } else { "" };
        let many = if self.columns.len() > MANY { " many" } else { "" };
        format!("table{short}{many}")
    }

    /// Its head and its rows.
    pub fn html(&self) -> String {
        let headings = self.columns.iter().map(|column| {
            format!("<th scope=\"col\"{}>{}</th>", column.class(), escaped(&column.heading))
        });
        let mut html =
            format!("<thead><tr>{}</tr></thead>\n<tbody>\n", headings.collect::<String>());
        let decimals: Vec<usize> =
            (0..self.columns.len()).map(|it| self.most_decimals(it)).collect();
        for row in &self.rows {
            let cells = row.iter().zip(&self.columns).zip(&decimals).enumerate();
            let cells: String = cells
                .map(|(place, ((cell, column), decimals))| {
                    written(cell, column, *decimals, place == 0)
                })
                .collect();
            html.push_str(&format!("<tr>{cells}</tr>\n"));
        }
        html + "</tbody>"
    }

    /// The most decimals in a column of plain numbers; zero where there are others.
    fn most_decimals(&self, column: usize) -> usize {
        let cells = self.rows.iter().filter_map(|row| row.get(column));
        let decimals: Option<Vec<usize>> =
            cells.filter(|it| !it.is_empty()).map(Cell::decimals).collect();
        decimals.and_then(|all| all.into_iter().max()).unwrap_or(0)
    }
}

/// A cell with room behind a number that has fewer decimals than others of its column, so that their points stand below each other.
fn written(cell: &Cell, column: &Column, most: usize, is_first: bool) -> String {
    let missing = cell.decimals().map_or(0, |it| most.saturating_sub(it));
    // The point takes half the width of a digit.
    let without_point = missing > 0 && cell.decimals() == Some(0);
    let room = missing as f64 + if without_point { 0.5 } else { 0.0 };
    let pad = match column.is_number && room > 0.0 {
        true => format!(" style=\"--pad: {room}ch\""),
        false => String::new(),
    };
    let value = cell.value.filter(|_| column.is_number).map_or(String::new(), |value| {
        let value = if value.is_finite() { value.to_string() } else { String::new() };
        format!(" data-value=\"{value}\"")
    });
    let (class, content) = (column.class(), &cell.html);
    match is_first {
        true => format!("<th scope=\"row\"{class}{pad}{value}>{content}</th>"),
        false => format!("<td{class}{pad}{value}>{content}</td>"),
    }
}

/// Keeps the members of a list that are kept.
fn retain<T>(all: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    all.retain(|_| kept.next().copied().unwrap_or(true));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(cells: &[&str]) -> Table {
        let row = |text: &&str| vec![Cell::text("row"), Cell::text(text), Cell::default()];
        Table {
            columns: vec![Column::text(""), Column::number("x [m]"), Column::number("y")],
            rows: cells.iter().map(row).collect(),
            caption: String::new(),
        }
    }

    #[test]
    fn points_of_numbers_stand_below_each_other() {
        let html = column(&["-1.25", "3", "0.5", ""]).html();
        assert!(html.contains("<td>\u{2212}1.25</td>"), "{html}");
        assert!(html.contains("<td style=\"--pad: 2.5ch\">3</td>"), "{html}");
        assert!(html.contains("<td style=\"--pad: 1ch\">0.5</td>"), "{html}");
        let html = column(&["1.25", "3e-9"]).html();
        assert!(!html.contains("--pad"), "{html}");
    }

    #[test]
    fn columns_of_which_nothing_is_known_are_left_out() {
        let html = column(&["1", "2"]).without_empty_columns().html();
        assert!(html.contains("x [m]") && !html.contains(">y<"), "{html}");
    }

    #[test]
    fn cells_with_more_than_a_number_are_sorted_by_it() {
        let mut table = column(&["1"]);
        table.rows[0][1] = Cell::valued("fold at -1.5 %", -1.5);
        assert!(table.html().contains("<td data-value=\"-1.5\">fold at \u{2212}1.5 %</td>"));
        table.rows[0][1] = Cell::valued("not known", f64::NAN);
        assert!(table.html().contains("<td data-value=\"\">not known</td>"));
    }
}
