//! Computations for the page on threads of their own: so many at once, each within a budget of time, and no longer than their
//! client waits.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::thread;
use std::time::{Duration, Instant};

use axum::body::{Body, Bytes};
use axum::response::Response;
use hyper::body::Frame;
use tokio::sync::mpsc::error::TrySendError;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, mpsc, oneshot};
use tokio::task::JoinHandle;
use tokio::time::{sleep, timeout};

use super::answer::{Refusal, of};
use crate::flow::{Stop, stop};
use crate::orbit::STACK;

/// What may be computed at once, and what may wait for it; more is refused.
const MOTIONS: [usize; 2] = [4, 64];
const READINGS: [usize; 2] = [2, 64];
const HEAVY: [usize; 2] = [2, 8];
/// The longest that a motion may take: a person waits for it.
pub const MOTION_BUDGET: Duration = Duration::from_secs(10);
/// The longest that other answers may take.
pub const BUDGET: Duration = Duration::from_secs(60);
/// The longest from the end of the budget to an answer: what follows no motion asks rarely whether it is to end.
const GRACE: Duration = Duration::from_secs(5);
/// The longest wait for a place.
const LONGEST_WAIT: Duration = Duration::from_secs(30);
/// Between two tries to send a line.
const PAUSE: Duration = Duration::from_millis(5);
/// Lines that wait to be sent.
const WAITING: usize = 64;

/// The computations of the server by what they ask of the machine.
pub struct Computations {
    /// Motions: a click is to be answered while all else is computed.
    pub motions: Places,
    /// What is read from the file.
    pub readings: Places,
    /// Figures, lines and basins, which may take all cores for long.
    pub heavy: Places,
}

impl Default for Computations {
    fn default() -> Computations {
        Computations {
            motions: Places::new(MOTIONS, MOTION_BUDGET, Priority::Usual),
            readings: Places::new(READINGS, BUDGET, Priority::Usual),
            heavy: Places::new(HEAVY, BUDGET, Priority::Low),
        }
    }
}

/// The places of computations of one kind.
pub struct Places {
    free: Arc<Semaphore>,
    /// Those that compute and those that wait.
    taken: Arc<Semaphore>,
    budget: Duration,
    priority: Priority,
}

/// What the system gives its cores to first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Priority {
    Usual,
    Low,
}

/// A place among the computations, until it is dropped.
struct Place(#[expect(dead_code, reason = "held")] [OwnedSemaphorePermit; 2]);

impl Places {
    fn new([at_once, waiting]: [usize; 2], budget: Duration, priority: Priority) -> Places {
        let [free, taken] = [at_once, at_once + waiting].map(|it| Arc::new(Semaphore::new(it)));
        Places { free, taken, budget, priority }
    }

    /// The answer that a computation gives within the budget.
    pub async fn answer<T: Send + 'static>(
        &self,
        compute: impl FnOnce() -> Result<T, Refusal> + Send + 'static,
    ) -> Result<T, Refusal> {
        let place = self.place().await?;
        let stopping = Stopping::after(self.budget);
        let (send, answer) = oneshot::channel();
        let budget = self.budget;
        self.begin(&stopping, place, move || {
            // The client may have gone away.
            let _ = send.send(whole(compute(), budget));
        })?;
        let told = match timeout(budget + GRACE, answer).await {
            Ok(Ok(told)) => told,
            Ok(Err(_)) => Err(Refusal::failed("the computation ended early")),
            Err(_) => Err(Refusal::late(budget, INSTEAD)),
        };
        // Until here, as a client that goes away drops it.
        drop(stopping);
        told
    }

    /// The answer of a computation that is prepared and then sends it line by line, until it returns, is to end or nobody
    /// listens.
    pub async fn stream<T: 'static>(
        &self,
        prepare: impl FnOnce() -> Result<T, Refusal> + Send + 'static,
        compute: impl FnOnce(T, &dyn Fn(String) -> bool) + Send + 'static,
    ) -> Result<Response, Refusal> {
        let place = self.place().await?;
        let stopping = Stopping::after(self.budget);
        let (send, lines) = mpsc::channel::<Bytes>(WAITING);
        let (ready, begun) = oneshot::channel();
        let budget = self.budget;
        self.begin(&stopping, place, move || {
            let (prepared, refused) = match whole(prepare(), budget) {
                Ok(prepared) => (Some(prepared), None),
                Err(refused) => (None, Some(refused)),
            };
            // The client may have gone away.
            let _ = ready.send(refused.map_or(Ok(()), Err));
            if let Some(prepared) = prepared {
                compute(prepared, &|line| sent(&send, Bytes::from(line + "\n")));
            }
        })?;
        begun.await.unwrap_or_else(|_| Err(Refusal::failed("the computation ended early")))?;
        Ok(of(Body::new(Lines { lines, _stopping: stopping }), "application/x-ndjson"))
    }

    /// A place, when there is one.
    async fn place(&self) -> Result<Place, Refusal> {
        let taken = self.taken.clone().try_acquire_owned().map_err(|_| Refusal::busy())?;
        match timeout(LONGEST_WAIT, self.free.clone().acquire_owned()).await {
            Ok(Ok(free)) => Ok(Place([taken, free])),
            _ => Err(Refusal::busy()),
        }
    }

    /// Computes on a thread of its own, which holds a place.
    fn begin(
        &self,
        stopping: &Stopping,
        place: Place,
        compute: impl FnOnce() + Send + 'static,
    ) -> Result<(), Refusal> {
        let (priority, ends) = (self.priority, stopping.stop.clone());
        let begun = thread::Builder::new().stack_size(STACK).spawn(move || {
            if priority == Priority::Low {
                lower_priority();
            }
            stop::obey(Some(ends));
            compute();
            drop(place);
        });
        begun.map(drop).map_err(|said| Refusal::failed(format!("no thread can be started: {said}")))
    }
}

