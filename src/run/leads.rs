//! Which of some known attractors a motion leads to that begins at a point of the section.

use std::sync::Arc;

use crate::attractor::{Attractor, FinalMotion};
use crate::capsule::{CapsuleSystem, Reading};
use crate::flow::{Stroboscopic, System};
use crate::orbit::{self, KnownOrbits, Machine, Outcome, Protocol, settle_all, settle_all_near};

/// A system with the attractors that are known of it.
pub(super) struct Leads<'a, R: Reading> {
    pub(super) system: CapsuleSystem<R>,
    protocol: Protocol,
    machine: Machine,
    /// The attractors by their numbers.
    known: Vec<(u32, &'a Attractor<3>)>,
    /// Neighbourhoods of the periodic ones.
    near: Arc<KnownOrbits<CapsuleSystem<R>, 3>>,
}

type Single<R> = <CapsuleSystem<R> as System<3>>::Single;

impl<'a, R: Reading> Leads<'a, R> {
    /// Those of a system whose cases are followed as a study says.
    pub(super) fn new(
        system: CapsuleSystem<R>,
        (protocol, machine): (&Protocol, Machine),
        known: Vec<(u32, &'a Attractor<3>)>,
    ) -> Self {
        // Nothing but where a start leads is asked for.
        let protocol = Protocol { points: 0, impact_points: 0, history: None, ..*protocol };
        let case = |(_, attractor): &(u32, &Attractor<3>)| {
            let point = attractor.points.first().filter(|_| attractor.outcome == Outcome::Periodic);
            Some(orbit::Case::new(system.clone(), Single::<R>::state(*point?)))
        };
        let cases: Vec<_> = known.iter().filter_map(case).collect();
        let orbits = settle_all(&cases, &protocol, machine);
        let instructions = machine.instructions_for(cases.len());
        let near = KnownOrbits::among(&system, orbits, instructions, protocol.tolerance);
        Leads { system, protocol, machine, known, near: Arc::new(near) }
    }

    pub(super) fn protocol(&self) -> &Protocol {
        &self.protocol
    }

    /// The attractors that some section points lead to, none where it is no known one; of those that do not repeat one is told
    /// only where it is the only one of its kind.
    pub(super) fn of(&self, points: &[[f64; 3]]) -> Vec<Option<u32>> {
        let case =
            |point: &[f64; 3]| orbit::Case::new(self.system.clone(), Single::<R>::state(*point));
        let cases: Vec<_> = points.iter().map(case).collect();
        let settled = settle_all_near(&cases, &self.near, &self.protocol, self.machine);
        let motion = |orbit: &orbit::OrbitOf<CapsuleSystem<R>, 3>| {
            FinalMotion::of(orbit, Single::<R>::point(&orbit.end))
        };
        settled.iter().map(|orbit| self.number(&motion(orbit))).collect()
    }

    /// The attractor of a motion, as [`Leads::of`] tells it.
    pub(super) fn number(&self, motion: &FinalMotion<3>) -> Option<u32> {
        let found = Attractor::of(0, &self.system, motion, &self.protocol)?;
        let metric = self.system.metric();
        let is = |known: &Attractor<3>| match found.outcome {
            Outcome::Periodic => known.is(&found, &metric),
            kind => known.outcome == kind,
        };
        let mut all = self.known.iter().filter(|(_, known)| is(known));
        let (number, _) = all.next()?;
        all.next().is_none().then_some(*number)
    }
}
