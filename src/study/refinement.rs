//! Which cases of a grid are computed where it is refined between cases that differ, and which are inferred.

use crate::description::Output;

/// The most axes of a refined grid.
pub const AXES: usize = 5;

/// The first cells of a grid: so many at least along the shortest axis, by the number of its axes.
const COARSE: [usize; AXES] = [64, 64, 16, 8, 4];

/// The sides of a tile have about so many cells, by the number of its axes.
const TILE: [usize; AXES] = [16384, 128, 32, 8, 8];

/// The position of a case along each axis; axes that a grid lacks come first and have one value.
type Position = [usize; AXES];

/// What tells the cases of a refined grid apart.
#[derive(Debug, Clone, PartialEq)]
pub enum Refine {
    /// The attractors that starts lead to.
    Attractors,
    /// The periods, and some outputs, each with the most by which two known cases of a cell may differ [SI].
    Outputs(Vec<(Output, f64)>),
}

/// How a grid is refined.
///
/// Method: coarse cells with a case at each corner are halved along every axis, again and again, where two of the cases that
/// are known in a cell or on its boundary differ, until the cases are neighbours. A case that is never computed lies in a cell
/// all of whose known cases are alike, and is inferred to be like them; what lies between them and touches none of them is
/// missed. A tile is a box of coarse cells; it has the cases on all of its boundary, so that it can be refined without the
/// others, and what enters it from a neighbour is refined once all tiles are there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refinement {
    /// The last value of each axis.
    last: Position,
    /// How far apart the corners of a coarse cell are; a power of two.
    spacing: usize,
    /// How far apart those of a tile are.
    side: usize,
}

/// A box of a grid; its ends are part of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Region {
    low: Position,
    high: Position,
}

/// A cell, by its least corner and how far its corners are apart, as far as the grid goes.
#[derive(Debug, Clone, Copy)]
struct Cell {
    low: Position,
    size: usize,
}

/// What is known of the cases of a tile, or of a whole grid.
#[derive(Debug, Clone)]
pub struct Refining<T> {
    refinement: Refinement,
    region: Region,
    /// The label of each case of the region; none where it has not been computed.
    labels: Vec<Option<T>>,
    alike: fn(&T, &T) -> bool,
}

impl Refinement {
    /// That of a grid of so many values along each axis; there are five axes at most.
    pub fn of(shape: &[usize]) -> Refinement {
        let mut last = [0; AXES];
        for (last, length) in last[AXES - shape.len()..].iter_mut().zip(shape) {
            *last = length.saturating_sub(1);
        }
        let shortest = last.iter().copied().filter(|length| *length > 0).min().unwrap_or(1);
        let dimension = shape.len().clamp(1, AXES) - 1;
        let mut spacing = 1;
        while shortest / (2 * spacing) >= COARSE[dimension] {
            spacing *= 2;
        }
        Refinement { last, spacing, side: TILE[dimension].max(spacing) }
    }

    /// The same with tiles of so many coarse cells along each axis: many and small, as a sample wants them.
    pub fn with_tiles_of(&self, cells: usize) -> Refinement {
        Refinement { side: cells * self.spacing, ..self.clone() }
    }

    /// Tiles along each axis.
    fn tiles_along(&self) -> Position {
        self.last.map(|last| last.div_ceil(self.side).max(1))
    }

    /// Number of tiles.
    pub fn tiles(&self) -> usize {
        self.tiles_along().iter().product()
    }

    /// The least corner of a tile.
    fn corner(&self, mut tile: usize) -> Position {
        let mut low = [0; AXES];
        for (low, tiles) in low.iter_mut().zip(self.tiles_along()).rev() {
            *low = tile % tiles * self.side;
            tile /= tiles;
        }
        low
    }

    /// A tile with the cases on all of its boundary.
    fn region(&self, tile: usize) -> Region {
        let low = self.corner(tile);
        Region { low, high: self.at_most(&low, self.side) }
    }

    /// The cases of a tile, in the order of their indices; each case belongs to one tile.
    pub fn cases(&self, tile: usize) -> Vec<usize> {
        let mut cases = Vec::new();
        self.own(tile).each(|at| cases.push(self.index(&at)));
        cases
    }

    /// Number of cases of a tile.
    pub fn count(&self, tile: usize) -> usize {
        self.own(tile).count()
    }

