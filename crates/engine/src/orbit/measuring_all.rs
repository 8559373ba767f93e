//! Cycles of many motions that are measured side by side.

use std::cmp::Reverse;
use std::collections::VecDeque;

use crate::flow::{Motion, Observer, Step, Stroboscopic, Switched, System};
use crate::lane::{Instructions, Lane, Mask, SideBySide, Work};

use super::measuring::{Kept, MeasureRequest, Measured, batch_ends, measured_alone};
use super::trajectory::Progress;

/// With no more than one lane in so many taken, cycles are measured faster one motion by one.
const WORTHWHILE: usize = 4;

/// The cycles that are to be measured of systems that are alike ([`System::is_alike`]), in their order.
///
/// Guarantees: the bits of [`measured_alone`].
///
/// # Panics
/// Where the processor does not have the instructions.
pub fn measured_side_by_side<M: System<D>, const D: usize>(
    instructions: Instructions,
    requests: Vec<MeasureRequest<M, D>>,
) -> Vec<Measured<M, D>> {
    instructions.run_on_a_vector(Crowd { requests })
}

struct Crowd<M: System<D>, const D: usize> {
    requests: Vec<MeasureRequest<M, D>>,
}

impl<M: System<D>, const D: usize> Work for Crowd<M, D> {
    type Output = Vec<Measured<M, D>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        let few = self.requests.len() * WORTHWHILE <= L::WIDTH;
        let idle = self.requests.iter().any(|it| it.cycles == 0);
        // What is never reached is not compiled.
        if const { L::WIDTH == 1 || M::Single::AUTONOMOUS } || few || idle {
            return self.requests.into_iter().map(measured_alone).collect();
        }
        together::<L, M, D>(self.requests)
    }
}

/// A motion in a lane.
struct Occupant<M: System<D>, const D: usize> {
    /// Its place among those that are to be measured.
    number: usize,
    system: M::Single,
    kept: Kept<D>,
    progress: Progress,
    cycles_left: u64,
    batches: Vec<M::Observer>,
    /// The cycles at which batches end that it has not come to.
    ends: VecDeque<u64>,
}

/// The cycles of each, as many motions at a time as there are lanes.
///
/// Method: the longest first, so that the lanes run empty together; a motion that cannot be followed begins again by
/// itself, which tells why.
#[inline(always)]
fn together<L: Lane, M: System<D>, const D: usize>(
    requests: Vec<MeasureRequest<M, D>>,
) -> Vec<Measured<M, D>> {
    let first = &requests[0];
    let (tolerance, points) = (first.tolerance, first.observed_points);
    let alike = |it: &MeasureRequest<M, D>| {
        it.system.is_alike(&first.system)
            && (it.tolerance, it.observed_points) == (tolerance, points)
    };
    assert!(requests.iter().all(alike), "motions side by side are alike");
    let mut system = M::In::<L>::splat(&first.system.single());
    let mut motion = Motion::<L, M::In<L>>::splat(&first.motion);
    let mut observed = M::Observers::<L>::splat(&first.system.observer(points));
    let mut until = system.period();
    let metrics: Vec<_> = requests.iter().map(|it| it.system.metric()).collect();
    let mut next: Vec<usize> = (0..requests.len()).collect();
    next.sort_by_key(|&number| Reverse(requests[number].cycles));
    let mut next = next.into_iter();
    let mut requests: Vec<_> = requests.into_iter().map(Some).collect();
    let mut found: Vec<_> = requests.iter().map(|_| None).collect();
    let mut occupants: Vec<Option<Occupant<M, D>>> = (0..L::WIDTH).map(|_| None).collect();
    let mut step = Step::<L, M::In<L>>::default();
    let mut one = Step::<f64, M::Single>::default();
    loop {
        for (lane, place) in occupants.iter_mut().enumerate() {
            if place.is_none()
                && let Some(number) = next.next()
                && let Some(request) = &requests[number]
            {
                let single = request.system.single();
                system.put(lane, &single);
                motion.put(lane, &request.motion);
                observed.put(lane, &request.system.observer(points));
                let mut kept = Kept::new(request.points);
                kept.begin_cycle(&metrics[number], M::Single::point(&request.motion.state));
                let (progress, cycles_left) = (request.progress, request.cycles);
                *place = Some(Occupant {
                    number,
                    system: single,
                    kept,
                    progress,
                    cycles_left,
                    batches: Vec::new(),
                    ends: batch_ends(request.cycles, request.batches).collect(),
                });
                until = system.period();
            }
        }
        if occupants.iter().all(Option::is_none) {
            return found.into_iter().map(|it| it.expect("each has been measured")).collect();
        }
        motion.step(&system, until, tolerance, &mut step);
        observed.see(&system, &step);
        let broken = motion.broken(&system);
        let durations = motion.time;
        motion.begin_cycle(step.arrives);
        for (lane, place) in occupants.iter_mut().enumerate() {
            let Some(occupant) = place else { continue };
            let (number, progress) = (occupant.number, &mut occupant.progress);
            let Some(request) = &requests[number] else { continue };
            one.take_lane(lane, &step);
            occupant.kept.see(&occupant.system, &metrics[number], &one);
            progress.steps += 1;
            let late = progress.steps >= progress.deadline(request.max_steps) && !one.arrives;
            if broken.lane(lane) || late {
                found[number] = requests[number].take().map(measured_alone);
                *place = None;
            } else if one.arrives {
                progress.count(durations.lane(lane));
                occupant.cycles_left -= 1;
                let cycle = request.cycles - occupant.cycles_left;
                if occupant.ends.front() == Some(&cycle) {
                    occupant.ends.pop_front();
                    occupant.batches.push(observed.lane(lane));
                }
                let here = M::Single::point(&motion.state.lane(lane));
                if occupant.cycles_left > 0 {
                    occupant.kept.begin_cycle(&metrics[number], here);
                } else if let Some(Occupant { kept, progress, batches, .. }) = place.take() {
                    let (motion, observed) = (motion.lane(lane), observed.lane(lane));
                    found[number] =
                        Some(Measured { motion, progress, observed, batches, kept, failure: None });
                }
            }
        }
    }
}
