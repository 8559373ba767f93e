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
    let entropies = of_boxes(shape, label, side, of_labels)?;
    let on_boundary: Vec<f64> = entropies.iter().copied().filter(|it| *it > 0.0).collect();
    Some(Entropy { side, basin: mean(&entropies), boundary: mean(&on_boundary) })
}

/// A number for the labels of each box of so many cells a side, in order; none without a box, or where a start is missing.
fn of_boxes<T>(
    shape: &[usize],
    label: impl Fn(usize) -> Label,
    side: usize,
    of: impl Fn(&[Label]) -> T,
) -> Option<Vec<T>> {
    let boxes: Vec<usize> = shape.iter().map(|length| length / side).collect();
    let count: usize = boxes.iter().product();
    if count == 0 || shape.is_empty() {
        return None;
    }
    let within = vec![side; shape.len()];
    let cells: Vec<Vec<usize>> =
        (0..side.pow(shape.len() as u32)).map(|cell| position(cell, &within)).collect();
    let mut labels = Vec::with_capacity(cells.len());
    let numbers = (0..count).map(|number| {
        let corner = position(number, &boxes);
        labels.clear();
        labels.extend(cells.iter().map(|cell| {
            let at = corner.iter().zip(cell).map(|(corner, inside)| corner * side + inside);
            label(index(at, shape))
        }));
        (!labels.contains(&Label::Missing)).then(|| of(&labels))
    });
    numbers.collect()
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

/// How the share of boxes that the boundary crosses falls with their size.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// The uncertainty exponent a: the share goes with the size to this power.
    pub exponent: Estimate,
    /// The dimension of the boundary, that of the space less the exponent.
    pub dimension: Estimate,
    /// How far apart the ends of a box are along an axis [cells], and the share of the boxes that have several labels.
    pub shares: Vec<(usize, f64)>,
}

/// The uncertainty exponent of a grid of starts of this `shape`, the last axis fastest; none where the boundary crosses boxes of
/// fewer than three sizes, or a start is missing.
///
/// Method: a start that is known to within a box is uncertain if the boundary crosses the box. The share of these among boxes
/// that do not overlap, whose ends are 1, 2, 4, ... cells apart, up to a sixteenth of the shortest axis; the slope of its
/// logarithm over that of the distance, by least squares (McDonald, Grebogi, Ott and Yorke 1985). Error: that of the slope by
/// the scatter about the line; it knows nothing of a curvature that another range of sizes would show.
pub fn uncertainty(shape: &[usize], label: impl Fn(usize) -> Label) -> Option<Uncertainty> {
    let longest = shape.iter().min()? / 16;
    let spans = (0..).map(|power| 1_usize << power).take_while(|span| *span <= longest);
    let share = |span: usize| {
        let several = |labels: &[Label]| labels.iter().any(|it| *it != labels[0]);
        let crossed = of_boxes(shape, &label, span + 1, several)?;
        let count = crossed.iter().filter(|it| **it).count();
        Some((span, count as f64 / crossed.len() as f64))
    };
    let shares: Vec<(usize, f64)> = spans.map(share).collect::<Option<_>>()?;
    let points: Vec<(f64, f64)> = shares
        .iter()
        .filter(|(_, share)| *share > 0.0)
        .map(|(span, share)| ((*span as f64).ln(), share.ln()))
        .collect();
    let exponent = slope(&points)?;
    let dimension = Estimate { value: shape.len() as f64 - exponent.value, ..exponent };
    Some(Uncertainty { exponent, dimension, shares })
}

/// The slope of a line through points by least squares; none through fewer than three.
fn slope(points: &[(f64, f64)]) -> Option<Estimate> {
    let count = points.len() as f64;
    if points.len() < 3 {
        return None;
    }
    let middle = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (middle(|it| it.0), middle(|it| it.1));
    let width: f64 = points.iter().map(|it| (it.0 - x).powi(2)).sum();
    let value = points.iter().map(|it| (it.0 - x) * (it.1 - y)).sum::<f64>() / width;
    let scatter: f64 = points.iter().map(|it| (it.1 - y - value * (it.0 - x)).powi(2)).sum();
    Some(Estimate { value, error: (scatter / (count - 2.0) / width).sqrt() })
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
