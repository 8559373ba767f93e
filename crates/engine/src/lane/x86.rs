//! AVX2 and AVX-512: vectors of four and eight lanes by the processor's own instructions.
//!
//! The one place of the floor with `unsafe`: an intrinsic may run only where the processor has it. A value of
//! these types comes into being only inside [`with_avx2`] and [`with_avx512`], which ask the processor
//! first; `pub(super)` keeps everyone else from making one. No fused multiply-add is used, so that the
//! bits are those of every other machine.
#![allow(unsafe_code)]

use std::arch::x86_64::*;
use std::mem::transmute;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::part::Part;
use super::work::Work;
use super::{INFINITE, LOG_ONE, LOG_UNIT, Lane, Mask, WHOLE, Wide};

/// Runs `work` on so many vectors of AVX-512, none where the processor lacks it.
pub(super) fn with_avx512<const N: usize, W: Work>(work: W) -> Option<W::Output> {
    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
    fn run<const N: usize, W: Work>(work: W) -> W::Output {
        match const { N } {
            // Much faster to compile than an array of one.
            1 => work.run::<Avx512>(),
            _ => work.run::<Wide<Avx512, N>>(),
        }
    }
    // SAFETY: the processor has what `run` is compiled for.
    has_avx512().then(|| unsafe { run::<N, W>(work) })
}

/// Runs `work` on so many vectors of AVX2, none where the processor lacks it.
pub(super) fn with_avx2<const N: usize, W: Work>(work: W) -> Option<W::Output> {
    #[target_feature(enable = "avx2")]
    fn run<const N: usize, W: Work>(work: W) -> W::Output {
        match const { N } {
            1 => work.run::<Avx2>(),
            _ => work.run::<Wide<Avx2, N>>(),
        }
    }
    // SAFETY: the processor has what `run` is compiled for.
    has_avx2().then(|| unsafe { run::<N, W>(work) })
}

/// Whether this processor has AVX-512 with its double-precision logic.
pub(super) fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512bw")
}

/// Whether this processor has AVX2.
pub(super) fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2")
}

/// Eight lanes.
#[derive(Debug, Clone, Copy)]
#[repr(transparent)]
pub(super) struct Avx512(__m512d);

/// A truth for each of eight lanes.
#[derive(Debug, Clone, Copy)]
#[repr(transparent)]
pub(super) struct Mask8(__mmask8);

/// Four lanes.
#[derive(Debug, Clone, Copy)]
#[repr(transparent)]
pub(super) struct Avx2(__m256d);

/// A truth for each of four lanes: all bits of the lane, or none.
#[derive(Debug, Clone, Copy)]
#[repr(transparent)]
pub(super) struct Mask4(__m256d);

/// An expression of intrinsics that exist wherever a value of this file's types does.
macro_rules! here {
    ($($expression:tt)*) => {
        // SAFETY: see the head of this file.
        unsafe { $($expression)* }
    };
}

macro_rules! by_instruction {
    ($type:ident, $($trait:ident $name:ident $instruction:ident),*) => {$(
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                $type(here!($instruction(self.0, other.0)))
            }
        }
    )*};
}

by_instruction!(Avx512, Add add _mm512_add_pd, Sub sub _mm512_sub_pd, Mul mul _mm512_mul_pd, Div div _mm512_div_pd);
by_instruction!(Avx2, Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd);
by_instruction!(Mask4, BitAnd bitand _mm256_and_pd, BitOr bitor _mm256_or_pd);

impl BitAnd for Mask8 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Mask8(self.0 & other.0)
    }
}

impl BitOr for Mask8 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Mask8(self.0 | other.0)
    }
}

impl Not for Mask8 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Mask8(!self.0)
    }
}

impl Not for Mask4 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Mask4(here!(_mm256_xor_pd(self.0, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)))))
    }
}

impl Mask for Mask8 {
    const WIDTH: usize = 8;

    #[inline(always)]
    fn from_bits(bits: u64) -> Self {
        Mask8(bits as __mmask8)
    }
    #[inline(always)]
    fn bits(self) -> u64 {
        u64::from(self.0)
    }
}

impl Mask for Mask4 {
    const WIDTH: usize = 4;

    #[inline(always)]
    fn from_bits(bits: u64) -> Self {
        let lane = |index: u64| -((bits >> index & 1) as i64);
        Mask4(here!(_mm256_castsi256_pd(_mm256_set_epi64x(lane(3), lane(2), lane(1), lane(0)))))
    }
    #[inline(always)]
    fn bits(self) -> u64 {
        here!(_mm256_movemask_pd(self.0)) as u64
    }
}

