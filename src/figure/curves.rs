//! Curves of special points in two parameters, with the special points that they go through.

use std::collections::BTreeSet;

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn, Stroke};
use super::codim2_symbol::{CODIM2_SYMBOLS, Codim2Symbol};
use super::error::FigureError;
use super::header::{self, Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::page::{PageRequest, PanelRequest};
use super::panel::{Panel, Pointing};
use super::style::{CURVE_WIDTH, PAPER};
use super::symbol::{SYMBOLS, Symbol};
use super::text::Text;
use super::thinned::{Placed, Special, Thinned, with_told};
use super::track::{Rows, elsewhere, in_view};
use super::varied::{along, varied};
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{
    CODIM2_CURVE, CODIM2_KIND, CURVE, CURVE_KIND, CURVE_PERIOD, CURVE_THROUGH, DIRECTION, Entry,
    INDEX_REQUEST, Place, SPECIAL_BRANCH, SPECIAL_CURVE,
};
use crate::store::dataset::Dataset;
use crate::study::Drawing;

/// Height of the frame [pt].
const HEIGHT: f64 = 165.0;

/// Widths of curves relative to the usual one, from the shortest period on.
const WIDTHS: [f64; 3] = [1.3, 0.8, 0.5];
/// Width of the rim of paper on both sides of a curve over colours [pt].
const RIM: f64 = 0.9;

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
    /// Its points of codimension 2.
    pub codim2: Vec<(Codim2Symbol, (f64, f64))>,
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Branches, reads, draw };

/// What is read of the curves, and of the special points that they go through.
pub fn reads(_: &Drawing, model: &'static Description) -> Names {
    let places = [Place::Request, Place::Special, Place::Curve, Place::Codim2];
    Names::of([CURVE, CURVE_KIND, CURVE_PERIOD, CURVE_THROUGH])
        .and([SPECIAL_BRANCH, SPECIAL_CURVE, INDEX_REQUEST, CODIM2_CURVE, CODIM2_KIND])
        .and(places.into_iter().flat_map(|place| place.parameters(model)))
}

/// Draws the curves that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let axes = axes(view)?;
    let mut curves = curves(view, &axes);
    if !view.shows("special-points") {
        for curve in &mut curves {
            curve.specials.clear();
            curve.codim2.clear();
        }
    }
    // Branches have no direction in which they were swept.
    let drawn = [axes[0].as_str(), axes[1].as_str()];
    let left_out = elsewhere(view, &drawn);
    let note = view.note(&[drawn[0], drawn[1], DIRECTION.name], &left_out);
    // Which symbols would overlap is known once the panel has its place.
    let header = Header { letter: None, note, legend: legend(&curves) };
    let panel = panel(view, &axes, &curves, header);
    let (_, panels) = page(view, panel.clone()).lay_out();
    let each = panels.iter().flatten().map(|panel| Thinned::of(panel, specials(&curves)));
    let thinned: Vec<Thinned> = each.collect();
    let legend = with_told(panel.header.legend, &thinned);
    let panel = PanelRequest { header: Header { legend, ..panel.header }, ..panel };
    let (mut canvas, panels) = page(view, panel).lay_out();
    for (panel, thinned) in panels.iter().flatten().zip(&thinned) {
        draw_curves(&mut canvas, panel, &curves, Ground::Paper);
        thinned.draw(&mut canvas, panel);
        panel.finish(&mut canvas);
    }
    let names = met(&curves).map(|symbol| symbol.name);
    let names = names.chain(SYMBOLS.map(|symbol| symbol.name)).map(str::to_owned);
    let names: Vec<String> = names.collect();
    Ok(canvas.finish(&view.about(&names, &drawn)).noting(left_out))
}

/// The panel of curves over two parameters. To ask for an axis counts what has no place on it, so that this is done once.
fn panel(view: &View<'_>, axes: &[String; 2], curves: &[Curve], header: Header) -> PanelRequest {
    let places = curves.iter().flat_map(|curve| curve.points.iter().chain(&curve.specials));
    let (x, y): (Vec<f64>, Vec<f64>) = places.copied().unzip();
    PanelRequest {
        x: AxisRequest::around(view.quantity(&axes[0]), &x, 0.03),
        y: AxisRequest::around(view.quantity(&axes[1]), &y, 0.03),
        header,
    }
}

/// The page of a panel.
fn page<'d>(view: &View<'d>, panel: PanelRequest) -> PageRequest<'d> {
    PageRequest::of_one(view.drawing, panel, HEIGHT, Pointing::Inward)
}

/// The parameters along the abscissa and the ordinate.
fn axes(view: &View<'_>) -> Result<[String; 2], FigureError> {
    let varied = varied(view.dataset);
    let [x, y] = [&view.drawing.x, &view.drawing.y]
        .map(|asked| asked.as_deref().filter(|name| varied.contains(name)));
    let x = x.or_else(|| along(view.dataset).first().copied());
    let y = y.or_else(|| varied.iter().copied().find(|name| x != Some(*name)));
    match (x, y) {
        (Some(x), Some(y)) if x != y => Ok([x, y].map(str::to_owned)),
        _ => Err(view.unfit(
            "the results hold no curves in two parameters: give a branch of the study a `second` \
             parameter and run `capsulemap continue`",
        )),
    }
}

