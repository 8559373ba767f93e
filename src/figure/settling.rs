//! For how many cycles each start is followed until its attractor is decided, over two coordinates of the start.

use super::axis::AxisRequest;
use super::basin::{mark_points, section_points};
use super::canvas::Drawn;
use super::colour::Colours;
use super::data::Value;
use super::error::FigureError;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::outcome::{self, Outcomes};
use super::page::{PageRequest, PanelRequest};
use super::panel::Pointing;
use super::plane::Plane;
use super::raster::Fill;
use super::style::{INFERRED, INK};
use super::text::Text;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{CYCLES, Entry, Place, section, starts};
use crate::study::{Coordinate, Drawing};

/// Height of the frame [pt].
const HEIGHT: f64 = 170.0;

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What the figure reads: the cycles of each case, and the section points of the attractors.
fn reads(_: &Drawing, model: &'static Description) -> Names {
    let phases = Coordinate::phases(model).map(Entry::of_coordinate);
    Names::of(outcome::READS)
        .and([CYCLES])
        .and(section(model).into_iter().map(|entry| Place::Attractor.of(entry)))
        .and(phases)
}

/// Draws the cycles that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let plane = Plane::of(view, "a figure of settling")?;
    let of_starts: Vec<&str> = starts(view.model()).into_iter().map(|entry| entry.name).collect();
    for name in [plane.x_name, plane.y_name] {
        if !of_starts.contains(&name) {
            let allowed = of_starts.join(", ");
            let why = format!("it lies over two of {allowed}, and `{name}` is none of these");
            return Err(view.unfit(why));
        }
    }
    let free = plane.free();
    let mut cycles: Vec<f64> = view.shown(CYCLES.name, &free)?.into_iter().collect();
    let outcomes = Outcomes::over(view, &free)?;
    let named =
        |case: usize, names: &[&str]| outcomes.name(case).is_some_and(|it| names.contains(&it));
    let inferred: Vec<bool> = (0..cycles.len()).map(|case| named(case, &["inferred"])).collect();
    for (case, cycles) in cycles.iter_mut().enumerate() {
        if named(case, &["inferred", "failed", "missing"]) {
            *cycles = f64::NAN;
        }
    }
    let colours = Colours::for_values(&cycles, view.quantity(CYCLES.name));
    let points = match view.shows("section-points") {
        true => section_points(view, &plane),
        false => Vec::new(),
    };
    let mut legend = Vec::new();
    if !points.is_empty() {
        let text = "section points of the attractors";
        legend.push((Mark::Disc(INK, super::basin::RADIUS), Text::plain(text)));
    }
    if inferred.contains(&true) {
        legend.push((Mark::Patch(INFERRED), Text::plain("inferred, not followed")));
    }
    if cycles.iter().zip(&inferred).any(|(cycles, inferred)| cycles.is_nan() && !inferred) {
        legend.push((Mark::Filled(Fill::NO_VALUE), Text::plain("no result")));
    }
    legend.extend(plane.legend());
    let panel = PanelRequest {
        x: AxisRequest::new(view.quantity(plane.x_name), plane.x.scale),
        y: AxisRequest::new(view.quantity(plane.y_name), plane.y.scale),
        header: Header { note: view.held_note(&free), legend, letter: None },
    };
    let room = |height: f64| colours.as_ref().map_or(0.0, |it| it.room(height));
    let page = PageRequest::of_one(view.drawing, panel, HEIGHT, Pointing::Outward);
    let (mut canvas, panels) = PageRequest { right_room: &room, ..page }.lay_out();
    let fill = |case: usize| match &colours {
        _ if inferred[case] => Fill::Plain(INFERRED),
        Some(colours) if !cycles[case].is_nan() && colours.has(cycles[case]) => {
            Fill::Plain(colours.of(cycles[case]))
        }
        _ => Fill::NO_VALUE,
    };
    for panel in panels.iter().flatten() {
        plane.draw(&mut canvas, panel, fill);
        let told = colours.as_ref().map_or(String::new(), Colours::told);
        plane.record(&mut canvas, panel, (&told, |case| Value::Number(cycles[case])));
        mark_points(&mut canvas, panel, &points);
        panel.finish(&mut canvas);
        if let Some(colours) = &colours {
            colours.draw_bar(&mut canvas, panel.frame);
        }
    }
    let about = view.about(&[CYCLES.name.to_owned()], &[plane.x_name, plane.y_name]);
    let skipped = inferred.iter().filter(|it| **it).count();
    let skipped =
        if skipped > 0 { format!("; {skipped} inferred, not followed") } else { String::new() };
    Ok(canvas.finish(&format!("{about}{skipped}")))
}
