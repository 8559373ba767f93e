//! The columns of a block, and how their numbers are packed.

use std::io::{self, BufWriter, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// The numbers of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Numbers {
    /// Quantities; a missing one is NaN.
    Real(Vec<f64>),
    /// Counts and categories.
    Integer(Vec<i64>),
}

/// The numbers of one variable at the cases of a block: the same count for each case, case by case.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of the variable.
    pub name: String,
    /// Its numbers.
    pub numbers: Numbers,
}

impl Numbers {
    /// The least and the greatest of integers, the other way round if there are none; none for reals.
    pub(super) fn range(&self) -> Option<[i64; 2]> {
        let Numbers::Integer(all) = self else { return None };
        let none = [i64::MAX, i64::MIN];
        Some(all.iter().fold(none, |[low, high], it| [low.min(*it), high.max(*it)]))
    }
}

/// The deflated bytes of numbers, lowest byte first.
pub(super) fn pack(numbers: &Numbers) -> io::Result<Vec<u8>> {
    // The encoder clears its room for output at every call, so that it is given many numbers at a time.
    let mut encoder = BufWriter::new(ZlibEncoder::new(Vec::new(), Compression::fast()));
    match numbers {
        Numbers::Real(reals) => {
            reals.iter().try_for_each(|it| encoder.write_all(&it.to_bits().to_le_bytes()))?;
        }
        Numbers::Integer(integers) => {
            integers.iter().try_for_each(|it| encoder.write_all(&it.to_le_bytes()))?;
        }
    }
    encoder.into_inner()?.finish()
}
