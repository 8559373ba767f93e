//! Sobol indices of outputs by the quantities that are drawn, with their intervals: a panel for each output.

use plotters::style::RGBColor;

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn, Stroke};
use super::data::Value;
use super::error::FigureError;
use super::header::{Entry, Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::page::{PageRequest, PanelRequest, in_rows, letter};
use super::panel::Panel;
use super::quantity::Quantity;
use super::scale::Scale;
use super::style::{BLUE, CURVE_WIDTH, FAINT_INK, MINOR_WIDTH, PAPER, VERMILION};
use super::text::Text;
use super::ticks::significant;
use super::view::View;
use crate::campaign::{
    NO_DESIGN, OutputSensitivity, Resampling, SobolIndex, SobolIndices, output_sensitivity,
};
use crate::description::Description;
use crate::store::catalogue::{DRAW, OUTCOME};
use crate::store::{Column, Design};
use crate::study::Drawing;

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// Height of the frame for each quantity, and beside them [pt].
const HEIGHT: [f64; 2] = [21.0, 10.0];
/// Panels side by side at most.
const COLUMNS: usize = 2;
/// How far both indices of a quantity are from its middle, in steps from one quantity to the next.
const APART: f64 = 0.16;
/// Radius of the points [pt].
const RADIUS: f64 = 2.1;
/// Half the height of the ends of intervals [pt].
const CAP: f64 = 1.8;

/// What the indices are of: the outputs and the outcomes.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    Names::of([OUTCOME]).and_named(outputs(drawing, model))
}

/// The names of the outputs that are drawn: the main one by default.
fn outputs(drawing: &Drawing, model: &'static Description) -> Vec<String> {
    match drawing.of.is_empty() {
        true => vec![model.main_output().name().to_owned()],
        false => drawing.of.clone(),
    }
}

/// Draws the indices that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let Some(design) = Design::of(view.dataset) else {
        return Err(view.unfit(NO_DESIGN));
    };
    let names = outputs(view.drawing, view.model());
    let shown = names.iter().map(|name| Shown::of(view, &design, name));
    let shown = shown.collect::<Result<Vec<Shown>, FigureError>>()?;
    let signs: Vec<String> =
        design.quantities.iter().map(|it| view.quantity(it).sign().to_owned()).collect();
    let requests = (0..shown.len()).map(|number| request(&shown, number, &signs)).collect();
    let rows = in_rows(requests, COLUMNS);
    let [each, beside] = HEIGHT;
    let page = PageRequest::of_rows(view.drawing, rows, each * signs.len() as f64 + beside);
    let (mut canvas, panels) = page.lay_out();
    for (panel, shown) in panels.iter().flatten().zip(&shown) {
        shown.draw(&mut canvas, panel, &design.quantities);
        panel.finish(&mut canvas);
    }
    canvas.notes.extend(shown.iter().flat_map(Shown::notes));
    let about = format!("Sobol indices of {}", names.join(", "));
    Ok(canvas.finish(&format!("{about} over {}", design.quantities.join(", "))))
}

/// What a panel shows.
struct Shown {
    /// The output.
    quantity: Quantity,
    /// What was found of it.
    found: OutputSensitivity,
}

/// One of both kinds of index.
#[derive(Debug, Clone, Copy)]
struct Series {
    /// Its name in the data.
    name: &'static str,
    /// Its name in the legend, with markup.
    sign: &'static str,
    colour: RGBColor,
    /// Whether its points are rings, so that both are told apart without colours.
    is_open: bool,
    /// How far it stands from the middle of a quantity.
    offset: f64,
    /// The indices of an output.
    of: fn(&SobolIndices) -> &[SobolIndex],
}

/// Both, as they stand from above.
const SERIES: [Series; 2] = [
    Series {
        name: "S1",
        sign: "first order *S*_{1}",
        colour: BLUE,
        is_open: false,
        offset: -APART,
        of: |it| &it.first,
    },
    Series {
        name: "ST",
        sign: "total order *S*_{T}",
        colour: VERMILION,
        is_open: true,
        offset: APART,
        of: |it| &it.total,
    },
];

impl Shown {
    /// The indices of an output by its name.
    fn of(view: &View<'_>, design: &Design, name: &str) -> Result<Shown, FigureError> {
        let cases = [DRAW.name];
        let values: Vec<f64> = view.take(name, &cases)?.into_iter().collect();
        let outcomes = Column {
            values: view.take(OUTCOME.name, &cases)?.into_iter().collect(),
            unit: OUTCOME.unit.to_owned(),
            flags: view.flags(OUTCOME.name).to_vec(),
        };
        let found = output_sensitivity(&values, &outcomes, design, Resampling::default());
        Ok(Shown { quantity: view.quantity(name), found })
    }

