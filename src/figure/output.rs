//! From a drawing to files: SVG with outlined text, PNG, PDF and the data behind it, each complete or absent.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use krilla::Document;
use krilla::geom::Size;
use krilla::metadata::Metadata;
use krilla::page::PageSettings;
use krilla_svg::{SurfaceExt, SvgSettings};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree, WriteOptions};

use super::error::FigureError;
use super::font;
use super::format::Format;
use super::mark;
use super::origin::Origin;
use super::style::FAMILY;
use super::text::escape;
use crate::store;

/// Where figures are written.
#[derive(Debug, Clone, Copy)]
pub struct Place<'a> {
    /// Their folder.
    pub folder: &'a Path,
    /// Their formats.
    pub formats: &'a [Format],
    /// Whether they replace files that this program did not write, or that were changed since.
    pub overwrite: bool,
}

impl Place<'_> {
    /// The file of a figure in a format.
    fn path(&self, name: &str, format: Format) -> PathBuf {
        self.folder.join(format!("{name}.{}", format.extension()))
    }

    /// Whether a figure, and the data behind it if it has them, can be written there: fails if a file is in its place that is no
    /// figure of this program.
    pub fn check(&self, name: &str, has_data: bool) -> Result<(), FigureError> {
        let of_data = has_data.then_some(&Format::Csv);
        for &format in self.formats.iter().chain(of_data) {
            let path = self.path(name, format);
            store::place(&path)
                .map_err(|source| FigureError::Write { figure: name.to_string(), source })?;
            if self.overwrite {
                continue;
            }
            match fs::read(&path) {
                Ok(bytes) if mark::is_valid(format, &bytes) => {}
                Err(said) if said.kind() == ErrorKind::NotFound => {}
                _ => return Err(FigureError::Occupied { figure: name.to_string(), path }),
            }
        }
        Ok(())
    }
}

/// A figure ready to be written.
pub struct Figure<'a> {
    /// Its name, the stem of its files.
    pub name: &'a str,
    /// What it shows.
    pub about: &'a str,
    /// The drawing.
    pub svg: &'a str,
    /// The data behind it as CSV, if they are to be written.
    pub data: Option<String>,
    /// Whether its SVG keeps text as text, which looks the same only where the font is.
    pub keeps_text: bool,
    /// Where it comes from; none in a picture that is shown at once.
    pub origin: Option<&'a Origin>,
    /// Dots per inch of its pixels.
    pub dpi: f64,
}

