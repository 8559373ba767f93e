//! Computed: the numbers of the program, one case as an `f64` or several side by side.
//!
//! The integrator is written once over [`Lane`]. Only additions, multiplications, divisions and
//! square roots occur, which IEEE 754 rounds the same way on every machine, and no
//! multiply-add is fused; so a case has the same bits alone, among others, and anywhere.

pub mod elementary;
pub mod series;
mod wide;

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

pub use series::{ORDER, Series};
pub use wide::{Wide, WideMask};

/// A truth value per lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// The same truth in every lane.
    fn splat(value: bool) -> Self;
    /// Whether any lane is true.
    fn any(self) -> bool;
}

/// A number per lane.
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A truth value for each number.
    type Mask: Mask;
    /// How many numbers there are.
    const WIDTH: usize;

    /// The number of each lane, by its index.
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self;
    /// The number in lane `index`.
    fn lane(self, index: usize) -> f64;
    /// `yes` where the mask is true, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Whether `self < other`, by lane.
    fn lt(self, other: Self) -> Self::Mask;
    /// Whether `self <= other`, by lane.
    fn le(self, other: Self) -> Self::Mask;
    /// Magnitude.
    fn abs(self) -> Self;
    /// Two to the power of `self`, which holds a whole number in -1022..=1023.
    fn exp2_whole(self) -> Self;
    /// The root of the given degree of a positive number, within 7 % for degree 14 and above.
    ///
    /// Method: the binary exponent and the leading bits of the fraction, read together as a
    /// piecewise linear logarithm, are divided by the degree. It serves step lengths, where a few
    /// percent do not matter but equal bits on every machine do.
    fn rough_root(self, degree: f64) -> Self;

    /// The same number in every lane.
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::from_fn(|_| value)
    }
    /// The lesser of two numbers; `self` when either is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.lt(self), other, self)
    }
    /// The greater of two numbers; `self` when either is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }
}

impl Mask for bool {
    #[inline(always)]
    fn splat(value: bool) -> bool {
        value
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
}

impl Lane for f64 {
    type Mask = bool;
    const WIDTH: usize = 1;

    #[inline(always)]
    fn from_fn(mut value: impl FnMut(usize) -> f64) -> f64 {
        value(0)
    }
    #[inline(always)]
    fn lane(self, _index: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn select(mask: bool, yes: f64, no: f64) -> f64 {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn lt(self, other: f64) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: f64) -> bool {
        self <= other
    }
    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }
    #[inline(always)]
    fn exp2_whole(self) -> f64 {
        f64::from_bits(((self as i64 + 1023) as u64) << 52)
    }
    #[inline(always)]
    fn rough_root(self, degree: f64) -> f64 {
        // The upper half of the bits of 1.0, where the piecewise linear logarithm is zero.
        const LOG_ONE: f64 = 0x3FF0_0000 as f64;
        let log = f64::from((self.to_bits() >> 32) as i32) - LOG_ONE;
        f64::from_bits(((log / degree + LOG_ONE) as i64 as u64) << 32)
    }
}
