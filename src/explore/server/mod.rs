//! The local server of `capsulemap explore`: a page on the loopback address that shows a file of results and computes motions.

mod answer;
mod asked;
mod assets;
mod described;
mod explored;
mod guard;
mod line;
mod map;
mod motion;
mod saved;
mod work;

use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::{Path, Query, Request, State};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::Response;
use axum::routing::get;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::sync::Semaphore;

use answer::{Refusal, html, json};
use asked::Asked;
pub use explored::Explored;
use guard::Guard;
use work::Work;

/// Connections at once; more wait.
const MOST_CONNECTIONS: usize = 64;
/// The longest wait for the head of a request.
const PATIENCE: Duration = Duration::from_secs(10);
/// The longest head of a request [bytes].
const LONGEST_HEAD: usize = 16 << 10;

/// A server that listens on the loopback address and waits to be run.
pub struct Server {
    listener: TcpListener,
    guard: Arc<Guard>,
}

/// What every answer is made of.
#[derive(Clone)]
struct Shared {
    explored: Arc<Explored>,
    guard: Arc<Guard>,
    work: Arc<Work>,
}

/// The parameters of a request.
type Pairs = Query<Vec<(String, String)>>;

impl Server {
    /// Listens on a port of 127.0.0.1; on one that is free for 0.
    ///
    /// Fails if the port is taken or the system has no randomness.
    pub fn bind(port: u16) -> io::Result<Server> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        let guard = Arc::new(Guard::new(listener.local_addr()?.port())?);
        Ok(Server { listener, guard })
    }

    /// Where the page is, with the token that opens it once.
    pub fn address(&self) -> io::Result<String> {
        let address: SocketAddr = self.listener.local_addr()?;
        Ok(format!("http://{address}/open?token={}", self.guard.token()))
    }

    /// Answers requests until the process ends.
    ///
    /// Fails if the system takes the listening socket away.
    pub fn run(self, explored: Explored) -> io::Result<()> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let shared = Shared {
            explored: Arc::new(explored),
            guard: self.guard,
            work: Arc::new(Work::default()),
        };
        runtime.block_on(accept(self.listener, router(shared)))
    }
}

/// Takes connections and answers them, each by itself.
async fn accept(listener: TcpListener, router: Router) -> io::Result<()> {
    let listener = tokio::net::TcpListener::from_std(listener)?;
    let free = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    loop {
        let Ok(place) = free.clone().acquire_owned().await else { return Ok(()) };
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            // A connection that is gone before it is taken, or too many open files: others are still answered.
            Err(_) => {
                tokio::time::sleep(Duration::from_millis(50)).await;
                continue;
            }
        };
        let service = TowerToHyperService::new(router.clone());
        tokio::spawn(async move {
            let mut connection = http1::Builder::new();
            connection.timer(TokioTimer::new()).header_read_timeout(PATIENCE);
            connection.max_buf_size(LONGEST_HEAD);
            // A client that goes away or breaks the protocol ends its own connection alone.
            let _ = connection.serve_connection(TokioIo::new(stream), service).await;
            drop(place);
        });
    }
}

fn router(shared: Shared) -> Router {
    Router::new()
        .route("/", get(page))
        .route("/open", get(open))
        .route("/page/{name}", get(asset))
        .route("/api/file", get(file))
        .route("/api/map", get(map))
        .route("/api/motion", get(motion))
        .route("/api/line", get(line))
        .route("/api/figure", get(figure))
        .fallback(|| async { Refusal::missing() })
        .layer(from_fn_with_state(shared.clone(), guarded))
        .with_state(shared)
}

/// Refuses what does not come from the page, and says to browsers what the page may do.
async fn guarded(State(shared): State<Shared>, request: Request, next: Next) -> Response {
    let answer = match shared.guard.check(&request) {
        Ok(()) => next.run(request).await,
        Err(refusal) => axum::response::IntoResponse::into_response(refusal),
    };
    guard::with_policy(answer)
}

async fn page() -> Response {
    html(assets::INDEX)
}

async fn open(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    shared.guard.open(&pairs)
}

async fn asset(Path(name): Path<String>) -> Result<Response, Refusal> {
    assets::asset(&name).ok_or_else(Refusal::missing)
}

async fn file(State(shared): State<Shared>) -> Result<Response, Refusal> {
    shared.work.short(move || Ok(json(&described::described(&shared.explored)))).await
}

async fn map(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    let asked = Asked::new(pairs)?;
    let explored = shared.explored.clone();
    shared.work.short(move || map::map(&explored, &asked)).await
}

async fn motion(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    let asked = Asked::new(pairs)?;
    let explored = shared.explored.clone();
    shared.work.short(move || Ok(json(&motion::motion(&explored, &asked)?))).await
}

async fn line(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    let asked = Asked::new(pairs)?;
    let line = line::Line::of(&shared.explored, &asked)?;
    let explored = shared.explored.clone();
    shared.work.stream(move |send| line.compute(&explored, send)).await
}

async fn figure(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    let asked = Asked::new(pairs)?;
    let explored = shared.explored.clone();
    shared.work.short(move || saved::figure(&explored, &asked)).await
}
