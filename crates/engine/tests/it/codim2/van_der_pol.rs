//! Van der Pol's oscillator with a force, x'' - m (1 - x^2) x' + x = f cos(w t + phase).

use std::f64::consts::PI;

use capsulemap_engine::flow::{Field, NoEvent, Stroboscopic, Switched, Taylor};
use capsulemap_engine::lane::elementary::{not_finite, sin_cos};
use capsulemap_engine::lane::{Lane, ORDER, Series, series};
use capsulemap_engine::{in_lanes, own_system};

/// The oscillator: strength of its feedback, amplitude, frequency and phase of the force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VanDerPol<L> {
    pub m: L,
    pub f: L,
    pub w: L,
    pub phase: L,
}

own_system!(VanDerPol { m, f, w, phase }
    section 2 state [L; 2], mode (), event NoEvent, scales |it| [it.w, 1.0]);

/// Place of the square of x among the series, after those of x and x'.
const SQUARE: usize = 2;

in_lanes! {
    impl<L: Lane> Switched<L> for VanDerPol<L> {
        type State = [L; 2];
        type Mode = ();
        type Jet = Taylor<L, 3>;
        type Event = NoEvent;
        const GUARDS: usize = 0;

        fn period(&self) -> L {
            L::splat(2.0 * PI) / self.w
        }

        fn expand(&self, _: &(), time: L, state: &[L; 2], jet: &mut Taylor<L, 3>) {
            let (mut sin, mut cos) = sin_cos(self.w * time + self.phase);
            jet.begin(state);
            for k in 0..ORDER {
                let per = L::splat(series::INVERSE[k + 1]);
                jet[SQUARE][k] = series::square_term(&jet[0], k);
                let product = series::product_term(&jet[SQUARE], &jet[1], k);
                let feedback = self.m * (jet[1][k] - product);
                jet[0][k + 1] = jet[1][k] * per;
                jet[1][k + 1] = (self.f * cos + feedback - jet[0][k]) * per;
                (sin, cos) = (self.w * cos * per, -(self.w * sin * per));
            }
        }

        fn pace<'a>(&self, jet: &'a Taylor<L, 3>) -> [&'a Series<L>; 2] {
            [&jet[0], &jet[1]]
        }

        fn at(&self, jet: &Taylor<L, 3>, h: L) -> [L; 2] {
            jet.at(h)
        }

        fn motion(&self, jet: &Taylor<L, 3>, h: L) -> ([L; 2], [L; 2]) {
            jet.motion(h)
        }

        fn lost(&self, [x, v]: &[L; 2]) -> L::Mask {
            not_finite(*x + *v)
        }
    }

    impl<L: Lane> Stroboscopic<L, 2> for VanDerPol<L> {
        fn point(state: &[L; 2]) -> [L; 2] {
            *state
        }

        fn state(point: [L; 2]) -> [L; 2] {
            point
        }
    }
}

impl Field for VanDerPol<f64> {
    type Coordinates = [f64; 2];

    fn coordinates(state: &[f64; 2]) -> [f64; 2] {
        *state
    }

    fn rates(&self, _: &(), time: f64, [x, v]: &[f64; 2]) -> [f64; 2] {
        let force = self.f * libm::cos(self.w * time + self.phase);
        [*v, force + self.m * (1.0 - x * x) * v - x]
    }

    fn weights(&self) -> [f64; 2] {
        [self.w, 1.0]
    }
}
