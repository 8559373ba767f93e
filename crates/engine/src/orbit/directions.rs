//! Directions that go with a motion: how much each step stretches them, and orthonormal ones in their place.

use crate::flow::{Motion, Reason, STEPS_PER_CYCLE, Step, Stroboscopic, cycle_changed_by};
use crate::lane::{Dual, Lane};

use super::return_map::{Cycles, DualPoint};

/// A step cannot shrink a direction of length one to this: its series would not describe the motion so far. Where it is no longer, and
/// no more than this beside what others have made of it, rounding is left of it, and the direction is lost, as where a motion comes to
/// rest on a surface.
const LOST: f64 = 1e-12;

/// What a cycle makes of directions that are orthonormal when it begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleStretch<const D: usize> {
    /// Logarithm of how much each was stretched, at right angles to those before it; minus infinity where it is lost.
    pub logs: [f64; D],
    /// How long the cycle lasted [s].
    pub duration: f64,
}

/// Where the directions of a motion can be made orthonormal after a step.
///
/// At an event the state is that of a moment which is not the same for the neighbours. Between the sections of an autonomous
/// system a neighbour is apart in more than the coordinates of these.
#[inline(always)]
pub(super) fn can_be_compared<L: Lane, S: Stroboscopic<L, D>, const D: usize>(
    step: &Step<L, S>,
) -> L::Mask {
    if S::AUTONOMOUS { step.arrives } else { step.arrives | !step.switches }
}

/// Makes the first `D` directions of a motion orthonormal in these units of its coordinates where `due`; returns the length that
/// each had at right angles to those before it, zero where it is lost.
///
/// Method: the directions are those between the motion and its neighbours at one time, which is why the time by which a neighbour
/// came later to an event is taken back first; then Gram's and Schmidt's. As it is done step by step, and no step shrinks a direction
/// by more than a few powers of ten beside another, a direction that is lost is told from one that shrinks.
#[inline(always)]
pub(super) fn orthonormalise<L, S, const D: usize, const U: usize>(
    system: &S,
    step: &Step<Dual<L, U>, S>,
    motion: &mut Motion<Dual<L, U>, S>,
    units: &[L; D],
    due: L::Mask,
) -> [L; D]
where
    L: Lane,
    S: Stroboscopic<Dual<L, U>, D>,
{
    let zero = L::splat(0.0);
    let mut point = S::point(&motion.state);
    let mut columns = [[zero; D]; D];
    for (j, column) in columns.iter_mut().enumerate() {
        for (i, part) in column.iter_mut().enumerate() {
            *part = point[i].gradient[j] / units[i];
        }
    }
    if !S::AUTONOMOUS {
        let (_, slopes) = system.motion(&step.jet, step.length);
        let slopes = S::point(&slopes);
        for (j, column) in columns.iter_mut().enumerate() {
            let late = motion.time.gradient[j];
            for (i, part) in column.iter_mut().enumerate() {
                *part = *part - slopes[i].value * late / units[i];
            }
            motion.time.gradient[j] = L::select(due, zero, late);
        }
    }
    let lengths = gram_schmidt(&mut columns);
    for (j, column) in columns.iter().enumerate() {
        for (i, part) in column.iter().enumerate() {
            point[i].gradient[j] = L::select(due, *part * units[i], point[i].gradient[j]);
        }
    }
    motion.state = S::moved_to(motion.state, point);
    lengths
}

/// Makes columns orthonormal; returns the length of each at right angles to those before it.
#[inline(always)]
fn gram_schmidt<L: Lane, const D: usize>(columns: &mut [[L; D]; D]) -> [L; D] {
    let zero = L::splat(0.0);
    let mut lengths = [zero; D];
    for (j, length) in lengths.iter_mut().enumerate() {
        let (before, from) = columns.split_at_mut(j);
        let own = &mut from[0];
        let least = L::splat(LOST) * product(own, own).sqrt().max(L::splat(1.0));
        for other in before {
            let along = product(other, own);
            for (own, other) in own.iter_mut().zip(other) {
                *own = *own - along * *other;
            }
        }
        let whole = product(own, own).sqrt();
        let lost = whole.le(least);
        *length = L::select(lost, zero, whole);
        let inverse = L::select(lost, zero, L::splat(1.0) / whole);
        own.iter_mut().for_each(|part| *part = *part * inverse);
    }
    lengths
}

#[inline(always)]
fn product<L: Lane, const D: usize>(one: &[L; D], other: &[L; D]) -> L {
    let mut sum = L::splat(0.0);
    for (one, other) in one.iter().zip(other) {
        sum = sum + *one * *other;
    }
    sum
}

/// Adds the logarithms of lengths in a lane.
#[inline(always)]
pub(super) fn add_logs<L: Lane, const D: usize>(
    logs: &mut [f64; D],
    lengths: &[L; D],
    lane: usize,
) {
    for (log, length) in logs.iter_mut().zip(lengths) {
        *log += libm::log(length.lane(lane));
    }
}

/// Where a motion in one lane returns to, with its directions there, and what each cycle made of them.
pub(super) fn stretched<S, const D: usize, const U: usize>(
    system: &S,
    from: DualPoint<D, U>,
    units: &[f64; D],
    cycles: &Cycles,
) -> Result<(DualPoint<D, U>, Vec<CycleStretch<D>>), Reason>
where
    S: Stroboscopic<Dual<f64, U>, D>,
{
    let mut motion = Motion::new(system, Dual::splat(0.0), S::state(from));
    let mut step = Step::default();
    let mut stretches = Vec::new();
    let budget = (STEPS_PER_CYCLE, cycles.tolerance);
    for _ in 0..cycles.count {
        let mut logs = [0.0; D];
        let duration = cycle_changed_by(system, &mut motion, &mut step, budget, |motion, step| {
            if can_be_compared::<_, S, D>(step) {
                let lengths = orthonormalise(system, step, motion, units, true);
                add_logs(&mut logs, &lengths, 0);
            }
        })?;
        stretches.push(CycleStretch { logs, duration: duration.value });
    }
    Ok((S::point(&motion.state), stretches))
}
