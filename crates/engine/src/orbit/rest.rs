//! What is left of a motion that has faded beside what it was: rest, or an orbit that is followed to from there.

use crate::flow::{Switched, System};

use super::Protocol;
use super::certificate::{Certified, certify};
use super::matrix::least_from_one;
use super::passage::Integrator;
use super::precision::{OBLIQUE, ROUNDING};
use super::recurrence::{Recurrence, Settled};
use super::return_map::{Cycles, returned};

/// The orbit that the motion from the origin of the section settles to within so many `cycles`, and how, where an orbit that
/// a motion has `settled` to cannot be told from the origin; else none.
///
/// A motion without a drive shrinks for ever. Where it is taken to repeat, its section point is the rounding of what it began
/// from, and differs from start to start: taken as it is, one equilibrium would be as many orbits as there are starts.
/// Method: the origin of the section is followed, where the system rests, or nearly does. An equilibrium repeats there
/// exactly after a cycle, and a small orbit settles relative to its own size. Guarantees: the same bits from all starts.
/// Assumes: an orbit that attracts, on the section of a drive.
pub(super) fn from_rest<M: System<D>, const D: usize>(
    system: &M,
    (orbit, settled): (&Certified<D>, &Settled),
    cycles: u64,
    protocol: &Protocol,
    integrator: &dyn Integrator<M, D>,
) -> Option<(Certified<D>, Settled)> {
    let attracts = orbit.multipliers[0].abs() < 1.0;
    let metric = system.metric();
    // Where a coordinate repeats, no point of the section is the origin of all motions.
    let has_origin = !M::Single::AUTONOMOUS && metric.repeats.iter().all(|it| !it);
    if !has_origin || orbit.neutral.is_some() || !attracts {
        return None;
    }
    let known_to = OBLIQUE * ROUNDING * settled.size / least_from_one(&orbit.multipliers);
    if metric.size(&orbit.section) > known_to {
        return None;
    }
    let (mut point, single) = ([0.0; D], system.single());
    let once = Cycles { count: 1, tolerance: protocol.tolerance };
    let mut recurrence = Recurrence::new(protocol.max_period, protocol.recurrence, metric);
    recurrence.meet(point);
    for followed in 1..=cycles {
        point = returned(&single, point, &once, |_| ()).ok()?;
        if let Some(settled) = recurrence.meet(point) {
            let found = certify(system, &point, &settled, protocol, integrator)?;
            let is_same = metric.distance(&found.section, &orbit.section) <= 2.0 * known_to;
            let isolated = is_same && found.neutral.is_none();
            let cycles = orbit.cycles + followed + found.cycles;
            return isolated.then_some((Certified { cycles, ..found }, settled));
        }
    }
    None
}
