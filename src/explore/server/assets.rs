//! The files of the page, which are part of the program.

use axum::response::Response;

use super::answer::bytes;

/// The page itself.
pub const INDEX: &str = include_str!("../page/index.html");

/// Name and bytes of what the page loads.
macro_rules! assets {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_bytes!(concat!("../page/", $name)))),*]
    };
}

const ASSETS: &[(&str, &[u8])] = assets![
    "ask.js",
    "attractors.js",
    "basin.js",
    "branches.js",
    "brush.js",
    "busy.js",
    "cells.js",
    "choices.js",
    "cloud.js",
    "colouring.js",
    "curves.js",
    "diagram.js",
    "divider.js",
    "drawing.js",
    "element.js",
    "facts.js",
    "form.js",
    "handed.js",
    "icon.svg",
    "icons.js",
    "indices.js",
    "keep.js",
    "legend.js",
    "line.js",
    "map.js",
    "marks.js",
    "model.js",
    "motion.js",
    "motions.js",
    "notices.js",
    "numbers.js",
    "onmap.js",
    "opening.js",
    "overlay.js",
    "page.css",
    "page.js",
    "panel.js",
    "plane.js",
    "plot.js",
    "progress.js",
    "ramps.js",
    "reading.js",
    "scale.js",
    "scatter.js",
    "shown.js",
    "snap.js",
    "strip.js",
    "tabs.js",
    "ticks.js",
    "tip.js",
    "tools.js",
    "tradeoff.js",
    "units.js",
    "view.js",
    "views.css",
    "uPlot/uPlot.esm.js",
    "uPlot/uPlot.min.css",
];

/// What the page loads by this name; files of folders by their own names.
pub fn asset(name: &str) -> Option<Response> {
    let (path, content) = ASSETS.iter().find(|it| it.0.rsplit('/').next() == Some(name))?;
    Some(bytes(content.to_vec(), kind(path)))
}

/// What browsers call the type of a file.
fn kind(path: &str) -> &'static str {
    match path.rsplit('.').next() {
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        _ => "image/svg+xml",
    }
}