/// What both widths do alike, with the integer and the floating forms of their registers.
macro_rules! lanes_alike {
    (
        $width:literal, $wide:ident, $splat:ident, $or:ident, $right:ident, $left:ident,
        $to_integer:ident, $to_double:ident, $andnot:ident, $sqrt:ident
    ) => {
        const WIDTH: usize = $width;
        const ZERO: Self = Self::from_array([0.0; $width]);

        #[inline(always)]
        fn splat(value: f64) -> Self {
            $wide(here!($splat(value)))
        }
        #[inline(always)]
        fn from_fn(mut value: impl FnMut(usize) -> f64) -> Self {
            let mut lanes = [0.0; $width];
            for (index, lane) in lanes.iter_mut().enumerate() {
                *lane = value(index);
            }
            Self::from_array(lanes)
        }
        #[inline(always)]
        fn lane(self, index: usize) -> f64 {
            self.into_array()[index]
        }
        #[inline(always)]
        fn with_lane(self, index: usize, value: f64) -> Self {
            let mut lanes = self.into_array();
            lanes[index] = value;
            Self::from_array(lanes)
        }
        #[inline(always)]
        fn abs(self) -> Self {
            let sign = Self::splat(-0.0).0;
            $wide(here!($to_double($andnot($to_integer(sign), $to_integer(self.0)))))
        }
        #[inline(always)]
        fn exp2_whole(self) -> Self {
            let sum = (self + Self::splat(WHOLE + 1023.0)).0;
            $wide(here!($to_double($left::<52>($to_integer(sum)))))
        }
        #[inline(always)]
        fn rough_log(self) -> Self {
            let whole = Self::splat(WHOLE).0;
            let bits = here!($or($right::<32>($to_integer(self.0)), $to_integer(whole)));
            ($wide(here!($to_double(bits))) - Self::splat(WHOLE + LOG_ONE))
                * Self::splat(1.0 / LOG_UNIT)
        }
        #[inline(always)]
        fn fraction_and_exponent(self) -> (Self, Self) {
            let (one, whole) = (Self::splat(1.0).0, Self::splat(WHOLE).0);
            let exponent = Self::splat(f64::from_bits(INFINITE)).0;
            let fraction = here!($andnot($to_integer(exponent), $to_integer(self.0)));
            let fraction = here!($or(fraction, $to_integer(one)));
            let power = here!($or($right::<52>($to_integer(self.0)), $to_integer(whole)));
            let power = $wide(here!($to_double(power))) - Self::splat(WHOLE + 1023.0);
            ($wide(here!($to_double(fraction))), power)
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            $wide(here!($sqrt(self.0)))
        }
        #[inline(always)]
        fn rough_exp(self) -> Self {
            let sum = (self * Self::splat(LOG_UNIT) + Self::splat(WHOLE + LOG_ONE)).0;
            $wide(here!($to_double($left::<32>($to_integer(sum)))))
        }
    };
}

/// Vectors as arrays of their lanes: moved through memory, which takes no instructions of theirs, so that a lane costs
/// a load where code is compiled without them, too.
macro_rules! array_of_lanes {
    ($wide:ident, $vector:ident, $width:literal) => {
        impl $wide {
            #[inline(always)]
            const fn from_array(lanes: [f64; $width]) -> Self {
                // SAFETY: both are so many numbers, of any bits.
                $wide(unsafe { transmute::<[f64; $width], $vector>(lanes) })
            }
            #[inline(always)]
            fn into_array(self) -> [f64; $width] {
                // SAFETY: the same.
                unsafe { transmute::<$vector, [f64; $width]>(self.0) }
            }
        }
    };
}

array_of_lanes!(Avx512, __m512d, 8);
array_of_lanes!(Avx2, __m256d, 4);

macro_rules! negated {
    ($wide:ident, $xor:ident, $to_integer:ident, $to_double:ident) => {
        impl Neg for $wide {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                let sign = Self::splat(-0.0).0;
                $wide(here!($to_double($xor($to_integer(self.0), $to_integer(sign)))))
            }
        }
    };
}

negated!(Avx512, _mm512_xor_si512, _mm512_castpd_si512, _mm512_castsi512_pd);
negated!(Avx2, _mm256_xor_si256, _mm256_castpd_si256, _mm256_castsi256_pd);

impl Lane for Avx512 {
    type Mask = Mask8;
    super::plain!();

    #[inline(always)]
    fn apart<P: Part>(part: P) -> P::Output {
        #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
        #[inline(never)]
        fn run<P: Part>(part: P) -> P::Output {
            part.run()
        }
        here!(run(part))
    }

    lanes_alike!(
        8,
        Avx512,
        _mm512_set1_pd,
        _mm512_or_si512,
        _mm512_srli_epi64,
        _mm512_slli_epi64,
        _mm512_castpd_si512,
        _mm512_castsi512_pd,
        _mm512_andnot_si512,
        _mm512_sqrt_pd
    );

    #[inline(always)]
    fn select(mask: Mask8, yes: Self, no: Self) -> Self {
        Avx512(here!(_mm512_mask_blend_pd(mask.0, no.0, yes.0)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask8 {
        Mask8(here!(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask8 {
        Mask8(here!(_mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0)))
    }
}

impl Lane for Avx2 {
    type Mask = Mask4;
    super::plain!();

    #[inline(always)]
    fn apart<P: Part>(part: P) -> P::Output {
        #[target_feature(enable = "avx2")]
        #[inline(never)]
        fn run<P: Part>(part: P) -> P::Output {
            part.run()
        }
        here!(run(part))
    }

    lanes_alike!(
        4,
        Avx2,
        _mm256_set1_pd,
        _mm256_or_si256,
        _mm256_srli_epi64,
        _mm256_slli_epi64,
        _mm256_castpd_si256,
        _mm256_castsi256_pd,
        _mm256_andnot_si256,
        _mm256_sqrt_pd
    );

    #[inline(always)]
    fn select(mask: Mask4, yes: Self, no: Self) -> Self {
        Avx2(here!(_mm256_blendv_pd(no.0, yes.0, mask.0)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask4 {
        Mask4(here!(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask4 {
        Mask4(here!(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0)))
    }
}
