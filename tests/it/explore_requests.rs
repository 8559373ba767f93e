//! Requests that ask `capsulemap explore` for much, are given up or never read: clicks are answered beside them.

use std::io::Write;
use std::net::TcpStream;
use std::thread;
use std::time::{Duration, Instant};

use super::explorer::{Explorer, coarse_overview};
use super::program::WorkDir;

/// A click is answered in this time [s].
const AT_ONCE: f64 = 1.0;
/// Requests that are given up, and clicks beside them.
const HEAVY: usize = 60;
const CLICKS: usize = 200;
/// After so long without a client the server computes nothing.
const IDLE: Duration = Duration::from_secs(5);

/// The server of a coarse map in which many cases are chaotic.
fn chaotic(work: &WorkDir) -> Explorer {
    work.put("map.toml", coarse_overview([3, 5]));
    work.run(&["sweep", "map.toml", "--output", "map.h5", "--no-figures"]).done();
    Explorer::new(work, &["map.h5"])
}

/// A chaotic case: its basin has 9409 starts, each of which takes thousands of cycles.
const CHAOS: &str = "p_d=2.4545&omega=66.52";

/// Asks for an address on a connection of its own, whose answer is not read.
fn asked(explorer: &Explorer, address: &str) -> TcpStream {
    let mut stream = TcpStream::connect(("127.0.0.1", explorer.port)).expect("a connection");
    let (port, cookie) = (explorer.port, &explorer.cookie);
    let request =
        format!("GET {address} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n\r\n");
    stream.write_all(request.as_bytes()).expect("asked");
    stream
}

/// Time of the processor that the server has taken [ticks of 10 ms].
#[cfg(target_os = "linux")]
fn ticks(explorer: &Explorer) -> u64 {
    let path = format!("/proc/{}/stat", explorer.child.id());
    let told = std::fs::read_to_string(path).expect("it runs");
    let (_, fields) = told.rsplit_once(')').expect("its name");
    // The 14th and the 15th field, of which two stand before.
    let fields: Vec<&str> = fields.split_whitespace().collect();
    fields[11..13].iter().map(|it| it.parse::<u64>().expect("ticks")).sum()
}

/// How long a click waits [s].
fn click(explorer: &Explorer, number: usize) -> f64 {
    let address = match number % 4 {
        0 => "/api/map?of=progression_speed&x=omega&y=p_d".to_owned(),
        _ => format!("/api/motion?p_d=3&omega={}", 40 + number % 30),
    };
    let begun = Instant::now();
    let answered = explorer.get(&address);
    assert_eq!(answered.status, 200, "{address}: {}", answered.text());
    begun.elapsed().as_secs_f64()
}

#[cfg(target_os = "linux")]
#[test]
fn clicks_are_answered_beside_heavy_requests_that_are_given_up() {
    let work = WorkDir::new();
    let explorer = chaotic(&work);
    let heavy = [
        format!("/api/figure?kind=basin&{CHAOS}&format=pdf"),
        format!("/api/basin?{CHAOS}"),
        format!("/api/line?{CHAOS}&to_omega=66.6&count=2000"),
        format!("/api/line?{CHAOS}&to_omega=66.6&count=2000&start=afresh"),
        format!("/api/figure?kind=bifurcation&{CHAOS}&to_omega=66.6&count=2000&format=pdf"),
    ];
    // Without others, a click waits for nothing.
    click(&explorer, 1);
    let longest = thread::scope(|scope| {
        let given_up = scope.spawn(|| {
            let mut random = fastrand::Rng::with_seed(37);
            let mut draw = |most: usize| random.usize(..most);
            for _ in 0..HEAVY {
                let stream = asked(&explorer, &heavy[draw(heavy.len())]);
                let pause = Duration::from_millis(draw(500) as u64);
                scope.spawn(move || {
                    thread::sleep(pause);
                    drop(stream);
                });
                thread::sleep(Duration::from_millis(draw(250) as u64));
            }
        });
        let mut longest: f64 = 0.0;
        for number in 0..CLICKS {
            longest = longest.max(click(&explorer, number));
            // The clicks last as long as the others.
            thread::sleep(Duration::from_millis(40));
        }
        given_up.join().expect("all are given up");
        longest
    });
    assert!(longest < AT_ONCE, "a click took {longest} s");
    thread::sleep(IDLE);
    let before = ticks(&explorer);
    thread::sleep(Duration::from_secs(1));
    let taken = ticks(&explorer) - before;
    assert!(taken <= 2, "{taken} ticks of the processor in a second without a client");
}

