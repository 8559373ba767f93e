//! Returns that are followed side by side.

use std::cmp::Reverse;
use std::iter::Peekable;
use std::vec;

use crate::flow::{Event, Motion, Reason, Stroboscopic, Switched, System};
use crate::lane::{Dual, Instructions, Lane, Mask, Series, SideBySide, Work, series};

use super::directions::{CycleStretch, add_logs, can_be_compared, orthonormalise};
use super::extrema::SignChanges;
use super::lanes::{EndedCycle, Lanes, Task};
use super::occupancy::Kernel;
use super::passage::{Integrator, OneByOne, Passage, Passing, ReturnRequest, told, value_at};

/// With no more than one lane in so many taken, returns are followed faster one by one.
const WORTHWHILE: usize = 4;

/// The returns that are asked for of systems that are alike ([`System::is_alike`]), in their order.
///
/// Guarantees: the bits of [`OneByOne`].
///
/// # Panics
/// Where the processor does not have the instructions.
pub fn passages<M: System<D>, const D: usize>(
    instructions: Instructions,
    requests: &[&ReturnRequest<M, D>],
) -> Vec<Result<Passage<M::Event, D>, Reason>> {
    instructions.run_on_a_vector(Requests { requests })
}

struct Requests<'a, M: System<D>, const D: usize> {
    requests: &'a [&'a ReturnRequest<M, D>],
}

impl<M: System<D>, const D: usize> Work for Requests<'_, M, D> {
    const IS_INTERPRETED: bool = M::IS_INTERPRETED;
    type Output = Vec<Result<Passage<M::Event, D>, Reason>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        // What is never reached is not compiled.
        let few = self.requests.len() * WORTHWHILE <= L::WIDTH;
        if const { L::WIDTH == 1 || M::Single::AUTONOMOUS } || few || !can_share(self.requests) {
            let alone = |it: &&ReturnRequest<M, D>| OneByOne.passage((*it).clone());
            return self.requests.iter().map(alone).collect();
        }
        match const { D } {
            1 => together::<L, M, D, 2>(self.requests),
            2 => together::<L, M, D, 3>(self.requests),
            3 => together::<L, M, D, 4>(self.requests),
            4 => together::<L, M, D, 5>(self.requests),
            5 => together::<L, M, D, 6>(self.requests),
            6 => together::<L, M, D, 7>(self.requests),
            7 => together::<L, M, D, 8>(self.requests),
            8 => together::<L, M, D, 9>(self.requests),
            _ => panic!("a section has one to eight coordinates, not {D}"),
        }
    }
}

/// Whether there are lanes for these returns: derivatives along a parameter are known where nothing but parameters
/// differs.
fn can_share<M: System<D>, const D: usize>(requests: &[&ReturnRequest<M, D>]) -> bool {
    let Some(first) = requests.first().map(|it| &it.system) else { return false };
    requests.iter().all(|it| it.along.is_none())
        || requests.iter().all(|it| it.system.shares_all_but_parameters(first))
}

/// The systems of the returns, each in its lane.
#[inline(always)]
fn in_lanes<L: Lane, M: System<D>, const D: usize, const U: usize>(
    in_lane: &[&ReturnRequest<M, D>],
) -> M::In<Dual<L, U>> {
    if in_lane.iter().any(|it| it.along.is_some()) {
        return in_lane[0].system.system(|parameter| {
            let value = L::from_fn(|lane| in_lane[lane].value(parameter));
            let mut dual = Dual::<L, U>::constant(value);
            dual.gradient[D] = L::from_fn(|lane| in_lane[lane].seed(parameter));
            dual
        });
    }
    let mut system = M::In::<Dual<L, U>>::splat(&in_lane[0].system.single());
    for (lane, it) in in_lane.iter().enumerate() {
        system.put(lane, &it.system.single());
    }
    system
}

