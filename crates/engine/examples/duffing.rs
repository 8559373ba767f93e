//! Duffing's oscillator x'' + c x' + x^3 = p cos t as a system of one's own: settled, certified, continued, and
//! its five coexisting attractors told apart.
//!
//! `cargo run --release -p capsulemap-engine --example duffing -- --json`

use std::f64::consts::PI;

use capsulemap_engine::attractor::{Label, Share, attractors_of, shares_of_grid};
use capsulemap_engine::branch::{self, SpecialKind};
use capsulemap_engine::flow::{Field, NoEvent, Stroboscopic, Switched, Taylor};
use capsulemap_engine::lane::elementary::{not_finite, sin_cos};
use capsulemap_engine::lane::{Lane, ORDER, Series, series};
use capsulemap_engine::orbit::{Case, Machine, Outcome, Proof, Protocol, settle_all};
use capsulemap_engine::{in_lanes, own_system};

/// The system: a struct of its parameters, in numbers of any kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Duffing<L> {
    /// Damping.
    pub c: L,
    /// Amplitude of the force.
    pub p: L,
}

own_system!(Duffing { c, p } section 2 state [L; 2], mode (), event NoEvent, scales |_| [1.0, 1.0]);

/// Starts along each coordinate.
const GRID: usize = 100;
/// Place of the square of x among the series, after those of x and v.
const SQUARE: usize = 2;

in_lanes! {
    impl<L: Lane> Switched<L> for Duffing<L> {
        type State = [L; 2];
        type Mode = ();
        type Jet = Taylor<L, 3>;
        type Event = NoEvent;
        const GUARDS: usize = 0;

        fn period(&self) -> L {
            L::splat(2.0 * PI)
        }

        fn expand(&self, _: &(), time: L, state: &[L; 2], jet: &mut Taylor<L, 3>) {
            let (mut sin, mut cos) = sin_cos(time);
            jet.begin(state);
            for k in 0..ORDER {
                let per = L::splat(series::INVERSE[k + 1]);
                jet[SQUARE][k] = series::square_term(&jet[0], k);
                let cube = series::product_term(&jet[SQUARE], &jet[0], k);
                jet[0][k + 1] = jet[1][k] * per;
                jet[1][k + 1] = (self.p * cos - self.c * jet[1][k] - cube) * per;
                (sin, cos) = (cos * per, -(sin * per));
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

    impl<L: Lane> Stroboscopic<L, 2> for Duffing<L> {
        fn point(state: &[L; 2]) -> [L; 2] {
            *state
        }

        fn state(point: [L; 2]) -> [L; 2] {
            point
        }
    }
}

/// The equations as they are written, by which every step is checked.
impl Field for Duffing<f64> {
    type Coordinates = [f64; 2];

    fn coordinates(state: &[f64; 2]) -> [f64; 2] {
        *state
    }

    fn rates(&self, _: &(), time: f64, [x, v]: &[f64; 2]) -> [f64; 2] {
        [*v, self.p * libm::cos(time) - self.c * v - x * x * x]
    }

    fn weights(&self) -> [f64; 2] {
        [1.0, 1.0]
    }
}

fn main() {
    let duffing = Duffing { c: 0.08, p: 0.2 };
    // A grid of starts over [-1, 1] x [-0.5, 1], settled side by side on all cores, each periodic one with a certificate.
    let starts = (0..GRID * GRID).map(|i| {
        let [x, v] = [i % GRID, i / GRID].map(|at| (at as f64 + 0.5) / GRID as f64);
        [-1.0 + 2.0 * x, -0.5 + 1.5 * v]
    });
    let cases: Vec<_> = starts.map(|start| Case::new(duffing, start)).collect();
    let protocol = Protocol::default();
    let orbits = settle_all(&cases, &protocol, Machine::default());
    let table = attractors_of(&duffing, &orbits, &protocol);

    // Ueda: at c = 0.08 and p = 0.2 five attractors coexist, all periodic.
    assert!(orbits.iter().all(|orbit| orbit.outcome == Outcome::Periodic));
    assert!(orbits.iter().all(|orbit| orbit.certificate.proof == Proof::Newton));
    let period = |place: usize| table.attractors[place].points.len();
    let periods: Vec<usize> = table.order.iter().map(|&place| period(place)).collect();
    assert_eq!(periods, [1, 1, 2, 2, 3]);
    let label = |start: usize| table.of_case[start].map_or(Label::Undecided, Label::Attractor);
    let shares = shares_of_grid(&[GRID, GRID], label, periods.len());

    // The exponents of a periodic orbit are those of its multipliers, and sum up to -c.
    let first = &orbits[table.attractors[0].case];
    let [a, b] = [0, 1].map(|at| first.certificate.multipliers[at].abs());
    let time = first.period as f64 * first.duration;
    assert!((libm::log(a * b) / time + duffing.c).abs() < 1e-9);
    assert!((libm::log(a) / time - first.exponent.value).abs() < 1e-12);

    // The first of them, followed in the force: where it turns back is a fold.
    let request = branch::Request {
        system: duffing,
        section: first.section[0],
        period: first.period,
        along: "p",
        range: [0.05, 0.6],
        doublings: 0,
        second: None,
        curve_range: None,
        longest_step: 0.05,
        most_points: 2000,
        tolerance: protocol.tolerance,
    };
    let found = branch::follow(&request).expect("a branch through the orbit");
    let folds: Vec<f64> = found.branches[0]
        .special
        .iter()
        .filter(|special| special.kind == SpecialKind::Fold)
        .map(|special| special.point.parameter)
        .collect();
    assert!(!folds.is_empty());

    if std::env::args().any(|argument| argument == "--json") {
        let of_shares = |of: fn(&Share) -> f64| {
            let numbers = table.order.iter().map(|&place| of(&shares[place]));
            numbers.collect::<Vec<_>>()
        };
        println!(
            "{{\"attractors\": {}, \"periods\": {periods:?}, \"shares\": {:?}, \"errors\": {:?}, \
             \"folds_p\": {folds:?}}}",
            table.attractors.len(),
            of_shares(|it| it.value),
            of_shares(|it| it.error),
        );
        return;
    }
    println!(
        "five attractors of x'' + 0.08 x' + x^3 = 0.2 cos t, by a grid of {GRID} x {GRID} starts:"
    );
    for &place in &table.order {
        let [x, v] = table.attractors[place].points[0];
        let Share { value, error, .. } = shares[place];
        let period = period(place);
        println!("  period {period}, at x = {x:+.6}, v = {v:+.6}; share {value:.4} +- {error:.4}");
    }
    println!("the first, followed in the force p, folds at {folds:?}");
}