#[test]
fn a_motion_is_bounded_and_says_where_it_ends() {
    let work = WorkDir::new();
    let explorer = chaotic(&work);
    // Of a slow drive: each cycle has hundreds of events.
    let address = "/api/motion?omega=0.5&p_d=5&cycles=400";
    let answered = explorer.get(address);
    assert_eq!(answered.status, 200, "{}", answered.text());
    assert!(answered.body.len() < 4_000_000, "{} bytes", answered.body.len());
    let told: serde_json::Value = serde_json::from_slice(&answered.body).expect("JSON");
    let sections = told["simulate"]["section"].as_array().expect("a list").len();
    let remarks = told["remarks"].to_string();
    let ends = format!("end after {} of 400 cycles", sections - 1);
    assert!(sections > 1 && sections < 400 && remarks.contains(&ends), "{remarks}");
}

/// A periodic case, in a study that follows chaotic ones for a thousand million cycles.
const PATIENT: &str = r#"
[parameters]
c = "0.44 N s/m"
mu_s = 0.437
mu_d = 0.2185
k2 = "86.8 kN/m"
delta = "2.45 mm"
omega = "60 rad/s"
p_d = "3 N"
[protocol]
max_cycles = 1000000000
max_steps = 1000000000000
"#;

#[test]
fn a_motion_that_takes_too_long_is_refused_with_the_command_that_has_no_limit() {
    let work = WorkDir::new();
    work.put("patient.toml", PATIENT);
    work.run(&["sweep", "patient.toml", "--output", "patient.h5", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["patient.h5"]);
    let begun = Instant::now();
    let refused = explorer.get(&format!("/api/motion?{CHAOS}&cycles=400"));
    assert_eq!(refused.status, 504, "{}", refused.text());
    let told = refused.text();
    assert!(told.contains("longer than the 10 s") && told.contains("--cycles 400"), "{told}");
    assert!(begun.elapsed() < Duration::from_secs(30), "{:?}", begun.elapsed());
}

#[test]
fn more_heavy_requests_than_can_wait_are_refused_at_once() {
    let work = WorkDir::new();
    let explorer = chaotic(&work);
    let basin = format!("/api/basin?{CHAOS}");
    let waiting: Vec<TcpStream> = (0..10).map(|_| asked(&explorer, &basin)).collect();
    thread::sleep(Duration::from_millis(300));
    let begun = Instant::now();
    let refused = explorer.get(&basin);
    assert_eq!(refused.status, 503, "{}", refused.text());
    assert!(refused.text().contains("busy with other computations"), "{}", refused.text());
    assert!(click(&explorer, 1) < AT_ONCE && begun.elapsed().as_secs_f64() < 2.0 * AT_ONCE);
    drop(waiting);
}

#[test]
fn clients_that_never_read_do_not_keep_the_connections() {
    let work = WorkDir::new();
    let explorer = chaotic(&work);
    let (port, cookie) = (explorer.port, &explorer.cookie);
    let request = format!(
        "GET /api/motion?p_d=3&omega=60 HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n\r\n"
    );
    // As many as the server takes at once, each of which asks for some megabytes.
    let never_read: Vec<TcpStream> = (0..64)
        .map(|_| {
            let mut stream = TcpStream::connect(("127.0.0.1", port)).expect("a connection");
            stream.set_write_timeout(Some(Duration::from_millis(50))).expect("a limit");
            let _ = stream.write_all(request.repeat(100).as_bytes());
            stream
        })
        .collect();
    thread::sleep(Duration::from_secs(1));
    let begun = Instant::now();
    let answered = explorer.get("/api/motion?p_d=3&omega=61");
    assert_eq!(answered.status, 200, "{}", answered.text());
    let waited = begun.elapsed();
    assert!(waited < Duration::from_secs(30), "{waited:?}");
    drop(never_read);
}
