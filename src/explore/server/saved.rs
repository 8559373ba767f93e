//! The figure of a view through the drawing code of `capsulemap figure`, as a file to be saved.

use axum::http::{HeaderValue, header};
use axum::response::Response;

use super::answer::{Refusal, bytes};
use super::asked::Asked;
use super::explored::Explored;
use super::map::drawing;
use crate::figure::{Format, Place, draw};

/// The map that a request asks for as PDF, SVG or PNG.
pub fn figure(explored: &Explored, asked: &Asked) -> Result<Response, Refusal> {
    let (format, kind) = match asked.text("format") {
        Some("pdf") => (Format::Pdf, "application/pdf"),
        Some("svg") => (Format::Svg, "image/svg+xml"),
        Some("png") => (Format::Png, "image/png"),
        _ => return Err(Refusal::unfit("format: pdf, svg or png is expected")),
    };
    let drawing = drawing(explored, asked)?;
    let dataset = explored.dataset(&drawing)?;
    let failed = |said: std::io::Error| Refusal::failed(said.to_string());
    let folder = tempfile::tempdir().map_err(failed)?;
    let place = Place { folder: folder.path(), formats: &[format], overwrite: false };
    let files = draw(&*dataset, &drawing, &place);
    let files = files.map_err(|error| Refusal::unfit(error.to_string()))?;
    let path = files.paths.first().ok_or_else(|| Refusal::failed("no file was drawn"))?;
    let mut answer = bytes(std::fs::read(path).map_err(failed)?, kind);
    let disposition = HeaderValue::from_static("attachment");
    answer.headers_mut().insert(header::CONTENT_DISPOSITION, disposition);
    Ok(answer)
}
