//! Basins of attraction: which attractor each start leads to, over two coordinates of the start.

use std::collections::BTreeSet;

use plotters::style::RGBColor;

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn, Stroke};
use super::data::Value;
use super::error::FigureError;
use super::header::{Header, Mark};
use super::inferred;
use super::kind::{Kind, Names, Needs};
use super::outcome::{self, Outcomes};
use super::page::{PageRequest, PanelRequest};
use super::panel::{Panel, Pointing};
use super::plane::Plane;
use super::raster::Fill;
use super::style::{ATTRACTORS, INK, OTHER_ATTRACTOR, PAPER, REFERENCE_WIDTH, UNDECIDED};
use super::text::Text;
use super::ticks::significant;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{
    ATTRACTOR, ATTRACTOR_INDEX, ATTRACTOR_KIND, ATTRACTOR_PERIOD, ATTRACTOR_SHARE,
    ATTRACTOR_SHARE_ERROR, Entry, Place, edges, section, starts,
};
use crate::study::{Coordinate, Drawing};
use crate::tradeoff::NOISE;

/// Height of the frame [pt].
const HEIGHT: f64 = 170.0;
/// Radius of section points [pt].
pub(super) const RADIUS: f64 = 2.4;
/// Width of the rim of a section point [pt].
const RIM: f64 = 0.7;
/// How much paper the colour of a basin has, so that the points of its attractor stand out.
const TINT: f64 = 0.45;
/// Attractors with an entry of their own in the legend.
const NAMED: usize = 10;

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What basins read: the attractor of each case, and the table of the attractors.
fn reads(_: &Drawing, model: &'static Description) -> Names {
    let sections = section(model).into_iter().map(|entry| Place::Attractor.of(entry));
    let phases = Coordinate::phases(model).map(Entry::of_coordinate);
    Names::of(outcome::READS)
        .and([ATTRACTOR, ATTRACTOR_KIND, ATTRACTOR_PERIOD, ATTRACTOR_SHARE, ATTRACTOR_SHARE_ERROR])
        .and(sections)
        .and(edges(model))
        .and(inferred::READS)
        .and(phases)
        .and([Place::Attractor.of(Entry::of_output(model.main_output()))])
        .and(model.impact_surface().map(Entry::of_parameter))
}

/// Draws the basins that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let of_starts: Vec<&str> = starts(view.model()).into_iter().map(|entry| entry.name).collect();
    if view.dataset.variable(ATTRACTOR.name).is_none() {
        let axes = of_starts.join(", ");
        let why = format!("the results tell no attractors; it needs two axes of {axes}");
        return Err(view.unfit(why));
    }
    let plane = Plane::of(view, "a figure of basins")?;
    for name in [plane.x_name, plane.y_name] {
        if !of_starts.contains(&name) {
            let allowed = of_starts.join(", ");
            let why = format!("basins lie over two of {allowed}, and `{name}` is none of these");
            return Err(view.unfit(why));
        }
    }
    let basins = Basins::of(view, &plane)?;
    let points = match view.shows("section-points") {
        true => section_points(view, &plane),
        false => Vec::new(),
    };
    let saddles = if view.shows("saddles") { saddles(view, &plane) } else { Vec::new() };
    let surface = surface(view, &plane).filter(|_| view.shows("impact-surface"));
    let mut legend = basins.legend(view);
    // A plane of all coordinates of a start is no projection.
    let is_projected = of_starts.len() > 2;
    if !points.is_empty() {
        let more = if is_projected { ", projected onto the plane" } else { "" };
        let words = Text::plain(&format!("section points of the orbits{more}"));
        legend.push((Mark::Disc(INK, RADIUS), words));
    }
    if !saddles.is_empty() {
        let more = if is_projected { ", projected alike" } else { "" };
        let words = Text::plain(&format!("saddles on the boundary{more}"));
        legend.push((Mark::Ring(INK, RADIUS), words));
    }
    if surface.is_some() {
        let dashed = Stroke::dashed(INK, REFERENCE_WIDTH);
        legend.push((Mark::Line(dashed), Text::plain("impact surface")));
    }
    let inferred = basins.inferred(view);
    legend.extend(inferred.iter().map(|it| (Mark::Nothing, Text::plain(it))));
    let panel = PanelRequest {
        x: AxisRequest::new(view.quantity(plane.x_name), plane.x.scale),
        y: AxisRequest::new(view.quantity(plane.y_name), plane.y.scale),
        header: Header {
            note: view.held_note(&plane.free()),
            legend: legend.into_iter().chain(plane.legend()).collect(),
            ..Header::default()
        },
    };
    let page = PageRequest::of_one(view.drawing, panel, HEIGHT, Pointing::Outward);
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        plane.draw(&mut canvas, panel, |case| basins.fill(case));
        plane.record(&mut canvas, panel, (ATTRACTOR.name, |case| basins.value(case)));
        if let Some(ends) = surface {
            panel.curve(&mut canvas, &ends, Stroke::dashed(INK, REFERENCE_WIDTH));
        }
        mark_saddles(&mut canvas, panel, &saddles);
        mark_points(&mut canvas, panel, &points);
        panel.record(&mut canvas, "saddles on the boundary", saddles.iter().copied());
        panel.finish(&mut canvas);
    }
    let about = view.about(&[ATTRACTOR.name.to_owned()], &[plane.x_name, plane.y_name]);
    let told = basins.present().into_iter().map(|number| told(view, number));
    let saddles = (!saddles.is_empty()).then(|| "saddles on the boundary".to_owned());
    let told: Vec<String> = told.chain(basins.inferred(view)).chain(saddles).collect();
    Ok(canvas.finish(&format!("{about}: {}", told.join("; "))))
}

