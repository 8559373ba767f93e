//! Motions along ramps over a diagram of the parameter that changes: a point for each cycle, and where they jump.

use plotters::style::RGBColor;

use super::canvas::{Canvas, Dash, Stroke};
use super::cloud::{self, Dot};
use super::header::{Entry, Mark};
use super::kind::Names;
use super::panel::Panel;
use super::style::{GREEN, PURPLE, QUASI_PERIODIC, REFERENCE_WIDTH};
use super::text::Text;
use super::track::{Rows, where_held};
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{JUMP_POINT, Place, RAMP, RAMP_INDEX, RAMP_NAMES};

/// The colours of ramps, in their order.
const COLOURS: [RGBColor; 3] = [GREEN, PURPLE, QUASI_PERIODIC];

/// The ramps that a diagram shows.
#[derive(Default)]
pub struct RampPoints {
    /// In the order of the study.
    pub ramps: Vec<Shown>,
}

/// A ramp, in the units of the figure.
pub struct Shown {
    /// Its name in the study.
    pub name: String,
    /// The colour of its points.
    pub colour: RGBColor,
    /// Its points, by panel.
    pub panels: Vec<Vec<(f64, f64)>>,
    /// The values of the parameter at which it jumps.
    pub jumps: Vec<f64>,
}

/// What is read of the ramps that are shown as their `outputs`.
pub fn reads(outputs: &[String], model: &'static Description) -> Names {
    let parameters = Place::Ramp.parameters(model).chain(Place::RampFirst.parameters(model));
    let outputs = outputs.iter().map(|output| Place::Ramp.name(output));
    Names::of([RAMP, JUMP_POINT]).and(parameters).and_named(outputs)
}

impl RampPoints {
    /// The ramps along `x` that lie where `view` holds the other axes, as each of the `outputs`.
    pub fn over(view: &View<'_>, x: &str, outputs: &[String]) -> RampPoints {
        let along = Rows::new(view.dataset, &Place::Ramp.name(x));
        if along.count() == 0 || !view.drawing.branches {
            return RampPoints::default();
        }
        let numbers = Rows::new(view.dataset, RAMP.name);
        let jumps = Rows::new(view.dataset, JUMP_POINT.name);
        let names = view.dataset.texts.get(RAMP_NAMES).map_or("", String::as_str);
        let fits = where_held(view, RAMP_INDEX, Place::RampFirst, &[x]);
        let factor = view.quantity(x).factor;
        let mut ramps = Vec::new();
        for (number, name) in names.lines().enumerate() {
            let points = numbers.places(number);
            let is_along = points.first().is_some_and(|place| along.one(*place).is_finite());
            if !is_along || !fits.get(number).copied().unwrap_or(false) {
                continue;
            }
            let panels = outputs.iter().map(|output| {
                let values = Rows::new(view.dataset, &Place::Ramp.name(output));
                let own = view.quantity(output).factor;
                let all = points.iter().map(|it| (along.one(*it) * factor, values.one(*it) * own));
                all.filter(|(_, y)| y.is_finite()).collect()
            });
            let at_jumps = (0..jumps.count()).map(|jump| jumps.one(jump) as usize);
            let own = at_jumps.filter(|point| points.contains(point));
            ramps.push(Shown {
                name: name.to_owned(),
                colour: COLOURS[ramps.len() % COLOURS.len()],
                panels: panels.collect(),
                jumps: own.map(|point| along.one(point) * factor).collect(),
            });
        }
        RampPoints { ramps }
    }

    /// All abscissae.
    pub fn abscissae(&self) -> impl Iterator<Item = f64> {
        self.ramps.iter().flat_map(|ramp| ramp.panels.iter().flatten()).map(|at| at.0)
    }

    /// The ordinates on a panel.
    pub fn ordinates(&self, panel: usize) -> impl Iterator<Item = f64> {
        self.ramps.iter().filter_map(move |ramp| ramp.panels.get(panel)).flatten().map(|at| at.1)
    }

    /// What the points are.
    pub fn legend(&self) -> Vec<Entry> {
        let mut legend = Vec::new();
        for ramp in self.ramps.iter().filter(|it| it.panels.iter().any(|points| !points.is_empty()))
        {
            legend.push((Mark::Disc(ramp.colour, 1.3), Text::plain(&ramp.name)));
        }
        if let Some(ramp) = self.ramps.iter().find(|it| !it.jumps.is_empty()) {
            legend.push((Mark::Line(ramp.jump_stroke()), Text::plain("jump")));
        }
        legend
    }

    /// Draws the points of a panel.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel, index: usize, view: &View<'_>) {
        let on_panel = self.ramps.iter().filter_map(|ramp| Some((ramp, ramp.panels.get(index)?)));
        let clouds: Vec<(&Shown, Vec<Dot>)> = on_panel
            .map(|(ramp, points)| {
                let crowding = points.len() as f64;
                let dot = |at: &(f64, f64)| Dot { at: *at, colour: ramp.colour, crowding, case: 0 };
                (ramp, points.iter().map(dot).collect())
            })
            .collect();
        for (ramp, dots) in &clouds {
            let inside = dots.iter().filter(|dot| panel.holds(dot.at.0, dot.at.1)).count();
            cloud::draw(canvas, panel, dots, cloud::radius(view.drawing, inside));
            panel.record(canvas, &ramp.name, dots.iter().map(|dot| dot.at));
            if !dots.is_empty() {
                let [low, high] = [panel.y.scale.low, panel.y.scale.high];
                for jump in ramp.jumps.iter().filter(|at| panel.x.scale.holds(**at)) {
                    panel.curve(canvas, &[(*jump, low), (*jump, high)], ramp.jump_stroke());
                    panel.record(canvas, &format!("{}: jump", ramp.name), [(*jump, low)]);
                }
            }
        }
    }
}

impl Shown {
    /// The line at a jump.
    fn jump_stroke(&self) -> Stroke {
        Stroke { colour: self.colour, width: REFERENCE_WIDTH, dash: Dash::Short }
    }
}
