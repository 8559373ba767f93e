//! Progression speed against the energy that a cycle takes, and the best of both.

use std::iter::repeat;

use super::axis::AxisRequest;
use super::canvas::{Drawn, Stroke};
use super::cloud::{self, Dot};
use super::colour::Colours;
use super::error::FigureError;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::outcome::{self, Outcomes};
use super::page::{PageRequest, PanelRequest};
use super::panel::Pointing;
use super::scale::Scale;
use super::style::{BLUE, CURVE_WIDTH, INK, ONE_COLUMN, VERMILION};
use super::text::Text;
use super::view::View;
use crate::capsule::Output;
use crate::store::catalogue::{DRAW, Entry};
use crate::study::Drawing;
use crate::tradeoff::front;

/// The energy shown, unless another is asked for.
const ENERGY: Entry = Entry::of_output(Output::WorkPositive);
/// The speed shown.
const SPEED: Entry = Entry::of_output(Output::ProgressionSpeed);
/// Radius of the ring around the fastest case [pt].
const BEST_RADIUS: f64 = 3.0;
/// Height of the frame [pt].
const HEIGHT: f64 = 158.0;

/// A case with both outputs, and its place among the cases.
struct Case {
    energy: f64,
    speed: f64,
    place: usize,
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What a trade-off reads: both quantities and the outcomes.
fn reads(drawing: &Drawing) -> Names {
    let energy = drawing.of.first().map_or(ENERGY.name, String::as_str);
    Names::of(outcome::READS).and([SPEED]).and_named([energy.to_owned()])
}

/// Draws the trade-off that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let energy = view.drawing.of.first().cloned().unwrap_or_else(|| ENERGY.name.to_owned());
    let free = view.free_axes();
    let cases = cases(view, &energy, &free)?;
    let hue = hue(view, &free)?;
    let fastest = fastest(view, &cases, &free);
    let colours = hue.as_ref().map(|(colours, _)| colours);
    let page = request(view, &cases, &energy, colours, fastest.as_ref());
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        panel.mark_zero(&mut canvas);
        let dot = |case: &Case| {
            let colour = hue.as_ref().map_or(BLUE, |(colours, of)| colours.of(of[case.place]));
            Dot { at: (case.energy, case.speed), colour, crowding: cases.len() as f64 }
        };
        let dots: Vec<_> = cases.iter().map(dot).collect();
        let radius = 1.4 * cloud::radius(dots.len());
        cloud::draw(&mut canvas, panel, &dots, radius);
        if cases.len() > 1 {
            let line = stairs(&best(&cases));
            panel.curve(&mut canvas, &line, Stroke::solid(VERMILION, CURVE_WIDTH));
        }
        if let Some((at, _)) = &fastest {
            let place = panel.place(cases[*at].energy, cases[*at].speed);
            canvas.rings(&[place], BEST_RADIUS, Stroke::solid(INK, CURVE_WIDTH));
        }
        if let Some((colours, _)) = &hue {
            colours.draw_bar(&mut canvas, panel.frame);
        }
        panel.finish(&mut canvas);
    }
    Ok(canvas.finish(&view.about(&[SPEED.name.to_owned(), energy], &free)))
}

/// The periodic cases with finite outputs.
fn cases(view: &View<'_>, energy: &str, free: &[&str]) -> Result<Vec<Case>, FigureError> {
    let (energies, speeds) = (view.shown(energy, free)?, view.shown(SPEED.name, free)?);
    if energies.len() != speeds.len() {
        return Err(view.unfit(format!("`{energy}` does not have one value per case")));
    }
    let outcomes = Outcomes::over(view, free)?;
    let case = |(place, (energy, speed)): (usize, (&f64, &f64))| Case {
        energy: *energy,
        speed: *speed,
        place,
    };
    let all = energies.iter().zip(&speeds).enumerate().map(case);
    let kept = |case: &Case| {
        case.energy.is_finite() && case.speed.is_finite() && outcomes.periodic(case.place)
    };
    Ok(all.filter(kept).collect())
}

/// So many axes of the fastest case stand in one entry of the legend; the others follow in entries of their
/// own.
const AXES_TOGETHER: usize = 2;

