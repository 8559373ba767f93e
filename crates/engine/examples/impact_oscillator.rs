//! A driven mass at a wall, x'' + c x' + x = f cos(w t + phase) with an impact x' -> -r x' at x = wall, as a system of one's
//! own: settled, certified, its two attractors told apart, and continued through a fold, an impact on the instant of
//! the section and a grazing.
//!
//! `cargo run --release -p capsulemap-engine --example impact_oscillator -- --json`

use std::f64::consts::PI;

use capsulemap_engine::attractor::attractors_of;
use capsulemap_engine::branch::{self, End, SpecialKind};
use capsulemap_engine::flow::{Event, Field, Stroboscopic, Switched, Taylor, Zeros};
use capsulemap_engine::lane::elementary::{not_finite, sin_cos};
use capsulemap_engine::lane::{Lane, ORDER, Series, series};
use capsulemap_engine::orbit::{Case, Machine, Outcome, Proof, Protocol, settle_all};
use capsulemap_engine::{in_lanes, own_system};

/// The system: a struct of its parameters, in numbers of any kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impactor<L> {
    /// Damping.
    pub c: L,
    /// Amplitude of the force.
    pub f: L,
    /// Angular frequency of the force.
    pub w: L,
    /// Coefficient of restitution.
    pub r: L,
    /// Where the wall stands; the mass stays below it.
    pub wall: L,
    /// Phase of the force at the section [rad].
    pub phase: L,
}

/// What happens to the mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wall {
    /// It meets the wall.
    Impact = 1,
}

impl Event for Wall {
    const ALL: &'static [Wall] = &[Wall::Impact];
    fn number(self) -> u8 {
        self as u8
    }
    /// Continuation looks for the grazings at which impacts begin.
    fn is_impact(self) -> bool {
        true
    }
}

own_system!(Impactor { c, f, w, r, wall, phase }
    section 2 state [L; 2], mode (), event Wall, scales |it| [it.w, 1.0]);

in_lanes! {
    impl<L: Lane> Switched<L> for Impactor<L> {
        type State = [L; 2];
        type Mode = ();
        type Jet = Taylor<L, 2>;
        type Event = Wall;
        const GUARDS: usize = 1;

        fn period(&self) -> L {
            L::splat(2.0 * PI) / self.w
        }

        fn expand(&self, _: &(), time: L, state: &[L; 2], jet: &mut Taylor<L, 2>) {
            let (mut sin, mut cos) = sin_cos(self.w * time + self.phase);
            jet.begin(state);
            for k in 0..ORDER {
                let per = L::splat(series::INVERSE[k + 1]);
                let force = self.f * cos - jet[0][k] - self.c * jet[1][k];
                jet[0][k + 1] = jet[1][k] * per;
                jet[1][k + 1] = force * per;
                (sin, cos) = (self.w * cos * per, -(self.w * sin * per));
            }
        }

        fn pace<'a>(&self, jet: &'a Taylor<L, 2>) -> [&'a Series<L>; 2] {
            [&jet[0], &jet[1]]
        }

        /// Positive as long as the mass is below the wall.
        fn guard(&self, _: usize, _: &(), jet: &Taylor<L, 2>, guard: &mut Series<L>) {
            *guard = jet[0].map(|term| -term);
            guard[0] = self.wall - jet[0][0];
        }

        fn at(&self, jet: &Taylor<L, 2>, h: L) -> [L; 2] {
            jet.at(h)
        }

        fn motion(&self, jet: &Taylor<L, 2>, h: L) -> ([L; 2], [L; 2]) {
            jet.motion(h)
        }

        /// The mass is put on the wall, which the guard is told: it leaves from zero, with a rate.
        fn switch(
            &self,
            _: usize,
            due: L::Mask,
            _: &mut (),
            [x, v]: &mut [L; 2],
            zeros: &mut Zeros<L>,
            _: L,
        ) -> L {
            *x = L::select(due, self.wall, *x);
            *v = L::select(due, -(self.r * *v), *v);
            zeros[0] = L::select(due, L::splat(1.0), zeros[0]);
            L::select(due, Wall::Impact.code(), L::splat(0.0))
        }

        fn lost(&self, [x, v]: &[L; 2]) -> L::Mask {
            not_finite(*x + *v)
        }

        fn touching<'a>(&self, jet: &'a Taylor<L, 2>) -> Option<(&'a Series<L>, [L; 2])> {
            Some((&jet[0], [self.wall; 2]))
        }
    }

    impl<L: Lane> Stroboscopic<L, 2> for Impactor<L> {
        fn point(state: &[L; 2]) -> [L; 2] {
            *state
        }

        fn state(point: [L; 2]) -> [L; 2] {
            point
        }
    }
}

