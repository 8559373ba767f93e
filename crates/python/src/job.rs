//! A study that is computed in the background, and what of it is done at a moment.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use capsulemap::campaign::{CampaignError, InMemory, OnDisk, Wanted, silent};
use capsulemap::store::Dataset;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::failure;
use super::labelled::of_dataset;
use super::partial::Partial;
use super::threads::{BETWEEN_SIGNALS, begin};

/// What has come of a computation.
enum Outcome {
    Running,
    Ended(Result<Dataset, CampaignError>),
    /// It broke off by a fault of the program.
    Broken,
    /// It has been handed out.
    Taken,
}

/// A study that is computed.
pub enum Work {
    /// In memory.
    InMemory(Arc<InMemory>),
    /// Into its file.
    OnDisk(Box<OnDisk>),
}

impl Work {
    fn run(&self, wanted: Wanted) -> Result<Dataset, CampaignError> {
        match self {
            Work::InMemory(study) => study.run(wanted, &silent),
            Work::OnDisk(study) => study.run(wanted),
        }
    }

    fn progress(&self) -> [usize; 2] {
        match self {
            Work::InMemory(study) => study.progress(),
            Work::OnDisk(study) => study.progress(),
        }
    }

    fn stop(&self) {
        match self {
            Work::InMemory(study) => study.stop(),
            Work::OnDisk(study) => study.stop(),
        }
    }
}

/// A computation, and what has come of it.
struct Computation {
    work: Work,
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
    pub fn begin(py: Python<'_>, work: Work, wanted: Wanted) -> PyResult<Job> {
        let (outcome, ended) = (Mutex::new(Outcome::Running), Condvar::new());
        let computation = Arc::new(Computation { work, outcome, ended });
        let own = computation.clone();
        begin(py, move || own.run(wanted))?;
        Ok(Job { computation, process: process::id() })
    }
}

impl Drop for Job {
    /// Ends a computation whose result nobody can ask for any more.
    fn drop(&mut self) {
        self.computation.work.stop();
    }
}

impl Computation {
    fn run(&self, wanted: Wanted) {
        let run = || self.work.run(wanted);
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
        self.computation.work.progress()
    }

    /// Ends the computation within a few steps; what is done stays.
    fn cancel(&self) {
        self.computation.work.stop();
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

    /// The cases that are done by now: of a study in memory a `Partial`, of one with a file the dataset as a dictionary.
    fn partial<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.computation.work {
            Work::InMemory(study) => {
                let moment = py.detach(|| study.moment());
                Ok(Bound::new(py, Partial::new(study.clone(), moment))?.into_any())
            }
            Work::OnDisk(study) => {
                let dataset = py.detach(|| study.so_far());
                let dataset = dataset.map_err(|error| failure::of_campaign(py, error))?;
                Ok(of_dataset(py, dataset)?.into_any())
            }
        }
    }
}
