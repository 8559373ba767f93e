//! A branch as a path through a diagram: its orbits and special points in order, their cycles matched.

use super::kind::Names;
use super::symbol::Symbol;
use super::view::View;
use crate::description::{Description, Section};
use crate::store::catalogue::{
    AT_BRANCH_POINTS, AT_SPECIAL_POINTS, BRANCH_STABLE, Entry, INDEX_REQUEST, OrbitColumns, Place,
    REQUEST, REQUEST_ALONG, REQUEST_KIND, SPECIAL_AFTER, SPECIAL_KIND, section,
};
use crate::store::dataset::Dataset;

/// Two values of a parameter closer than this, relative to their size, are the same.
const SAME: f64 = 1e-6;

/// What is read of the branches whose orbits are shown as their `outputs`.
pub fn reads(outputs: &[String], model: &'static Description) -> Names {
    let at_points = orbit_names(Place::Branch, &AT_BRANCH_POINTS, outputs, model);
    let at_specials = orbit_names(Place::Special, &AT_SPECIAL_POINTS, outputs, model);
    at_points
        .and_all(at_specials)
        .and([INDEX_REQUEST, REQUEST_KIND, BRANCH_STABLE, SPECIAL_AFTER, SPECIAL_KIND])
        .and(Place::Request.parameters(model))
}

/// What is read of the orbits at a place on the branches.
fn orbit_names(
    place: Place,
    own: &OrbitColumns,
    outputs: &[String],
    model: &'static Description,
) -> Names {
    let of_orbits = [own.branch, own.period].into_iter().chain(place.parameters(model));
    let sections = section(model).into_iter().map(|entry| place.of(entry));
    let outputs = outputs.iter().map(|output| place.name(output));
    Names::of(of_orbits.chain(sections)).and_named(outputs)
}

/// Whether each request lies where `view` holds the axes other than those that are `drawn`: each branch of the study, and each
/// boundary of its map.
pub fn in_view(view: &View<'_>, drawn: &[&str]) -> Vec<bool> {
    where_held(view, REQUEST, Place::Request, drawn)
}

/// The same of branches alone: the short one from which a boundary is followed is none that was asked for.
pub fn branches_in_view(view: &View<'_>, drawn: &[&str]) -> Vec<bool> {
    let kinds = Rows::new(view.dataset, REQUEST_KIND.name);
    let fits = in_view(view, drawn).into_iter().enumerate();
    fits.map(|(request, fits)| fits && is_branch(&kinds, request)).collect()
}

/// Whether a request is a branch of the study; files without boundaries have no kinds.
fn is_branch(kinds: &Rows, request: usize) -> bool {
    kinds.one(request) != 1.0
}

/// Whether each of what lies along a dimension, whose parameters are the columns of a place, lies where `view` holds the axes other than
/// those that are `drawn`.
pub fn where_held(view: &View<'_>, dimension: Entry, place: Place, drawn: &[&str]) -> Vec<bool> {
    let count = view.coordinate_values(dimension.name).len();
    let mut fits = vec![true; count];
    for axis in view.axes() {
        let mut held = Vec::new();
        if !drawn.contains(&axis) {
            held.extend(view.held_value(axis).map(|value| (axis, vec![value])));
        }
        for quantity in view.beside(axis) {
            let values = view.values_beside(quantity);
            // Along a path that is drawn it would have to be the same everywhere.
            let own = match drawn.contains(&axis) {
                true => values,
                false => values.get(view.held.place(axis)).copied().into_iter().collect(),
            };
            held.push((quantity, own));
        }
        for (name, values) in held {
            let Some(variable) = view.dataset.variable(&place.name(name)) else { continue };
            for (fits, value) in fits.iter_mut().zip(variable.values.to_real()) {
                *fits &= values.iter().all(|held| is_same(value, *held));
            }
        }
    }
    fits
}

/// Whether two values of a parameter are the same, but for rounding.
fn is_same(value: f64, held: f64) -> bool {
    (value - held).abs() <= SAME * held.abs().max(value.abs())
}

