//! The files of the page, which are part of the program.

use axum::response::Response;

use super::answer::bytes;

/// The page itself.
pub const INDEX: &str = include_str!("../page/index.html");

/// Name, type and bytes of what the page loads.
const ASSETS: [(&str, &str, &[u8]); 11] = [
    ("page.css", CSS, include_bytes!("../page/page.css")),
    ("page.js", JS, include_bytes!("../page/page.js")),
    ("view.js", JS, include_bytes!("../page/view.js")),
    ("ask.js", JS, include_bytes!("../page/ask.js")),
    ("map.js", JS, include_bytes!("../page/map.js")),
    ("motion.js", JS, include_bytes!("../page/motion.js")),
    ("plot.js", JS, include_bytes!("../page/plot.js")),
    ("line.js", JS, include_bytes!("../page/line.js")),
    ("icon.svg", "image/svg+xml", include_bytes!("../page/icon.svg")),
    ("uPlot.esm.js", JS, include_bytes!("../page/uPlot/uPlot.esm.js")),
    ("uPlot.min.css", CSS, include_bytes!("../page/uPlot/uPlot.min.css")),
];
const CSS: &str = "text/css; charset=utf-8";
const JS: &str = "text/javascript; charset=utf-8";

/// What the page loads by this name.
pub fn asset(name: &str) -> Option<Response> {
    let (_, kind, content) = ASSETS.iter().find(|it| it.0 == name)?;
    Some(bytes(content.to_vec(), kind))
}
