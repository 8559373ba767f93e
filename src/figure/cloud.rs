//! Points of a diagram: vector discs where they are few, pixels where they are many.

use plotters::style::RGBColor;

use super::canvas::Canvas;
use super::geometry::Point;
use super::panel::Panel;
use super::raster::Raster;
use super::style::{CLOUD_LIMIT, POINTS_PER_MM};
use crate::study::Drawing;

/// A point in the units of the panel's axes.
pub struct Dot {
    /// Where it stands.
    pub at: (f64, f64),
    /// Its colour.
    pub colour: RGBColor,
    /// Dots that the panel would hold if all of it were as crowded as here.
    pub crowding: f64,
    /// The case that it shows, where the data behind a figure tell what its colour means.
    pub case: usize,
}

/// How many points of all sorts lie inside the frame of a panel.
pub fn count(panel: &Panel, dots: &[Vec<Dot>]) -> usize {
    dots.iter().flatten().filter(|dot| panel.holds(dot.at.0, dot.at.1)).count()
}

/// The radius of `count` points [pt]: that which the request sets, or at which they can be distinguished.
pub fn radius(drawing: &Drawing, count: usize) -> f64 {
    if let Some(diameter) = drawing.marker_mm {
        return diameter / 2.0 * POINTS_PER_MM;
    }
    match count {
        0..=60 => 1.6,
        61..=400 => 0.9,
        401..=2500 => 0.6,
        2501..=10_000 => 0.38,
        _ => 0.25,
    }
}

/// Transmittance of the paper where dots are crowded: dark, but with room for structure.
const SHINE_THROUGH: f64 = 0.3;

/// Draws the points of `dots` that lie on `panel`, the later over the earlier.
pub fn draw(canvas: &mut Canvas, panel: &Panel, dots: &[Dot], radius: f64) {
    let placed = dots
        .iter()
        .filter(|dot| panel.holds(dot.at.0, dot.at.1))
        .map(|dot| (panel.place(dot.at.0, dot.at.1), dot));
    if dots.len() <= CLOUD_LIMIT {
        let discs: Vec<(Point, RGBColor)> = placed.map(|(at, dot)| (at, dot.colour)).collect();
        canvas.discs(&discs, radius);
        return;
    }
    let frame = panel.frame;
    let area = std::f64::consts::PI * radius * radius;
    let mut raster = Raster::over(frame);
    for ((x, y), dot) in placed {
        // Crowded dots let those below shine through and show density; lone ones stay dark.
        let crowding = (dot.crowding * area / (frame.width() * frame.height())).max(1e-6);
        let opacity = (1.0 - SHINE_THROUGH.powf(1.0 / crowding)).max(0.02);
        raster.disc((x - frame.left, y - frame.top), radius, dot.colour, opacity);
    }
    canvas.image(frame, &raster);
}
