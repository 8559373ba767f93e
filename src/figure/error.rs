//! What can go wrong when a figure is drawn.

use std::fmt;
use std::path::PathBuf;

use crate::quantity::printable::printable;
use crate::store::StoreError;
use crate::study::document::nearest;

/// Why a figure could not be drawn.
#[derive(Debug)]
pub enum FigureError {
    /// The figure needs a variable or an axis that the results do not hold.
    Missing {
        /// Name of the figure.
        figure: String,
        /// "variable" or "axis".
        what: &'static str,
        /// The name that was asked for.
        name: String,
        /// The names there are.
        present: Vec<String>,
    },
    /// What was asked for does not fit the results or the kind of figure.
    Unfit {
        /// Name of the figure.
        figure: String,
        /// What does not fit, and what would.
        why: String,
    },
    /// A label holds a character that the embedded font cannot draw.
    Glyph {
        /// Name of the figure.
        figure: String,
        /// The character.
        character: char,
        /// The label it stands in.
        label: String,
    },
    /// The drawing could not be turned into a file format.
    Render {
        /// Name of the figure.
        figure: String,
        /// What the renderer said.
        why: String,
    },
    /// A file could not be written.
    Write {
        /// Name of the figure.
        figure: String,
        /// The file, and what the system said.
        source: StoreError,
    },
    /// A file is in the place of a figure that this program did not write, or that was changed since.
    Occupied {
        /// Name of the figure.
        figure: String,
        /// The file.
        path: PathBuf,
    },
}

impl fmt::Display for FigureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FigureError::Missing { figure, what, name, present } => {
                write!(f, "figure `{figure}`: the results hold no {what} `{name}`")?;
                if let Some(other) = nearest(name, present.iter().map(String::as_str)) {
                    write!(f, "; did you mean `{other}`?")?;
                }
                match present.is_empty() {
                    true => write!(f, " (there is none)"),
                    false => write!(f, " (there is: {})", present.join(", ")),
                }
            }
            FigureError::Unfit { figure, why } => write!(f, "figure `{figure}`: {why}"),
            FigureError::Glyph { figure, character, label } => write!(
                f,
                "figure `{figure}`: the font has no character `{character}` (U+{:04X}) for the \
                 label \"{label}\"",
                u32::from(*character)
            ),
            FigureError::Render { figure, why } => {
                write!(f, "figure `{figure}`: the drawing could not be rendered: {why}")
            }
            FigureError::Write { figure, source } => write!(f, "figure `{figure}`: {source}"),
            FigureError::Occupied { figure, path } => write!(
                f,
                "figure `{figure}`: {}: exists, and capsulemap did not draw it or it was changed since; it is not replaced",
                printable(path)
            ),
        }
    }
}

impl std::error::Error for FigureError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            FigureError::Write { source, .. } => Some(source),
            _ => None,
        }
    }
}
