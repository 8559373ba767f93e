//! One motion from its start as a dataset: where it is at each section, and its events.

use std::collections::BTreeMap;
use std::sync::Arc;

use capsulemap::description::{Description, State};
use capsulemap::motion::{Simulation, SimulationSize};
use capsulemap::of::model_of;
use capsulemap::store::{Dataset, Values, Variable};
use capsulemap::study::Study;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::failure;
use super::labelled::of_dataset;
use super::threads::computed;

/// The dimensions.
const CYCLE: &str = "cycle";
const EVENT: &str = "event";

/// The first case of a study from its start over so many cycles: time, coordinates, sums and counts over `cycle`, and the events over
/// `event`; a signal that raises an exception ends it.
///
/// Fails with `MachineError` where the motion cannot be followed at all.
pub fn simulated(py: Python<'_>, study: Arc<Study>, cycles: u64) -> PyResult<Bound<'_, PyDict>> {
    if study.cases() == 0 {
        return Err(failure::of_request(py, "the study has no case".to_owned()));
    }
    let own = study.clone();
    let simulation = computed(py, move || {
        let (case, most) = (own.case(0), SimulationSize { cycles, events: usize::MAX });
        model_of(&case.parameters).simulate(&case, most, own.protocol.tolerance)
    })?;
    of_dataset(py, dataset(&study, &simulation))
}

fn dataset(study: &Study, simulation: &Simulation) -> Dataset {
    let model = study.base.model();
    let mut dataset = capsulemap::store::frame(study);
    if let Some(failure) = &simulation.failure {
        dataset.attributes.insert("failure".to_owned(), failure.to_string());
    }
    let mut table = Table { dataset: &mut dataset, along: CYCLE, prefix: "" };
    let section = &simulation.section;
    table.count(section.iter().map(|it| it.cycle as i64), "cycles since the first section");
    table.reals("time", "s", "time since the start", section.iter().map(|it| it.time));
    table.states(model, section.iter().map(|it| &it.state));
    for (place, name) in model.motion.sums.iter().enumerate() {
        let sums = section.iter().map(|it| it.sums.get(place).copied().unwrap_or(f64::NAN));
        let output = model.output(name);
        let unit = output.map_or("1", |it| it.unit());
        table.reals(name, unit, "summed up since the start", sums);
    }
    for (place, name) in model.motion.counts.iter().enumerate() {
        let counts = section.iter().map(|it| it.counts.get(place).map_or(0, |it| *it as i64));
        table.integers(name, "counted since the start", counts, BTreeMap::new());
    }
    let events = &simulation.events;
    table.along = EVENT;
    table.prefix = "event_";
    table.count((0..events.len()).map(|it| it as i64), "events since the start");
    table.reals("time", "s", "time since the start", events.iter().map(|it| it.time));
    let names = model.motion.events.iter().zip(1_i64..);
    let flags = names.map(|(name, number)| (number, (*name).to_owned())).collect();
    table.integers("kind", "what happens", events.iter().map(|it| i64::from(it.number)), flags);
    table.states(model, events.iter().map(|it| &it.state));
    dataset
}

/// Columns along one dimension of a dataset.
struct Table<'a> {
    dataset: &'a mut Dataset,
    along: &'static str,
    /// What the names of its variables begin with.
    prefix: &'static str,
}

impl Table<'_> {
    fn count(&mut self, numbers: impl Iterator<Item = i64>, meaning: &str) {
        let (dimensions, labels) = (vec![self.along.to_owned()], ["1", meaning].map(str::to_owned));
        let coordinate =
            Variable::labelled(dimensions, labels, Values::integers(numbers.collect()));
        self.dataset.coordinates.push((self.along.to_owned(), coordinate));
    }

    fn reals(&mut self, name: &str, unit: &str, meaning: &str, of: impl Iterator<Item = f64>) {
        self.put(name, [unit, meaning], Values::reals(of.collect()));
    }

    fn integers(
        &mut self,
        name: &str,
        meaning: &str,
        of: impl Iterator<Item = i64>,
        flags: BTreeMap<i64, String>,
    ) {
        let flags = flags.into_iter().collect();
        let values = Values::integers(of.collect());
        let name = self.put(name, ["1", meaning], values);
        if let Some(variable) = self.dataset.variables.get_mut(&name) {
            variable.flags = flags;
        }
    }

    fn states<'s>(
        &mut self,
        model: &'static Description,
        states: impl Iterator<Item = &'s State> + Clone,
    ) {
        for coordinate in model.coordinates() {
            let of = states.clone().map(|state| state[coordinate]);
            let start = coordinate.start();
            self.reals(coordinate.name(), start.dimension.unit(), coordinate.name(), of);
        }
    }

    fn put(&mut self, name: &str, labels: [&str; 2], values: Values) -> String {
        let name = format!("{}{name}", self.prefix);
        let dimensions = vec![self.along.to_owned()];
        let variable = Variable::labelled(dimensions, labels.map(str::to_owned), values);
        self.dataset.variables.insert(name.clone(), variable);
        name
    }
}
