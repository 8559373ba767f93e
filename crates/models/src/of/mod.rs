//! The one implementation of the door, generic over systems with a face.

mod filled;
mod leads;
mod own;
mod registry;
mod stable;

use std::fmt::{self, Debug, Formatter};
use std::iter;
use std::marker::PhantomData;
use std::sync::Arc;

use capsulemap_engine::attractor::{
    self, Attractor, Bridge, Executor, FinalMotion, Links, Table, linear_orbits,
};
use capsulemap_engine::branch::{self, Linearised, NotFollowed, Segment};
use capsulemap_engine::flow::System;
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::passage::{Integrator, OneByOne};
use capsulemap_engine::orbit::return_map::{Cycles, append_points, observed};
use capsulemap_engine::orbit::{Batch, KnownOrbits, Machine, Protocol, Underway, settle_all};

use crate::capsule::description::{CAPSULE, CAPSULE_OVER_FOLDS};
use crate::capsule::{AsPrinted, CapsuleSystem, Filippov, General, OverFolds};
use crate::description::{Description, Outputs, Parameter, Parameters, Section};
use crate::face::{self, Face, engine_case, system};
use crate::model::{
    Along, Batches, CaseQueue, Cell, Known, Leads, LinearOrbits, Model, Motions, Neighbours,
    StableOrbit, Unfinished, Unlinked,
};
use crate::motion::branch::{Found, Request};
use crate::motion::{
    Case, Failure, Orbit, Sensitivity, Setting, Simulation, SimulationSize, Stretch,
};

pub use registry::{
    NotRegistered, all_models, default_model, make_known, model_called, model_of, register,
    settle_case,
};

/// A system with a face, as a model.
pub struct Of<M, const D: usize> {
    description: &'static Description,
    systems: PhantomData<fn() -> M>,
}

impl<M, const D: usize> Of<M, D> {
    /// The model of systems of this kind that are described so.
    pub const fn described(description: &'static Description) -> Self {
        Of { description, systems: PhantomData }
    }

    /// A section point as the description has it.
    fn point(&self, coordinates: [f64; D]) -> Section {
        self.description.section_point(&coordinates)
    }
}

impl<M, const D: usize> Debug for Of<M, D> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Of").field(&self.description.name).finish()
    }
}

static FILIPPOV: Of<CapsuleSystem<Filippov>, 3> = Of::described(&CAPSULE);
static AS_PRINTED: Of<CapsuleSystem<AsPrinted>, 3> = Of::described(&CAPSULE);
static GENERAL: Of<CapsuleSystem<General>, 3> = Of::described(&CAPSULE);
static OVER_FOLDS: Of<CapsuleSystem<OverFolds>, 4> = Of::described(&CAPSULE_OVER_FOLDS);

/// Section points as the engine has them.
fn arrays<const D: usize>(points: &[Section]) -> Vec<[f64; D]> {
    points.iter().map(Section::array).collect()
}

/// The attractors of a cell for the engine, which does not ask which case has which.
fn table_of<const D: usize>(table: &Table<Section>) -> Arc<Table<[f64; D]>> {
    let attractors = table.attractors.iter().map(|it| it.clone().map(|point| point.array()));
    Arc::new(Table {
        of_case: Vec::new(),
        attractors: attractors.collect(),
        order: table.order.clone(),
    })
}

/// What is held along a parameter, for the engine.
fn along<M: Face<D>, const D: usize>(it: &Along) -> branch::Along<M, D> {
    let (varied, tolerance) = (it.varied.map(M::which), it.tolerance);
    branch::Along { system: system(&it.setting), varied, tolerance }
}

/// Two neighbouring cells, for the engine.
fn neighbours<M: Face<D>, const D: usize>(it: Neighbours) -> attractor::Neighbours<M, D> {
    let Neighbours { protocol, values, cells, inherited, .. } = it;
    let cells = cells.map(|cell| table_of(&cell));
    attractor::Neighbours { along: along(&it.along), protocol, values, cells, inherited }
}

/// What follows the orbits of computations that run side by side.
type Integration<'a, M, const D: usize> = dyn Integrator<M, D> + 'a;
/// The attractors of a cell by place with their derivatives, as the engine has them.
type LinearOf<M, const D: usize> = Vec<Option<Linearised<<M as System<D>>::Event, D>>>;

