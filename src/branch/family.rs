//! A family of motions: where each returns to, and what it passes, as functions of its point and parameters.

use crate::flow::{Event, Reason, Stroboscopic, Switched, System};
use crate::lane::Lane;
use crate::orbit::return_map::{Cycles, returned};

use crate::orbit::extrema::Extremum;
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

/// What a motion passes until its return.
#[derive(Debug, Clone)]
pub struct Passage<L, E, const D: usize> {
    /// The point that it returns to.
    pub end: [L; D],
    /// Its events in order.
    pub events: Vec<E>,
    /// The local extrema of the coordinate that may touch a surface, in order.
    pub extrema: Vec<Extremum<L>>,
    /// How far an autonomous motion gets from where it begins, in the units of the metric; infinite for a driven
    /// one, which need not move to return.
    pub excursion: f64,
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
    ) -> Result<Passage<L, M::Event, D>, Reason> {
        let system = self.with_free(free);
        let period = system.period().lane(0);
        let (metric, begins) = (self.system.metric(), point.map(|coordinate| coordinate.lane(0)));
        let mut excursion: f64 = if M::In::<L>::AUTONOMOUS { 0.0 } else { f64::INFINITY };
        let mut passing = Passing::<L, M::Event>::new(period);
        let cycles = Cycles { count: self.period, tolerance: self.tolerance };
        let end = returned(&system, point, &cycles, |step| {
            if M::In::<L>::AUTONOMOUS {
                let here = M::In::<L>::point(&system.at(&step.jet, L::splat(0.0)));
                let here = here.map(|coordinate| coordinate.lane(0));
                excursion = excursion.max(metric.distance(&here, &begins));
            }
            let event = M::Event::from_code(step.event.lane(0));
            passing.see((step.length.lane(0), event), system.touching(&step.jet));
        })?;
        let Passing { events, extrema, .. } = passing;
        Ok(Passage { end, events, extrema, excursion })
    }
}

/// How far two times of a motion of this period are apart, modulo the period.
pub fn apart(a: f64, b: f64, period: u64) -> f64 {
    let apart = (a - b).rem_euclid(period as f64);
    apart.min(period as f64 - apart)
}

/// The sequence of events, begun where it is least: the same wherever on the orbit the section lies.
pub fn cyclic<E: Event>(events: &[E]) -> Vec<E> {
    let turned = |by: usize| [&events[by..], &events[..by]].concat();
    (0..events.len()).map(turned).min().unwrap_or_default()
}
