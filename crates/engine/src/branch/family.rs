//! A family of motions: where each returns to, and what it passes, as functions of its point and parameters.

use crate::flow::{Event, Reason, Switched, System};
use crate::lane::Lane;
use crate::orbit::return_map::{Cycles, returned};

use crate::orbit::extrema::{Extremum, SignChanges};
use crate::orbit::passage::Passing;

/// Motions of a system, some of whose parameters are free.
#[derive(Debug, Clone)]
pub struct Family<M, const D: usize> {
    /// The system with the parameters that are not free.
    pub system: M,
    /// Cycles to the return.
    pub period: u64,
    /// Relative local error of a step.
    pub tolerance: f64,
}

/// Where a motion returns to.
#[derive(Debug, Clone)]
pub struct Passage<L, const D: usize> {
    /// The point.
    pub end: [L; D],
    /// The local extrema until then of the coordinate that may touch a surface, in order.
    pub extrema: Vec<Extremum<L>>,
    /// How often the surface is met that an extremum may touch.
    pub impacts: usize,
}

impl<M: System<D>, const D: usize> Family<M, D> {
    /// The system with these values of the `free` parameters.
    pub fn with_free<L: Lane>(&self, free: &[(M::Parameter, L)]) -> M::In<L> {
        self.system.system(|parameter| {
            let given = free.iter().find(|(name, _)| *name == parameter);
            given.map_or(L::splat(self.system.value(parameter)), |(_, value)| *value)
        })
    }

    /// The motion from a section point with these values of the `free` parameters.
    ///
    /// A margin carries derivatives too: at an extremum those at fixed time are those of the extremum. Times
    /// count in cycles of the drive; of an autonomous system in the time that a cycle may take at most.
    pub fn passage<L: Lane>(
        &self,
        point: [L; D],
        free: &[(M::Parameter, L)],
    ) -> Result<Passage<L, D>, Reason> {
        let system = self.with_free(free);
        let period = system.period().lane(0);
        let mut passing = Passing::<L, M::Event>::new(period);
        let mut changes = SignChanges::none();
        let cycles = Cycles { count: self.period, tolerance: self.tolerance };
        let end = returned(&system, point, &cycles, |step| {
            passing.see_alone(&system, step, &mut changes);
        })?;
        let impacts = passing.events.iter().filter(|event| event.is_impact()).count();
        Ok(Passage { end, extrema: passing.extrema, impacts })
    }

    /// How long the longest cycle of an autonomous motion takes, as a share of the time for which a return is waited for; none
    /// where the motion does not return.
    pub fn longest_cycle(&self, point: [f64; D], free: &[(M::Parameter, f64)]) -> Option<f64> {
        let system = self.with_free(free);
        let (mut longest, mut elapsed) = (0.0_f64, 0.0);
        let cycles = Cycles { count: self.period, tolerance: self.tolerance };
        let end = returned(&system, point, &cycles, |step| {
            elapsed += step.length;
            if step.arrives {
                longest = longest.max(std::mem::take(&mut elapsed));
            }
        });
        end.ok().map(|_: [f64; D]| longest / system.period())
    }
}

/// How far two times of a motion of this period are apart, modulo the period.
pub fn apart(a: f64, b: f64, period: u64) -> f64 {
    let apart = (a - b).rem_euclid(period as f64);
    apart.min(period as f64 - apart)
}

/// What an extremum of an orbit, of some with their times and distances, is on another orbit: each of the two is the nearest in
/// time to the other. None where there is no such one, as where an extremum has appeared.
pub fn counterpart(
    extremum: &(f64, f64),
    [here, there]: [&[(f64, f64)]; 2],
    period: u64,
) -> Option<(f64, f64)> {
    let other = nearest_in_time(there, extremum.0, period)?;
    (nearest_in_time(here, other.0, period)? == *extremum).then_some(other)
}

/// The extremum that is nearest to a time.
fn nearest_in_time(among: &[(f64, f64)], time: f64, period: u64) -> Option<(f64, f64)> {
    among
        .iter()
        .copied()
        .min_by(|a, b| apart(a.0, time, period).total_cmp(&apart(b.0, time, period)))
}

/// The sequence of events, begun where it is least: the same wherever on the orbit the section lies.
pub fn cyclic<E: Event>(events: &[E]) -> Vec<E> {
    let turned = (0..events.len()).map(|by| [&events[by..], &events[..by]].concat());
    turned.min().unwrap_or_default()
}
