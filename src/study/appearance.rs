//! How a figure shows quantities, as far as a study or the command line sets it.

use std::collections::BTreeMap;

use super::Coordinate;
use super::document::unknown;
use crate::description::Description;
use crate::quantity::Dimension;
use crate::quantity::units::{expectation, unit};

/// What figures show besides what the model describes, with its dimension.
const OTHERS: [(&str, Dimension); 8] = [
    ("outcome", Dimension::Number),
    ("period", Dimension::Number),
    ("cycles", Dimension::Number),
    ("attractor_share", Dimension::Number),
    ("attractor_integrity_factor", Dimension::Velocity),
    ("time", Dimension::Time),
    ("spectrum_frequency", Dimension::AngularFrequency),
    ("attractor", Dimension::Number),
];

/// The unit of frequencies that is the natural frequency of the mass on its spring alone.
pub const NATURAL: &str = "sqrt(k1/m1)";

/// What can be set of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Setting {
    /// The ends of its axis, or of its colours.
    Limits,
    /// How its values are spread along its axis, or over its colours.
    Scale,
    /// The unit in which it is shown.
    Unit,
    /// What it is called.
    Label,
    /// Digits after the point of the numbers along its axis.
    Decimals,
    /// The colours of its values.
    ColourMap,
    /// The value in the middle of its colours.
    Centre,
    /// The values at which a map has contour lines.
    Contours,
}

impl Setting {
    /// Each setting by its key in studies, which is its option on the command line, too.
    pub const NAMES: [(&'static str, Setting); 8] = [
        ("limits", Setting::Limits),
        ("scale", Setting::Scale),
        ("unit", Setting::Unit),
        ("label", Setting::Label),
        ("decimals", Setting::Decimals),
        ("colour_map", Setting::ColourMap),
        ("centre", Setting::Centre),
        ("contours", Setting::Contours),
    ];

    /// Its key.
    pub fn name(self) -> &'static str {
        Setting::NAMES[self as usize].0
    }

    /// Whether it has several parts.
    pub fn is_list(self) -> bool {
        matches!(self, Setting::Limits | Setting::Contours)
    }
}

/// How values are spread along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ScaleChoice {
    /// Equal differences take equal lengths.
    Linear,
    /// Equal ratios take equal lengths.
    Log,
    /// A value v stands at asinh(v/w): linear within w of zero (SI), logarithmic beyond. Without w, it is a thousandth of the
    /// largest magnitude, rounded to a power of ten.
    Symlog(Option<f64>),
}