/// The curves over the two parameters `axes` that lie where `view` holds the others.
pub fn curves(view: &View<'_>, axes: &[String; 2]) -> Vec<Curve> {
    let columns = Columns::of(view, axes);
    let all = (0..).map(|it| columns.number.places(it)).take_while(|places| !places.is_empty());
    all.filter_map(|places| columns.curve(&places)).collect()
}

/// What a file has of the points of curves, and of the special points that they go through.
struct Columns<'a> {
    /// Whether each branch of the study lies where the view holds the other axes.
    fits: Vec<bool>,
    /// The number of the curve that a point is on.
    number: Rows,
    kind: Rows,
    /// The names of the kinds.
    kinds: &'a [(i64, String)],
    period: Rows,
    /// The special point that the curve goes through from which it was followed.
    through: Rows,
    /// The branch of a special point.
    branch: Rows,
    /// The place in the study of a branch.
    request: Rows,
    /// The curve that a special point is on.
    of_special: Rows,
    /// The kinds of points of codimension 2, and the curves that they are on.
    codim2_kind: Rows,
    codim2_kinds: &'a [(i64, String)],
    codim2_curve: Rows,
    /// The two parameters.
    axes: [AxisColumns; 2],
}

/// A parameter of curves, where they are and where the special points are.
struct AxisColumns {
    /// Value shown per value in SI.
    factor: f64,
    on_curve: Rows,
    at_special: Rows,
    at_codim2: Rows,
    /// What branches have that do not vary it.
    asked: Rows,
}

impl AxisColumns {
    fn of(view: &View<'_>, name: &str) -> AxisColumns {
        let places = [Place::Curve, Place::Special, Place::Codim2, Place::Request];
        let [on_curve, at_special, at_codim2, asked] =
            places.map(|place| Rows::new(view.dataset, &place.name(name)));
        let factor = view.quantity(name).factor;
        AxisColumns { factor, on_curve, at_special, at_codim2, asked }
    }

    /// The value at a point of a curve, in the unit shown.
    fn value(&self, point: usize) -> f64 {
        self.on_curve.one(point) * self.factor
    }

    /// The value at a special point, in the unit shown; where it does not vary there that of the branch which was asked for.
    fn special_value(&self, special: usize, asked: usize) -> f64 {
        let [own, given] = [self.at_special.one(special), self.asked.one(asked)];
        (if own.is_finite() { own } else { given }) * self.factor
    }
}

