//! The law of lanes: a motion has the same bits alone and in any lane of any vector, on any thread, in any order.

use capsulemap_engine::flow::cycle;
use capsulemap_engine::flow::{
    Event, Motion, Reason, STEPS_PER_CYCLE, Step, Stroboscopic, Switched,
};
use capsulemap_engine::lane::{Instructions, Lane, Mask, SideBySide, Work};
use capsulemap_engine::orbit::{
    Case, Machine, OrbitOf, Protocol, Returns, returns, settle, settle_all,
};

use super::subject::{Subject, bits, count};

const TOLERANCE: f64 = 1e-12;
/// Cycles followed.
const CYCLES: usize = 6;

/// What a case does: the bits of its section points, and its events by number and time.
#[derive(Debug, Clone, PartialEq)]
struct Course<const D: usize> {
    points: Vec<[u64; D]>,
    events: Vec<(u64, u64)>,
    failure: Option<Reason>,
}

/// A case followed alone.
fn alone<M: Subject<D>, const D: usize>(case: &Case<M, D>) -> Course<D> {
    let system = case.system.single();
    let mut motion = Motion::new(&system, case.begins, case.start);
    let mut step = Step::default();
    let mut course = Course { points: Vec::new(), events: Vec::new(), failure: None };
    for _ in 0..CYCLES {
        let events = &mut course.events;
        let ended = cycle(&system, &mut motion, &mut step, (STEPS_PER_CYCLE, TOLERANCE), |step| {
            if step.event != 0.0 {
                events.push((step.event.to_bits(), (step.start + step.length).to_bits()));
            }
        });
        if let Err(reason) = ended {
            course.failure = Some(reason);
            break;
        }
        course.points.push(M::Single::point(&motion.state).map(f64::to_bits));
    }
    course
}

/// The same for a list of cases, as many at a time as the lanes are; spare lanes repeat the first case.
struct Together<'a, M: Subject<D>, const D: usize>(&'a [Case<M, D>]);

impl<M: Subject<D>, const D: usize> Work for Together<'_, M, D> {
    type Output = Vec<Course<D>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        // A loop, as what iterators call is compiled without the instructions of the lanes.
        let mut found = Vec::with_capacity(self.0.len());
        for cases in self.0.chunks(L::WIDTH) {
            found.extend(side_by_side::<L, M, D>(cases));
        }
        found
    }
}

#[inline(always)]
fn side_by_side<L: Lane, M: Subject<D>, const D: usize>(cases: &[Case<M, D>]) -> Vec<Course<D>> {
    let first = cases[0].system.single();
    let begun = Motion::new(&first, cases[0].begins, cases[0].start);
    let mut motion = Motion::<L, M::In<L>>::splat(&begun);
    let mut system = M::In::<L>::splat(&first);
    for (lane, case) in cases.iter().enumerate() {
        let one = case.system.single();
        system.put(lane, &one);
        motion.put(lane, &Motion::new(&one, case.begins, case.start));
    }
    let periods = system.period();
    let nothing = Course { points: Vec::new(), events: Vec::new(), failure: None };
    let mut found = vec![nothing; cases.len()];
    let mut steps = vec![0; cases.len()];
    let mut step = Step::default();
    let goes_on = |course: &Course<D>| course.points.len() < CYCLES && course.failure.is_none();
    while found.iter().any(goes_on) {
        motion.step(&system, periods, TOLERANCE, &mut step);
        let mut begun = motion;
        begun.begin_cycle(&system, step.arrives);
        for (lane, course) in found.iter_mut().enumerate().filter(|(_, it)| goes_on(it)) {
            steps[lane] += 1;
            let event = step.event.lane(lane);
            if event != 0.0 {
                let time = step.start.lane(lane) + step.length.lane(lane);
                course.events.push((event.to_bits(), time.to_bits()));
            }
            if let Some(breakdown) = motion.breakdown(&system, &step, lane) {
                course.failure = Some(breakdown.into());
            } else if step.arrives.lane(lane) {
                steps[lane] = 0;
                let state = begun.state.lane(lane);
                course.points.push(M::Single::point(&state).map(f64::to_bits));
            } else if steps[lane] >= STEPS_PER_CYCLE {
                course.failure = Some(Reason::TooManySteps);
            }
        }
        motion = begun;
    }
    found
}

/// Orders in which cases are dealt to the lanes, so that each has other lanes and other neighbours, and some
/// have the last lane.
fn orders(count: usize) -> [Vec<usize>; 3] {
    let straight: Vec<usize> = (0..count).collect();
    let turned = (0..count).map(|i| (i + count / 2 + 1) % count).collect();
    [straight.clone(), straight.into_iter().rev().collect(), turned]
}

