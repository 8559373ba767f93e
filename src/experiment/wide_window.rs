//! Polynomials through moving windows of many samples, in a time that does not grow with the window.

use nalgebra::{DMatrix, DVector};

use super::polynomial::Polynomial;

/// Neighbouring windows are fitted together whose begins differ by less than this share of their samples: they then have nearly all
/// samples in common, and the polynomials that are orthogonal over all of these are nearly so over each window.
const TOGETHER: usize = 32;
/// A window over whose samples polynomials are this much nearer to dependent is fitted by itself, to keep the digits.
const DEPENDENT: f64 = 1e-5;

/// Shows the polynomial of this order in each window of so many samples to `see`, with the sample that the window begins at, in order.
///
/// # Method
///
/// For each group of neighbouring windows one polynomial is fitted to all their samples. What it leaves is fitted in each window
/// by the normal equations in the polynomials that are orthogonal over the group. Their sums are those over the samples that all windows
/// of the group have, those towards its beginning and those towards its end, which are added sample by sample: nothing is subtracted,
/// so that no digits are lost.
///
/// # Guarantees
///
/// The polynomials of [`Polynomial::fit`], to rounding. For n samples n times 66 terms are added for each sum, whatever the window.
///
/// # Breaks
///
/// Where so many samples crowd in a part of a window that the others do not count beside them, each such window is fitted by itself,
/// in a time that grows with the window.
pub(super) fn polynomials(
    times: &[f64],
    values: &[f64],
    samples: usize,
    order: usize,
    see: &mut impl FnMut(usize, &Polynomial),
) {
    let count = values.len() - samples + 1;
    let together = samples.div_ceil(TOGETHER);
    for first in (0..count).step_by(together) {
        let last = (first + together).min(count) - 1;
        let span = first..last + samples;
        let whole = Polynomial::fit(&times[span.clone()], &values[span], order);
        let basis = vec![0.0; order + 1];
        Group { times, values, samples, begins: [first, last], whole, basis }.show(see);
    }
}

/// Windows that are fitted together.
struct Group<'s> {
    times: &'s [f64],
    values: &'s [f64],
    /// Samples of a window.
    samples: usize,
    /// Where its first and its last window begin.
    begins: [usize; 2],
    /// The polynomial through all their samples.
    whole: Polynomial,
    /// Room for the values of polynomials at a sample.
    basis: Vec<f64>,
}

/// Sums over samples: of products of two polynomials, one triangle, and of what is left times each polynomial.
#[derive(Debug, Clone)]
struct Sums(Vec<f64>);

impl Group<'_> {
    /// Adds a sample to sums.
    fn add(&mut self, sums: &mut Sums, sample: usize) {
        let rest = self.whole.basis(self.times[sample], self.values[sample], &mut self.basis);
        let mut place = 0;
        for (i, a) in self.basis.iter().enumerate() {
            for b in &self.basis[..=i] {
                sums.0[place] += a * b;
                place += 1;
            }
        }
        for (sum, a) in sums.0[place..].iter_mut().zip(&self.basis) {
            *sum += a * rest;
        }
    }

    /// Shows the polynomials of its windows.
    fn show(mut self, see: &mut impl FnMut(usize, &Polynomial)) {
        let ([first, last], samples) = (self.begins, self.samples);
        let terms = self.basis.len();
        let zero = Sums(vec![0.0; terms * (terms + 1) / 2 + terms]);
        let mut shared = zero.clone();
        (last..first + samples).for_each(|sample| self.add(&mut shared, sample));
        // The sums over what windows have before the shared samples, that of the last window first.
        let mut before = vec![zero.clone()];
        for sample in (first..last).rev() {
            let mut sums = before[before.len() - 1].clone();
            self.add(&mut sums, sample);
            before.push(sums);
        }
        let mut after = zero;
        for begins in first..=last {
            if begins > first {
                self.add(&mut after, begins + samples - 1);
            }
            let parts = [&before[last - begins], &shared, &after];
            let total: Vec<f64> =
                (0..after.0.len()).map(|i| parts.iter().map(|it| it.0[i]).sum()).collect();
            match corrections(&total, terms) {
                Some(more) => see(begins, &self.whole.plus(&more)),
                None => {
                    let range = begins..begins + samples;
                    let (times, values) = (&self.times[range.clone()], &self.values[range]);
                    see(begins, &Polynomial::fit(times, values, terms - 1));
                }
            }
        }
    }
}

/// The coefficients that solve the normal equations of these sums; none where polynomials are nearly dependent.
fn corrections(sums: &[f64], terms: usize) -> Option<Vec<f64>> {
    let (triangle, right) = sums.split_at(terms * (terms + 1) / 2);
    let matrix = DMatrix::from_fn(terms, terms, |i, j| {
        let (row, column) = (i.max(j), i.min(j));
        triangle[row * (row + 1) / 2 + column]
    });
    let lower = matrix.cholesky()?;
    let diagonal = lower.l_dirty().diagonal();
    if diagonal.min() < DEPENDENT * diagonal.max() {
        return None;
    }
    Some(lower.solve(&DVector::from_column_slice(right)).as_slice().to_vec())
}
