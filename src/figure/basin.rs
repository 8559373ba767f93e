//! Basins of attraction: which attractor each start leads to, over two coordinates of the start.

use std::collections::BTreeSet;

use super::attractor_colours::{Colours, tinted};
use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn, Stroke};
use super::data::Value;
use super::error::FigureError;
use super::header::{self, Header, Mark};
use super::inferred;
use super::kind::{Kind, Names, Needs};
use super::known_attractors::{self, KnownAttractors};
use super::manifolds::{self, Curves};
use super::motion::Motion;
use super::outcome::{self, Outcomes, told_of_missing};
use super::page::{PageRequest, PanelRequest};
use super::panel::{Panel, Pointing};
use super::plane::Plane;
use super::raster::Fill;
use super::section_points::{
    self, SectionPoint, behind, draw_saddles, draw_section_points, saddles, section_points,
};
use super::style::{INK, NOT_YET, OTHER_ATTRACTOR, POINT_RADIUS, REFERENCE_WIDTH, UNDECIDED};
use super::text::Text;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{ATTRACTOR, Entry, Place, edges, starts};
use crate::study::{Coordinate, Drawing};

/// Height of the frame [pt].
const HEIGHT: f64 = 170.0;
/// The line where the mass reaches the stop.
const SURFACE: Stroke = Stroke::dashed(INK, REFERENCE_WIDTH);

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What basins read: the attractor of each case, and the table of the attractors.
fn reads(_: &Drawing, model: &'static Description) -> Names {
    Names::of(outcome::READS)
        .and([ATTRACTOR])
        .and(known_attractors::READS)
        .and_all(section_points::reads(model))
        .and(edges(model))
        .and_all(manifolds::reads(model))
        .and(inferred::READS)
        .and([Place::Attractor.of(Entry::of_output(model.main_output()))])
        .and(model.parameters().map(Entry::of_parameter))
}

/// Draws the basins that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let mut basins = Basins::of(view)?;
    // Which points lie behind others is known once the panel has its place.
    let page = PageRequest::of_one(view.drawing, basins.request(view), HEIGHT, Pointing::Outward);
    let (_, panels) = page.lay_out();
    let each = panels.iter().flatten();
    basins.behind = each.map(|it| behind(it, &basins.points, &basins.saddles)).sum();
    let page = PageRequest::of_one(view.drawing, basins.request(view), HEIGHT, Pointing::Outward);
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        basins.draw(&mut canvas, panel);
        panel.finish(&mut canvas);
    }
    Ok(canvas.finish(&basins.about(view)))
}

/// The basin of each case over a plane, and what lies over them.
struct Basins<'a> {
    plane: Plane<'a>,
    /// The number of the attractor of each case over the axes of the plane; negative for none.
    numbers: Vec<i64>,
    /// Whether a case has no result.
    without: Vec<bool>,
    /// Whether a case is not computed yet.
    not_yet: Vec<bool>,
    /// What the results tell of the attractors.
    attractors: KnownAttractors<'a>,
    colours: Colours,
    /// Whether each attractor of the table is chaotic or quasi-periodic.
    irregular: Vec<bool>,
    /// Which part of the starts is inferred, if any is, and how well.
    inferred: Vec<String>,
    /// The section points of the attractors.
    points: Vec<SectionPoint>,
    /// The section points of saddles.
    saddles: Vec<(f64, f64)>,
    /// How many of both lie behind others.
    behind: usize,
    /// Their manifolds.
    curves: Curves,
    /// The ends of the lines where the mass reaches its stops.
    surfaces: Vec<[(f64, f64); 2]>,
}

