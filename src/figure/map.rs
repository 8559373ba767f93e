//! One output over two axes, in colours.

use plotters::style::RGBColor;

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn};
use super::category::{self, Kinds};
use super::colour::Colours;
use super::error::FigureError;
use super::header::{Header, Mark};
use super::inferred;
use super::kind::{Kind, Names, Needs};
use super::outcome::{self, Outcomes};
use super::page::{PageRequest, PanelRequest};
use super::panel::{Panel, Pointing};
use super::plane::Plane;
use super::raster::Fill;
use super::style::{INFERRED, INFINITE};
use super::text::Text;
use super::view::View;
use crate::capsule::Output;
use crate::store::catalogue::{self, Entry, PERIOD, Type};
use crate::study::Drawing;

/// The output shown, unless another is asked for.
const OUTPUT: Entry = Entry::of_output(Output::ProgressionSpeed);
/// Height of the frame [pt].
const HEIGHT: f64 = 158.0;

/// How the cells are coloured.
enum Paint {
    /// By their values; those that are inferred and have none are marked.
    Numbers(Option<Colours>, Vec<f64>, Vec<bool>),
    Kinds(Kinds),
}

impl Paint {
    /// The colour of a case; none where it has no value.
    fn colour(&self, case: usize) -> Option<RGBColor> {
        match self {
            Paint::Numbers(_, values, _) if values[case].is_infinite() => Some(INFINITE),
            Paint::Numbers(_, values, inferred) if values[case].is_nan() => {
                inferred[case].then_some(INFERRED)
            }
            Paint::Numbers(colours, values, _) => colours.as_ref().map(|it| it.of(values[case])),
            Paint::Kinds(kinds) => kinds.colour(case),
        }
    }

    /// Room beside the frame for the bar or the list of kinds [pt].
    fn room(&self) -> f64 {
        match self {
            Paint::Numbers(colours, ..) => colours.as_ref().map_or(0.0, |it| it.room(HEIGHT)),
            Paint::Kinds(kinds) => kinds.room(),
        }
    }

    /// Draws the bar or the list of kinds beside `panel`.
    fn explain(&self, canvas: &mut Canvas, panel: &Panel) {
        match self {
            Paint::Numbers(Some(colours), ..) => colours.draw_bar(canvas, panel.frame),
            Paint::Numbers(None, ..) => {}
            Paint::Kinds(kinds) => kinds.draw_legend(canvas, panel.frame),
        }
    }

    /// The entries that the colour bar does not explain.
    fn legend(&self) -> Vec<(Mark, Text)> {
        let Paint::Numbers(_, values, inferred) = self else { return Vec::new() };
        let mut legend = Vec::new();
        if values.iter().any(|value| value.is_infinite()) {
            legend.push((Mark::Patch(INFINITE), Text::plain("infinite")));
        }
        let mut without = values.iter().zip(inferred).filter(|(value, _)| value.is_nan());
        if without.clone().any(|(_, inferred)| *inferred) {
            legend.push((Mark::Patch(INFERRED), Text::plain("not computed")));
        }
        if without.any(|(_, inferred)| !inferred) {
            legend.push((Mark::Filled(Fill::NO_VALUE), Text::plain("no value")));
        }
        legend
    }
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What a map reads: its output, the outcomes, and what sorts cases where it shows kinds of them.
fn reads(drawing: &Drawing) -> Names {
    let output = drawing.of.first().map_or(OUTPUT.name, String::as_str);
    let entry = catalogue::named(output);
    let sorted = entry.is_none_or(|entry| !matches!(entry.numbers, Type::Real));
    let sorting = category::READS.into_iter().filter(|_| sorted);
    Names::of(outcome::READS).and(inferred::READS).and(sorting).and_named([output.to_owned()])
}

/// Draws the map that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let plane = Plane::of(view, "a map")?;
    let (x_name, y_name) = (plane.x_name, plane.y_name);
    let output = view.drawing.of.first().cloned().unwrap_or_else(|| OUTPUT.name.to_owned());
    let paint = paint(view, &output, &plane.free(), plane.count())?;
    let inferred = inferred::inferred(&Outcomes::over(view, &plane.free())?, plane.count());
    let told = inferred::told(view, &inferred, "cases", "differ");
    let legend = told.iter().map(|it| (Mark::Nothing, Text::plain(it)));
    let panel = PanelRequest {
        x: AxisRequest::new(view.quantity(x_name), plane.x.scale),
        y: AxisRequest::new(view.quantity(y_name), plane.y.scale),
        header: Header {
            note: view.held_note(&[x_name, y_name]),
            legend: paint.legend().into_iter().chain(legend).chain(plane.legend()).collect(),
            ..Header::default()
        },
    };
    let page = PageRequest::of_one(view.drawing, panel, HEIGHT, Pointing::Outward);
    let page = PageRequest { right_room: paint.room(), ..page };
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        plane.draw(&mut canvas, panel, |case| Fill::of(paint.colour(case)));
        panel.finish(&mut canvas);
        paint.explain(&mut canvas, panel);
    }
    Ok(canvas.finish(&view.about(&[output], &[x_name, y_name])))
}

fn paint(view: &View<'_>, output: &str, free: &[&str], cases: usize) -> Result<Paint, FigureError> {
    let mut values: Vec<f64> = view.shown(output, free)?.into_iter().collect();
    if values.len() != cases {
        let why = format!("`{output}` has several values per case, and a map shows one");
        return Err(view.unfit(why));
    }
    if output == PERIOD.name || !view.flags(output).is_empty() {
        return Ok(Paint::Kinds(Kinds::of(view, output, free)?));
    }
    let outcomes = Outcomes::over(view, free)?;
    let inferred = inferred::inferred(&outcomes, cases);
    for (case, value) in values.iter_mut().enumerate() {
        if outcomes.failed(case) {
            *value = f64::NAN;
        }
    }
    let colours = Colours::for_values(&values, view.quantity(output));
    Ok(Paint::Numbers(colours, values, inferred))
}