impl<M: Face<D>, const D: usize> Model for Of<M, D> {
    fn description(&self) -> &'static Description {
        self.description
    }

    fn faults(&self) -> Vec<String> {
        face::faults::<M, D>(self.description)
    }

    fn remarks(&self, parameters: &Parameters, orbit: &Orbit) -> Vec<String> {
        M::remarks(parameters, orbit)
    }

    fn scales(&self, setting: &Setting) -> Section {
        self.point(system::<M, D>(setting).metric().scales)
    }

    fn settle(&self, case: &Case, protocol: &Protocol, known: Option<&Known>) -> Orbit {
        let known = known.map(orbits_of::<M, D>);
        let (_, orbit) =
            Underway::new(0, engine_case::<M, D>(case), protocol, known).finish(protocol);
        face::orbit_of::<M, D>(orbit, case, protocol)
    }

    fn settle_all(&self, cases: &[Case], protocol: &Protocol, machine: Machine) -> Vec<Orbit> {
        let read: Vec<_> = cases.iter().map(engine_case::<M, D>).collect();
        let orbits = settle_all(&read, protocol, machine).into_iter().zip(cases);
        orbits.map(|(orbit, case)| face::orbit_of::<M, D>(orbit, case, protocol)).collect()
    }

    fn settle_queue(
        &self,
        instructions: Instructions,
        protocol: &Protocol,
        known: Option<&Known>,
        queue: &mut dyn CaseQueue,
    ) -> Vec<Box<dyn Unfinished>> {
        filled::settle::<M, D>(instructions, protocol, known.map(orbits_of::<M, D>), queue)
    }

    fn known_orbits(
        &self,
        sample: &[Case],
        protocol: &Protocol,
        machine: Machine,
    ) -> Option<Known> {
        let sample: Vec<_> = sample.iter().map(engine_case::<M, D>).collect();
        let system = sample.first()?.system.clone();
        let orbits = settle_all(&sample, protocol, machine);
        let instructions = machine.instructions_for(sample.len());
        let known = KnownOrbits::among(&system, orbits, instructions, protocol.tolerance);
        Some(Known(Arc::new(known)))
    }

    fn attractor(
        &self,
        setting: &Setting,
        case: usize,
        motion: &FinalMotion<Section>,
        protocol: &Protocol,
    ) -> Option<Attractor<Section>> {
        let motion = motion.map(|it| it.array());
        let found = Attractor::of(case, &system::<M, D>(setting), &motion, protocol)?;
        Some(found.map(|point| self.point(point)))
    }

    fn least_point(&self, setting: &Setting, attractor: &Attractor<Section>) -> usize {
        let metric = system::<M, D>(setting).metric();
        attractor.clone().map(|it| it.array()).least_point(&metric)
    }

    fn table(
        &self,
        setting: &Setting,
        motions: Motions<'_>,
        protocol: &Protocol,
        executor: &dyn Executor,
    ) -> Table<Section> {
        let (at, system) = (at::<D>(motions), system::<M, D>(setting));
        Table::sort(motions.count, at, &system, protocol, executor).map(|point| self.point(point))
    }

    fn extend_table(
        &self,
        table: &mut Table<Section>,
        setting: &Setting,
        motions: Motions<'_>,
        protocol: &Protocol,
        executor: &dyn Executor,
    ) {
        let mut extended = std::mem::take(table).map(|it| it.array());
        let (at, system) = (at::<D>(motions), system::<M, D>(setting));
        extended.extend(motions.count, at, &system, protocol, executor);
        *table = extended.map(|point| self.point(point));
    }

    fn linear_orbits(
        &self,
        instructions: Instructions,
        next: &mut dyn FnMut() -> Option<(usize, Cell)>,
    ) -> Vec<(usize, LinearOrbits)> {
        let computations = iter::from_fn(next).map(|(place, cell)| {
            let (along, table) = (along::<M, D>(&cell.along), table_of(&cell.table));
            move |integrator: &Integration<'_, M, D>| {
                let linear = linear_orbits(integrator, &along, cell.value, &table);
                (place, LinearOrbits(Arc::new(linear)))
            }
        });
        Batch::all(instructions, computations, || ())
    }

    fn links(
        &self,
        instructions: Instructions,
        next: &mut dyn FnMut() -> Option<(usize, Unlinked)>,
        done: &mut dyn FnMut(),
    ) -> Vec<(usize, Links<Section>)> {
        let model = self.description;
        let computations = iter::from_fn(next).map(|(place, unlinked)| {
            let Unlinked { neighbours: cells, linear } = unlinked;
            let neighbours = neighbours::<M, D>(cells);
            move |integrator: &Integration<'_, M, D>| {
                let [before, after] = linear.each_ref().map(linear_of::<M, D>);
                let links = neighbours.link(integrator, [before, after]);
                (place, links.map(|point| model.section_point(&point)))
            }
        });
        Batch::all(instructions, computations, done)
    }

    fn bridges(
        &self,
        cells: &[Arc<Table<Section>>],
        links: &[Links<Section>],
        between: &(dyn Fn(usize) -> Option<Neighbours> + Sync),
        executor: &dyn Executor,
    ) -> Vec<Bridge<Section>> {
        let cells: Vec<_> = cells.iter().map(|cell| table_of(cell)).collect();
        let links: Vec<Links<[f64; D]>> =
            links.iter().map(|it| it.clone().map(|point| point.array())).collect();
        let bridges =
            attractor::bridges(&cells, &links, |at| between(at).map(neighbours::<M, D>), executor);
        bridges.into_iter().map(|it| it.map(|point| self.point(point))).collect()
    }

    fn leads(
        &self,
        setting: &Setting,
        protocol: &Protocol,
        machine: Machine,
        known: &[(u32, &Attractor<Section>)],
    ) -> Box<dyn Leads> {
        let known = known
            .iter()
            .map(|(number, it)| (*number, Attractor::clone(it).map(|point| point.array())))
            .collect();
        Box::new(leads::LeadsOf::<M, D>::new(system(setting), protocol, machine, known))
    }

    fn simulate(&self, case: &Case, most: SimulationSize, tolerance: f64) -> Simulation {
        face::simulate::<M, D>(case, most, tolerance)
    }

    fn arc(&self, case: &Case, count: u32, tolerance: f64) -> Result<Stretch, Failure> {
        let system = M::of(&case.parameters, case.section_phase);
        face::arc::<M, D>(case, count, tolerance).map_err(|it| it.map(|state| system.told(&state)))
    }

    fn section_points(
        &self,
        setting: &Setting,
        from: Section,
        cycles: u64,
        tolerance: f64,
    ) -> Option<Vec<Section>> {
        let mut points = vec![from.array()];
        append_points(&system::<M, D>(setting), &mut points, cycles as usize, tolerance)?;
        Some(points.into_iter().map(|point| self.point(point)).collect())
    }

    fn stable_orbit(
        &self,
        setting: &Setting,
        guess: &Section,
        period: u64,
        tolerance: f64,
    ) -> Option<StableOrbit> {
        let cycles = Cycles { count: period, tolerance };
        stable::orbit::<M, D>(system(setting), &guess.array(), cycles)
    }

    fn sensitivity(
        &self,
        setting: &Setting,
        section: &Section,
        period: u64,
        tolerance: f64,
        parameter: Parameter,
    ) -> Option<Sensitivity> {
        let cycles = Cycles { count: period, tolerance };
        system::<M, D>(setting).sensitivity(&section.array(), cycles, M::which(parameter))
    }

    fn follow(&self, request: &Request) -> Result<Found, NotFollowed> {
        face::follow::<M, D>(request)
    }

    fn segment(&self, it: &Along, from: (f64, &[Section]), to: f64) -> Option<Segment<Section>> {
        let (value, points) = from;
        let from = (value, &arrays(points)[..]);
        Some(
            branch::segment(&OneByOne, &along::<M, D>(it), from, to)?
                .map(|point| self.point(point)),
        )
    }

    fn batches(
        &self,
        setting: &Setting,
        from: Section,
        batches: Batches,
        tolerance: f64,
    ) -> Option<Vec<Outputs>> {
        let cycles = Cycles { count: batches.cycles, tolerance };
        let system = system::<M, D>(setting);
        let mut point = from.array();
        let mut outputs = Vec::new();
        for _ in 0..batches.count {
            let mut observer = system.observer(0);
            point = observed(&system.single(), point, &cycles, &mut observer).ok()?;
            outputs.push(system.per_cycle(&observer, cycles.count as f64));
        }
        Some(outputs)
    }
}

/// The orbits that are known, as this model has found them.
fn orbits_of<M: Face<D>, const D: usize>(known: &Known) -> Arc<KnownOrbits<M, D>> {
    known.0.clone().downcast().expect("they are of this model")
}

/// The attractors of a cell with their derivatives, as this model has found them.
fn linear_of<M: Face<D>, const D: usize>(linear: &LinearOrbits) -> &LinearOf<M, D> {
    linear.0.downcast_ref().expect("they are of this model")
}

/// The final motions of some cases for the engine.
fn at<const D: usize>(
    motions: Motions<'_>,
) -> impl Fn(usize) -> (usize, Option<FinalMotion<[f64; D]>>) + Sync + '_ {
    move |place| {
        let (case, motion) = (motions.at)(place);
        (case, motion.map(|it| it.map(|point| point.array())))
    }
}
