//! Numbers with their derivatives: what is computed with them is differentiated exactly, events included.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::unrolled::unrolled;
use super::{Differentiable, Lane, ORDER, Part, Series, series};

/// A number per lane with its derivatives along `N` directions.
///
/// Method: forward differentiation. Events are decided by the numbers alone; a step is as short as the
/// fastest of the number's and its derivatives' series needs. An event's time is differentiated as the
/// root that it is ([`Lane::root`]), which puts into the linearised flow the jumps that switching makes in
/// it (saltation), and sticking takes a direction out of it exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<L, const N: usize> {
    /// The number.
    pub value: L,
    /// Its derivatives.
    pub gradient: [L; N],
}

impl<L: Lane, const N: usize> Dual<L, N> {
    /// A number that does not depend on any direction.
    #[inline(always)]
    pub fn constant(value: L) -> Self {
        Dual { value, ..Self::ZERO }
    }

    /// A number that is itself the direction of this index.
    #[inline(always)]
    pub fn variable(value: L, direction: usize) -> Self {
        let mut variable = Dual::constant(value);
        variable.gradient[direction] = L::splat(1.0);
        variable
    }

    /// Another number in the place of this one, with the derivatives of each direction.
    #[inline(always)]
    fn with_gradient(mut self, value: L, gradient: impl Fn(usize) -> L) -> Self {
        self.value = value;
        unrolled!(i < N, {
            self.gradient[i] = gradient(i);
        });
        self
    }

    /// A function of this number by the chain rule, from its value and its slope here.
    ///
    /// Where the slope is not finite, as that of the square root at zero, a derivative of zero stays zero:
    /// a constant remains one.
    #[inline(always)]
    fn chained(self, value: L, slope: L) -> Self {
        let zero = L::splat(0.0);
        let unbounded = !slope.abs().le(L::splat(f64::MAX));
        self.with_gradient(value, |i| {
            let constant = unbounded & self.gradient[i].abs().le(zero);
            L::select(constant, zero, self.gradient[i] * slope)
        })
    }
}

impl<L: Lane, const N: usize> Add for Dual<L, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with_gradient(self.value + other.value, |i| self.gradient[i] + other.gradient[i])
    }
}

impl<L: Lane, const N: usize> Sub for Dual<L, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with_gradient(self.value - other.value, |i| self.gradient[i] - other.gradient[i])
    }
}

impl<L: Lane, const N: usize> Mul for Dual<L, N> {
    type Output = Self;
    // The product rule has a sum in it.
    #[allow(clippy::suspicious_arithmetic_impl)]
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with_gradient(self.value * other.value, |i| {
            self.gradient[i] * other.value + self.value * other.gradient[i]
        })
    }
}

impl<L: Lane, const N: usize> Div for Dual<L, N> {
    type Output = Self;
    // One division serves all derivatives.
    #[allow(clippy::suspicious_arithmetic_impl)]
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let inverse = L::splat(1.0) / other.value;
        self.with_gradient(value, |i| (self.gradient[i] - value * other.gradient[i]) * inverse)
    }
}

impl<L: Lane, const N: usize> Neg for Dual<L, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.with_gradient(-self.value, |i| -self.gradient[i])
    }
}

impl<L: Lane, const N: usize> Lane for Dual<L, N> {
    type Mask = L::Mask;
    type Plain = L::Plain;
    const PARTS: usize = (N + 1) * L::PARTS;
    const WIDTH: usize = L::WIDTH;
    const ZERO: Self = Dual { value: L::ZERO, gradient: [L::ZERO; N] };