    /// What stands above its panel: the output, and the sum of the first order.
    fn heading(&self) -> Text {
        let output = self.quantity.name().clone();
        let after = match &self.found.indices {
            Ok(it) => {
                let SobolIndex { value, half_width } = it.first_sum;
                let [value, half_width] = [value, half_width].map(|it| format!("{it:.2}"));
                format!(": Σ *S*_{{1}} = {value} ± {half_width}").replace(' ', "\u{a0}")
            }
            Err(why) => format!(": {}", why.reason()),
        };
        let left_out = match self.found.rows_left_out {
            0 => String::new(),
            some => format!("; {some} of {} base samples left out", self.found.rows + some),
        };
        output.then(Text::markup(&after.replacen(":\u{a0}", ": ", 1))).then(Text::plain(&left_out))
    }

    /// What is left out, and what stands for no single motion.
    fn notes(&self) -> Vec<String> {
        let OutputSensitivity { rows, rows_left_out, aperiodic, .. } = self.found;
        let name = &self.quantity.key;
        let left_out = (rows_left_out > 0).then(|| {
            let all = rows + rows_left_out;
            format!("{name}: {rows_left_out} of {all} base samples are left out, as not all of their cases have a value")
        });
        let aperiodic = (aperiodic > 0).then(|| {
            format!("{name}: {aperiodic} cases do not repeat; their values are means with standard errors, whose variance is in each total index")
        });
        left_out.into_iter().chain(aperiodic).collect()
    }

    /// The ends of all intervals.
    fn ends(&self) -> Vec<f64> {
        let Ok(indices) = &self.found.indices else { return Vec::new() };
        let all = SERIES.iter().flat_map(|it| (it.of)(indices));
        all.flat_map(|it| [it.value - it.half_width, it.value + it.half_width]).collect()
    }

    /// Draws the points of each quantity with their intervals.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel, names: &[String]) {
        let [low, high] = [-0.5, names.len() as f64 - 0.5];
        for at in [0.0, 1.0] {
            panel.curve(canvas, &[(at, low), (at, high)], Stroke::solid(FAINT_INK, MINOR_WIDTH));
        }
        let Ok(indices) = &self.found.indices else { return };
        for series in SERIES {
            let all = (series.of)(indices).iter().zip(names).enumerate();
            for (place, (index, name)) in all {
                series.draw(canvas, panel, index, place as f64 + series.offset);
                let told =
                    format!("{} of {name}, value: half the width of its interval", series.name);
                let half = Value::Number(index.half_width);
                panel.record_values(canvas, &told, [((index.value, place as f64), half)]);
            }
        }
    }
}

impl Series {
    /// Draws an index at a height, with a line as far as its interval goes.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel, index: &SobolIndex, height: f64) {
        let SobolIndex { value, half_width } = *index;
        let [from, to] = [value - half_width, value + half_width].map(|it| panel.place(it, height));
        let ends = [from, to].map(|(x, y)| ((x, y - CAP), (x, y + CAP)));
        let stroke = Stroke::solid(self.colour, CURVE_WIDTH);
        canvas.segments(&[&[(from, to)][..], &ends].concat(), stroke);
        let point = panel.place(value, height);
        canvas.discs(&[(point, self.colour)], RADIUS);
        if self.is_open {
            canvas.discs(&[(point, PAPER)], RADIUS - CURVE_WIDTH);
        }
    }
}

/// What panel `number` is to show.
fn request(shown: &[Shown], number: usize, signs: &[String]) -> PanelRequest {
    let it = &shown[number];
    // All panels of a figure have one scale, so that they can be compared.
    let ends = shown.iter().flat_map(Shown::ends).chain([0.0, 1.0]);
    let x = AxisRequest::new(Quantity::labelled("Sobol index"), Scale::around(ends, 0.04));
    let legend = if number == 0 { legend() } else { Vec::new() };
    let is_first = number.is_multiple_of(COLUMNS);
    let y = AxisRequest { numbered: is_first, ..AxisRequest::of_words(signs.to_vec()) };
    let is_lowest = number + COLUMNS >= shown.len();
    PanelRequest {
        x: AxisRequest { labelled: is_lowest, ..x },
        y,
        header: Header { letter: letter(number, shown.len()), note: Some(it.heading()), legend },
    }
}

/// What the points mean.
fn legend() -> Vec<Entry> {
    let [first, total] = SERIES;
    let confidence = significant(100.0 * Resampling::default().confidence, 2);
    vec![
        (Mark::Disc(first.colour, RADIUS), Text::markup(first.sign)),
        (Mark::Ring(total.colour, RADIUS), Text::markup(total.sign)),
        (Mark::Nothing, Text::plain(&format!("with {confidence} % intervals"))),
    ]
}
