//! Text as HTML: what HTML reads otherwise, and symbols with italics and scripts.

/// Text with the characters that HTML reads otherwise replaced.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
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
    use super::symbol;

    #[test]
    fn symbols_have_italics_and_scripts() {
        assert_eq!(symbol("*x*_{1} − *x*_{2}"), "<i>x</i><sub>1</sub> − <i>x</i><sub>2</sub>");
        assert_eq!(symbol("*μ*_{s}^{+}"), "<i>μ</i><sub>s</sub><sup>+</sup>");
        assert_eq!(symbol("a < b"), "a &lt; b");
    }
}