/// The basin of each case.
struct Basins {
    /// The number of the attractor of each case over the axes of the plane; negative for none.
    numbers: Vec<i64>,
    /// Whether a case has no result.
    without: Vec<bool>,
    /// Whether a case is inferred.
    inferred: Vec<bool>,
    /// Whether each attractor of the table is chaotic or quasi-periodic.
    irregular: Vec<bool>,
}

impl Basins {
    fn of(view: &View<'_>, plane: &Plane<'_>) -> Result<Basins, FigureError> {
        let free = plane.free();
        let numbers = view.take(ATTRACTOR.name, &free)?.iter().map(|it| *it as i64).collect();
        let outcomes = Outcomes::over(view, &free)?;
        let no_result = |case| matches!(outcomes.name(case), Some("failed" | "missing"));
        let without = (0..plane.count()).map(no_result).collect();
        let inferred = inferred::inferred(&outcomes, plane.count());
        let kinds = view.flags(ATTRACTOR_KIND.name);
        let is_irregular = |code: f64| {
            let name = kinds.iter().find(|(value, _)| *value as f64 == code);
            name.is_some_and(|(_, name)| name != "periodic")
        };
        let irregular = view.column(ATTRACTOR_KIND).into_iter().map(is_irregular).collect();
        Ok(Basins { numbers, without, inferred, irregular })
    }

    /// Which part of the starts is inferred, if any is, and how well.
    fn inferred(&self, view: &View<'_>) -> Vec<String> {
        inferred::told(view, &self.inferred, "starts", "lead elsewhere")
    }

    /// How a cell is filled.
    fn fill(&self, case: usize) -> Fill {
        match self.numbers[case] {
            _ if self.without[case] => Fill::NO_VALUE,
            number if number < 0 => Fill::Plain(UNDECIDED),
            number => self.of_attractor(number as usize),
        }
    }

    /// The attractor of a case, numbered from 1 as in the legend.
    fn value(&self, case: usize) -> Value {
        match self.numbers[case] {
            _ if self.without[case] => Value::None,
            number if number < 0 => Value::Name("unknown".to_owned()),
            number => Value::Number(number as f64 + 1.0),
        }
    }

    /// How the basin of an attractor is filled: hatched where the motion does not repeat.
    fn of_attractor(&self, number: usize) -> Fill {
        let own = colour(number);
        match self.irregular.get(number) {
            Some(true) => Fill::Hatched(tinted(own), own),
            _ => Fill::Plain(tinted(own)),
        }
    }

