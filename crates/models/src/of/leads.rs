//! Which of some known attractors motions lead to that begin at points of the section.

use std::sync::Arc;

use capsulemap_engine::attractor::{
    self, EdgeSearch, FinalMotion, ManifoldSearch, Manifolds, Met, Plane, Saddle, SectionMap,
    minimal_critical_shock,
};
use capsulemap_engine::flow::Stroboscopic;
use capsulemap_engine::orbit::passage::{OneByOne, image};
use capsulemap_engine::orbit::return_map::{Cycles, returned};
use capsulemap_engine::orbit::{
    self, KnownOrbits, Machine, Outcome, Protocol, settle_all, settle_all_near,
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
        let periodic = known.iter().filter(|(_, it)| it.outcome == Outcome::Periodic);
        let points = periodic.filter_map(|(_, it)| it.points.first());
        let cases: Vec<_> = points.map(|point| case_at(&system, point)).collect();
        let orbits = settle_all(&cases, &protocol, machine);
        let instructions = machine.instructions_for(cases.len());
        let near = KnownOrbits::among(&system, orbits, instructions, protocol.tolerance);
        LeadsOf { system, protocol, machine, known, near: Arc::new(near) }
    }

    /// The attractors that some section points lead to.
    fn lead_to(&self, points: &[[f64; D]]) -> Vec<Option<u32>> {
        let cases: Vec<_> = points.iter().map(|point| case_at(&self.system, point)).collect();
        let settled = settle_all_near(&cases, &self.near, &self.protocol, self.machine);
        let motions =
            settled.iter().map(|orbit| FinalMotion::of(orbit, M::Single::point(&orbit.end)));
        motions.map(|motion| self.number_of(&motion)).collect()
    }

    /// The saddle on a boundary between two section points.
    fn between(&self, points: [[f64; D]; 2]) -> Option<Met<[f64; D]>> {
        let search = EdgeSearch {
            system: &self.system,
            protocol: &self.protocol,
            integrator: &OneByOne,
            leads: &|points| self.lead_to(points),
        };
        search.saddle(points)
    }

    /// A saddle with section points as the description has them.
    fn told(&self, met: Met<[f64; D]>) -> Met<Section> {
        let model = self.system.description();
        let mut met = met.map(|point| model.section_point(&point));
        met.saddle.multipliers.truncate(model.section.len());
        met
    }

    /// The attractor of a motion.
    fn number_of(&self, motion: &FinalMotion<[f64; D]>) -> Option<u32> {
        let found = Attractor::of(0, &self.system, motion, &self.protocol)?;
        let metric = self.system.metric();
        let mut all = self.known.iter().filter(|(_, known)| match found.outcome {
            Outcome::Periodic => known.is(&found, &metric),
            kind => known.outcome == kind,
        });
        let (number, _) = all.next()?;
        all.next().is_none().then_some(*number)
    }
}

/// A case that begins at a point of the section.
fn case_at<M: Face<D>, const D: usize>(system: &M, point: &[f64; D]) -> orbit::Case<M, D> {
    orbit::Case::new(system.clone(), M::Single::state(*point))
}

impl<M: Face<D>, const D: usize> Leads for LeadsOf<M, D> {
    fn of(&self, points: &[Section]) -> Vec<Option<u32>> {
        self.lead_to(&super::arrays(points))
    }

    fn number(&self, motion: &FinalMotion<Section>) -> Option<u32> {
        self.number_of(&motion.map(|it| it.array()))
    }

    fn saddle(&self, points: [Section; 2]) -> Option<Met<Section>> {
        Some(self.told(self.between(points.map(|it| it.array()))?))
    }

    fn manifolds(
        &self,
        plane: &Plane<Section>,
        attractors: &[Option<u32>],
        known: &[Saddle<Section>],
    ) -> Manifolds<Section> {
        let Plane { origin, places, values } = plane.clone();
        let single = self.system.single();
        let cycle = Cycles { count: 1, tolerance: self.protocol.tolerance };
        let of_known = self.known.iter().map(|(number, it)| (*number as usize, &it.points));
        let count = of_known.clone().map(|(number, _)| number + 1).max().unwrap_or(0);
        let mut points = vec![Vec::new(); count];
        of_known.for_each(|(number, own)| points[number].clone_from(own));
        let search = ManifoldSearch {
            map: SectionMap {
                metric: self.system.metric(),
                image: &|point| image(&OneByOne, &self.system, point, &cycle).ok(),
                next: &|point| returned(&single, *point, &cycle, |_| ()).ok(),
                leads: &|points| self.lead_to(points),
            },
            saddle: &|points| self.between(points),
            plane: &Plane { origin: origin.array(), places, values },
            attractors,
            points: &points,
        };
        let known: Vec<_> = known.iter().map(|it| it.clone().map(|point| point.array())).collect();
        let model = self.system.description();
        let Manifolds { saddles, stable, unstable, coverage } = search.manifolds(&known);
        Manifolds {
            saddles: saddles.into_iter().map(|it| self.told(it)).collect(),
            stable,
            unstable: unstable
                .into_iter()
                .map(|it| it.map(|point| model.section_point(&point)))
                .collect(),
            coverage,
        }
    }

    fn shock(&self, number: u32, points: &[Section], towards: &Section) -> Option<f64> {
        let (points, metric) = (super::arrays(points), self.system.metric());
        let found = minimal_critical_shock(&points, towards.array(), &metric, &|points| {
            let leads = self.lead_to(points).into_iter();
            leads.map(|it| it.is_some_and(|other| other != number)).collect()
        })?;
        Some(found.size)
    }
}
