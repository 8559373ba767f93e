//! A system whose return map is a polynomial, and whose coordinate touches a wall where a closed form says.

use std::f64::consts::PI;

use capsulemap_engine::flow::{Event, Field, Stroboscopic, Switched, Taylor, Zeros};
use capsulemap_engine::lane::elementary::{not_finite, sin_cos};
use capsulemap_engine::lane::{Lane, ORDER, Series, SideBySide, series};
use capsulemap_engine::{in_lanes, own_system};

/// In a cycle x goes through high sin^2(2 pi t) + skew y sin(2 pi t), which leads back to where it began and has the maxima
/// high + skew y at t = 1/4 and high - skew y at t = 3/4. Then (x, y, z) becomes (y, a - b x + s y - q y^2 - k y^3, c + z + z^2), and
/// after a cycle in which x was beyond the wall, kick (z + 2/5) is taken from z.
///
/// Fixed points have y = x; the multipliers of the first two have the sum s - 2 q x - 3 k x^2 and the product b, the third is 1 + 2 z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mapped<L> {
    pub a: L,
    pub b: L,
    pub s: L,
    pub q: L,
    pub k: L,
    pub c: L,
    pub high: L,
    pub skew: L,
    pub wall: L,
    pub kick: L,
}

own_system!(Mapped { a, b, s, q, k, c, high, skew, wall, kick }
    section 3 state [L; 3], mode Beyond<L>, event Touch, scales |_| [1.0; 3]);

/// Whether x is beyond the wall, which stops nothing, and whether it was in this cycle: one or zero.
#[derive(Debug, Clone, Copy)]
pub struct Beyond<L>(L, L);

impl<L: Lane> Default for Beyond<L> {
    fn default() -> Self {
        Beyond(L::splat(0.0), L::splat(0.0))
    }
}

/// What happens at the wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Touch {
    /// It is met.
    Meets = 1,
    /// It is left.
    Leaves,
}

impl Event for Touch {
    const ALL: &'static [Touch] = &[Touch::Meets, Touch::Leaves];
    fn number(self) -> u8 {
        self as u8
    }
    fn is_impact(self) -> bool {
        self == Touch::Meets
    }
}

in_lanes! {
    impl<L: Lane> SideBySide for Beyond<L> {
        type One = Beyond<f64>;
        fn splat(one: &Beyond<f64>) -> Self {
            Beyond(L::splat(one.0), L::splat(one.1))
        }
        fn lane(&self, index: usize) -> Beyond<f64> {
            Beyond(self.0.lane(index), self.1.lane(index))
        }
        fn put(&mut self, index: usize, one: &Beyond<f64>) {
            self.0 = self.0.with_lane(index, one.0);
            self.1 = self.1.with_lane(index, one.1);
        }
        fn take_lane(&mut self, index: usize, other: &Self) {
            self.0 = self.0.with_lane_of(index, other.0);
            self.1 = self.1.with_lane_of(index, other.1);
        }
    }

    impl<L: Lane> Switched<L> for Mapped<L> {
        type State = [L; 3];
        type Mode = Beyond<L>;
        type Jet = Taylor<L, 3>;
        type Event = Touch;
        const GUARDS: usize = 1;

        fn period(&self) -> L {
            L::splat(1.0)
        }

        fn begin_cycle(&self, mask: L::Mask, beyond: &mut Beyond<L>, state: &mut [L; 3]) {
            let [x, y, z] = *state;
            let next = self.a - self.b * x + (self.s - (self.q + self.k * y) * y) * y;
            let kick = beyond.1 * self.kick * (z + L::splat(0.4));
            let mapped = [y, next, self.c + z + z * z - kick];
            for (own, mapped) in state.iter_mut().zip(mapped) {
                *own = L::select(mask, mapped, *own);
            }
            beyond.0 = L::select(mask, L::splat(0.0), beyond.0);
            beyond.1 = L::select(mask, L::splat(0.0), beyond.1);
        }

        fn expand(&self, _: &Beyond<L>, time: L, state: &[L; 3], jet: &mut Taylor<L, 3>) {
            let turn = L::splat(2.0 * PI);
            let (mut sin, mut cos) = sin_cos(turn * time);
            let (mut sin_2, mut cos_2) = sin_cos((turn + turn) * time);
            jet.begin(state);
            for k in 0..ORDER {
                let per = L::splat(series::INVERSE[k + 1]);
                let rate = turn * (self.high * sin_2 + self.skew * state[1] * cos);
                jet[0][k + 1] = rate * per;
                jet[1][k + 1] = L::splat(0.0);
                jet[2][k + 1] = L::splat(0.0);
                (sin, cos) = (turn * cos * per, -(turn * sin * per));
                (sin_2, cos_2) =
                    ((turn + turn) * cos_2 * per, -((turn + turn) * sin_2 * per));
            }
        }

        fn pace<'a>(&self, jet: &'a Taylor<L, 3>) -> [&'a Series<L>; 2] {
            [&jet[0], &jet[0]]
        }

        /// How far x is from the wall, on its side.
        fn guard(&self, _: usize, beyond: &Beyond<L>, jet: &Taylor<L, 3>, guard: &mut Series<L>) {
            let side = L::splat(1.0) - beyond.0 - beyond.0;
            *guard = jet[0].map(|term| -(side * term));
            guard[0] = side * (self.wall - jet[0][0]);
        }

        fn at(&self, jet: &Taylor<L, 3>, h: L) -> [L; 3] {
            jet.at(h)
        }

        fn motion(&self, jet: &Taylor<L, 3>, h: L) -> ([L; 3], [L; 3]) {
            jet.motion(h)
        }

        fn switch(
            &self,
            _: usize,
            due: L::Mask,
            beyond: &mut Beyond<L>,
            [x, ..]: &mut [L; 3],
            zeros: &mut Zeros<L>,
            _: L,
        ) -> L {
            *x = L::select(due, self.wall, *x);
            let meets = beyond.0.lt(L::splat(0.5));
            beyond.0 = L::select(due, L::splat(1.0) - beyond.0, beyond.0);
            beyond.1 = L::select(due, L::splat(1.0), beyond.1);
            zeros[0] = L::select(due, L::splat(1.0), zeros[0]);
            L::select(due, L::select(meets, Touch::Meets.code(), Touch::Leaves.code()), L::splat(0.0))
        }

        fn lost(&self, [x, y, z]: &[L; 3]) -> L::Mask {
            not_finite(*x + *y + *z)
        }

        fn touching<'a>(&self, jet: &'a Taylor<L, 3>) -> Option<(&'a Series<L>, [L; 2])> {
            Some((&jet[0], [self.wall; 2]))
        }
    }

    impl<L: Lane> Stroboscopic<L, 3> for Mapped<L> {
        fn point(state: &[L; 3]) -> [L; 3] {
            *state
        }

        fn state(point: [L; 3]) -> [L; 3] {
            point
        }
    }
}

impl Field for Mapped<f64> {
    type Coordinates = [f64; 3];

    fn coordinates(state: &[f64; 3]) -> [f64; 3] {
        *state
    }

    fn rates(&self, _: &Beyond<f64>, time: f64, [_, y, _]: &[f64; 3]) -> [f64; 3] {
        let turn = 2.0 * PI;
        let twice = libm::sin(2.0 * turn * time);
        [turn * (self.high * twice + self.skew * y * libm::cos(turn * time)), 0.0, 0.0]
    }

    fn weights(&self) -> [f64; 3] {
        [1.0; 3]
    }
}
