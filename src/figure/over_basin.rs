//! What lies over the basins of a file, for a screen that draws it itself: attractors, saddles and their manifolds.

use std::collections::BTreeSet;

use super::attractor_colours::Colours;
use super::error::FigureError;
use super::known_attractors::KnownAttractors;
use super::manifolds::Curves;
use super::over_map::channels;
use super::plane::Plane;
use super::section_points::{in_plane, is_at_starts, of_attractors};
use super::shown::Shown;
use super::track::Rows;
use super::variables;
use super::view::View;
use crate::description::{Description, Output};
use crate::store::catalogue::{
    ATTRACTOR_CASE, ATTRACTOR_INDEX, ATTRACTOR_MULTIPLIER_IMAG, ATTRACTOR_MULTIPLIER_REAL,
    EDGE_HIGH, EDGE_INDEX, EDGE_LOW, EDGE_MULTIPLIER_IMAG, EDGE_MULTIPLIER_REAL, EDGE_PERIOD,
    EDGE_RESIDUAL, Entry, Place, STABLE_EDGE, STABLE_LEFT, STABLE_RIGHT, UNSTABLE_ATTRACTOR,
    UNSTABLE_EDGE, edges,
};
use crate::study::Drawing;

/// What a file tells of its basins, its places in the units of the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct OverBasin {
    /// The attractors, by their number.
    pub attractors: Vec<BasinAttractor>,
    /// The saddles between basins.
    pub saddles: Vec<BasinSaddle>,
    /// The boundary as curves: the stable manifolds of the saddles.
    pub stable: Vec<BasinCurve>,
    /// The unstable manifolds of the saddles.
    pub unstable: Vec<BasinCurve>,
    /// Whether section points lie in more dimensions than the plane has.
    pub is_projected: bool,
    /// What is not shown, in phrases.
    pub left_out: Vec<String>,
}

/// An attractor of a file of basins.
#[derive(Debug, Clone, PartialEq)]
pub struct BasinAttractor {
    /// Its colour.
    pub colour: [u8; 3],
    /// The colour of its basin.
    pub basin: [u8; 3],
    /// Its period, or the name of its kind.
    pub motion: String,
    /// The first case that leads to it.
    pub case: Option<u64>,
    /// The outputs that are told of motions, in SI.
    pub outputs: Vec<(Output, f64)>,
    /// Its share of the starts, with the standard error.
    pub share: [f64; 2],
    /// The multipliers of its orbit.
    pub multipliers: Vec<[f64; 2]>,
    /// Its section points.
    pub points: Vec<[f64; 2]>,
}

/// A saddle between two basins.
#[derive(Debug, Clone, PartialEq)]
pub struct BasinSaddle {
    /// The numbers of the attractors whose basins it lies between.
    pub between: [u64; 2],
    /// Its period.
    pub period: u64,
    /// How far its section is from repeating, relative to the motion.
    pub residual: f64,
    /// The multipliers of its orbit.
    pub multipliers: Vec<[f64; 2]>,
    /// Its section points.
    pub points: Vec<[f64; 2]>,
}

/// A curve of a manifold.
#[derive(Debug, Clone, PartialEq)]
pub struct BasinCurve {
    /// The number of the saddle that it is of, where that is known.
    pub saddle: Option<u64>,
    /// The attractors on its sides, or the one to which it leads.
    pub attractors: Vec<u64>,
    /// Its points.
    pub points: Vec<[f64; 2]>,
}

/// The names of the variables that [`over_basin`] reads.
pub fn over_basin_variables(drawing: &Drawing, model: &'static Description) -> BTreeSet<String> {
    let more = [
        ATTRACTOR_CASE,
        ATTRACTOR_MULTIPLIER_REAL,
        ATTRACTOR_MULTIPLIER_IMAG,
        EDGE_LOW,
        EDGE_HIGH,
        EDGE_PERIOD,
        EDGE_RESIDUAL,
        EDGE_MULTIPLIER_REAL,
        EDGE_MULTIPLIER_IMAG,
        STABLE_EDGE,
        STABLE_LEFT,
        STABLE_RIGHT,
        UNSTABLE_EDGE,
        UNSTABLE_ATTRACTOR,
    ];
    let outputs = model.key_outputs().map(|it| Place::Attractor.of(Entry::of_output(it)));
    let mut names = variables(drawing, model);
    names.extend(more.into_iter().chain(outputs).map(|entry| entry.name.to_owned()));
    names
}