/// The returns in their order, as many at a time as there are lanes.
///
/// Method: the longest first, so that the lanes run empty together.
#[inline(always)]
fn together<L: Lane, M: System<D>, const D: usize, const U: usize>(
    requests: &[&ReturnRequest<M, D>],
) -> Vec<Result<Passage<M::Event, D>, Reason>> {
    let alike = |it: &&ReturnRequest<M, D>| it.system.is_alike(&requests[0].system);
    assert!(requests.iter().all(alike), "motions side by side are alike");
    let tolerance = requests[0].cycles.tolerance;
    let equal = |it: &&ReturnRequest<M, D>| it.cycles.tolerance == tolerance;
    assert!(requests.iter().all(equal), "one tolerance serves all lanes");
    let mut waiting: Vec<usize> = (0..requests.len()).collect();
    waiting.sort_by_key(|&number| Reverse(requests[number].cycles.count));
    // What moves to no purpose in a lane that is free.
    let in_lane = vec![requests[waiting[0]]; L::WIDTH];
    let system = in_lanes::<L, M, D, U>(&in_lane);
    let motion = begun(&system, &in_lane);
    let mut lanes = Lanes::new(system, motion, tolerance);
    let mut task = Returning {
        requests,
        waiting: waiting.into_iter().peekable(),
        in_lane,
        changes: SignChanges::<L::Plain, Dual<f64, U>>::none(),
        found: requests.iter().map(|_| Err(Reason::TooManySteps)).collect(),
    };
    lanes.follow(&mut task);
    task.found
}

/// Follows motions to their returns.
struct Returning<'a, P: Lane, M: System<D>, const D: usize, const U: usize> {
    requests: &'a [&'a ReturnRequest<M, D>],
    /// The numbers of those that wait.
    waiting: Peekable<vec::IntoIter<usize>>,
    /// The return in each lane, or one that was there.
    in_lane: Vec<&'a ReturnRequest<M, D>>,
    changes: SignChanges<P, Dual<f64, U>>,
    found: Vec<Result<Passage<M::Event, D>, Reason>>,
}

/// A return in a lane.
struct ReturnInLane<E, const D: usize, const U: usize> {
    /// Its place among those that are asked for.
    number: usize,
    passing: Passing<Dual<f64, U>, E>,
    cycles: u64,
    /// What the cycles have made of its directions, where that is asked for, and what this one has so far.
    stretches: Vec<CycleStretch<D>>,
    logs: [f64; D],
}

impl<'a, P: Lane, M: System<D>, const D: usize, const U: usize> Returning<'a, P, M, D, U> {
    /// The lanes, as bits, with a return of which something is so.
    #[inline(always)]
    fn lanes_where<K>(
        &self,
        kept: &[Option<K>],
        is_so: impl Fn(&ReturnRequest<M, D>) -> bool,
    ) -> u64 {
        let mut lanes = 0;
        for (lane, kept) in kept.iter().enumerate() {
            lanes |= u64::from(kept.is_some() && is_so(self.in_lane[lane])) << lane;
        }
        lanes
    }

    /// Takes note of how much a step has stretched the directions that are followed.
    #[inline(always)]
    fn stretch<L: Lane>(&self, lanes: &mut Lanes<Dual<L, U>, M, ReturnInLane<M::Event, D, U>, D>) {
        let followed = self.lanes_where(&lanes.kept, |it| it.directions.is_some());
        if followed == 0 {
            return;
        }
        let Lanes { system, step, motion, kept, .. } = lanes;
        let due = L::Mask::from_bits(followed) & can_be_compared::<_, M::In<Dual<L, U>>, D>(step);
        let units = std::array::from_fn(|i| L::from_fn(|lane| self.in_lane[lane].units[i]));
        let lengths = orthonormalise(system, step, motion, &units, due);
        for (lane, own) in kept.iter_mut().enumerate() {
            if let Some(own) = own.as_mut().filter(|_| due.lane(lane)) {
                add_logs(&mut own.logs, &lengths, lane);
            }
        }
    }
}