impl<'a> Columns<'a> {
    fn of(view: &View<'a>, axes: &[String; 2]) -> Columns<'a> {
        let entries = [CURVE, CURVE_KIND, CURVE_PERIOD, CURVE_THROUGH, SPECIAL_BRANCH];
        let [number, kind, period, through, branch] =
            entries.map(|entry| Rows::new(view.dataset, entry.name));
        let entries = [INDEX_REQUEST, SPECIAL_CURVE, CODIM2_KIND, CODIM2_CURVE];
        let [request, of_special, codim2_kind, codim2_curve] =
            entries.map(|entry| Rows::new(view.dataset, entry.name));
        Columns {
            fits: in_view(view, &[&axes[0], &axes[1]]),
            number,
            kind,
            kinds: flags(view.dataset, CURVE_KIND),
            period,
            through,
            branch,
            request,
            of_special,
            codim2_kind,
            codim2_kinds: flags(view.dataset, CODIM2_KIND),
            codim2_curve,
            axes: axes.each_ref().map(|name| AxisColumns::of(view, name)),
        }
    }

    /// The curve with these points; none where it is not shown.
    fn curve(&self, places: &[usize]) -> Option<Curve> {
        let first = *places.first()?;
        let branch = self.branch.one(self.through.one(first) as usize);
        let asked = self.request.one(branch as usize) as usize;
        let [x, y] = &self.axes;
        let points: Vec<_> = places.iter().map(|at| (x.value(*at), y.value(*at))).collect();
        let is_within = self.fits.get(asked).copied().unwrap_or(false);
        if !is_within || points.iter().any(|(x, y)| !x.is_finite() || !y.is_finite()) {
            return None;
        }
        let number = self.number.one(first) as usize;
        let specials = self.of_special.places(number).into_iter();
        Some(Curve {
            symbol: Symbol::named(named(self.kinds, self.kind.one(first))?)?,
            period: self.period.one(first) as u64,
            points,
            specials: specials
                .map(|it| (x.special_value(it, asked), y.special_value(it, asked)))
                .collect(),
            codim2: self.codim2(number),
        })
    }

    /// The points of codimension 2 on the curve of this number.
    fn codim2(&self, number: usize) -> Vec<(Codim2Symbol, (f64, f64))> {
        let places = self.codim2_curve.places(number).into_iter();
        let symbols = places.filter_map(|place| {
            let symbol =
                Codim2Symbol::named(named(self.codim2_kinds, self.codim2_kind.one(place))?)?;
            let [x, y] = self.axes.each_ref().map(|axis| axis.at_codim2.one(place) * axis.factor);
            Some((symbol, (x, y)))
        });
        symbols.collect()
    }
}

impl Curve {
    /// How the curve is drawn: the longer its period among `periods`, the thinner.
    fn stroke(&self, periods: &[u64]) -> Stroke {
        let rank = periods.iter().position(|&period| period == self.period).unwrap_or(0);
        let width = WIDTHS[rank.min(WIDTHS.len() - 1)];
        Stroke { colour: self.symbol.colour, width: width * CURVE_WIDTH, dash: self.symbol.dash }
    }
}

/// The names of the categories of a variable.
fn flags(dataset: &Dataset, entry: Entry) -> &[(i64, String)] {
    dataset.variable(entry.name).map_or(&[], |it| &it.flags)
}

/// The name of a category among all.
fn named(flags: &[(i64, String)], code: f64) -> Option<&str> {
    flags.iter().find(|(known, _)| *known as f64 == code).map(|(_, name)| name.as_str())
}

/// The periods that occur, the shortest first.
fn periods(curves: &[Curve]) -> Vec<u64> {
    let mut periods: Vec<u64> = curves.iter().map(|curve| curve.period).collect();
    periods.sort_unstable();
    periods.dedup();
    periods
}

/// What the curves are: an entry for each kind, with the periods of its orbits where there are several.
pub fn legend(curves: &[Curve]) -> Vec<header::Entry> {
    let all = periods(curves);
    let mut legend = Vec::new();
    for symbol in SYMBOLS.into_iter().rev() {
        let ours: Vec<&Curve> = curves.iter().filter(|it| it.symbol == symbol).collect();
        let own: BTreeSet<u64> = ours.iter().map(|it| it.period).collect();
        let Some(first) = ours.iter().min_by_key(|it| it.period) else { continue };
        let words = match all.len() {
            1 => symbol.words.to_owned(),
            _ => format!("{}, {}", symbol.words, counted(&own)),
        };
        legend.push((Mark::Line(first.stroke(&all)), Text::plain(&words)));
    }
    if all.len() > 1 {
        legend.push((Mark::Nothing, Text::plain("the longer the period, the thinner")));
    }
    let begun = SYMBOLS
        .into_iter()
        .rev()
        .filter(|symbol| curves.iter().any(|it| it.symbol == *symbol && !it.specials.is_empty()));
    let begun: Vec<Symbol> = begun.collect();
    let symbols = begun.iter().map(|it| (Mark::Symbol(*it), Text::plain(it.words)));
    legend.extend(symbols);
    if !begun.is_empty() {
        legend.push((Mark::Nothing, Text::plain("(points from which curves are followed)")));
    }
    legend.extend(met(curves).map(|it| (Mark::Codim2(it), Text::plain(it.words))));
    legend
}

/// Periods in words.
fn counted(periods: &BTreeSet<u64>) -> String {
    let each: Vec<String> = periods.iter().map(u64::to_string).collect();
    match each.as_slice() {
        [one] => format!("period {one}"),
        [first @ .., last] => format!("periods {} and {last}", first.join(", ")),
        [] => String::new(),
    }
}

/// The kinds of points of codimension 2 on the curves.
fn met(curves: &[Curve]) -> impl Iterator<Item = Codim2Symbol> {
    CODIM2_SYMBOLS
        .into_iter()
        .filter(|symbol| curves.iter().flat_map(|it| &it.codim2).any(|(other, _)| other == symbol))
}

/// The special points of branches on the curves, and their points of codimension 2.
pub fn specials(curves: &[Curve]) -> impl Iterator<Item = Placed> + '_ {
    curves.iter().flat_map(|curve| {
        let one = curve.specials.iter().map(|at| (Special::One(curve.symbol), *at));
        one.chain(curve.codim2.iter().map(|(symbol, at)| (Special::Two(*symbol), *at)))
    })
}

/// What curves lie on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ground {
    /// Paper.
    Paper,
    /// The colours of a map, from which a rim of paper lifts them.
    Colours,
}

/// Draws the curves.
pub fn draw_curves(canvas: &mut Canvas, panel: &Panel, curves: &[Curve], ground: Ground) {
    let periods = periods(curves);
    // Below all, so that no rim hides a curve.
    for curve in curves.iter().filter(|_| ground == Ground::Colours) {
        let width = curve.stroke(&periods).width + RIM;
        panel.curve(canvas, &curve.points, Stroke::solid(PAPER, width));
    }
    // The dashed go over the solid, so that both show where they run together.
    for symbol in SYMBOLS.into_iter().rev() {
        for curve in curves.iter().filter(|curve| curve.symbol == symbol) {
            panel.curve(canvas, &curve.points, curve.stroke(&periods));
            let series = format!("{}, period {}", symbol.words, curve.period);
            panel.record(canvas, &series, curve.points.iter().copied());
        }
    }
}
