//! Cycles of many motions that are measured side by side.

use std::collections::VecDeque;

use crate::flow::defect::DefectInLanes;
use crate::flow::{Metric, Motion, Observer, Step, Stroboscopic, Switched, System};
use crate::lane::{Instructions, Lane, SideBySide, Work};

use super::lanes::{EndedCycle, Lanes, Task};
use super::measuring::{Kept, MeasureRequest, Measured, batch_ends, measured_alone};
use super::occupancy::Kernel;
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
    instructions.run_on_a_vector(Requests { requests })
}

struct Requests<M: System<D>, const D: usize> {
    requests: Vec<MeasureRequest<M, D>>,
}

impl<M: System<D>, const D: usize> Work for Requests<M, D> {
    const IS_INTERPRETED: bool = M::IS_INTERPRETED;
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
    let system = M::In::<L>::splat(&first.system.single());
    let motion = Motion::<L, M::In<L>>::splat(&first.motion);
    let mut waiting: Vec<usize> = (0..requests.len()).collect();
    waiting.sort_by_key(|&number| requests[number].cycles);
    let mut lanes = Lanes::new(system, motion, tolerance);
    let mut task = Measuring::<L, M, D> {
        observed: M::Observers::<L>::splat(&first.system.observer(points)),
        waiting,
        found: requests.iter().map(|_| None).collect(),
        requests: requests.into_iter().map(Some).collect(),
        step: Step::default(),
    };
    lanes.follow(&mut task);
    task.found.into_iter().map(|it| it.expect("each has been measured")).collect()
}

/// Measures cycles.
struct Measuring<L: Lane, M: System<D>, const D: usize> {
    /// What is not in a lane has been measured, or waits.
    requests: Vec<Option<MeasureRequest<M, D>>>,
    /// The numbers of those that wait, the longest last.
    waiting: Vec<usize>,
    observed: M::Observers<L>,
    found: Vec<Option<Measured<M, D>>>,
    /// Room for the step of one lane.
    step: Step<f64, M::Single>,
}

/// A motion in a lane.
struct MotionInLane<M: System<D>, const D: usize> {
    /// Its place among those that are to be measured.
    number: usize,
    request: MeasureRequest<M, D>,
    system: M::Single,
    metric: Metric<D>,
    kept: Kept<D>,
    progress: Progress,
    cycles: u64,
    batches: Vec<M::Observer>,
    /// The cycles at which batches end that it has not come to.
    ends: VecDeque<u64>,
}

impl<M: System<D>, const D: usize> MotionInLane<M, D> {
    fn new(number: usize, request: MeasureRequest<M, D>) -> Self {
        let metric = request.system.metric();
        let mut kept = Kept::new(request.points);
        kept.begin_cycle(&metric, M::Single::point(&request.motion.state));
        MotionInLane {
            number,
            system: request.system.single(),
            metric,
            kept,
            progress: request.progress,
            cycles: 0,
            batches: Vec::new(),
            ends: batch_ends(request.cycles, request.batches).collect(),
            request,
        }
    }

    /// Steps that the cycle may still take that begins.
    fn steps_left(&self) -> u64 {
        self.progress.deadline(self.request.max_steps) - self.progress.steps
    }
}

impl<L: Lane, M: System<D>, const D: usize> Task<L, M, D> for Measuring<L, M, D> {
    type Kept = MotionInLane<M, D>;
    const KERNEL: Kernel = Kernel::Measuring;

    #[inline(always)]
    fn fill(&mut self, lanes: &mut Lanes<L, M, Self::Kept, D>) -> bool {
        while let Some(lane) = lanes.free().next()
            && let Some(number) = self.waiting.pop()
            && let Some(request) = self.requests[number].take()
        {
            let MeasureRequest { system, motion, observed_points, .. } = &request;
            self.observed.put(lane, &system.observer(*observed_points));
            let (system, motion) = (system.single(), *motion);
            let own = MotionInLane::new(number, request);
            let steps_left = own.steps_left();
            lanes.put(lane, &system, &motion, own);
            lanes.allow(lane, steps_left);
        }
        lanes.count() > 0
    }

    #[inline(always)]
    fn see(&mut self, lanes: &mut Lanes<L, M, Self::Kept, D>) {
        let Lanes { system, step, kept, .. } = lanes;
        self.observed.see(system, step);
        let defect = DefectInLanes::of(system, step);
        let begins = M::In::<L>::point(&system.beginning(&step.jet));
        for (lane, own) in kept.iter_mut().enumerate() {
            let Some(MotionInLane { system, metric, kept, .. }) = own else { continue };
            let defect = defect.one(lane, step, system, &mut self.step);
            kept.see(metric, &begins.lane(lane), defect);
        }
    }

    #[inline(always)]
    fn end_cycle(
        &mut self,
        lanes: &mut Lanes<L, M, Self::Kept, D>,
        lane: usize,
        cycle: EndedCycle,
    ) {
        let Some(own) = &mut lanes.kept[lane] else { return };
        own.progress.steps += cycle.steps;
        own.progress.count(cycle.duration);
        own.cycles += 1;
        if own.ends.front() == Some(&own.cycles) {
            own.ends.pop_front();
            own.batches.push(self.observed.lane(lane));
        }
        if own.cycles < own.request.cycles {
            let here = M::Single::point(&lanes.motion.state.lane(lane));
            own.kept.begin_cycle(&own.metric, here);
            let steps_left = own.steps_left();
            lanes.allow(lane, steps_left);
            return;
        }
        let MotionInLane { number, progress, batches, kept, .. } = lanes.take(lane);
        let (motion, observed) = (lanes.motion.lane(lane), self.observed.lane(lane));
        self.found[number] =
            Some(Measured { motion, progress, observed, batches, kept, failure: None });
    }

    #[inline(always)]
    fn give_up(&mut self, lanes: &mut Lanes<L, M, Self::Kept, D>, lane: usize) {
        let MotionInLane { number, request, .. } = lanes.take(lane);
        self.found[number] = Some(measured_alone(request));
    }
}
