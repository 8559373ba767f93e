//! Poincaré sections of one case: the stroboscopic one, and the one at the impacts.

use std::f64::consts::TAU;

use plotters::style::RGBColor;

use super::attractor_colours::Colours;
use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn};
use super::case_panels::CasePanel;
use super::cloud::{self, Dot};
use super::error::FigureError;
use super::header::Header;
use super::kind::{Kind, Names, Needs};
use super::motion::Motion;
use super::page::{PageRequest, PanelRequest, in_rows, letter};
use super::panel::{Panel, Pointing};
use super::quantity::Quantity;
use super::style::{INK, TWO_COLUMNS};
use super::text::Text;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{Entry, impacts, section};
use crate::study::Drawing;

/// Height of the frames [pt].
const HEIGHT: f64 = 165.0;
/// The unit of phases in files.
const RADIANS: &str = "rad";
/// Width below which sections do not stand beside each other [mm].
const NARROW: f64 = 120.0;

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What sections read.
fn reads(_: &Drawing, model: &'static Description) -> Names {
    let surface = model.impact_surface().map(Entry::of_parameter);
    Names::of(section(model)).and(impacts(model)).and(surface)
}

/// A section: its two coordinates, and its points in the units of the figure.
struct Section {
    name: &'static str,
    quantities: [Quantity; 2],
    points: Vec<[f64; 2]>,
    /// Its attractor by the number in the file, with its colour, where the results number it.
    attractor: Option<(usize, RGBColor)>,
}

impl Section {
    /// How many points it has, and of which attractor.
    fn told(&self) -> String {
        let count = self.points.len();
        let of = self.attractor.map_or(String::new(), |it| format!(" of attractor {}", it.0));
        format!("{count} {}{}{of}", self.name, if count == 1 { "" } else { "s" })
    }

    /// Its panel with this letter; `held` says where the axes are held, where the panel is the one that says it.
    fn request(&self, letter: Option<char>, held: Option<Text>) -> PanelRequest {
        let [x, y] = self.quantities.clone();
        let [of_x, of_y] = [0, 1].map(|i| self.points.iter().map(|it| it[i]).collect::<Vec<f64>>());
        let told = Text::plain(&self.told());
        let note = match held {
            Some(held) => told.then(Text::plain(" of the case at ")).then(held),
            None => told,
        };
        PanelRequest {
            x: AxisRequest::around(x, &of_x, 0.05),
            y: AxisRequest::around(y, &of_y, 0.05),
            header: Header { letter, note: Some(note), legend: Vec::new() },
        }
    }

    /// Draws its points.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel, drawing: &Drawing) {
        let crowding = self.points.len() as f64;
        let colour = self.attractor.map_or(INK, |it| it.1);
        let mut dots = Vec::new();
        for [x, y] in &self.points {
            dots.push(Dot { at: (*x, *y), colour, crowding, case: 0 });
        }
        cloud::draw(canvas, panel, &dots, cloud::radius(drawing, dots.len()));
        panel.record(canvas, self.name, dots.iter().map(|dot| dot.at));
    }
}

/// Draws the sections that `view` asks for, those of which the study keeps points.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let sections = sections(view)?;
    let page = page(view, &sections);
    let (mut canvas, panels) = page.lay_out();
    for (panel, section) in panels.iter().flatten().zip(&sections) {
        section.draw(&mut canvas, panel, view.drawing);
        panel.finish(&mut canvas);
    }
    let told: Vec<String> = sections.iter().map(Section::told).collect();
    let held = view.held_record(&[]);
    let at = if held.is_empty() { held } else { format!(" at {held}") };
    Ok(canvas.finish(&format!("section{at}: {}", told.join(", "))))
}

/// What the figure shows of the results: at least one section.
fn sections(view: &View<'_>) -> Result<Vec<Section>, FigureError> {
    let attractor = CasePanel { view: view.clone(), free: Vec::new(), case: 0 }.attractor()?;
    let colours = Colours::of(view)?;
    let attractor = attractor.map(|number| (number, colours.colour(number)));
    let found = [stroboscopic(view)?, at_impacts(view)?].into_iter().flatten();
    let sections: Vec<Section> = found.map(|section| Section { attractor, ..section }).collect();
    if section(view.model()).len() < 2 {
        let why = "section points of one coordinate have no plane; `bifurcation` shows them";
        return Err(view.unfit(why));
    }
    if sections.is_empty() {
        let why = "there are no section points; `points` of [protocol] says how many are kept";
        return Err(view.unfit(why));
    }
    Ok(sections)
}

