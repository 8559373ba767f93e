//! The one loop that follows motions side by side: each lane takes the next motion when its own is done.

use crate::flow::{Breakdown, MAX_GUARDS, Motion, STEPS_PER_CYCLE, Step, Switched, System};
use crate::lane::{Lane, Mask, SideBySide};

use super::occupancy::{Kernel, LaneSteps};

/// A cycle that has ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct EndedCycle {
    /// Steps that it took.
    pub steps: u64,
    /// Its duration [s].
    pub duration: f64,
}

/// What is done with motions that are followed side by side, in numbers of the kind `N`.
pub(super) trait Task<N: Lane, M: System<D>, const D: usize> {
    /// What goes with a motion while it is in a lane.
    type Kept;

    /// What the motions are followed for.
    const KERNEL: Kernel;

    /// Puts motions that wait into free lanes, before each step; whether there is anything left to follow.
    fn fill(&mut self, lanes: &mut Lanes<N, M, Self::Kept, D>) -> bool;

    /// Takes note of the step that all motions have taken.
    #[inline(always)]
    fn see(&mut self, _lanes: &mut Lanes<N, M, Self::Kept, D>) {}

    /// Takes note of a cycle that has ended in a lane; the motion is taken away or goes on.
    fn end_cycle(&mut self, lanes: &mut Lanes<N, M, Self::Kept, D>, lane: usize, cycle: EndedCycle);

    /// Takes the motion away that cannot end its cycle, or not within the steps that it may take.
    fn give_up(&mut self, lanes: &mut Lanes<N, M, Self::Kept, D>, lane: usize);
}

/// Motions side by side, one in each lane that is taken; what is in a free lane moves to no purpose.
pub(super) struct Lanes<N: Lane, M: System<D>, A, const D: usize> {
    /// The systems.
    pub system: M::In<N>,
    /// Their motions.
    pub motion: Motion<N, M::In<N>>,
    /// The step that they have taken last.
    pub step: Step<N, M::In<N>>,
    /// What goes with each.
    pub kept: Vec<Option<A>>,
    /// Where a cycle ends [s].
    until: N,
    /// Relative local error of a step.
    tolerance: f64,
    /// The lanes with a motion, as bits.
    taken: u64,
    /// Steps taken, from a number on that no cycle takes.
    steps: u64,
    /// How many had been taken when the cycle of each lane began, and by which it must have ended.
    began: Vec<u64>,
    ends_by: Vec<u64>,
    /// No cycle must have ended before so many are taken.
    deadline: u64,
    /// Motions that take their first steps, which lanes they are for, and how many steps are left.
    entering: Motion<N, M::In<N>>,
    enter: u64,
    first_steps: usize,
    /// Steps of lanes that were taken.
    lane_steps: LaneSteps,
}

impl<N: Lane, M: System<D>, A, const D: usize> Lanes<N, M, A, D> {
    /// Free lanes of these systems, in which this moves to no purpose.
    #[inline(always)]
    pub fn new(system: M::In<N>, motion: Motion<N, M::In<N>>, tolerance: f64) -> Self {
        Lanes {
            until: system.period(),
            system,
            entering: motion,
            motion,
            step: Step::default(),
            kept: (0..N::WIDTH).map(|_| None).collect(),
            tolerance,
            taken: 0,
            steps: STEPS_PER_CYCLE,
            began: vec![0; N::WIDTH],
            ends_by: vec![0; N::WIDTH],
            deadline: u64::MAX,
            enter: 0,
            first_steps: 0,
            lane_steps: LaneSteps::default(),
        }
    }

