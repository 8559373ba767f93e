//! How the cases of a study lie in lines of cells, by arithmetic on their indices.

use super::{CaseSet, Study};

/// Some dimensions of a study, slowest first: the length of each, and how far apart in the index two cases
/// are that are neighbours along it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
struct Dimensions(Vec<[usize; 2]>);

impl Dimensions {
    /// Number of positions.
    fn count(&self) -> usize {
        self.0.iter().map(|[length, _]| length).product()
    }

    /// What position `number` adds to the index of a case.
    fn offset(&self, number: usize) -> usize {
        let (mut rest, mut offset) = (number, 0);
        for [length, spacing] in self.0.iter().rev() {
            offset += rest % length * spacing;
            rest /= length;
        }
        offset
    }
}

/// The lines of a study along the axis of its attractors, each a row of cells.
///
/// The cases of a cell have the same parameters and differ in start and direction only. Without an axis each
/// cell is a line. Draws are one cell where starts alone are drawn, and one cell each otherwise. Nothing is held per case, as there may be millions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// The axis, by its place in the study.
    pub axis: Option<usize>,
    lines: Dimensions,
    cells: Dimensions,
    cases: Dimensions,
}

impl Layout {
    /// The lines of `study`.
    pub fn of(study: &Study) -> Layout {
        let axis = linked_axis(study);
        let [lines, cells, cases] = std::array::from_fn(|_| Dimensions::default());
        let mut layout = Layout { axis, lines, cells, cases };
        let shape = study.shape();
        if let CaseSet::Draws(draws) = &study.case_set {
            let starts = draws.ranges.iter().all(|range| range.coordinate.is_start());
            let dimensions = if starts { &mut layout.cases } else { &mut layout.lines };
            dimensions.0.push([draws.count, 1]);
            return layout;
        }
        for (place, &length) in shape.iter().enumerate() {
            let dimensions = match study.axes().get(place) {
                _ if Some(place) == axis => &mut layout.cells,
                Some(other) if !other.is_of_starts() => &mut layout.lines,
                // A start, or the directions, which are no axis.
                _ => &mut layout.cases,
            };
            dimensions.0.push([length, shape[place + 1..].iter().product()]);
        }
        layout
    }

    /// Number of lines.
    pub fn lines(&self) -> usize {
        self.lines.count()
    }

    /// Cells of a line.
    pub fn cells(&self) -> usize {
        self.cells.count()
    }

    /// Cases of a cell.
    pub fn cases(&self) -> usize {
        self.cases.count()
    }

    /// The index of a case by its line, its cell on the line, and its place in the cell, all of which count
    /// in the order of the indices.
    pub fn case(&self, line: usize, cell: usize, place: usize) -> usize {
        self.lines.offset(line) + self.cells.offset(cell) + self.cases.offset(place)
    }
}

/// The axis along which cases inherit their start, or else the only one along which something else than starts varies, if that is
/// parameters alone.
pub fn linked_axis(study: &Study) -> Option<usize> {
    if let Some(inherit) = study.inherit() {
        return Some(inherit.axis);
    }
    let mut varies = (0..study.axes().len()).filter(|axis| !study.axes()[*axis].is_of_starts());
    let first = varies.next()?;
    let alone = varies.next().is_none();
    (alone && study.axes()[first].is_of_parameters()).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(start: &str) -> (Study, Layout) {
        let axis =
            |name: &str, values: &str| format!("[[axes]]\nname = \"{name}\"\nvalues = {values}\n");
        let text = [
            "[parameters]\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\n".to_owned(),
            axis("start_y1", "[\"0 m/s\", \"1 m/s\"]"),
            axis("omega", "[\"20 rad/s\", \"30 rad/s\", \"40 rad/s\"]"),
            axis("start_r", "[\"0 mm\", \"1 mm\"]"),
            axis("p_d", "[\"1 N\", \"2 N\"]"),
            start.to_owned(),
        ]
        .concat();
        let study = Study::parse("study.toml", &text).unwrap_or_else(|faults| panic!("{faults}"));
        let layout = Layout::of(&study);
        (study, layout)
    }

    #[test]
    fn every_case_is_in_one_cell_with_those_of_its_parameters() {
        let both = "[start]\ninherit = \"omega\"\ndirections = [\"upward\", \"downward\"]";
        for (start, shape) in [("", [6, 1, 4]), (both, [2, 3, 8])] {
            let (study, layout) = layout(start);
            assert_eq!([layout.lines(), layout.cells(), layout.cases()], shape);
            let mut seen = vec![0; study.cases()];
            for (line, cell) in
                (0..shape[0]).flat_map(|line| (0..shape[1]).map(move |it| (line, it)))
            {
                let cases: Vec<usize> =
                    (0..shape[2]).map(|it| layout.case(line, cell, it)).collect();
                assert!(cases.is_sorted());
                let first = study.case(cases[0]).parameters;
                assert!(cases.iter().all(|&case| study.case(case).parameters == first));
                cases.iter().for_each(|&case| seen[case] += 1);
            }
            assert!(seen.iter().all(|&count| count == 1));
        }
    }

    #[test]
    fn the_cells_of_a_line_differ_along_the_axis_alone() {
        let (study, layout) = layout("[start]\ninherit = \"omega\"");
        for line in 0..layout.lines() {
            let positions =
                (0..layout.cells()).map(|cell| study.position(layout.case(line, cell, 0)));
            assert!(positions.eq((0..3).map(|at| vec![0, at, 0, line])));
        }
    }
}
