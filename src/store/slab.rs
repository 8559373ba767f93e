//! Slabs of a variable over a study's axes, small enough to be held in memory one at a time.

use std::collections::BTreeMap;

use ndarray::{ArrayD, IxDyn};

use super::Values;
use super::catalogue::OUTCOME;

/// Largest slab of a variable, for studies of every size [numbers].
pub const MOST_NUMBERS: usize = 1 << 23;

/// The category of a case that has not been computed.
pub const MISSING: (i64, &str) = (-1, "missing");

/// The category of a case of a refined study that has not been computed, as it lies among cases that lead to one attractor.
pub const INFERRED: (i64, &str) = (-2, "inferred");

/// A box of a study's cases: its first position and its length along each axis, slowest first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Slab {
    /// First position along each axis.
    pub start: Vec<usize>,
    /// Positions along each axis.
    pub count: Vec<usize>,
}

impl Slab {
    /// All cases of a study of so many values along each axis.
    pub fn whole(shape: &[usize]) -> Slab {
        Slab { start: vec![0; shape.len()], count: shape.to_vec() }
    }

    /// The part of an array over these dimensions where some of them are held at a place.
    pub fn at(dimensions: &[String], shape: &[usize], held: &BTreeMap<String, usize>) -> Slab {
        let mut slab = Slab::whole(shape);
        for (axis, name) in dimensions.iter().enumerate() {
            if let Some(&place) = held.get(name) {
                (slab.start[axis], slab.count[axis]) = (place, 1);
            }
        }
        slab
    }

    /// Number of cases.
    pub fn cases(&self) -> usize {
        self.count.iter().product()
    }

    /// The place of a case of a study of the given shape among those of the slab; none if it is outside.
    pub fn place(&self, shape: &[usize], case: usize) -> Option<usize> {
        let (mut rest, mut place, mut spacing) = (case, 0, 1);
        for axis in (0..shape.len()).rev() {
            let inside = (rest % shape[axis]).checked_sub(self.start[axis])?;
            if inside >= self.count[axis] {
                return None;
            }
            place += inside * spacing;
            spacing *= self.count[axis];
            rest /= shape[axis];
        }
        Some(place)
    }

    /// The least and the greatest index of its cases in a study of the given shape.
    pub fn bounds(&self, shape: &[usize]) -> [usize; 2] {
        let ends = self.start.iter().zip(&self.count).map(|(start, count)| start + count - 1);
        [index(shape, self.start.iter().copied()), index(shape, ends)]
    }

    /// Its parts of so many positions along an axis, of which the last may have fewer.
    fn divided(&self, axis: usize, length: usize) -> Vec<Slab> {
        let mut parts = Vec::new();
        for from in (0..self.count[axis]).step_by(length) {
            let mut part = self.clone();
            part.start[axis] += from;
            part.count[axis] = length.min(self.count[axis] - from);
            parts.push(part);
        }
        parts
    }
}

/// The index of the case at a position in a study of the given shape.
fn index(shape: &[usize], position: impl Iterator<Item = usize>) -> usize {
    shape.iter().zip(position).fold(0, |index, (length, at)| index * length + at)
}

/// Divides a study of the given shape into slabs of at most `most` cases, or of one chunk if that has more;
/// no chunk is in two slabs.
pub fn slabs(shape: &[usize], chunk: &[usize], most: usize) -> Vec<Slab> {
    let mut slabs = vec![Slab::whole(shape)];
    for (axis, side) in chunk.iter().enumerate() {
        if slabs[0].cases() <= most {
            break;
        }
        let across = slabs[0].cases() / slabs[0].count[axis];
        let length = (most / across / side).max(1) * side;
        slabs = slabs.iter().flat_map(|slab| slab.divided(axis, length)).collect();
    }
    slabs
}

/// The numbers of a variable at the cases of a slab, most of which may still be missing.
pub struct Filling {
    numbers: Numbers,
    /// Numbers of each case.
    width: usize,
    shape: Vec<usize>,
}

enum Numbers {
    Real(Vec<f64>),
    Integer(Vec<i64>),
}

