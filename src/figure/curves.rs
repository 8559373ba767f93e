//! Curves of special points in two parameters, with the special points that they go through.

use super::axis::AxisRequest;
use super::branch_lines::{draw_symbols, faded};
use super::canvas::{Canvas, Drawn, Stroke};
use super::error::FigureError;
use super::header::{self, Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::page::{PageRequest, PanelRequest};
use super::panel::{Panel, Pointing};
use super::style::CURVE_WIDTH;
use super::symbol::{SYMBOLS, Symbol};
use super::text::Text;
use super::track::{Rows, elsewhere, in_view};
use super::varied::{along, varied};
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{
    CURVE, CURVE_KIND, CURVE_PERIOD, CURVE_THROUGH, DIRECTION, Entry, INDEX_REQUEST, Place,
    SPECIAL_BRANCH, SPECIAL_CURVE,
};
use crate::study::Drawing;

/// Height of the frame [pt].
const HEIGHT: f64 = 165.0;

/// A curve in the units of the figure.
pub struct Curve {
    /// What happens on it.
    pub symbol: Symbol,
    /// Period of the orbits on it.
    pub period: u64,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// The special points that it goes through.
    specials: Vec<(f64, f64)>,
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Branches, reads, draw };

/// What is read of the curves, and of the special points that they go through.
pub fn reads(_: &Drawing, model: &'static Description) -> Names {
    let places = [Place::Request, Place::Special, Place::Curve];
    Names::of([CURVE, CURVE_KIND, CURVE_PERIOD, CURVE_THROUGH])
        .and([SPECIAL_BRANCH, SPECIAL_CURVE, INDEX_REQUEST])
        .and(places.into_iter().flat_map(|place| place.parameters(model)))
}

/// Draws the curves that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let axes = axes(view)?;
    let mut curves = curves(view, &axes);
    if !view.shows("special-points") {
        curves.iter_mut().for_each(|curve| curve.specials.clear());
    }
    let range = |of: fn(&(f64, f64)) -> f64| {
        let places = curves.iter().flat_map(|curve| curve.points.iter().chain(&curve.specials));
        places.map(of).collect::<Vec<f64>>()
    };
    let axis =
        |name: &str, values: Vec<f64>| AxisRequest::around(view.quantity(name), &values, 0.03);
    // Branches have no direction in which they were swept.
    let drawn = [axes[0].as_str(), axes[1].as_str()];
    let left_out = elsewhere(view, &drawn);
    let note = view.note(&[drawn[0], drawn[1], DIRECTION.name], &left_out);
    let panel = PanelRequest {
        x: axis(&axes[0], range(|place| place.0)),
        y: axis(&axes[1], range(|place| place.1)),
        header: Header { letter: None, note, legend: legend(&curves) },
    };
    let page = PageRequest::of_one(view.drawing, panel, HEIGHT, Pointing::Inward);
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        draw_curves(&mut canvas, panel, &curves);
        panel.finish(&mut canvas);
    }
    let names = SYMBOLS.map(|symbol| symbol.name.to_owned());
    Ok(canvas.finish(&view.about(&names, &drawn)).noting(left_out))
}

/// The parameters along the abscissa and the ordinate.
fn axes(view: &View<'_>) -> Result<[String; 2], FigureError> {
    let varied = varied(view.dataset);
    let known = |name: &&String| varied.contains(&name.as_str());
    let first = || along(view.dataset).first().map(|name| name.to_string());
    let x = view.drawing.x.as_ref().filter(known).cloned().or_else(first);
    let other = || varied.iter().find(|name| x.as_deref() != Some(**name));
    let y = view.drawing.y.as_ref().filter(known).cloned();
    let y = y.or_else(|| other().map(|name| name.to_string()));
    match (x, y) {
        (Some(x), Some(y)) if x != y => Ok([x, y]),
        _ => Err(view.unfit(
            "the results hold no curves in two parameters: give a branch of the study a `second` \
             parameter and run `capsulemap continue`",
        )),
    }
}