    /// The numbers of the attractors that occur.
    fn present(&self) -> Vec<usize> {
        let known = self.numbers.iter().filter(|number| **number >= 0);
        known.map(|number| *number as usize).collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// The attractors that occur, with what the table tells of them, and what else fills cells.
    fn legend(&self, view: &View<'_>) -> Vec<(Mark, Text)> {
        let present = self.present();
        let entry = |&number: &usize| {
            (Mark::Filled(self.of_attractor(number)), Text::plain(&told(view, number)))
        };
        let mut legend: Vec<_> = present.iter().take(NAMED).map(entry).collect();
        if present.len() > NAMED {
            let others = format!("{} other attractors", present.len() - NAMED);
            legend.push((Mark::Filled(Fill::Plain(tinted(OTHER_ATTRACTOR))), Text::plain(&others)));
        }
        let cases = || self.numbers.iter().zip(&self.without);
        if cases().any(|(number, without)| *number < 0 && !without) {
            legend.push((Mark::Patch(UNDECIDED), Text::plain("attractor unknown")));
        }
        if self.without.contains(&true) {
            legend.push((Mark::Filled(Fill::NO_VALUE), Text::plain("no result")));
        }
        legend
    }
}

/// The section points of the periodic attractors, by attractor, where the section is at the phase of the starts.
pub(super) fn section_points(view: &View<'_>, plane: &Plane<'_>) -> Vec<((f64, f64), RGBColor)> {
    let sections = section(view.model()).into_iter().map(|entry| Place::Attractor.of(entry));
    let places = in_plane(view, plane, &sections.collect::<Vec<_>>());
    let cycles = places.len() / view.coordinate_values(ATTRACTOR_INDEX.name).len().max(1);
    let coloured = |(place, at): (usize, (f64, f64))| (at, colour(place / cycles.max(1)));
    let points = places.into_iter().enumerate().map(coloured);
    points.filter(|((x, y), _)| x.is_finite() && y.is_finite()).collect()
}

/// The section points of the saddles between basins.
fn saddles(view: &View<'_>, plane: &Plane<'_>) -> Vec<(f64, f64)> {
    let places = in_plane(view, plane, &edges(view.model()));
    places.into_iter().filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
}

/// Section points as they are seen in the plane of the starts, in the units of the figure; none where the section is at another
/// phase than the starts.
fn in_plane(view: &View<'_>, plane: &Plane<'_>, sections: &[Entry]) -> Vec<(f64, f64)> {
    let model = view.model();
    let phase = |it: Coordinate| view.parameter(it.name(), &[]).ok()?.first().copied();
    let phases: Vec<Option<f64>> = Coordinate::phases(model).map(phase).collect();
    if phases.contains(&None) || phases.first() != phases.last() {
        return Vec::new();
    }
    let columns: Vec<Vec<f64>> = sections.iter().map(|entry| view.column(*entry)).collect();
    let points = columns.first().map_or(0, Vec::len);
    let of_axis = |name: &str| -> Vec<f64> {
        let place = Coordinate::of_section(model).position(|it| it.name() == name);
        let factor = view.quantity(name).factor;
        // What is no coordinate of the section is zero there.
        let values = place.map_or(vec![0.0; points], |place| columns[place].clone());
        values.into_iter().map(|value| value * factor).collect()
    };
    of_axis(plane.x_name).into_iter().zip(of_axis(plane.y_name)).collect()
}

/// The colour of an attractor in every figure: by its number.
pub(super) fn colour(number: usize) -> RGBColor {
    ATTRACTORS.get(number).copied().unwrap_or(OTHER_ATTRACTOR)
}

/// The colour of an area that belongs to an attractor.
pub(super) fn band(number: usize) -> RGBColor {
    tinted(colour(number))
}

/// The colour of an area that belongs to no known attractor.
pub(super) fn undecided() -> RGBColor {
    UNDECIDED
}

/// A colour with paper in it.
fn tinted(RGBColor(red, green, blue): RGBColor) -> RGBColor {
    let RGBColor(white, ..) = PAPER;
    let mix =
        |channel: u8| (f64::from(channel) * (1.0 - TINT) + f64::from(white) * TINT).round() as u8;
    RGBColor(mix(red), mix(green), mix(blue))
}

/// An attractor in a phrase: its kind or period, its speed, and its share with the error.
fn told(view: &View<'_>, number: usize) -> String {
    let of = |entry: Entry| view.column(entry).get(number).copied();
    if of(ATTRACTOR_KIND).is_none() {
        return format!("attractor {number}");
    }
    let mut parts = vec![motion(view, of(ATTRACTOR_KIND), of(ATTRACTOR_PERIOD))];
    let model = view.model();
    if model.has_trade_off() {
        let speed = of(Place::Attractor.of(Entry::of_output(model.speed())));
        parts.extend(speed.map(|it| format!("{} mm/s", millimetres(it))));
    }
    if let (Some(share), Some(error)) = (of(ATTRACTOR_SHARE), of(ATTRACTOR_SHARE_ERROR)) {
        let (share, error) = (100.0 * share, 100.0 * error);
        // Two digits of the error say how many of the share are known.
        let decimals =
            if error > 0.0 { (1.0 - error.log10().floor()).clamp(0.0, 4.0) } else { 1.0 };
        let decimals = decimals as usize;
        parts.push(match error > 0.0 {
            _ if error.is_nan() => {
                format!("{share:.1} % of the starts computed, others are missing")
            }
            true => format!("{share:.decimals$} ± {error:.decimals$} % of the starts"),
            false => format!("{share:.decimals$} % of the starts"),
        });
    }
    parts.join(", ")
}

/// What a motion is, by its kind as files have it: its period, or the name of its kind.
pub(super) fn motion(view: &View<'_>, code: Option<f64>, period: Option<f64>) -> String {
    let kinds = view.flags(ATTRACTOR_KIND.name);
    let kind = kinds.iter().find(|(value, _)| Some(*value as f64) == code);
    match (kind.map(|(_, name)| name.as_str()), period) {
        (Some("periodic"), Some(period)) => format!("period {period}"),
        (kind, _) => kind.unwrap_or("unknown").to_owned(),
    }
}

/// A speed [m/s] in mm/s, with three digits; what rounding leaves is zero.
pub(super) fn millimetres(speed: f64) -> String {
    significant(if speed.abs() < NOISE { 0.0 } else { 1e3 * speed }, 3)
}

/// The ends of the line where the mass reaches the stop, if an axis is its displacement and the line lies on it.
fn surface(view: &View<'_>, plane: &Plane<'_>) -> Option<[(f64, f64); 2]> {
    let delta = view.model().impact_surface()?.symbol();
    let factor = view.quantity(delta).factor;
    let gap = view.parameter(delta, &[]).ok()?.first().copied()? * factor;
    let displacement = Coordinate::starts(view.model()).next()?.name();
    let (x, y) = (&plane.x.scale, &plane.y.scale);
    let inside = |low: f64, high: f64| (low..=high).contains(&gap);
    if plane.x_name == displacement && inside(x.low, x.high) {
        return Some([(gap, y.low), (gap, y.high)]);
    }
    let along_y = plane.y_name == displacement && inside(y.low, y.high);
    along_y.then_some([(x.low, gap), (x.high, gap)])
}

/// Draws section points, those of each attractor in its colour.
pub(super) fn mark_points(canvas: &mut Canvas, panel: &Panel, points: &[((f64, f64), RGBColor)]) {
    canvas.clipped(panel.frame, |canvas| {
        for ((x, y), colour) in points {
            let at = panel.place(*x, *y);
            canvas.discs(&[(at, PAPER)], RADIUS + RIM);
            canvas.discs(&[(at, INK)], RADIUS);
            canvas.discs(&[(at, *colour)], RADIUS - RIM);
        }
    });
    panel.record(canvas, "section points of the attractors", points.iter().map(|it| it.0));
}

/// Draws the section points of saddles: rings on paper, as they belong to no basin.
fn mark_saddles(canvas: &mut Canvas, panel: &Panel, saddles: &[(f64, f64)]) {
    canvas.clipped(panel.frame, |canvas| {
        for (x, y) in saddles {
            let at = panel.place(*x, *y);
            canvas.discs(&[(at, PAPER)], RADIUS + RIM);
            canvas.rings(&[at], RADIUS, Stroke::solid(INK, 2.0 * RIM));
        }
    });
}
