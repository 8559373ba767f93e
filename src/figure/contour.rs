//! Contour lines: where values on a grid pass through a level.

use std::collections::BTreeMap;

use super::geometry::Point;

/// The side of a grid cell on which a line crosses: that from a grid point along its row, or along its column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Crossing {
    column: usize,
    row: usize,
    along_row: bool,
}

/// Values on the points of a grid with their places.
pub struct Field<'a> {
    /// The places of the columns.
    pub x: &'a [f64],
    /// The places of the rows.
    pub y: &'a [f64],
    /// The value of a column and a row; lines end beside those that are not finite.
    pub value: &'a dyn Fn(usize, usize) -> f64,
}

impl Field<'_> {
    /// The lines along which the value is `level`, each from end to end, or around with its first point at its end, too.
    ///
    /// # Method
    ///
    /// Marching squares with linear interpolation along the sides; in a cell that all four sides cross, the mean of its corners
    /// tells which belong together.
    pub fn lines(&self, level: f64) -> Vec<Vec<Point>> {
        let mut neighbours: BTreeMap<Crossing, Vec<Crossing>> = BTreeMap::new();
        for row in 1..self.y.len() {
            for column in 1..self.x.len() {
                for [a, b] in self.segments(column - 1, row - 1, level) {
                    neighbours.entry(a).or_default().push(b);
                    neighbours.entry(b).or_default().push(a);
                }
            }
        }
        let mut lines: Vec<Vec<Crossing>> = Vec::new();
        // Open lines from one of their ends, then those that are closed.
        let ends: Vec<Crossing> =
            neighbours.iter().filter(|it| it.1.len() == 1).map(|it| *it.0).collect();
        for end in ends {
            lines.extend(walk(&mut neighbours, end));
        }
        while let Some((&first, _)) = neighbours.first_key_value() {
            lines.extend(walk(&mut neighbours, first));
        }
        let places =
            lines.iter().map(|line| line.iter().map(|it| self.place(*it, level)).collect());
        places.collect()
    }

    /// The segments of lines in the cell whose first corner is given.
    fn segments(&self, column: usize, row: usize, level: f64) -> Vec<[Crossing; 2]> {
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
        let values = corners.map(|(right, up)| (self.value)(column + right, row + up));
        if values.iter().any(|value| !value.is_finite()) {
            return Vec::new();
        }
        let is_above = values.map(|value| value >= level);
        let sides = [
            Crossing { column, row, along_row: true },
            Crossing { column: column + 1, row, along_row: false },
            Crossing { column, row: row + 1, along_row: true },
            Crossing { column, row, along_row: false },
        ];
        let crossed = (0..4).filter(|side| is_above[*side] != is_above[(side + 1) % 4]);
        let crossed: Vec<Crossing> = crossed.map(|side| sides[side]).collect();
        match crossed[..] {
            [a, b] => vec![[a, b]],
            // The corner between two sides is cut off unless the middle is on its side of the level.
            [a, b, c, d] if (values.iter().sum::<f64>() / 4.0 >= level) == is_above[0] => {
                vec![[a, b], [c, d]]
            }
            [a, b, c, d] => vec![[d, a], [b, c]],
            _ => Vec::new(),
        }
    }

    /// Where a line crosses a side.
    fn place(&self, crossing: Crossing, level: f64) -> Point {
        let Crossing { column, row, along_row } = crossing;
        let (next_column, next_row) = if along_row { (column + 1, row) } else { (column, row + 1) };
        let (from, to) = ((self.value)(column, row), (self.value)(next_column, next_row));
        let share = (level - from) / (to - from);
        let x = between(self.x[column], self.x[next_column], share);
        let y = between(self.y[row], self.y[next_row], share);
        (x, y)
    }
}

/// The place at a share of the distance between two.
fn between(from: f64, to: f64, share: f64) -> f64 {
    from + share * (to - from)
}

/// Follows a line from a crossing, whose segments are taken away; none where there are none left.
fn walk(
    neighbours: &mut BTreeMap<Crossing, Vec<Crossing>>,
    first: Crossing,
) -> Option<Vec<Crossing>> {
    let mut line = vec![first];
    let mut at = first;
    while let Some(next) = neighbours.get_mut(&at).and_then(Vec::pop) {
        if neighbours[&at].is_empty() {
            neighbours.remove(&at);
        }
        if let Some(back) = neighbours.get_mut(&next) {
            back.retain(|it| *it != at);
            if back.is_empty() {
                neighbours.remove(&next);
            }
        }
        line.push(next);
        at = next;
    }
    (line.len() > 1).then_some(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines of a function over a grid of -1 to 1.
    fn lines(of: impl Fn(f64, f64) -> f64, level: f64) -> Vec<Vec<Point>> {
        let places: Vec<f64> = (0..81).map(|place| place as f64 / 40.0 - 1.0).collect();
        let value = |column: usize, row: usize| of(places[column], places[row]);
        Field { x: &places, y: &places, value: &value }.lines(level)
    }

    #[test]
    fn a_circle_is_one_closed_line() {
        let found = lines(|x, y| x * x + y * y, 0.36);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].first(), found[0].last());
        // Interpolation over a width of 1/40 errs by less than its square.
        let away = |at: &Point| (at.0.hypot(at.1) - 0.6).abs();
        assert!(found[0].iter().all(|at| away(at) < 6e-4));
        let length: f64 =
            found[0].windows(2).map(|it| (it[1].0 - it[0].0).hypot(it[1].1 - it[0].1)).sum();
        assert!((length - 1.2 * std::f64::consts::PI).abs() < 2e-3, "{length}");
    }

    #[test]
    fn lines_end_at_the_edge_and_beside_what_is_missing() {
        assert_eq!(lines(|x, _| x, 0.013).len(), 1);
        let found = lines(|x, y| if y.abs() < 0.1 { f64::NAN } else { x }, 0.013);
        assert_eq!(found.len(), 2);
        assert!(found.iter().flatten().all(|at| at.1.abs() >= 0.1 && (at.0 - 0.013).abs() < 1e-12));
        assert!(lines(|x, y| x + y, 3.0).is_empty());
    }

    #[test]
    fn branches_of_a_hyperbola_stay_apart() {
        for level in [0.003, -0.003] {
            let found = lines(|x, y| x * y, level);
            assert_eq!(found.len(), 2, "{level}");
            assert!(
                found.iter().all(|line| line.iter().all(|it| (it.0 > 0.0) == (line[0].0 > 0.0)))
            );
        }
    }
}