impl<'a> Basins<'a> {
    /// What the figure shows of the results.
    fn of(view: &View<'a>) -> Result<Basins<'a>, FigureError> {
        if view.dataset.variable(ATTRACTOR.name).is_none() {
            let of_starts = starts(view.model()).into_iter().map(|entry| entry.name);
            let axes = of_starts.collect::<Vec<_>>().join(", ");
            let why = format!("the results tell no attractors; it needs two axes of {axes}");
            return Err(view.unfit(why));
        }
        let plane = Plane::of_starts(view, "a figure of basins", "basins lie")?;
        let free = plane.free();
        let numbers = view.take(ATTRACTOR.name, &free)?.iter().map(|it| *it as i64).collect();
        let outcomes = Outcomes::over(view, &free)?;
        let without = (0..plane.count()).map(|case| outcomes.failed(case)).collect();
        let not_yet = (0..plane.count()).map(|case| outcomes.missing(case)).collect();
        let inferred = inferred::inferred(&outcomes, plane.count());
        let attractors = KnownAttractors::held(view)?;
        let colours = Colours::of(view)?;
        Ok(Basins {
            numbers,
            without,
            not_yet,
            irregular: attractors.irregular(),
            attractors,
            inferred: inferred::told(view, &inferred, "starts", "lead elsewhere"),
            points: match view.shows("section-points") {
                true => section_points(view, &plane, &colours),
                false => Vec::new(),
            },
            saddles: if view.shows("saddles") { saddles(view, &plane) } else { Vec::new() },
            curves: if view.shows("manifolds") { Curves::of(view, &plane) } else { Curves::none() },
            behind: 0,
            surfaces: match view.shows("impact-surface") {
                true => surfaces(view, &plane),
                false => Vec::new(),
            },
            colours,
            plane,
        })
    }

    /// The panel with what its fills and marks mean.
    fn request(&self, view: &View<'_>) -> PanelRequest {
        let mut legend = self.legend_of_fills();
        legend.extend(self.legend_of_marks(view.model()));
        legend.extend(self.inferred.iter().map(|it| (Mark::Nothing, Text::plain(it))));
        legend.extend(self.plane.legend());
        let note = view.held_note(&self.plane.free());
        PanelRequest {
            x: AxisRequest::new(view.quantity(self.plane.x_name), self.plane.x.scale),
            y: AxisRequest::new(view.quantity(self.plane.y_name), self.plane.y.scale),
            header: Header { note, legend, letter: None },
        }
    }

    /// The attractors that occur, with what the table tells of them, and what else fills cells.
    fn legend_of_fills(&self) -> Vec<header::Entry> {
        let present = self.present();
        let mut legend = Vec::new();
        let (own, others): (Vec<usize>, Vec<usize>) =
            present.into_iter().partition(|number| self.colours.has(*number));
        for number in own {
            let fill = Mark::Filled(self.of_attractor(number));
            legend.push((fill, Text::plain(&self.attractors.told(number))));
        }
        if !others.is_empty() {
            let others = format!("{} further attractors", others.len());
            legend.push((Mark::Filled(Fill::Plain(tinted(OTHER_ATTRACTOR))), Text::plain(&others)));
        }
        let cases = self.numbers.iter().zip(self.without.iter().zip(&self.not_yet));
        let mut computed = cases.filter(|(_, (without, not_yet))| !*without && !*not_yet);
        if computed.any(|(number, _)| *number < 0) {
            legend.push((Mark::Patch(UNDECIDED), Text::plain("attractor unknown")));
        }
        if self.without.contains(&true) {
            legend.push((Mark::Filled(Fill::NO_VALUE), Text::plain("no result")));
        }
        let missing = self.not_yet.iter().filter(|it| **it).count();
        let missing = told_of_missing(missing, self.not_yet.len());
        legend.extend(missing.map(|words| (Mark::Patch(NOT_YET), Text::plain(&words))));
        legend
    }

    /// What lies over the cells.
    fn legend_of_marks(&self, model: &'static Description) -> Vec<header::Entry> {
        // A plane of all coordinates of a start is no projection.
        let is_projected = starts(model).len() > 2;
        let mut legend = Vec::new();
        if let Some(point) = self.points.first() {
            let more = if is_projected { ", projected onto the plane" } else { "" };
            let are_several = self.points.iter().any(|it| it.colour != point.colour);
            let of = if are_several { "orbits in their colours" } else { "orbits" };
            let words = Text::plain(&format!("section points of the {of}{more}"));
            legend.push((Mark::Rimmed(point.colour), words));
        }
        if !self.saddles.is_empty() {
            let more = if is_projected { ", projected alike" } else { "" };
            let words = Text::plain(&format!("saddles on the boundary{more}"));
            legend.push((Mark::Ring(INK, POINT_RADIUS), words));
        }
        if self.behind > 0 {
            let words = format!("of these points, behind others: {}", self.behind);
            legend.push((Mark::Nothing, Text::plain(&words)));
        }
        legend.extend(self.curves.legend());
        if !self.surfaces.is_empty() {
            let several = if self.surfaces.len() > 1 { "s" } else { "" };
            let words = Text::plain(&format!("impact surface{several}"));
            legend.push((Mark::Line(SURFACE), words));
        }
        legend
    }

    /// Draws the basins and what lies over them.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        self.plane.draw(canvas, panel, |case| self.fill(case));
        self.plane.record(canvas, panel, ATTRACTOR.name, |case| self.value(case));
        for ends in &self.surfaces {
            panel.curve(canvas, ends, SURFACE);
        }
        self.curves.draw(canvas, panel);
        draw_section_points(canvas, panel, &self.points);
        draw_saddles(canvas, panel, &self.saddles);
        panel.record(canvas, "saddles on the boundary", self.saddles.iter().copied());
    }

