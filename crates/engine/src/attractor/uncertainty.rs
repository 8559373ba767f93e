//! How the share of boxes that the boundary of basins crosses goes with their size: the uncertainty exponent, and whether there is one.

use super::basin::{Estimate, each_box};
use super::share::Label;

/// Slabs into which the grid is cut along an axis, one of which is left out at a time.
const SLABS: usize = 8;
/// Two local slopes differ that are so many of the standard errors of their difference apart.
const APART: f64 = 4.0;

/// How the share of boxes that the boundary crosses falls with their size.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// The uncertainty exponent a: the share goes with the size to this power.
    pub exponent: Estimate,
    /// The dimension of the boundary, that of the space less the exponent.
    pub dimension: Estimate,
    /// The boxes of each size, the smallest first.
    pub sizes: Vec<BoxSize>,
    /// The slope between each two sizes that follow each other, the smallest first.
    pub slopes: Vec<LocalSlope>,
    /// Whether one exponent describes all sizes: whether no two of the local slopes differ by more than their errors.
    pub scales: bool,
}

/// The boxes of a size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoxSize {
    /// How far apart the ends of a box are along an axis [cells].
    pub span: usize,
    /// So many boxes.
    pub boxes: usize,
    /// Those that have several labels.
    pub crossed: usize,
}

/// The slope of the logarithm of the share over that of the size, between two sizes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalSlope {
    /// The spans of the two sizes [cells].
    pub spans: [usize; 2],
    /// The slope, with its statistical error.
    pub slope: Estimate,
}

/// The uncertainty exponent of a grid of starts of this `shape`, the last axis fastest; none where the boundary crosses boxes of
/// fewer than three sizes, or a start is missing.
///
/// Method: a start that is known to within a box is uncertain if the boundary crosses the box. The share of these among boxes
/// that do not overlap, whose ends are 1, 2, 4, ... cells apart, up to a sixteenth of the shortest axis; the slope of its
/// logarithm over that of the distance, by least squares.
/// Source: McDonald, Grebogi, Ott and Yorke (1985).
/// Error: whether neighbouring boxes are crossed is correlated, and so are the shares of two sizes, as it is one boundary. So the
/// grid is cut into eight slabs along an axis, and the variance of a slope, and that of the difference of two, is what leaving out
/// one slab at a time makes of it (the jackknife); of the axes, the one with the largest counts. That is the statistical error
/// of a local slope. The error of the exponent is its own of this kind, or as much more as is needed for the slope
/// between any two sizes to lie within the two errors of it: what the slopes drift is then within the error.
/// Guarantees: where two local slopes differ by four standard errors of their difference, the sizes show no exponent, and `scales` says so.
/// Breaks: slabs count as independent, so a pattern of the boundary that is longer than a slab has too small an error; and
/// what sizes beyond those of the grid show is not known.
pub fn uncertainty(shape: &[usize], label: impl Fn(usize) -> Label) -> Option<Uncertainty> {
    let longest = shape.iter().min()? / 16;
    let spans = (0..).map(|power| 1_usize << power).take_while(|span| *span <= longest);
    let all = spans.map(|span| Counts::of(shape, &label, span)).collect::<Option<Vec<Counts>>>()?;
    let sizes = all.iter().map(|it| it.size).collect();
    let crossed: Vec<Counts> = all.into_iter().filter(|it| it.size.crossed > 0).collect();
    if crossed.len() < 3 {
        return None;
    }
    let samples = Samples::of(&crossed, shape.len());
    let count = crossed.len() - 1;
    let slopes: Vec<LocalSlope> = (0..count)
        .map(|at| LocalSlope {
            spans: [crossed[at].size.span, crossed[at + 1].size.span],
            slope: samples.estimate(|logs| local_slope(&crossed, logs, at)),
        })
        .collect();
    let mut pairs = (0..count).flat_map(|first| (first + 1..count).map(move |it| [first, it]));
    let scales = !pairs.any(|[first, second]| samples.differ(&crossed, first, second));
    let fitted = samples.estimate(|logs| fitted_slope(&crossed, logs));
    let beyond = slopes.iter().map(|it| (it.slope.value - fitted.value).abs() - it.slope.error);
    let error = beyond.fold(fitted.error, f64::max);
    let exponent = Estimate { value: fitted.value, error };
    let dimension = Estimate { value: shape.len() as f64 - fitted.value, error };
    Some(Uncertainty { exponent, dimension, sizes, slopes, scales })
}