    #[inline(always)]
    fn apart<P: Part>(part: P) -> P::Output {
        L::apart(part)
    }
    #[inline(always)]
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self {
        Dual::constant(L::from_fn(value))
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Dual::constant(L::splat(value))
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.value.lane(index)
    }
    /// The lane's derivatives become zero: the number put there depends on nothing.
    #[inline(always)]
    fn with_lane(self, index: usize, value: f64) -> Self {
        let value = self.value.with_lane(index, value);
        self.with_gradient(value, |i| self.gradient[i].with_lane(index, 0.0))
    }
    #[inline(always)]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        yes.with_gradient(L::select(mask, yes.value, no.value), |i| {
            L::select(mask, yes.gradient[i], no.gradient[i])
        })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> L::Mask {
        self.value.lt(other.value)
    }
    #[inline(always)]
    fn le(self, other: Self) -> L::Mask {
        self.value.le(other.value)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let negative = self.value.lt(L::splat(0.0));
        let turned = |i: usize| L::select(negative, -self.gradient[i], self.gradient[i]);
        self.with_gradient(self.value.abs(), turned)
    }
    #[inline(always)]
    fn exp2_whole(self) -> Self {
        Dual::constant(self.value.exp2_whole())
    }
    #[inline(always)]
    fn rough_log(self) -> Self {
        Dual::constant(self.value.rough_log())
    }
    #[inline(always)]
    fn fraction_and_exponent(self) -> (Self, Self) {
        let (fraction, exponent) = self.value.fraction_and_exponent();
        let scale = L::from_plain((fraction / self.value).plain());
        (self.chained(fraction, scale), Dual::constant(exponent))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chained(root, L::splat(0.5) / root)
    }
    #[inline(always)]
    fn apply<F: Differentiable<M>, const M: usize>(self, function: &F) -> [Self; M] {
        let values = self.value.apply(function);
        let slopes = function.slopes(self.value, values);
        let mut duals = [self; M];
        for (dual, (value, slope)) in duals.iter_mut().zip(values.into_iter().zip(slopes)) {
            *dual = self.chained(value, slope);
        }
        duals
    }
    #[inline(always)]
    fn rough_exp(self) -> Self {
        Dual::constant(self.value.rough_exp())
    }
    #[inline(always)]
    fn nearest_whole(self) -> Self {
        Dual::constant(self.value.nearest_whole())
    }
    #[inline(always)]
    fn part(self, index: usize) -> L::Plain {
        match (index / L::PARTS, index % L::PARTS) {
            (0, part) => self.value.part(part),
            (direction, part) => self.gradient[direction - 1].part(part),
        }
    }
    #[inline(always)]
    fn from_plain(value: L::Plain) -> Self {
        Dual::constant(L::from_plain(value))
    }
    /// By the implicit function theorem: the derivatives of the polynomial at the root over minus its slope
    /// there.
    #[inline(always)]
    fn root(value: L::Plain, polynomial: &Series<Self>) -> Self {
        let mut values = series::zero();
        for (of_value, term) in values.iter_mut().zip(polynomial) {
            *of_value = term.value;
        }
        let at = L::root(value, &values);
        let (there, slope) = value_and_slope(polynomial, at);
        let inverse = L::splat(-1.0) / slope;
        there.with_gradient(at, |i| there.gradient[i] * inverse)
    }
    #[inline(always)]
    fn scaled(self, by: L::Plain) -> Self {
        self.with_gradient(self.value.scaled(by), |i| self.gradient[i].scaled(by))
    }
    /// The derivatives are those of the polynomial at a time without any, and its slope times those of the time.
    #[inline(always)]
    fn value_at(polynomial: &Series<Self>, h: Self) -> Self {
        let (there, slope) = value_and_slope(polynomial, h.value);
        h.with_gradient(there.value, |i| there.gradient[i] + slope * h.gradient[i])
    }
    #[inline(always)]
    fn exp_next(
        e: &Series<Self>,
        b: &Series<Self>,
        factor: Self,
        a: &Series<Self>,
        k: usize,
    ) -> Self {
        let mut product = e[0].value * b[k].value;
        for j in 1..k + 1 {
            product = product + e[j].value * b[k - j].value;
        }
        let value = (factor.value * product) * L::splat(series::INVERSE[k + 1]);
        // The derivative of e is e times that of a, with the term of e that is computed here.
        let mut next = a[0].with_gradient(value, |i| a[0].gradient[i] * value);
        for j in 0..k + 1 {
            let of_a = &a[k + 1 - j].gradient;
            next = next.with_gradient(value, |i| next.gradient[i] + e[j].value * of_a[i]);
        }
        next
    }
    #[inline(always)]
    fn plain_series<'a>(
        series: &'a mut Series<Self>,
        room: &'a mut Series<L::Plain>,
    ) -> &'a mut Series<L::Plain> {
        for (plain, term) in room.iter_mut().zip(series) {
            *plain = term.plain();
        }
        room
    }
}

/// A polynomial at a time, with its derivatives along the directions, and its slope there.
#[inline(always)]
fn value_and_slope<L: Lane, const N: usize>(
    polynomial: &Series<Dual<L, N>>,
    time: L,
) -> (Dual<L, N>, L) {
    let (mut sum, mut slope) = (polynomial[ORDER], L::splat(0.0));
    for k in (0..ORDER).rev() {
        slope = slope * time + sum.value;
        let Dual { value, gradient } = &polynomial[k];
        let next = sum.value * time + *value;
        sum = sum.with_gradient(next, |i| sum.gradient[i] * time + gradient[i]);
    }
    (sum, slope)
}
