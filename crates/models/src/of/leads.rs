//! Which of some known attractors motions lead to that begin at points of the section.

use std::sync::Arc;

use capsulemap_engine::attractor::{self, EdgeSearch, FinalMotion, Met, minimal_critical_shock};
use capsulemap_engine::flow::Stroboscopic;
use capsulemap_engine::orbit::passage::OneByOne;
use capsulemap_engine::orbit::{
    self, KnownOrbits, Machine, OrbitOf, Outcome, Protocol, settle_all, settle_all_near,
};

use crate::description::Section;
use crate::face::Face;
use crate::model::Leads;

/// An attractor with the section points of the engine.
type Attractor<const D: usize> = attractor::Attractor<[f64; D]>;

/// A system with the attractors that are known of it.
pub(super) struct LeadsOf<M: Face<D>, const D: usize> {
    system: M,
    protocol: Protocol,
    machine: Machine,
    /// The attractors by their numbers.
    known: Vec<(u32, Attractor<D>)>,
    /// Neighbourhoods of the periodic ones.
    near: Arc<KnownOrbits<M, D>>,
}

impl<M: Face<D>, const D: usize> LeadsOf<M, D> {
    /// Those of a system whose cases are followed by this protocol.
    pub(super) fn new(
        system: M,
        protocol: &Protocol,
        machine: Machine,
        known: Vec<(u32, Attractor<D>)>,
    ) -> Self {
        // Nothing but where a start leads is asked for.
        let protocol = Protocol { points: 0, impact_points: 0, history: None, ..*protocol };
        let case = |(_, attractor): &(u32, Attractor<D>)| {
            let point = attractor.points.first().filter(|_| attractor.outcome == Outcome::Periodic);
            Some(orbit::Case::new(system.clone(), M::Single::state(*point?)))
        };
        let cases: Vec<_> = known.iter().filter_map(case).collect();
        let orbits = settle_all(&cases, &protocol, machine);
        let instructions = machine.instructions_for(cases.len());
        let near = KnownOrbits::among(&system, orbits, instructions, protocol.tolerance);
        LeadsOf { system, protocol, machine, known, near: Arc::new(near) }
    }

    /// The attractors that some section points lead to.
    fn lead_to(&self, points: &[[f64; D]]) -> Vec<Option<u32>> {
        let case =
            |point: &[f64; D]| orbit::Case::new(self.system.clone(), M::Single::state(*point));
        let cases: Vec<_> = points.iter().map(case).collect();
        let settled = settle_all_near(&cases, &self.near, &self.protocol, self.machine);
        let motion = |orbit: &OrbitOf<M, D>| FinalMotion::of(orbit, M::Single::point(&orbit.end));
        settled.iter().map(|orbit| self.number_of(&motion(orbit))).collect()
    }

    /// The attractor of a motion.
    fn number_of(&self, motion: &FinalMotion<[f64; D]>) -> Option<u32> {
        let found = Attractor::of(0, &self.system, motion, &self.protocol)?;
        let metric = self.system.metric();
        let is = |known: &Attractor<D>| match found.outcome {
            Outcome::Periodic => known.is(&found, &metric),
            kind => known.outcome == kind,
        };
        let mut all = self.known.iter().filter(|(_, known)| is(known));
        let (number, _) = all.next()?;
        all.next().is_none().then_some(*number)
    }
}

impl<M: Face<D>, const D: usize> Leads for LeadsOf<M, D> {
    fn of(&self, points: &[Section]) -> Vec<Option<u32>> {
        self.lead_to(&super::arrays(points))
    }

    fn number(&self, motion: &FinalMotion<Section>) -> Option<u32> {
        self.number_of(&motion.map(|it| it.array()))
    }

    fn saddle(&self, points: [Section; 2]) -> Option<Met<Section>> {
        let search = EdgeSearch {
            system: &self.system,
            protocol: &self.protocol,
            integrator: &OneByOne,
            leads: &|points| self.lead_to(points),
        };
        let met = search.saddle(points.map(|it| it.array()))?;
        Some(met.map(Into::into))
    }

    fn shock(&self, number: u32, points: &[Section], towards: &Section) -> Option<f64> {
        let elsewhere = |points: &[[f64; D]]| {
            let leads = self.lead_to(points).into_iter();
            leads.map(|it| it.is_some_and(|other| other != number)).collect()
        };
        let (points, metric) = (super::arrays(points), self.system.metric());
        let found = minimal_critical_shock(&points, towards.array(), &metric, &elsewhere)?;
        Some(found.size)
    }
}
