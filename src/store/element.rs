//! The types of the numbers of variables, the same for every form in which they are handed out.

use super::{Values, Variable};

/// The type of a variable's numbers in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Element {
    /// Eight bytes, a real.
    Real,
    /// One byte.
    Byte,
    /// Four bytes.
    Int,
    /// Eight bytes.
    Long,
}

impl Element {
    /// The narrowest type for the numbers of a variable, of which those that are integers are in `range`.
    pub fn of(variable: &Variable, range: Option<[i64; 2]>) -> Element {
        if let Values::Real(_) = variable.values {
            return Element::Real;
        }
        let flags = variable.flags.iter().map(|(value, _)| *value);
        let all: Vec<i64> = range.into_iter().flatten().chain(flags).collect();
        match () {
            () if !variable.flags.is_empty() && fit::<i8>(&all) => Element::Byte,
            () if fit::<i32>(&all) => Element::Int,
            () => Element::Long,
        }
    }

    /// Bytes of a number.
    pub fn bytes(self) -> usize {
        match self {
            Element::Byte => 1,
            Element::Int => 4,
            Element::Real | Element::Long => 8,
        }
    }
}

/// Whether all numbers are some of a type.
fn fit<T: TryFrom<i64>>(numbers: &[i64]) -> bool {
    numbers.iter().all(|number| T::try_from(*number).is_ok())
}