/// How many branches are not shown as they lie where the axes that are not `drawn` have other values than `view` holds;
/// none if all are shown.
pub fn elsewhere(view: &View<'_>, drawn: &[&str]) -> Option<String> {
    let along = view.dataset.variable(REQUEST_ALONG.name).filter(|_| view.drawing.branches)?;
    let kinds = Rows::new(view.dataset, REQUEST_KIND.name);
    let requests = along.values.to_real().into_iter().zip(in_view(view, drawn)).enumerate();
    let branches = requests.filter(|(request, _)| is_branch(&kinds, *request));
    let ours = branches.filter(|(_, (code, _))| {
        let flag = along.flags.iter().find(|(value, _)| *value as f64 == *code);
        flag.is_some_and(|(_, name)| drawn.contains(&name.as_str()))
    });
    let (shown, hidden): (Vec<bool>, Vec<bool>) =
        ours.map(|(_, (_, fits))| fits).partition(|fits| *fits);
    let all = shown.len() + hidden.len();
    (!hidden.is_empty()).then(|| format!("{} of {all} branches lie at other values", hidden.len()))
}

/// A point of a branch, in SI.
pub struct Stop {
    /// Value of the parameter of the branch.
    pub x: f64,
    /// The output, once or for each cycle of the period.
    pub values: Vec<f64>,
    /// Whether the orbit is stable; unknown at a special point.
    pub stable: Option<bool>,
    /// What happens there, at a special point.
    pub symbol: Option<Symbol>,
    /// The row of the special point in its table.
    pub special: Option<usize>,
}

/// A branch.
pub struct Track {
    /// Its stops in order.
    pub stops: Vec<Stop>,
}

impl Track {
    /// Number of lines that the branch makes.
    pub fn width(&self) -> usize {
        self.stops.iter().map(|stop| stop.values.len()).min().unwrap_or(0)
    }
}

/// The numbers of a variable, `width` of them at each place of its dimension; none where it is missing.
pub struct Rows {
    width: usize,
    /// Whether there is a second dimension.
    several: bool,
    values: Vec<f64>,
}

impl Rows {
    /// The variable called `name`.
    pub fn new(dataset: &Dataset, name: &str) -> Rows {
        let Some(variable) = dataset.variable(name) else {
            return Rows { width: 1, several: false, values: Vec::new() };
        };
        let width = variable.values.shape().iter().skip(1).product();
        let several = variable.dimensions.len() > 1;
        Rows { width, several, values: variable.values.to_real().into_iter().collect() }
    }

    /// The numbers at a place.
    pub fn at(&self, place: usize) -> &[f64] {
        let begin = place * self.width;
        self.values.get(begin..begin + self.width).unwrap_or(&[])
    }

    /// How many places there are.
    pub fn count(&self) -> usize {
        self.values.len() / self.width.max(1)
    }

    /// The first number at a place, or NaN.
    pub fn one(&self, place: usize) -> f64 {
        self.at(place).first().copied().unwrap_or(f64::NAN)
    }

    /// The places at which the value is `wanted`.
    pub fn places(&self, wanted: usize) -> Vec<usize> {
        (0..self.values.len()).filter(|place| self.one(*place) == wanted as f64).collect()
    }
}

/// The variables of the points of the branches or of their special points.
struct Source {
    branch: Rows,
    x: Rows,
    output: Rows,
    period: Rows,
    section: Vec<Rows>,
}

impl Source {
    fn new(dataset: &Dataset, place: Place, own: &OrbitColumns, x: &str, output: &str) -> Source {
        let [branch, period] = [own.branch, own.period].map(|it| Rows::new(dataset, it.name));
        let [x, output] = [x, output].map(|name| Rows::new(dataset, &place.name(name)));
        let sections = section(dataset.model()).into_iter();
        let section = sections.map(|entry| Rows::new(dataset, &place.name(entry.name))).collect();
        Source { branch, x, output, period, section }
    }

    /// The section points of the orbit at `place`.
    fn orbit(&self, place: usize) -> Vec<Section> {
        let cycles = self.period.one(place).max(0.0) as usize;
        let points = (0..cycles).map(|cycle| {
            let values = self.section.iter().map(|rows| rows.at(place).get(cycle).copied());
            values.map(|value| value.unwrap_or(f64::NAN)).collect()
        });
        points.collect()
    }
}