impl ScaleChoice {
    /// Each by its name.
    const NAMES: [(&'static str, ScaleChoice); 3] = [
        ("linear", ScaleChoice::Linear),
        ("log", ScaleChoice::Log),
        ("symlog", ScaleChoice::Symlog(None)),
    ];
}

macro_rules! colour_maps {
    ($($(#[$meaning:meta])* $map:ident $name:literal;)*) => {
        /// The colours of values; all but `turbo` can be told apart by the colour-blind.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum ColourMap {
            $($(#[$meaning])* $map,)*
        }

        impl ColourMap {
            /// Each by its name.
            pub const NAMES: &[(&str, ColourMap)] = &[$(($name, ColourMap::$map),)*];

            /// Its name.
            pub fn name(self) -> &'static str {
                ColourMap::NAMES[self as usize].0
            }
        }
    };
}

colour_maps! {
    /// From dark blue over green to yellow.
    Viridis "viridis";
    /// From dark blue over grey to yellow.
    Cividis "cividis";
    /// From black over purple to pale yellow.
    Magma "magma";
    /// From black over red to pale yellow.
    Inferno "inferno";
    /// From blue over purple to yellow.
    Plasma "plasma";
    /// From white to black.
    Greys "greys";
    /// From white to dark blue.
    Blues "blues";
    /// From blue over white to red.
    BlueRed "blue-red";
    /// From purple over white to orange.
    PurpleOrange "purple-orange";
    /// From green over white to brown.
    GreenBrown "green-brown";
    /// All colours of the spectrum; not for the colour-blind.
    Turbo "turbo";
}

/// Colours with their direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colouring {
    /// The colours.
    pub map: ColourMap,
    /// Whether they run the other way.
    pub reversed: bool,
}

/// Behind the name of colours that run the other way.
const REVERSED: &str = "-reversed";

/// What is set of a quantity; the figure chooses what is not.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct QuantitySettings {
    /// The ends of its axis, or of its colours (SI).
    pub limits: Option<[f64; 2]>,
    /// How its values are spread.
    pub scale: Option<ScaleChoice>,
    /// The unit in which it is shown.
    pub unit: Option<&'static str>,
    /// What it is called; symbols stand between dollar signs.
    pub label: Option<String>,
    /// Digits after the point of the numbers along its axis.
    pub decimals: Option<usize>,
    /// The colours of its values.
    pub colour_map: Option<Colouring>,
    /// The value in the middle of its colours (SI).
    pub centre: Option<f64>,
    /// The values at which a map has contour lines (SI).
    pub contours: Vec<f64>,
}

/// Most digits after the point.
const MOST_DECIMALS: usize = 12;

/// What is set of the quantities of a figure, by their names.
pub type Settings = BTreeMap<String, QuantitySettings>;

/// What figures of the results of a model can show, by name, with its dimension.
pub fn quantities(model: &'static Description) -> Vec<(&'static str, Dimension)> {
    let coordinates = Coordinate::all(model).map(Coordinate::quantity);
    let outputs = model.outputs().map(|it| it.quantity());
    let signals = model.motion.signals.iter().map(|it| it.quantity);
    let groups = model.motion.groups.iter().map(|it| it.quantity);
    let of_motions = model.points().chain(signals).chain(groups);
    let described = coordinates.chain(outputs).chain(of_motions);
    described.map(|it| (it.name, it.dimension)).chain(OTHERS).collect()
}

/// The dimension of what a figure of the results of a model can show; the error names what there is.
pub fn dimension_of(name: &str, model: &'static Description) -> Result<Dimension, String> {
    let known = quantities(model);
    let found = known.iter().find(|it| it.0 == name).map(|it| it.1);
    found.ok_or_else(|| unknown("quantity", name, known.iter().map(|it| it.0)))
}

/// Reads a quantity of a dimension (SI).
pub type ReadQuantity = fn(&str, Dimension) -> Result<f64, String>;

/// What a text says of a setting of a quantity.
#[derive(Debug, Clone, Copy)]
pub struct SettingText<'a> {
    /// The parts of the text.
    pub parts: &'a [String],
    /// The dimension of the quantity.
    pub dimension: Dimension,
    /// How values of the quantity are read.
    pub read: ReadQuantity,
}

impl SettingText<'_> {
    /// All parts as values.
    fn values(&self) -> Result<Vec<f64>, String> {
        self.parts.iter().map(|part| self.value(part)).collect()
    }

    /// The only part.
    fn one(&self) -> Result<&str, String> {
        match self.parts {
            [one] => Ok(one.as_str()),
            _ => Err(format!("expected one value, found {}", self.parts.len())),
        }
    }

    /// A finite value of the quantity.
    fn value(&self, text: &str) -> Result<f64, String> {
        let value = (self.read)(text, self.dimension)?;
        if value.is_finite() { Ok(value) } else { Err(format!("{value} is not a finite number")) }
    }

    /// "linear", "log", "symlog" or "symlog WIDTH".
    fn scale(&self) -> Result<ScaleChoice, String> {
        let text = self.one()?;
        let known = ScaleChoice::NAMES.iter().find(|it| it.0 == text).map(|it| it.1);
        if let Some(width) = text.strip_prefix("symlog ") {
            let width = self.value(width)?;
            let expected = "the width of the linear part of a symlog scale must be above 0";
            return (width > 0.0)
                .then_some(ScaleChoice::Symlog(Some(width)))
                .ok_or(expected.to_owned());
        }
        known.ok_or_else(|| unknown("scale", text, ScaleChoice::NAMES.iter().map(|it| it.0)))
    }
}

