//! The colours of cases: by a quantity with a bar, or by kinds with a list.

use plotters::style::RGBColor;

use super::canvas::Canvas;
use super::category::{self, Kinds};
use super::colour::Colours;
use super::data::Value;
use super::error::FigureError;
use super::geometry::Rect;
use super::header::Mark;
use super::inferred;
use super::outcome::{Outcomes, told_of_missing};
use super::raster::Fill;
use super::style::{INFERRED, INFINITE, NOT_YET};
use super::text::Text;
use super::view::View;

/// What follows the name of a quantity whose difference between two sweeps is shown.
const DIFFERENCE: &str = ", downward − upward";

/// How a case was come by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ComeBy {
    /// It was computed.
    Computed,
    /// It is inferred from those around it.
    Inferred,
    /// It is not computed yet.
    NotYet,
}

impl ComeBy {
    /// That of each of so many cases.
    fn all(outcomes: &Outcomes<'_>, cases: usize) -> Vec<ComeBy> {
        let each = inferred::inferred(outcomes, cases).into_iter().enumerate();
        let each = each.map(|(case, is_inferred)| match is_inferred {
            true => ComeBy::Inferred,
            false if outcomes.missing(case) => ComeBy::NotYet,
            false => ComeBy::Computed,
        });
        each.collect()
    }

    /// That of the difference of two cases.
    fn of_both(self, other: ComeBy) -> ComeBy {
        match [self, other].contains(&ComeBy::NotYet) {
            true => ComeBy::NotYet,
            false if self == ComeBy::Computed => other,
            false => self,
        }
    }
}

/// How cases are coloured.
pub enum Paint {
    /// By their values, with how each case was come by, which tells why it may have none.
    Numbers(Option<Colours>, Vec<f64>, Vec<ComeBy>),
    /// By their kinds.
    Kinds(Kinds),
}

