//! A mass on a moving belt, x'' + c x' + x = friction, which sticks and slips: an autonomous system whose section
//! is where the mass turns back.
//!
//! `cargo run --release -p capsulemap-engine --example belt -- --json`

use capsulemap_engine::attractor::{Label, Share, attractors_of, shares_of_draws};
use capsulemap_engine::branch::{self, End, SpecialKind};
use capsulemap_engine::flow::{Event, Field, Stroboscopic, Switched, Taylor, Zeros};
use capsulemap_engine::lane::elementary::{exp, not_finite};
use capsulemap_engine::lane::{Lane, ORDER, Series, SideBySide, series};
use capsulemap_engine::orbit::{self, Case, Machine, Outcome, Proof, Protocol};
use capsulemap_engine::{in_lanes, own_system};

/// The mass on its belt; friction is a (1 + exp(-|u| / s)) against its velocity u on the belt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Belt<L> {
    /// Damping.
    pub c: L,
    /// Friction of fast sliding; friction at rest is up to twice that.
    pub a: L,
    /// Stribeck velocity.
    pub s: L,
    /// Velocity of the belt.
    pub v: L,
}

/// Sign of the velocity on the belt; zero where the mass sticks.
#[derive(Debug, Clone, Copy)]
pub struct Slip<L>(L);

impl<L: Lane> Default for Slip<L> {
    fn default() -> Self {
        Slip(L::splat(0.0))
    }
}

/// What happens to the mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Change {
    /// It begins to stick.
    Stick = 1,
    /// It begins to slip.
    Slip,
    /// Its velocity on the belt changes its sign.
    Reversal,
}

impl Event for Change {
    const ALL: &'static [Change] = &[Change::Stick, Change::Slip, Change::Reversal];
    fn number(self) -> u8 {
        self as u8
    }
}

own_system!(Belt { c, a, s, v }
    section 1 state [L; 2], mode Slip<L>, event Change, scales |_| [1.0]);

/// Places among the series, after those of x and x': velocity on the belt over s, and its exponential.
const RATIO: usize = 2;
const DECAY: usize = 3;

