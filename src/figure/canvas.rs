//! The page: shapes drawn by plotters into layers of one SVG, and the labels set between them.

use std::fmt::Write as _;

use base64::Engine as _;
use plotters::coord::Shift;
use plotters::prelude::{
    Circle, Color, DrawingArea, DrawingAreaErrorKind, IntoDrawingArea, PathElement, Polygon,
    Rectangle, SVGBackend, ShapeStyle,
};
use plotters::style::RGBColor;

use super::data::Data;
use super::geometry::{Point, Rect};
use super::raster::Raster;
use super::style::{FAMILY, INK};
use super::text::{Text, escape};

/// Units of the drawing in a point: plotters has whole coordinates only.
const FINE: f64 = 100.0;

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Colour.
    pub colour: RGBColor,
    /// Width [pt].
    pub width: f64,
    /// How it is broken.
    pub dash: Dash,
}

/// How a line is broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
    /// Not at all.
    None,
    /// Into dashes.
    Usual,
    /// Into long dashes.
    Long,
    /// Into short dashes.
    Short,
    /// Into dashes and dots by turns.
    Mixed,
    /// Into dots.
    Dotted,
}

impl Dash {
    /// The attribute of an SVG group whose lines are broken so, in units of the drawing.
    fn attribute(self) -> &'static str {
        match self {
            Dash::None => "",
            Dash::Usual => " stroke-dasharray=\"350 220\"",
            Dash::Long => " stroke-dasharray=\"600 220\"",
            Dash::Short => " stroke-dasharray=\"220 150\"",
            Dash::Mixed => " stroke-dasharray=\"500 180 100 180\"",
            Dash::Dotted => " stroke-dasharray=\"100 160\"",
        }
    }
}

impl Stroke {
    /// An unbroken line.
    pub fn solid(colour: RGBColor, width: f64) -> Stroke {
        Stroke { colour, width, dash: Dash::None }
    }

    /// A broken line.
    pub const fn dashed(colour: RGBColor, width: f64) -> Stroke {
        Stroke { colour, width, dash: Dash::Usual }
    }
}

/// Which end of a label its position is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// The beginning.
    Start,
    /// The middle.
    Middle,
    /// The end.
    End,
}

/// The direction a label reads in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// From left to right.
    Across,
    /// From bottom to top.
    Upward,
}

/// A page being drawn.
pub struct Canvas {
    width: f64,
    height: f64,
    body: String,
    clips: usize,
    missing: Option<(char, String)>,
    fault: Option<String>,
    /// What of the request does not fit the page.
    pub unfit: Option<String>,
    /// What is drawn, if it is to be told.
    pub data: Option<Data>,
    /// What of the request is left out, a sentence each.
    pub notes: Vec<String>,
}

/// A finished page.
pub struct Drawn {
    /// What it shows.
    pub about: String,
    /// The drawing.
    pub svg: String,
    /// A character that the font lacks, and the label it stands in.
    pub missing: Option<(char, String)>,
    /// What plotters could not draw.
    pub fault: Option<String>,
    /// What of the request does not fit the page.
    pub unfit: Option<String>,
    /// What is drawn, if it is to be told.
    pub data: Option<Data>,
    /// What it leaves out or takes for something else, a sentence each.
    pub notes: Vec<String>,
}

impl Drawn {
    /// The same with a note, if there is one.
    pub fn noting(mut self, note: Option<String>) -> Drawn {
        self.notes.extend(note);
        self
    }
}

impl Canvas {
    /// An empty page [pt].
    pub fn new(width: f64, height: f64) -> Canvas {
        let (missing, fault, unfit, data) = (None, None, None, None);
        let (body, notes) = (String::new(), Vec::new());
        Canvas { width, height, body, clips: 0, missing, fault, unfit, data, notes }
    }

