//! When a case has settled, and when its orbit can be told before it is reached.

use std::sync::Arc;

use crate::flow::Metric;

use super::Protocol;
use super::extrapolation::{WINDOW, limit};
use super::neighbourhood::Neighbourhood;
use super::recurrence::{Recurrence, Settled};

/// Section points this close, relative to the motion, may be near enough to their limit to tell it.
const NEAR: f64 = 1e-3;
/// How far the limit may be, relative to the motion.
const FAR: f64 = 1e-2;
/// At a distance of so many recurrence tolerances it is not worth telling: waiting is as short.
const CLOSE: f64 = 10.0;
/// The approach takes so many times longer than a proof that is worth it, as proofs may fail.
const WORTH: f64 = 2.0;
/// Orbits that are foretold in one case at most.
const FORETOLD: u32 = 4;

/// What follows from a section point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict<const D: usize> {
    /// The motion goes on.
    Unsettled,
    /// It seems to tend to an orbit.
    Foretold(Foretold<D>),
    /// It has settled.
    Settled(Settled),
    /// It has come into the neighbourhood of this number.
    Inside(usize),
    /// It has come into the neighbourhood of the orbit that was foretold.
    Home,
}

/// An orbit that the section seems to tend to; nothing is proven of that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foretold<const D: usize> {
    /// The limit of its section points that are a period apart.
    pub limit: [f64; D],
    /// After how many cycles the section nearly repeats, and how closely.
    pub nearly: Settled,
}

/// A case that has not settled yet.
#[derive(Debug, Clone)]
pub struct Settling<const D: usize> {
    recurrence: Recurrence<D>,
    metric: Metric<D>,
    tolerance: f64,
    foretold_left: u32,
    /// Points met.
    met: u64,
    /// No orbit is foretold before so many points are met.
    patience: u64,
    /// Where the case need not be followed any further.
    neighbourhoods: Option<Arc<Vec<Neighbourhood<D>>>>,
    /// The neighbourhood of an orbit that was foretold.
    home: Option<Neighbourhood<D>>,
}

impl<const D: usize> Settling<D> {
    /// Nothing met yet.
    pub fn new(protocol: &Protocol, metric: Metric<D>) -> Self {
        Settling {
            recurrence: Recurrence::new(protocol.max_period, protocol.recurrence, metric),
            metric,
            tolerance: protocol.recurrence,
            foretold_left: if protocol.accelerate { FORETOLD } else { 0 },
            met: 0,
            patience: 0,
            neighbourhoods: None,
            home: None,
        }
    }

    /// The same for a case that need not be followed further than into one of these neighbourhoods; they are wider than what
    /// is worth to be foretold.
    pub fn until(self, neighbourhoods: Arc<Vec<Neighbourhood<D>>>) -> Self {
        Settling { neighbourhoods: Some(neighbourhoods), foretold_left: 0, ..self }
    }

    /// Takes note that the motion is not proven to lead to the orbit that was foretold; it is where it comes into this
    /// neighbourhood of it, if there is one. Else the next may be foretold when twice as many points are met.
    pub fn go_on(&mut self, home: Option<Neighbourhood<D>>) {
        self.patience = if home.is_some() { u64::MAX } else { 2 * self.met };
        self.home = home;
    }

    /// Takes the next section point.
    ///
    /// What is foretold decides nothing: the motion goes on as it would, and is at an orbit where it has settled, or where
    /// a neighbourhood is proven to lead there.
    pub fn meet(&mut self, point: [f64; D]) -> Verdict<D> {
        self.met += 1;
        let mut near = self.neighbourhoods.iter().flat_map(|all| all.iter());
        if let Some(number) = near.position(|it| it.contains(&point)) {
            return Verdict::Inside(number);
        }
        if let Some(settled) = self.recurrence.meet(point) {
            return Verdict::Settled(settled);
        }
        if self.home.as_ref().is_some_and(|home| home.contains(&point)) {
            return Verdict::Home;
        }
        if self.foretold_left == 0 || self.met < self.patience {
            return Verdict::Unsettled;
        }
        match self.foretold() {
            Some(foretold) => {
                self.foretold_left -= 1;
                Verdict::Foretold(foretold)
            }
            None => Verdict::Unsettled,
        }
    }

    /// The orbit that the section seems to tend to, where that is worth a proof.
    ///
    /// The proof follows twice as many points as the lattice of a neighbourhood has, each for a period; at a steady rate
    /// the distance falls to the tolerance in so many periods, and that must be more by a factor.
    fn foretold(&self) -> Option<Foretold<D>> {
        let (k, distance) = self.recurrence.nearest()?;
        if distance > NEAR || distance <= CLOSE * self.tolerance {
            return None;
        }
        let points = self.recurrence.last::<WINDOW>(k)?;
        let moves = |i: &usize| points.iter().any(|point| point[*i] != 0.0);
        let proof = 2.0 * libm::pow(3.0, (0..D).filter(moves).count() as f64);
        let step = |i: usize| self.metric.distance(&points[i], &points[i + 1]);
        let rate = libm::log(step(0) / step(WINDOW - 2)) / (WINDOW - 2) as f64;
        if rate * WORTH * proof > libm::log(distance / self.tolerance) {
            return None;
        }
        let limit = limit(&points)?;
        let away = self.metric.distance(&limit, &points[WINDOW - 1]);
        let size = self.recurrence.scale();
        let nearly = Settled { repeats_after: k, within: distance, size };
        (away <= FAR * size).then_some(Foretold { limit, nearly })
    }
}
