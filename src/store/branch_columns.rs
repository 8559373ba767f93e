//! Columns over one of the dimensions of the branches, and those that every orbit on a branch has.

use ndarray::{ArrayD, IxDyn};

use crate::capsule::branch::Point;
use crate::capsule::{Output, Parameter};
use crate::orbit::matrix::Complex;

use super::{Dataset, Values, Variable};

/// Dimension: the cycles of a period.
pub const CYCLE: &str = "branch_cycle";
/// Dimension: the Floquet multipliers of an orbit.
pub const MULTIPLIER: &str = "branch_multiplier";

/// An orbit on a branch.
pub struct Row<'a> {
    /// Number of the branch.
    pub branch: usize,
    /// The parameter that is followed on it.
    pub along: Parameter,
    /// Period of its orbits [cycles].
    pub period: u64,
    /// The orbit.
    pub point: &'a Point,
}

impl Row<'_> {
    /// Whether every Floquet multiplier lies within the unit circle.
    fn is_stable(&self) -> bool {
        self.point.multipliers.iter().all(|multiplier| multiplier.abs() < 1.0)
    }
}

/// Variables of one dimension, added to a dataset one by one.
pub struct Columns<'d> {
    dataset: &'d mut Dataset,
    dimension: &'static str,
}

impl<'d> Columns<'d> {
    /// Variables over `dimension`.
    pub fn new(dataset: &'d mut Dataset, dimension: &'static str) -> Self {
        Columns { dataset, dimension }
    }

    fn add(&mut self, name: &str, unit: &str, long_name: &str, values: Values) -> &mut Variable {
        let variable = Variable {
            dimensions: vec![self.dimension.to_owned()],
            unit: unit.to_owned(),
            long_name: long_name.to_owned(),
            values,
            flags: Vec::new(),
        };
        self.dataset.variables.entry(name.to_owned()).insert_entry(variable).into_mut()
    }

    /// Measured quantities.
    pub fn reals(
        &mut self,
        name: &str,
        unit: &str,
        long_name: &str,
        values: impl Iterator<Item = f64>,
    ) {
        self.add(name, unit, long_name, Values::Real(line(values)));
    }

    /// Counts and numbers of others.
    pub fn integers(&mut self, name: &str, long_name: &str, values: impl Iterator<Item = i64>) {
        self.add(name, "1", long_name, Values::Integer(line(values)));
    }

    /// Categories, each with its name.
    pub fn flags(
        &mut self,
        name: &str,
        long_name: &str,
        values: impl Iterator<Item = i64>,
        flags: Vec<(i64, String)>,
    ) {
        self.add(name, "1", long_name, Values::Integer(line(values))).flags = flags;
    }

    /// Measured quantities, of which each place has several along `inner`.
    fn rows(
        &mut self,
        (name, unit, long_name): (&str, &str, &str),
        (inner, length): (&str, usize),
        values: Vec<f64>,
    ) {
        let places = self.dataset.coordinate(self.dimension);
        let count = places.map_or(0, |places| places.values.shape()[0]);
        let array = ArrayD::from_shape_vec(IxDyn(&[count, length]), values);
        let values = Values::Real(array.expect("as many values for each place"));
        self.add(name, unit, long_name, values).dimensions.push(inner.to_owned());
    }
}

fn line<T>(values: impl Iterator<Item = T>) -> ArrayD<T> {
    let values: Vec<T> = values.collect();
    ArrayD::from_shape_vec(IxDyn(&[values.len()]), values).expect("a line of values")
}

/// Where orbits lie, and how their variables are called.
pub struct Place {
    /// The dimension.
    pub dimension: &'static str,
    /// What the names of the variables begin with.
    pub prefix: &'static str,
    /// What their meanings end with.
    pub on: &'static str,
}

/// Adds the variables that every orbit on a branch has; a parameter that a branch does not follow is NaN.
pub fn add_points(
    dataset: &mut Dataset,
    Place { dimension, prefix, on }: &Place,
    rows: &[Row<'_>],
    along: &[Parameter],
    outputs: &[Output],
) {
    let named = |what: &str| format!("{prefix}_{what}");
    let length = dataset.coordinate(CYCLE).map_or(0, |cycles| cycles.values.shape()[0]);
    let mut columns = Columns::new(dataset, dimension);
    let own = if *prefix == "branch" { "branch".to_owned() } else { named("branch") };
    columns.integers(&own, "branch that the orbit is on", rows.iter().map(|r| r.branch as i64));
    for &parameter in along {
        let values = rows.iter().map(|row| match row.along == parameter {
            true => row.point.parameter,
            false => f64::NAN,
        });
        let meaning = format!("{} {on}", parameter.meaning());
        let unit = parameter.dimension().unit();
        columns.reals(&named(parameter.symbol()), unit, &meaning, values);
    }
    let periods = rows.iter().map(|row| row.period as i64);
    columns.integers(&named("period"), "period in drive cycles", periods);
    let stable = rows.iter().map(|row| i64::from(row.is_stable()));
    let flags = vec![(0, "unstable".to_owned()), (1, "stable".to_owned())];
    columns.flags(&named("stable"), "whether neighbours approach the orbit", stable, flags);
    let residuals = rows.iter().map(|row| row.point.residual);
    let meaning = "how far the section is from repeating, relative to the motion";
    columns.reals(&named("residual"), "1", meaning, residuals);
    let sequences = rows.iter().map(|row| row.point.sequence as i64);
    columns.integers(&named("sequence"), "which sequence of events of its branch", sequences);
    for &output in outputs {
        let values = rows.iter().map(|row| row.point.measured[output]);
        columns.reals(&named(output.name()), output.unit(), output.meaning(), values);
    }
    add_sections(&mut columns, prefix, rows, length);
    add_multipliers(&mut columns, prefix, rows);
}

/// The section points of one period, padded with NaN up to the longest.
fn add_sections(columns: &mut Columns<'_>, prefix: &str, rows: &[Row<'_>], length: usize) {
    for (i, (name, unit, meaning)) in [
        ("section_r", "m", "relative displacement x1 - x2 at the stroboscopic section"),
        ("section_y1", "m/s", "velocity of the mass at the stroboscopic section"),
        ("section_y2", "m/s", "velocity of the capsule at the stroboscopic section"),
    ]
    .into_iter()
    .enumerate()
    {
        let of_row = |row: &Row<'_>| {
            let section = &row.point.section;
            (0..length).map(|n| section.get(n).map_or(f64::NAN, |it| it[i])).collect::<Vec<_>>()
        };
        let values = rows.iter().flat_map(of_row).collect();
        columns.rows((&format!("{prefix}_{name}"), unit, meaning), (CYCLE, length), values);
    }
}

fn add_multipliers(columns: &mut Columns<'_>, prefix: &str, rows: &[Row<'_>]) {
    let mut add = |part: &str, meaning: &str, of: fn(&Complex) -> f64| {
        let name = format!("{prefix}_multiplier_{part}");
        let meaning = format!("{meaning} part of the Floquet multipliers of the period");
        let values = rows.iter().flat_map(|row| row.point.multipliers.iter().map(of)).collect();
        columns.rows((&name, "1", &meaning), (MULTIPLIER, 3), values);
    };
    add("real", "real", |multiplier| multiplier.re);
    add("imag", "imaginary", |multiplier| multiplier.im);
}
