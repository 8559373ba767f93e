//! The formats that figures are written in.

/// A file format for figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Pixels, for screens and slides.
    Png,
    /// Vectors, for the web and for editing.
    Svg,
    /// Vectors, for papers.
    Pdf,
    /// The data behind the figure.
    Csv,
}

impl Format {
    /// The extension of file names.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Png => "png",
            Format::Svg => "svg",
            Format::Pdf => "pdf",
            Format::Csv => "csv",
        }
    }
}