/// The equations as they are written, by which every step is checked.
impl Field for Impactor<f64> {
    type Coordinates = [f64; 2];

    fn coordinates(state: &[f64; 2]) -> [f64; 2] {
        *state
    }

    fn rates(&self, _: &(), time: f64, [x, v]: &[f64; 2]) -> [f64; 2] {
        [*v, self.f * libm::cos(self.w * time + self.phase) - x - self.c * v]
    }

    fn weights(&self) -> [f64; 2] {
        [self.w, 1.0]
    }
}

fn main() {
    let impactor = Impactor { c: 0.1, f: 1.0, w: 1.5, r: 0.7, wall: 1.0, phase: 0.0 };
    let protocol = Protocol::default();
    // From near its steady answer the mass stays below the wall; from rest it goes on meeting it.
    let cases = [[-0.8, 0.0], [0.0, 0.0]].map(|start| Case::new(impactor, start));
    let orbits = settle_all(&cases, &protocol, Machine::default());
    assert!(orbits.iter().all(|orbit| orbit.outcome == Outcome::Periodic));
    assert!(orbits.iter().all(|orbit| orbit.certificate.proof == Proof::Newton));
    let attractors = attractors_of(&impactor, &orbits, &protocol).attractors.len();
    assert_eq!(attractors, 2);

    // Areas of the section shrink by e^(-c T) in a cycle and by r^2 at an impact; the exponents are theirs.
    for (orbit, impacts) in orbits.iter().zip([0, 1]) {
        let [a, b] = [0, 1].map(|at| orbit.certificate.multipliers[at].abs());
        let shrinks =
            -impactor.c * orbit.duration + 2.0 * f64::from(impacts) * libm::log(impactor.r);
        assert!((libm::log(a * b) - shrinks).abs() < 1e-9);
        assert!((libm::log(a) / orbit.duration - orbit.exponent.value).abs() < 1e-9);
    }

    // Both lie on one branch: it turns back at a fold, passes an impact on the instant of the section, and at a
    // grazing the orbit of one impact becomes one of none.
    let request = branch::Request {
        system: impactor,
        section: orbits[1].section[0],
        period: 1,
        along: "w",
        range: [0.8, 1.8],
        doublings: 0,
        second: None,
        curve_range: None,
        longest_step: 0.02,
        most_points: 2000,
        tolerance: protocol.tolerance,
    };
    let found = branch::follow(&request).expect("a branch through the orbit");
    let followed = &found.branches[0];
    assert_eq!(followed.ends, [End::Bound; 2]);
    let value = |kind: SpecialKind| {
        let mut special = followed.special.iter().filter(|special| special.kind == kind);
        special.next().expect("the special point").point.parameter
    };
    let [fold, grazing] = [SpecialKind::Fold, SpecialKind::Grazing].map(value);
    // Without impacts the amplitude is 1/sqrt((1 - w^2)^2 + (c w)^2), which is one at w^2 = 2 - c^2.
    assert!((grazing - libm::sqrt(1.99)).abs() < 1e-11, "{grazing}");

    if std::env::args().any(|argument| argument == "--json") {
        println!("{{\"attractors\": {attractors}, \"fold_w\": {fold}, \"grazing_w\": {grazing}}}");
        return;
    }
    println!("two attractors at w = 1.5, one without impacts and one with an impact in each cycle");
    let orbits = followed.points.len();
    println!("both lie on one branch, followed over w = 0.8 to 1.8 by {orbits} orbits:");
    println!("  fold at w = {fold:.11}, grazing at w = {grazing:.11}");
}
