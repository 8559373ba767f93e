//! The columns that every orbit on a branch has, at the points of the branches and at their special points.

use ndarray::{ArrayD, IxDyn};

use super::catalogue::{BRANCH_CYCLE, Entry, OrbitColumns, Place, section};
use super::{Dataset, Values};
use crate::description::{Output, Parameter};
use crate::motion::branch::Point;
use crate::orbit::matrix::Complex;

/// An orbit on a branch.
pub struct Row<'a> {
    /// Number of the branch.
    pub branch: usize,
    /// The parameter in which it is continued.
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

/// Adds the columns of every orbit on a branch at a `place`; a parameter that does not vary on a branch is NaN.
pub fn add_points(
    dataset: &mut Dataset,
    (place, own): (Place, &OrbitColumns),
    rows: &[Row<'_>],
    along: &[Parameter],
    outputs: &[Output],
) {
    let mut whole = |entry: Entry, of: fn(&Row<'_>) -> i64| {
        dataset.put_column(entry, Values::integers(rows.iter().map(of).collect()));
    };
    whole(own.branch, |row| row.branch as i64);
    whole(own.period, |row| row.period as i64);
    whole(own.stable, |row| i64::from(row.is_stable()));
    whole(own.sequence, |row| row.point.sequence as i64);
    let mut real = |entry: Entry, of: &dyn Fn(&Row<'_>) -> f64| {
        dataset.put_column(entry, Values::reals(rows.iter().map(of).collect()));
    };
    real(own.residual, &|row| row.point.residual);
    for &parameter in along {
        real(place.of(Entry::of_parameter(parameter)), &|row| match row.along == parameter {
            true => row.point.parameter,
            false => f64::NAN,
        });
    }
    for &output in outputs {
        real(place.of(Entry::of_output(output)), &|row| row.point.measured[output]);
    }
    add_sections(dataset, place, rows);
    add_multipliers(dataset, own, rows);
}

/// The section points of one period, padded with NaN up to the longest.
fn add_sections(dataset: &mut Dataset, place: Place, rows: &[Row<'_>]) {
    let cycles = dataset.coordinate(BRANCH_CYCLE.name);
    let length = cycles.map_or(0, |cycles| cycles.values.shape()[0]);
    for (i, entry) in section(dataset.model()).into_iter().enumerate() {
        let of_row = |row: &Row<'_>| {
            let section = &row.point.section;
            (0..length).map(|n| section.get(n).map_or(f64::NAN, |it| it[i])).collect::<Vec<_>>()
        };
        let values = rows.iter().flat_map(of_row).collect();
        dataset.put_column(place.of(entry), table(rows.len(), length, values));
    }
}

fn add_multipliers(dataset: &mut Dataset, own: &OrbitColumns, rows: &[Row<'_>]) {
    let parts: [fn(&Complex) -> f64; 2] = [|multiplier| multiplier.re, |multiplier| multiplier.im];
    for (entry, part) in own.multipliers.into_iter().zip(parts) {
        let values = rows.iter().flat_map(|row| row.point.multipliers.iter().map(part)).collect();
        let count = dataset.model().section.len();
        dataset.put_column(entry, table(rows.len(), count, values));
    }
}

/// Several reals at each of `count` places.
fn table(count: usize, width: usize, values: Vec<f64>) -> Values {
    let array = ArrayD::from_shape_vec(IxDyn(&[count, width]), values);
    Values::Real(array.expect("as many values at each place"))
}
