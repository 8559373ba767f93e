//! A point of the section of a model: a value for each coordinate of its state that does not drift.

use std::fmt::{self, Debug, Formatter};
use std::ops::{Deref, DerefMut};

use serde::{Serialize, Serializer};

/// Coordinates of a section, at most.
pub const MOST_COORDINATES: usize = 8;

/// A point of the section (SI), in the order of the coordinates of its model; it reads as a slice.
#[derive(Clone, Copy)]
pub struct Section {
    count: u8,
    values: [f64; MOST_COORDINATES],
}

impl Section {
    /// The point with these coordinates.
    ///
    /// # Panics
    /// Where there are more than [`MOST_COORDINATES`].
    pub fn new(coordinates: &[f64]) -> Section {
        assert!(coordinates.len() <= MOST_COORDINATES, "at most {MOST_COORDINATES} coordinates");
        let mut values = [0.0; MOST_COORDINATES];
        values[..coordinates.len()].copy_from_slice(coordinates);
        Section { count: coordinates.len() as u8, values }
    }

    /// Its coordinates; where there is room for more, zeros after them.
    ///
    /// # Panics
    /// Where there is room for fewer.
    pub fn array<const D: usize>(&self) -> [f64; D] {
        assert!(self.len() <= D, "a section point of the model");
        std::array::from_fn(|place| self.get(place).copied().unwrap_or(0.0))
    }
}

impl<const D: usize> From<[f64; D]> for Section {
    fn from(coordinates: [f64; D]) -> Section {
        Section::new(&coordinates)
    }
}

impl FromIterator<f64> for Section {
    fn from_iter<I: IntoIterator<Item = f64>>(coordinates: I) -> Section {
        let mut point = Section::new(&[]);
        for coordinate in coordinates {
            point.values[usize::from(point.count)] = coordinate;
            point.count += 1;
        }
        point
    }
}

impl<'a> IntoIterator for &'a Section {
    type Item = &'a f64;
    type IntoIter = std::slice::Iter<'a, f64>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl Deref for Section {
    type Target = [f64];
    fn deref(&self) -> &[f64] {
        &self.values[..usize::from(self.count)]
    }
}

impl DerefMut for Section {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.values[..usize::from(self.count)]
    }
}

impl PartialEq for Section {
    fn eq(&self, other: &Section) -> bool {
        **self == **other
    }
}

impl<const D: usize> PartialEq<[f64; D]> for Section {
    fn eq(&self, other: &[f64; D]) -> bool {
        **self == other[..]
    }
}

/// As a list.
impl Serialize for Section {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (**self).serialize(serializer)
    }
}

impl Debug for Section {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}
