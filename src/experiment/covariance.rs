//! The covariance of fitted parameters, by squares and by losses that let outliers count little.

use nalgebra::DMatrix;

use super::loss::Loss;

/// A direction of the scaled Jacobian below this share of the largest is not determined.
const DETERMINED: f64 = 1e-10;
/// Fewer data of one distribution do not tell their scatter.
const FEW: usize = 10;
/// A normal number is integrated over so many standard deviations to either side, in steps of so many.
const NORMAL: (i32, f64) = (160, 0.05);

/// What the data say of the fitted parameters together.
#[derive(Debug, Clone, PartialEq)]
pub struct Covariance {
    /// The inverse of half the curvature of what is made least; see [`Covariance::new`] for what is not determined.
    pub inverse_curvature: DMatrix<f64>,
    /// The covariance of the parameters; infinite and zero where the other is.
    pub covariance: DMatrix<f64>,
    /// Whether a parameter has an effect that others of them undo, so that only combinations are determined.
    pub is_combined: Vec<bool>,
    /// What the sum that is made least grows by at one standard error, of all data together.
    pub growth: f64,
}

/// Data at the fitted parameters.
#[derive(Debug, Clone, Copy)]
pub struct Data<'d> {
    /// The residuals.
    pub values: &'d [f64],
    /// Their derivatives in each parameter, by datum.
    pub slopes: &'d [Vec<f64>],
    /// How many data in turn have one distribution; all have where it is empty.
    pub groups: &'d [usize],
}

/// The means of a group of data: half the curvature of the loss, and the square of half its slope.
#[derive(Clone, Copy)]
struct Means {
    curvature: f64,
    square: f64,
}

impl Covariance {
    /// The covariance of as many parameters as `left_out` has, of which those are not determined.
    ///
    /// # Method
    ///
    /// By squares `s^2 (J^T J)^-1`, with the variance s^2 of the residuals. With another loss `A^-1 B A^-1`, where `A` is the sum of
    /// `m J_i^T J_i` over the data and `B` that of `q J_i^T J_i`: m is the mean of half the curvature of the loss over the data of
    /// one distribution, q that of the squares of half its slope, times n/(n - p) for n data and p parameters. Of fewer than ten data
    /// both are those of normal numbers of unit variance.
    ///
    /// # Source
    ///
    /// Huber, Robust Statistics (1981), sections 6.3 and 7.6, group by group.
    ///
    /// # Assumes
    ///
    /// Independent residuals, whose size does not depend on the slopes within a group.
    ///
    /// # Guarantees
    ///
    /// That of a parameter that the data do not determine, or that is left out, is infinite, and zero with the others.
    ///
    /// # Breaks
    ///
    /// Where residuals follow one another, as those of a wrong model do, it is too small.
    pub fn new(data: Data<'_>, loss: Loss, left_out: &[bool]) -> Covariance {
        let count = data.values.len();
        let freedom = count.saturating_sub(left_out.len()) as f64;
        if loss == Loss::Squares {
            let (inverse_curvature, is_combined) = inverse_curvature(data.slopes, left_out);
            let growth = data.values.iter().map(|it| it * it).sum::<f64>() / freedom;
            let mut covariance = inverse_curvature.clone();
            covariance.iter_mut().filter(|it| it.is_finite()).for_each(|it| *it *= growth);
            return Covariance { inverse_curvature, covariance, is_combined, growth };
        }
        let means = means(data, loss, count as f64 / freedom);
        let scaled: Vec<Vec<f64>> = data
            .slopes
            .iter()
            .zip(&means)
            .map(|(row, means)| row.iter().map(|it| it * means.curvature.sqrt()).collect())
            .collect();
        let (inverse_curvature, is_combined) = inverse_curvature(&scaled, left_out);
        let finite = inverse_curvature.map(|it| if it.is_finite() { it } else { 0.0 });
        let weighed = DMatrix::from_fn(data.slopes.len(), left_out.len(), |i, j| {
            data.slopes[i][j] * means[i].square.sqrt()
        }) * &finite;
        let mut covariance = weighed.transpose() * &weighed;
        for i in 0..left_out.len() {
            if inverse_curvature[(i, i)].is_infinite() {
                covariance[(i, i)] = f64::INFINITY;
            }
        }
        let squares: f64 = means.iter().map(|it| it.square).sum();
        let growth = squares / means.iter().map(|it| it.curvature).sum::<f64>();
        Covariance { inverse_curvature, covariance, is_combined, growth }
    }

