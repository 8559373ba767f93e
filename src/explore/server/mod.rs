//! The local server of `capsulemap explore`: a page on the loopback address that shows a file of results and computes motions.

mod access;
mod answer;
mod asked;
mod assets;
mod basin;
mod branches;
mod computations;
mod described;
mod draws;
mod explored;
mod firsts;
mod followed;
mod limits;
mod line;
mod map;
mod motion;
mod private_folder;
mod saved;
mod sensitivity;
mod source;
mod stored_basin;
mod stored_diagram;
mod units;
mod written;

use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::{Path, Query, Request, State};
use axum::http::{HeaderMap, StatusCode};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::{MethodRouter, get};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::sync::Semaphore;

use access::Access;
use answer::{Refusal, html, json};
use asked::Asked;
use basin::Basin;
use branches::LineBranch;
use computations::{Computations, Places};
use explored::Explored;
use line::Line;
use motion::Clicked;
pub use private_folder::PrivateFolder;
pub use source::Source;
use units::Units;
use written::Written;

/// Connections at once; more wait.
const MOST_CONNECTIONS: usize = 64;
/// The longest wait for the head of a request.
const LONGEST_WAIT: Duration = Duration::from_secs(10);
/// The name of the page on the disk that sends a browser to the server.
const REDIRECT: &str = "open.html";
/// The longest head of a request [bytes].
const LONGEST_HEAD: usize = 16 << 10;

/// A server that listens on the loopback address and waits to be run.
pub struct Server {
    listener: TcpListener,
    access: Arc<Access>,
    folder: Arc<PrivateFolder>,
}

/// What every answer is made of.
#[derive(Clone)]
struct Shared {
    source: Arc<Source>,
    access: Arc<Access>,
    folder: Arc<PrivateFolder>,
    computations: Arc<Computations>,
}

/// The parameters of a request.
type Pairs = Query<Vec<(String, String)>>;

impl Server {
    /// Listens on a port of 127.0.0.1, on one that is free for 0; what it keeps while it runs lies in `folder`.
    ///
    /// Fails if the port is taken or the system has no randomness.
    pub fn bind(port: u16, folder: Arc<PrivateFolder>) -> io::Result<Server> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        let access = Arc::new(Access::new(listener.local_addr()?.port())?);
        Ok(Server { listener, access, folder })
    }

    /// Where the page is, with the token that opens it once.
    pub fn address(&self) -> io::Result<String> {
        let address: SocketAddr = self.listener.local_addr()?;
        Ok(format!("http://{address}/open?token={}", self.access.token()))
    }

    /// A page on the disk that sends a browser there, until the token is used: other users of the machine read what programs
    /// are started with, and cannot read this file.
    ///
    /// Fails if it cannot be written.
    pub fn redirect(&self) -> io::Result<PathBuf> {
        self.folder.put(REDIRECT, &answer::redirect(&self.address()?))
    }

    /// Answers requests until the process ends.
    ///
    /// Fails if the system takes the listening socket away.
    pub fn run(self, source: Arc<Source>) -> io::Result<()> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let Server { listener, access, folder } = self;
        let computations = Arc::new(Computations::default());
        let shared = Shared { source, access, folder, computations };
        runtime.block_on(accept(listener, router(shared)))
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
        // An answer is sent at once: what is left of it waits for no acknowledgement.
        let _ = stream.set_nodelay(true);
        let service = TowerToHyperService::new(router.clone());
        tokio::spawn(async move {
            let mut connection = http1::Builder::new();
            connection.timer(TokioTimer::new()).header_read_timeout(LONGEST_WAIT);
            connection.max_buf_size(LONGEST_HEAD);
            // A client that goes away or breaks the protocol ends its own connection alone.
            let _ = connection.serve_connection(TokioIo::new(Written::new(stream)), service).await;
            drop(place);
        });
    }
}

fn router(shared: Shared) -> Router {
    Router::new()
        .route("/", get(page))
        .route("/open", get(open).head(looked_at))
        .route("/page/{name}", get(asset))
        .route("/api/file", get(file))
        .route("/api/anew", get(anew))
        .route("/api/progress", get(progress))
        .route("/api/map", of_file(readings, map::map))
        .route("/api/curves", of_file(readings, map::curves))
        .route("/api/trade-off", of_file(readings, map::trade_off))
        .route("/api/motion", of_file(motions, motion::motion))
        .route("/api/click", get(click))
        .route("/api/draws", of_file(readings, |it, asked| Ok(json(&draws::draws(it, asked)?))))
        .route("/api/diagram", of_file(readings, stored_diagram::diagram))
        .route("/api/stored-basin", of_file(readings, stored_basin::stored_basin))
        .route("/api/sensitivity", of_file(readings, sensitivity::sensitivity))
        .route("/api/figure", get(figure))
        .route("/api/line", get(line))
        .route("/api/branches", get(branches))
        .route("/api/basin", get(basin))
        .fallback(|| async { Refusal::missing() })
        .layer(from_fn_with_state(shared.clone(), guarded))
        .with_state(shared)
}

