//! A family of motions: where each returns to, and what it passes, as functions of its point and parameters.

use crate::flow::guard::crossings;
use crate::flow::{Event, Reason, Stroboscopic, Switched, System};
use crate::lane::{Lane, Series, series};
use crate::orbit::return_map::{Cycles, returned};

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

/// A local maximum or minimum of the coordinate that may touch a surface: on the surface it is a grazing.
#[derive(Debug, Clone, Copy)]
pub struct Extremum<L> {
    /// How far it is below the surface; negative above it.
    pub margin: L,
    /// When it is met after the section [cycles].
    pub time: f64,
}

/// The extremum that is nearest to the surface.
pub fn nearest<L: Lane>(extrema: &[Extremum<L>]) -> Option<&Extremum<L>> {
    let away = |extremum: &Extremum<L>| extremum.margin.lane(0).abs();
    extrema.iter().min_by(|a, b| away(a).total_cmp(&away(b)))
}

impl<M: System<D>, const D: usize> Family<M, D> {
    /// The motion from a section point with these values of the `free` parameters.
    ///
    /// A margin carries derivatives too: at an extremum those at fixed time are those of the extremum. Times
    /// count in cycles of the drive; of an autonomous system in the time that a cycle may take at most.
    pub fn passage<L: Lane>(
        &self,
        point: [L; D],
        free: &[(M::Parameter, L)],
    ) -> Result<Passage<L, M::Event, D>, Reason> {
        let system = self.system.system(|parameter| {
            let given = free.iter().find(|(name, _)| *name == parameter);
            given.map_or(L::splat(self.system.value(parameter)), |(_, value)| *value)
        });
        let period = system.period().lane(0);
        let (metric, begins) = (self.system.metric(), point.map(|coordinate| coordinate.lane(0)));
        let mut excursion: f64 = if M::In::<L>::AUTONOMOUS { 0.0 } else { f64::INFINITY };
        let (mut events, mut extrema, mut elapsed) = (Vec::new(), Vec::new(), 0.0);
        let mut turns = Turns::default();
        let cycles = Cycles { count: self.period, tolerance: self.tolerance };
        let end = returned(&system, point, &cycles, |step| {
            events.extend(M::Event::from_code(step.event.lane(0)));
            let length = step.length.lane(0);
            if M::In::<L>::AUTONOMOUS {
                let here = M::In::<L>::point(&system.at(&step.jet, L::splat(0.0)));
                let here = here.map(|coordinate| coordinate.lane(0));
                excursion = excursion.max(metric.distance(&here, &begins));
            }
            if let Some((coordinate, surface)) = system.touching(&step.jet) {
                let has_event = step.event.lane(0) > 0.0;
                turns.during(coordinate, (length, has_event), |time, value| {
                    let time = (elapsed + time) / period;
                    extrema.push(Extremum { margin: surface - value, time });
                });
            }
            elapsed += length;
        })?;
        Ok(Passage { end, events, extrema, excursion })
    }
}

/// The local extrema of a coordinate, step by step.
#[derive(Default)]
struct Turns {
    /// Whether the coordinate rose at the end of the last step; none where an event may have changed its rate.
    rose: Option<bool>,
}

impl Turns {
    /// Shows the extrema during a step, each with its time.
    ///
    /// A step may end just at an extremum, where rounding leaves the zero of the rate to neither step: then the rate
    /// has other signs in the two.
    fn during<L: Lane>(
        &mut self,
        coordinate: &Series<L>,
        (length, has_event): (f64, bool),
        mut found: impl FnMut(f64, L),
    ) {
        let rate = series::derivative(&std::array::from_fn(|k| coordinate[k].lane(0)));
        let mut times = Vec::new();
        crossings(&rate, length, |time, falls| times.push((time, falls)));
        let within = series::value(&rate, 0.5 * length) > 0.0;
        let begins_rising = times.first().map_or(within, |(_, falls)| *falls);
        if self.rose.is_some_and(|rose| rose != begins_rising) {
            found(0.0, coordinate[0]);
        }
        for (time, _) in &times {
            found(*time, series::value(coordinate, L::splat(*time)));
        }
        let ends_rising = times.last().map_or(within, |(_, falls)| !falls);
        self.rose = (!has_event).then_some(ends_rising);
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