impl Filling {
    /// The variable `name` without any case; of `model`, which is what a block has of it, the kind of
    /// numbers and how many each case has are taken.
    pub fn new(slab: &Slab, name: &str, model: &Values) -> Filling {
        let inner = &model.shape()[1..];
        let width = inner.iter().product();
        let length = slab.cases() * width;
        let numbers = match model {
            Values::Real(_) => Numbers::Real(vec![f64::NAN; length]),
            // Zero stands for no period, no failure, no proof; an outcome has no such number.
            Values::Integer(_) => {
                let nothing = if name == OUTCOME.name { MISSING.0 } else { 0 };
                Numbers::Integer(vec![nothing; length])
            }
        };
        let shape = slab.count.iter().chain(inner).copied().collect();
        Filling { numbers, width, shape }
    }

    /// Puts reals in the places of their cases; what has no place is left out.
    ///
    /// # Panics
    ///
    /// If the variable is one of integers.
    pub fn put_reals(&mut self, places: impl Iterator<Item = Option<usize>>, own: &[f64]) {
        let Numbers::Real(all) = &mut self.numbers else { panic!("the variable is of integers") };
        put_rows(all, self.width, places, own);
    }

    /// Puts integers in the places of their cases; what has no place is left out.
    ///
    /// # Panics
    ///
    /// If the variable is one of reals.
    pub fn put_integers(&mut self, places: impl Iterator<Item = Option<usize>>, own: &[i64]) {
        let Numbers::Integer(all) = &mut self.numbers else { panic!("the variable is of reals") };
        put_rows(all, self.width, places, own);
    }

    /// Puts one integer in some places, of a variable that has one for each case.
    ///
    /// # Panics
    ///
    /// If the variable is one of reals.
    pub fn put_each(&mut self, places: impl Iterator<Item = Option<usize>>, number: i64) {
        let Numbers::Integer(all) = &mut self.numbers else { panic!("the variable is of reals") };
        places.flatten().for_each(|place| all[place] = number);
    }

    /// The numbers over the axes of the slab.
    pub fn finish(self) -> Values {
        let shape = IxDyn(&self.shape);
        let fits = "as many numbers as the shape has";
        match self.numbers {
            Numbers::Real(all) => Values::Real(ArrayD::from_shape_vec(shape, all).expect(fits)),
            Numbers::Integer(all) => {
                Values::Integer(ArrayD::from_shape_vec(shape, all).expect(fits))
            }
        }
    }
}

fn put_rows<T: Copy>(
    all: &mut [T],
    width: usize,
    places: impl Iterator<Item = Option<usize>>,
    own: &[T],
) {
    for (place, row) in places.zip(own.chunks_exact(width)) {
        if let Some(place) = place {
            all[place * width..(place + 1) * width].copy_from_slice(row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_has_its_place_in_one_slab() {
        let shape = [7, 5, 9, 2];
        let chunk = [3, 2, 4, 2];
        for most in [1, 10, 24, 48, 100, 200, 10_000] {
            let slabs = slabs(&shape, &chunk, most);
            assert!(slabs.iter().all(|slab| slab.cases() <= most.max(48)));
            let mut seen = vec![0; shape.iter().product()];
            for slab in &slabs {
                let of = |case| slab.place(&shape, case).map(|place| (place, case));
                let mut places: Vec<(usize, usize)> = (0..seen.len()).filter_map(of).collect();
                let [first, last] = slab.bounds(&shape);
                assert_eq!((places[0].1, places[places.len() - 1].1), (first, last));
                places.iter().for_each(|(_, case)| seen[*case] += 1);
                places.sort_unstable();
                assert!(places.iter().map(|(place, _)| *place).eq(0..slab.cases()));
                assert!(places.is_sorted_by_key(|(_, case)| *case));
            }
            assert!(seen.iter().all(|&count| count == 1), "{most}");
        }
    }

    #[test]
    fn a_study_of_one_case_is_one_slab() {
        assert_eq!(slabs(&[], &[], 1), [Slab { start: vec![], count: vec![] }]);
        assert_eq!(Slab::whole(&[]).place(&[], 0), Some(0));
    }
}
