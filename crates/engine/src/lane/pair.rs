//! Two lanes in plain Rust, which compilers put into the registers that every machine of an architecture has:
//! SSE2 on x86-64, NEON on 64-bit Arm.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::{Lane, Mask};

/// Two numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(16))]
pub struct Pair([f64; 2]);

/// Two truths, each all bits of a word or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(align(16))]
pub struct PairMask([u64; 2]);

macro_rules! by_lane {
    ($type:ident, $($trait:ident $name:ident),*) => {$(
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                $type([self.0[0].$name(other.0[0]), self.0[1].$name(other.0[1])])
            }
        }
    )*};
}

by_lane!(Pair, Add add, Sub sub, Mul mul, Div div);
by_lane!(PairMask, BitAnd bitand, BitOr bitor);

impl Neg for Pair {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Pair([-self.0[0], -self.0[1]])
    }
}

impl Not for PairMask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        PairMask([!self.0[0], !self.0[1]])
    }
}

#[inline(always)]
fn word(truth: bool) -> u64 {
    u64::from(truth).wrapping_neg()
}

impl Mask for PairMask {
    const WIDTH: usize = 2;

    #[inline(always)]
    fn from_bits(bits: u64) -> Self {
        PairMask([word(bits & 1 != 0), word(bits & 2 != 0)])
    }
    #[inline(always)]
    fn bits(self) -> u64 {
        (self.0[0] & 1) | (self.0[1] & 2)
    }
}

impl Lane for Pair {
    type Mask = PairMask;
    const WIDTH: usize = 2;
    const ZERO: Self = Pair([0.0; 2]);
    super::plain!();
    super::everywhere!();

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Pair([value; 2])
    }
    #[inline(always)]
    fn from_fn(mut value: impl FnMut(usize) -> f64) -> Self {
        Pair([value(0), value(1)])
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.0[index]
    }
    #[inline(always)]
    fn with_lane(mut self, index: usize, value: f64) -> Self {
        self.0[index] = value;
        self
    }
    #[inline(always)]
    fn select(mask: PairMask, yes: Self, no: Self) -> Self {
        let pick = |i: usize| {
            f64::from_bits((mask.0[i] & yes.0[i].to_bits()) | (!mask.0[i] & no.0[i].to_bits()))
        };
        Pair([pick(0), pick(1)])
    }
    #[inline(always)]
    fn lt(self, other: Self) -> PairMask {
        PairMask([word(self.0[0] < other.0[0]), word(self.0[1] < other.0[1])])
    }
    #[inline(always)]
    fn le(self, other: Self) -> PairMask {
        PairMask([word(self.0[0] <= other.0[0]), word(self.0[1] <= other.0[1])])
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Pair([self.0[0].abs(), self.0[1].abs()])
    }
    #[inline(always)]
    fn exp2_whole(self) -> Self {
        Pair([self.0[0].exp2_whole(), self.0[1].exp2_whole()])
    }
    #[inline(always)]
    fn rough_log(self) -> Self {
        Pair([self.0[0].rough_log(), self.0[1].rough_log()])
    }
    #[inline(always)]
    fn fraction_and_exponent(self) -> (Self, Self) {
        let [first, second] = self.0;
        let (first, second) = (first.fraction_and_exponent(), second.fraction_and_exponent());
        (Pair([first.0, second.0]), Pair([first.1, second.1]))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Pair([self.0[0].sqrt(), self.0[1].sqrt()])
    }
    #[inline(always)]
    fn rough_exp(self) -> Self {
        Pair([self.0[0].rough_exp(), self.0[1].rough_exp()])
    }
}
