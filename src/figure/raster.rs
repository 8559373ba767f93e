//! Pixels embedded in a vector figure: dense clouds of points and the cells of maps.

use std::ops::Range;

use plotters::style::RGBColor;

use super::geometry::{Point, Rect};
use super::style::{DPI, HATCH, MISSING};

/// How an area is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fill {
    /// One colour.
    Plain(RGBColor),
    /// Diagonal lines of the second colour over the first.
    Hatched(RGBColor, RGBColor),
}

impl Fill {
    /// An area without values.
    pub const NO_VALUE: Fill = Fill::Hatched(MISSING, HATCH);

    /// The colour, or the hatching of an area without values.
    pub fn of(colour: Option<RGBColor>) -> Fill {
        colour.map_or(Fill::NO_VALUE, Fill::Plain)
    }

    /// The colour of pixel (`x`, `y`).
    fn at(self, x: usize, y: usize) -> RGBColor {
        match self {
            Fill::Plain(colour) => colour,
            Fill::Hatched(_, lines) if (x + y) % 20 < 3 => lines,
            Fill::Hatched(ground, _) => ground,
        }
    }
}

/// Pixels with opacity, over a rectangle of the page.
pub struct Raster {
    /// Whether a renderer may blend neighbouring pixels.
    pub smooth: bool,
    width: usize,
    height: usize,
    pixels: Vec<[u8; 4]>,
}

impl Raster {
    /// A transparent raster of the size of `rect`, to be drawn over it.
    pub fn over(rect: Rect) -> Raster {
        let [width, height] = [rect.width(), rect.height()]
            .map(|points| ((points / 72.0 * DPI).round() as usize).max(1));
        Raster { smooth: true, width, height, pixels: vec![[255, 255, 255, 0]; width * height] }
    }

    /// An opaque raster over `rect` that is filled as `of` says for the column and the row of a position, which
    /// count from the upper left corner in shares of the rectangle.
    pub fn cells<C, R, K>(rect: Rect, column: C, row: R, of: K) -> Raster
    where
        C: Fn(f64) -> usize,
        R: Fn(f64) -> usize,
        K: Fn(usize, usize) -> Fill,
    {
        let mut raster = Raster { smooth: false, ..Raster::over(rect) };
        let columns: Vec<_> = middles(raster.width).map(column).collect();
        for (y, middle) in middles(raster.height).enumerate() {
            let cell_row = row(middle);
            for (x, cell_column) in columns.iter().enumerate() {
                let RGBColor(red, green, blue) = of(*cell_column, cell_row).at(x, y);
                raster.pixels[y * raster.width + x] = [red, green, blue, 255];
            }
        }
        raster
    }

    /// A disc whose centre lies at `centre` [pt from the upper left corner], laid over what is there.
    pub fn disc(&mut self, centre: Point, radius: f64, colour: RGBColor, opacity: f64) {
        let scale = DPI / 72.0;
        let (x, y, radius) = (centre.0 * scale, centre.1 * scale, radius * scale);
        for row in covered(y, radius, self.height) {
            for column in covered(x, radius, self.width) {
                let away = (column as f64 + 0.5 - x).hypot(row as f64 + 0.5 - y);
                let cover = (radius + 0.5 - away).clamp(0.0, 1.0) * opacity;
                if cover > 0.0 {
                    lay_over(&mut self.pixels[row * self.width + column], colour, cover);
                }
            }
        }
    }

    /// The raster as a PNG file.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_depth(png::BitDepth::Eight);
        // Opaque rasters go without an opacity channel, which some journals' printers refuse.
        let opaque = self.pixels.iter().all(|pixel| pixel[3] == 255);
        let data: Vec<u8> = match opaque {
            true => self.pixels.iter().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect(),
            false => self.pixels.as_flattened().to_vec(),
        };
        encoder.set_color(if opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
        let mut writer = encoder.write_header().map_err(|error| error.to_string())?;
        writer.write_image_data(&data).map_err(|error| error.to_string())?;
        writer.finish().map_err(|error| error.to_string())?;
        Ok(bytes)
    }
}

/// The middles of so many pixels, as shares of their length.
fn middles(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |at| (at as f64 + 0.5) / count as f64)
}

/// The pixels before `end` that a disc around a place may cover.
fn covered(at: f64, radius: f64, end: usize) -> Range<usize> {
    let first = (at - radius - 1.0).floor().max(0.0) as usize;
    first..((at + radius + 1.0).ceil().max(0.0) as usize).min(end)
}

/// `colour` with opacity `cover` over `pixel` (the Porter-Duff operator "over").
fn lay_over(pixel: &mut [u8; 4], colour: RGBColor, cover: f64) {
    let below = f64::from(pixel[3]) / 255.0;
    let total = cover + below * (1.0 - cover);
    let RGBColor(red, green, blue) = colour;
    for (channel, ours) in pixel.iter_mut().zip([red, green, blue]) {
        let mixed = f64::from(ours) * cover + f64::from(*channel) * below * (1.0 - cover);
        *channel = (mixed / total).round() as u8;
    }
    pixel[3] = (total * 255.0).round() as u8;
}