/// Refuses what does not come from the page, and says to browsers what the page may do.
async fn guarded(State(shared): State<Shared>, request: Request, next: Next) -> Response {
    let answer = match shared.access.check(&request) {
        Ok(()) => next.run(request).await,
        Err(refusal) if request.uri().path() == "/" => refusal.page(),
        Err(refusal) => refusal.into_response(),
    };
    access::with_policy(answer)
}

async fn page() -> Response {
    html(assets::INDEX)
}

/// Gives the browser its cookie for the token; one that has it is sent on to the page.
async fn open(State(shared): State<Shared>, headers: HeaderMap, Query(pairs): Pairs) -> Response {
    if shared.access.knows(&headers) {
        return Redirect::to("/").into_response();
    }
    let opened = shared.access.open(&pairs);
    if opened.is_ok() {
        shared.folder.remove(REDIRECT);
    }
    opened.unwrap_or_else(Refusal::page)
}

/// What HEAD is told of the address with the token, which GET alone uses up.
async fn looked_at() -> StatusCode {
    StatusCode::NO_CONTENT
}

async fn asset(Path(name): Path<String>) -> Result<Response, Refusal> {
    assets::asset(&name).ok_or_else(Refusal::missing)
}

async fn file(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    let (asked, source) = (Asked::new(pairs)?, shared.source.clone());
    shared.computations.readings.answer(move || described_now(&source, &asked)).await
}

/// What the page is told of the file as it is now, and how far its run is.
fn described_now(source: &Source, asked: &Asked) -> Result<Response, Refusal> {
    let (units, running, explored) = (Units::of(asked)?, source.progress(), source.explored()?);
    explored.answer(|it| Ok(json(&described::described(it, &units, running))))
}

/// Opens the file anew, after another program has changed it.
async fn anew(State(shared): State<Shared>) -> Result<Response, Refusal> {
    let source = shared.source.clone();
    let readings = &shared.computations.readings;
    readings.answer(move || source.open_anew().map(|()| json(&true))).await
}

async fn progress(State(shared): State<Shared>) -> Response {
    json(&shared.source.progress())
}

fn motions(computations: &Computations) -> &Places {
    &computations.motions
}

fn readings(computations: &Computations) -> &Places {
    &computations.readings
}

/// Answers with what is computed from the results, in one of these places.
fn of_file(
    places: fn(&Computations) -> &Places,
    answer: fn(&Explored, &Asked) -> Result<Response, Refusal>,
) -> MethodRouter<Shared> {
    get(move |State(shared): State<Shared>, Query(pairs): Pairs| async move {
        let (asked, explored) = (Asked::new(pairs)?, shared.source.explored()?);
        let places = places(&shared.computations);
        places.answer(move || explored.answer(|it| answer(it, &asked))).await
    })
}

async fn figure(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    let (asked, explored) = (Asked::new(pairs)?, shared.source.explored()?);
    let folder = shared.folder.clone();
    let heavy = &shared.computations.heavy;
    heavy.answer(move || explored.answer(|it| saved::figure(it, &asked, folder.path()))).await
}

/// The motion of a case, as a page that is looked at wants it: as soon as there is something to be drawn.
async fn click(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    let (asked, explored) = (Asked::new(pairs)?, shared.source.explored()?);
    let now = explored.clone();
    let motions = &shared.computations.motions;
    let prepare = move || now.answer(|it| Clicked::of(it, &asked));
    let answer = motions.stream(prepare, Clicked::compute).await;
    explored.expect_clicks();
    answer
}

async fn line(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    let (asked, explored) = (Asked::new(pairs)?, shared.source.explored()?);
    let heavy = &shared.computations.heavy;
    heavy.stream(move || explored.answer(|it| Line::of(it, &asked)), Line::compute).await
}

async fn basin(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    let (asked, explored) = (Asked::new(pairs)?, shared.source.explored()?);
    let heavy = &shared.computations.heavy;
    heavy.stream(move || explored.answer(|it| Basin::of(it, &asked)), Basin::compute).await
}

async fn branches(State(shared): State<Shared>, Query(pairs): Pairs) -> Result<Response, Refusal> {
    let (asked, explored) = (Asked::new(pairs)?, shared.source.explored()?);
    let heavy = &shared.computations.heavy;
    let prepare = move || explored.answer(|it| LineBranch::of(it, &asked));
    heavy.stream(prepare, LineBranch::compute).await
}
