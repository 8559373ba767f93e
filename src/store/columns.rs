//! The columns of a table in a dataset, made of the rows of the table.

use ndarray::{ArrayD, IxDyn};

use super::catalogue::Entry;
use super::{Dataset, Values};

/// The rows of a table, of which columns are put into a dataset.
pub(super) struct Columns<'a, R> {
    /// Where the columns go.
    pub dataset: &'a mut Dataset,
    /// The rows.
    pub rows: &'a [R],
}

impl<R> Columns<'_, R> {
    /// Puts a column of counts, of categories or of the numbers of others.
    pub fn integers(&mut self, entry: Entry, of: impl Fn(&R) -> i64) {
        self.dataset.put_column(entry, Values::integers(self.rows.iter().map(of).collect()));
    }

    /// Puts a column of quantities.
    pub fn reals(&mut self, entry: Entry, of: impl Fn(&R) -> f64) {
        self.dataset.put_column(entry, Values::reals(self.rows.iter().map(of).collect()));
    }

    /// Puts a column of which each row has `width` quantities.
    pub fn several(&mut self, entry: Entry, width: usize, of: impl Fn(&R, usize) -> f64) {
        let mut numbers = Vec::with_capacity(self.rows.len() * width);
        for row in self.rows {
            numbers.extend((0..width).map(|at| of(row, at)));
        }
        let shape = IxDyn(&[self.rows.len(), width]);
        let array = ArrayD::from_shape_vec(shape, numbers).expect("as many in each row");
        self.dataset.put_column(entry, Values::Real(array));
    }
}