in_lanes! {
    impl<L: Lane> SideBySide for Slip<L> {
        type One = Slip<f64>;
        fn splat(one: &Slip<f64>) -> Self {
            Slip(L::splat(one.0))
        }
        fn lane(&self, index: usize) -> Slip<f64> {
            Slip(self.0.lane(index))
        }
        fn put(&mut self, index: usize, one: &Slip<f64>) {
            self.0 = self.0.with_lane(index, one.0);
        }
        fn take_lane(&mut self, index: usize, other: &Self) {
            self.0 = self.0.with_lane_of(index, other.0);
        }
    }

    impl<L: Lane> Belt<L> {
        /// Where the mass sticks.
        fn sticks(slip: &Slip<L>) -> L::Mask {
            (slip.0 * slip.0).lt(L::splat(0.5))
        }

        /// What follows where the mass has the velocity of the belt, to which it came from `side`.
        fn at_rest(&self, x: L, side: L) -> Slip<L> {
            let pull = x + self.c * self.v;
            let holds = pull.abs().le(self.a + self.a);
            Slip(L::select(holds, L::splat(0.0), -side))
        }
    }

    impl<L: Lane> Switched<L> for Belt<L> {
        type State = [L; 2];
        type Mode = Slip<L>;
        type Jet = Taylor<L, 4>;
        type Event = Change;
        const GUARDS: usize = 2;
        const AUTONOMOUS: bool = true;

        /// The longest time between two turns that is waited for.
        fn period(&self) -> L {
            L::splat(100.0)
        }

        fn start(&self, _: L, [x, v]: &mut [L; 2]) -> Slip<L> {
            let (zero, u) = (L::splat(0.0), *v - self.v);
            let side = L::select(u.lt(zero), L::splat(-1.0), L::splat(1.0));
            let pulled = L::select(x.lt(zero), L::splat(-1.0), L::splat(1.0));
            Slip(L::select(u.abs().le(zero), self.at_rest(*x, pulled).0, side))
        }

        fn expand(&self, slip: &Slip<L>, _: L, state: &[L; 2], jet: &mut Taylor<L, 4>) {
            let (zero, sticks) = (L::splat(0.0), Self::sticks(slip));
            jet.begin(state);
            jet[RATIO][0] = -(slip.0 * (state[1] - self.v) / self.s);
            jet[DECAY][0] = exp(jet[RATIO][0]);
            for k in 0..ORDER {
                let per = L::splat(series::INVERSE[k + 1]);
                let constant = if k == 0 { self.a } else { zero };
                let friction = -(slip.0 * (constant + self.a * jet[DECAY][k]));
                let force = friction - jet[0][k] - self.c * jet[1][k];
                jet[0][k + 1] = jet[1][k] * per;
                jet[1][k + 1] = L::select(sticks, zero, force * per);
                jet[RATIO][k + 1] = -(slip.0 * jet[1][k + 1] / self.s);
                jet[DECAY][k + 1] = series::exp_term(&jet[RATIO], &jet[DECAY], k + 1);
            }
        }

        fn pace<'a>(&self, jet: &'a Taylor<L, 4>) -> [&'a Series<L>; 2] {
            [&jet[0], &jet[1]]
        }

        fn watched(&self, which: usize, slip: &Slip<L>) -> L::Mask {
            let sticks = Self::sticks(slip);
            if which == 0 { !sticks } else { sticks }
        }

        /// While the mass slips, its speed on the belt; while it sticks, what friction can still hold.
        fn guard(&self, which: usize, slip: &Slip<L>, jet: &Taylor<L, 4>, guard: &mut Series<L>) {
            if which == 0 {
                *guard = series::scaled(&jet[1], slip.0);
                guard[0] = slip.0 * (jet[1][0] - self.v);
            } else {
                *guard = series::scaled(&jet[0], L::splat(-1.0));
                guard[0] = self.a + self.a - self.c * self.v - jet[0][0];
            }
        }

        fn at(&self, jet: &Taylor<L, 4>, h: L) -> [L; 2] {
            jet.at(h)
        }

        fn motion(&self, jet: &Taylor<L, 4>, h: L) -> ([L; 2], [L; 2]) {
            jet.motion(h)
        }

        fn switch(
            &self,
            which: usize,
            due: L::Mask,
            slip: &mut Slip<L>,
            [x, v]: &mut [L; 2],
            zeros: &mut Zeros<L>,
            _: L,
        ) -> L {
            *v = L::select(due, self.v, *v);
            if which == 1 {
                // Friction is the same at rest and in slow sliding, so the acceleration starts from zero.
                slip.0 = L::select(due, L::splat(-1.0), slip.0);
                zeros[0] = L::select(due, L::splat(2.0), zeros[0]);
                return L::select(due, Change::Slip.code(), L::splat(0.0));
            }
            let next = self.at_rest(*x, slip.0);
            let sticks = Self::sticks(&next);
            slip.0 = L::select(due, next.0, slip.0);
            zeros[0] = L::select(due, L::select(sticks, L::splat(0.0), L::splat(1.0)), zeros[0]);
            let code = L::select(sticks, Change::Stick.code(), Change::Reversal.code());
            L::select(due, code, L::splat(0.0))
        }

        fn lost(&self, [x, v]: &[L; 2]) -> L::Mask {
            not_finite(*x + *v)
        }

        fn section(&self, jet: &Taylor<L, 4>, section: &mut Series<L>) {
            *section = jet[1];
        }
    }

    impl<L: Lane> Stroboscopic<L, 1> for Belt<L> {
        fn point([x, _]: &[L; 2]) -> [L; 1] {
            [*x]
        }
        fn state([x]: [L; 1]) -> [L; 2] {
            [x, L::splat(0.0)]
        }
    }
}

/// The equations as they are written, by which every step is checked.
impl Field for Belt<f64> {
    type Coordinates = [f64; 2];
    fn coordinates(state: &[f64; 2]) -> [f64; 2] {
        *state
    }
    fn rates(&self, slip: &Slip<f64>, _: f64, [x, v]: &[f64; 2]) -> [f64; 2] {
        if slip.0 == 0.0 {
            return [*v, 0.0];
        }
        let friction = slip.0 * self.a * (1.0 + libm::exp(-(v - self.v).abs() / self.s));
        [*v, -friction - x - self.c * v]
    }
    fn weights(&self) -> [f64; 2] {
        [1.0, 1.0]
    }
}

/// Starts at each belt speed, as published.
const STARTS: usize = 2000;
/// Belt speeds, from 0.5 in steps of 0.075.
const SPEEDS: usize = 21;

