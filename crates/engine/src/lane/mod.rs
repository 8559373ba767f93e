//! The numbers of the program: one case as an `f64`, or several side by side.
//!
//! The integrator is written once over [`Lane`]. Besides choices and shifts of bits, only additions,
//! multiplications, divisions and square roots occur, which IEEE 754 rounds the same way on every machine,
//! and no multiply-add is fused; so a case has the same bits alone, among others, and anywhere.

pub mod dispatch;
pub mod dual;
pub mod elementary;
mod in_lanes;
mod order;
mod pair;
mod part;
pub mod quadrature;
pub mod series;
mod side_by_side;
mod unrolled;
mod wide;
mod work;
#[cfg(target_arch = "x86_64")]
mod x86;

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

pub use dispatch::Instructions;
pub use dual::Dual;
pub use order::{ORDER, Series};
pub use pair::Pair;
pub use part::Part;
pub use side_by_side::SideBySide;
pub use wide::Wide;
pub use work::Work;

pub use crate::{in_lanes, side_by_side};

/// Adding and subtracting this rounds a number of moderate size to the nearest whole one.
const ROUNDER: f64 = 1.5 * WHOLE;
/// Added to a whole number of 0..2^52, this leaves it in the low bits of the sum.
const WHOLE: f64 = 4_503_599_627_370_496.0;
/// The bits of a number's exponent.
const INFINITE: u64 = f64::INFINITY.to_bits();
/// The upper half of the bits of 1.0, where the piecewise linear logarithm is zero.
const LOG_ONE: f64 = 0x3FF0_0000 as f64;
/// How much the upper half of the bits grows when a number doubles.
const LOG_UNIT: f64 = 0x0010_0000 as f64;

/// A truth value per lane.
pub trait Mask:
    Copy + Send + Sync + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// How many there are, at most 64.
    const WIDTH: usize;
    /// The truths from bits, that of lane 0 the lowest.
    fn from_bits(bits: u64) -> Self;
    /// The truths as bits.
    fn bits(self) -> u64;
    /// The same truth in every lane.
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Self::from_bits(if value { u64::MAX } else { 0 })
    }
    /// The truth in lane `index`.
    #[inline(always)]
    fn lane(self, index: usize) -> bool {
        self.bits() >> index & 1 != 0
    }
    /// The same truths but for lane `index`.
    #[inline(always)]
    fn with_lane(self, index: usize, value: bool) -> Self {
        let others = self.bits() & !(1 << index);
        Self::from_bits(others | u64::from(value) << index)
    }
    /// Whether any lane is true.
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
}

