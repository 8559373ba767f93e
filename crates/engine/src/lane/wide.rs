//! Several vectors side by side, so that the operations of one fill the waits of another.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::unrolled::unrolled;
use super::{Lane, Mask, Part};

/// `M` groups of lanes, or of their truth values, each treated exactly as it would be alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wide<L, const M: usize>(pub [L; M]);

macro_rules! by_group {
    ($bound:ident, $($trait:ident $name:ident),*) => {$(
        impl<L: $bound, const M: usize> $trait for Wide<L, M> {
            type Output = Self;
            #[inline(always)]
            fn $name(mut self, other: Self) -> Self {
                unrolled!(i < M, {
                    self.0[i] = self.0[i].$name(other.0[i]);
                });
                self
            }
        }
    )*};
}

by_group!(Lane, Add add, Sub sub, Mul mul, Div div);
by_group!(Mask, BitAnd bitand, BitOr bitor);

impl<L: Lane, const M: usize> Neg for Wide<L, M> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        unrolled!(i < M, {
            self.0[i] = -self.0[i];
        });
        self
    }
}

impl<K: Mask, const M: usize> Not for Wide<K, M> {
    type Output = Self;
    #[inline(always)]
    fn not(mut self) -> Self {
        unrolled!(i < M, {
            self.0[i] = !self.0[i];
        });
        self
    }
}

impl<K: Mask, const M: usize> Mask for Wide<K, M> {
    const WIDTH: usize = M * K::WIDTH;

    #[inline(always)]
    fn from_bits(bits: u64) -> Self {
        let mut mask = Wide([K::splat(false); M]);
        unrolled!(i < M, {
            mask.0[i] = K::from_bits(bits >> (i * K::WIDTH));
        });
        mask
    }
    #[inline(always)]
    fn bits(self) -> u64 {
        let mut bits = 0;
        unrolled!(i < M, {
            bits |= self.0[i].bits() << (i * K::WIDTH);
        });
        bits
    }
}

macro_rules! each {
    ($self:expr, $of:expr) => {{
        let mut result = $self;
        unrolled!(i < M, {
            result.0[i] = $of(i);
        });
        result
    }};
}

impl<L: Lane, const M: usize> Lane for Wide<L, M> {
    type Mask = Wide<L::Mask, M>;
    const WIDTH: usize = M * L::WIDTH;
    const ZERO: Self = Wide([L::ZERO; M]);
    super::plain!();

    #[inline(always)]
    fn apart<P: Part>(part: P) -> P::Output {
        L::apart(part)
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        each!(Self::ZERO, |_| L::splat(value))
    }
    #[inline(always)]
    fn from_fn(mut value: impl FnMut(usize) -> f64) -> Self {
        let mut result = Self::ZERO;
        unrolled!(i < M, {
            result.0[i] = L::from_fn(|lane| value(i * L::WIDTH + lane));
        });
        result
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.0[index / L::WIDTH].lane(index % L::WIDTH)
    }
    #[inline(always)]
    fn with_lane(mut self, index: usize, value: f64) -> Self {
        let group = &mut self.0[index / L::WIDTH];
        *group = group.with_lane(index % L::WIDTH, value);
        self
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        each!(yes, |i: usize| L::select(mask.0[i], yes.0[i], no.0[i]))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        let mut mask = Self::Mask::splat(false);
        unrolled!(i < M, {
            mask.0[i] = self.0[i].lt(other.0[i]);
        });
        mask
    }
    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        let mut mask = Self::Mask::splat(false);
        unrolled!(i < M, {
            mask.0[i] = self.0[i].le(other.0[i]);
        });
        mask
    }
    #[inline(always)]
    fn abs(self) -> Self {
        each!(self, |i: usize| self.0[i].abs())
    }
    #[inline(always)]
    fn exp2_whole(self) -> Self {
        each!(self, |i: usize| self.0[i].exp2_whole())
    }
    #[inline(always)]
    fn rough_log(self) -> Self {
        each!(self, |i: usize| self.0[i].rough_log())
    }
    #[inline(always)]
    fn fraction_and_exponent(self) -> (Self, Self) {
        let (mut fractions, mut exponents) = (self, self);
        unrolled!(i < M, {
            (fractions.0[i], exponents.0[i]) = self.0[i].fraction_and_exponent();
        });
        (fractions, exponents)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        each!(self, |i: usize| self.0[i].sqrt())
    }
    #[inline(always)]
    fn rough_exp(self) -> Self {
        each!(self, |i: usize| self.0[i].rough_exp())
    }
}
