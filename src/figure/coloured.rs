//! A map as the colours and numbers of its cells, for a screen that draws it itself.

use std::rc::Rc;

use super::attractor_colours::{colour_of, tinted};
use super::cells::Cells;
use super::chosen::Chosen;
use super::colour::Colours;
use super::error::FigureError;
use super::map;
use super::over_map::channels;
use super::paint::Paint;
use super::plane::Plane;
use super::quantity::Quantity;
use super::scale::{Scale, Spacing};
use super::shown::Shown;
use super::style::UNDECIDED;
use super::unit::ShownUnit;
use super::view::View;
use crate::store::dataset::Dataset;
use crate::study::{Drawing, QuantitySettings};

/// Colours of a bar.
const STEPS: usize = 256;

/// An axis of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapAxis {
    /// Its name in files.
    pub name: String,
    /// What it is, with its unit.
    pub label: String,
    /// Value shown per value in SI.
    pub factor: f64,
    /// The values of the cells, rising [SI].
    pub values: Vec<f64>,
    /// Where each cell ends, as a share of the axis from its low end.
    pub ends: Vec<f64>,
    /// The ends of the axis, in the unit shown, and whether it is logarithmic.
    pub range: [f64; 2],
    /// Whether equal ratios take equal lengths.
    pub is_logarithmic: bool,
}

/// What the colours of a map tell.
#[derive(Debug, Clone, PartialEq)]
pub enum MapColours {
    /// Numbers: the ends of the bar in the unit shown, how its values are spread ("linear", "log" or "symlog"), the width about
    /// which a symmetric scale turns, and its colours from the low end.
    Bar([f64; 2], &'static str, f64, Vec<[u8; 3]>),
    /// Kinds by their names, and none of them where no case has a value.
    Kinds(Vec<(String, Option<[u8; 3]>)>),
}

/// A map as colours and numbers, cell by cell: row by row from the least ordinate, each from the least abscissa.
#[derive(Debug, Clone, PartialEq)]
pub struct ColouredMap {
    /// The abscissa and the ordinate.
    pub axes: [MapAxis; 2],
    /// Red, green, blue and opacity of each cell; transparent where it has no value.
    pub colours: Vec<u8>,
    /// What each cell shows, in the unit shown; the place of its kind where there are kinds; NaN where it has none.
    pub values: Vec<f32>,
    /// What the colours tell, with its unit.
    pub told: String,
    /// The bar or the kinds.
    pub key: MapColours,
}

/// The map that `drawing` asks for, with the colours of the figure.
///
/// Fails as the figure does.
pub fn coloured_map<'a>(
    shown: impl Into<Shown<'a>>,
    drawing: &'a Drawing,
) -> Result<ColouredMap, FigureError> {
    let view = View::new(shown.into(), drawing)?;
    let plane = Plane::of(&view, "a map")?;
    let paint = map::paint(&view, std::slice::from_ref(&view), &plane)?;
    let count = plane.count();
    let (mut colours, mut values) = (Vec::with_capacity(4 * count), Vec::with_capacity(count));
    for row in 0..plane.y.count() {
        for column in 0..plane.x.count() {
            let case = plane.case(column, row);
            let colour = paint.colour(case).map_or([0; 4], |it| [it.0, it.1, it.2, u8::MAX]);
            colours.extend(colour);
            values.push(paint.number(case));
        }
    }
    Ok(ColouredMap {
        axes: [
            axis(view.quantity(plane.x_name), &plane.x),
            axis(view.quantity(plane.y_name), &plane.y),
        ],
        colours,
        values,
        told: paint.told(),
        key: key(&paint),
    })
}

fn axis(quantity: Quantity, cells: &Cells) -> MapAxis {
    let Scale { spacing, low, high } = cells.scale;
    MapAxis {
        label: quantity.told(),
        factor: quantity.factor,
        values: cells.values().map(|value| value / quantity.factor).collect(),
        ends: (0..cells.count()).map(|cell| cells.range(cell)[1]).collect(),
        range: [low, high],
        is_logarithmic: spacing == Spacing::Log,
        name: quantity.key,
    }
}

pub(super) fn key(paint: &Paint) -> MapColours {
    match paint {
        Paint::Numbers(Some(colours), ..) => bar(colours),
        Paint::Numbers(None, ..) => MapColours::Kinds(Vec::new()),
        Paint::Kinds(kinds) => {
            let kinds = kinds.kinds.iter().map(|it| (it.name.clone(), it.colour.map(channels)));
            MapColours::Kinds(kinds.collect())
        }
    }
}

fn bar(colours: &Colours) -> MapColours {
    let scale = colours.scale();
    let values = (0..STEPS).map(|step| scale.value(step as f64 / (STEPS - 1) as f64));
    let bar = values.map(|value| channels(colours.of(value))).collect();
    let (spread, width) = match scale.spacing {
        Spacing::Linear => ("linear", 0.0),
        Spacing::Log => ("log", 0.0),
        Spacing::Symmetric(width) => ("symlog", width),
    };
    MapColours::Bar([scale.low, scale.high], spread, width, bar)
}

/// The colour of a start in figures of basins: that of the attractor of this number, or of starts whose attractor is not known.
pub fn label_colour(attractor: Option<u32>) -> [u8; 3] {
    channels(attractor.map_or(UNDECIDED, |number| tinted(colour_of(number as usize))))
}

/// How figures show a quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownQuantity {
    /// What it is, with its unit.
    pub label: String,
    /// Its unit; empty where it has none.
    pub unit: String,
    /// Value shown per value in SI.
    pub factor: f64,
}

/// How figures show the quantity called `name` in files, in a unit that is named and fits it, or in the usual one.
pub fn shown_quantity(name: &str, dataset: &Dataset, unit: Option<&str>) -> ShownQuantity {
    let unit = unit.and_then(|unit| ShownUnit::of(name, dataset.model(), unit, || None).ok());
    let chosen = Chosen::new(QuantitySettings::default(), unit);
    let quantity = Quantity::named(name, dataset).with(Rc::new(chosen));
    let (label, unit) = (quantity.told(), quantity.unit().content());
    ShownQuantity { label, unit, factor: quantity.factor }
}
