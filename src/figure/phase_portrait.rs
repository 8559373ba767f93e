//! Relative velocity over relative displacement, with the impact surface and the section points.

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn, Stroke};
use super::error::FigureError;
use super::geometry::Rect;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::page::{PageRequest, PanelRequest};
use super::panel::{Panel, Pointing};
use super::style::{BLUE, CONTACT, CURVE_WIDTH, FAINT_INK, INK, REFERENCE_WIDTH, VERMILION};
use super::text::Text;
use super::view::View;
use crate::capsule::Parameter;
use crate::store::catalogue::{
    Entry, HISTORY_R, HISTORY_TIME, HISTORY_Y1, HISTORY_Y2, IMPACT_Y1, IMPACT_Y2,
    RELATIVE_VELOCITY, SECTION_R, SECTION_Y1, SECTION_Y2,
};
use crate::study::Drawing;

/// Height of the frame [pt].
const HEIGHT: f64 = 165.0;
/// Radius of section points [pt].
const SECTION_RADIUS: f64 = 2.2;
/// Radius of impact points [pt].
const IMPACT_RADIUS: f64 = 2.2;

/// What a portrait shows, in the units of its axes.
struct Portrait {
    orbit: Vec<(f64, f64)>,
    sections: Vec<(f64, f64)>,
    impacts: Vec<(f64, f64)>,
    gap: Option<f64>,
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What a portrait reads: the motion, the points of both sections, and the gap.
fn reads(_: &Drawing) -> Names {
    Names::of([HISTORY_R, HISTORY_Y1, HISTORY_Y2])
        .and([SECTION_R, SECTION_Y1, SECTION_Y2, IMPACT_Y1, IMPACT_Y2])
        .and([Entry::of_parameter(Parameter::Delta)])
}

/// Draws the phase portrait that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let portrait = portrait(view)?;
    let all = || portrait.orbit.iter().chain(&portrait.sections).chain(&portrait.impacts);
    let x: Vec<f64> = all().map(|point| point.0).chain(portrait.gap).collect();
    let y: Vec<f64> = all().map(|point| point.1).collect();
    let panel = PanelRequest {
        x: AxisRequest::around(view.quantity(HISTORY_R.name), &x, 0.06),
        y: AxisRequest::around(view.quantity(RELATIVE_VELOCITY.name), &y, 0.06),
        header: Header { letter: None, note: view.held_note(&[]), legend: legend(&portrait) },
    };
    let page = PageRequest::of_one(view.drawing, panel, HEIGHT, Pointing::Inward);
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        draw_portrait(&mut canvas, panel, &portrait);
    }
    Ok(canvas.finish(&view.about(&[HISTORY_R.name.to_owned()], &[])))
}

fn portrait(view: &View<'_>) -> Result<Portrait, FigureError> {
    let cycles = view.coordinate_values(HISTORY_TIME.name);
    if cycles.is_empty() {
        return Err(view.without_histories());
    }
    let [first, last] = view.drawing.cycles.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let r = view.shown(HISTORY_R.name, &[])?;
    let (y1, y2) = (view.take(HISTORY_Y1.name, &[])?, view.take(HISTORY_Y2.name, &[])?);
    let orbit: Vec<_> = cycles
        .iter()
        .zip(r.iter().zip(y1.iter().zip(&y2)))
        .filter(|(cycle, _)| (first - 1e-9..=last + 1e-9).contains(*cycle))
        .map(|(_, (r, (y1, y2)))| (*r, y1 - y2))
        .collect();
    if orbit.is_empty() {
        return Err(view.unfit(format!("no sample lies in cycles {first} to {last}")));
    }
    let delta = Parameter::Delta.symbol();
    let factor = view.quantity(delta).factor;
    let gap = view.parameter(delta, &[]).ok().and_then(|gap| gap.first().map(|it| it * factor));
    let sections = match view.dataset.variable(SECTION_R.name) {
        Some(_) => {
            let r = view.shown(SECTION_R.name, &[])?;
            relative(view, [SECTION_Y1, SECTION_Y2], r.iter())?
        }
        None => Vec::new(),
    };
    let impacts = match (view.dataset.variable(IMPACT_Y1.name), gap) {
        (Some(_), Some(gap)) => relative(view, [IMPACT_Y1, IMPACT_Y2], std::iter::repeat(&gap))?,
        _ => Vec::new(),
    };
    Ok(Portrait { orbit, sections, impacts, gap })
}

/// Points of given displacement and the difference of two velocities, without the padding.
fn relative<'a>(
    view: &View<'_>,
    [y1, y2]: [Entry; 2],
    r: impl Iterator<Item = &'a f64>,
) -> Result<Vec<(f64, f64)>, FigureError> {
    let (y1, y2) = (view.take(y1.name, &[])?, view.take(y2.name, &[])?);
    let points = r.zip(y1.iter().zip(&y2)).map(|(r, (y1, y2))| (*r, y1 - y2));
    Ok(points.filter(|(r, velocity)| r.is_finite() && velocity.is_finite()).collect())
}

fn legend(portrait: &Portrait) -> Vec<(Mark, Text)> {
    let mut legend = Vec::new();
    if !portrait.sections.is_empty() {
        legend.push((Mark::Disc(INK, SECTION_RADIUS), Text::plain("stroboscopic")));
    }
    if !portrait.impacts.is_empty() {
        legend.push((Mark::Ring(VERMILION, IMPACT_RADIUS), Text::plain("impact")));
    }
    if portrait.gap.is_some() {
        legend.push((Mark::Patch(CONTACT), Text::plain("contact")));
    }
    legend
}

fn draw_portrait(canvas: &mut Canvas, panel: &Panel, portrait: &Portrait) {
    if let Some(gap) = portrait.gap {
        let (surface, _) = panel.place(gap, panel.y.scale.low);
        let left = surface.clamp(panel.frame.left, panel.frame.right);
        canvas.fill(Rect { left, ..panel.frame }, CONTACT);
        let ends = [(gap, panel.y.scale.low), (gap, panel.y.scale.high)];
        panel.curve(canvas, &ends, Stroke::dashed(FAINT_INK, REFERENCE_WIDTH));
    }
    panel.curve(canvas, &portrait.orbit, Stroke::solid(BLUE, CURVE_WIDTH));
    let rings = Stroke::solid(VERMILION, CURVE_WIDTH);
    canvas.rings(&panel.places(&portrait.impacts), IMPACT_RADIUS, rings);
    let sections: Vec<_> =
        panel.places(&portrait.sections).into_iter().map(|at| (at, INK)).collect();
    canvas.discs(&sections, SECTION_RADIUS);
    for (series, points) in [
        ("motion", &portrait.orbit),
        ("stroboscopic", &portrait.sections),
        ("impact", &portrait.impacts),
    ] {
        panel.record(canvas, series, points.iter().copied());
    }
    panel.finish(canvas);
}
