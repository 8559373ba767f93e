//! Numbers with derivatives have the same bits alone and in the lanes of every instruction set.

use capsulemap_engine::flow::{MAX_GUARDS, Motion, Step, Stroboscopic};

use capsulemap_engine::lane::{Dual, Instructions, Lane, Mask, Work};
use capsulemap_models::capsule::{Capsule, CapsuleParameters as _, CapsuleState as _, Case, State};

use super::derivatives::dual_capsule;
use super::draws;

const CYCLES: usize = 2;
const TOLERANCE: f64 = 1e-12;

/// The bits of the section's coordinates and of their derivatives.
type Bits = [[u64; 4]; 3];

fn start(case: &Case) -> [f64; 3] {
    let State { r, y1, y2, .. } = case.start.capsule();
    [r, y1, y2]
}

/// The bits that lane `index` holds.
fn bits<L: Lane>(point: &[Dual<L, 3>; 3], index: usize) -> Bits {
    point.map(|Dual { value, gradient }| {
        let [a, b, c] = gradient.map(|derivative| derivative.lane(index).to_bits());
        [value.lane(index).to_bits(), a, b, c]
    })
}

/// What each cycle of one case ends with.
fn alone(case: &Case) -> Vec<Bits> {
    let system = dual_capsule(case);
    let point = start(case);
    let from = std::array::from_fn(|i| Dual::<f64, 3>::variable(point[i], i));
    let period = Dual::constant(case.parameters.drive_period());
    let mut motion = Motion::new(&system, Dual::splat(0.0), Capsule::state(from));
    let mut step = Step::default();
    let mut found = Vec::new();
    while found.len() < CYCLES {
        motion.step(&system, period, TOLERANCE, &mut step);
        if period.le(motion.time) {
            motion.begin_cycle(&system, true);
            found.push(bits(&Capsule::point(&motion.state), 0));
        }
    }
    found
}

/// The same for every case of a list, side by side, as many as the lanes are.
struct Together<'a>(&'a [Case]);

impl Work for Together<'_> {
    type Output = Vec<Vec<Bits>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        // A loop, as what iterators call is compiled without the instructions of the lanes.
        let mut found = Vec::with_capacity(self.0.len());
        for cases in self.0.chunks(L::WIDTH) {
            found.extend(side_by_side::<L>(cases));
        }
        found
    }
}

/// Up to `L::WIDTH` cases, each lane with its own time, step and mode; spare lanes repeat the first case.
#[inline(always)]
fn side_by_side<L: Lane>(cases: &[Case]) -> Vec<Vec<Bits>> {
    let of = |lane: usize| cases.get(lane).unwrap_or(&cases[0]);
    let shape = of(0).parameters.shape();
    let lanes = |number: &dyn Fn(&Case) -> f64| L::from_fn(|lane| number(of(lane)));
    let system = Capsule::<Dual<L, 3>>::new(
        |p| Dual::constant(lanes(&|case| case.parameters[p])),
        shape,
        of(0).section_phase,
    );
    let from = std::array::from_fn(|i| Dual::variable(lanes(&|case| start(case)[i]), i));
    let periods = Dual::<L, 3>::constant(lanes(&|case| case.parameters.drive_period()));
    // As a new motion begins, with the one copy of the step that there is.
    let zero = Dual::splat(0.0);
    let mut motion = Motion::begun(&system, zero, Capsule::state(from));
    let mut first_steps = MAX_GUARDS;
    let mut step = Step::default();
    let mut found = vec![Vec::new(); cases.len()];
    while found.iter().any(|cycles| cycles.len() < CYCLES) {
        let begins = first_steps > 0;
        let (until, tolerance) = if begins { (zero, 1.0) } else { (periods, TOLERANCE) };
        motion.step(&system, until, tolerance, &mut step);
        if begins {
            first_steps = if step.switches.any() { first_steps - 1 } else { 0 };
            continue;
        }
        let ended = periods.le(motion.time);
        for (lane, cycles) in found.iter_mut().enumerate() {
            if ended.lane(lane) && cycles.len() < CYCLES {
                cycles.push(bits(&Capsule::point(&motion.state), lane));
            }
        }
        if ended.any() {
            motion.begin_cycle(&system, ended);
        }
    }
    found
}

#[test]
fn derivatives_have_the_same_bits_alone_and_among_others() {
    let mut cases = draws::cases(48, 51);
    // The phase is one number for all lanes.
    cases.iter_mut().for_each(|case| case.section_phase = 0.7);
    let expected: Vec<Vec<Bits>> = cases.iter().map(alone).collect();
    let zero = 0.0_f64.to_bits();
    let moves = |found: &Vec<Bits>| found[CYCLES - 1].iter().any(|[_, a, ..]| *a != zero);
    assert!(expected.iter().filter(|found| moves(found)).count() > 40);
    for instructions in Instructions::available() {
        assert!(instructions.run(Together(&cases)) == expected, "{}", instructions.name());
    }
}