/// The boxes of a size, and those of each slab across each axis.
struct Counts {
    size: BoxSize,
    /// Boxes, and crossed boxes, by axis and slab.
    slabs: Vec<[BoxSize; SLABS]>,
}

impl Counts {
    /// Those of boxes whose ends are a `span` apart; none without a box, or where a start is missing.
    fn of(shape: &[usize], label: &impl Fn(usize) -> Label, span: usize) -> Option<Counts> {
        let none = BoxSize { span, boxes: 0, crossed: 0 };
        let mut counts = Counts { size: none, slabs: vec![[none; SLABS]; shape.len()] };
        each_box(shape, label, span + 1, |corner, labels| {
            let is_crossed = labels.iter().any(|it| *it != labels[0]);
            counts.size.count(is_crossed);
            for ((slabs, corner), length) in counts.slabs.iter_mut().zip(corner).zip(shape) {
                // A box belongs to the slab in which its middle lies, (2 corner + span + 1)/2 cells from the end.
                let slab = (2 * corner + span + 1) * SLABS / (2 * length);
                slabs[slab.min(SLABS - 1)].count(is_crossed);
            }
        })?;
        Some(counts)
    }
}

impl BoxSize {
    fn count(&mut self, is_crossed: bool) {
        self.boxes += 1;
        self.crossed += usize::from(is_crossed);
    }

    /// The logarithm of the share of crossed boxes among those outside a slab.
    fn log_share_without(&self, slab: &BoxSize) -> f64 {
        ((self.crossed - slab.crossed) as f64 / (self.boxes - slab.boxes) as f64).ln()
    }
}

/// The logarithms of the shares of all sizes: of the whole grid, and with a slab left out, by axis.
struct Samples {
    whole: Vec<f64>,
    without: Vec<Vec<Vec<f64>>>,
}

impl Samples {
    fn of(counts: &[Counts], axes: usize) -> Samples {
        let whole = counts.iter().map(|it| (it.size.crossed as f64 / it.size.boxes as f64).ln());
        let mut without = vec![Vec::new(); axes];
        for (axis, without) in without.iter_mut().enumerate() {
            for slab in 0..SLABS {
                let logs = counts.iter().map(|it| it.size.log_share_without(&it.slabs[axis][slab]));
                without.push(logs.collect());
            }
        }
        Samples { whole: whole.collect(), without }
    }

    /// Whether the local slopes after two sizes differ by more than their errors.
    fn differ(&self, counts: &[Counts], first: usize, second: usize) -> bool {
        let difference = self
            .estimate(|logs| local_slope(counts, logs, second) - local_slope(counts, logs, first));
        difference.value.abs() > APART * difference.error
    }

    /// A number that follows from the logarithms of the shares, with its statistical error: infinite where all that is crossed by
    /// the boundary at some size lies in one slab.
    fn estimate(&self, of: impl Fn(&[f64]) -> f64) -> Estimate {
        let variances = self.without.iter().map(|slabs| {
            let values: Vec<f64> = slabs.iter().map(|logs| of(logs)).collect();
            jackknife(&values)
        });
        let largest = variances.fold(0.0, f64::max);
        Estimate { value: of(&self.whole), error: largest.sqrt() }
    }
}

/// The variance of a number by what leaving out each slab makes of it.
fn jackknife(values: &[f64]) -> f64 {
    if values.iter().any(|it| !it.is_finite()) {
        return f64::INFINITY;
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (count - 1.0) / count * values.iter().map(|it| (it - mean).powi(2)).sum::<f64>()
}

/// The slope between a size and the next.
fn local_slope(counts: &[Counts], logs: &[f64], at: usize) -> f64 {
    let ratio = counts[at + 1].size.span as f64 / counts[at].size.span as f64;
    (logs[at + 1] - logs[at]) / ratio.ln()
}

/// The slope of a line through all sizes by least squares.
fn fitted_slope(counts: &[Counts], logs: &[f64]) -> f64 {
    let sizes: Vec<f64> = counts.iter().map(|it| (it.size.span as f64).ln()).collect();
    let count = sizes.len() as f64;
    let (x, y) = (sizes.iter().sum::<f64>() / count, logs.iter().sum::<f64>() / count);
    let width: f64 = sizes.iter().map(|it| (it - x).powi(2)).sum();
    sizes.iter().zip(logs).map(|(size, log)| (size - x) * (log - y)).sum::<f64>() / width
}
