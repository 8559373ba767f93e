//! What a case settles to: its outcome, its period and everything measured on the attractor.

use crate::flow::System;

use super::underway::Underway;
use super::{Case, OrbitOf, Protocol};

/// Follows a case to the first section, from there until it settles, and measures it.
///
/// Cycles are counted from the first section: the part of a cycle before it belongs to none. The time of a
/// failure is counted from the start.
pub fn settle<M: System<D>, const D: usize>(
    case: &Case<M, D>,
    protocol: &Protocol,
) -> OrbitOf<M, D> {
    Underway::new(0, case.clone(), protocol, None).finish(protocol).1
}
