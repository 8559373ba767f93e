//! A study that is computed in the background, and what of it is done at a moment.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use capsulemap::campaign::{CampaignError, InMemory, Moment, Wanted, silent};
use capsulemap::store::Dataset;
use capsulemap::study::Study;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::failure;
use super::labelled::{array, element, labels_of, of_dataset, type_name};
use super::threads::{BETWEEN_SIGNALS, begin, machine};

/// What has come of a computation.
enum Outcome {
    Running,
    Ended(Result<Dataset, CampaignError>),
    /// It broke off by a fault of the program.
    Broken,
    /// It has been handed out.
    Taken,
}

/// A computation, and what has come of it.
struct Computation {
    study: InMemory,
    outcome: Mutex<Outcome>,
    ended: Condvar,
}

/// A study that is computed in the background.
#[pyclass(frozen)]
pub struct Job {
    computation: Arc<Computation>,
    /// The process whose threads compute it.
    process: u32,
}

impl Job {
    /// Begins to compute what is wanted of a study.
    pub fn begin(py: Python<'_>, study: Study, wanted: Wanted) -> PyResult<Job> {
        let study = InMemory::new(study, machine());
        let (outcome, ended) = (Mutex::new(Outcome::Running), Condvar::new());
        let computation = Arc::new(Computation { study, outcome, ended });
        let own = computation.clone();
        begin(py, move || own.run(wanted))?;
        Ok(Job { computation, process: process::id() })
    }
}

impl Drop for Job {
    /// Ends a computation whose result nobody can ask for any more.
    fn drop(&mut self) {
        self.computation.study.stop();
    }
}

impl Computation {
    fn run(&self, wanted: Wanted) {
        let run = || self.study.run(wanted, &silent);
        let outcome = catch_unwind(AssertUnwindSafe(run)).map_or(Outcome::Broken, Outcome::Ended);
        *self.locked() = outcome;
        self.ended.notify_all();
    }

    fn locked(&self) -> MutexGuard<'_, Outcome> {
        self.outcome.lock().unwrap_or_else(|it| it.into_inner())
    }

    fn is_running(&self) -> bool {
        matches!(*self.locked(), Outcome::Running)
    }

    /// Waits as long as it runs, but not longer than this.
    fn wait(&self, most: Duration) {
        let outcome = self.locked();
        let running = |it: &mut Outcome| matches!(it, Outcome::Running);
        drop(self.ended.wait_timeout_while(outcome, most, running));
    }
}

#[pymethods]
impl Job {
    /// Waits until the computation has ended, so many seconds at most; returns whether it has. Signals are looked for every 20 ms.
    #[pyo3(signature = (seconds = None))]
    fn wait(&self, py: Python<'_>, seconds: Option<f64>) -> PyResult<bool> {
        let most = seconds.and_then(|it| Duration::try_from_secs_f64(it.max(0.0)).ok());
        let begun = Instant::now();
        while self.is_running(py)? {
            let left = most.map_or(BETWEEN_SIGNALS, |most| most.saturating_sub(begun.elapsed()));
            if left.is_zero() {
                return Ok(false);
            }
            py.detach(|| self.computation.wait(left.min(BETWEEN_SIGNALS)));
            py.check_signals()?;
        }
        Ok(true)
    }

    /// Whether it is still computed.
    fn is_running(&self, py: Python<'_>) -> PyResult<bool> {
        let running = self.computation.is_running();
        if running && self.process != process::id() {
            let told = "the threads of this job are in the parent of this process";
            return Err(failure::of_request(py, told.to_owned()));
        }
        Ok(running)
    }

    /// Cases that are done, and all of the study.
    fn progress(&self) -> [usize; 2] {
        self.computation.study.progress()
    }

    /// Ends the computation within a few steps; what is done stays.
    fn cancel(&self) {
        self.computation.study.stop();
    }

    /// The dataset, which is handed out once, as a dictionary; none if it was cancelled. Raises what the computation has failed with.
    fn result<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let outcome = std::mem::replace(&mut *self.computation.locked(), Outcome::Taken);
        match outcome {
            Outcome::Ended(Ok(dataset)) => of_dataset(py, dataset).map(Some),
            Outcome::Ended(Err(CampaignError::Stopped)) => Ok(None),
            Outcome::Ended(Err(error)) => Err(failure::of_campaign(py, error)),
            Outcome::Broken => Err(failure::machine(py, "the computation broke off".to_owned())),
            Outcome::Taken => Err(failure::of_request(py, "the result was taken".to_owned())),
            Outcome::Running => {
                *self.computation.locked() = Outcome::Running;
                Err(failure::of_request(py, "the job is still running".to_owned()))
            }
        }
    }

    /// The cases that are done by now.
    fn partial(&self, py: Python<'_>) -> Partial {
        let moment = py.detach(|| self.computation.study.moment());
        Partial { computation: self.computation.clone(), moment }
    }
}

/// The cases of a study that were done at a moment. Numbers are put together as they are asked for.
#[pyclass(frozen)]
pub struct Partial {
    computation: Arc<Computation>,
    moment: Moment,
}

#[pymethods]
impl Partial {
    /// All but the variables over the cases, as a dictionary.
    fn frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let frame = py.detach(|| self.computation.study.at(&self.moment).frame());
        of_dataset(py, frame)
    }

    /// The variables over the cases: name, dimensions, shape, type and attributes of each.
    #[expect(clippy::type_complexity)]
    fn labels<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<
        Vec<(String, Bound<'py, PyTuple>, Bound<'py, PyTuple>, &'static str, Bound<'py, PyDict>)>,
    > {
        let labels = py.detach(|| self.computation.study.at(&self.moment).labels());
        let told = labels.into_iter().map(|it| {
            let own = labels_of(py, &it.name, &it.label, it.element)?;
            let dimensions = PyTuple::new(py, &it.label.dimensions)?;
            let shape = PyTuple::new(py, &it.shape)?;
            Ok((it.name, dimensions, shape, type_name(it.element), own))
        });
        told.collect()
    }

    /// The numbers of a variable over the cases: NaN, 0 or the outcome `missing` of those that were not done.
    fn numbers<'py>(&self, py: Python<'py>, name: String) -> PyResult<Bound<'py, PyAny>> {
        let found = py.detach(|| self.computation.study.at(&self.moment).variable(&name));
        match found.map_err(|error| failure::of_campaign(py, error))? {
            Some(variable) => {
                let element = element(&variable);
                Ok(array(py, variable.values, element))
            }
            None => Err(failure::of_request(py, format!("there is no variable `{name}`"))),
        }
    }
}
