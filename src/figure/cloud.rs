//! Points of a diagram: vector discs where they are few, pixels where they are many.

use plotters::style::RGBColor;

use super::canvas::{Canvas, Point};
use super::panel::Panel;
use super::raster::Raster;
use super::style::CLOUD_LIMIT;

/// A point with its colour, in the units of the panel's axes.
pub type Dot = ((f64, f64), RGBColor);

/// The radius at which `count` points can be seen and told apart [pt].
pub fn radius(count: usize) -> f64 {
    match count {
        0..=60 => 1.6,
        61..=400 => 1.0,
        401..=2500 => 0.6,
        _ => 0.38,
    }
}

/// Draws the points of `dots` that lie on `panel`, the later over the earlier.
pub fn draw(canvas: &mut Canvas, panel: &Panel, dots: &[Dot], radius: f64) {
    let on_panel = |((x, y), _): &&Dot| panel.x.scale.holds(*x) && panel.y.scale.holds(*y);
    let placed: Vec<(Point, RGBColor)> = dots
        .iter()
        .filter(on_panel)
        .map(|((x, y), colour)| (panel.place(*x, *y), *colour))
        .collect();
    if placed.len() <= CLOUD_LIMIT {
        canvas.discs(&placed, radius);
        return;
    }
    let frame = panel.frame;
    // The more the points overlap, the more of those below must shine through to show density.
    let cover = placed.len() as f64 * std::f64::consts::PI * radius * radius;
    let opacity = (frame.width() * frame.height() / cover).sqrt().clamp(0.2, 1.0);
    let mut raster = Raster::over(frame);
    for ((x, y), colour) in placed {
        raster.disc((x - frame.left, y - frame.top), radius, colour, opacity);
    }
    canvas.image(frame, &raster);
}