    /// What a tile has that no later one has.
    fn own(&self, tile: usize) -> Region {
        let mut region = self.region(tile);
        for (high, last) in region.high.iter_mut().zip(self.last) {
            *high -= usize::from(*high < last);
        }
        region
    }

    /// The position so far beyond another along every axis, as far as the grid goes.
    fn at_most(&self, low: &Position, further: usize) -> Position {
        std::array::from_fn(|axis| (low[axis] + further).min(self.last[axis]))
    }

    fn index(&self, at: &Position) -> usize {
        at.iter().zip(self.last).fold(0, |index, (at, last)| index * (last + 1) + at)
    }

    fn position(&self, mut index: usize) -> Position {
        let mut at = [0; AXES];
        for (at, last) in at.iter_mut().zip(self.last).rev() {
            *at = index % (last + 1);
            index /= last + 1;
        }
        at
    }
}

impl Region {
    fn count(&self) -> usize {
        self.low.iter().zip(self.high).map(|(low, high)| high + 1 - low).product()
    }

    /// The place of a position among those of the region; none if it is outside.
    fn place(&self, at: &Position) -> Option<usize> {
        let mut place = 0;
        for ((low, high), at) in self.low.iter().zip(self.high).zip(at) {
            if !(*low..=high).contains(at) {
                return None;
            }
            place = place * (high + 1 - low) + at - low;
        }
        Some(place)
    }

    /// The weight of one of its corners in linear interpolation at a position inside.
    fn weight(&self, corner: &Position, at: &Position) -> f64 {
        let along = (0..AXES).map(|axis| match self.high[axis] - self.low[axis] {
            0 => 1.0,
            length => 1.0 - corner[axis].abs_diff(at[axis]) as f64 / length as f64,
        });
        along.product()
    }

    /// Calls a function with each position, the last axis fastest.
    fn each(&self, mut call: impl FnMut(Position)) {
        let mut at = self.low;
        loop {
            call(at);
            let Some(axis) = (0..AXES).rev().find(|&axis| at[axis] < self.high[axis]) else {
                return;
            };
            at[axis] += 1;
            at[axis + 1..].copy_from_slice(&self.low[axis + 1..]);
        }
    }
}

/// Calls a function with every combination of some values along each axis, the last axis fastest.
fn each_of(values: &[Vec<usize>; AXES], mut call: impl FnMut(Position)) {
    let places = values.each_ref().map(|values| values.len() - 1);
    Region { low: [0; AXES], high: places }
        .each(|place| call(std::array::from_fn(|axis| values[axis][place[axis]])));
}

impl<T> Refining<T> {
    /// A tile of which no case is known; labels that are not `alike`, a label with itself included, are told apart.
    pub fn tile(refinement: &Refinement, tile: usize, alike: fn(&T, &T) -> bool) -> Self {
        Refining::new(refinement, refinement.region(tile), alike)
    }

    /// The whole grid, of which no case is known.
    pub fn whole(refinement: &Refinement, alike: fn(&T, &T) -> bool) -> Self {
        Refining::new(refinement, Region { low: [0; AXES], high: refinement.last }, alike)
    }

    fn new(refinement: &Refinement, region: Region, alike: fn(&T, &T) -> bool) -> Self {
        let labels = (0..region.count()).map(|_| None).collect();
        Refining { refinement: refinement.clone(), region, labels, alike }
    }

    /// Notes the label of a case that has been computed.
    pub fn note(&mut self, case: usize, label: T) {
        if let Some(place) = self.region.place(&self.refinement.position(case)) {
            self.labels[place] = Some(label);
        }
    }

    fn label(&self, at: &Position) -> Option<&T> {
        self.labels[self.region.place(at)?].as_ref()
    }

    /// The cases that are to be computed next, in the order of their indices; none once all cells are alike or as small as
    /// they get.
    pub fn wanted(&self) -> Vec<usize> {
        let mut wanted = Vec::new();
        self.each_coarse(|cell| self.visit(cell, &mut wanted));
        wanted.sort_unstable();
        wanted.dedup();
        wanted
    }

    /// Calls a function with each case that has not been computed, and the labels of the corners of the cell in which it lies,
    /// each with its weight in linear interpolation over the places along the axes; the least corner first.
    pub fn inferred(&self, mut call: impl FnMut(usize, &[(f64, &T)])) {
        self.each_coarse(|cell| self.infer(cell, &mut call));
    }