impl<'a, L: Lane, M: System<D>, const D: usize, const U: usize> Task<Dual<L, U>, M, D>
    for Returning<'a, L::Plain, M, D, U>
{
    type Kept = ReturnInLane<M::Event, D, U>;
    const KERNEL: Kernel = Kernel::Returns;

    #[inline(always)]
    fn fill(&mut self, lanes: &mut Lanes<Dual<L, U>, M, Self::Kept, D>) -> bool {
        let free = L::WIDTH - lanes.count();
        let Some(&next) = self.waiting.peek() else { return lanes.count() > 0 };
        // It takes some steps to enter, so that short returns enter together.
        if free as u64 * self.requests[next].cycles.count < L::WIDTH as u64 {
            return true;
        }
        let entrants: Vec<(usize, usize)> = lanes.free().zip(self.waiting.by_ref()).collect();
        for &(lane, number) in &entrants {
            self.in_lane[lane] = self.requests[number];
        }
        lanes.system = in_lanes::<L, M, D, U>(&self.in_lane);
        lanes.enter(begun(&lanes.system, &self.in_lane));
        for (lane, number) in entrants {
            let passing = Passing::new(lanes.period(lane));
            let (stretches, logs) = (Vec::new(), [0.0; D]);
            lanes.let_in(lane, ReturnInLane { number, passing, cycles: 0, stretches, logs });
        }
        true
    }

    #[inline(always)]
    fn see(&mut self, lanes: &mut Lanes<Dual<L, U>, M, Self::Kept, D>) {
        self.stretch(lanes);
        let Lanes { system, step, kept, .. } = lanes;
        let watched = self.lanes_where(kept, |it| it.watched && it.directions.is_none());
        if watched == 0 {
            return;
        }
        let touching = system.touching(&step.jet);
        if let Some((coordinate, _)) = touching {
            let watched = L::Mask::from_bits(watched);
            self.changes.of(coordinate, step.length.plain(), watched, one);
        }
        for (lane, own) in kept.iter_mut().enumerate() {
            let Some(own) = own.as_mut().filter(|_| watched >> lane & 1 != 0) else {
                continue;
            };
            let event = M::Event::from_code(step.event.lane(lane));
            let seen = (step.length.lane(lane), event);
            if let Some((coordinate, surfaces)) = touching {
                let at = |time: f64| value_in_lane(coordinate, lane, time);
                let changes = (&self.changes, lane);
                own.passing.turn(changes, seen, at, || surfaces.map(|it| one(&it, lane)));
            }
            own.passing.see(seen);
        }
    }

    #[inline(always)]
    fn end_cycle(
        &mut self,
        lanes: &mut Lanes<Dual<L, U>, M, Self::Kept, D>,
        lane: usize,
        cycle: EndedCycle,
    ) {
        let Some(own) = &mut lanes.kept[lane] else { return };
        own.cycles += 1;
        if self.in_lane[lane].directions.is_some() {
            let logs = std::mem::replace(&mut own.logs, [0.0; D]);
            own.stretches.push(CycleStretch { logs, duration: cycle.duration });
        }
        if own.cycles < self.in_lane[lane].cycles.count {
            return;
        }
        let ReturnInLane { number, passing, stretches, .. } = lanes.take(lane);
        let end = M::In::<Dual<L, U>>::point(&lanes.motion.state);
        let end = std::array::from_fn(|i| one(&end[i], lane));
        self.found[number] = Ok(Passage { stretches, ..told(end, passing, f64::INFINITY) });
    }

    #[inline(always)]
    fn give_up(&mut self, lanes: &mut Lanes<Dual<L, U>, M, Self::Kept, D>, lane: usize) {
        let why = lanes.breakdown(lane).map_or(Reason::TooManySteps, Reason::from);
        self.found[lanes.take(lane).number] = Err(why);
    }
}

/// The motions of the returns, each in its lane, before the guards that are due at the start are obeyed.
#[inline(always)]
fn begun<L: Lane, M: System<D>, const D: usize, const U: usize>(
    system: &M::In<Dual<L, U>>,
    in_lane: &[&ReturnRequest<M, D>],
) -> Motion<Dual<L, U>, M::In<Dual<L, U>>> {
    let from = std::array::from_fn(|i| {
        let mut dual = Dual::<L, U>::constant(L::from_fn(|lane| in_lane[lane].point[i]));
        for direction in 0..D {
            dual.gradient[direction] =
                L::from_fn(|lane| in_lane[lane].coordinate_seed(i, direction));
        }
        dual
    });
    Motion::begun(system, Dual::splat(0.0), M::In::<Dual<L, U>>::state(from))
}

/// The value of a series in a lane at a time, its first term at the start.
#[inline(always)]
fn value_in_lane<L: Lane, const U: usize>(
    series: &Series<Dual<L, U>>,
    lane: usize,
    time: f64,
) -> Dual<f64, U> {
    let terms = if time == 0.0 { 1 } else { series.len() };
    let mut own = series::zero();
    for (own, lanes) in own.iter_mut().zip(&series[..terms]) {
        *own = one(lanes, lane);
    }
    value_at(&own, time)
}

/// The number that a lane holds, with its derivatives.
#[inline(always)]
fn one<L: Lane, const U: usize>(lanes: &Dual<L, U>, lane: usize) -> Dual<f64, U> {
    let gradient = std::array::from_fn(|i| lanes.gradient[i].lane(lane));
    Dual { value: lanes.value.lane(lane), gradient }
}
