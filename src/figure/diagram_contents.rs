//! What a diagram shows of the results: cases, branches, symbols, ramps and measured points.

use plotters::style::RGBColor;

use super::branch_lines::BranchLines;
use super::cloud::Dot;
use super::data::Value;
use super::measured::MeasuredPoints;
use super::paint::Paint;
use super::ramp_points::RampPoints;
use super::style::UNDECIDED_DOT;
use super::thinned::Placed;
use super::view::View;

/// The cases that a diagram shows.
pub struct Cases<'a> {
    /// The name of the axis along the abscissa.
    pub axis: &'a str,
    /// The axes over which the cases are taken, that of the abscissa first.
    pub free: Vec<&'a str>,
    /// The values of the abscissa, in the unit of the figure.
    pub values: Vec<f64>,
    /// Cases at each value.
    pub per_value: usize,
}

impl Cases<'_> {
    /// How many cases there are.
    pub fn count(&self) -> usize {
        self.values.len() * self.per_value
    }
}

/// What a diagram shows of the results.
pub struct Contents<'a> {
    /// The cases.
    pub cases: Cases<'a>,
    /// What is shown of them, a panel each.
    pub outputs: Vec<String>,
    /// The lines of branches, by output.
    pub lines: Vec<BranchLines>,
    /// The colours of the cases, where the request names what tells them.
    pub paint: Option<Paint>,
    /// The points, by output and by sort.
    pub clouds: Vec<Vec<Vec<Dot>>>,
    /// The symbols of events, by output; empty where there are none.
    pub symbols: Vec<Vec<Placed>>,
    /// The ramps along the axis of the cases.
    pub ramps: RampPoints,
    /// The measured points.
    pub measured: MeasuredPoints,
}

impl<'a> Contents<'a> {
    /// The branches along the axis of the cases; of the cases themselves nothing yet.
    pub fn of_branches(view: &View<'_>, cases: Cases<'a>, outputs: Vec<String>) -> Contents<'a> {
        let lines =
            outputs.iter().map(|output| BranchLines::shown(view, cases.axis, output)).collect();
        let ramps = RampPoints::over(view, cases.axis, &outputs);
        let measured = MeasuredPoints::none(&outputs);
        let (clouds, symbols) = (Vec::new(), Vec::new());
        Contents { cases, outputs, lines, paint: None, clouds, symbols, ramps, measured }
    }

    /// The points of a case, which has a part of the `numbers` of all; `usual` is their colour where the request names none.
    pub fn dots(&self, case: usize, numbers: &[f64], usual: RGBColor) -> Vec<Dot> {
        let Cases { values, per_value, .. } = &self.cases;
        let per_case = numbers.len().checked_div(self.cases.count()).unwrap_or(0);
        let own = &numbers[case * per_case..(case + 1) * per_case];
        let finite: Vec<f64> = own.iter().copied().filter(|it| it.is_finite()).collect();
        let crowding = (finite.len() * values.len()) as f64;
        let painted = self.paint.as_ref().map(|it| it.colour(case).unwrap_or(UNDECIDED_DOT));
        let (x, colour) = (values[case / per_value], painted.unwrap_or(usual));
        finite.into_iter().map(|y| Dot { at: (x, y), colour, crowding, case }).collect()
    }

    /// What the colour of a case tells.
    pub fn value(&self, case: usize) -> Value {
        self.paint.as_ref().map_or(Value::None, |paint| paint.value(case))
    }

    /// All that stands along the ordinate of an output, by its place among them.
    pub fn ordinates(&self, index: usize) -> Vec<f64> {
        let dots = self.clouds[index].iter().flatten().map(|dot| dot.at.1);
        dots.chain(self.lines[index].places().map(|at| at.1))
            .chain(self.symbols.get(index).into_iter().flatten().map(|it| it.1.1))
            .chain(self.ramps.ordinates(index))
            .chain(self.measured.ordinates(index))
            .collect()
    }

    /// How far branches, ramps and measured points reach along the abscissa.
    pub fn reached(&self) -> Vec<f64> {
        let of_branches = self.lines.iter().flat_map(BranchLines::places).map(|at| at.0);
        of_branches.chain(self.ramps.abscissae()).chain(self.measured.abscissae()).collect()
    }
}

/// What a diagram shows, and what its points are.
pub struct Sorted<'a> {
    /// What it shows.
    pub contents: Contents<'a>,
    /// What the points of each sort are, and their colour where the request names none.
    pub sorts: Vec<(String, RGBColor)>,
    /// The ranges of the abscissa in which attractors coexist, in the unit of the figure.
    pub windows: Vec<[f64; 2]>,
    /// Which events are not marked, in words.
    pub left_out: Option<String>,
}
