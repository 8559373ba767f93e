//! A model with the outputs that a study defines: all else it leaves to the model that it extends.

use std::collections::BTreeMap;
use std::ptr;
use std::sync::{Arc, Mutex, PoisonError};

use capsulemap_engine::attractor::{Attractor, Bridge, Executor, FinalMotion, Links, Table};
use capsulemap_engine::branch::{NotFollowed, Segment};
use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{Machine, Protocol};

use crate::description::{Description, Outputs, Parameter, Parameters, Section, State};
use crate::model::{
    Along, Batches, CaseQueue, Cell, Known, Leads, LinearOrbits, Model, Motions, Neighbours,
    StableOrbit, Unfinished, Unlinked,
};
use crate::motion::branch::{Found, Request};
use crate::motion::{
    Case, Failure, Orbit, Sensitivity, Setting, Simulation, SimulationSize, Stretch,
};

/// A model with the outputs that a study defines.
#[derive(Debug, Clone, Copy)]
struct WithOwn {
    description: &'static Description,
    model: &'static dyn Model,
}

/// The model with the own outputs of a description; the same for the same two.
pub(super) fn with_own(
    description: &'static Description,
    model: &'static dyn Model,
) -> &'static dyn Model {
    static KNOWN: Mutex<Vec<&'static WithOwn>> = Mutex::new(Vec::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let found = known
        .iter()
        .find(|it| it.description == description && ptr::addr_eq(it.model, model))
        .copied();
    found.unwrap_or_else(|| {
        let model: &'static WithOwn = Box::leak(Box::new(WithOwn { description, model }));
        known.push(model);
        model
    })
}

impl WithOwn {
    /// A state as one of this description.
    fn state(&self, state: &State) -> State {
        State::new(self.description, state.values())
    }

    /// What a case has settled to, with the own outputs.
    fn orbit(&self, parameters: &Parameters, orbit: Orbit) -> Orbit {
        Orbit {
            outputs: orbit.outputs.with_own(parameters),
            end: self.state(&orbit.end),
            failure: orbit.failure.map(|it| it.map(|state| self.state(&state))),
            ..orbit
        }
    }
}