impl QuantitySettings {
    /// Sets what a text says of a setting.
    ///
    /// # Errors
    ///
    /// Says what is wrong and expected.
    pub fn put(&mut self, setting: Setting, text: SettingText<'_>) -> Result<(), String> {
        match setting {
            Setting::Limits => {
                let limits = <[f64; 2]>::try_from(text.values()?).ok().filter(|it| it[0] < it[1]);
                self.limits = Some(limits.ok_or("expected two values, the lesser first")?);
            }
            Setting::Contours => self.contours = text.values()?,
            Setting::Centre => self.centre = Some(text.value(text.one()?)?),
            Setting::Scale => self.scale = Some(text.scale()?),
            Setting::Unit => self.unit = Some(known_unit(text.one()?, text.dimension)?),
            Setting::Label => self.label = Some(text.one()?.to_owned()),
            Setting::Decimals => {
                let Some(digits) = text.one()?.parse().ok().filter(|it| *it <= MOST_DECIMALS)
                else {
                    return Err(format!("expected a whole number, 0 to {MOST_DECIMALS}"));
                };
                self.decimals = Some(digits);
            }
            Setting::ColourMap => self.colour_map = Some(colouring(text.one()?)?),
        }
        let reaches_zero = self.limits.is_some_and(|it| it[0] <= 0.0);
        if self.scale == Some(ScaleChoice::Log) && reaches_zero {
            return Err("a logarithmic scale needs limits above zero".to_owned());
        }
        Ok(())
    }

    /// The parts of a setting as text, if it is set; `write` makes text of a quantity.
    pub fn parts(&self, setting: Setting, write: impl Fn(f64) -> String) -> Option<Vec<String>> {
        match setting {
            Setting::Limits => self.limits.map(|it| it.map(write).to_vec()),
            Setting::Contours => (!self.contours.is_empty())
                .then(|| self.contours.iter().map(|it| write(*it)).collect()),
            Setting::Centre => self.centre.map(|it| vec![write(it)]),
            Setting::Scale => self.scale.map(|scale| match scale {
                ScaleChoice::Linear => vec!["linear".to_owned()],
                ScaleChoice::Log => vec!["log".to_owned()],
                ScaleChoice::Symlog(None) => vec!["symlog".to_owned()],
                ScaleChoice::Symlog(Some(width)) => vec![format!("symlog {}", write(width))],
            }),
            Setting::Unit => self.unit.map(|it| vec![it.to_owned()]),
            Setting::Label => self.label.clone().map(|it| vec![it]),
            Setting::Decimals => self.decimals.map(|it| vec![it.to_string()]),
            Setting::ColourMap => self.colour_map.map(|Colouring { map, reversed }| {
                vec![format!("{}{}", map.name(), if reversed { REVERSED } else { "" })]
            }),
        }
    }
}

fn known_unit(text: &str, dimension: Dimension) -> Result<&'static str, String> {
    if text == NATURAL && dimension == Dimension::AngularFrequency {
        return Ok(NATURAL);
    }
    let others = if dimension == Dimension::AngularFrequency {
        format!(", {NATURAL}")
    } else {
        String::new()
    };
    unit(text, dimension).map(|it| it.0).ok_or_else(|| {
        format!("unknown unit \"{text}\"; expected that of {}{others}", expectation(dimension))
    })
}

fn colouring(text: &str) -> Result<Colouring, String> {
    let (name, reversed) = match text.strip_suffix(REVERSED) {
        Some(name) => (name, true),
        None => (text, false),
    };
    let Some((_, map)) = ColourMap::NAMES.iter().find(|it| it.0 == name) else {
        let fault = unknown("colour map", name, ColourMap::NAMES.iter().map(|it| it.0));
        return Err(format!("{fault}, each with or without {REVERSED}"));
    };
    Ok(Colouring { map: *map, reversed })
}
