//! Returns that are followed side by side.

use std::cmp::Reverse;

use crate::flow::{
    Event, MAX_GUARDS, Motion, Reason, STEPS_PER_CYCLE, Step, Stroboscopic, Switched, System,
};
use crate::lane::{Dual, Instructions, Lane, Mask, SideBySide, Work, series};

use super::extrema::SignChanges;
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
    instructions.run_on_a_vector(Crowd { requests })
}

struct Crowd<'a, M: System<D>, const D: usize> {
    requests: &'a [&'a ReturnRequest<M, D>],
}

impl<M: System<D>, const D: usize> Work for Crowd<'_, M, D> {
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
            _ => panic!("a section has one to six coordinates, not {D}"),
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

/// A return in a lane.
struct Occupant<E, const U: usize> {
    /// Its place among those that are asked for.
    number: usize,
    passing: Passing<Dual<f64, U>, E>,
    cycles: u64,
    /// Steps of the cycle.
    steps: u64,
}

/// The returns in their order, as many at a time as there are lanes.
///
/// Method: the longest first, so that the lanes run empty together. The next motions enter free lanes by
/// [`Motion::begun`] beside those that go on.
#[inline(always)]
fn together<L: Lane, M: System<D>, const D: usize, const U: usize>(
    requests: &[&ReturnRequest<M, D>],
) -> Vec<Result<Passage<M::Event, D>, Reason>> {
    let alike = |it: &&ReturnRequest<M, D>| it.system.is_alike(&requests[0].system);
    assert!(requests.iter().all(alike), "motions side by side are alike");
    let tolerance = requests[0].cycles.tolerance;
    let equal = |it: &&ReturnRequest<M, D>| it.cycles.tolerance == tolerance;
    assert!(requests.iter().all(equal), "one tolerance serves all lanes");
    let mut found: Vec<_> = requests.iter().map(|_| Err(Reason::TooManySteps)).collect();
    let mut places: Vec<usize> = (0..requests.len()).collect();
    places.sort_by_key(|&place| Reverse(requests[place].cycles.count));
    let mut next = places.iter().copied().peekable();
    let mut occupants: Vec<Option<Occupant<M::Event, U>>> = (0..L::WIDTH).map(|_| None).collect();
    // What moves to no purpose in a lane that is free.
    let mut in_lane = vec![requests[places[0]]; L::WIDTH];
    let mut system = in_lanes::<L, M, D, U>(&in_lane);
    let mut entering = begun(&system, &in_lane);
    let mut motion = begun(&system, &in_lane);
    let mut until = system.period();
    let mut step = Step::default();
    let mut changes = SignChanges::<L::Plain, Dual<f64, U>>::none();
    let (mut first_steps, mut enter) = (0, 0_u64);
    loop {
        let free = occupants.iter().filter(|it| it.is_none()).count();
        // It takes some steps to enter, so that short returns enter together.
        let enough = |place: &usize| free as u64 * requests[*place].cycles.count >= L::WIDTH as u64;
        if next.peek().is_none() && free == L::WIDTH {
            return found;
        } else if free > 0 && first_steps == 0 && next.peek().is_some_and(enough) {
            let free = (0..L::WIDTH).filter(|&lane| occupants[lane].is_none());
            let entrants: Vec<(usize, usize)> = free.zip(next.by_ref()).collect();
            for &(lane, number) in &entrants {
                in_lane[lane] = requests[number];
                enter |= 1 << lane;
            }
            system = in_lanes::<L, M, D, U>(&in_lane);
            until = system.period();
            for (lane, number) in entrants {
                let passing = Passing::new(until.value.lane(lane));
                occupants[lane] = Some(Occupant { number, passing, cycles: 0, steps: 0 });
            }
            entering = begun(&system, &in_lane);
            first_steps = MAX_GUARDS;
        }
        let enters = first_steps > 0;
        let moving = if enters { &mut entering } else { &mut motion };
        let (to, tolerance) = if enters { (Dual::splat(0.0), 1.0) } else { (until, tolerance) };
        moving.step(&system, to, tolerance, &mut step);
        if enters {
            first_steps -= 1;
            while first_steps == 0 && enter != 0 {
                motion.take_lane(enter.trailing_zeros() as usize, &entering);
                enter &= enter - 1;
            }
            continue;
        }
        let watches = |lane: &usize| occupants[*lane].is_some() && in_lane[*lane].watched;
        let watched = (0..L::WIDTH).filter(watches).fold(0, |bits, lane| bits | 1 << lane);
        let watched = L::Mask::from_bits(watched);
        if let Some((coordinate, _)) = system.touching(&step.jet).filter(|_| watched.any()) {
            changes.of(coordinate, step.length.plain(), watched, one);
        }
        let broken = motion.broken(&system).bits();
        let arrives = step.arrives.bits();
        for (lane, place) in occupants.iter_mut().enumerate() {
            let Some(occupant) = place else { continue };
            let request = in_lane[lane];
            occupant.steps += 1;
            if request.watched {
                occupant.see(&system, &step, (&changes, lane));
            }
            if broken >> lane & 1 != 0 {
                let why = motion.breakdown(&system, lane).map(Reason::from);
                found[occupant.number] = Err(why.unwrap_or(Reason::TooManySteps));
                *place = None;
            } else if arrives >> lane & 1 != 0 {
                occupant.cycles += 1;
                occupant.steps = 0;
                if occupant.cycles >= request.cycles.count
                    && let Some(Occupant { number, passing, .. }) = place.take()
                {
                    let end = M::In::<Dual<L, U>>::point(&motion.state);
                    let end = std::array::from_fn(|i| one(&end[i], lane));
                    found[number] = Ok(told(end, passing, f64::INFINITY));
                }
            } else if occupant.steps >= STEPS_PER_CYCLE {
                *place = None;
            }
        }
        if step.arrives.any() {
            motion.begin_cycle(step.arrives);
        }
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
        dual.gradient[i] = L::from_fn(|lane| in_lane[lane].units[i]);
        dual
    });
    Motion::begun(system, Dual::splat(0.0), M::In::<Dual<L, U>>::state(from))
}

impl<E: Event, const U: usize> Occupant<E, U> {
    /// Takes note of what the motion in a lane passes in a step.
    #[inline(always)]
    fn see<L: Lane, S>(
        &mut self,
        system: &S,
        step: &Step<Dual<L, U>, S>,
        (changes, lane): (&SignChanges<L::Plain, Dual<f64, U>>, usize),
    ) where
        S: Switched<Dual<L, U>, Event = E>,
    {
        let seen = (step.length.lane(lane), E::from_code(step.event.lane(lane)));
        if let Some((coordinate, surface)) = system.touching(&step.jet) {
            let at = |time: f64| {
                let terms = if time == 0.0 { 1 } else { coordinate.len() };
                let mut own = series::zero();
                for (own, lanes) in own.iter_mut().zip(&coordinate[..terms]) {
                    *own = one(lanes, lane);
                }
                value_at(&own, time)
            };
            self.passing.turn((changes, lane), seen, at, || one(&surface, lane));
        }
        self.passing.see(seen);
    }
}

/// The number that a lane holds, with its derivatives.
fn one<L: Lane, const U: usize>(lanes: &Dual<L, U>, lane: usize) -> Dual<f64, U> {
    let gradient = std::array::from_fn(|i| lanes.gradient[i].lane(lane));
    Dual { value: lanes.value.lane(lane), gradient }
}
