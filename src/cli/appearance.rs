//! What the command line sets of a figure: its size, and how it shows quantities.

use std::collections::BTreeMap;

use clap::Args;

use super::arguments::plain_or_quantity;
use crate::quantity::Dimension;
use crate::quantity::units::parse_in;
use crate::study::appearance::SettingText;
use crate::study::colour::attractor_number;
use crate::study::document::unknown;
use crate::study::drawing::check_text;
use crate::study::{Colour, Drawing, Setting, Size};

/// The dimension of the quantity of this name, or what is wrong with the name.
pub type DimensionOf<'a> = &'a dyn Fn(&str) -> Result<Dimension, String>;

/// Options that set how a figure looks.
#[derive(Debug, Args)]
#[command(next_help_heading = "Appearance")]
pub struct Appearance {
    /// Width, in mm unless another unit is named, such as "3.4 in" or "246 pt".
    #[arg(long, requires = "kind", allow_hyphen_values = true)]
    width: Option<String>,
    /// Height, likewise.
    #[arg(long, requires = "kind", allow_hyphen_values = true)]
    height: Option<String>,
    /// Diameter of the points of cases, likewise.
    #[arg(long, requires = "kind", allow_hyphen_values = true)]
    marker_size: Option<String>,
    /// Dots per inch of a PNG file; 600 by default.
    #[arg(long, requires = "kind", allow_negative_numbers = true)]
    dpi: Option<f64>,
    /// Marks to leave out, of those that the kind of figure has: gap, stroboscopic, impacts, contact, drive, coexistence,
    /// events, special-points, section-points, saddles, manifolds, impact-surface, fronts, optima.
    #[arg(long, value_delimiter = ',', requires = "kind")]
    hide: Vec<String>,
    /// Colours of attractors by their numbers in the file, as 0=blue,2=#d55e00; the others have those that the figures of the study
    /// set, or else those that figures choose.
    #[arg(long, value_name = "NUMBER=COLOUR,...", value_delimiter = ',', requires = "kind")]
    colours: Vec<String>,
    /// Words that stand in the figure where the quantities along both axes have these values.
    #[arg(long, value_name = "WORDS: NAME=VALUE, NAME=VALUE", requires = "kind")]
    text: Vec<String>,
    /// Leave out what the marks mean; what the figure leaves out is still said.
    #[arg(long, requires = "kind")]
    no_legend: bool,
    /// Write the data behind the figure beside it, as CSV in the units of its axes.
    #[arg(long, requires = "kind")]
    data: bool,
    /// Keep text as text in SVG files; they look the same only where the font is.
    #[arg(long, requires = "kind")]
    svg_text: bool,
    /// Ends of an axis, or of colours, by the quantity that they show.
    #[arg(long, value_name = "NAME=LOW,HIGH", requires = "kind", allow_hyphen_values = true)]
    limits: Vec<String>,
    /// How values are spread: linear, log, or symlog with a width w, about which asinh(v/w) turns from linear to logarithmic.
    #[arg(long, value_name = "NAME=SCALE", requires = "kind")]
    scale: Vec<String>,
    /// Unit of a quantity, as Hz, deg or, for frequencies, sqrt(k1/m1).
    #[arg(long, value_name = "NAME=UNIT", requires = "kind")]
    unit: Vec<String>,
    /// What a quantity is called; symbols stand between dollar signs, as in $k_2$.
    #[arg(long, value_name = "NAME=TEXT", requires = "kind")]
    label: Vec<String>,
    /// Digits after the point of the numbers along an axis.
    #[arg(long, value_name = "NAME=COUNT", requires = "kind")]
    decimals: Vec<String>,
    /// Colours of values: viridis, cividis, magma, inferno, plasma, greys, blues, blue-red, purple-orange, green-brown or
    /// turbo, each also with -reversed.
    #[arg(long, value_name = "NAME=COLOURS", requires = "kind")]
    colour_map: Vec<String>,
    /// Value in the middle of the colours.
    #[arg(long, value_name = "NAME=VALUE", requires = "kind", allow_hyphen_values = true)]
    centre: Vec<String>,
    /// Values at which a map has contour lines.
    #[arg(long, value_name = "NAME=VALUE,...", requires = "kind", allow_hyphen_values = true)]
    contours: Vec<String>,
}

