//! One coordinate of a motion over another, with the impact surface, section points and impacts: a panel for each case.

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn, Stroke};
use super::case_panels::{CasePanel, case_panels};
use super::error::FigureError;
use super::geometry::Rect;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::motion::{Motion, sources, sources_of_arcs};
use super::page::{NO_ROOM, PageRequest, PanelRequest, letter};
use super::panel::{Panel, Pointing};
use super::style::{
    BLUE, CONTACT, CURVE_WIDTH, FAINT_INK, INK, ONE_COLUMN, REFERENCE_WIDTH, TWO_COLUMNS, VERMILION,
};
use super::text::Text;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{Entry, histories, impacts, section};
use crate::study::Drawing;

/// Height of the frame [pt].
const HEIGHT: f64 = 165.0;
/// Height of each of several frames [pt].
const HEIGHT_OF_SEVERAL: f64 = 120.0;
/// Radius of section points [pt].
const SECTION_RADIUS: f64 = 2.2;
/// Radius of impact points [pt].
const IMPACT_RADIUS: f64 = 2.2;

/// What a portrait shows, in the units of its axes.
struct Portrait {
    orbit: Vec<(f64, f64)>,
    sections: Vec<(f64, f64)>,
    impacts: Vec<(f64, f64)>,
    /// Where the mass reaches the stop, along the abscissa and along the ordinate.
    gap: [Option<f64>; 2],
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What a portrait reads: the motion, the points of both sections, and the gap.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    let named = drawing.of.iter().flat_map(|name| sources(name, model));
    Names::of(histories(model))
        .and(section(model))
        .and(impacts(model))
        .and(model.impact_surface().map(Entry::of_parameter))
        .and(named)
        .and(sources_of_arcs(model))
        .and_named(drawing.of.clone())
}

/// Draws the phase portraits that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let names: [&str; 2] = match (&view.drawing.of[..], view.model().motion.portrait) {
        ([x, y], _) => [x, y],
        ([], Some(names)) => names,
        ([], None) => return Err(view.without_histories()),
        _ => return Err(view.unfit("`of` names the coordinates of both axes of a phase portrait")),
    };
    let cases = case_panels(view)?;
    let count = cases.len();
    let portraits = cases.iter().map(|panel| portrait(panel, names));
    let portraits = portraits.collect::<Result<Vec<Portrait>, FigureError>>()?;
    let columns = match count {
        1 => 1,
        2 | 4 => 2,
        _ => 3,
    };
    // What the marks mean stands above the panels of the first row, a part of it above each.
    let legend = legend(view, &portraits);
    let part = legend.len().div_ceil(columns).max(1);
    let legend: Vec<Vec<(Mark, Text)>> = legend.chunks(part).map(<[_]>::to_vec).collect();
    let request = |(case, portrait): (usize, &Portrait)| {
        let all = || portrait.orbit.iter().chain(&portrait.sections).chain(&portrait.impacts);
        let x: Vec<f64> = all().map(|point| point.0).chain(portrait.gap[0]).collect();
        let y: Vec<f64> = all().map(|point| point.1).chain(portrait.gap[1]).collect();
        let x = AxisRequest::around(view.quantity(names[0]), &x, 0.06);
        let y = AxisRequest::around(view.quantity(names[1]), &y, 0.06);
        PanelRequest {
            x: AxisRequest { labelled: case + columns >= count, ..x },
            y: AxisRequest { labelled: case.is_multiple_of(columns), ..y },
            header: Header {
                letter: letter(case, count),
                note: cases[case].note(),
                legend: legend.get(case).cloned().unwrap_or_default(),
            },
        }
    };
    let mut panels: Vec<PanelRequest> = portraits.iter().enumerate().map(request).collect();
    let mut rows = Vec::new();
    while !panels.is_empty() {
        let rest = panels.split_off(columns.min(panels.len()));
        rows.push(std::mem::replace(&mut panels, rest));
    }
    let page = PageRequest {
        drawing: view.drawing,
        width_mm: if columns > 1 { TWO_COLUMNS } else { ONE_COLUMN },
        heights: vec![if count > 1 { HEIGHT_OF_SEVERAL } else { HEIGHT }; rows.len()],
        rows,
        column_room: NO_ROOM,
        right_room: NO_ROOM,
        bottom_room: 0.0,
        pointing: Pointing::Inward,
    };
    let (mut canvas, panels) = page.lay_out();
    for (panel, portrait) in panels.iter().flatten().zip(&portraits) {
        draw_portrait(&mut canvas, panel, portrait);
    }
    Ok(canvas.finish(&view.about(&names.map(str::to_owned), &cases[0].free())))
}

