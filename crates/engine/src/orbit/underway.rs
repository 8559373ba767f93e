//! A case between its start and its settling.

use std::sync::Arc;

use crate::flow::{Motion, Stroboscopic, System};

use super::aperiodic::Departure;
use super::case_end::{End, find_period};
use super::known_orbits::KnownOrbits;
use super::measure::{ClosedOrbit, Found, Told, conclude, told};
use super::passage::{Integrator, OneByOne};
use super::settling::Settling;
use super::trajectory::Progress;
use super::{Case, Failure, OrbitOf, Protocol, Trajectory};

/// How a case has come to its end, or why it could not be followed.
pub(super) type Finding<M, const D: usize> = Result<End<D>, Failure<<M as System<D>>::State<f64>>>;

/// What comes of a case that was to be concluded.
pub(super) enum Conclusion<M: System<D>, const D: usize> {
    /// Its number, and what it has settled to.
    Done(usize, OrbitOf<M, D>),
    /// It goes on from where it is: it is not proven to lead to the orbit that was foretold.
    GoesOn(Box<Underway<M, D>>),
}

/// A case between its start and its settling, under the number that its owner knows it by.
pub struct Underway<M: System<D>, const D: usize> {
    pub(super) number: usize,
    pub(super) case: Case<M, D>,
    pub(super) system: M::Single,
    pub(super) motion: Motion<f64, M::Single>,
    pub(super) settling: Settling<D>,
    pub(super) progress: Progress,
    /// The orbit that was foretold, once it is closed.
    pub(super) foretold: Option<ClosedOrbit<D>>,
    pub(super) known: Option<Arc<KnownOrbits<M, D>>>,
}

impl<M: System<D>, const D: usize> Underway<M, D> {
    /// A case about to start, which need not be followed further than to the neighbourhood of an orbit that is
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
        let foretold = None;
        Underway { number, case, system, motion, settling, progress, foretold, known }
    }

    /// The number that its owner knows it by.
    pub fn number(&self) -> usize {
        self.number
    }

    /// Where its linearised flow is followed from, of a case that may take so many steps in all.
    pub(super) fn departure(&self, max_steps: u64) -> Departure<'_, M, D> {
        Departure {
            system: &self.case.system,
            point: M::Single::point(&self.motion.state),
            max_steps: self.progress.steps_left(max_steps),
        }
    }

    /// Follows the case by itself until it settles, and measures it.
    pub fn finish(mut self, protocol: &Protocol) -> (usize, OrbitOf<M, D>) {
        loop {
            let found = |trajectory: &mut Trajectory<'_, _, D>, settling: &mut Settling<D>| {
                find_period::<M, D>(trajectory, settling, protocol)
            };
            match self.conclude(protocol, found, &OneByOne) {
                Conclusion::Done(number, orbit) => return (number, orbit),
                Conclusion::GoesOn(case) => self = *case,
            }
        }
    }

    /// Measures the case, going on from where it is with what it is found to have settled to, unless it has not.
    pub(super) fn conclude(
        mut self,
        protocol: &Protocol,
        found: impl FnOnce(&mut Trajectory<'_, M::Single, D>, &mut Settling<D>) -> Finding<M, D>,
        integrator: &dyn Integrator<M, D>,
    ) -> Conclusion<M, D> {
        let mut trajectory =
            Trajectory::resume(&self.system, self.motion, self.progress, protocol.tolerance)
                .limited(protocol.max_steps);
        let found = match found(&mut trajectory, &mut self.settling) {
            Ok(End::Found(found)) => Ok(found),
            Ok(End::Home) => {
                let foretold = self.foretold.expect("an orbit was foretold");
                Ok(foretold.reached(&mut trajectory))
            }
            Ok(End::Inside(number)) => {
                let known = self.known.as_ref().expect("orbits are known");
                let orbit = known.reached(number, trajectory.progress.cycles);
                return Conclusion::Done(self.number, orbit);
            }
            Ok(End::Foretold(foretold)) => {
                let here = (trajectory.motion(), trajectory.progress);
                match told(&mut trajectory, &self.case, &foretold, protocol, integrator) {
                    Told::Leads(orbit) => Ok(Found::Orbit(orbit)),
                    Told::Unproven(home) => {
                        let (orbit, home) = home.unzip();
                        self.settling.go_on(home);
                        (self.foretold, self.motion, self.progress) = (orbit, here.0, here.1);
                        return Conclusion::GoesOn(Box::new(self));
                    }
                }
            }
            Err(failure) => Err(failure),
        };
        let orbit = conclude(&mut trajectory, &self.case, found, protocol, integrator);
        Conclusion::Done(self.number, orbit)
    }
}
