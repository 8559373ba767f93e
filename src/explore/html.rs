//! The parts of a report: numbered sections, figures and tables, with references to them, as HTML that needs nothing from outside.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::escaped::{escaped, sentence};
use super::table::Table;
use crate::figure::Picture;

/// How the page looks on screens and on paper.
const STYLE: &str = include_str!("report/style.css");
/// What sorts and copies tables; the page is whole without it.
const SCRIPT: &str = include_str!("report/tables.js");

/// Pictures are this much wider than in print, as screens are farther from the eye.
const ENLARGED: f64 = 1.4;
/// A text of up to so many lines is not torn between pages.
const SHORT: usize = 30;

/// Tells a page of this program.
pub const GENERATOR: &str = "<meta name=\"generator\" content=\"capsulemap\">";

/// What a reference leads to, by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Item {
    /// A figure.
    Figure(usize),
    /// A table.
    Table(usize),
}

impl Item {
    /// Its name as the page has it: "Figure 3".
    fn name(self) -> String {
        match self {
            Item::Figure(number) => format!("Figure {number}"),
            Item::Table(number) => format!("Table {number}"),
        }
    }

    fn anchor(self) -> String {
        self.name().to_lowercase().replace(' ', "-")
    }
}

/// A paragraph with references.
#[derive(Debug, Clone, Default)]
pub struct Prose(String);

impl Prose {
    /// A paragraph that goes on with a text.
    pub fn and(self, text: &str) -> Prose {
        Prose(self.0 + &sentence(text))
    }

    /// A paragraph that goes on with a reference.
    pub fn see(self, item: Item) -> Prose {
        Prose(self.0 + &format!("<a href=\"#{}\">{}</a>", item.anchor(), item.name()))
    }
}

impl From<&str> for Prose {
    fn from(text: &str) -> Prose {
        Prose::default().and(text)
    }
}

impl From<String> for Prose {
    fn from(text: String) -> Prose {
        Prose::from(text.as_str())
    }
}

/// A heading of a page.
#[derive(Debug)]
struct Heading {
    /// Its number: "2", or "2.1" within a section.
    number: String,
    text: String,
}

/// A page that is being written.
#[derive(Debug, Default)]
pub struct Page {
    body: String,
    /// What the sections tell in short.
    in_short: Vec<String>,
    headings: Vec<Heading>,
    /// Sections, sections within the last of them, figures and tables so far.
    sections: [usize; 2],
    figures: usize,
    tables: usize,
}

impl Page {
    /// Begins a section.
    pub fn section(&mut self, heading: &str) {
        self.sections = [self.sections[0] + 1, 0];
        self.begin("h2", self.sections[0].to_string(), heading);
    }

    /// Begins a section within a section.
    pub fn subsection(&mut self, heading: &str) {
        self.sections[1] += 1;
        let [outer, inner] = self.sections;
        self.begin("h3", format!("{outer}.{inner}"), heading);
    }

    fn begin(&mut self, element: &str, number: String, heading: &str) {
        // Writing to a String cannot fail.
        let _ = writeln!(
            self.body,
            "<{element} id=\"section-{number}\"><span class=\"number\">{number}</span>{}</{element}>",
            escaped(heading)
        );
        self.headings.push(Heading { number, text: heading.to_owned() });
    }

    /// Tells a sentence in the summary that stands first.
    pub fn sum_up(&mut self, sentence: impl Into<String>) {
        self.in_short.push(sentence.into());
    }

    /// A paragraph.
    pub fn text(&mut self, text: impl Into<Prose>) {
        let _ = writeln!(self.body, "<p>{}</p>", text.into().0);
    }

