//! One coordinate of a motion over another, with the impact surface, section points and impacts: a panel for each case.

use std::collections::BTreeMap;

use plotters::style::RGBColor;

use super::attractor_colours::Colours;
use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn, Stroke};
use super::case_panels::{CasePanel, case_panels};
use super::error::FigureError;
use super::geometry::Rect;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::motion::{Motion, ShownCycles, sources, sources_of_arcs};
use super::page::{PageRequest, PanelRequest, in_rows, letter};
use super::panel::Panel;
use super::style::{BLUE, CONTACT, CURVE_WIDTH, FAINT_INK, INK, PAPER, REFERENCE_WIDTH};
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
    /// Its attractor with the colour that figures give it, where the results number it.
    attractor: Option<(usize, RGBColor)>,
    sections: Vec<(f64, f64)>,
    impacts: Vec<(f64, f64)>,
    /// Where the mass reaches its stops, along the abscissa and along the ordinate, and on which side they are, 1 or -1.
    stops: [Vec<(f64, f64)>; 2],
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What a portrait reads: the motion, the points of both sections, and the stops.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    let named = drawing.of.iter().flat_map(|name| sources(name, model));
    Names::of(histories(model))
        .and(section(model))
        .and(impacts(model))
        .and(model.surfaces().map(|(it, _)| Entry::of_parameter(it)))
        .and(named)
        .and(sources_of_arcs(model))
        .and_named(drawing.of.clone())
}

/// Draws the phase portraits that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let portraits = Portraits::of(view)?;
    let Portraits { names, cases, .. } = &portraits;
    let height = if cases.len() > 1 { HEIGHT_OF_SEVERAL } else { HEIGHT };
    let rows = in_rows(portraits.panels(view), portraits.columns());
    let (mut canvas, panels) = PageRequest::of_rows(view.drawing, rows, height).lay_out();
    for (panel, portrait) in panels.iter().flatten().zip(&portraits.portraits) {
        draw_portrait(&mut canvas, panel, portrait);
    }
    Ok(canvas.finish(&view.about(&names.map(str::to_owned), &cases[0].free)))
}

/// What a figure of phase portraits shows: one for each case.
struct Portraits<'a> {
    /// The coordinates along the abscissa and the ordinate.
    names: [&'a str; 2],
    cases: Vec<CasePanel<'a>>,
    portraits: Vec<Portrait>,
}

impl<'a> Portraits<'a> {
    /// What the figure shows of the results.
    fn of(view: &View<'a>) -> Result<Portraits<'a>, FigureError> {
        let names: [&str; 2] = match (&view.drawing.of[..], view.model().motion.portrait) {
            ([x, y], _) => [x, y],
            ([], Some(names)) => names,
            ([], None) => return Err(view.without_histories()),
            _ => {
                let why = "`of` names the coordinates of both axes of a phase portrait";
                return Err(view.unfit(why));
            }
        };
        view.check_signals(names.into_iter())?;
        let cases = case_panels(view)?;
        let portraits = cases.iter().map(|panel| Portrait::of(panel, names));
        let portraits = portraits.collect::<Result<_, FigureError>>()?;
        Ok(Portraits { names, cases, portraits })
    }

    /// How many panels stand side by side.
    fn columns(&self) -> usize {
        match self.cases.len() {
            1 => 1,
            2 | 4 => 2,
            _ => 3,
        }
    }

    /// The panel of each case.
    fn panels(&self, view: &View<'_>) -> Vec<PanelRequest> {
        let (count, columns) = (self.cases.len(), self.columns());
        // What the marks mean stands above the panels of the first row, a part of it above each.
        let legend = legend(view, &self.portraits);
        let part = legend.len().div_ceil(columns).max(1);
        let mut parts = legend.chunks(part);
        let mut panels = Vec::new();
        for (case, portrait) in self.portraits.iter().enumerate() {
            let legend = parts.next().map_or(Vec::new(), <[_]>::to_vec);
            let (x, y): (Vec<f64>, Vec<f64>) = portrait.places().unzip();
            let [of_x, of_y] = [0, 1].map(|axis| portrait.stops[axis].iter().map(|(at, _)| *at));
            let x = x.into_iter().chain(of_x).collect::<Vec<f64>>();
            let y = y.into_iter().chain(of_y).collect::<Vec<f64>>();
            let x = AxisRequest::around(view.quantity(self.names[0]), &x, 0.06);
            let y = AxisRequest::around(view.quantity(self.names[1]), &y, 0.06);
            let (letter, note) = (letter(case, count), self.cases[case].note());
            panels.push(PanelRequest {
                x: AxisRequest { labelled: case + columns >= count, ..x },
                y: AxisRequest { labelled: case.is_multiple_of(columns), ..y },
                header: Header { letter, note, legend },
            });
        }
        panels
    }
}

impl Portrait {
    /// One coordinate over another, for a case.
    fn of(panel: &CasePanel<'_>, names: [&str; 2]) -> Result<Portrait, FigureError> {
        let view = &panel.view;
        let motion = Motion::drawn(view, &panel.free, panel.case);
        let shown = ShownCycles::of(view.drawing);
        let samples = motion.shown(names[0])?.into_iter().zip(motion.shown(names[1])?);
        let samples = motion.cycles()?.into_iter().zip(samples);
        let orbit: Vec<_> =
            samples.filter(|(cycle, _)| shown.has(*cycle)).map(|(_, place)| place).collect();
        if orbit.is_empty() {
            let ShownCycles { first, last } = shown;
            return Err(view.unfit(format!("no sample lies in cycles {first} to {last}")));
        }
        let factors = names.map(|name| view.quantity(name).factor);
        let sections = match view.shows("stroboscopic") {
            true => places([motion.at_sections(names[0])?, motion.at_sections(names[1])?], factors),
            false => Vec::new(),
        };
        let impacts = match view.shows("impacts") {
            true => places([motion.at_impacts(names[0])?, motion.at_impacts(names[1])?], factors),
            false => Vec::new(),
        };
        let met = view.model().signal_of_coordinate(0).map(|it| it.name());
        let stops = if view.shows("contact") { motion.stops() } else { Vec::new() };
        let stops = [0, 1].map(|axis| {
            let met = stops.iter().filter(|_| met == Some(names[axis]));
            met.map(|(at, side)| (at * factors[axis], *side)).collect()
        });
        let colours = Colours::of(view)?;
        let attractor = panel.attractor()?.map(|number| (number, colours.colour(number)));
        Ok(Portrait { orbit, attractor, sections, impacts, stops })
    }

