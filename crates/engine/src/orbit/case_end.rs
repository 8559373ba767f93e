//! How a case comes to its end: it settles, an orbit is near or foretold, or its budget of cycles is used up.

use super::measure::Found;
use super::settling::{Foretold, Settling, Verdict};
use super::{Failure, Protocol, Trajectory};
use crate::flow::System;

/// How a case has come to its end.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum End<const D: usize> {
    /// It is found to do this.
    Found(Found<D>),
    /// It is in the neighbourhood of the known orbit of this number.
    Inside(usize),
    /// It seems to tend to this orbit, which is to be proven.
    Foretold(Foretold<D>),
    /// It is in the neighbourhood of the orbit that was foretold.
    Home,
}

impl<const D: usize> End<D> {
    /// That which follows from a section point, if the case is at an end; nothing is foretold any more where its budget
    /// of cycles is `exhausted`.
    pub(super) fn of(verdict: Verdict<D>, exhausted: bool) -> Option<Self> {
        match verdict {
            Verdict::Unsettled => None,
            Verdict::Settled(settled) => Some(End::Found(Found::Repeats(settled))),
            Verdict::Inside(number) => Some(End::Inside(number)),
            Verdict::Foretold(foretold) => (!exhausted).then_some(End::Foretold(foretold)),
            Verdict::Home => Some(End::Home),
        }
    }
}

/// Follows until the section repeats, an orbit is near or foretold, or the budget of cycles ends.
pub(super) fn find_period<M: System<D>, const D: usize>(
    trajectory: &mut Trajectory<'_, M::Single, D>,
    settling: &mut Settling<D>,
    protocol: &Protocol,
) -> Result<End<D>, Failure<M::State<f64>>> {
    while trajectory.progress.cycles < protocol.max_cycles {
        trajectory.cycle(|_| ())?;
        let exhausted = trajectory.progress.cycles >= protocol.max_cycles;
        if let Some(end) = End::of(settling.meet(trajectory.section()), exhausted) {
            return Ok(end);
        }
    }
    Ok(End::Found(Found::Aperiodic))
}
