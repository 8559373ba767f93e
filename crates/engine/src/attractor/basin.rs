//! How uncertain it is which attractor a start leads to, from the labels of a grid of starts.

use super::share::Label;

/// A number that is estimated, with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

/// The entropy of basins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entropy {
    /// Cells along each side of a box.
    pub side: usize,
    /// The mean over all boxes [nat].
    pub basin: Estimate,
    /// The mean over those with several labels; NaN where there is none [nat].
    pub boundary: Estimate,
}

/// The basin entropy of a grid of starts of this `shape`, the last axis fastest, in boxes of so many cells a `side`; none
/// where the grid has fewer cells along an axis, or a start is missing.
///
/// Method: the mean over boxes that do not overlap of - sum p ln p, p the shares of the labels in a box; what is left over at
/// the ends of the axes is not counted (Daza, Wagemakers, Georgeot, Guery-Odelin and Sanjuan 2016). Starts whose attractor is
/// not known are a label of their own. It depends on the resolution: where the boundary has the uncertainty exponent a, a grid
/// that is finer by a factor c has boxes with several labels in a share that is smaller by c^a, and so the mean over all boxes,
/// while that over boxes on the boundary tends to a number of the boundary's own. Above ln 2 the boundary is fractal.
/// Error: the standard error of the mean over boxes as if they were independent.
pub fn entropy(shape: &[usize], label: impl Fn(usize) -> Label, side: usize) -> Option<Entropy> {
    let mut entropies = Vec::new();
    each_box(shape, label, side, |_, labels| entropies.push(of_labels(labels)))?;
    let on_boundary: Vec<f64> = entropies.iter().copied().filter(|it| *it > 0.0).collect();
    Some(Entropy { side, basin: mean(&entropies), boundary: mean(&on_boundary) })
}

/// Tells `box_of` of each box of so many cells a side, in order: the corner with the least coordinates [cells], and the labels in it;
/// none without a box, or where a start is missing.
pub(super) fn each_box(
    shape: &[usize],
    label: impl Fn(usize) -> Label,
    side: usize,
    mut box_of: impl FnMut(&[usize], &[Label]),
) -> Option<()> {
    let boxes: Vec<usize> = shape.iter().map(|length| length / side).collect();
    let count: usize = boxes.iter().product();
    if count == 0 || shape.is_empty() {
        return None;
    }
    let within = vec![side; shape.len()];
    let cells: Vec<Vec<usize>> =
        (0..side.pow(shape.len() as u32)).map(|cell| position(cell, &within)).collect();
    let mut labels = Vec::with_capacity(cells.len());
    for number in 0..count {
        let mut corner = position(number, &boxes);
        corner.iter_mut().for_each(|it| *it *= side);
        labels.clear();
        labels.extend(cells.iter().map(|cell| {
            let at = corner.iter().zip(cell).map(|(corner, inside)| corner + inside);
            label(index(at, shape))
        }));
        if labels.contains(&Label::Missing) {
            return None;
        }
        box_of(&corner, &labels);
    }
    Some(())
}

/// The entropy of the labels of a box [nat].
fn of_labels(labels: &[Label]) -> f64 {
    let mut entropy = 0.0;
    for (place, label) in labels.iter().enumerate() {
        if !labels[..place].contains(label) {
            let share =
                labels.iter().filter(|it| *it == label).count() as f64 / labels.len() as f64;
            entropy -= share * share.ln();
        }
    }
    entropy
}

/// The mean, and its standard error; NaN of nothing.
fn mean(values: &[f64]) -> Estimate {
    let count = values.len() as f64;
    let value = values.iter().sum::<f64>() / count;
    let variance =
        values.iter().map(|it| (it - value).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    Estimate { value, error: (variance / count).sqrt() }
}

/// The position of a cell along each axis of a grid, the last axis fastest.
fn position(mut number: usize, shape: &[usize]) -> Vec<usize> {
    let mut position = vec![0; shape.len()];
    for (at, length) in position.iter_mut().zip(shape).rev() {
        *at = number % length;
        number /= length;
    }
    position
}

/// The number of the cell at a position.
fn index(position: impl Iterator<Item = usize>, shape: &[usize]) -> usize {
    position.zip(shape).fold(0, |number, (at, length)| number * length + at)
}