    fn each_coarse(&self, mut call: impl FnMut(Cell)) {
        let Refinement { spacing, .. } = self.refinement;
        let Region { low, high } = self.region;
        let firsts: [Vec<usize>; AXES] = std::array::from_fn(|axis| {
            // An axis of one value has one cell, too.
            (low[axis]..high[axis].max(low[axis] + 1)).step_by(spacing).collect()
        });
        each_of(&firsts, |low| call(Cell { low, size: spacing }));
    }

    /// The cases that a cell lacks.
    fn visit(&self, cell: Cell, wanted: &mut Vec<usize>) {
        if self.lacks(&self.corners(cell), wanted) || cell.size == 1 || !self.is_split(cell) {
            return;
        }
        if !self.lacks(&self.halves(cell), wanted) {
            self.each_child(cell, |child| self.visit(child, wanted));
        }
    }

    fn infer(&self, cell: Cell, call: &mut impl FnMut(usize, &[(f64, &T)])) {
        if cell.size == 1 {
            return;
        }
        if self.is_split(cell) {
            return self.each_child(cell, |child| self.infer(child, call));
        }
        let inside = self.box_of(cell);
        let mut corners = Vec::new();
        each_of(&self.corners(cell), |at| corners.push((at, self.label(&at))));
        let known: Option<Vec<(Position, &T)>> =
            corners.into_iter().map(|(at, label)| Some((at, label?))).collect();
        let Some(corners) = known else { return };
        let mut weighted: Vec<(f64, &T)> = corners.iter().map(|(_, label)| (0.0, *label)).collect();
        inside.each(|at| {
            if self.label(&at).is_none() {
                for ((weight, _), (corner, _)) in weighted.iter_mut().zip(&corners) {
                    *weight = inside.weight(corner, &at);
                }
                call(self.refinement.index(&at), &weighted);
            }
        });
    }

    /// Adds those of some cases that have not been computed, and tells whether there are any.
    fn lacks(&self, cases: &[Vec<usize>; AXES], wanted: &mut Vec<usize>) -> bool {
        let before = wanted.len();
        each_of(cases, |at| {
            if self.label(&at).is_none() {
                wanted.push(self.refinement.index(&at));
            }
        });
        wanted.len() > before
    }

    /// Whether a cell whose corners are known is divided: two of its known cases differ, or it has been divided before.
    fn is_split(&self, cell: Cell) -> bool {
        let Region { low, high } = self.box_of(cell);
        let half = cell.size / 2;
        let middle = std::array::from_fn(|axis| (low[axis] + half).min(high[axis]));
        // Where the grid ends within its first half, a cell is that half.
        let is_half = middle == high;
        if is_half || self.label(&middle).is_some() {
            return true;
        }
        let mut differ = false;
        if let Some(first) = self.label(&low) {
            self.box_of(cell).each(|at| {
                differ |= self.label(&at).is_some_and(|other| !(self.alike)(first, other));
            });
        }
        differ
    }

    fn box_of(&self, cell: Cell) -> Region {
        Region { low: cell.low, high: self.refinement.at_most(&cell.low, cell.size) }
    }

    /// The positions of the corners of a cell along each axis.
    fn corners(&self, cell: Cell) -> [Vec<usize>; AXES] {
        let Region { low, high } = self.box_of(cell);
        std::array::from_fn(|axis| {
            let mut values = vec![low[axis], high[axis]];
            values.dedup();
            values
        })
    }

    /// The positions of the corners of its halves.
    fn halves(&self, cell: Cell) -> [Vec<usize>; AXES] {
        let Region { low, high } = self.box_of(cell);
        std::array::from_fn(|axis| {
            let middle = (low[axis] + cell.size / 2).min(high[axis]);
            let mut values = vec![low[axis], middle, high[axis]];
            values.dedup();
            values
        })
    }

    fn each_child(&self, cell: Cell, mut call: impl FnMut(Cell)) {
        let size = cell.size / 2;
        let high = self.box_of(cell).high;
        let firsts = std::array::from_fn(|axis| {
            let low = cell.low[axis];
            [low, low + size].into_iter().filter(|at| *at == low || *at < high[axis]).collect()
        });
        each_of(&firsts, |low| call(Cell { low, size }));
    }
}
