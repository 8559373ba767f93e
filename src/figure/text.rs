//! Labels with italic symbols, subscripts and superscripts, from a short markup.

use std::fmt::Write as _;

use super::font::{self, Face};

/// Size of sub- and superscripts relative to the text.
const SCRIPT_SIZE: f64 = 0.7;

/// Where a run stands relative to the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Script {
    Line,
    Sub,
    Super,
}

impl Script {
    /// Shift down from the line, in sizes of the text.
    fn shift(self) -> f64 {
        match self {
            Script::Line => 0.0,
            Script::Sub => 0.18,
            Script::Super => -0.36,
        }
    }

    /// Size relative to the text.
    fn size(self) -> f64 {
        if self == Script::Line { 1.0 } else { SCRIPT_SIZE }
    }
}

/// Symbols by their names in TeX.
const SYMBOLS: [(&str, &str); 37] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("pi", "π"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("phi", "φ"),
    ("varphi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("Delta", "Δ"),
    ("Omega", "Ω"),
    ("Phi", "Φ"),
    ("cos", "cos\u{202f}"),
    ("sin", "sin\u{202f}"),
    ("sqrt", "√"),
    ("cdot", "·"),
    ("times", "×"),
    ("pm", "±"),
    ("le", "≤"),
    ("ge", "≥"),
    ("approx", "≈"),
    ("circ", "°"),
    (",", "\u{202f}"),
    ("%", "%"),
];

/// Characters in one face and position.
#[derive(Debug, Clone, PartialEq)]
struct Run {
    content: String,
    face: Face,
    script: Script,
}

/// A label ready to be set.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Text {
    runs: Vec<Run>,
}

impl Text {
    /// The label written as `*x*_{1} (10^{-3} mm)`: stars for italics, braces for scripts.
    pub fn markup(source: &str) -> Text {
        let mut text = Text::default();
        let (mut face, mut script) = (Face::Regular, Script::Line);
        let mut characters = source.chars().peekable();
        while let Some(character) = characters.next() {
            let opens = characters.peek() == Some(&'{');
            match character {
                '*' if face == Face::Italic => face = Face::Regular,
                '*' => face = Face::Italic,
                '_' | '^' if opens => {
                    characters.next();
                    script = if character == '_' { Script::Sub } else { Script::Super };
                }
                '}' if script != Script::Line => script = Script::Line,
                other => text.push(other, face, script),
            }
        }
        text
    }

    /// The label with symbols as in TeX between dollar signs: `$k_2$`, `$\\omega/\\omega_{1}$`. Letters are italic, those of
    /// sub- and superscripts upright, as in the labels of axes; what is not known stays as it is.
    pub fn tex(source: &str) -> Text {
        let parts: Vec<&str> = source.split('$').collect();
        if parts.len().is_multiple_of(2) {
            // A dollar sign without a second one is a dollar sign.
            return Text::plain(source);
        }
        let mut text = Text::default();
        for (number, part) in parts.into_iter().enumerate() {
            match number % 2 {
                0 => text = text.then(Text::plain(part)),
                _ => text.push_symbols(part),
            }
        }
        text
    }

    /// What is wrong with symbols between dollar signs, if anything is.
    pub fn tex_fault(source: &str) -> Option<String> {
        let parts: Vec<&str> = source.split('$').collect();
        if parts.len().is_multiple_of(2) {
            return Some(format!("\"{source}\" has a dollar sign without a second one"));
        }
        let symbols = parts.iter().skip(1).step_by(2);
        let commands = symbols.flat_map(|part| part.split('\\').skip(1));
        let unknown = commands.into_iter().find(|rest| !begins_with_symbol(rest))?;
        let end = unknown.find(|it: char| !it.is_alphabetic()).unwrap_or(unknown.len());
        let known: Vec<String> = SYMBOLS.iter().map(|(name, _)| format!("\\{name}")).collect();
        let name = &unknown[..end];
        Some(format!(
            "\"{source}\" has the unknown \\{name}; known are _, ^, {{}} and {}",
            known.join(" ")
        ))
    }

    /// Adds what stands between dollar signs.
    fn push_symbols(&mut self, source: &str) {
        let mut rest = source;
        let (mut script, mut is_group) = (Script::Line, false);
        while let Some(character) = rest.chars().next() {
            let named = rest.strip_prefix('\\').and_then(|rest| {
                let known = SYMBOLS.iter().filter(|(name, _)| rest.starts_with(name));
                known.max_by_key(|(name, _)| name.len())
            });
            if let Some((name, symbol)) = named {
                rest = rest[1 + name.len()..].trim_start();
                match symbol.chars().count() {
                    1 => symbol.chars().for_each(|it| self.push_symbol(it, script)),
                    // The name of a function is upright.
                    _ => symbol.chars().for_each(|it| self.push(it, Face::Regular, script)),
                }
            } else {
                rest = &rest[character.len_utf8()..];
                match character {
                    '_' | '^' => {
                        script = if character == '_' { Script::Sub } else { Script::Super };
                        is_group = rest.starts_with('{');
                        rest = rest.strip_prefix('{').unwrap_or(rest);
                        continue;
                    }
                    '}' if is_group => is_group = false,
                    '-' => self.push_symbol('\u{2212}', script),
                    other => self.push_symbol(other, script),
                }
            }
            if !is_group {
                script = Script::Line;
            }
        }
    }

