//! What is computed on, and how Python waits for it: in threads that end with what they compute, so that no child process inherits any.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use capsulemap::flow::{Stop, stop};
use capsulemap::orbit::STACK;
use capsulemap::run::Machine;
use pyo3::prelude::*;

use super::failure;

/// Time between two looks for signals.
pub const BETWEEN_SIGNALS: Duration = Duration::from_millis(20);

/// Threads that compute; 0 for one per core.
static THREADS: AtomicUsize = AtomicUsize::new(0);

/// Sets on how many threads everything is computed from now on; none for one per core. Results do not depend on it.
#[pyfunction]
#[pyo3(signature = (count = None))]
pub fn set_threads(py: Python<'_>, count: Option<i64>) -> PyResult<()> {
    let count = match count {
        None => Some(0),
        Some(count) => usize::try_from(count).ok().filter(|it| *it > 0),
    };
    match count {
        Some(count) => THREADS.store(count, Ordering::Relaxed),
        None => {
            let told = "threads: expected a whole number above zero";
            return Err(failure::of_request(py, told.to_owned()));
        }
    }
    Ok(())
}

/// On how many threads everything is computed; none for one per core.
#[pyfunction]
pub fn threads() -> Option<usize> {
    let count = THREADS.load(Ordering::Relaxed);
    (count > 0).then_some(count)
}

/// What is computed on.
pub fn machine() -> Machine {
    Machine { threads: threads(), ..Machine::default() }
}

/// Begins work in a thread with room for what lanes keep on the stack.
///
/// Fails if the thread cannot be started.
pub fn begin(py: Python<'_>, work: impl FnOnce() + Send + 'static) -> PyResult<()> {
    let thread = thread::Builder::new().name("capsulemap".to_owned()).stack_size(STACK);
    let begun = thread.spawn(work);
    begun.map(drop).map_err(|it| failure::machine(py, format!("no thread could be started: {it}")))
}

/// What `work` comes to, computed in a thread of its own; a signal that raises an exception ends it within a few steps.
pub fn computed<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (done, result) = channel();
    // A receiver belongs to one thread at a time, also where the interpreter is let go.
    let result = Mutex::new(result);
    let ends = Stop::default();
    let obeyed = ends.clone();
    begin(py, move || {
        stop::obey(Some(obeyed));
        // Nobody listens any more after a signal.
        let _ = done.send(work());
    })?;
    loop {
        let said = py.detach(|| {
            result
                .lock()
                .map_or(Err(RecvTimeoutError::Disconnected), |it| it.recv_timeout(BETWEEN_SIGNALS))
        });
        match said {
            Ok(value) => return Ok(value),
            Err(RecvTimeoutError::Disconnected) => {
                return Err(failure::machine(py, "the computation broke off".to_owned()));
            }
            Err(RecvTimeoutError::Timeout) => py.check_signals().inspect_err(|_| ends.ask())?,
        }
    }
}
