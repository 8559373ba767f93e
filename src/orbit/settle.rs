//! What a case settles to: its outcome, its period and everything measured on the attractor.

use crate::flow::System;

use super::measure::{Found, conclude};
use super::passage::OneByOne;
use super::recurrence::Settled;
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
    conclude(&mut trajectory, case, settled.map(Found::from), protocol, &OneByOne)
}

/// Follows until the section repeats; none when the budget of cycles ends first.
pub(super) fn find_period<M: System<D>, const D: usize>(
    trajectory: &mut Trajectory<'_, M::Single, D>,
    settling: &mut Settling<D>,
    protocol: &Protocol,
) -> Result<Option<Settled>, Failure<M::State<f64>>> {
    while trajectory.progress.cycles < protocol.max_cycles {
        trajectory.cycle(|_| ())?;
        match settling.meet(trajectory.section()) {
            Verdict::Settled(settled) => return Ok(Some(settled)),
            // At the end of the budget the motion is measured where it is.
            Verdict::Leap(section) if trajectory.progress.cycles < protocol.max_cycles => {
                trajectory.leap(section);
            }
            Verdict::Leap(_) | Verdict::Unsettled => {}
        }
    }
    Ok(None)
}
