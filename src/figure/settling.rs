//! For how many cycles each start is followed until its attractor is decided, over two coordinates of the start.

use super::attractor_colours::Colours as Attractors;
use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn};
use super::colour::Colours;
use super::data::Value;
use super::error::FigureError;
use super::header::{self, Header, Mark};
use super::inferred::inferred;
use super::kind::{Kind, Names, Needs};
use super::outcome::{self, Outcomes, told_of_missing};
use super::page::{PageRequest, PanelRequest};
use super::panel::{Panel, Pointing};
use super::plane::Plane;
use super::raster::Fill;
use super::section_points::{self, SectionPoint, draw_section_points, section_points};
use super::style::{INFERRED, NOT_YET};
use super::text::Text;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::CYCLES;
use crate::study::Drawing;

/// Height of the frame [pt].
const HEIGHT: f64 = 170.0;

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What the figure reads: the cycles of each case, and the section points of the attractors.
fn reads(_: &Drawing, model: &'static Description) -> Names {
    Names::of(outcome::READS).and([CYCLES]).and_all(section_points::reads(model))
}

/// Draws the cycles that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let settling = Settling::of(view)?;
    let panel = settling.request(view);
    let page = PageRequest::of_one(view.drawing, panel, HEIGHT, Pointing::Outward);
    let page = PageRequest {
        right_room: &|height| settling.colours.as_ref().map_or(0.0, |it| it.room(height)),
        ..page
    };
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        settling.draw(&mut canvas, panel);
    }
    Ok(canvas.finish(&settling.about(view)))
}

/// The cycles of each case over a plane, and the section points over them.
struct Settling<'a> {
    plane: Plane<'a>,
    /// The cycles of each case over the axes of the plane; NaN where it was not followed to an end.
    cycles: Vec<f64>,
    /// Whether a case is inferred.
    inferred: Vec<bool>,
    /// Whether a case is not computed yet.
    not_yet: Vec<bool>,
    /// The colours of the cycles; none where no case has any.
    colours: Option<Colours>,
    /// The section points of the attractors.
    points: Vec<SectionPoint>,
}

impl<'a> Settling<'a> {
    /// What the figure shows of the results.
    fn of(view: &View<'a>) -> Result<Settling<'a>, FigureError> {
        let plane = Plane::of_starts(view, "a figure of settling", "it lies")?;
        let free = plane.free();
        let mut cycles: Vec<f64> = view.shown(CYCLES.name, &free)?.into_iter().collect();
        let outcomes = Outcomes::over(view, &free)?;
        let inferred = inferred(&outcomes, cycles.len());
        let not_yet: Vec<bool> = (0..cycles.len()).map(|case| outcomes.missing(case)).collect();
        for (case, cycles) in cycles.iter_mut().enumerate() {
            if inferred[case] || not_yet[case] || outcomes.failed(case) {
                *cycles = f64::NAN;
            }
        }
        let colours = Colours::for_values(&cycles, view.quantity(CYCLES.name));
        let points = match view.shows("section-points") {
            true => section_points(view, &plane, &Attractors::of(view)?),
            false => Vec::new(),
        };
        Ok(Settling { plane, cycles, inferred, not_yet, colours, points })
    }

    /// The panel with what its fills and marks mean.
    fn request(&self, view: &View<'_>) -> PanelRequest {
        let Plane { x_name, y_name, x, y } = &self.plane;
        let legend = self.legend();
        PanelRequest {
            x: AxisRequest::new(view.quantity(x_name), x.scale),
            y: AxisRequest::new(view.quantity(y_name), y.scale),
            header: Header { note: view.held_note(&self.plane.free()), legend, letter: None },
        }
    }

    fn legend(&self) -> Vec<header::Entry> {
        let mut legend = Vec::new();
        if let Some(point) = self.points.first() {
            let text = "section points of the attractors";
            legend.push((Mark::Rimmed(point.colour), Text::plain(text)));
        }
        if self.inferred.contains(&true) {
            legend.push((Mark::Patch(INFERRED), Text::plain("inferred, not followed")));
        }
        let cases = self.cycles.iter().zip(self.inferred.iter().zip(&self.not_yet));
        let mut computed = cases.filter(|(_, (inferred, not_yet))| !*inferred && !*not_yet);
        if computed.any(|(cycles, _)| cycles.is_nan()) {
            legend.push((Mark::Filled(Fill::NO_VALUE), Text::plain("no result")));
        }
        let missing = self.not_yet.iter().filter(|it| **it).count();
        let missing = told_of_missing(missing, self.not_yet.len());
        legend.extend(missing.map(|words| (Mark::Patch(NOT_YET), Text::plain(&words))));
        legend.extend(self.plane.legend());
        legend
    }

    /// How a cell is filled.
    fn fill(&self, case: usize) -> Fill {
        let cycles = self.cycles[case];
        match &self.colours {
            _ if self.inferred[case] => Fill::Plain(INFERRED),
            _ if self.not_yet[case] => Fill::Plain(NOT_YET),
            Some(colours) if !cycles.is_nan() && colours.has(cycles) => {
                Fill::Plain(colours.of(cycles))
            }
            _ => Fill::NO_VALUE,
        }
    }

    /// Draws the cells, the section points over them and the bar beside them.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        self.plane.draw(canvas, panel, |case| self.fill(case));
        let told = self.colours.as_ref().map_or(String::new(), Colours::told);
        self.plane.record(canvas, panel, &told, |case| Value::Number(self.cycles[case]));
        draw_section_points(canvas, panel, &self.points);
        panel.finish(canvas);
        if let Some(colours) = &self.colours {
            colours.draw_bar(canvas, panel.frame);
        }
    }

    /// What the figure shows, and how many cases are inferred.
    fn about(&self, view: &View<'_>) -> String {
        let about = view.about(&[CYCLES.name.to_owned()], &self.plane.names());
        match self.inferred.iter().filter(|it| **it).count() {
            0 => about,
            count => format!("{about}; {count} inferred, not followed"),
        }
    }
}
