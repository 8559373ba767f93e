//! What a case settles to: its outcome, its period and everything measured on the attractor.

use crate::flow::System;

use super::measure::{Found, conclude};
use super::passage::OneByOne;
use super::settling::{Settling, Verdict};
use super::{Case, Failure, OrbitOf, Protocol, Trajectory};

/// Follows a case to the first section, from there until it settles, and measures it.
///
/// Cycles are counted from the first section: the part of a cycle before it belongs to none. The time of a
/// failure is counted from the start.
pub fn settle<M: System<D>, const D: usize>(
    case: &Case<M, D>,
    protocol: &Protocol,
) -> OrbitOf<M, D> {
    let system = case.system.single();
    let mut trajectory = Trajectory::begun(&system, case.start, case.begins, protocol.tolerance)
        .limited(protocol.max_steps);
    let mut settling = Settling::new(protocol, case.system.metric());
    if trajectory.is_at_section() {
        settling.meet(trajectory.section());
    }
    let settled = find_period::<M, D>(&mut trajectory, &mut settling, protocol);
    let found = settled.map(|end| match end {
        End::Found(found) => found,
        End::Inside(_) => unreachable!("no orbit is known"),
    });
    conclude(&mut trajectory, case, found, protocol, &OneByOne)
}

/// How a case has come to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End<const D: usize> {
    /// It is found to do this.
    Found(Found<D>),
    /// It is in the neighbourhood of the known orbit of this number.
    Inside(usize),
}

impl<const D: usize> From<Found<D>> for End<D> {
    fn from(found: Found<D>) -> Self {
        End::Found(found)
    }
}

/// Follows until the section repeats, a known orbit is near, or the budget of cycles ends.
pub(super) fn find_period<M: System<D>, const D: usize>(
    trajectory: &mut Trajectory<'_, M::Single, D>,
    settling: &mut Settling<D>,
    protocol: &Protocol,
) -> Result<End<D>, Failure<M::State<f64>>> {
    while trajectory.progress.cycles < protocol.max_cycles {
        trajectory.cycle(|_| ())?;
        match settling.meet(trajectory.section()) {
            Verdict::Settled(settled) => return Ok(Found::Repeats(settled).into()),
            Verdict::Inside(number) => return Ok(End::Inside(number)),
            // At the end of the budget the motion is measured where it is.
            Verdict::Leap(section) if trajectory.progress.cycles < protocol.max_cycles => {
                trajectory.leap(section);
            }
            Verdict::Leap(_) | Verdict::Unsettled => {}
        }
    }
    Ok(Found::Aperiodic.into())
}