/// What the results tell of the basins over the two axes of starts that `drawing` asks for.
///
/// Fails as the figure of the basins does where an axis is no coordinate of a start.
pub fn over_basin<'a>(
    shown: impl Into<Shown<'a>>,
    drawing: &'a Drawing,
) -> Result<OverBasin, FigureError> {
    let view = View::new(shown.into(), drawing)?;
    let plane = Plane::of_starts(&view, "a figure of basins", "basins lie")?;
    let curves = Curves::of(&view, &plane);
    let elsewhere = "section points: the section is at another phase than the starts";
    let is_elsewhere = !is_at_starts(&view);
    let [of_stable, left, right] =
        [STABLE_EDGE, STABLE_LEFT, STABLE_RIGHT].map(|it| Rows::new(view.dataset, it.name));
    let [of_unstable, to] =
        [UNSTABLE_EDGE, UNSTABLE_ATTRACTOR].map(|it| Rows::new(view.dataset, it.name));
    Ok(OverBasin {
        attractors: attractors(&view, &plane, &Colours::of(&view)?)?,
        saddles: saddles(&view, &plane),
        stable: parted(&curves.stable, &of_stable, &[left, right]),
        unstable: parted(&curves.unstable, &of_unstable, &[to]),
        is_projected: edges(view.model()).len() > 2,
        left_out: is_elsewhere
            .then(|| elsewhere.to_owned())
            .into_iter()
            .chain(curves.shortfall())
            .collect(),
    })
}

/// The attractors of the table.
fn attractors(
    view: &View<'_>,
    plane: &Plane<'_>,
    colours: &Colours,
) -> Result<Vec<BasinAttractor>, FigureError> {
    let known = KnownAttractors::held(view)?;
    let count = view.coordinate_values(ATTRACTOR_INDEX.name).len();
    let mut points = points(in_plane(view, plane, &of_attractors(view.model())), count);
    let parts = [ATTRACTOR_MULTIPLIER_REAL, ATTRACTOR_MULTIPLIER_IMAG];
    let parts = parts.map(|entry| Rows::new(view.dataset, entry.name));
    let case = Rows::new(view.dataset, ATTRACTOR_CASE.name);
    let outputs = view.model().key_outputs().map(|output| {
        let entry = Place::Attractor.of(Entry::of_output(output));
        (output, Rows::new(view.dataset, entry.name))
    });
    let outputs: Vec<(Output, Rows)> = outputs.collect();
    let all = (0..count).map(|number| BasinAttractor {
        colour: channels(colours.colour(number)),
        basin: channels(colours.band(number)),
        motion: known.motion(number),
        case: whole(case.one(number)),
        outputs: outputs.iter().map(|(output, rows)| (*output, rows.one(number))).collect(),
        share: known.share(number),
        multipliers: multipliers(&parts, number),
        points: std::mem::take(&mut points[number]),
    });
    Ok(all.collect())
}

/// The saddles of the table.
fn saddles(view: &View<'_>, plane: &Plane<'_>) -> Vec<BasinSaddle> {
    let count = view.coordinate_values(EDGE_INDEX.name).len();
    let mut points = points(in_plane(view, plane, &edges(view.model())), count);
    let [low, high, period, residual] = [EDGE_LOW, EDGE_HIGH, EDGE_PERIOD, EDGE_RESIDUAL]
        .map(|it| Rows::new(view.dataset, it.name));
    let parts =
        [EDGE_MULTIPLIER_REAL, EDGE_MULTIPLIER_IMAG].map(|it| Rows::new(view.dataset, it.name));
    let all = (0..count).map(|number| BasinSaddle {
        between: [&low, &high].map(|it| it.one(number) as u64),
        period: period.one(number) as u64,
        residual: residual.one(number),
        multipliers: multipliers(&parts, number),
        points: std::mem::take(&mut points[number]),
    });
    all.collect()
}

/// The multipliers in a row of two tables, those of their real and of their imaginary parts.
fn multipliers([real, imaginary]: &[Rows; 2], number: usize) -> Vec<[f64; 2]> {
    let pairs = real.at(number).iter().zip(imaginary.at(number));
    pairs.map(|(re, im)| [*re, *im]).filter(|it| it[0].is_finite()).collect()
}

/// The places of so many orbits, each with its own; those that are no numbers are left out.
fn points(places: Vec<(f64, f64)>, orbits: usize) -> Vec<Vec<[f64; 2]>> {
    let cycles = places.len() / orbits.max(1);
    let of_orbits = (0..orbits).map(|number| {
        let own = places.iter().skip(number * cycles).take(cycles);
        let finite = own.filter(|(x, y)| x.is_finite() && y.is_finite());
        finite.map(|&(x, y)| [x, y]).collect()
    });
    of_orbits.collect()
}

/// A number of a table; none where it tells of none.
fn whole(value: f64) -> Option<u64> {
    (value >= 0.0).then_some(value as u64)
}

/// Curves that lie one after the other, parted by points that are no numbers, with the saddle and the attractors of each.
fn parted(points: &[(f64, f64)], saddle: &Rows, attractors: &[Rows]) -> Vec<BasinCurve> {
    let parts = points.split(|(x, _)| x.is_nan()).filter(|part| !part.is_empty());
    let curves = parts.enumerate().map(|(number, part)| BasinCurve {
        saddle: whole(saddle.one(number)),
        attractors: attractors.iter().filter_map(|it| whole(it.one(number))).collect(),
        points: part.iter().map(|&(x, y)| [x, y]).collect(),
    });
    curves.collect()
}
