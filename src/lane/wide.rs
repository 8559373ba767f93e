//! Several numbers side by side, each treated exactly as an `f64` alone would be: the form that a vector of
//! cases runs the same source in. Sweeps run one case at a time so far; the tests hold the bits of both equal.

use std::array;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::{Lane, Mask};

/// `N` numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Wide<const N: usize>(pub [f64; N]);

/// `N` truth values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WideMask<const N: usize>(pub [bool; N]);

macro_rules! by_lane {
    ($type:ident, $($trait:ident $name:ident),*) => {$(
        impl<const N: usize> $trait for $type<N> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(array::from_fn(|i| self.0[i].$name(other.0[i])))
            }
        }
    )*};
}

by_lane!(Wide, Add add, Sub sub, Mul mul, Div div);
by_lane!(WideMask, BitAnd bitand, BitOr bitor);

impl<const N: usize> Neg for Wide<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(array::from_fn(|i| -self.0[i]))
    }
}

impl<const N: usize> Not for WideMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(array::from_fn(|i| !self.0[i]))
    }
}

impl<const N: usize> Mask for WideMask<N> {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().any(|&lane| lane)
    }
}

impl<const N: usize> Lane for Wide<N> {
    type Mask = WideMask<N>;
    const WIDTH: usize = N;

    #[inline(always)]
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self {
        Self(array::from_fn(value))
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.0[index]
    }
    #[inline(always)]
    fn select(mask: WideMask<N>, yes: Self, no: Self) -> Self {
        Self(array::from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> WideMask<N> {
        WideMask(array::from_fn(|i| self.0[i] < other.0[i]))
    }
    #[inline(always)]
    fn le(self, other: Self) -> WideMask<N> {
        WideMask(array::from_fn(|i| self.0[i] <= other.0[i]))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(array::from_fn(|i| self.0[i].abs()))
    }
    #[inline(always)]
    fn exp2_whole(self) -> Self {
        Self(array::from_fn(|i| self.0[i].exp2_whole()))
    }
    #[inline(always)]
    fn rough_root(self, degree: f64) -> Self {
        Self(array::from_fn(|i| self.0[i].rough_root(degree)))
    }
}