    /// Runs `draw` on a plotters area over the whole page; `attributes` hold for all its shapes.
    fn layer<F>(&mut self, attributes: &str, draw: F)
    where
        F: FnOnce(&Area<'_>) -> Result<(), DrawingAreaErrorKind<std::io::Error>>,
    {
        let mut svg = String::new();
        let area = SVGBackend::with_string(&mut svg, self.size()).into_drawing_area();
        if let Err(error) = draw(&area).and_then(|()| area.present()) {
            self.fault.get_or_insert(error.to_string());
        }
        drop(area);
        // plotters wraps each layer in an `svg` element of its own; only the shapes are kept.
        let begin = svg.find('\n').map_or(0, |at| at + 1);
        let end = svg.rfind("</svg>").unwrap_or(svg.len());
        let _ = write!(self.body, "<g{attributes}>\n{}</g>\n", &svg[begin..end]);
    }

    /// Width and height of the page [pt].
    pub fn extent(&self) -> [f64; 2] {
        [self.width, self.height]
    }

    fn size(&self) -> (u32, u32) {
        ((self.width * FINE).round() as u32, (self.height * FINE).round() as u32)
    }

    /// A line through `points`.
    pub fn line(&mut self, points: &[Point], stroke: Stroke) {
        let path: Vec<_> = points.iter().copied().map(fine).collect();
        self.layer(stroke.dash.attribute(), |area| {
            area.draw(&PathElement::new(path, outline(stroke.colour, stroke.width)))
        });
    }

    /// Separate straight lines.
    pub fn segments(&mut self, segments: &[(Point, Point)], stroke: Stroke) {
        let style = outline(stroke.colour, stroke.width);
        self.layer("", |area| {
            segments.iter().try_for_each(|(from, to)| {
                area.draw(&PathElement::new(vec![fine(*from), fine(*to)], style))
            })
        });
    }

    /// Filled discs of one radius, each with its colour.
    pub fn discs(&mut self, discs: &[(Point, RGBColor)], radius: f64) {
        let radius = (radius * FINE).round() as u32;
        self.layer("", |area| {
            discs.iter().try_for_each(|(centre, colour)| {
                area.draw(&Circle::new(fine(*centre), radius, colour.filled()))
            })
        });
    }

    /// Rings of one radius.
    pub fn rings(&mut self, centres: &[Point], radius: f64, stroke: Stroke) {
        let radius = (radius * FINE).round() as u32;
        let style = outline(stroke.colour, stroke.width);
        self.layer("", |area| {
            centres.iter().try_for_each(|at| area.draw(&Circle::new(fine(*at), radius, style)))
        });
    }

    /// A filled polygon.
    pub fn polygon(&mut self, corners: &[Point], colour: RGBColor) {
        let corners: Vec<_> = corners.iter().copied().map(fine).collect();
        self.layer("", |area| area.draw(&Polygon::new(corners, colour.filled())));
    }

    /// A filled rectangle.
    pub fn fill(&mut self, rect: Rect, colour: RGBColor) {
        let (from, to) = (fine((rect.left, rect.top)), fine((rect.right, rect.bottom)));
        self.layer("", |area| area.draw(&Rectangle::new([from, to], colour.filled())));
    }

    /// The sides of a rectangle.
    pub fn frame(&mut self, rect: Rect, stroke: Stroke) {
        // plotters gives rectangles no line width of their own.
        let attributes = format!(" stroke-width=\"{}\"", (stroke.width * FINE).round());
        let (from, to) = (fine((rect.left, rect.top)), fine((rect.right, rect.bottom)));
        let style = outline(stroke.colour, stroke.width);
        self.layer(&attributes, |area| area.draw(&Rectangle::new([from, to], style)));
    }

    /// A raster stretched over `rect`; cells keep their edges, clouds may be smoothed.
    pub fn image(&mut self, rect: Rect, raster: &Raster) {
        let bytes = match raster.png() {
            Ok(bytes) => bytes,
            Err(error) => {
                self.fault.get_or_insert(error);
                return;
            }
        };
        let rendering = if raster.smooth { "auto" } else { "pixelated" };
        let (left, top) = fine((rect.left, rect.top));
        let (right, bottom) = fine((rect.right, rect.bottom));
        let _ = writeln!(
            self.body,
            "<image x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" \
             preserveAspectRatio=\"none\" style=\"image-rendering:{rendering}\" \
             href=\"data:image/png;base64,{}\"/>",
            right - left,
            bottom - top,
            base64::engine::general_purpose::STANDARD.encode(bytes)
        );
    }

    /// What `draw` draws, cut off at `rect`.
    pub fn clipped(&mut self, rect: Rect, draw: impl FnOnce(&mut Canvas)) {
        self.clips += 1;
        let (left, top) = fine((rect.left, rect.top));
        let (right, bottom) = fine((rect.right, rect.bottom));
        let _ = writeln!(
            self.body,
            "<clipPath id=\"clip{0}\"><rect x=\"{left}\" y=\"{top}\" width=\"{1}\" \
             height=\"{2}\"/></clipPath>\n<g clip-path=\"url(#clip{0})\">",
            self.clips,
            right - left,
            bottom - top
        );
        draw(self);
        self.body.push_str("</g>\n");
    }

    /// A label in black whose baseline passes through `at`.
    pub fn text(&mut self, text: &Text, at: Point, size: f64, anchor: Anchor) {
        self.label(text, at, size, anchor, Reading::Across, INK);
    }

    /// A label in any colour and direction whose baseline passes through `at`.
    pub fn label(
        &mut self,
        text: &Text,
        at: Point,
        size: f64,
        anchor: Anchor,
        reading: Reading,
        colour: RGBColor,
    ) {
        if let (Some(character), None) = (text.missing_glyph(), &self.missing) {
            self.missing = Some((character, text.content()));
        }
        let (x, y) = fine(at);
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let turn = match reading {
            Reading::Across => String::new(),
            Reading::Upward => format!(" transform=\"rotate(-90 {x} {y})\""),
        };
        let RGBColor(red, green, blue) = colour;
        let _ = writeln!(
            self.body,
            "<text x=\"{x}\" y=\"{y}\" font-family=\"{FAMILY}\" font-size=\"{}\" \
             text-anchor=\"{anchor}\" fill=\"#{red:02x}{green:02x}{blue:02x}\" \
             xml:space=\"preserve\"{turn}>{}</text>",
            size * FINE,
            text.spans(size * FINE)
        );
    }

    /// The page as one SVG; `about` says what it shows.
    pub fn finish(self, about: &str) -> Drawn {
        let (width, height) = self.size();
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}pt\" height=\"{}pt\" \
             viewBox=\"0 0 {width} {height}\" stroke-linejoin=\"round\">\n<desc>{}</desc>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            f64::from(width) / FINE,
            f64::from(height) / FINE,
            escape(about),
            self.body
        );
        let (about, notes) = (about.to_string(), self.notes);
        let (missing, fault, unfit) = (self.missing, self.fault, self.unfit);
        Drawn { about, svg, missing, fault, unfit, data: self.data, notes }
    }
}

/// A plotters area over the whole page.
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The nearest coordinates of the drawing.
fn fine(point: Point) -> (i32, i32) {
    ((point.0 * FINE).round() as i32, (point.1 * FINE).round() as i32)
}

/// The plotters style of a line.
fn outline(colour: RGBColor, width: f64) -> ShapeStyle {
    colour.stroke_width((width * FINE).round() as u32)
}
