//! The columns that every orbit on a branch has, at the points of the branches and at their special points.

use super::Dataset;
use super::catalogue::{BRANCH_CYCLE, Entry, OrbitColumns, Place, section};
use super::columns::Columns;
use crate::description::{Output, Parameter};
use crate::motion::branch::Point;

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

/// The orbits at one place of the branches, and how their columns are called there.
pub struct OrbitTable<'a> {
    /// The place.
    pub place: Place,
    /// The columns that no other variable is called after.
    pub own: &'a OrbitColumns,
    /// The orbits.
    pub rows: &'a [Row<'a>],
}

impl OrbitTable<'_> {
    /// Adds the columns of the orbits; a parameter that does not vary on a branch is NaN.
    pub fn add(&self, dataset: &mut Dataset, along: &[Parameter], outputs: &[Output]) {
        let OrbitTable { place, own, rows } = *self;
        let mut columns = Columns { dataset, rows };
        columns.integers(own.branch, |row| row.branch as i64);
        columns.integers(own.period, |row| row.period as i64);
        columns.integers(own.stable, |row| i64::from(row.is_stable()));
        columns.integers(own.sequence, |row| row.point.sequence as i64);
        columns.reals(own.residual, |row| row.point.residual);
        for &parameter in along {
            let entry = place.of(Entry::of_parameter(parameter));
            columns.reals(entry, |row| match row.along == parameter {
                true => row.point.parameter,
                false => f64::NAN,
            });
        }
        for &output in outputs {
            let entry = place.of(Entry::of_output(output));
            columns.reals(entry, |row| row.point.measured[output]);
        }
        self.add_sections(&mut columns);
        self.add_multipliers(&mut columns);
    }

    /// The section points of one period, padded with NaN up to the longest.
    fn add_sections(&self, columns: &mut Columns<'_, Row<'_>>) {
        let cycles = columns.dataset.coordinate(BRANCH_CYCLE.name);
        let length = cycles.map_or(0, |cycles| cycles.values.shape()[0]);
        for (i, entry) in section(columns.dataset.model()).into_iter().enumerate() {
            columns.several(self.place.of(entry), length, |row, cycle| {
                row.point.section.get(cycle).map_or(f64::NAN, |it| it[i])
            });
        }
    }

    fn add_multipliers(&self, columns: &mut Columns<'_, Row<'_>>) {
        let count = columns.dataset.model().section.len();
        let [real, imaginary] = self.own.multipliers;
        columns.several(real, count, |row, at| row.point.multipliers[at].re);
        columns.several(imaginary, count, |row, at| row.point.multipliers[at].im);
    }
}