/// A list in another order.
fn ordered<T: Clone>(list: &[T], order: &[usize]) -> Vec<T> {
    order.iter().map(|&place| list[place].clone()).collect()
}

/// Section points and events have the same bits in every lane.
pub fn courses<M: Subject<D>, const D: usize>() {
    let mut events = 0;
    for seed in 0..3 {
        let cases = M::draws(count(27), 100 + seed);
        let expected: Vec<_> = cases.iter().map(alone).collect();
        let lasting = expected.iter().filter(|it| it.points.len() == CYCLES).count();
        assert!(2 * lasting > cases.len(), "{lasting} of {} can be followed", cases.len());
        events += expected.iter().map(|course| course.events.len()).sum::<usize>();
        for instructions in Instructions::available() {
            for order in orders(cases.len()) {
                let found = instructions.run(Together(&ordered(&cases, &order)));
                for (course, &place) in found.iter().zip(&order) {
                    let case = &cases[place].system;
                    assert_eq!(*course, expected[place], "{}: {case:?}", instructions.name());
                }
            }
        }
    }
    assert_eq!(events > 100, !<M::Event as Event>::ALL.is_empty(), "{events} events");
}

/// The points that a case has after the cycles waited, alone.
fn returned_alone<M: Subject<D>, const D: usize>(
    case: &Case<M, D>,
    (waited, kept): (usize, usize),
) -> (Vec<[u64; D]>, Option<Reason>) {
    let system = case.system.single();
    let mut motion = Motion::new(&system, case.begins, case.start);
    let (mut step, mut points) = (Step::default(), Vec::new());
    for met in 0..waited + kept {
        match cycle(&system, &mut motion, &mut step, (STEPS_PER_CYCLE, TOLERANCE), |_| ()) {
            Err(reason) => return (points, Some(reason)),
            Ok(_) if met < waited => {}
            Ok(_) => points.push(M::Single::point(&motion.state).map(f64::to_bits)),
        }
    }
    (points, None)
}

/// The machines to compare: all instructions, on one thread and on two.
fn machines() -> impl Iterator<Item = Machine> {
    Instructions::available().flat_map(|instructions| {
        [1, 2].map(|threads| Machine { threads: Some(threads), instructions: Some(instructions) })
    })
}

/// Returns of many cases are those of each alone.
pub fn all_returns<M: Subject<D>, const D: usize>() {
    let span = (7, 5);
    let cases = M::draws(count(40), 200);
    let expected: Vec<_> = cases.iter().map(|case| returned_alone(case, span)).collect();
    for machine in machines() {
        for order in orders(cases.len()) {
            let dealt = ordered(&cases, &order);
            let found = returns(&dealt, (span.0 as u64, span.1), TOLERANCE, machine);
            for (Returns { points, failure }, &place) in found.iter().zip(&order) {
                let found = (bits(points), *failure);
                assert_eq!(found, expected[place], "{machine:?}: {:?}", cases[place].system);
            }
        }
    }
}

/// What a case settles to, as text and bits.
fn verdict<M: Subject<D>, const D: usize>(orbit: &OrbitOf<M, D>) -> String {
    let numbers = [orbit.residual, orbit.defect, orbit.size, orbit.duration, orbit.excluded];
    let exponent = [orbit.exponent.value, orbit.exponent.uncertainty];
    let multipliers = orbit.multipliers().iter().map(|it| [it.re.to_bits(), it.im.to_bits()]);
    let failure = orbit.failure.map(|failure| (failure.reason, failure.time.to_bits()));
    format!(
        "{:?} {} {:?} {:x?} {multipliers:x?} {:x?} {:x?} {} {} {failure:?}",
        orbit.outcome,
        orbit.period,
        orbit.certificate.proof,
        bits(&orbit.section),
        exponent.map(f64::to_bits),
        numbers.map(f64::to_bits),
        orbit.cycles,
        orbit.measured_cycles,
    )
}

/// Many cases settle to what each settles to alone.
pub fn all_orbits<M: Subject<D>, const D: usize>() {
    let usual = Protocol::default();
    let protocol = Protocol { max_cycles: 300, exponent_cycles: 64, measured_cycles: 8, ..usual };
    let cases = M::draws(count(21), 300);
    let expected: Vec<String> =
        cases.iter().map(|case| verdict::<M, D>(&settle(case, &protocol))).collect();
    for machine in machines() {
        for order in &orders(cases.len())[..2] {
            let found = settle_all(&ordered(&cases, order), &protocol, machine);
            for (orbit, &place) in found.iter().zip(order) {
                let found = verdict::<M, D>(orbit);
                assert_eq!(found, expected[place], "{machine:?}: {:?}", cases[place].system);
            }
        }
    }
}
