//! Progression speed against the energy that a cycle takes, and the best of both.

use std::iter::repeat;

use super::axis::AxisRequest;
use super::canvas::{Drawn, Stroke};
use super::cloud::{self, Dot};
use super::colour::Colours;
use super::error::FigureError;
use super::header::{Entry, Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::outcome::{self, Outcomes};
use super::page::{PageRequest, PanelRequest};
use super::panel::Pointing;
use super::style::{BLUE, CURVE_WIDTH, FAINT_INK, INK, ONE_COLUMN, VERMILION};
use super::text::Text;
use super::view::View;
use crate::capsule::Output;
use crate::store::catalogue::{self, DRAW};
use crate::study::Drawing;
use crate::tradeoff::{front, speed_at_rest};

/// The energy shown, unless another is asked for.
const ENERGY: catalogue::Entry = catalogue::Entry::of_output(Output::WorkPositive);
/// The speed shown.
const SPEED: catalogue::Entry = catalogue::Entry::of_output(Output::ProgressionSpeed);
/// Radius of the ring around the fastest case [pt].
const BEST_RADIUS: f64 = 3.0;
/// Height of the frame [pt].
const HEIGHT: f64 = 158.0;

/// A case with both outputs, and its place among the cases.
struct Case {
    energy: f64,
    speed: f64,
    place: usize,
    is_periodic: bool,
}

/// The cases of a figure.
struct Cases {
    /// Those with both outputs.
    shown: Vec<Case>,
    /// How many have none.
    left_out: usize,
    /// The speed up to which a case is at rest.
    rest: f64,
}

/// A direction of motion.
#[derive(Clone, Copy)]
struct Direction {
    name: &'static str,
    sign: f64,
}

/// The directions, each with a front and a fastest case of its own.
const DIRECTIONS: [Direction; 2] =
    [Direction { name: "forward", sign: 1.0 }, Direction { name: "backward", sign: -1.0 }];

impl Cases {
    /// The periodic cases that move in a direction.
    fn moving(&self, direction: Direction) -> impl Iterator<Item = &Case> {
        let moves = move |case: &&Case| case.is_periodic && direction.sign * case.speed > self.rest;
        self.shown.iter().filter(moves)
    }

    /// The fastest case in a direction.
    fn fastest(&self, direction: Direction) -> Option<&Case> {
        let speed = |case: &&Case| direction.sign * case.speed;
        self.moving(direction).max_by(|a, b| speed(a).total_cmp(&speed(b)))
    }

    /// The Pareto front of a direction, as energies and speeds.
    fn front(&self, direction: Direction) -> Vec<(f64, f64)> {
        let (energies, speeds): (Vec<f64>, Vec<f64>) =
            self.moving(direction).map(|case| (case.energy, direction.sign * case.speed)).unzip();
        let front = front(&energies, &speeds).into_iter();
        front.map(|case| (energies[case], direction.sign * speeds[case])).collect()
    }

    /// How many are shown that are not periodic.
    fn aperiodic(&self) -> usize {
        self.shown.iter().filter(|case| !case.is_periodic).count()
    }
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
    let colours = hue.as_ref().map(|(colours, _)| colours);
    let page = request(view, &cases, &energy, colours, &free);
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        panel.mark_zero(&mut canvas);
        let crowding = cases.shown.len() as f64;
        let dot = |case: &Case| {
            let colour = hue.as_ref().map_or(BLUE, |(colours, of)| colours.of(of[case.place]));
            let colour = if case.is_periodic { colour } else { FAINT_INK };
            Dot { at: (case.energy, case.speed), colour, crowding }
        };
        let (periodic, others): (Vec<&Case>, Vec<&Case>) =
            cases.shown.iter().partition(|case| case.is_periodic);
        let dots: Vec<_> = others.into_iter().chain(periodic).map(dot).collect();
        cloud::draw(&mut canvas, panel, &dots, 1.4 * cloud::radius(dots.len()));
        for direction in DIRECTIONS {
            let line = stairs(&cases.front(direction));
            if line.len() > 1 {
                panel.curve(&mut canvas, &line, Stroke::solid(VERMILION, CURVE_WIDTH));
            }
            if let Some(case) = cases.fastest(direction) {
                let place = panel.place(case.energy, case.speed);
                canvas.rings(&[place], BEST_RADIUS, Stroke::solid(INK, CURVE_WIDTH));
            }
        }
        if let Some((colours, _)) = &hue {
            colours.draw_bar(&mut canvas, panel.frame);
        }
        panel.finish(&mut canvas);
    }
    Ok(canvas.finish(&about(view, &cases, energy, &free)))
}