/// The sections beside each other, or below each other in a narrow figure.
fn page<'a>(view: &View<'a>, sections: &[Section]) -> PageRequest<'a> {
    let count = sections.len();
    let first = sections[0].request(letter(0, count), view.held_note(&[]));
    let first = PageRequest::of_one(view.drawing, first, HEIGHT, Pointing::Inward);
    let mut panels = Vec::new();
    for (index, section) in sections.iter().enumerate() {
        // The values at which the axes are held are named once.
        let held = view.held_note(&[]).filter(|_| index == 0);
        panels.push(section.request(letter(index, count), held));
    }
    let columns = if view.drawing.width_mm.is_some_and(|it| it < NARROW) { 1 } else { 2 };
    let rows = in_rows(panels, columns);
    PageRequest {
        width_mm: if count > 1 { TWO_COLUMNS } else { first.width_mm },
        heights: vec![HEIGHT; rows.len()],
        rows,
        ..first
    }
}

fn stroboscopic(view: &View<'_>) -> Result<Option<Section>, FigureError> {
    let [x, y] = match coordinates(view)?[..] {
        [x, y, ..] if view.dataset.variable(x.name).is_some() => [x, y],
        _ => return Ok(None),
    };
    let quantities = [x, y].map(|entry| view.quantity(entry.name));
    let name = "stroboscopic section point";
    Ok(Some(section_of(name, quantities, shown(view, x)?, shown(view, y)?)))
}

/// The section coordinates, those first that are asked for.
fn coordinates(view: &View<'_>) -> Result<Vec<Entry>, FigureError> {
    let known = section(view.model());
    let mut asked = Vec::new();
    for name in &view.drawing.of {
        let Some(found) = known.iter().find(|it| it.name == name) else {
            let names: Vec<&str> = known.iter().map(|it| it.name).collect();
            let names = names.join(", ");
            return Err(view.unfit(format!("a section cannot show `{name}`; it can show {names}")));
        };
        asked.push(*found);
    }
    Ok(asked.into_iter().chain(known).collect())
}

/// The first number that is told of an impact, and the ordinate of a phase portrait there.
fn at_impacts(view: &View<'_>) -> Result<Option<Section>, FigureError> {
    let model = view.model();
    let (Some(first), Some([_, ordinate])) =
        (impacts(model).first().copied(), model.motion.portrait)
    else {
        return Ok(None);
    };
    if view.dataset.variable(first.name).is_none() {
        return Ok(None);
    }
    let quantities = [first.name, ordinate].map(|name| view.quantity(name));
    let factor = quantities[1].factor;
    let values = Motion::sampled(view, &[], 0).at_impacts(ordinate)?;
    let values = values.into_iter().map(|value| value * factor).collect();
    let turn = TAU * quantities[0].factor;
    let firsts = shown(view, first)?;
    let firsts = if first.unit == RADIANS { cut_in_gap(firsts, turn) } else { firsts };
    Ok(Some(section_of("kept impact", quantities, firsts, values)))
}

/// Phases from 0 to a whole `turn`, cut where the widest gap between them is, so that those around zero stay together: what lies
/// beyond the gap is one turn less.
fn cut_in_gap(phases: Vec<f64>, turn: f64) -> Vec<f64> {
    let mut sorted: Vec<f64> = phases.iter().copied().filter(|it| it.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else { return phases };
    let across_zero = first + turn - last;
    let gaps = sorted.windows(2).map(|pair| (pair[1] - pair[0], (pair[0] + pair[1]) / 2.0));
    let widest = gaps.max_by(|a, b| a.0.total_cmp(&b.0));
    match widest.filter(|(gap, _)| *gap > across_zero) {
        None => phases,
        Some((_, cut)) => {
            phases.into_iter().map(|it| if it > cut { it - turn } else { it }).collect()
        }
    }
}

/// The numbers of a case, in the units of the figure.
fn shown(view: &View<'_>, entry: Entry) -> Result<Vec<f64>, FigureError> {
    Ok(view.shown(entry.name, &[])?.into_iter().collect())
}

/// A section with the points that a case has.
fn section_of(name: &'static str, quantities: [Quantity; 2], x: Vec<f64>, y: Vec<f64>) -> Section {
    let both = x.into_iter().zip(y).map(|(x, y)| [x, y]);
    let points: Vec<[f64; 2]> = both.filter(|at| at.iter().all(|it| it.is_finite())).collect();
    Section { name, quantities, points, attractor: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_are_cut_where_there_are_none() {
        let near = |found: Vec<f64>, expected: &[f64]| {
            assert_eq!(found.len(), expected.len());
            let both = found.iter().zip(expected);
            assert!(both.clone().all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
        };
        near(cut_in_gap(vec![0.1, 6.2, 0.2, 6.1], TAU), &[0.1, 6.2 - TAU, 0.2, 6.1 - TAU]);
        near(cut_in_gap(vec![1.0, 2.0, 3.0], TAU), &[1.0, 2.0, 3.0]);
        near(cut_in_gap(vec![10.0, 350.0, 355.0], 360.0), &[10.0, -10.0, -5.0]);
        near(cut_in_gap(vec![3.0], TAU), &[3.0]);
        near(cut_in_gap(Vec::new(), TAU), &[]);
    }
}