/// One coordinate over another, for a case.
fn portrait(panel: &CasePanel<'_>, names: [&str; 2]) -> Result<Portrait, FigureError> {
    let (view, case) = (&panel.view, panel.case);
    let free: &[&str] = &panel.free();
    let motion = Motion::drawn(view, free, case);
    let [first, last] = view.drawing.cycles.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let samples = motion.shown(names[0])?.into_iter().zip(motion.shown(names[1])?);
    let orbit: Vec<_> = motion
        .cycles()?
        .into_iter()
        .zip(samples)
        .filter(|(cycle, _)| (first - 1e-9..=last + 1e-9).contains(cycle))
        .map(|(_, place)| place)
        .collect();
    if orbit.is_empty() {
        return Err(view.unfit(format!("no sample lies in cycles {first} to {last}")));
    }
    let gap = view
        .model()
        .impact_surface()
        .and_then(|delta| view.parameter(delta.symbol(), free).ok()?.iter().nth(case).copied());
    let factors = names.map(|name| view.quantity(name).factor);
    let both = |x: Vec<f64>, y: Vec<f64>| -> Vec<(f64, f64)> {
        let places = x.into_iter().zip(y).map(|(x, y)| (x * factors[0], y * factors[1]));
        places.filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
    };
    let sections = match view.shows("stroboscopic") {
        true => both(motion.at_sections(names[0])?, motion.at_sections(names[1])?),
        false => Vec::new(),
    };
    let impacts = match view.shows("impacts") {
        true => both(motion.at_impacts(names[0])?, motion.at_impacts(names[1])?),
        false => Vec::new(),
    };
    let shown = gap.filter(|_| view.shows("contact"));
    let met = view.model().signal_of_coordinate(0).map(|it| it.name());
    let reached = |at: usize| shown.filter(|_| met == Some(names[at])).map(|it| it * factors[at]);
    Ok(Portrait { orbit, sections, impacts, gap: [reached(0), reached(1)] })
}

/// What the marks mean that any of `portraits` has.
fn legend(view: &View<'_>, portraits: &[Portrait]) -> Vec<(Mark, Text)> {
    let mut legend = Vec::new();
    if portraits.iter().any(|it| !it.sections.is_empty()) {
        legend.push((Mark::Disc(INK, SECTION_RADIUS), Text::plain("stroboscopic")));
    }
    if portraits.iter().any(|it| !it.impacts.is_empty()) {
        legend.push((Mark::Ring(VERMILION, IMPACT_RADIUS), Text::plain("impact")));
    }
    let has_gap = portraits.iter().any(|it| it.gap.iter().any(Option::is_some));
    if let Some(delta) = view.model().impact_surface().filter(|_| has_gap) {
        let delta = view.quantity(delta.symbol()).short_name();
        let words = Text::plain("contact, from\u{a0}").then(delta);
        legend.push((Mark::Patch(CONTACT), words));
    }
    legend
}

/// Shades the side of the impact surface where the stop is pressed, with a line along the surface.
fn draw_contact(canvas: &mut Canvas, panel: &Panel, gap: [Option<f64>; 2]) {
    let frame = panel.frame;
    let (x, y) = (&panel.x.scale, &panel.y.scale);
    let line = Stroke::dashed(FAINT_INK, REFERENCE_WIDTH);
    if let Some(gap) = gap[0] {
        let left = panel.place(gap, y.low).0.clamp(frame.left, frame.right);
        canvas.fill(Rect { left, ..frame }, CONTACT);
        panel.curve(canvas, &[(gap, y.low), (gap, y.high)], line);
    }
    if let Some(gap) = gap[1] {
        let bottom = panel.place(x.low, gap).1.clamp(frame.top, frame.bottom);
        canvas.fill(Rect { bottom, ..frame }, CONTACT);
        panel.curve(canvas, &[(x.low, gap), (x.high, gap)], line);
    }
}

fn draw_portrait(canvas: &mut Canvas, panel: &Panel, portrait: &Portrait) {
    draw_contact(canvas, panel, portrait.gap);
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
