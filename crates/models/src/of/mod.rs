//! The one implementation of the door, generic over how the friction of the capsule is read.

mod filled;
mod leads;

use std::iter;
use std::marker::PhantomData;
use std::sync::Arc;

use capsulemap_engine::attractor::{
    self, Attractor, Bridge, Executor, FinalMotion, Links, Table, linear_orbits,
};
use capsulemap_engine::branch::{self, Segment, cyclic};
use capsulemap_engine::flow::System;
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::matrix::eigenvalues;
use capsulemap_engine::orbit::newton::close;
use capsulemap_engine::orbit::passage::{Integrator, OneByOne, ReturnRequest, image};
use capsulemap_engine::orbit::return_map::{Cycles, append_points, observed};
use capsulemap_engine::orbit::{Batch, KnownOrbits, Machine, Protocol, Underway, settle_all};

use crate::capsule::description::CAPSULE;
use crate::capsule::{
    Account, AsPrinted, CapsuleParameters as _, CapsuleSystem, Case, Filippov, Orbit, Parameter,
    Parameters, Reading, Section, Sensitivity, Switching, per_cycle, sensitivity,
};
use crate::description::{self, Description, Outputs};
use crate::model::{
    Along, Batches, CaseQueue, Cell, Known, Leads, LinearOrbits, Model, Motions, Neighbours,
    Setting, StableOrbit, Unfinished, Unlinked,
};

/// An orbit closes to this residual, relative to the motion; a larger one is seen in the outputs.
const EXACT: f64 = 1e-11;
/// How often Newton's method is begun again from the image of the point where it has ended, as beside a kink of the return
/// map it may end early.
const AGAIN: usize = 4;

/// The capsule, its friction read as `R` says, as a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Of<R>(PhantomData<R>);

static FILIPPOV: Of<Filippov> = Of(PhantomData);
static AS_PRINTED: Of<AsPrinted> = Of(PhantomData);

/// The model of capsules with these parameters, by how their friction is read.
// Inlined into another crate, it would have the tables of both implementations, and so the lanes, compiled there once more.
#[inline(never)]
pub fn model_of(parameters: &Parameters) -> &'static dyn Model {
    match parameters.switching() {
        Switching::Filippov => &FILIPPOV,
        Switching::AsPrinted => &AS_PRINTED,
    }
}

/// The model of studies that name none.
pub fn default_model() -> &'static Description {
    &CAPSULE
}

/// The system of a setting.
fn system<R: Reading>(setting: &Setting) -> CapsuleSystem<R> {
    CapsuleSystem::new(setting.parameters.clone(), setting.phase)
}

/// What is held along a parameter, for the engine.
fn along<R: Reading>(it: &Along) -> branch::Along<CapsuleSystem<R>, 3> {
    let (parameter, tolerance) = (Parameter::which(it.parameter), it.tolerance);
    branch::Along { system: system(&it.setting), parameter, tolerance }
}

/// Two neighbouring cells, for the engine.
fn neighbours<R: Reading>(it: Neighbours) -> attractor::Neighbours<CapsuleSystem<R>, 3> {
    let Neighbours { protocol, values, cells, inherited, .. } = it;
    attractor::Neighbours { along: along(&it.along), protocol, values, cells, inherited }
}

/// What follows the orbits of computations that run side by side.
type Integration<'a, R> = dyn Integrator<CapsuleSystem<R>, 3> + 'a;

impl<R: Reading> Model for Of<R> {
    fn settle(&self, case: &Case, protocol: &Protocol, known: Option<&Known>) -> Orbit {
        let known = known.map(orbits_of::<R>);
        let (_, orbit) = Underway::new(0, case.read::<R>(), protocol, known).finish(protocol);
        Orbit::of::<R>(orbit, case, protocol)
    }

    fn settle_queue(
        &self,
        instructions: Instructions,
        protocol: &Protocol,
        known: Option<&Known>,
        queue: &mut dyn CaseQueue,
    ) -> Vec<Box<dyn Unfinished>> {
        filled::settle::<R>(instructions, protocol, known.map(orbits_of::<R>), queue)
    }

    fn known_orbits(
        &self,
        sample: &[Case],
        protocol: &Protocol,
        machine: Machine,
    ) -> Option<Known> {
        let sample: Vec<_> = sample.iter().map(Case::read::<R>).collect();
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
        motion: &FinalMotion<3>,
        protocol: &Protocol,
    ) -> Option<Attractor<3>> {
        Attractor::of(case, &system::<R>(setting), motion, protocol)
    }

    fn table(
        &self,
        setting: &Setting,
        motions: Motions<'_>,
        protocol: &Protocol,
        executor: &dyn Executor,
    ) -> Table<3> {
        Table::sort(motions.count, motions.at, &system::<R>(setting), protocol, executor)
    }

    fn extend_table(
        &self,
        table: &mut Table<3>,
        setting: &Setting,
        motions: Motions<'_>,
        protocol: &Protocol,
        executor: &dyn Executor,
    ) {
        table.extend(motions.count, motions.at, &system::<R>(setting), protocol, executor);
    }

