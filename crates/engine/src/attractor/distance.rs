//! How far each start of a grid is from the nearest of some of them.

/// The squares of the distances of all starts of a grid from the nearest of some, which `is_from` tells; infinite where there is none.
/// The positions of the starts along each of the `axes` are given, the last axis fastest.
///
/// Method: exact Euclidean distances, axis by axis (Felzenszwalb and Huttenlocher 2012).
pub(super) fn squares_of_distances(axes: &[Vec<f64>], is_from: impl Fn(usize) -> bool) -> Vec<f64> {
    let starts = axes.iter().map(Vec::len).product();
    let mut squares: Vec<f64> =
        (0..starts).map(|start| if is_from(start) { 0.0 } else { f64::INFINITY }).collect();
    let mut spacing = starts;
    for axis in axes {
        let block = spacing;
        spacing /= axis.len();
        // An axis may fall.
        let mut order: Vec<usize> = (0..axis.len()).collect();
        order.sort_by(|a, b| axis[*a].total_cmp(&axis[*b]));
        let rising: Vec<f64> = order.iter().map(|at| axis[*at]).collect();
        for first in (0..starts).step_by(block) {
            for line in first..first + spacing {
                transform(&rising, &mut squares, |at| line + order[at] * spacing);
            }
        }
    }
    squares
}

/// Replaces the numbers f at the rising positions x of a line by the least of f(q) + (x - x(q))^2 over the line, as the lower envelope of
/// parabolas; `place` tells where they are.
fn transform(x: &[f64], numbers: &mut [f64], place: impl Fn(usize) -> usize) {
    // The parabolas of the envelope, and from where on each is the lowest.
    let mut lowest: Vec<(usize, f64)> = Vec::with_capacity(x.len());
    let f: Vec<f64> = (0..x.len()).map(|at| numbers[place(at)]).collect();
    for q in (0..x.len()).filter(|&q| f[q].is_finite()) {
        let mut from = f64::NEG_INFINITY;
        while let Some(&(p, begins)) = lowest.last() {
            from = 0.5 * (x[q] + x[p] + (f[q] - f[p]) / (x[q] - x[p]));
            if from > begins {
                break;
            }
            lowest.pop();
            from = f64::NEG_INFINITY;
        }
        lowest.push((q, from));
    }
    let mut at = 0;
    for (to, &x_to) in x.iter().enumerate() {
        while at + 1 < lowest.len() && lowest[at + 1].1 < x_to {
            at += 1;
        }
        if let Some(&(q, _)) = lowest.get(at) {
            numbers[place(to)] = f[q] + (x_to - x[q]) * (x_to - x[q]);
        }
    }
}
