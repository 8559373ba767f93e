//! A case between its departure and its settling.

use std::sync::Arc;

use crate::flow::{Motion, Stroboscopic, System};

use super::known_orbits::KnownOrbits;
use super::measure::conclude;
use super::passage::{Integrator, OneByOne};
use super::settle::{End, find_period};
use super::settling::Settling;
use super::trajectory::Progress;
use super::{Case, Failure, OrbitOf, Protocol, Trajectory};

/// How a case has come to its end, or why it could not be followed.
pub(super) type Finding<M, const D: usize> = Result<End<D>, Failure<<M as System<D>>::State<f64>>>;

/// A case between its departure and its settling, under the number that its owner knows it by.
pub struct Underway<M: System<D>, const D: usize> {
    pub(super) number: usize,
    pub(super) case: Case<M, D>,
    pub(super) system: M::Single,
    pub(super) motion: Motion<f64, M::Single>,
    pub(super) settling: Settling<D>,
    pub(super) progress: Progress,
    pub(super) known: Option<Arc<KnownOrbits<M, D>>>,
}

impl<M: System<D>, const D: usize> Underway<M, D> {
    /// A case about to depart, which need not be followed further than to the neighbourhood of an orbit that is
    /// `known` of its system.
    pub fn new(
        number: usize,
        case: Case<M, D>,
        protocol: &Protocol,
        known: Option<Arc<KnownOrbits<M, D>>>,
    ) -> Self {
        let mut settling = Settling::new(protocol, case.system.metric());
        if let Some(known) = &known {
            settling = settling.until(known.neighbourhoods().clone());
        }
        let system = case.system.single();
        let motion = Motion::new(&system, case.begins, case.start);
        if case.begins == 0.0 {
            settling.meet(M::Single::point(&motion.state));
        }
        let progress = Progress::begun(case.begins);
        Underway { number, case, system, motion, settling, progress, known }
    }

    /// The number that its owner knows it by.
    pub fn number(&self) -> usize {
        self.number
    }

    /// Follows the case by itself until it settles, and measures it.
    pub fn finish(self, protocol: &Protocol) -> (usize, OrbitOf<M, D>) {
        let found = |trajectory: &mut Trajectory<'_, _, D>, settling: &mut Settling<D>| {
            find_period::<M, D>(trajectory, settling, protocol)
        };
        self.conclude(protocol, found, &OneByOne)
    }

    /// Measures the case, going on from where it is with what it is found to have settled to.
    pub(super) fn conclude(
        mut self,
        protocol: &Protocol,
        found: impl FnOnce(&mut Trajectory<'_, M::Single, D>, &mut Settling<D>) -> Finding<M, D>,
        integrator: &dyn Integrator<M, D>,
    ) -> (usize, OrbitOf<M, D>) {
        let mut trajectory =
            Trajectory::resume(&self.system, self.motion, self.progress, protocol.tolerance)
                .limited(protocol.max_steps);
        let found = match (found(&mut trajectory, &mut self.settling), &self.known) {
            (Ok(End::Inside(number)), Some(known)) => {
                return (self.number, known.reached(number, trajectory.progress.cycles));
            }
            (Ok(End::Inside(_)), None) => unreachable!("no orbit is known"),
            (Ok(End::Found(found)), _) => Ok(found),
            (Err(failure), _) => Err(failure),
        };
        (self.number, conclude(&mut trajectory, &self.case, found, protocol, integrator))
    }
}
