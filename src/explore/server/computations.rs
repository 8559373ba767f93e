//! Computations for the page, so many at once, on threads of their own.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::thread;
use std::time::{Duration, Instant};

use axum::body::{Body, Bytes};
use axum::http::StatusCode;
use axum::response::Response;
use hyper::body::Frame;
use tokio::sync::mpsc::error::TrySendError;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, mpsc, oneshot};
use tokio::time::timeout;

use super::answer::{Refusal, of};
use crate::orbit::STACK;

/// Computations of one answer at once, and those that answer line by line.
const MOST_SHORT: usize = 2;
const MOST_STREAMS: usize = 2;
/// The longest wait for a place among them.
const LONGEST_WAIT: Duration = Duration::from_secs(30);
/// Between two tries to send a line.
const PAUSE: Duration = Duration::from_millis(5);
/// Lines that wait to be sent.
const WAITING: usize = 64;

/// The places of computations.
pub struct Computations {
    short: Arc<Semaphore>,
    streams: Arc<Semaphore>,
}

impl Default for Computations {
    fn default() -> Computations {
        let [short, streams] = [MOST_SHORT, MOST_STREAMS].map(|it| Arc::new(Semaphore::new(it)));
        Computations { short, streams }
    }
}

impl Computations {
    /// The answer that a computation gives.
    pub async fn short<T: Send + 'static>(
        &self,
        compute: impl FnOnce() -> Result<T, Refusal> + Send + 'static,
    ) -> Result<T, Refusal> {
        let place = place(&self.short).await?;
        let (send, answer) = oneshot::channel();
        begin(move || {
            // The client may have gone away.
            let _ = send.send(compute());
            drop(place);
        })?;
        answer.await.unwrap_or_else(|_| Err(Refusal::failed("the computation ended early")))
    }

    /// The answer of a computation that sends it line by line, until it returns or nobody listens.
    pub async fn stream(
        &self,
        compute: impl FnOnce(&dyn Fn(String) -> bool) + Send + 'static,
    ) -> Result<Response, Refusal> {
        let place = place(&self.streams).await?;
        let (send, lines) = mpsc::channel::<Bytes>(WAITING);
        begin(move || {
            compute(&|line| sent(&send, Bytes::from(line + "\n")));
            drop(place);
        })?;
        Ok(of(Body::new(Lines(lines)), "application/x-ndjson"))
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

/// A place among the computations, when there is one.
async fn place(places: &Arc<Semaphore>) -> Result<OwnedSemaphorePermit, Refusal> {
    match timeout(LONGEST_WAIT, places.clone().acquire_owned()).await {
        Ok(Ok(place)) => Ok(place),
        _ => {
            let why = "the program is busy with other computations";
            Err(Refusal::with(StatusCode::SERVICE_UNAVAILABLE, why))
        }
    }
}

fn begin(compute: impl FnOnce() + Send + 'static) -> Result<(), Refusal> {
    let begun = thread::Builder::new().stack_size(STACK).spawn(compute);
    begun.map(drop).map_err(|said| Refusal::failed(format!("no thread can be started: {said}")))
}

/// Lines as the body of an answer.
struct Lines(mpsc::Receiver<Bytes>);

impl hyper::body::Body for Lines {
    type Data = Bytes;
    type Error = std::convert::Infallible;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Self::Error>>> {
        self.0.poll_recv(context).map(|line| line.map(|it| Ok(Frame::data(it))))
    }
}