    fn push_symbol(&mut self, character: char, script: Script) {
        let is_italic = character.is_alphabetic() && script == Script::Line;
        self.push(character, if is_italic { Face::Italic } else { Face::Regular }, script);
    }

    /// The label exactly as given, without markup.
    pub fn plain(source: &str) -> Text {
        Text::set(source, Face::Regular)
    }

    /// The label exactly as given, in bold.
    pub fn bold(source: &str) -> Text {
        Text::set(source, Face::Bold)
    }

    fn set(source: &str, face: Face) -> Text {
        Text { runs: vec![Run { content: source.to_string(), face, script: Script::Line }] }
    }

    fn push(&mut self, character: char, face: Face, script: Script) {
        match self.runs.last_mut() {
            Some(run) if run.face == face && run.script == script => run.content.push(character),
            _ => self.runs.push(Run { content: character.to_string(), face, script }),
        }
    }

    /// This label followed by `other`.
    pub fn then(mut self, other: Text) -> Text {
        self.runs.extend(other.runs);
        self
    }

    /// The label broken at its spaces into lines no wider than `width` at `size` [pt]; a word that
    /// is wider stands alone.
    pub fn wrapped(&self, width: f64, size: f64) -> Vec<Text> {
        let mut words = vec![Text::default()];
        for run in &self.runs {
            for (at, part) in run.content.split(' ').enumerate() {
                if at > 0 {
                    words.push(Text::default());
                }
                let word = words.last_mut().filter(|_| !part.is_empty());
                word.into_iter().for_each(|word| {
                    word.runs.push(Run { content: part.to_string(), ..run.clone() });
                });
            }
        }
        let mut lines: Vec<Text> = Vec::new();
        for word in words.into_iter().filter(|word| !word.runs.is_empty()) {
            let longer =
                lines.last().map(|line| line.clone().then(Text::plain(" ")).then(word.clone()));
            match (lines.last_mut(), longer) {
                (Some(line), Some(longer)) if longer.width(size) <= width => *line = longer,
                _ => lines.push(word),
            }
        }
        lines
    }

    /// Width at `size` [pt].
    pub fn width(&self, size: f64) -> f64 {
        let runs = self.runs.iter();
        let widths = runs.map(|run| font::width(run.face, &run.content) * run.script.size());
        widths.sum::<f64>() * size
    }

    /// Whether there is nothing to set.
    pub fn is_empty(&self) -> bool {
        self.runs.iter().all(|run| run.content.is_empty())
    }

    /// A character that the font lacks, if there is one.
    pub fn missing_glyph(&self) -> Option<char> {
        self.runs
            .iter()
            .find_map(|run| run.content.chars().find(|c| !font::has_glyph(run.face, *c)))
    }

    /// The characters alone.
    pub fn content(&self) -> String {
        self.runs.iter().map(|run| run.content.as_str()).collect()
    }

    /// The label as spans of an SVG text of `size`, in the units of the drawing.
    pub fn spans(&self, size: f64) -> String {
        let mut svg = String::new();
        let mut shift = 0.0;
        for run in &self.runs {
            svg.push_str("<tspan");
            let wanted = run.script.shift() * size;
            if wanted != shift {
                let _ = write!(svg, " dy=\"{:.1}\"", wanted - shift);
                shift = wanted;
            }
            if run.script != Script::Line {
                let _ = write!(svg, " font-size=\"{:.1}\"", size * SCRIPT_SIZE);
            }
            match run.face {
                Face::Regular => {}
                Face::Italic => svg.push_str(" font-style=\"italic\""),
                Face::Bold => svg.push_str(" font-weight=\"bold\""),
            }
            let _ = write!(svg, ">{}</tspan>", escape(&run.content));
        }
        svg
    }
}

/// Whether a text begins with the whole name of a symbol.
fn begins_with_symbol(text: &str) -> bool {
    SYMBOLS.iter().any(|(name, _)| {
        let rest = text.strip_prefix(name);
        rest.is_some_and(|rest| !rest.chars().next().is_some_and(char::is_alphabetic))
    })
}

/// The characters that XML reserves, written as entities.
pub fn escape(content: &str) -> String {
    content.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
