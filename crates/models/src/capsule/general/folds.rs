//! Folds across the way of the capsule, evenly spaced: they raise the friction, and push back whoever climbs them.

use std::f64::consts::PI;

use capsulemap_engine::lane::elementary::{exp, sin_cos};
use capsulemap_engine::lane::{Lane, Series, series, side_by_side};

use crate::capsule::parameter::Parameter;
use crate::capsule::shape::Shape;

/// Points of the mean over a spacing; by the trapezoidal rule those of the sharpest fold give it to rounding.
const POINTS: usize = 32;

/// The folds of a way.
///
/// With theta, 2 pi times the place of the capsule in spacings from the top of a fold on, and the height w = exp(sharpness (cos theta - 1)) of a fold, which is one at its top, the resistance of
/// the ground is (1 + `fold_friction` w) times what it is on even ground, and the capsule is pushed by `fold_force` sin(theta) w / M, M the
/// largest value of sin(theta) w: backward before the top, forward behind it.
#[derive(Debug, Clone, Copy)]
pub struct Folds<L> {
    /// One over the spacing [1/m].
    pub per_length: L,
    /// By what share the top of a fold raises the resistance.
    rise: L,
    /// What sin(theta) w is multiplied with [N].
    force: L,
    sharpness: L,
}

side_by_side!(Folds { per_length, rise, force, sharpness });

/// What the folds do at a place.
#[derive(Debug, Clone, Copy)]
pub struct AtPlace<L> {
    /// What the resistance of even ground is multiplied with.
    pub resists: L,
    /// What pushes the capsule, forward positive [N].
    pub pushes: L,
}

/// Taylor series of what the folds do during a step.
#[derive(Debug, Clone)]
pub struct FoldSeries<L> {
    sin: Series<L>,
    cos: Series<L>,
    /// w.
    height: Series<L>,
    /// sin(theta) w.
    slope: Series<L>,
    /// What even ground would resist with [N].
    even: Series<L>,
}

side_by_side!(FoldSeries {} with { sin, cos, height, slope, even });

impl<L: Lane> Default for FoldSeries<L> {
    #[inline(always)]
    fn default() -> Self {
        let zero = series::zero();
        FoldSeries { sin: zero, cos: zero, height: zero, slope: zero, even: zero }
    }
}

impl<L: Lane> FoldSeries<L> {
    /// Writes term `k > 0` of a capsule that rests.
    #[inline(always)]
    pub fn rest(&mut self, k: usize) {
        let zero = L::splat(0.0);
        (self.sin[k], self.cos[k], self.height[k], self.slope[k]) = (zero, zero, zero, zero);
    }
}

