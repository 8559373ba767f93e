//! Curves of special points and branches as lines and points over a map, for a screen that draws them itself.

use std::collections::BTreeSet;

use plotters::style::RGBColor;

use super::canvas::Dash;
use super::curves::{self, Curve, curves};
use super::error::FigureError;
use super::plane::Plane;
use super::shown::Shown;
use super::style::INK;
use super::symbol::Symbol;
use super::track::{Rows, branches_in_view, elsewhere};
use super::varied;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{
    AT_BRANCH_POINTS, AT_SPECIAL_POINTS, INDEX_REQUEST, OrbitColumns, Place, REQUEST_KIND,
    SPECIAL_KIND,
};
use crate::study::Drawing;

/// A line over a map, in the units of its axes.
#[derive(Debug, Clone, PartialEq)]
pub struct MapLine {
    /// What it is.
    pub words: String,
    /// Its colour; none for branches, which have the colour of the text.
    pub colour: Option<[u8; 3]>,
    /// Whether it is broken.
    pub is_dashed: bool,
    /// Its points.
    pub points: Vec<[f64; 2]>,
}

/// A special point over a map, in the units of its axes.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPoint {
    /// What happens there.
    pub words: &'static str,
    /// The colour of curves of such points; of a point of codimension 2 that of ink.
    pub colour: [u8; 3],
    /// Where it is.
    pub at: [f64; 2],
}

/// What lies over a map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OverMap {
    /// Curves of special points, and branches.
    pub lines: Vec<MapLine>,
    /// The points of codimension 2 on the curves, and the special points of the branches.
    pub points: Vec<MapPoint>,
    /// How many branches lie at other values of the axes that are held; none if all are shown.
    pub left_out: Option<String>,
}

/// The names of the variables that [`over_map`] reads.
pub fn over_map_variables(drawing: &Drawing, model: &'static Description) -> BTreeSet<String> {
    let at_points = Place::Branch.parameters(model);
    let names =
        curves::reads(drawing, model).and([AT_BRANCH_POINTS.branch, AT_SPECIAL_POINTS.branch]);
    names.and([SPECIAL_KIND, REQUEST_KIND]).and(at_points).and(varied::READS).into_set()
}

/// The curves and branches of the results over the two axes of the map that `drawing` asks for, where they lie at the values of
/// the axes that it holds.
///
/// Fails as the map does.
pub fn over_map<'a>(
    shown: impl Into<Shown<'a>>,
    drawing: &'a Drawing,
) -> Result<OverMap, FigureError> {
    let view = View::new(shown.into(), drawing)?;
    let plane = Plane::of(&view, "a map")?;
    let axes = [plane.x_name, plane.y_name];
    let of_curves = curves(&view, &axes.map(str::to_owned));
    let mut over = OverMap { left_out: elsewhere(&view, &axes), ..OverMap::default() };
    over.lines = of_curves.iter().map(line_of).collect();
    let met = of_curves.iter().flat_map(|curve| &curve.codim2);
    over.points.extend(met.map(|(symbol, (x, y))| MapPoint {
        words: symbol.words,
        colour: channels(INK),
        at: [*x, *y],
    }));
    Branches::new(&view, axes).add_to(&mut over);
    Ok(over)
}

/// The branches of the results over the axes of a map.
struct Branches<'v, 'a> {
    view: &'v View<'a>,
    axes: [&'a str; 2],
    /// Value shown per value in SI, by axis.
    factors: [f64; 2],
    /// The values of the requests, by axis.
    asked: [Rows; 2],
    /// The points of the branches.
    points: Orbits,
    /// The special points of the branches.
    specials: Orbits,
}

/// Orbits of branches.
struct Orbits {
    /// The number of the branch of each.
    branch: Rows,
    /// Where they are [SI], by axis.
    columns: [Rows; 2],
}

impl Orbits {
    fn new(view: &View<'_>, place: Place, own: &OrbitColumns, axes: [&str; 2]) -> Orbits {
        let columns = axes.map(|name| Rows::new(view.dataset, &place.name(name)));
        Orbits { branch: Rows::new(view.dataset, own.branch.name), columns }
    }
}

impl<'v, 'a> Branches<'v, 'a> {
    fn new(view: &'v View<'a>, axes: [&'a str; 2]) -> Self {
        Branches {
            view,
            axes,
            factors: axes.map(|name| view.quantity(name).factor),
            asked: axes.map(|name| Rows::new(view.dataset, &Place::Request.name(name))),
            points: Orbits::new(view, Place::Branch, &AT_BRANCH_POINTS, axes),
            specials: Orbits::new(view, Place::Special, &AT_SPECIAL_POINTS, axes),
        }
    }

    /// Adds the branches that lie at the values of the axes that are held, and their special points.
    fn add_to(&self, over: &mut OverMap) {
        let dataset = self.view.dataset;
        let fits = branches_in_view(self.view, &self.axes);
        let request = Rows::new(dataset, INDEX_REQUEST.name);
        let kind = Rows::new(dataset, SPECIAL_KIND.name);
        let flags = self.view.flags(SPECIAL_KIND.name);
        for number in 0..request.count() {
            let of = request.one(number) as usize;
            if !fits.get(of).copied().unwrap_or(false) {
                continue;
            }
            let points = self.places(&self.points, number, of);
            if points.len() > 1 {
                let words = "branch of orbits".to_owned();
                let points = points.into_iter().map(|(_, at)| at).collect();
                over.lines.push(MapLine { words, colour: None, is_dashed: false, points });
            }
            for (place, at) in self.places(&self.specials, number, of) {
                let flag = flags.iter().find(|(code, _)| *code as f64 == kind.one(place));
                let symbol = flag.and_then(|(_, name)| Symbol::named(name));
                over.points.extend(symbol.map(|symbol| MapPoint {
                    words: symbol.words,
                    colour: channels(symbol.colour),
                    at,
                }));
            }
        }
    }

    /// The rows of the orbits of a branch, by its number and that of its request, with where they are in the units of the axes.
    fn places(&self, orbits: &Orbits, number: usize, request: usize) -> Vec<(usize, [f64; 2])> {
        let mut places = Vec::new();
        for row in orbits.branch.places(number) {
            let at = [0, 1].map(|axis| {
                // What the branch does not vary has the value of its request.
                let own = orbits.columns[axis].one(row);
                let in_si = if own.is_finite() { own } else { self.asked[axis].one(request) };
                in_si * self.factors[axis]
            });
            if at.iter().all(|it| it.is_finite()) {
                places.push((row, at));
            }
        }
        places
    }
}

/// A curve as a line over a map.
fn line_of(Curve { symbol, period, points, .. }: &Curve) -> MapLine {
    let words = match period {
        1 => symbol.words.to_owned(),
        period => format!("{}, period {period}", symbol.words),
    };
    MapLine {
        words,
        colour: Some(channels(symbol.colour)),
        is_dashed: symbol.dash != Dash::None,
        points: points.iter().map(|&(x, y)| [x, y]).collect(),
    }
}

/// The words and the colour of the special points of a kind, by its name in files.
pub fn special_symbol(name: &str) -> (&'static str, [u8; 3]) {
    Symbol::named(name).map_or(("", channels(INK)), |it| (it.words, channels(it.colour)))
}

/// Red, green and blue of a colour.
pub(super) fn channels(RGBColor(red, green, blue): RGBColor) -> [u8; 3] {
    [red, green, blue]
}