    fn linear_orbits(
        &self,
        instructions: Instructions,
        next: &mut dyn FnMut() -> Option<(usize, Cell)>,
    ) -> Vec<(usize, LinearOrbits)> {
        let computations = iter::from_fn(next).map(|(place, cell)| {
            let along = along::<R>(&cell.along);
            move |integrator: &Integration<'_, R>| {
                (place, linear_orbits(integrator, &along, cell.value, &cell.table))
            }
        });
        Batch::all(instructions, computations, || ())
    }

    fn links(
        &self,
        instructions: Instructions,
        next: &mut dyn FnMut() -> Option<(usize, Unlinked)>,
        done: &mut dyn FnMut(),
    ) -> Vec<(usize, Links<3>)> {
        let computations = iter::from_fn(next).map(|(place, unlinked)| {
            let Unlinked { neighbours: cells, linear } = unlinked;
            let neighbours = neighbours::<R>(cells);
            move |integrator: &Integration<'_, R>| {
                (place, neighbours.link(integrator, [&linear[0], &linear[1]]))
            }
        });
        Batch::all(instructions, computations, done)
    }

    fn bridges(
        &self,
        cells: &[Arc<Table<3>>],
        links: &[Links<3>],
        between: &(dyn Fn(usize) -> Option<Neighbours> + Sync),
        executor: &dyn Executor,
    ) -> Vec<Bridge<3>> {
        let between = |at: usize| between(at).map(neighbours::<R>);
        attractor::bridges(cells, links, between, executor)
    }

    fn leads<'a>(
        &self,
        setting: &Setting,
        protocol: &Protocol,
        machine: Machine,
        known: Vec<(u32, &'a Attractor<3>)>,
    ) -> Box<dyn Leads + 'a> {
        Box::new(leads::LeadsOf::<R>::new(system(setting), protocol, machine, known))
    }

    fn section_points(
        &self,
        setting: &Setting,
        from: Section,
        cycles: u64,
        tolerance: f64,
    ) -> Option<Vec<Section>> {
        let mut points = vec![from];
        append_points(&system::<R>(setting), &mut points, cycles as usize, tolerance)?;
        Some(points)
    }

    fn stable_orbit(
        &self,
        setting: &Setting,
        guess: &Section,
        period: u64,
        tolerance: f64,
    ) -> Option<StableOrbit> {
        let system = system::<R>(setting);
        let metric = system.metric();
        let cycles = Cycles { count: period, tolerance };
        let size = metric.size(guess).max(system.expected_size());
        let image_of = |point: &Section| image(&OneByOne, &system, point, &cycles);
        let closed_near =
            |guess: &Section| close(image_of, period, &metric, guess, size).ok().flatten();
        let mut closed = closed_near(guess)?;
        for _ in 0..AGAIN {
            if closed.residual <= EXACT {
                break;
            }
            closed = closed_near(&image_of(&closed.point).ok()?.end)?;
        }
        let multipliers = eigenvalues(&closed.jacobian);
        let is_stable = multipliers[0].abs() < 1.0;
        if closed.residual > EXACT || !is_stable {
            return None;
        }
        let section = closed.point;
        let passed = OneByOne.passage(ReturnRequest {
            system,
            along: None,
            point: section,
            units: [1.0; 3],
            cycles,
            watched: true,
        });
        Some(StableOrbit { section, multipliers, events: cyclic(&passed.ok()?.events) })
    }

    fn sensitivity(
        &self,
        setting: &Setting,
        section: &Section,
        period: u64,
        tolerance: f64,
        parameter: description::Parameter,
    ) -> Option<Sensitivity> {
        let parameter = Parameter::which(parameter);
        sensitivity(&system::<R>(setting), (section, period), tolerance, parameter)
    }

    fn segment(&self, it: &Along, from: (f64, &[Section]), to: f64) -> Option<Segment<3>> {
        branch::segment(&OneByOne, &along::<R>(it), from, to)
    }

    fn batches(
        &self,
        setting: &Setting,
        from: Section,
        batches: Batches,
        tolerance: f64,
    ) -> Option<Vec<Outputs>> {
        let cycles = Cycles { count: batches.cycles, tolerance };
        let system = system::<R>(setting);
        let of = |parameter: Parameter| setting.parameters[parameter];
        let mut point = from;
        let batch = |_| {
            let mut account = Account::new(of, 0);
            point = observed(&system.system(of), point, &cycles, &mut account).ok()?;
            Some(per_cycle(&account, of, cycles.count as f64).into())
        };
        (0..batches.count).map(batch).collect()
    }
}

/// The orbits that are known, as this model has found them.
fn orbits_of<R: Reading>(known: &Known) -> Arc<KnownOrbits<CapsuleSystem<R>, 3>> {
    known.0.clone().downcast().expect("they are of this model")
}