/// A number per lane.
pub trait Lane:
    Copy
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A truth value for each number.
    type Mask: Mask;
    /// The numbers without their derivatives; themselves where they have none.
    type Plain: Lane<Mask = Self::Mask, Plain = Self::Plain>;
    /// One, and one more for each derivative.
    const PARTS: usize;
    /// How many numbers there are.
    const WIDTH: usize;
    /// Zero in every lane.
    const ZERO: Self;

    /// The number of each lane, by its index.
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self;
    /// The number in lane `index`.
    fn lane(self, index: usize) -> f64;
    /// The same numbers but for lane `index`.
    fn with_lane(self, index: usize, value: f64) -> Self;
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
    /// Logarithm to base 2 of a positive number, within 0.09.
    ///
    /// Method: the binary exponent and the leading bits of the fraction, read together as a number, which
    /// makes a piecewise linear logarithm. It serves step lengths, where a few percent do not matter
    /// but equal bits on every machine do. Zero counts as 2^-1023.
    fn rough_log(self) -> Self;
    /// The fraction `f` and the whole exponent `n` of a positive normal number, which is `f 2^n` with
    /// `1 <= f < 2`; both are exact.
    fn fraction_and_exponent(self) -> (Self, Self);
    /// The square root, correctly rounded; NaN for negative numbers.
    fn sqrt(self) -> Self;
    /// The values of `function` at this number, with the derivatives that the function states.
    fn apply<F: Differentiable<M>, const M: usize>(self, function: &F) -> [Self; M];
    /// The inverse of `rough_log`, for numbers in -1022..=1023; to 20 bits of the fraction.
    fn rough_exp(self) -> Self;

    /// Does a part of a step in a function of its own, with the instructions of these lanes.
    fn apart<P: Part>(part: P) -> P::Output;

    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// The nearest whole number, for magnitudes below 2^51.
    #[inline(always)]
    fn nearest_whole(self) -> Self {
        (self + Self::splat(ROUNDER)) - Self::splat(ROUNDER)
    }
    /// The number itself (0) or one of its derivatives.
    fn part(self, index: usize) -> Self::Plain;
    /// A number whose derivatives are zero.
    fn from_plain(value: Self::Plain) -> Self;
    /// A known root of `polynomial`, with the derivatives that those of the polynomial give it.
    fn root(value: Self::Plain, polynomial: &Series<Self>) -> Self;
    /// Times a number without derivatives.
    fn scaled(self, by: Self::Plain) -> Self;
    /// The value of `polynomial` at time `h`, by Horner's rule.
    fn value_at(polynomial: &Series<Self>, h: Self) -> Self;
    /// Coefficient `k + 1` of the exponential `e` of a series `a`, where `a' = factor b`.
    ///
    /// Method: `e_(k+1) = (factor/(k + 1)) sum_{j=0..k} e_j b_(k-j)`, from `e' = a' e`; the derivatives are those of `a`
    /// times `e`, one product for each, where a product of numbers with derivatives takes two. Of numbers without derivatives
    /// `a` is not read.
    fn exp_next(
        e: &Series<Self>,
        b: &Series<Self>,
        factor: Self,
        a: &Series<Self>,
        k: usize,
    ) -> Self;
    /// A series without its derivatives: itself where it has none, or copied to `room`.
    fn plain_series<'a>(
        series: &'a mut Series<Self>,
        room: &'a mut Series<Self::Plain>,
    ) -> &'a mut Series<Self::Plain>;
    /// The same with what another has in lane `index`, derivatives included.
    #[inline(always)]
    fn with_lane_of(self, index: usize, other: Self) -> Self {
        Self::select(Self::Mask::splat(false).with_lane(index, true), other, self)
    }
    /// The number without its derivatives.
    #[inline(always)]
    fn plain(self) -> Self::Plain {
        self.part(0)
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

/// `M` functions of one argument that share their arithmetic, with their derivatives.
///
/// [`Lane::apply`] applies them. Numbers with derivatives take those of the functions from `slopes`; the
/// arithmetic of `values` is not differentiated, so an approximation in it costs the derivatives no digits.
pub trait Differentiable<const M: usize> {
    /// The functions at `x`.
    fn values<L: Lane>(&self, x: L) -> [L; M];
    /// Their derivatives at `x`, where they have these `values`.
    fn slopes<L: Lane>(&self, x: L, values: [L; M]) -> [L; M];
}

impl Mask for bool {
    const WIDTH: usize = 1;

    #[inline(always)]
    fn from_bits(bits: u64) -> bool {
        bits & 1 != 0
    }
    #[inline(always)]
    fn bits(self) -> u64 {
        u64::from(self)
    }
}

/// What every kind of lane says whose numbers have no derivatives.
macro_rules! plain {
    () => {
        type Plain = Self;
        const PARTS: usize = 1;

        #[inline(always)]
        fn part(self, _index: usize) -> Self {
            self
        }
        #[inline(always)]
        fn from_plain(value: Self) -> Self {
            value
        }
        #[inline(always)]
        fn root(value: Self, _polynomial: &$crate::lane::Series<Self>) -> Self {
            value
        }
        #[inline(always)]
        fn scaled(self, by: Self) -> Self {
            self * by
        }
        #[inline(always)]
        fn value_at(polynomial: &$crate::lane::Series<Self>, h: Self) -> Self {
            let mut sum = polynomial[$crate::lane::ORDER];
            for k in (0..$crate::lane::ORDER).rev() {
                sum = sum * h + polynomial[k];
            }
            sum
        }
        #[inline(always)]
        fn exp_next(
            e: &$crate::lane::Series<Self>,
            b: &$crate::lane::Series<Self>,
            factor: Self,
            _a: &$crate::lane::Series<Self>,
            k: usize,
        ) -> Self {
            let product = $crate::lane::order::product_term(e, b, k);
            (factor * product) * Self::splat($crate::lane::order::INVERSE[k + 1])
        }
        #[inline(always)]
        fn plain_series<'a>(
            series: &'a mut $crate::lane::Series<Self>,
            _room: &'a mut $crate::lane::Series<Self>,
        ) -> &'a mut $crate::lane::Series<Self> {
            series
        }
        #[inline(always)]
        fn apply<F: $crate::lane::Differentiable<COUNT>, const COUNT: usize>(
            self,
            function: &F,
        ) -> [Self; COUNT] {
            function.values(self)
        }
    };
}
use plain;

/// What lanes say whose instructions every processor of the architecture has.
macro_rules! everywhere {
    () => {
        #[inline(never)]
        fn apart<P: $crate::lane::Part>(part: P) -> P::Output {
            part.run()
        }
    };
}
use everywhere;

impl Lane for f64 {
    type Mask = bool;
    const WIDTH: usize = 1;
    const ZERO: Self = 0.0;
    plain!();
    everywhere!();

    #[inline(always)]
    fn from_fn(mut value: impl FnMut(usize) -> f64) -> f64 {
        value(0)
    }
    #[inline(always)]
    fn splat(value: f64) -> f64 {
        value
    }
    #[inline(always)]
    fn lane(self, _index: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn with_lane(self, _index: usize, value: f64) -> f64 {
        value
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
        f64::from_bits((self + (WHOLE + 1023.0)).to_bits() << 52)
    }
    #[inline(always)]
    fn rough_log(self) -> f64 {
        let bits = (self.to_bits() >> 32) | WHOLE.to_bits();
        (f64::from_bits(bits) - (WHOLE + LOG_ONE)) * (1.0 / LOG_UNIT)
    }
    #[inline(always)]
    fn fraction_and_exponent(self) -> (f64, f64) {
        let bits = self.to_bits();
        let fraction = f64::from_bits((bits & !INFINITE) | 1.0_f64.to_bits());
        (fraction, f64::from_bits((bits >> 52) | WHOLE.to_bits()) - (WHOLE + 1023.0))
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn rough_exp(self) -> f64 {
        f64::from_bits((self * LOG_UNIT + (WHOLE + LOG_ONE)).to_bits() << 32)
    }
}
