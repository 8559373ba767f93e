//! Computations for the page, so many at once, on threads of their own.

use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::thread;
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::http::StatusCode;
use axum::response::Response;
use hyper::body::Frame;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, mpsc, oneshot};
use tokio::time::timeout;

use super::answer::{Refusal, of};
use crate::orbit::STACK;

/// Computations of one answer at once, and those that answer line by line.
const MOST_SHORT: usize = 2;
const MOST_STREAMS: usize = 1;
/// The longest wait for a place among them.
const PATIENCE: Duration = Duration::from_secs(30);
/// Lines that wait to be sent.
const WAITING: usize = 64;

/// The places of computations.
pub struct Work {
    short: Arc<Semaphore>,
    streams: Arc<Semaphore>,
}

impl Default for Work {
    fn default() -> Work {
        let [short, streams] = [MOST_SHORT, MOST_STREAMS].map(|it| Arc::new(Semaphore::new(it)));
        Work { short, streams }
    }
}

impl Work {
    /// The answer that a computation gives.
    pub async fn short(
        &self,
        work: impl FnOnce() -> Result<Response, Refusal> + Send + 'static,
    ) -> Result<Response, Refusal> {
        let place = place(&self.short).await?;
        let (send, answer) = oneshot::channel();
        let work = move || {
            // Nobody may wait for the answer any more.
            let _ = send.send(work());
            drop(place);
        };
        begin(work)?;
        answer.await.unwrap_or_else(|_| Err(Refusal::failed("the computation ended early")))
    }

    /// The answer of a computation that sends it line by line, until it returns or nobody listens.
    pub async fn stream(
        &self,
        work: impl FnOnce(&dyn Fn(String) -> bool) + Send + 'static,
    ) -> Result<Response, Refusal> {
        let place = place(&self.streams).await?;
        let (send, lines) = mpsc::channel::<Bytes>(WAITING);
        begin(move || {
            work(&|line| send.blocking_send(Bytes::from(line + "\n")).is_ok());
            drop(place);
        })?;
        Ok(of(Body::new(Lines(lines)), "application/x-ndjson"))
    }
}

/// A place among the computations, when there is one.
async fn place(places: &Arc<Semaphore>) -> Result<OwnedSemaphorePermit, Refusal> {
    match timeout(PATIENCE, places.clone().acquire_owned()).await {
        Ok(Ok(place)) => Ok(place),
        _ => {
            let why = "the program is busy with other computations";
            Err(Refusal::with(StatusCode::SERVICE_UNAVAILABLE, why))
        }
    }
}

fn begin(work: impl FnOnce() + Send + 'static) -> Result<(), Refusal> {
    let begun = thread::Builder::new().stack_size(STACK).spawn(work);
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
