//! A family of motions: where each returns to, and what it passes, as functions of its point and parameters.

use std::f64::consts::PI;

use crate::capsule::{Capsule, EventKind, Parameter, Parameters};
use crate::flow::guard::crossings;
use crate::lane::{Lane, Series, series};
use crate::orbit::Reason;
use crate::orbit::return_map::returned_in;

/// Motions of a capsule, some of whose parameters are free.
#[derive(Debug, Clone)]
pub struct Family {
    /// The parameters that are not free.
    pub parameters: Parameters,
    /// Phase of the drive at the section [rad].
    pub phase: f64,
    /// Cycles to the return.
    pub period: u64,
    /// Relative local error of a step.
    pub tolerance: f64,
}

/// What a motion passes until its return.
#[derive(Debug, Clone)]
pub struct Passage<L> {
    /// Where it returns to: r, y1, y2.
    pub end: [L; 3],
    /// Its events in order.
    pub events: Vec<EventKind>,
    /// The local extrema of r in order.
    pub extrema: Vec<Extremum<L>>,
}

/// A local maximum or minimum of r: at the stop it is a grazing, from the open or the closed side.
#[derive(Debug, Clone, Copy)]
pub struct Extremum<L> {
    /// How far it is from the stop, above zero before it [m].
    pub margin: L,
    /// When it is met after the section [cycles].
    pub time: f64,
}

/// The extremum that is nearest to the stop.
pub fn nearest<L: Lane>(extrema: &[Extremum<L>]) -> Option<&Extremum<L>> {
    let away = |extremum: &Extremum<L>| extremum.margin.lane(0).abs();
    extrema.iter().min_by(|a, b| away(a).total_cmp(&away(b)))
}

impl Family {
    /// The motion from a section point with these values of the `free` parameters.
    ///
    /// A margin carries derivatives too: at an extremum those at fixed time are those of the extremum.
    pub fn passage<L: Lane>(
        &self,
        point: [L; 3],
        free: &[(Parameter, L)],
    ) -> Result<Passage<L>, Reason> {
        let of = |parameter| {
            let given = free.iter().find(|(name, _)| *name == parameter);
            given.map_or(L::splat(self.parameters[parameter]), |(_, value)| *value)
        };
        let system = Capsule::new(of, self.parameters.resistance, self.phase);
        let drive_period = L::splat(2.0 * PI) / of(Parameter::Omega);
        let (mut events, mut extrema, mut elapsed) = (Vec::new(), Vec::new(), 0.0);
        let delta = of(Parameter::Delta);
        let cycles = (drive_period, self.period);
        let end = returned_in(&system, point, cycles, self.tolerance, |step| {
            events.extend(EventKind::from_code(step.event.lane(0)));
            let length = step.length.lane(0);
            turns(&step.jet.r, length, |time, r| {
                let time = (elapsed + time) / drive_period.lane(0);
                extrema.push(Extremum { margin: delta - r, time });
            });
            elapsed += length;
        })?;
        Ok(Passage { end, events, extrema })
    }
}

/// Shows the local extrema of `r` during a step, each with its time.
fn turns<L: Lane>(r: &Series<L>, length: f64, mut found: impl FnMut(f64, L)) {
    let rate = series::derivative(&std::array::from_fn(|k| r[k].lane(0)));
    crossings(&rate, length, |time, _| found(time, series::value(r, L::splat(time))));
}

/// How far two times of a motion of this period are apart, the other way round too.
pub fn apart(a: f64, b: f64, period: u64) -> f64 {
    let apart = (a - b).rem_euclid(period as f64);
    apart.min(period as f64 - apart)
}

/// The sequence of events, begun where it is least: the same wherever on the orbit the section lies.
pub fn cyclic(events: &[EventKind]) -> Vec<EventKind> {
    let turned = |by: usize| [&events[by..], &events[..by]].concat();
    (0..events.len()).map(turned).min().unwrap_or_default()
}