impl Paint {
    /// The colours of the cases of one panel after the other, of which each has so many over its axes `free`, by an output, by
    /// kinds, or by an axis; they span the values of the cases that are seen.
    pub fn of(
        view: &View<'_>,
        panels: &[View<'_>],
        name: &str,
        free: &[&str],
        seen: &[bool],
    ) -> Result<Paint, FigureError> {
        let cases = seen.len();
        if category::is_sorted(view, name) {
            return Ok(Paint::Kinds(Kinds::of(view, panels, name, free)?));
        }
        let (mut all, mut come_by) = (Vec::new(), Vec::new());
        for panel in panels {
            let values = numbers(panel, name, free)?;
            if values.len() != cases {
                let why = format!("`{name}` has several values per case; one tells a colour");
                return Err(view.unfit(why));
            }
            all.extend(values);
            come_by.extend(ComeBy::all(&Outcomes::over(panel, free)?, cases));
        }
        let is_axis = view.dataset.variable(name).is_none();
        let quantity = view.quantity(name);
        let colours = match is_axis {
            true => {
                let values = view.axis_values(name)?;
                let values: Vec<f64> = values.iter().map(|it| it * quantity.factor).collect();
                Some(Colours::for_axis(&values, quantity))
            }
            false => Colours::for_values(&of_seen(&all, seen), quantity),
        };
        Ok(Paint::Numbers(colours, all, come_by))
    }

    /// The colours of the differences of two sweeps, the second less the first.
    pub fn of_difference(
        [first, second]: [&View<'_>; 2],
        name: &str,
        free: &[&str],
        seen: &[bool],
    ) -> Result<Paint, FigureError> {
        let cases = seen.len();
        if category::is_sorted(first, name) {
            return Ok(Paint::Kinds(Kinds::of_difference([first, second], name, free)?));
        }
        let [of_first, of_second] = [numbers(first, name, free)?, numbers(second, name, free)?];
        let values: Vec<f64> = of_second.iter().zip(&of_first).map(|(b, a)| b - a).collect();
        let come_by = [first, second]
            .map(|view| Ok::<_, FigureError>(ComeBy::all(&Outcomes::over(view, free)?, cases)));
        let [a, b] = come_by;
        let come_by = a?.into_iter().zip(b?).map(|(a, b)| a.of_both(b)).collect();
        let quantity = first.quantity(name).followed_by(DIFFERENCE);
        Ok(Paint::Numbers(Colours::for_values(&of_seen(&values, seen), quantity), values, come_by))
    }

    /// The colour of a case; none where it has no value.
    pub fn colour(&self, case: usize) -> Option<RGBColor> {
        match self {
            Paint::Numbers(_, values, _) if values[case].is_infinite() => Some(INFINITE),
            Paint::Numbers(_, values, come_by) if values[case].is_nan() => match come_by[case] {
                ComeBy::Inferred => Some(INFERRED),
                ComeBy::NotYet => Some(NOT_YET),
                ComeBy::Computed => None,
            },
            Paint::Numbers(colours, values, _) => {
                colours.as_ref().filter(|it| it.has(values[case])).map(|it| it.of(values[case]))
            }
            Paint::Kinds(kinds) => kinds.colour(case),
        }
    }

    /// What the colours tell, with its unit.
    pub fn told(&self) -> String {
        match self {
            Paint::Numbers(colours, ..) => colours.as_ref().map_or(String::new(), Colours::told),
            Paint::Kinds(kinds) => kinds.told(),
        }
    }

    /// What the colour of a case tells.
    pub fn value(&self, case: usize) -> Value {
        match self {
            Paint::Numbers(_, values, _) => Value::Number(values[case]),
            Paint::Kinds(kinds) => kinds.name(case).map_or(Value::None, Value::Name),
        }
    }

    /// What the colour of a case tells as a number: that of its kind where there are kinds; NaN where it has none.
    pub fn number(&self, case: usize) -> f32 {
        match self {
            Paint::Numbers(_, values, _) => values[case] as f32,
            Paint::Kinds(kinds) => kinds.place(case).map_or(f32::NAN, f32::from),
        }
    }

    /// Room beside frames of this height for the bar or the list of kinds [pt].
    pub fn room(&self, height: f64) -> f64 {
        match self {
            Paint::Numbers(colours, ..) => colours.as_ref().map_or(0.0, |it| it.room(height)),
            Paint::Kinds(kinds) => kinds.room(),
        }
    }

    /// Height that the list of kinds needs beside frames [pt]; a bar needs none.
    pub fn least_height(&self) -> f64 {
        match self {
            Paint::Numbers(..) => 0.0,
            Paint::Kinds(kinds) => kinds.height(),
        }
    }

    /// Draws the bar or the list of kinds beside a frame.
    pub fn explain(&self, canvas: &mut Canvas, frame: Rect) {
        match self {
            Paint::Numbers(Some(colours), ..) => colours.draw_bar(canvas, frame),
            Paint::Numbers(None, ..) => {}
            Paint::Kinds(kinds) => kinds.draw_legend(canvas, frame),
        }
    }

    /// Leaves kinds out of their list of which no case is seen.
    pub fn list(&mut self, seen: impl Fn(usize) -> bool) {
        if let Paint::Kinds(kinds) = self {
            kinds.list(seen);
        }
    }

    /// The entries that the colour bar does not explain, for the cases that are seen.
    pub fn legend(&self, seen: impl Fn(usize) -> bool) -> Vec<(Mark, Text)> {
        let (colours, values, come_by) = match self {
            Paint::Numbers(colours, values, come_by) => (colours, values, come_by),
            Paint::Kinds(kinds) => {
                let words = kinds.told_of_missing(seen);
                return words.map(|it| (Mark::Nothing, Text::plain(&it))).into_iter().collect();
            }
        };
        let cases = values.iter().zip(come_by).enumerate().filter(|(case, _)| seen(*case));
        let cases: Vec<(&f64, ComeBy)> = cases.map(|(_, (value, by))| (value, *by)).collect();
        let mut legend = Vec::new();
        if cases.iter().any(|(value, _)| value.is_infinite()) {
            legend.push((Mark::Patch(INFINITE), Text::plain("infinite")));
        }
        let without: Vec<ComeBy> =
            cases.iter().filter(|(value, _)| value.is_nan()).map(|(_, by)| *by).collect();
        if without.contains(&ComeBy::Inferred) {
            legend.push((Mark::Patch(INFERRED), Text::plain("inferred, not computed")));
        }
        let not_yet = without.iter().filter(|it| **it == ComeBy::NotYet).count();
        let not_yet = told_of_missing(not_yet, cases.len());
        legend.extend(not_yet.map(|words| (Mark::Patch(NOT_YET), Text::plain(&words))));
        let has_none = without.contains(&ComeBy::Computed);
        let some_have_no_place = colours.as_ref().is_some_and(|colours| {
            cases.iter().any(|(it, _)| it.is_finite() && !colours.has(**it))
        });
        let words = match (has_none, some_have_no_place) {
            (true, true) => "no value, or not above zero",
            (false, true) => "not above zero",
            _ => "no value",
        };
        if has_none || words != "no value" {
            legend.push((Mark::Filled(Fill::NO_VALUE), Text::plain(words)));
        }
        legend
    }
}

/// The values of the cases that are seen of each panel.
fn of_seen(values: &[f64], seen: &[bool]) -> Vec<f64> {
    let values = values.iter().zip(seen.iter().cycle());
    values.filter(|(_, seen)| **seen).map(|(value, _)| *value).collect()
}

/// The numbers of cases over the axes `free` in the unit shown; cases that failed have none.
fn numbers(view: &View<'_>, name: &str, free: &[&str]) -> Result<Vec<f64>, FigureError> {
    let factor = view.quantity(name).factor;
    let outcomes = Outcomes::over(view, free)?;
    let values = view.parameter(name, free)?.into_iter().enumerate();
    let numbers = values.map(|(case, value)| match outcomes.failed(case) {
        true => f64::NAN,
        false => value * factor,
    });
    Ok(numbers.collect())
}