    /// What the sum that is made least grows by at one standard error of a parameter, with the others fitted.
    pub fn growth_of(&self, parameter: usize) -> f64 {
        let place = (parameter, parameter);
        let ratio = self.covariance[place] / self.inverse_curvature[place];
        if ratio.is_finite() { ratio } else { self.growth }
    }
}

/// The means of the group of each datum; `share` is n/(n - p).
fn means(data: Data<'_>, loss: Loss, share: f64) -> Vec<Means> {
    let whole = [data.values.len()];
    let is_whole = data.groups.iter().sum::<usize>() != data.values.len();
    let groups = if is_whole { &whole[..] } else { data.groups };
    let (mut all, mut rest) = (Vec::with_capacity(data.values.len()), data.values);
    for count in groups {
        let (own, others) = rest.split_at(*count);
        let means = if own.len() < FEW { normal_means(loss) } else { own_means(own, loss, share) };
        all.resize(all.len() + own.len(), means);
        rest = others;
    }
    all
}

fn own_means(values: &[f64], loss: Loss, share: f64) -> Means {
    let count = values.len() as f64;
    Means {
        curvature: values.iter().map(|it| loss.curvature(*it)).sum::<f64>() / count,
        square: share * values.iter().map(|it| loss.influence(*it).powi(2)).sum::<f64>() / count,
    }
}

/// The means of normal numbers of unit variance.
fn normal_means(loss: Loss) -> Means {
    let (count, step) = NORMAL;
    let mut means = Means { curvature: 0.0, square: 0.0 };
    for i in -count..=count {
        let at = step * f64::from(i);
        let density = step * (-0.5 * at * at).exp() / std::f64::consts::TAU.sqrt();
        means.curvature += density * loss.curvature(at);
        means.square += density * loss.influence(at).powi(2);
    }
    means
}

/// `(J^T J)^-1` over the parameters that the data determine, see [`Covariance::new`], and whether only combinations of each are
/// determined.
fn inverse_curvature(slopes: &[Vec<f64>], left_out: &[bool]) -> (DMatrix<f64>, Vec<bool>) {
    let count = left_out.len();
    let mut covariance = DMatrix::zeros(count, count);
    let mut is_combined = vec![false; count];
    let squares =
        (0..count).map(|column| slopes.iter().map(|row| row[column] * row[column]).sum::<f64>());
    let norms: Vec<f64> = squares.map(f64::sqrt).collect();
    let (kept, others): (Vec<usize>, Vec<usize>) =
        (0..count).partition(|&i| !left_out[i] && norms[i] > 0.0);
    others.into_iter().for_each(|i| covariance[(i, i)] = f64::INFINITY);
    if kept.is_empty() || slopes.len() < kept.len() {
        kept.into_iter().for_each(|i| covariance[(i, i)] = f64::INFINITY);
        return (covariance, is_combined);
    }
    // Columns of unit length, so that units do not matter.
    let scaled = DMatrix::from_fn(slopes.len(), kept.len(), |row, column| {
        slopes[row][kept[column]] / norms[kept[column]]
    });
    let svd = scaled.svd(false, true);
    let Some(directions) = svd.v_t else { return (covariance, is_combined) };
    let largest = svd.singular_values.max();
    for (value, direction) in svd.singular_values.iter().zip(directions.row_iter()) {
        let is_open = *value <= DETERMINED * largest;
        for (i, &row) in kept.iter().enumerate() {
            for (j, &column) in kept.iter().enumerate() {
                let share = direction[i] * direction[j] / (norms[row] * norms[column]);
                if !is_open {
                    covariance[(row, column)] += share / (value * value);
                } else if i == j && direction[i].abs() > 1e-6 {
                    covariance[(row, row)] = f64::INFINITY;
                    is_combined[row] = true;
                }
            }
        }
    }
    (covariance, is_combined)
}