impl Model for WithOwn {
    fn description(&self) -> &'static Description {
        self.description
    }

    fn faults(&self) -> Vec<String> {
        self.model.faults()
    }

    fn remarks(&self, parameters: &Parameters, orbit: &Orbit) -> Vec<String> {
        self.model.remarks(parameters, orbit)
    }

    fn scales(&self, setting: &Setting) -> Section {
        self.model.scales(setting)
    }

    fn settle(&self, case: &Case, protocol: &Protocol, known: Option<&Known>) -> Orbit {
        self.orbit(&case.parameters, self.model.settle(case, protocol, known))
    }

    fn settle_all(&self, cases: &[Case], protocol: &Protocol, machine: Machine) -> Vec<Orbit> {
        let orbits = self.model.settle_all(cases, protocol, machine).into_iter().zip(cases);
        orbits.map(|(orbit, case)| self.orbit(&case.parameters, orbit)).collect()
    }

    fn settle_queue(
        &self,
        instructions: Instructions,
        protocol: &Protocol,
        known: Option<&Known>,
        queue: &mut dyn CaseQueue,
    ) -> Vec<Box<dyn Unfinished>> {
        let mut told = Told { queue, model: *self, parameters: BTreeMap::new() };
        let left = self.model.settle_queue(instructions, protocol, known, &mut told);
        let mut unfinished: Vec<Box<dyn Unfinished>> = Vec::new();
        for case in left {
            let parameters = told.taken(case.number());
            unfinished.push(Box::new(Left { case, model: *self, parameters }));
        }
        unfinished
    }

    fn known_orbits(
        &self,
        sample: &[Case],
        protocol: &Protocol,
        machine: Machine,
    ) -> Option<Known> {
        self.model.known_orbits(sample, protocol, machine)
    }

    fn attractor(
        &self,
        setting: &Setting,
        case: usize,
        motion: &FinalMotion<Section>,
        protocol: &Protocol,
    ) -> Option<Attractor<Section>> {
        self.model.attractor(setting, case, motion, protocol)
    }

    fn least_point(&self, setting: &Setting, attractor: &Attractor<Section>) -> usize {
        self.model.least_point(setting, attractor)
    }

    fn table(
        &self,
        setting: &Setting,
        motions: Motions<'_>,
        protocol: &Protocol,
        executor: &dyn Executor,
    ) -> Table<Section> {
        self.model.table(setting, motions, protocol, executor)
    }

    fn extend_table(
        &self,
        table: &mut Table<Section>,
        setting: &Setting,
        motions: Motions<'_>,
        protocol: &Protocol,
        executor: &dyn Executor,
    ) {
        self.model.extend_table(table, setting, motions, protocol, executor);
    }

    fn linear_orbits(
        &self,
        instructions: Instructions,
        next: &mut dyn FnMut() -> Option<(usize, Cell)>,
    ) -> Vec<(usize, LinearOrbits)> {
        self.model.linear_orbits(instructions, next)
    }

    fn links(
        &self,
        instructions: Instructions,
        next: &mut dyn FnMut() -> Option<(usize, Unlinked)>,
        done: &mut dyn FnMut(),
    ) -> Vec<(usize, Links<Section>)> {
        self.model.links(instructions, next, done)
    }

    fn bridges(
        &self,
        cells: &[Arc<Table<Section>>],
        links: &[Links<Section>],
        between: &(dyn Fn(usize) -> Option<Neighbours> + Sync),
        executor: &dyn Executor,
    ) -> Vec<Bridge<Section>> {
        self.model.bridges(cells, links, between, executor)
    }

    fn leads(
        &self,
        setting: &Setting,
        protocol: &Protocol,
        machine: Machine,
        known: &[(u32, &Attractor<Section>)],
    ) -> Box<dyn Leads> {
        self.model.leads(setting, protocol, machine, known)
    }

    fn simulate(&self, case: &Case, most: SimulationSize, tolerance: f64) -> Simulation {
        self.model.simulate(case, most, tolerance)
    }

    fn arc(&self, case: &Case, count: u32, tolerance: f64) -> Result<Stretch, Failure> {
        self.model.arc(case, count, tolerance)
    }

    fn section_points(
        &self,
        setting: &Setting,
        from: Section,
        cycles: u64,
        tolerance: f64,
    ) -> Option<Vec<Section>> {
        self.model.section_points(setting, from, cycles, tolerance)
    }

    fn stable_orbit(
        &self,
        setting: &Setting,
        guess: &Section,
        period: u64,
        tolerance: f64,
    ) -> Option<StableOrbit> {
        self.model.stable_orbit(setting, guess, period, tolerance)
    }

    fn sensitivity(
        &self,
        setting: &Setting,
        section: &Section,
        period: u64,
        tolerance: f64,
        parameter: Parameter,
    ) -> Option<Sensitivity> {
        let found = self.model.sensitivity(setting, section, period, tolerance, parameter)?;
        let Sensitivity { outputs, slopes, .. } = &found;
        Some(Sensitivity {
            slopes: slopes.slopes_with_own(&setting.parameters, outputs, parameter),
            outputs: outputs.with_own(&setting.parameters),
            ..found
        })
    }

    fn follow(&self, request: &Request) -> Result<Found, NotFollowed> {
        let at = |value| {
            let mut parameters = request.setting.parameters.clone();
            parameters[request.along] = value;
            parameters
        };
        let found = self.model.follow(request)?;
        Ok(found.map(|value, outputs| outputs.with_own(&at(value)), |point| point))
    }

    fn segment(&self, along: &Along, from: (f64, &[Section]), to: f64) -> Option<Segment<Section>> {
        self.model.segment(along, from, to)
    }

    fn batches(
        &self,
        setting: &Setting,
        from: Section,
        batches: Batches,
        tolerance: f64,
    ) -> Option<Vec<Outputs>> {
        let found = self.model.batches(setting, from, batches, tolerance)?;
        Some(found.iter().map(|it| it.with_own(&setting.parameters)).collect())
    }
}

/// A queue whose records are told with the own outputs; it holds the parameters of the cases that are in lanes, by their numbers.
struct Told<'a> {
    queue: &'a mut dyn CaseQueue,
    model: WithOwn,
    parameters: BTreeMap<usize, Parameters>,
}

impl Told<'_> {
    /// The parameters of the case of a number, which is in no lane any more.
    fn taken(&mut self, number: usize) -> Parameters {
        self.parameters.remove(&number).expect("the case was in a lane")
    }
}

impl CaseQueue for Told<'_> {
    fn next(&mut self, done: Option<(usize, Orbit)>) -> Option<(usize, Case)> {
        let done = done.map(|(number, orbit)| {
            let parameters = self.taken(number);
            (number, self.model.orbit(&parameters, orbit))
        });
        let (number, case) = self.queue.next(done)?;
        self.parameters.insert(number, case.parameters.clone());
        Some((number, case))
    }
}

/// A case that has left the lanes unfinished, with its parameters.
struct Left {
    case: Box<dyn Unfinished>,
    model: WithOwn,
    parameters: Parameters,
}

impl Unfinished for Left {
    fn number(&self) -> usize {
        self.case.number()
    }

    fn finish(self: Box<Self>, protocol: &Protocol) -> Orbit {
        self.model.orbit(&self.parameters, self.case.finish(protocol))
    }
}