/// The branches along `x` that lie where `view` holds the other axes, as their `output`.
pub fn tracks(view: &View<'_>, x: &str, output: &str) -> Vec<Track> {
    let dataset = view.dataset;
    if dataset.variable(&Place::Branch.name(output)).is_none() {
        return Vec::new();
    }
    let fits = branches_in_view(view, &[x]);
    let request = Rows::new(dataset, INDEX_REQUEST.name);
    let points = Source::new(dataset, Place::Branch, &AT_BRANCH_POINTS, x, output);
    let specials = Source::new(dataset, Place::Special, &AT_SPECIAL_POINTS, x, output);
    let shown = (0..request.values.len())
        .filter(|branch| fits.get(request.one(*branch) as usize).copied().unwrap_or(false));
    let along_x = shown.filter(|branch| {
        let first = points.branch.places(*branch).first().copied();
        first.is_some_and(|place| points.x.one(place).is_finite())
    });
    along_x.map(|branch| track(dataset, branch, &points, &specials)).collect()
}

fn track(dataset: &Dataset, branch: usize, points: &Source, specials: &Source) -> Track {
    let stable = Rows::new(dataset, BRANCH_STABLE.name);
    let after = Rows::new(dataset, SPECIAL_AFTER.name);
    let kind = Rows::new(dataset, SPECIAL_KIND.name);
    let flags = dataset.variable(SPECIAL_KIND.name).map_or(&[][..], |variable| &variable.flags);
    let mut turning = Turning::new(points, branch);
    let mut waiting = specials.branch.places(branch).into_iter().peekable();
    let mut stops = Vec::new();
    for place in points.branch.places(branch) {
        let stable = Some(stable.one(place) == 1.0);
        let values = turning.values(points, place);
        let x = points.x.one(place);
        stops.push(Stop { x, values, stable, symbol: None, special: None });
        while let Some(special) = waiting.next_if(|&special| after.one(special) <= place as f64) {
            let values = turning.values(specials, special);
            let x = specials.x.one(special);
            let flag = flags.iter().find(|(code, _)| *code as f64 == kind.one(special));
            let symbol = flag.and_then(|(_, name)| Symbol::named(name));
            stops.push(Stop { x, values, stable: None, symbol, special: Some(special) });
        }
    }
    Track { stops }
}

/// Keeps the cycles of an orbit in step with those of the orbit before it on the branch.
struct Turning {
    /// Extent of each section coordinate on the branch.
    extent: Section,
    before: Vec<Section>,
}

impl Turning {
    fn new(points: &Source, branch: usize) -> Turning {
        let all: Vec<Section> =
            points.branch.places(branch).into_iter().flat_map(|at| points.orbit(at)).collect();
        let extent = (0..points.section.len()).map(|i| {
            let low = all.iter().map(|point| point[i]).fold(f64::INFINITY, f64::min);
            let high = all.iter().map(|point| point[i]).fold(f64::NEG_INFINITY, f64::max);
            (high - low).max(f64::MIN_POSITIVE)
        });
        Turning { extent: extent.collect(), before: Vec::new() }
    }

    /// The output at `place`, its cycles turned to lie nearest those of the orbit before.
    fn values(&mut self, source: &Source, place: usize) -> Vec<f64> {
        let mut orbit = source.orbit(place);
        let turn = match self.before.len() == orbit.len() {
            true => self.nearest(&orbit),
            false => 0,
        };
        orbit.rotate_left(turn);
        let cycles = orbit.len();
        self.before = orbit;
        if !source.output.several {
            return vec![source.output.one(place)];
        }
        let values = source.output.at(place);
        let turned = (0..cycles).map(|cycle| values.get((cycle + turn) % cycles));
        turned.map(|value| value.copied().unwrap_or(f64::NAN)).collect()
    }

    /// By how many cycles `orbit` is turned against the one before.
    fn nearest(&self, orbit: &[Section]) -> usize {
        let distances = (0..orbit.len()).map(|turn| {
            let turned = orbit.iter().cycle().skip(turn);
            let pairs = self.before.iter().zip(turned);
            (turn, pairs.map(|(a, b)| self.apart(a, b)).sum::<f64>())
        });
        distances.min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(turn, _)| turn)
    }

    /// Square of the distance of two section points, relative to the extent of the branch.
    fn apart(&self, a: &[f64], b: &[f64]) -> f64 {
        (0..a.len())
            .map(|i| {
                let difference = (a[i] - b[i]) / self.extent[i];
                difference * difference
            })
            .sum()
    }
}
