//! Which of some known attractors motions lead to that begin at points of the section.

use std::sync::Arc;

use capsulemap_engine::attractor::{Attractor, EdgeSearch, FinalMotion, Met};
use capsulemap_engine::flow::{Stroboscopic, System};
use capsulemap_engine::orbit::passage::OneByOne;
use capsulemap_engine::orbit::{
    self, KnownOrbits, Machine, OrbitOf, Outcome, Protocol, settle_all, settle_all_near,
};

use crate::capsule::{CapsuleSystem, Reading, Section};
use crate::model::Leads;

/// A system with the attractors that are known of it.
pub(super) struct LeadsOf<'a, R: Reading> {
    system: CapsuleSystem<R>,
    protocol: Protocol,
    machine: Machine,
    /// The attractors by their numbers.
    known: Vec<(u32, &'a Attractor<3>)>,
    /// Neighbourhoods of the periodic ones.
    near: Arc<KnownOrbits<CapsuleSystem<R>, 3>>,
}

type Single<R> = <CapsuleSystem<R> as System<3>>::Single;

impl<'a, R: Reading> LeadsOf<'a, R> {
    /// Those of a system whose cases are followed by this protocol.
    pub(super) fn new(
        system: CapsuleSystem<R>,
        protocol: &Protocol,
        machine: Machine,
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
        LeadsOf { system, protocol, machine, known, near: Arc::new(near) }
    }
}

impl<R: Reading> Leads for LeadsOf<'_, R> {
    fn of(&self, points: &[Section]) -> Vec<Option<u32>> {
        let case =
            |point: &Section| orbit::Case::new(self.system.clone(), Single::<R>::state(*point));
        let cases: Vec<_> = points.iter().map(case).collect();
        let settled = settle_all_near(&cases, &self.near, &self.protocol, self.machine);
        let motion = |orbit: &OrbitOf<CapsuleSystem<R>, 3>| {
            FinalMotion::of(orbit, Single::<R>::point(&orbit.end))
        };
        settled.iter().map(|orbit| self.number(&motion(orbit))).collect()
    }

    fn number(&self, motion: &FinalMotion<3>) -> Option<u32> {
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

    fn saddle(&self, points: [Section; 2]) -> Option<Met<3>> {
        let search = EdgeSearch {
            system: &self.system,
            protocol: &self.protocol,
            integrator: &OneByOne,
            leads: &|points| self.of(points),
        };
        search.saddle(points)
    }
}