    /// All places that it shows.
    fn places(&self) -> impl Iterator<Item = (f64, f64)> {
        self.orbit.iter().chain(&self.sections).chain(&self.impacts).copied()
    }
}

/// Points with these coordinates [SI] in the units of the figure, without those that have none.
fn places(coordinates: [Vec<f64>; 2], factors: [f64; 2]) -> Vec<(f64, f64)> {
    let [x, y] = coordinates;
    let places = x.into_iter().zip(y).map(|(x, y)| (x * factors[0], y * factors[1]));
    places.filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
}

/// What the marks mean that any of `portraits` has.
fn legend(view: &View<'_>, portraits: &[Portrait]) -> Vec<(Mark, Text)> {
    let mut legend = Vec::new();
    let attractors: BTreeMap<usize, RGBColor> =
        portraits.iter().filter_map(|it| it.attractor).collect();
    for (number, colour) in attractors {
        let words = Text::plain(&format!("attractor {number}"));
        legend.push((Mark::Line(Stroke::solid(colour, CURVE_WIDTH)), words));
    }
    if portraits.iter().any(|it| !it.sections.is_empty()) {
        legend.push((Mark::Disc(INK, SECTION_RADIUS), Text::plain("stroboscopic")));
    }
    if portraits.iter().any(|it| !it.impacts.is_empty()) {
        legend.push((Mark::Ring(INK, IMPACT_RADIUS), Text::plain("impact")));
    }
    let most_stops = portraits.iter().flat_map(|it| it.stops.iter().map(Vec::len)).max();
    if most_stops > Some(1) {
        legend.push((Mark::Patch(CONTACT), Text::plain("contact")));
    } else if let Some(delta) = view.model().impact_surface().filter(|_| most_stops == Some(1)) {
        let delta = view.quantity(delta.symbol()).short_name();
        let words = Text::plain("contact, from\u{a0}").then(delta);
        legend.push((Mark::Patch(CONTACT), words));
    }
    legend
}

/// Shades the side of each surface of impacts where its stop is pressed, with a line along the surface.
fn draw_contact(canvas: &mut Canvas, panel: &Panel, stops: &[Vec<(f64, f64)>; 2]) {
    let frame = panel.frame;
    let (x, y) = (&panel.x.scale, &panel.y.scale);
    let line = Stroke::dashed(FAINT_INK, REFERENCE_WIDTH);
    for (at, side) in &stops[0] {
        let place = panel.place(*at, y.low).0.clamp(frame.left, frame.right);
        let pressed = match *side > 0.0 {
            true => Rect { left: place, ..frame },
            false => Rect { right: place, ..frame },
        };
        canvas.fill(pressed, CONTACT);
        panel.curve(canvas, &[(*at, y.low), (*at, y.high)], line);
    }
    for (at, side) in &stops[1] {
        let place = panel.place(x.low, *at).1.clamp(frame.top, frame.bottom);
        let pressed = match *side > 0.0 {
            true => Rect { bottom: place, ..frame },
            false => Rect { top: place, ..frame },
        };
        canvas.fill(pressed, CONTACT);
        panel.curve(canvas, &[(x.low, *at), (x.high, *at)], line);
    }
}

fn draw_portrait(canvas: &mut Canvas, panel: &Panel, portrait: &Portrait) {
    draw_contact(canvas, panel, &portrait.stops);
    let colour = portrait.attractor.map_or(BLUE, |it| it.1);
    panel.curve(canvas, &portrait.orbit, Stroke::solid(colour, CURVE_WIDTH));
    let impacts = panel.places(&portrait.impacts);
    let paper: Vec<_> = impacts.iter().map(|at| (*at, PAPER)).collect();
    canvas.discs(&paper, IMPACT_RADIUS);
    canvas.rings(&impacts, IMPACT_RADIUS, Stroke::solid(INK, CURVE_WIDTH));
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