    /// A paragraph of less weight.
    pub fn note(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p class=\"note\">{}</p>", sentence(text));
    }

    /// Text as it is, with its lines.
    pub fn verbatim(&mut self, text: &str) {
        let class = if text.lines().count() <= SHORT { " class=\"short\"" } else { "" };
        let _ = writeln!(self.body, "<pre{class}>{}</pre>", escaped(text));
    }

    /// The table that comes next.
    pub fn next_table(&self) -> Item {
        Item::Table(self.tables + 1)
    }

    /// The figure that comes next.
    pub fn next_figure(&self) -> Item {
        Item::Figure(self.figures + 1)
    }

    /// A table with its caption above it.
    pub fn table(&mut self, table: &Table) {
        self.tables += 1;
        let item = Item::Table(self.tables);
        let (anchor, name) = (item.anchor(), item.name());
        let (class, caption, content) = (table.class(), sentence(&table.caption), table.html());
        let _ = writeln!(
            self.body,
            "<div class=\"{class}\" id=\"{anchor}\">\n<div class=\"head\"><p class=\"caption\" id=\"{anchor}-caption\"><b>{name}.</b> \
             {caption}</p></div>\n<div class=\"wide\" role=\"group\" aria-labelledby=\"{anchor}-caption\">\
             <table aria-labelledby=\"{anchor}-caption\">\n{content}</table></div>\n</div>"
        );
    }

    /// Pictures beside each other with their caption below them.
    pub fn pictures(&mut self, pictures: &[Picture], caption: &str) {
        self.figures += 1;
        let item = Item::Figure(self.figures);
        let (anchor, name) = (item.anchor(), item.name());
        let class = if pictures.len() > 1 { "row pair" } else { "row" };
        let _ = writeln!(self.body, "<figure id=\"{anchor}\">\n<div class=\"{class}\">");
        for Picture { png, about, width_mm, .. } in pictures {
            let (data, about) = (STANDARD.encode(png), escaped(about));
            let width_mm = ENLARGED * width_mm;
            let _ = writeln!(
                self.body,
                "<img style=\"width: {width_mm:.0}mm\" alt=\"{about}\" src=\"data:image/png;base64,{data}\">"
            );
        }
        let _ = writeln!(
            self.body,
            "</div>\n<figcaption><b>{name}.</b> {}</figcaption>\n</figure>",
            sentence(caption)
        );
    }

    /// The whole page under a title, with facts about it by their names.
    pub fn finish(self, title: &str, facts: &[(&str, String)]) -> String {
        let title = escaped(title);
        let (facts, contents) = (listed(facts), self.contents());
        let in_short = sentence(&self.in_short.join(" "));
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n{GENERATOR}\n<title>{title}</title>\n\
             <style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n<dl class=\"facts\">\n{facts}</dl>\n</header>\n<main>\n\
             <section class=\"abstract\" aria-labelledby=\"abstract\">\n<h2 id=\"abstract\">Abstract</h2>\n<p>{in_short}</p>\n</section>\n\
             <nav aria-labelledby=\"contents\">\n<h2 id=\"contents\">Contents</h2>\n<ol>\n{contents}</ol>\n</nav>\n{}</main>\n\
             <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
            self.body
        )
    }

    /// The headings with links to them.
    fn contents(&self) -> String {
        let lines = self.headings.iter().map(|Heading { number, text }| {
            let class = if number.contains('.') { " class=\"inner\"" } else { "" };
            format!(
                "<li{class}><span class=\"number\">{number}</span><a href=\"#section-{number}\">{}</a></li>\n",
                escaped(text)
            )
        });
        lines.collect()
    }
}

/// Facts by their names.
fn listed(facts: &[(&str, String)]) -> String {
    let lines = facts
        .iter()
        .map(|(name, fact)| format!("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(fact)));
    lines.collect()
}

#[cfg(test)]
mod tests {
    use super::super::table::{Cell, Column};
    use super::*;

    #[test]
    fn nothing_in_a_text_is_read_as_html() {
        let mut page = Page::default();
        page.section("a < b & \"c\"");
        let table = Table {
            caption: "<caption>".to_owned(),
            columns: vec![Column::text("<th>")],
            rows: vec![vec![Cell::text("</table>")]],
        };
        page.table(&table);
        page.text(Prose::from("<p>").see(Item::Table(1)));
        let html = page.finish("<script>", &[("<dt>", "<dd>".to_owned())]);
        assert!(html.matches("<script>").count() == 1 && html.matches("</table>").count() == 1);
        assert!(html.contains("</span>a &lt; b &amp; &quot;c&quot;</h2>"));
        assert!(html.contains("<p>&lt;p&gt;<a href=\"#table-1\">Table 1</a></p>"));
    }
}
