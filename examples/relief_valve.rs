//! A pressure relief valve (Hos and Champneys 2012), which no drive moves: y1' = y2, y2' = -kappa y2 -
//! (y1 + delta) + y3, y3' = beta (q - y1 sqrt(y3)), with an impact y2 -> -r y2 on the seat y1 = 0.
//!
//! `cargo run --release --no-default-features --example relief_valve -- --json`

use std::time::Instant;

use capsulemap::branch::{self, SpecialKind};
use capsulemap::flow::{Event, Field, Stroboscopic, Switched, Taylor, Zeros};
use capsulemap::lane::elementary::not_finite;
use capsulemap::lane::{Lane, ORDER, Series, series};
use capsulemap::orbit::{self, Case, Machine, Outcome, Protocol};
use capsulemap::{in_lanes, own_system};

/// The valve by its parameters; seen once a maximum of y1 if `MAXIMA`, else at equal times.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Valve<L, const MAXIMA: bool> {
    kappa: L,
    delta: L,
    beta: L,
    r: L,
    q: L,
}

/// What happens to the valve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Seat {
    /// It meets its seat.
    Impact = 1,
}

impl Event for Seat {
    const ALL: &'static [Seat] = &[Seat::Impact];
    fn number(self) -> u8 {
        self as u8
    }
    fn is_impact(self) -> bool {
        true
    }
}

own_system!(Valve<true> { kappa, delta, beta, r, q }
    section 2 state [L; 3], mode (), event Seat, scales |_| [1.0, 0.1]);
own_system!(Valve<false> { kappa, delta, beta, r, q }
    section 3 state [L; 3], mode (), event Seat, scales |_| [1.0, 1.0, 0.1]);

/// Place of the square root of y3 among the series, after those of y1, y2 and y3.
const ROOT: usize = 3;

in_lanes! {
    impl<L: Lane, const MAXIMA: bool> Switched<L> for Valve<L, MAXIMA> {
        type State = [L; 3];
        type Mode = ();
        type Jet = Taylor<L, 4>;
        type Event = Seat;
        const GUARDS: usize = 1;
        const AUTONOMOUS: bool = MAXIMA;

        /// The longest time between two maxima that is waited for, or the time between two looks.
        fn period(&self) -> L {
            L::splat(if MAXIMA { 200.0 } else { 1.0 })
        }

        fn expand(&self, _: &(), _: L, state: &[L; 3], jet: &mut Taylor<L, 4>) {
            jet.begin(state);
            for k in 0..ORDER {
                let per = L::splat(series::INVERSE[k + 1]);
                jet[ROOT][k] = series::sqrt_term(&jet[2], &jet[ROOT], k);
                let outflow = series::product_term(&jet[0], &jet[ROOT], k);
                let [load, inflow] = if k == 0 { [self.delta, self.q] } else { [L::splat(0.0); 2] };
                let force = jet[2][k] - jet[0][k] - load - self.kappa * jet[1][k];
                jet[0][k + 1] = jet[1][k] * per;
                jet[1][k + 1] = force * per;
                jet[2][k + 1] = self.beta * (inflow - outflow) * per;
            }
        }

        fn pace<'a>(&self, jet: &'a Taylor<L, 4>) -> [&'a Series<L>; 2] {
            [&jet[1], &jet[2]]
        }

        fn guard(&self, _: usize, _: &(), jet: &Taylor<L, 4>, guard: &mut Series<L>) {
            *guard = jet[0];
        }

        fn at(&self, jet: &Taylor<L, 4>, h: L) -> [L; 3] {
            jet.at(h)
        }

        fn switch(
            &self,
            _: usize,
            due: L::Mask,
            _: &mut (),
            [y1, y2, _]: &mut [L; 3],
            zeros: &mut Zeros<L>,
            _: L,
        ) -> L {
            *y1 = L::select(due, L::splat(0.0), *y1);
            *y2 = L::select(due, -(self.r * *y2), *y2);
            zeros[0] = L::select(due, L::splat(1.0), zeros[0]);
            L::select(due, Seat::Impact.code(), L::splat(0.0))
        }

        fn lost(&self, [y1, y2, y3]: &[L; 3]) -> L::Mask {
            not_finite(*y1 + *y2 + *y3)
        }

        fn section(&self, jet: &Taylor<L, 4>, section: &mut Series<L>) {
            *section = jet[1];
        }

        fn touching<'a>(&self, jet: &'a Taylor<L, 4>) -> Option<(&'a Series<L>, L)> {
            Some((&jet[0], L::splat(0.0)))
        }
    }

    impl<L: Lane> Stroboscopic<L, 2> for Valve<L, true> {
        fn point([y1, _, y3]: &[L; 3]) -> [L; 2] {
            [*y1, *y3]
        }
        fn state([y1, y3]: [L; 2]) -> [L; 3] {
            [y1, L::splat(0.0), y3]
        }
    }

    impl<L: Lane> Stroboscopic<L, 3> for Valve<L, false> {
        fn point(state: &[L; 3]) -> [L; 3] {
            *state
        }
        fn state(point: [L; 3]) -> [L; 3] {
            point
        }
    }
}

