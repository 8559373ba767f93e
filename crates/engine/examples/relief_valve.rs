//! A pressure relief valve (Hos and Champneys 2012), which no drive moves: y1' = y2, y2' = -kappa y2 -
//! (y1 + delta) + y3, y3' = beta (q - y1 sqrt(y3)), with an impact y2 -> -r y2 on the seat y1 = 0.
//!
//! `cargo run --release -p capsulemap-engine --example relief_valve -- --json`; `--values 1000` computes a diagram
//! of fewer flow rates than 30 720, `--svg FILE` draws it.

use std::time::Instant;

use capsulemap_engine::attractor::attractors_of;
use capsulemap_engine::branch::{self, End, SpecialKind};
use capsulemap_engine::flow::{Event, Field, Stroboscopic, Switched, System, Taylor, Zeros};
use capsulemap_engine::lane::elementary::not_finite;
use capsulemap_engine::lane::series::{self, SquareRoot};
use capsulemap_engine::lane::{Lane, ORDER, Series};
use capsulemap_engine::orbit::return_map::{Cycles, returned};
use capsulemap_engine::orbit::{self, Case, Machine, Outcome, Proof, Protocol, Returns};
use capsulemap_engine::{in_lanes, own_system};

/// The valve by its parameters; seen once a maximum of y1 if `MAXIMA`, else at equal times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Valve<L, const MAXIMA: bool> {
    /// Damping.
    pub kappa: L,
    /// Load of the spring on the closed valve.
    pub delta: L,
    /// Stiffness of the vessel.
    pub beta: L,
    /// Coefficient of restitution of the seat.
    pub r: L,
    /// Flow rate into the vessel.
    pub q: L,
}

