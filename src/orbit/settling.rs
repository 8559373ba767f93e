//! When a case has settled, and how it gets there sooner.

use std::sync::Arc;

use crate::flow::Metric;

use super::Protocol;
use super::extrapolation::{WINDOW, limit};
use super::neighbourhood::Neighbourhood;
use super::recurrence::{Recurrence, Settled};

/// Section points this close, relative to the motion, may be near enough to their limit to leap there.
const NEAR: f64 = 1e-3;
/// The longest leap, relative to the motion.
const LEAP: f64 = 1e-2;
/// A distance so many recurrence tolerances wide is not worth a leap: waiting is as short.
const CLOSE: f64 = 10.0;
/// Leaps in one case at most.
const LEAPS: u32 = 20;

/// What follows from a section point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict<const D: usize> {
    /// The motion goes on.
    Unsettled,
    /// It goes on from another point of the section, which it would have approached.
    Leap([f64; D]),
    /// It has settled.
    Settled(Settled),
    /// It has come into the neighbourhood of this number.
    Inside(usize),
}

/// A case that has not settled yet.
#[derive(Debug, Clone)]
pub struct Settling<const D: usize> {
    recurrence: Recurrence<D>,
    metric: Metric<D>,
    tolerance: f64,
    leaps_left: u32,
    /// Where the case need not be followed any further.
    neighbourhoods: Option<Arc<Vec<Neighbourhood<D>>>>,
}

impl<const D: usize> Settling<D> {
    /// Nothing met yet.
    pub fn new(protocol: &Protocol, metric: Metric<D>) -> Self {
        Settling {
            recurrence: Recurrence::new(protocol.max_period, protocol.recurrence, metric),
            metric,
            tolerance: protocol.recurrence,
            leaps_left: if protocol.accelerate { LEAPS } else { 0 },
            neighbourhoods: None,
        }
    }

    /// The same for a case that need not be followed further than into one of these neighbourhoods.
    pub fn until(self, neighbourhoods: Arc<Vec<Neighbourhood<D>>>) -> Self {
        Settling { neighbourhoods: Some(neighbourhoods), ..self }
    }

    /// Takes the next section point.
    ///
    /// A leap does not decide anything: the motion goes on from where it leads, and whether it has settled is
    /// judged by the points after it alone.
    pub fn meet(&mut self, point: [f64; D]) -> Verdict<D> {
        let mut near = self.neighbourhoods.iter().flat_map(|all| all.iter());
        if let Some(number) = near.position(|it| it.contains(&point)) {
            return Verdict::Inside(number);
        }
        if let Some(settled) = self.recurrence.meet(point) {
            return Verdict::Settled(settled);
        }
        if self.leaps_left == 0 {
            return Verdict::Unsettled;
        }
        match self.leap() {
            Some(target) => {
                self.leaps_left -= 1;
                self.recurrence.restart(target);
                Verdict::Leap(target)
            }
            None => Verdict::Unsettled,
        }
    }

    fn leap(&self) -> Option<[f64; D]> {
        let (k, distance) = self.recurrence.nearest()?;
        if distance > NEAR || distance <= CLOSE * self.tolerance {
            return None;
        }
        let points = self.recurrence.last::<WINDOW>(k)?;
        let target = limit(&points)?;
        let newest = points[WINDOW - 1];
        (self.metric.distance(&target, &newest) <= LEAP * self.recurrence.scale()).then_some(target)
    }
}
