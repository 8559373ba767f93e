//! The figures of views through the drawing code of `capsulemap figure`, as files to be saved.

use std::path::Path;
use std::sync::Arc;

use axum::http::{HeaderValue, header};
use axum::response::Response;

use super::answer::{Refusal, bytes};
use super::asked::Asked;
use super::basin::{self, Basin};
use super::computations::BUDGET;
use super::explored::Explored;
use super::line::{self, Line};
use super::map;
use super::motion;
use super::stored_diagram;
use super::units::Units;
use crate::campaign::results_in_memory;
use crate::figure::{Format, Place, draw};
use crate::flow::stop;
use crate::orbit::Machine;
use crate::run::run_sample;
use crate::store::Dataset;
use crate::study::{Drawing, DrawingKind, Study};

/// What a request for a figure of the file itself has, where one with the same name is computed, too.
const STORED: &str = "stored";

/// The figure that a request asks for as PDF, SVG or PNG, drawn in a folder that others cannot read; what it shows is computed
/// again where it is not in the file.
pub fn figure(explored: &Explored, asked: &Asked, place: &Path) -> Result<Response, Refusal> {
    let (format, content) = format(asked)?;
    let kind = asked.text("kind").unwrap_or_default();
    let known = DrawingKind::NAMES.iter().find(|it| it.0 == kind).map(|it| it.1);
    let (results, mut drawing) = match known {
        Some(kind @ (DrawingKind::Map | DrawingKind::TradeOff)) => {
            let drawing = map::drawing(explored, asked, kind)?;
            (explored.dataset(&drawing)?, drawing)
        }
        Some(kind @ (DrawingKind::History | DrawingKind::PhasePortrait)) => {
            let study = motion::study(explored, asked)?;
            computed(&study, Drawing::new(kind.name(), kind), motion::INSTEAD)?
        }
        Some(DrawingKind::Bifurcation) if asked.text(STORED).is_some() => {
            let drawing = stored_diagram::drawing(explored, asked)?;
            (explored.dataset(&drawing)?, drawing)
        }
        Some(kind @ DrawingKind::Basin) if asked.text(STORED).is_some() => {
            let drawing = map::drawing(explored, asked, kind)?;
            (explored.dataset(&drawing)?, drawing)
        }
        Some(DrawingKind::Bifurcation) => {
            let line = Line::of(explored, asked)?;
            let study = line.study().ok_or_else(|| Refusal::unfit(line::NO_STUDY))?;
            drawn_by(&study, line::INSTEAD)?
        }
        Some(DrawingKind::Basin) => drawn_by(Basin::of(explored, asked)?.study(), basin::INSTEAD)?,
        _ => {
            let why =
                "kind: map, trade-off, history, phase-portrait, bifurcation or basin is expected";
            return Err(Refusal::unfit(why));
        }
    };
    Units::of(asked)?.set(&mut drawing.settings, explored);
    let folder = tempfile::tempdir_in(place).map_err(Refusal::failed)?;
    let place = Place { folder: folder.path(), formats: &[format], overwrite: false };
    let files = draw(&*results, &drawing, &place).map_err(Refusal::undrawn)?;
    let path = files.paths.first().ok_or_else(|| Refusal::failed("no file was drawn"))?;
    let mut answer = bytes(std::fs::read(path).map_err(Refusal::failed)?, content);
    let disposition = HeaderValue::from_static("attachment");
    answer.headers_mut().insert(header::CONTENT_DISPOSITION, disposition);
    Ok(answer)
}

/// The format of a figure, and what browsers call it.
fn format(asked: &Asked) -> Result<(Format, &'static str), Refusal> {
    match asked.text("format") {
        Some("pdf") => Ok((Format::Pdf, "application/pdf")),
        Some("svg") => Ok((Format::Svg, "image/svg+xml")),
        Some("png") => Ok((Format::Png, "image/png")),
        _ => Err(Refusal::unfit("format: pdf, svg or png is expected")),
    }
}

/// The results of a small study, with its own figure; `instead` is what to do where they take too long.
fn drawn_by(study: &Study, instead: &str) -> Result<(Arc<Dataset>, Drawing), Refusal> {
    let drawing = study.drawings.first().cloned();
    computed(study, drawing.ok_or_else(|| Refusal::failed("the study has no figure"))?, instead)
}

/// The results of a small study, with a figure of them.
fn computed(
    study: &Study,
    drawing: Drawing,
    instead: &str,
) -> Result<(Arc<Dataset>, Drawing), Refusal> {
    let chains: Vec<usize> = (0..study.chains()).collect();
    let machine = Machine::default();
    let records = run_sample(study, machine, &chains, || ()).map_err(Refusal::failed)?;
    check_time(instead)?;
    let results = results_in_memory(study, &records, machine);
    check_time(instead)?;
    Ok((Arc::new(results.map_err(Refusal::failed)?), drawing))
}

/// Fails if a computation has taken too long; `instead` is what to do then.
fn check_time(instead: &str) -> Result<(), Refusal> {
    match stop::is_asked() {
        true => Err(Refusal::late(BUDGET, instead)),
        false => Ok(()),
    }
}