/// The equations as they are written, by which every step is checked.
impl<const MAXIMA: bool> Field for Valve<f64, MAXIMA> {
    type Coordinates = [f64; 3];
    fn coordinates(state: &[f64; 3]) -> [f64; 3] {
        *state
    }
    fn motion(&self, jet: &Taylor<f64, 4>, h: f64) -> ([f64; 3], [f64; 3]) {
        jet.motion(h)
    }
    fn rates(&self, _: &(), _: f64, [y1, y2, y3]: &[f64; 3]) -> [f64; 3] {
        let force = y3 - y1 - self.delta - self.kappa * y2;
        [*y2, force, self.beta * (self.q - y1 * y3.sqrt())]
    }
    fn weights(&self) -> [f64; 3] {
        [1.0, 1.0, 0.1]
    }
}

/// The valve of the paper at a flow rate.
fn valve<const MAXIMA: bool>(q: f64) -> Valve<f64, MAXIMA> {
    Valve { kappa: 1.25, delta: 10.0, beta: 20.0, r: 0.8, q }
}

/// The flow rate at which the open valve rests with this y1.
fn flow_at_rest(y1: f64) -> f64 {
    y1 * (y1 + 10.0).sqrt()
}

/// The flow rate at which the equilibrium loses its stability, in closed form: with a = beta y1/(2 s) and
/// s = sqrt(y1 + delta) a pair of imaginary eigenvalues makes (kappa + a)(1 + kappa a) = a + beta s.
fn exact_loss_of_stability() -> f64 {
    let excess = |y1: f64| {
        let s = (y1 + 10.0).sqrt();
        let a = 20.0 * y1 / (2.0 * s);
        (1.25 + a) * (1.0 + 1.25 * a) - a - 20.0 * s
    };
    let (mut low, mut high) = (0.1_f64, 10.0_f64);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    flow_at_rest(0.5 * (low + high))
}

fn main() {
    let protocol = Protocol::default();
    // The equilibrium, seen at equal times, is a fixed point; a pair of multipliers passes the unit circle.
    let y1 = 4.0;
    let equilibrium = branch::Request {
        system: valve::<false>(flow_at_rest(y1)),
        section: [y1, 0.0, y1 + 10.0],
        period: 1,
        along: "q",
        range: [4.0, 20.0],
        doublings: 0,
        second: None,
        longest_step: 0.05,
        most_points: 1000,
        tolerance: protocol.tolerance,
    };
    let found = branch::follow(&equilibrium).expect("the equilibrium");
    println!(
        "{:?} {:?}",
        found.branches[0].special.iter().map(|s| (s.kind, s.point.parameter)).collect::<Vec<_>>(),
        found.branches[0].ends
    );
    println!("exact {}", exact_loss_of_stability());
    let at = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(8.0);
    let case = Case::new(valve::<true>(at), [y1, 0.0, 15.0]);
    let orbit = orbit::settle(&case, &protocol);
    println!(
        "{:?} {} {:?} {:?} {:?} cycles {} defect {:e}",
        orbit.outcome,
        orbit.period,
        orbit.section.first(),
        orbit.certificate,
        orbit.failure,
        orbit.cycles,
        orbit.defect
    );
    let request = branch::Request {
        system: valve::<true>(at),
        section: orbit.section[0],
        period: orbit.period,
        along: "q",
        range: [4.0, 9.5],
        doublings: 0,
        second: None,
        longest_step: 0.05,
        most_points: 1000,
        tolerance: protocol.tolerance,
    };
    let found = branch::follow(&request).expect("the cycle");
    let b = &found.branches[0];
    println!(
        "{:?} {:?} {} .. {}",
        b.special.iter().map(|s| (s.kind, s.point.parameter)).collect::<Vec<_>>(),
        b.ends,
        b.points[0].parameter,
        b.points.last().unwrap().parameter
    );
    let _ = (Instant::now(), Machine::default(), SpecialKind::Grazing, Outcome::Periodic);
}
