//! Which part of the boundary that a grid of starts shows lies beside curves.

use super::manifold::Plane;

/// A curve is looked at this often between two neighbouring starts.
const PER_CELL: f64 = 4.0;
/// A pair of starts is covered where a curve passes this near to the middle between them, in starts along each axis.
const BESIDE: f64 = 1.0;

/// Two neighbouring starts that lead to two attractors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pair {
    /// The places of the starts along the two sides of the plane.
    pub starts: [[usize; 2]; 2],
    /// The attractors.
    pub attractors: [u32; 2],
    /// Whether a curve passes.
    pub is_covered: bool,
}

/// The pairs of neighbouring starts of a grid between which there is a boundary.
pub(super) struct BoundaryCover<'a, P> {
    plane: &'a Plane<P>,
    /// The pairs, along the rows.
    pub pairs: Vec<Pair>,
    /// The pairs whose first start is at a place of the grid, the first side of the plane the slower.
    of_start: Vec<Vec<usize>>,
}

impl<'a, P> BoundaryCover<'a, P> {
    /// That of a grid of starts which lead to these attractors, the first side of the plane the slower.
    pub fn of(plane: &'a Plane<P>, attractors: &[Option<u32>]) -> Self {
        let [rows, columns] = plane.values.each_ref().map(Vec::len);
        let mut cover =
            BoundaryCover { plane, pairs: Vec::new(), of_start: vec![Vec::new(); rows * columns] };
        for row in 0..rows {
            for column in 0..columns {
                for other in [[row, column + 1], [row + 1, column]] {
                    if other[0] < rows && other[1] < columns {
                        let leads = [
                            attractors[row * columns + column],
                            attractors[other[0] * columns + other[1]],
                        ];
                        cover.note([[row, column], other], leads);
                    }
                }
            }
        }
        cover
    }

    /// Takes note of two neighbouring starts.
    fn note(&mut self, starts: [[usize; 2]; 2], leads: [Option<u32>; 2]) {
        let [Some(first), Some(second)] = leads else { return };
        if first != second {
            let columns = self.plane.values[1].len();
            let [row, column] = starts[0];
            self.of_start[row * columns + column].push(self.pairs.len());
            self.pairs.push(Pair { starts, attractors: [first, second], is_covered: false });
        }
    }

    /// Takes note of a curve by its points.
    pub fn cover(&mut self, points: &[[f64; 2]]) {
        for pair in points.windows(2) {
            let [from, to] =
                [&pair[0], &pair[1]].map(|at| [0, 1].map(|side| self.place(side, at[side])));
            let cells = libm::hypot(to[0] - from[0], to[1] - from[1]);
            let parts = (PER_CELL * cells).ceil().max(1.0) as usize;
            for part in 0..=parts {
                let share = part as f64 / parts as f64;
                self.pass([0, 1].map(|side| from[side] + share * (to[side] - from[side])));
            }
        }
    }

    /// Takes note of a point of a curve, in starts along the sides.
    fn pass(&mut self, at: [f64; 2]) {
        let [rows, columns] = self.plane.values.each_ref().map(Vec::len);
        let [row, column] = at.map(|it| it.floor().max(0.0) as usize);
        for row in row.saturating_sub(1)..(row + 3).min(rows) {
            for column in column.saturating_sub(1)..(column + 3).min(columns) {
                for number in &self.of_start[row * columns + column] {
                    let pair = &mut self.pairs[*number];
                    let [a, b] = pair.starts;
                    let is_beside =
                        |side: usize| (0.5 * (a[side] + b[side]) as f64 - at[side]).abs() <= BESIDE;
                    pair.is_covered |= is_beside(0) && is_beside(1);
                }
            }
        }
    }

    /// Where a share of a side lies among the starts along it, as a number that is whole at each of them.
    fn place(&self, side: usize, share: f64) -> f64 {
        let last = self.plane.values[side].len() - 1;
        let (mut low, mut high) = (0, last);
        while high - low > 1 {
            let middle = (low + high) / 2;
            if self.plane.share(side, middle) <= share { low = middle } else { high = middle }
        }
        let [a, b] = [low, high].map(|it| self.plane.share(side, it));
        low as f64 + (share - a) / (b - a)
    }

    /// How many pairs are not covered.
    pub fn uncovered(&self) -> usize {
        self.pairs.iter().filter(|it| !it.is_covered).count()
    }
}