    /// What the figure shows, with the attractors that occur.
    fn about(&self, view: &View<'_>) -> String {
        let about = view.about(&[ATTRACTOR.name.to_owned()], &self.plane.names());
        let attractors = self.present().into_iter().map(|number| self.attractors.told(number));
        let saddles = (!self.saddles.is_empty()).then(|| "saddles on the boundary".to_owned());
        let beside = self.inferred.iter().cloned().chain(saddles).chain(self.curves.about());
        let told: Vec<String> = attractors.chain(beside).collect();
        format!("{about}: {}", told.join("; "))
    }

    /// How a cell is filled.
    fn fill(&self, case: usize) -> Fill {
        match self.numbers[case] {
            _ if self.without[case] => Fill::NO_VALUE,
            _ if self.not_yet[case] => Fill::Plain(NOT_YET),
            number if number < 0 => Fill::Plain(UNDECIDED),
            number => self.of_attractor(number as usize),
        }
    }

    /// The attractor of a case, numbered as in the file and in the legend.
    fn value(&self, case: usize) -> Value {
        match self.numbers[case] {
            _ if self.without[case] || self.not_yet[case] => Value::None,
            number if number < 0 => Value::Name("unknown".to_owned()),
            number => Value::Number(number as f64),
        }
    }

    /// How the basin of an attractor is filled: hatched where the motion does not repeat.
    fn of_attractor(&self, number: usize) -> Fill {
        match self.irregular.get(number) {
            Some(true) => Fill::Hatched(self.colours.band(number), self.colours.colour(number)),
            _ => Fill::Plain(self.colours.band(number)),
        }
    }

    /// The numbers of the attractors that occur.
    fn present(&self) -> Vec<usize> {
        let known = self.numbers.iter().filter(|number| **number >= 0);
        known.map(|number| *number as usize).collect::<BTreeSet<_>>().into_iter().collect()
    }
}

/// The ends of the lines where the mass reaches its stops, as far as an axis is its displacement and they lie on it.
fn surfaces(view: &View<'_>, plane: &Plane<'_>) -> Vec<[(f64, f64); 2]> {
    let Some(displacement) = Coordinate::starts(view.model()).next() else { return Vec::new() };
    let factor = view.quantity(displacement.name()).factor;
    let stops = Motion::drawn(view, &plane.free(), 0).stops();
    let (x, y) = (&plane.x.scale, &plane.y.scale);
    let ends = stops.into_iter().filter_map(|(at, _)| {
        let gap = at * factor;
        if plane.x_name == displacement.name() && (x.low..=x.high).contains(&gap) {
            return Some([(gap, y.low), (gap, y.high)]);
        }
        let along_y = plane.y_name == displacement.name() && (y.low..=y.high).contains(&gap);
        along_y.then_some([(x.low, gap), (x.high, gap)])
    });
    ends.collect()
}