impl<L: Lane> Folds<L> {
    /// Those of these parameters; none on even ground.
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape) -> Self {
        let (zero, one, two) = (L::splat(0.0), L::splat(1.0), L::splat(2.0));
        if !shape.over_folds {
            return Folds { per_length: zero, rise: zero, force: zero, sharpness: zero };
        }
        let sharpness = of(Parameter::FoldSharpness);
        // The largest slope is where sharpness sin^2 = cos.
        let twice = two * sharpness;
        let cos = twice / (one + (one + twice * twice).sqrt());
        let largest = (one - cos * cos).sqrt() * exp(sharpness * (cos - one));
        Folds {
            per_length: one / of(Parameter::FoldSpacing),
            rise: of(Parameter::FoldFriction),
            force: of(Parameter::FoldForce) / largest,
            sharpness,
        }
    }

    /// The sine and cosine of theta, and w, at a place.
    #[inline(always)]
    fn height(&self, place: L) -> (L, L, L) {
        let (sin, cos) = sin_cos(place * L::splat(2.0 * PI));
        (sin, cos, exp(self.sharpness * (cos - L::splat(1.0))))
    }

    /// What they do at a place, told in spacings.
    #[inline(always)]
    pub fn at(&self, place: L) -> AtPlace<L> {
        let (sin, _, height) = self.height(place);
        AtPlace { resists: L::splat(1.0) + self.rise * height, pushes: self.force * (sin * height) }
    }

    /// The mean over a spacing of what the resistance of even ground is multiplied with.
    pub fn mean_resistance(&self) -> L {
        let mut sum = L::splat(0.0);
        for point in 0..POINTS {
            sum = sum + self.at(L::splat(point as f64 / POINTS as f64)).resists;
        }
        sum / L::splat(POINTS as f64)
    }

    /// The largest of what the resistance of even ground is multiplied with, at the top of a fold.
    pub fn largest_resistance(&self) -> L {
        L::splat(1.0) + self.rise
    }

    /// A place within a spacing, from 0 on: what is told in whole spacings is left out.
    #[inline(always)]
    pub fn within(&self, place: L) -> L {
        let plain = place.plain();
        let nearest = plain.nearest_whole();
        let (zero, one) = (L::Plain::splat(0.0), L::Plain::splat(1.0));
        let whole = nearest - L::Plain::select(plain.lt(nearest), one, zero);
        // A place that is no number says so later on.
        place - L::from_plain(L::Plain::select(whole.abs().le(L::Plain::splat(1e15)), whole, zero))
    }

    /// Begins the series at a place.
    #[inline(always)]
    pub fn begin(&self, place: L, folds: &mut FoldSeries<L>) {
        let (sin, cos, height) = self.height(place);
        (folds.sin[0], folds.cos[0]) = (sin, cos);
        (folds.height[0], folds.slope[0]) = (height, sin * height);
    }

    /// Term `k` of the resistance from that of what even ground would resist with [N].
    #[inline(always)]
    pub fn resistance_term(&self, even: L, folds: &mut FoldSeries<L>, k: usize) -> L {
        folds.even[k] = even;
        even + self.rise * series::product_term(&folds.even, &folds.height, k)
    }

    /// Writes term `k > 0` of the folds from the terms of x2 up to it: sin' = theta' cos, cos' = -theta' sin, w' = -sharpness theta' sin w.
    #[inline(always)]
    pub fn move_on(&self, x2: &Series<L>, folds: &mut FoldSeries<L>, k: usize) {
        let turn = self.per_length * L::splat(2.0 * PI);
        let of_height = self.sharpness * turn;
        folds.sin[k] = turn * series::slope_product_term(x2, &folds.cos, k);
        folds.cos[k] = -(turn * series::slope_product_term(x2, &folds.sin, k));
        folds.height[k] = -(of_height * series::slope_product_term(x2, &folds.slope, k));
        folds.slope[k] = series::product_term(&folds.sin, &folds.height, k);
    }

    /// A force of even ground as the folds raise it where a step begins [N].
    #[inline(always)]
    pub fn raised_by_start(&self, force: L, folds: &FoldSeries<L>) -> L {
        force * (L::splat(1.0) + self.rise * folds.height[0])
    }

    /// Term `k` of what pushes the capsule [N].
    #[inline(always)]
    pub fn push_term(&self, folds: &FoldSeries<L>, k: usize) -> L {
        self.force * folds.slope[k]
    }

    /// A force of even ground as folds raise it [N].
    #[inline(always)]
    pub fn raised(&self, force: &Series<L>, folds: &FoldSeries<L>) -> Series<L> {
        let mut raised = *force;
        for (k, term) in raised.iter_mut().enumerate() {
            *term = force[k] + self.rise * series::product_term(force, &folds.height, k);
        }
        raised
    }
}

impl Folds<f64> {
    /// What they do at a place, told in spacings, as the law is written.
    pub fn exactly_at(&self, place: f64) -> AtPlace<f64> {
        let (sin, cos) = libm::sincos(2.0 * PI * place);
        let height = libm::exp(self.sharpness * (cos - 1.0));
        AtPlace { resists: 1.0 + self.rise * height, pushes: self.force * sin * height }
    }
}
