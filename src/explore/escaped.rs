//! Text as HTML: what HTML reads otherwise, and symbols with italics and scripts.

use super::numbers::signed;

/// Text with the characters that HTML reads otherwise replaced.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A sentence as HTML: what stands between backticks is code, and numbers have minus signs.
pub fn sentence(text: &str) -> String {
    let parts: Vec<&str> = text.split('`').collect();
    if parts.len().is_multiple_of(2) {
        // A backtick without a second one is a backtick.
        return escaped(&signed(text));
    }
    let written = parts.iter().enumerate().map(|(place, part)| match place % 2 {
        0 => escaped(&signed(part)),
        _ => format!("<code>{}</code>", escaped(part)),
    });
    written.collect()
}

/// A symbol in the markup of labels, `*x*_{1}`: stars for italics, braces for scripts.
pub fn symbol(markup: &str) -> String {
    let mut html = String::new();
    let (mut is_italic, mut script) = (false, None);
    let mut characters = markup.chars().peekable();
    while let Some(character) = characters.next() {
        let opens = characters.peek() == Some(&'{');
        match character {
            '*' => {
                html.push_str(if is_italic { "</i>" } else { "<i>" });
                is_italic = !is_italic;
            }
            '_' | '^' if opens => {
                characters.next();
                let element = if character == '_' { "sub" } else { "sup" };
                html.push_str(&format!("<{element}>"));
                script = Some(element);
            }
            '}' if script.is_some() => {
                html.push_str(&format!("</{}>", script.take().unwrap_or_default()));
            }
            other => html.push_str(&escaped(&other.to_string())),
        }
    }
    if is_italic {
        html.push_str("</i>");
    }
    html
}

#[cfg(test)]
mod tests {
    use super::{sentence, symbol};

    #[test]
    fn what_stands_between_backticks_is_code() {
        assert_eq!(sentence("by `a < -1` at -1"), "by <code>a &lt; -1</code> at \u{2212}1");
        assert_eq!(sentence("a ` b"), "a ` b");
    }

    #[test]
    fn symbols_have_italics_and_scripts() {
        assert_eq!(symbol("*x*_{1} − *x*_{2}"), "<i>x</i><sub>1</sub> − <i>x</i><sub>2</sub>");
        assert_eq!(symbol("*μ*_{s}^{+}"), "<i>μ</i><sub>s</sub><sup>+</sup>");
        assert_eq!(symbol("a < b"), "a &lt; b");
    }
}