/// What the figure shows and leaves out, in a sentence kept inside its files.
fn about(view: &View<'_>, cases: &Cases, energy: String, free: &[&str]) -> String {
    let shows = view.about(&[SPEED.name.to_owned(), energy], free);
    let rest = cases.rest / view.quantity(SPEED.name).factor;
    format!(
        "{shows}; {} periodic cases, {} others as means over their cycles, {} without values; the fronts are of \
         periodic cases that move faster than {rest:e} m/s",
        cases.shown.len() - cases.aperiodic(),
        cases.aperiodic(),
        cases.left_out
    )
}

/// The cases with finite outputs.
fn cases(view: &View<'_>, energy: &str, free: &[&str]) -> Result<Cases, FigureError> {
    if !Output::ALL.iter().any(|output| output.name() == energy) {
        return Err(view.unfit(format!("`{energy}` is no output of a motion")));
    }
    let (energies, speeds) = (view.shown(energy, free)?, view.shown(SPEED.name, free)?);
    if energies.len() != speeds.len() {
        return Err(view.unfit(format!("`{energy}` does not have one value per case")));
    }
    let outcomes = Outcomes::over(view, free)?;
    let case = |(place, (energy, speed)): (usize, (&f64, &f64))| Case {
        energy: *energy,
        speed: *speed,
        place,
        is_periodic: outcomes.periodic(place),
    };
    let all = energies.iter().zip(&speeds).enumerate().map(case);
    let (shown, left_out): (Vec<Case>, Vec<Case>) =
        all.partition(|case| case.energy.is_finite() && case.speed.is_finite());
    let factor = view.quantity(SPEED.name).factor;
    let rest = factor * speed_at_rest(shown.iter().map(|case| case.speed / factor));
    Ok(Cases { shown, left_out: left_out.len(), rest })
}

/// So many axes of the fastest case stand in one entry of the legend; the others follow in entries of their
/// own.
const AXES_TOGETHER: usize = 2;

/// Where the fastest case in a direction stands along the axes, in parts of a legend's width.
fn fastest(view: &View<'_>, case: &Case, direction: Direction, free: &[&str]) -> Vec<Text> {
    let long: Vec<&&str> =
        free.iter().filter(|name| view.coordinate_values(name).len() > 1).collect();
    let mut parts = Vec::new();
    for (i, name) in long.iter().enumerate() {
        let place = view.place_along(name, free, case.place);
        let joint = if i + 1 < long.len() { ", " } else { "" };
        let note = view.value_note(name, place).then(Text::plain(joint));
        match parts.last_mut() {
            Some(part) if i % AXES_TOGETHER > 0 => *part = Text::then(std::mem::take(part), note),
            Some(_) => parts.push(note),
            None => {
                let begins = Text::plain(&format!("fastest {}: ", direction.name));
                parts.push(begins.then(note));
            }
        }
    }
    parts
}

/// What the marks mean, and how many cases are shown otherwise or not at all.
fn legend(view: &View<'_>, cases: &Cases, free: &[&str]) -> Vec<Entry> {
    let mut legend = Vec::new();
    if DIRECTIONS.iter().any(|direction| cases.front(*direction).len() > 1) {
        let line = Mark::Line(Stroke::solid(VERMILION, CURVE_WIDTH));
        let periodic = if cases.aperiodic() > 0 { " of periodic cases" } else { "" };
        legend.push((line, Text::plain(&format!("Pareto front{periodic}"))));
    }
    for direction in DIRECTIONS {
        let parts = cases.fastest(direction).map(|case| fastest(view, case, direction, free));
        let marks = [Mark::Ring(INK, BEST_RADIUS)].into_iter().chain(repeat(Mark::Nothing));
        legend.extend(marks.zip(parts.into_iter().flatten()));
    }
    let aperiodic = cases.aperiodic();
    if aperiodic > 0 {
        let said = Text::plain(&format!("not periodic, by their means: {aperiodic}"));
        legend.push((Mark::Disc(FAINT_INK, 1.4), said));
    }
    if cases.left_out > 0 {
        let said = Text::plain(&format!("without values, left out: {}", cases.left_out));
        legend.push((Mark::Nothing, said));
    }
    legend
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
    cases: &Cases,
    energy: &str,
    colours: Option<&Colours>,
    free: &[&str],
) -> PageRequest {
    let energies: Vec<f64> = cases.shown.iter().map(|case| case.energy).collect();
    let speeds: Vec<f64> = cases.shown.iter().map(|case| case.speed).collect();
    let legend = if cases.shown.len() > 1 { legend(view, cases, free) } else { Vec::new() };
    let y = AxisRequest::around(view.quantity(SPEED.name), &speeds, 0.06);
    let panel = PanelRequest {
        x: AxisRequest::around(view.quantity(energy), &energies, 0.04),
        y,
        header: Header { legend, note: view.held_note(free), ..Header::default() },
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