/// The curves over the two parameters `axes` that lie where `view` holds the others.
pub fn curves(view: &View<'_>, axes: &[String; 2]) -> Vec<Curve> {
    let dataset = view.dataset;
    let rows = |entry: Entry| Rows::new(dataset, entry.name);
    let at = |place: Place, name: &str| Rows::new(dataset, &place.name(name));
    let fits = in_view(view, &[&axes[0], &axes[1]]);
    let (number, through) = (rows(CURVE), rows(CURVE_THROUGH));
    let (branch, request) = (rows(SPECIAL_BRANCH), rows(INDEX_REQUEST));
    let (kind, period) = (rows(CURVE_KIND), rows(CURVE_PERIOD));
    let values = [0, 1].map(|i| (at(Place::Curve, &axes[i]), view.quantity(&axes[i])));
    let at_special =
        [0, 1].map(|i| [Place::Special, Place::Request].map(|place| at(place, &axes[i])));
    let on_curve = rows(SPECIAL_CURVE);
    let flags = dataset.variable(CURVE_KIND.name).map_or(&[][..], |variable| &variable.flags);
    let curve = |places: Vec<usize>| {
        let first = *places.first()?;
        let asked = request.one(branch.one(through.one(first) as usize) as usize) as usize;
        let name = flags.iter().find(|(code, _)| *code as f64 == kind.one(first));
        let place = |at: usize| {
            let [x, y] = [0, 1].map(|i| values[i].0.one(at) * values[i].1.factor);
            (x, y)
        };
        let points: Vec<_> = places.into_iter().map(place).collect();
        let within = fits.get(asked).copied().unwrap_or(false);
        let drawn = within && points.iter().all(|(x, y)| x.is_finite() && y.is_finite());
        // What does not vary at the special point has the value of the request.
        let special = |special: usize| {
            let [x, y] = [0, 1].map(|i| {
                let [own, given] = [at_special[i][0].one(special), at_special[i][1].one(asked)];
                (if own.is_finite() { own } else { given }) * values[i].1.factor
            });
            (x, y)
        };
        let specials = on_curve.places(number.one(first) as usize).into_iter().map(special);
        let symbol = Symbol::named(&name?.1)?;
        let period = period.one(first) as u64;
        drawn.then(|| Curve { symbol, period, points, specials: specials.collect() })
    };
    let all = (0..).map(|it| number.places(it)).take_while(|places| !places.is_empty());
    all.filter_map(curve).collect()
}

impl Curve {
    /// How the curve is drawn: the longer its period among `periods`, the fainter.
    fn stroke(&self, periods: &[u64]) -> Stroke {
        let rank = periods.iter().position(|&period| period == self.period).unwrap_or(0);
        let colour = (0..rank.min(2)).fold(self.symbol.colour, |colour, _| faded(colour));
        Stroke { colour, width: 1.2 * CURVE_WIDTH, dash: self.symbol.dash }
    }
}

/// The periods that occur, the shortest first.
fn periods(curves: &[Curve]) -> Vec<u64> {
    let mut periods: Vec<u64> = curves.iter().map(|curve| curve.period).collect();
    periods.sort_unstable();
    periods.dedup();
    periods
}

/// What the curves are.
pub fn legend(curves: &[Curve]) -> Vec<header::Entry> {
    let periods = periods(curves);
    let mut legend = Vec::new();
    for symbol in SYMBOLS.into_iter().rev() {
        for &period in &periods {
            let is_ours = |curve: &&Curve| curve.symbol == symbol && curve.period == period;
            let Some(curve) = curves.iter().find(is_ours) else { continue };
            let words = match periods.len() {
                1 => symbol.words.to_owned(),
                _ => format!("{}, period {period}", symbol.words),
            };
            legend.push((Mark::Line(curve.stroke(&periods)), Text::plain(&words)));
        }
    }
    legend
}

/// Draws the curves, and the special points of branches on them.
pub fn draw_curves(canvas: &mut Canvas, panel: &Panel, curves: &[Curve]) {
    let periods = periods(curves);
    // The dashed go over the solid, so that both show where they run together.
    for symbol in SYMBOLS.into_iter().rev() {
        for curve in curves.iter().filter(|curve| curve.symbol == symbol) {
            panel.curve(canvas, &curve.points, curve.stroke(&periods));
            let series = format!("{}, period {}", symbol.words, curve.period);
            panel.record(canvas, &series, curve.points.iter().copied());
        }
    }
    for curve in curves {
        draw_symbols(canvas, panel, curve.symbol, curve.specials.iter().copied());
    }
}