impl Figure<'_> {
    /// Writes the figure to its place in each of its formats; says which files came out.
    pub fn write(&self, place: &Place<'_>) -> Result<Vec<PathBuf>, FigureError> {
        let Place { folder, formats, .. } = *place;
        place.check(self.name, self.data.is_some())?;
        let tree = self.tree()?;
        if !formats.is_empty() {
            store::create_folder(folder)
                .map_err(|source| FigureError::Write { figure: self.name.to_string(), source })?;
        }
        let mut paths = Vec::new();
        let of_data = self.data.iter().filter(|_| !formats.is_empty()).map(|_| &Format::Csv);
        for format in formats.iter().chain(of_data) {
            let bytes = match format {
                Format::Csv => self.data.clone().unwrap_or_default().into_bytes(),
                Format::Svg if self.keeps_text => self.svg.as_bytes().to_vec(),
                Format::Png => self.png(&tree)?,
                Format::Svg => self.outlined(&tree).into_bytes(),
                Format::Pdf => self.pdf(&tree)?,
            };
            let path = place.path(self.name, *format);
            self.replace(&path, &mark::add(*format, bytes))?;
            paths.push(path);
        }
        Ok(paths)
    }

    /// The figure as the bytes of a PNG file, and its width [mm].
    pub fn raster(&self) -> Result<(Vec<u8>, f64), FigureError> {
        let tree = self.tree()?;
        // A length of 96 in the tree is an inch.
        Ok((self.png(&tree)?, f64::from(tree.size().width()) / 96.0 * 25.4))
    }

    fn tree(&self) -> Result<Tree, FigureError> {
        let options =
            Options { fontdb: font::database(), font_family: FAMILY.into(), ..Options::default() };
        Tree::from_str(self.svg, &options).map_err(|e| self.render(e.to_string()))
    }

    /// The drawing with its text as outlines, so that it looks the same without our fonts.
    fn outlined(&self, tree: &Tree) -> String {
        let options = WriteOptions { coordinates_precision: 3, ..WriteOptions::default() };
        let svg = tree.to_string(&options);
        let shapes = svg.split_once('>').map_or("", |(_, shapes)| shapes);
        let (width, height) = (tree.size().width(), tree.size().height());
        // A start of our own: with the size in points, and a view box so that it can be scaled.
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" \
             xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{:.2}pt\" height=\"{:.2}pt\" \
             viewBox=\"0 0 {width} {height}\">\n    <title>{}</title>\n    <desc>{}</desc>{shapes}",
            width * 0.75,
            height * 0.75,
            escape(self.name),
            escape(self.about)
        )
    }

    fn png(&self, tree: &Tree) -> Result<Vec<u8>, FigureError> {
        // A length of 96 in the tree is an inch.
        let scale = (self.dpi / 96.0) as f32;
        let [width, height] =
            [tree.size().width(), tree.size().height()].map(|it| (it * scale).round() as u32);
        let pixmap = Pixmap::new(width, height);
        let mut pixmap = pixmap.ok_or_else(|| self.render("it is too large".to_string()))?;
        pixmap.fill(Color::WHITE);
        resvg::render(tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
        let pixels: Vec<u8> =
            pixmap.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        encode([width, height], self.dpi, &pixels, &self.texts())
            .map_err(|error| self.render(error.to_string()))
    }

    /// What a PNG file says of itself, by the usual keys.
    fn texts(&self) -> Vec<(&'static str, String)> {
        let mut texts = vec![("Description", self.about.to_string())];
        if let Some(origin) = self.origin {
            texts.push(("Software", origin.program.clone()));
            texts.extend(origin.time.iter().map(|it| ("Creation Time", it.clone())));
            texts.extend(origin.study.iter().map(|it| ("Source", format!("study {it}"))));
        }
        texts
    }

    fn pdf(&self, tree: &Tree) -> Result<Vec<u8>, FigureError> {
        // A point is 1/72 inch, a length in the tree 1/96.
        let (width, height) = (tree.size().width() * 0.75, tree.size().height() * 0.75);
        let both = PageSettings::from_wh(width, height).zip(Size::from_wh(width, height));
        let (settings, size) = both.ok_or_else(|| self.render("it has no size".to_string()))?;
        let mut document = Document::new();
        let metadata =
            Metadata::new().title(self.name.to_string()).description(self.about.to_string());
        document.set_metadata(match self.origin {
            Some(origin) => {
                let keywords = origin.study.iter().map(|it| format!("study {it}")).collect();
                let metadata = metadata.creator(origin.program.clone()).keywords(keywords);
                match origin.of_pdf() {
                    Some(time) => metadata.creation_date(time),
                    None => metadata,
                }
            }
            None => metadata,
        });
        let mut page = document.start_page_with(settings);
        let mut surface = page.surface();
        let drawn = surface.draw_svg(tree, size, SvgSettings::default());
        surface.finish();
        page.finish();
        drawn.ok_or_else(|| self.render("a shape has no form in PDF".to_string()))?;
        document.finish().map_err(|error| self.render(format!("{error:?}")))
    }

    /// Puts `bytes` at `path` in one step, so that no reader meets half a file; what killed runs have left of it goes.
    fn replace(&self, path: &Path, bytes: &[u8]) -> Result<(), FigureError> {
        store::discard_abandoned(path)
            .and_then(|()| store::put(path, bytes))
            .map_err(|source| FigureError::Write { figure: self.name.to_string(), source })
    }

    fn render(&self, why: String) -> FigureError {
        FigureError::Render { figure: self.name.to_string(), why }
    }
}

/// An RGB image as PNG with its resolution and what it says of itself.
fn encode(
    [width, height]: [u32; 2],
    dpi: f64,
    rgb: &[u8],
    texts: &[(&str, String)],
) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let per_metre = (dpi / 0.0254).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
        unit: png::Unit::Meter,
    }));
    for (key, text) in texts {
        encoder.add_itxt_chunk((*key).to_string(), text.clone())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    writer.finish()?;
    Ok(bytes)
}