/// What happens to the valve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Seat {
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
            let root = SquareRoot::of(jet[2][0]);
            for k in 0..ORDER {
                let per = L::splat(series::INVERSE[k + 1]);
                jet[ROOT][k] = root.term(&jet[2], &jet[ROOT], k);
                let outflow = series::product_term(&jet[ROOT], &jet[0], k);
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

        fn motion(&self, jet: &Taylor<L, 4>, h: L) -> ([L; 3], [L; 3]) {
            jet.motion(h)
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

        fn touching<'a>(&self, jet: &'a Taylor<L, 4>) -> Option<(&'a Series<L>, [L; 2])> {
            Some((&jet[0], [L::splat(0.0); 2]))
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

/// What is followed in the flow rate from an orbit.
fn request<const D: usize, const MAXIMA: bool>(
    system: Valve<f64, MAXIMA>,
    section: [f64; D],
    range: [f64; 2],
) -> branch::Request<Valve<f64, MAXIMA>, D>
where
    Valve<f64, MAXIMA>: System<D, Parameter = &'static str>,
{
    let (longest_step, most_points, tolerance) = (0.05, 1000, 1e-12);
    let (period, along, doublings, second) = (1, "q", 0, None);
    branch::Request {
        system,
        section,
        period,
        along,
        range,
        doublings,
        second,
        curve_range: None,
        longest_step,
        most_points,
        tolerance,
    }
}

/// The special point of a kind on a branch.
fn special<O, const D: usize>(found: &branch::Found<O, [f64; D]>, kind: SpecialKind) -> f64 {
    let special = found.branches[0].special.iter().find(|special| special.kind == kind);
    special.expect("the special point").point.parameter
}

/// Where the least y1 of the settled cycle vanishes, which is nearly linear there, from two flow rates above `near`.
fn touch_of_settled_cycles(near: f64) -> f64 {
    let protocol = Protocol::default();
    let least = |q: f64| {
        let system = valve::<true>(q);
        let orbit = orbit::settle(&Case::new(system, [4.0, 0.0, 15.0]), &protocol);
        let mut least = f64::INFINITY;
        let cycle = Cycles { count: 1, tolerance: protocol.tolerance };
        returned(&system, orbit.section[0], &cycle, |step| {
            let at = |i: u32| system.at(&step.jet, step.length * f64::from(i) / 64.0)[0];
            least = (0..=64).map(at).fold(least, f64::min);
        })
        .expect("the cycle is closed");
        assert!(least > 0.0, "no impact at {q}");
        least
    };
    let flows = [near + 2e-4, near + 4e-4];
    let [a, b] = flows.map(least);
    flows[0] - a * (flows[1] - flows[0]) / (b - a)
}

/// The maxima of y1 over the flow rate as a picture, one dot each.
fn diagram(flows: &[f64], maxima: &[Returns<2>]) -> String {
    let mut dots = String::new();
    for (q, returns) in flows.iter().zip(maxima).step_by(8) {
        for [y1, _] in &returns.points {
            let (x, y) = (60.0 + 54.0 * q, 380.0 - 22.0 * y1);
            dots += &format!("<rect x='{x:.2}' y='{y:.2}' width='.4' height='.4'/>");
        }
    }
    let tick = |i: i32| {
        let (x, y) = (60 + 108 * i, 380 - 66 * i);
        format!(
            "<path d='M{x} 380v5M60 {y}h-5' stroke='black'/><text x='{x}' y='400'>{}</text>\
             <text x='40' y='{}'>{}</text>",
            2 * i,
            y + 4,
            3 * i
        )
    };
    let ticks: String = (0..=5).map(tick).collect();
    let left_out = maxima.iter().filter(|it| it.failure.is_some()).count();
    let note = format!(
        "left out: {left_out} of {} flow rates, at which the valve comes to rest and has no more maxima",
        flows.len()
    );
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 640 430' font-family='sans-serif' \
         font-size='13' text-anchor='middle'><rect width='640' height='430' fill='white'/>{dots}\
         <path d='M60 30V380H600' fill='none' stroke='black'/>{ticks}<text x='330' y='424'>flow \
         rate q</text><text transform='rotate(-90 16 205)' x='16' y='205'>maximum of y1</text>\
         <text x='330' y='20'>{note}</text></svg>"
    )
}

fn main() {
    // The equilibrium, seen at equal times, is a fixed point; a pair of multipliers passes the unit circle.
    let at_rest = request(valve::<false>(flow_at_rest(4.0)), [4.0, 0.0, 14.0], [4.0, 20.0]);
    let found = branch::follow(&at_rest).expect("the equilibrium");
    let loss_of_stability = special(&found, SpecialKind::NeimarkSacker);
    let exact = exact_loss_of_stability();
    assert!((loss_of_stability - exact).abs() < 1e-9 * exact, "{loss_of_stability} {exact}");

    // The cycle that is left, with a certificate, and the exponent of its multipliers.
    let protocol = Protocol::default();
    let orbit = orbit::settle(&Case::new(valve::<true>(8.0), [4.0, 0.0, 15.0]), &protocol);
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    assert_eq!(orbit.certificate.proof, Proof::Newton);
    let largest = orbit.certificate.multipliers[0].abs();
    assert!((orbit.exponent.value - libm::log(largest) / orbit.duration).abs() < 1e-9);
    // Continued in the flow rate, it shrinks onto the equilibrium at one end and touches the seat at the other.
    let cycle = request(valve::<true>(8.0), orbit.section[0], [5.0, 9.0]);
    let found = branch::follow(&cycle).expect("the cycle");
    let last = found.branches[0].points.last().expect("a point").parameter;
    assert_eq!(found.branches[0].ends, [End::Bound, End::Equilibrium]);
    assert!((last - exact).abs() < 1e-6, "{last}");
    let first_touch = special(&found, SpecialKind::Grazing);
    let settled = touch_of_settled_cycles(first_touch);
    assert!((first_touch - settled).abs() < 2e-6, "{first_touch} {settled}");

    // Two starts at one flow rate lead to one attractor or to two.
    let starts = [[0.5, 0.0, 10.0], [6.0, 0.0, 12.0], [4.0, 0.0, 15.0]];
    let cases: Vec<_> = starts.map(|start| Case::new(valve::<true>(7.0), start)).to_vec();
    let orbits = orbit::settle_all(&cases, &protocol, Machine::default());
    let attractors = attractors_of(&valve::<true>(7.0), &orbits, &protocol).attractors.len();

    // The diagram: 30 720 flow rates, 1024 maxima of y1 waited and 32 kept, on one core.
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let given = |key: &str| arguments.iter().skip_while(|it| *it != key).nth(1);
    let values = given("--values").map_or(30_720, |it| it.parse().expect("a number of flow rates"));
    let flow = |i: u32| 0.2 + 9.8 * f64::from(i) / f64::from(values - 1);
    let flows: Vec<f64> = (0..values).map(flow).collect();
    let cases: Vec<_> =
        flows.iter().map(|q| Case::new(valve::<true>(*q), [0.2, 0.0, 10.0])).collect();
    let begun = Instant::now();
    let maxima = orbit::returns(&cases, (1024, 32), 1e-10, Machine::single());
    let values_per_second = flows.len() as f64 / begun.elapsed().as_secs_f64();
    // What is not finished has come to rest where the equilibrium is stable.
    let unfinished = flows.iter().zip(&maxima).filter(|(_, it)| it.failure.is_some());
    assert!(unfinished.clone().all(|(q, _)| *q > exact));
    let at_rest = unfinished.count();

    if let Some(file) = given("--svg") {
        std::fs::write(file, diagram(&flows, &maxima)).expect("the picture can be written");
    }
    if arguments.iter().any(|argument| argument == "--json") {
        println!(
            "{{\"loss_of_stability_q\": {loss_of_stability}, \
             \"first_touch_q\": {first_touch}, \
             \"values_per_second\": {values_per_second:.0}, \"at_rest\": {at_rest}, \
             \"attractors_at_7\": {attractors}}}"
        );
        return;
    }
    println!(
        "the equilibrium loses its stability at q = {loss_of_stability:.12} (exactly {exact:.12})"
    );
    println!("the cycle touches the seat first at q = {first_touch:.9}");
    println!("{values_per_second:.0} flow rates a second, {at_rest} of {} at rest", flows.len());
}
