//! Cases that are integrated side by side, and nothing else.

use std::marker::PhantomData;

use capsulemap::capsule::{
    AsPrinted, CapsuleParameters, Filippov, Form, General, OverFolds, Parameters, Reading, State,
};
use capsulemap::flow::{Motion, Step};
use capsulemap::lane::{Instructions, Lane, Mask, SideBySide, Work};

/// Drive cycles of each case.
pub const CYCLES: u64 = 100;

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

/// Integrates every case from its start over so many cycles, the section at phase zero.
pub fn integrate_from(
    instructions: Instructions,
    cases: &[(Parameters, State<f64>)],
    cycles: u64,
    tolerance: f64,
) -> Vec<End> {
    let form = cases.first().map_or(Form::Filippov, |(case, _)| case.form());
    let ends = match form {
        Form::Filippov => integrate_as::<Filippov, 3>(instructions, cases, cycles, tolerance),
        Form::AsPrinted => integrate_as::<AsPrinted, 3>(instructions, cases, cycles, tolerance),
        Form::General => integrate_as::<General, 3>(instructions, cases, cycles, tolerance),
        Form::OverFolds => integrate_as::<OverFolds, 4>(instructions, cases, cycles, tolerance),
    };
    let is_sound = |end: &End| end.state.y1.is_finite() && end.events <= end.steps;
    assert!(ends.iter().all(is_sound), "motions are finite, and every event ends a step");
    ends
}

/// The same of cases of one form.
fn integrate_as<R: Reading<D>, const D: usize>(
    instructions: Instructions,
    cases: &[(Parameters, State<f64>)],
    cycles: u64,
    tolerance: f64,
) -> Vec<End> {
    instructions.run(Integrate::<R, D> { cases, cycles, tolerance, form: PhantomData })
}

struct Integrate<'a, R, const D: usize> {
    cases: &'a [(Parameters, State<f64>)],
    cycles: u64,
    tolerance: f64,
    form: PhantomData<R>,
}

impl<R: Reading<D>, const D: usize> Work for Integrate<'_, R, D> {
    type Output = Vec<End>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Vec<End> {
        let Some((first, _)) = self.cases.first() else { return Vec::new() };
        let one = R::single(first, 0.0);
        let mut system = <R::In<L> as SideBySide>::splat(&one);
        let begun = Motion::new(&one, 0.0, State::default());
        let mut motion = Motion::<L, R::In<L>>::splat(&begun);
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
                    let one = R::single(case, 0.0);
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
                motion.begin_cycle(&system, ended);
            }
        }
    }
}