/// The case with the greatest speed, and where it stands along the axes, in parts of a legend's width.
fn fastest(view: &View<'_>, cases: &[Case], free: &[&str]) -> Option<(usize, Vec<Text>)> {
    let faster = |a: &usize, b: &usize| cases[*a].speed.total_cmp(&cases[*b].speed);
    let at = (0..cases.len()).max_by(faster).filter(|_| cases.len() > 1)?;
    let long: Vec<&&str> =
        free.iter().filter(|name| view.coordinate_values(name).len() > 1).collect();
    let mut parts = Vec::new();
    for (i, name) in long.iter().enumerate() {
        let place = view.place_along(name, free, cases[at].place);
        let joint = if i + 1 < long.len() { ", " } else { "" };
        let words = view.value_note(name, place).then(Text::plain(joint));
        match parts.last_mut() {
            Some(part) if i % AXES_TOGETHER > 0 => *part = Text::then(std::mem::take(part), words),
            Some(_) => parts.push(words),
            None => parts.push(Text::plain("fastest forward: ").then(words)),
        }
    }
    Some((at, parts))
}

/// The colours of an axis, and the axis' value for each case.
fn hue(view: &View<'_>, free: &[&str]) -> Result<Option<(Colours, Vec<f64>)>, FigureError> {
    let wanted = view.drawing.x.as_deref();
    let long = |name: &&&str| **name != DRAW.name && view.coordinate_values(name).len() > 1;
    let Some(name) = wanted.or_else(|| free.iter().find(long).copied()) else {
        return Ok(None);
    };
    let quantity = view.quantity(name);
    let factor = quantity.factor;
    let values: Vec<f64> = view.axis_values(name)?.iter().map(|value| value * factor).collect();
    let of_case = view.parameter(name, free)?.iter().map(|value| value * factor).collect();
    Ok(Some((Colours::for_axis(&values, quantity), of_case)))
}

fn request(
    view: &View<'_>,
    cases: &[Case],
    energy: &str,
    colours: Option<&Colours>,
    fastest: Option<&(usize, Vec<Text>)>,
) -> PageRequest {
    let energies: Vec<f64> = cases.iter().map(|case| case.energy).collect();
    let speeds: Vec<f64> = cases.iter().map(|case| case.speed).collect();
    let legend = match cases.len() {
        0 | 1 => Vec::new(),
        _ => {
            let line = Mark::Line(Stroke::solid(VERMILION, CURVE_WIDTH));
            let mut legend = vec![(line, Text::plain("Pareto front"))];
            let parts = fastest.into_iter().flat_map(|(_, parts)| parts.iter().cloned());
            let marks = [Mark::Ring(INK, BEST_RADIUS)].into_iter().chain(repeat(Mark::Nothing));
            legend.extend(marks.zip(parts));
            legend
        }
    };
    // Speeds differ in sign and stay linear, so that standing still keeps its place.
    let y = AxisRequest {
        scale: Scale::around(speeds.iter().copied(), 0.06),
        ..AxisRequest::around(view.quantity(SPEED.name), &speeds, 0.06)
    };
    let panel = PanelRequest {
        x: AxisRequest::around(view.quantity(energy), &energies, 0.04),
        y,
        header: Header { legend, ..Header::default() },
    };
    PageRequest {
        title: view.drawing.title.clone(),
        width_mm: view.drawing.width_mm.unwrap_or(ONE_COLUMN),
        heights: vec![HEIGHT],
        rows: vec![vec![panel]],
        right_room: colours.map_or(0.0, |colours| colours.room(HEIGHT)),
        pointing: Pointing::Inward,
    }
}

/// The Pareto front of the cases, as energies and speeds.
fn best(cases: &[Case]) -> Vec<(f64, f64)> {
    let (energies, speeds): (Vec<f64>, Vec<f64>) =
        cases.iter().map(|case| (case.energy, case.speed)).unzip();
    front(&energies, &speeds).into_iter().map(|case| (energies[case], speeds[case])).collect()
}

/// The front as stairs: up to the next case, the last one stays the best.
fn stairs(front: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut line = Vec::new();
    for (at, (energy, speed)) in front.iter().enumerate() {
        if at > 0 {
            line.push((*energy, front[at - 1].1));
        }
        line.push((*energy, *speed));
    }
    line
}