/// What is to be done instead of waiting for an answer that has no other advice.
const INSTEAD: &str = "the commands of capsulemap have no such limit";

/// What came of a computation, unless it was ended early: what it gives then has no meaning.
fn whole<T>(told: Result<T, Refusal>, budget: Duration) -> Result<T, Refusal> {
    match told {
        Err(refusal) if refusal.is_late() => Err(refusal),
        _ if stop::is_asked() => Err(Refusal::late(budget, INSTEAD)),
        told => told,
    }
}

/// Lets this thread, and those that it starts, compute where no other of the program has to.
fn lower_priority() {
    // Of Linux alone the number is that of a thread; the answer is the same where it is refused, only later.
    #[cfg(target_os = "linux")]
    let _ = rustix::process::setpriority_process(None, LOWEST);
}

/// The lowest priority of the system.
#[cfg(target_os = "linux")]
const LOWEST: i32 = 19;

/// Ends a computation when its budget is at its end, or when it is dropped with its answer.
struct Stopping {
    stop: Stop,
    timer: JoinHandle<()>,
}

impl Stopping {
    fn after(budget: Duration) -> Stopping {
        let stop = Stop::default();
        let late = stop.clone();
        let timer = tokio::spawn(async move {
            sleep(budget).await;
            late.ask();
        });
        Stopping { stop, timer }
    }
}

impl Drop for Stopping {
    fn drop(&mut self) {
        self.stop.ask();
        self.timer.abort();
    }
}

/// Whether a line was sent; a client that takes none for long is as one that has gone away.
fn sent(send: &mpsc::Sender<Bytes>, mut line: Bytes) -> bool {
    let begun = Instant::now();
    loop {
        line = match send.try_send(line) {
            Ok(()) => return true,
            Err(TrySendError::Full(line)) if begun.elapsed() < LONGEST_WAIT => line,
            Err(_) => return false,
        };
        thread::sleep(PAUSE);
    }
}

/// Lines as the body of an answer, with what ends their computation.
struct Lines {
    lines: mpsc::Receiver<Bytes>,
    _stopping: Stopping,
}

impl hyper::body::Body for Lines {
    type Data = Bytes;
    type Error = std::convert::Infallible;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Self::Error>>> {
        self.lines.poll_recv(context).map(|line| line.map(|it| Ok(Frame::data(it))))
    }
}