impl Appearance {
    /// The drawing as these options set it; all faults otherwise.
    pub fn set(
        &self,
        drawing: Drawing,
        dimension_of: DimensionOf<'_>,
    ) -> Result<Drawing, Vec<String>> {
        let mut faults = Vec::new();
        let Appearance { dpi, data, svg_text, .. } = *self;
        let marks = drawing.kind.keys().marks;
        for name in self.hide.iter().filter(|name| !marks.contains(&name.as_str())) {
            let fault = unknown("mark of this kind of figure", name, marks.iter().copied());
            faults.push(format!("--hide: {fault}"));
        }
        let hide = self.hide.clone();
        let mut drawing = Drawing { hide, dpi, legend: !self.no_legend, data, svg_text, ..drawing };
        self.set_sizes(&mut drawing, &mut faults);
        let checked = self.dpi.map_or(Ok(()), |dpi| Size::Resolution.check(dpi));
        faults.extend(checked.err().map(|fault| format!("--dpi: {fault}")));
        let colours = self.colours.iter().map(|text| numbered(text));
        for colour in colours {
            match colour {
                Ok((number, colour)) => drop(drawing.colours.insert(number, colour)),
                Err(fault) => faults.push(format!("--colours {fault}")),
            }
        }
        for text in &self.text {
            match placed(text, dimension_of) {
                Ok((words, at)) => drop(drawing.texts.insert(words, at)),
                Err(fault) => faults.push(format!("--text {text}: {fault}")),
            }
        }
        for (key, setting) in Setting::NAMES {
            for text in self.of(setting) {
                let put = put(&mut drawing, setting, text, dimension_of);
                let option = key.replace('_', "-");
                faults.extend(put.err().map(|fault| format!("--{option} {text}: {fault}")));
            }
        }
        if faults.is_empty() { Ok(drawing) } else { Err(faults) }
    }

    /// Sets the sizes of a drawing; faults are noted.
    fn set_sizes(&self, drawing: &mut Drawing, faults: &mut Vec<String>) {
        let sizes = [
            ("width", &self.width, &mut drawing.width_mm, Size::Width),
            ("height", &self.height, &mut drawing.height_mm, Size::Height),
            ("marker-size", &self.marker_size, &mut drawing.marker_mm, Size::Marker),
        ];
        for (option, text, kept, size) in sizes {
            let found = text.as_deref().map(millimetres).transpose();
            let checked = found.and_then(|it| it.map_or(Ok(()), |it| size.check(it)).map(|()| it));
            match checked {
                Ok(found) => *kept = found,
                Err(fault) => faults.push(format!("--{option}: {fault}")),
            }
        }
    }

    /// What is given of a setting.
    fn of(&self, setting: Setting) -> &[String] {
        match setting {
            Setting::Limits => &self.limits,
            Setting::Scale => &self.scale,
            Setting::Unit => &self.unit,
            Setting::Label => &self.label,
            Setting::Decimals => &self.decimals,
            Setting::ColourMap => &self.colour_map,
            Setting::Centre => &self.centre,
            Setting::Contours => &self.contours,
        }
    }
}

/// The colour of an attractor, behind its number.
fn numbered(text: &str) -> Result<(u32, Colour), String> {
    let fault = |why: String| format!("{text}: {why}");
    let (number, colour) = text
        .split_once('=')
        .ok_or_else(|| fault("expected NUMBER=COLOUR, as 0=blue".to_owned()))?;
    let number = attractor_number(number.trim()).map_err(fault)?;
    Ok((number, Colour::parse(colour.trim()).map_err(fault)?))
}

/// A length [mm]; a plain number is in millimetres.
fn millimetres(text: &str) -> Result<f64, String> {
    let plain = text.trim().parse::<f64>().ok();
    plain.map_or_else(|| parse_in(text, Dimension::Length, 1e-3), Ok)
}

/// The words of "WORDS: NAME=VALUE, NAME=VALUE", and where they stand.
fn placed(
    text: &str,
    dimension_of: DimensionOf<'_>,
) -> Result<(String, BTreeMap<String, f64>), String> {
    let (words, place) = text.rsplit_once(':').ok_or("expected WORDS: NAME=VALUE, NAME=VALUE")?;
    let mut at = BTreeMap::new();
    for part in place.split(',') {
        let (name, value) = part.split_once('=').ok_or("expected NAME=VALUE after the words")?;
        let name = name.trim();
        at.insert(name.to_owned(), plain_or_quantity(value, dimension_of(name)?)?);
    }
    check_text(words, &at)?;
    Ok((words.trim().to_owned(), at))
}

/// Sets what "NAME=VALUE" says.
fn put(
    drawing: &mut Drawing,
    setting: Setting,
    text: &str,
    dimension_of: DimensionOf<'_>,
) -> Result<(), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    let dimension = dimension_of(name.trim())?;
    let parts: Vec<String> = match setting.is_list() {
        true => value.split(',').map(str::to_owned).collect(),
        false => vec![value.to_owned()],
    };
    let settings = drawing.settings.entry(name.trim().to_owned()).or_default();
    settings.put(setting, SettingText { parts: &parts, dimension, read: plain_or_quantity })
}
