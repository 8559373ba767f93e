//! The colours of attractors and of their basins, the same in every figure.

use plotters::style::RGBColor;

use super::style::{ATTRACTORS, OTHER_ATTRACTOR, PAPER};

/// How much paper the colour of a basin has, so that the points of its attractor stand out.
const TINT: f64 = 0.45;

/// The colour of an attractor, by its number.
pub fn colour(number: usize) -> RGBColor {
    ATTRACTORS.get(number).copied().unwrap_or(OTHER_ATTRACTOR)
}

/// The colour of an area that belongs to an attractor.
pub fn band(number: usize) -> RGBColor {
    tinted(colour(number))
}

/// A colour with paper in it.
pub fn tinted(RGBColor(red, green, blue): RGBColor) -> RGBColor {
    RGBColor(with_paper(red), with_paper(green), with_paper(blue))
}

fn with_paper(channel: u8) -> u8 {
    let RGBColor(white, ..) = PAPER;
    (f64::from(channel) * (1.0 - TINT) + f64::from(white) * TINT).round() as u8
}