/// The share of starts, uniform over [-2, 2] x [0, 2], that lead to the cycle of sticking and slipping at a belt speed; the others come to
/// slide steadily.
fn share_of_the_cycle(v: f64) -> Share {
    let belt = Belt { c: 0.1, a: 0.5, s: 0.5, v };
    let mut random = fastrand::Rng::with_seed(7);
    let starts = (0..STARTS).map(|_| [4.0 * random.f64() - 2.0, 2.0 * random.f64()]);
    let cases: Vec<_> = starts.map(|start| Case::new(belt, start)).collect();
    // Where steady sliding is nearly neutral, starts approach it slowly.
    let protocol = Protocol { max_cycles: 5000, ..Protocol::default() };
    let orbits = orbit::settle_all(&cases, &protocol, Machine::default());
    let table = attractors_of(&belt, &orbits, &protocol);
    assert_eq!(table.attractors.len(), usize::from(table.of_case.iter().any(Option::is_some)));
    let label = |start: usize| table.of_case[start].map_or(Label::Undecided, Label::Attractor);
    let none = Share { starts: 0, value: 0.0, error: 0.0, interval: None };
    shares_of_draws(STARTS, label, table.attractors.len()).first().copied().unwrap_or(none)
}

fn main() {
    let shares: Vec<(f64, Share)> =
        (0..SPEEDS).map(|i| 0.5 + 0.075 * i as f64).map(|v| (v, share_of_the_cycle(v))).collect();
    let belt = Belt { c: 0.1, a: 0.5, s: 0.5, v: 1.5 };
    let protocol = Protocol::default();
    // The cycle that sticks and slips: what came before is forgotten while the mass sticks, so that its
    // multiplier is zero.
    let starts = [[2.0, 0.0], [1.0, 0.0], [0.7, 0.0]].map(|start| Case::new(belt, start));
    let orbits = orbit::settle_all(&starts, &protocol, Machine::default());
    let table = attractors_of(&belt, &orbits, &protocol);
    let orbit = &orbits[0];
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    assert_eq!(orbit.certificate.proof, Proof::Newton);
    assert!(orbit.certificate.multipliers[0].abs() < 1e-12);
    assert!(orbit.exponent.value < -4.0 || orbit.exponent.value == f64::NEG_INFINITY);

    // Followed in the velocity of the belt it ends where it just fails to stick; the branch turns there, into
    // the unstable cycle that does not stick, and ends where that shrinks onto steady sliding.
    let request = branch::Request {
        system: belt,
        section: orbit.section[0],
        period: orbit.period,
        along: "v",
        range: [1.0, 2.5],
        doublings: 0,
        second: None,
        curve_range: None,
        longest_step: 0.05,
        most_points: 1000,
        tolerance: protocol.tolerance,
    };
    let found = branch::follow(&request).expect("the cycle");
    let at = |kind: SpecialKind| {
        let special = found.branches[0].special.iter().find(|special| special.kind == kind);
        special.expect("the special point").point.parameter
    };
    let cycle_disappears = at(SpecialKind::EventSequence);
    // The smallest cycle that can be told from steady sliding; how far it is away goes with its size squared.
    assert_eq!(found.branches[0].ends[1], End::Equilibrium);
    let sliding_unstable = found.branches[0].points.last().expect("an orbit").parameter;
    assert!((cycle_disappears - 1.8366).abs() < 5e-5, "{cycle_disappears}");
    let exact = belt.s * libm::log(belt.a / (belt.c * belt.s));
    assert!((sliding_unstable - exact).abs() < 1e-8, "{sliding_unstable} {exact}");

    if std::env::args().any(|argument| argument == "--json") {
        println!(
            "{{\"cycle_disappears_v\": {cycle_disappears}, \"sliding_unstable_v\": {sliding_unstable}, \
             \"attractors\": {}, \"shares\": {:?}}}",
            table.attractors.len(),
            shares.iter().map(|(_, share)| share.value).collect::<Vec<f64>>()
        );
        return;
    }
    println!(
        "speed of the belt, share of {STARTS} starts that lead to the cycle of sticking and slipping:"
    );
    for (v, share) in shares {
        println!("  {v:.3}  {:.4} +- {:.4}", share.value, share.error);
    }
    println!("the cycle of sticking and slipping disappears at v = {cycle_disappears:.9}");
    println!("steady sliding is stable above v = {sliding_unstable:.9} (exactly {exact:.9})");
}
