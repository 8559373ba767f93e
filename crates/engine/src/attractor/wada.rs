//! Whether all basins have one boundary, the property of Wada, by merging basins on a grid of starts.

use super::distance::squares_of_distances;
use super::share::Label;

/// The boundaries of some basins beside each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Wada {
    /// The starts on the boundary of the basin of each attractor, by its number.
    pub boundaries: Vec<usize>,
    /// The starts whose attractor is not known: no boundary is told between them and others.
    pub unknown: usize,
    /// Each boundary beside each other one.
    pub pairs: Vec<BoundaryPair>,
    /// The verdict by radius, the smallest first.
    pub scales: Vec<WadaScale>,
}

/// How far the boundary of a basin is from that of another.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundaryPair {
    /// The attractor whose boundary is looked at, by its number.
    pub of: u32,
    /// The attractor from whose boundary distances are told.
    pub from: u32,
    /// The largest distance of a start on the one boundary from the other [starts].
    pub distance: f64,
    /// The share of the starts on the one boundary that are farther from the other than each radius.
    pub farther: Vec<f64>,
}

/// What holds if all boundaries are as wide as a radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WadaScale {
    /// The radius [starts].
    pub radius: usize,
    /// The largest share of a boundary that is farther from another one: zero where the basins are Wada to within this radius.
    pub farther: f64,
    /// The largest share of all starts that are within this radius of one boundary: near one the radius tells nothing.
    pub covered: f64,
}

impl Wada {
    /// The largest distance of a start on one boundary from another, the Hausdorff distance of the two that differ most [starts].
    pub fn distance(&self) -> f64 {
        self.pairs.iter().map(|it| it.distance).fold(0.0, f64::max)
    }

    /// The least radius to within which all basins have one boundary; none of those that are looked at may be large enough.
    pub fn least_radius(&self) -> Option<usize> {
        self.scales.iter().find(|it| it.farther == 0.0).map(|it| it.radius)
    }
}

/// How far the boundaries of the basins of so many `attractors` are from each other, on a grid of starts of this `shape`, the last axis
/// fastest; none of fewer than three attractors, where a start is missing, where a basin has no boundary, and on a grid of fewer than 16
/// starts along an axis or of one axis.
///
/// Method: of each attractor the picture of its basin and of all others merged, whose boundary is the starts of which a neighbour along
/// an axis is on the other side. Basins are Wada if all these boundaries are one; here, to within a radius r, if each start on
/// each of them is within r of every other. Distances are Euclidean, in starts along the axes. Radii are 1, 2, 4, ... up to a
/// sixteenth of the shortest axis.
/// Source: Daza, Wagemakers and Sanjuan (2018).
/// Guarantees: distances are exact.
/// Breaks: it tells of the grid, not of what is finer; one start with a wrong label among those of another basin has a boundary of
/// its own, which the largest distance is then that of; and basins that are so narrow that boundaries cover all starts are
/// Wada to within any radius, see [`WadaScale::covered`].
pub fn wada(shape: &[usize], label: impl Fn(usize) -> Label, attractors: usize) -> Option<Wada> {
    let longest = shape.iter().min()? / 16;
    if attractors < 3 || shape.len() < 2 || longest == 0 {
        return None;
    }
    let radii: Vec<usize> = (0..).map(|power| 1 << power).take_while(|it| *it <= longest).collect();
    let starts: usize = shape.iter().product();
    if (0..starts).any(|start| label(start) == Label::Missing) {
        return None;
    }
    let unknown = (0..starts).filter(|start| label(*start) == Label::Undecided).count();
    let boundaries = boundaries(shape, &label, attractors);
    if boundaries.iter().any(Vec::is_empty) {
        return None;
    }
    let axes: Vec<Vec<f64>> =
        shape.iter().map(|length| (0..*length).map(|at| at as f64).collect()).collect();
    let mut pairs = Vec::new();
    let mut covered = vec![0.0_f64; radii.len()];
    for (from, boundary) in boundaries.iter().enumerate() {
        let squares = squares_of_distances(&axes, |start| boundary.binary_search(&start).is_ok());
        for (covered, radius) in covered.iter_mut().zip(&radii) {
            *covered = covered.max(1.0 - farther(squares.iter().copied(), *radius));
        }
        for (of, others) in boundaries.iter().enumerate().filter(|(of, _)| *of != from) {
            let squares = others.iter().map(|start| squares[*start]);
            pairs.push(BoundaryPair {
                of: of as u32,
                from: from as u32,
                distance: squares.clone().fold(0.0, f64::max).sqrt(),
                farther: radii.iter().map(|radius| farther(squares.clone(), *radius)).collect(),
            });
        }
    }
    pairs.sort_by_key(|it| (it.of, it.from));
    let scales = radii.iter().zip(covered).enumerate().map(|(at, (&radius, covered))| {
        let farther = pairs.iter().map(|it| it.farther[at]).fold(0.0, f64::max);
        WadaScale { radius, farther, covered }
    });
    let scales = scales.collect();
    Some(Wada { boundaries: boundaries.iter().map(Vec::len).collect(), unknown, pairs, scales })
}

/// The starts on the boundary of the basin of each attractor, in rising order.
fn boundaries(
    shape: &[usize],
    label: impl Fn(usize) -> Label,
    attractors: usize,
) -> Vec<Vec<usize>> {
    let starts: usize = shape.iter().product();
    let mut found = vec![Vec::new(); attractors];
    for start in 0..starts {
        let mut spacing = starts;
        for &length in shape {
            spacing /= length;
            if start / spacing % length + 1 == length {
                continue;
            }
            let other = start + spacing;
            if let (Label::Attractor(a), Label::Attractor(b)) = (label(start), label(other))
                && a != b
            {
                for number in [a, b] {
                    found[number as usize].extend([start, other]);
                }
            }
        }
    }
    for boundary in &mut found {
        boundary.sort_unstable();
        boundary.dedup();
    }
    found
}

/// The share of some squares of distances that are beyond a radius.
fn farther(squares: impl Iterator<Item = f64>, radius: usize) -> f64 {
    let (mut beyond, mut all) = (0_usize, 0_usize);
    for square in squares {
        all += 1;
        beyond += usize::from(square > (radius * radius) as f64);
    }
    beyond as f64 / all as f64
}