    /// How many lanes have a motion.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.taken.count_ones() as usize
    }

    /// The lanes without a motion.
    #[inline(always)]
    pub fn free(&self) -> impl Iterator<Item = usize> + use<N, M, A, D> {
        let taken = self.taken;
        (0..N::WIDTH).filter(move |lane| taken >> lane & 1 == 0)
    }

    /// The lanes with a motion.
    #[inline(always)]
    pub fn taken(&self) -> impl Iterator<Item = usize> + use<N, M, A, D> {
        let taken = self.taken;
        (0..N::WIDTH).filter(move |lane| taken >> lane & 1 != 0)
    }

    /// Puts a motion into a lane that is free, with what goes with it.
    #[inline(always)]
    pub fn put(
        &mut self,
        lane: usize,
        system: &M::Single,
        motion: &<Motion<N, M::In<N>> as SideBySide>::One,
        kept: A,
    ) where
        Motion<N, M::In<N>>: SideBySide,
    {
        self.system.put(lane, system);
        self.motion.put(lane, motion);
        self.until = self.system.period();
        self.take_place(lane, kept);
    }

    /// Begins to let motions in ([`Lanes::let_in`]), whose systems are there already: `begun` by [`Motion::begun`], they take
    /// their first steps while the motions in other lanes wait.
    ///
    /// For numbers with derivatives: a copy of the step for one lane would take long to compile.
    #[inline(always)]
    pub fn enter(&mut self, begun: Motion<N, M::In<N>>) {
        const { assert!(N::PARTS > 1, "plain motions are put") };
        self.until = self.system.period();
        self.entering = begun;
        self.first_steps = MAX_GUARDS;
    }

    /// Lets the motion that enters into a free lane, with what goes with it.
    #[inline(always)]
    pub fn let_in(&mut self, lane: usize, kept: A) {
        self.enter |= 1 << lane;
        self.take_place(lane, kept);
    }

    #[inline(always)]
    fn take_place(&mut self, lane: usize, kept: A) {
        self.kept[lane] = Some(kept);
        self.taken |= 1 << lane;
        self.began[lane] = self.steps;
        self.allow(lane, STEPS_PER_CYCLE);
    }

    /// Lets the cycle in a lane take so many steps from now on; [`STEPS_PER_CYCLE`] where nothing is said.
    #[inline(always)]
    pub fn allow(&mut self, lane: usize, steps: u64) {
        self.ends_by[lane] = self.steps.saturating_add(steps);
        self.deadline = self.deadline.min(self.ends_by[lane]);
    }

    /// Takes note that the cycle in a lane began so many steps ago.
    #[inline(always)]
    pub fn has_taken(&mut self, lane: usize, steps: u64) {
        self.began[lane] = self.steps - steps;
    }

    /// Steps that the cycle in a lane has taken.
    #[inline(always)]
    pub fn steps(&self, lane: usize) -> u64 {
        self.steps - self.began[lane]
    }

    /// Where a cycle ends in a lane [s].
    #[inline(always)]
    pub fn period(&self, lane: usize) -> f64 {
        self.until.lane(lane)
    }

    /// Takes the motion in a lane away, with what goes with it, which is returned.
    #[inline(always)]
    pub fn take(&mut self, lane: usize) -> A {
        self.taken &= !(1 << lane);
        self.kept[lane].take().expect("the lane has a motion")
    }

    /// What keeps the motion in a lane from going on, if anything.
    #[inline(always)]
    pub fn breakdown(&self, lane: usize) -> Option<Breakdown> {
        self.motion.breakdown(&self.system, &self.step, lane)
    }

    /// Follows motions until the task has none left.
    #[inline(always)]
    pub fn follow<T: Task<N, M, D, Kept = A>>(&mut self, task: &mut T) {
        while self.is_entered() || task.fill(self) {
            if self.advance() {
                task.see(self);
                self.attend(task);
            }
        }
        T::KERNEL.count(self.lane_steps);
    }

    /// Whether motions take their first steps.
    #[inline(always)]
    fn is_entered(&self) -> bool {
        (const { N::PARTS > 1 }) && self.first_steps > 0
    }

    /// Moves every lane by a step; whether that is not a first step of those that enter.
    #[inline(always)]
    fn advance(&mut self) -> bool {
        let enters = self.is_entered();
        let zero = N::splat(0.0);
        let (moving, until, tolerance) = match enters {
            true => (&mut self.entering, zero, 1.0),
            false => (&mut self.motion, self.until, self.tolerance),
        };
        if const { N::WIDTH == 1 } {
            moving.single_step(&self.system, until, tolerance, &mut self.step);
        } else {
            moving.step(&self.system, until, tolerance, &mut self.step);
        }
        self.lane_steps.all += N::WIDTH as u64;
        if enters {
            self.lane_steps.with_motion += u64::from(self.enter.count_ones());
            self.end_first_step();
        } else {
            self.lane_steps.with_motion += u64::from(self.taken.count_ones());
            self.steps += 1;
        }
        !enters
    }

    /// Lets those in that have taken their first steps: once one has obeyed no guard, further ones change nothing.
    #[inline(always)]
    fn end_first_step(&mut self) {
        self.first_steps -= 1;
        let obeyed = self.step.switches.bits() & self.enter;
        if self.first_steps > 0 && obeyed != 0 {
            return;
        }
        self.first_steps = 0;
        self.entering.face_section(&self.system, &mut self.step);
        while let Some(lane) = take_lowest(&mut self.enter) {
            self.motion.take_lane(lane, &self.entering);
        }
    }

    /// Looks after the lanes whose motion cannot go on, whose cycle has ended, or takes too many steps.
    #[inline(always)]
    fn attend<T: Task<N, M, D, Kept = A>>(&mut self, task: &mut T) {
        let arrives = self.step.arrives;
        let mut broken = self.motion.broken(&self.system).bits() & self.taken;
        let mut ended = arrives.bits() & self.taken & !broken;
        while let Some(lane) = take_lowest(&mut broken) {
            task.give_up(self, lane);
        }
        if arrives.any() {
            let durations = self.motion.time;
            self.motion.begin_cycle(&self.system, arrives);
            while let Some(lane) = take_lowest(&mut ended) {
                let (steps, duration) = (self.steps(lane), durations.lane(lane));
                self.began[lane] = self.steps;
                self.allow(lane, STEPS_PER_CYCLE);
                task.end_cycle(self, lane, EndedCycle { steps, duration });
            }
        }
        if self.steps >= self.deadline {
            self.give_up_the_slow(task);
        }
    }

    /// Gives up the motions whose cycle has taken as many steps as it may.
    fn give_up_the_slow<T: Task<N, M, D, Kept = A>>(&mut self, task: &mut T) {
        for lane in self.taken() {
            if self.ends_by[lane] <= self.steps {
                task.give_up(self, lane);
            }
        }
        let ends = self.taken().map(|lane| self.ends_by[lane]).min();
        self.deadline = ends.unwrap_or(u64::MAX);
    }
}

/// The lowest bit that is set, which is cleared.
#[inline(always)]
fn take_lowest(bits: &mut u64) -> Option<usize> {
    if *bits == 0 {
        return None;
    }
    let lowest = bits.trailing_zeros() as usize;
    *bits &= *bits - 1;
    Some(lowest)
}
