//! The cases that the benches measure: those of Figs 5 to 7 and a grid, computed from rest side by side.

// Each bench uses its part.
#![allow(dead_code)]

use capsulemap::capsule::{Capsule, Parameter, Parameters, State};
use capsulemap::flow::{Motion, Step};
use capsulemap::lane::{Instructions, Lane, Mask, SideBySide, Work};

/// Drive cycles of each case.
pub const CYCLES: u64 = 100;
/// Relative local error of a step.
pub const TOLERANCE: f64 = 1e-12;
/// Copies of a figure's one case, which fill the lanes.
const COPIES: usize = 64;

/// Table 1's capsule with these.
pub fn parameters(k2: f64, omega: f64, p_d: f64, delta: f64) -> Parameters {
    Parameters::with(&[
        (Parameter::K2, k2),
        (Parameter::Omega, omega),
        (Parameter::Pd, p_d),
        (Parameter::Delta, delta),
    ])
}

/// The sets of cases by name: copies of the case of a figure, and a grid of 32 x 32 cases over omega 10..100 rad/s
/// and p_d 1..6 N (k2 18.96 kN/m, delta 1.5 mm).
pub fn case_sets() -> [(&'static str, Vec<Parameters>); 4] {
    let along = |index: usize, from: f64, to: f64| from + (to - from) * index as f64 / 31.0;
    let grid = (0..32 * 32)
        .map(|i| parameters(18_960.0, along(i % 32, 10.0, 100.0), along(i / 32, 1.0, 6.0), 0.0015));
    [
        ("Fig 5", vec![parameters(2420.0, 77.91, 4.0, 0.0035); COPIES]),
        ("Fig 6", vec![parameters(18_960.0, 20.73, 4.0, 0.0015); COPIES]),
        ("Fig 7, 54.6 rad/s", vec![parameters(59_410.0, 54.6, 2.5, 0.0015); COPIES]),
        ("grid 32 x 32", grid.collect()),
    ]
}

/// Where a case ends, and how it got there.
#[derive(Debug, Clone, Copy, Default)]
pub struct End {
    /// The state after the last cycle.
    pub state: State<f64>,
    /// Steps taken.
    pub steps: u64,
    /// Events met.
    pub events: u64,
}

/// Integrates every case from rest over so many cycles.
pub fn integrate(
    instructions: Instructions,
    cases: &[Parameters],
    cycles: u64,
    tolerance: f64,
) -> Vec<End> {
    let cases: Vec<_> = cases.iter().map(|case| (case.clone(), State::default())).collect();
    integrate_from(instructions, &cases, cycles, tolerance)
}

/// Integrates every case from its start over so many cycles, the section at phase zero.
pub fn integrate_from(
    instructions: Instructions,
    cases: &[(Parameters, State<f64>)],
    cycles: u64,
    tolerance: f64,
) -> Vec<End> {
    instructions.run(Integrate { cases, cycles, tolerance })
}

struct Integrate<'a> {
    cases: &'a [(Parameters, State<f64>)],
    cycles: u64,
    tolerance: f64,
}

impl Work for Integrate<'_> {
    type Output = Vec<End>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Vec<End> {
        let Some((first, _)) = self.cases.first() else { return Vec::new() };
        let one = Capsule::single(first, 0.0);
        let mut system = Capsule::<L>::splat(&one);
        let mut motion = Motion::<L, Capsule<L>>::splat(&Motion::new(&one, 0.0, State::default()));
        let mut periods = L::splat(first.drive_period());
        let (mut steps, mut events) = (L::splat(0.0), L::splat(0.0));
        let mut case_of_lane: Vec<Option<usize>> = vec![None; L::WIDTH];
        let mut cycles_left = vec![0; L::WIDTH];
        let mut ends = vec![End::default(); self.cases.len()];
        let (mut next, mut busy) = (0, 0);
        let mut step = Step::default();
        // All lanes begin as if their case had just ended.
        let mut due = L::Mask::splat(true).bits();
        loop {
            while due != 0 {
                let lane = due.trailing_zeros() as usize;
                due &= due - 1;
                if cycles_left[lane] > 1 {
                    cycles_left[lane] -= 1;
                    continue;
                }
                if let Some(done) = case_of_lane[lane].take() {
                    busy -= 1;
                    let (steps, events) = (steps.lane(lane) as u64, events.lane(lane) as u64);
                    ends[done] = End { state: motion.state.lane(lane), steps, events };
                }
                if let Some((case, start)) = self.cases.get(next) {
                    let one = Capsule::single(case, 0.0);
                    system.put(lane, &one);
                    motion.put(lane, &Motion::new(&one, 0.0, *start));
                    periods = periods.with_lane(lane, case.drive_period());
                    (steps, events) = (steps.with_lane(lane, 0.0), events.with_lane(lane, 0.0));
                    (case_of_lane[lane], cycles_left[lane]) = (Some(next), self.cycles);
                    next += 1;
                    busy += 1;
                }
            }
            if busy == 0 {
                return ends;
            }
            motion.step(&system, periods, self.tolerance, &mut step);
            assert!(!motion.broken(&system).any(), "the cases can be integrated");
            let one = L::splat(1.0);
            steps = steps + one;
            events = events + L::select(L::splat(0.0).lt(step.event), one, L::splat(0.0));
            let ended = periods.le(motion.time);
            due = ended.bits();
            if due != 0 {
                motion.begin_cycle(ended);
            }
        }
    }
}
