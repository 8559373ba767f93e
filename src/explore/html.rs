//! The parts of a page: text, tables and pictures as HTML that needs nothing from outside.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::figure::Picture;

/// How the page looks; colours of text and rules alone, so that it prints as it is.
const STYLE: &str = "\
body { max-width: 62rem; margin: 2rem auto; padding: 0 1rem; font: 16px/1.5 Georgia, serif; color: #111; }\n\
h1, h2, h3 { line-height: 1.2; } h2 { margin-top: 2.2rem; border-bottom: 1px solid #999; }\n\
table { border-collapse: collapse; font-size: 0.9rem; } .wide { overflow-x: auto; }\n\
th, td { padding: 0.15rem 0.6rem; text-align: right; max-width: 16rem; } th { border-bottom: 1px solid #111; vertical-align: bottom; }\n\
th:first-child, td:first-child { text-align: left; } td.text { text-align: left; }\n\
figure { margin: 1.2rem 0; } figcaption { font-size: 0.9rem; } img { max-width: 100%; height: auto; }\n\
.row { display: flex; flex-wrap: wrap; gap: 1rem; align-items: flex-start; }\n\
pre { background: #f4f4f4; padding: 0.6rem; white-space: pre-wrap; overflow-wrap: anywhere; font-size: 0.82rem; line-height: 1.35; }\n\
nav a { margin-right: 1rem; } .note { color: #555; font-size: 0.9rem; }\n";

/// Pictures are this much wider than in print, as screens are farther from the eye.
const ENLARGED: f64 = 1.4;

/// Tells a page of this program.
pub const GENERATOR: &str = "<meta name=\"generator\" content=\"capsulemap\">";

/// A page that is being written.
#[derive(Debug, Default)]
pub struct Page {
    body: String,
    /// The headings of its parts.
    parts: Vec<String>,
}

impl Page {
    /// Begins a part.
    pub fn part(&mut self, heading: &str) {
        let number = self.parts.len() + 1;
        // Writing to a String cannot fail.
        let _ = writeln!(self.body, "<h2 id=\"part-{number}\">{}</h2>", escaped(heading));
        self.parts.push(heading.to_owned());
    }

    /// A heading within a part.
    pub fn heading(&mut self, heading: &str) {
        let _ = writeln!(self.body, "<h3>{}</h3>", escaped(heading));
    }

    /// A paragraph.
    pub fn text(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", escaped(text));
    }

    /// A paragraph of less weight.
    pub fn note(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p class=\"note\">{}</p>", escaped(text));
    }

    /// Text as it is, with its lines.
    pub fn verbatim(&mut self, text: &str) {
        let _ = writeln!(self.body, "<pre>{}</pre>", escaped(text));
    }

    /// A table with a line of headings; the first column is text.
    pub fn table(&mut self, headings: &[String], rows: &[Vec<String>]) {
        let _ =
            writeln!(self.body, "<div class=\"wide\"><table>\n<tr>{}</tr>", cells(headings, "th"));
        for row in rows {
            let _ = writeln!(self.body, "<tr>{}</tr>", cells(row, "td"));
        }
        self.body.push_str("</table></div>\n");
    }

    /// Pictures beside each other, with what is said of them.
    pub fn pictures(&mut self, pictures: &[Picture], caption: &str) {
        self.body.push_str("<figure>\n<div class=\"row\">\n");
        for Picture { png, about, width_mm, .. } in pictures {
            let (data, about) = (STANDARD.encode(png), escaped(about));
            let width_mm = ENLARGED * width_mm;
            let _ = writeln!(
                self.body,
                "<img style=\"width: {width_mm:.0}mm\" alt=\"{about}\" src=\"data:image/png;base64,{data}\">"
            );
        }
        let _ =
            writeln!(self.body, "</div>\n<figcaption>{}</figcaption>\n</figure>", escaped(caption));
    }

    /// The whole page under a title.
    pub fn finish(self, title: &str) -> String {
        let title = escaped(title);
        let links: String = self
            .parts
            .iter()
            .enumerate()
            .map(|(place, part)| format!("<a href=\"#part-{}\">{}</a>", place + 1, escaped(part)))
            .collect();
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n{GENERATOR}\n<title>{title}</title>\n\
             <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<nav>{links}</nav>\n{}</body>\n</html>\n",
            self.body
        )
    }
}

/// The cells of a line of a table, each in an element of this kind.
fn cells(cells: &[String], kind: &str) -> String {
    cells.iter().map(|it| format!("<{kind}>{}</{kind}>", escaped(it))).collect()
}

/// Text with the characters that HTML reads otherwise replaced.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::Page;

    #[test]
    fn nothing_in_a_text_is_read_as_html() {
        let mut page = Page::default();
        page.part("a < b & \"c\"");
        page.table(&["<th>".to_owned()], &[vec!["</table>".to_owned()]]);
        let html = page.finish("<script>");
        assert!(!html.contains("<script>") && html.matches("</table>").count() == 1);
        assert!(html.contains("<h2 id=\"part-1\">a &lt; b &amp; &quot;c&quot;</h2>"));
    }
}
