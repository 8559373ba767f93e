//! Requests that do not come from the page: each is refused, and the server goes on to answer the page.

use std::io::Write;
use std::net::TcpStream;
use std::time::Duration;

use super::explorer::Explorer;
use super::program::WorkDir;

/// Four cases are enough to be explored.
const STUDY: &str = "[parameters]\nk2 = \"2.42 kN/m\"\ndelta = \"3.5 mm\"\n\
     [[axes]]\nname = \"omega\"\nvalues = [\"60 rad/s\", \"70 rad/s\"]\n\
     [[axes]]\nname = \"p_d\"\nvalues = [\"3 N\", \"4 N\"]\n";

fn explorer(work: &WorkDir) -> Explorer {
    work.put("s.toml", STUDY);
    work.run(&["sweep", "s.toml", "--output", "s.h5", "--no-figures"]).done();
    Explorer::new(work, &["s.h5"])
}

/// Requests with what answers them may have as status; `{port}`, `{cookie}` and `{token}` stand for those of the server.
const HOSTILE: &[(&str, &[u16])] = &[
    // Another host: a page elsewhere whose name leads to this machine.
    ("GET / HTTP/1.1\r\nHost: example.org\r\nCookie: {cookie}\r\n", &[403]),
    ("GET / HTTP/1.1\r\nHost: 127.0.0.1.example.org:{port}\r\nCookie: {cookie}\r\n", &[403]),
    ("GET /api/file HTTP/1.1\r\nHost: 192.168.1.7:{port}\r\nCookie: {cookie}\r\n", &[403]),
    ("GET /api/file HTTP/1.1\r\nHost: 0.0.0.0:{port}\r\nCookie: {cookie}\r\n", &[403]),
    ("GET /api/file HTTP/1.1\r\nHost: \r\nCookie: {cookie}\r\n", &[400, 403]),
    ("GET /api/file HTTP/1.1\r\nCookie: {cookie}\r\n", &[400, 403]),
    (
        "GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nHost: example.org\r\nCookie: {cookie}\r\n",
        &[400],
    ),
    (
        "GET http://example.org/api/file HTTP/1.1\r\nHost: example.org\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    // Another page in the same browser.
    (
        "GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://example.org\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    (
        "GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: null\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    (
        "GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:1\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    (
        "GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nSec-Fetch-Site: cross-site\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    (
        "GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nSec-Fetch-Site: same-site\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    // Another user of the machine, without the token or the cookie.
    ("GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n", &[403]),
    ("GET /api/motion?omega=60&p_d=3 HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n", &[403]),
    ("GET /page/page.js HTTP/1.1\r\nHost: localhost:{port}\r\n", &[403]),
    (
        "GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: capsulemap-{port}=0000\r\n",
        &[403],
    ),
    ("GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: capsulemap-{port}=\r\n", &[403]),
    ("GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: other={token}\r\n", &[403]),
    ("GET /open?token= HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n", &[403]),
    ("GET /open?token=00 HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n", &[403]),
    // The token once more.
    ("GET /open?token={token} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n", &[403]),
    // Paths out of the page.
    ("GET /page/../Cargo.toml HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n", &[404]),
    (
        "GET /page/..%2f..%2fetc%2fpasswd HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n",
        &[404],
    ),
    ("GET /page/%00 HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n", &[404]),
    ("GET /../../etc/passwd HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n", &[404]),
    ("GET //example.org/ HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n", &[400, 404]),
    // Other methods, and bodies.
    (
        "POST /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\nContent-Length: 0\r\n",
        &[405],
    ),
    ("DELETE / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n", &[405]),
    (
        "CONNECT example.org:443 HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n",
        &[400, 403, 404, 405],
    ),
    (
        "GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\nContent-Length: 99999999999\r\n",
        &[413],
    ),
    (
        "GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\nTransfer-Encoding: chunked\r\n",
        &[413],
    ),
    (
        "GET /api/file HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\nContent-Length: -1\r\n",
        &[400],
    ),
    // Names of what is drawn that are none, or lead out.
    (
        "GET /api/diagram?x=../../etc/passwd HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n",
        &[400],
    ),
    (
        "GET /api/stored-basin?x=%00&y=%0d%0aSet-Cookie:x HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n",
        &[400],
    ),
    (
        "GET /api/figure?kind=map&x=omega&y=p_d&limits-x=1e999,-1e999&format=svg HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n",
        &[400],
    ),
    (
        "GET /api/file?units=%27%3b--,mm HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n",
        &[400],
    ),
    (
        "GET /api/sensitivity?of=%ff HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n",
        &[400],
    ),
    // What is no HTTP.
    ("GET /api/file HTTP/9.9\r\nHost: 127.0.0.1:{port}\r\n", &[400, 505]),
    ("\u{0}\u{1}\u{2}\r\n", &[400]),
    (
        "GET /api/motion?omega=%ff%fe HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n",
        &[400],
    ),
];

#[test]
fn hostile_requests_are_refused_and_the_server_lives() {
    let work = WorkDir::new();
    let mut explorer = explorer(&work);
    let fill = |text: &str| {
        let text = text.replace("{port}", &explorer.port.to_string());
        text.replace("{cookie}", &explorer.cookie).replace("{token}", &explorer.token) + "\r\n"
    };
    let secret = explorer.cookie.split('=').nth(1).expect("a value").to_owned();
    for (request, allowed) in HOSTILE {
        let answered =
            explorer.raw(fill(request).replacen("\r\n", "\r\nConnection: close\r\n", 1).as_bytes());
        // A connection that is closed without an answer is a refusal, too, where the request is no HTTP.
        let Some(answered) = answered else {
            assert!(allowed.contains(&400), "{request}: no answer");
            continue;
        };
        assert!(allowed.contains(&answered.status), "{request}: {}", answered.head);
        let told = answered.head.clone() + &answered.text();
        assert!(!told.contains(&secret) && !told.contains(&explorer.token), "{request}");
    }
    // Heads that are too long, and a thousand headers.
    let long =
        format!("GET /api/file?x={} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n", "a".repeat(200_000));
    let many = format!("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n{}\r\n", "X: y\r\n".repeat(1000));
    for request in [long, many] {
        let status = explorer.raw(request.as_bytes()).map_or(400, |it| it.status);
        assert!([400, 403, 414, 431].contains(&status), "{status}");
    }
    // Connections that say nothing, and more of them than are taken at once.
    let idle: Vec<TcpStream> = (0..100)
        .filter_map(|_| TcpStream::connect(("127.0.0.1", explorer.port)).ok())
        .map(|mut it| {
            let _ = it.write_all(b"GET / HTTP/1.1\r\nHost: ");
            it
        })
        .collect();
    std::thread::sleep(Duration::from_millis(100));
    drop(idle);
    // Answers that nobody takes.
    for _ in 0..4 {
        let mut stream = TcpStream::connect(("127.0.0.1", explorer.port)).expect("a connection");
        let request = "GET /api/basin?omega=60&p_d=4 HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n";
        stream.write_all(fill(request).as_bytes()).expect("written");
    }
    assert!(explorer.lives());
    assert_eq!(explorer.object("/api/file")["cases"], 4);
}

/// Heads of requests that no address may answer, with the statuses that refuse them; `{cookie}` is that of the page.
const NO_ACCESS: &[(&str, &[u16])] = &[
    ("GET {address} HTTP/1.1\r\nHost: example.org\r\nCookie: {cookie}\r\n", &[403]),
    (
        "GET {address} HTTP/1.1\r\nHost: 127.0.0.1.example.org:{port}\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    ("GET {address} HTTP/1.1\r\nHost: 0.0.0.0:{port}\r\nCookie: {cookie}\r\n", &[403]),
    ("GET {address} HTTP/1.1\r\nCookie: {cookie}\r\n", &[400, 403]),
    (
        "GET {address} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://example.org\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    (
        "GET {address} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: null\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    (
        "GET {address} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nSec-Fetch-Site: cross-site\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    (
        "GET {address} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nSec-Fetch-Site: same-site\r\nCookie: {cookie}\r\n",
        &[403],
    ),
    ("GET {address} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n", &[403]),
    (
        "GET {address} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: capsulemap-{port}=00\r\n",
        &[403],
    ),
    ("POST {address} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n", &[405]),
    ("PUT {address} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: {cookie}\r\n", &[405]),
];

#[test]
fn no_address_of_the_server_answers_without_access() {
    let work = WorkDir::new();
    let mut explorer = explorer(&work);
    // All that it answers, by its own text, so that none is forgotten here.
    let source = include_str!("../../src/explore/server/mod.rs");
    let routes = source.split(".route(\"").skip(1).filter_map(|it| it.split('"').next());
    let addresses: Vec<String> = routes.map(|it| it.replace("{name}", "page.js")).collect();
    assert!(addresses.len() >= 13, "{addresses:?}");
    let mut checks = 0;
    for address in &addresses {
        for (head, allowed) in NO_ACCESS {
            let request = head.replace("{address}", address);
            let request = request.replace("{port}", &explorer.port.to_string());
            let request = request.replace("{cookie}", &explorer.cookie);
            let sent = request.clone() + "Connection: close\r\n\r\n";
            let answered = explorer.raw(sent.as_bytes()).expect("an answer");
            // An address that cannot be understood without its question is refused for that, too.
            let is_refused =
                allowed.contains(&answered.status) || address == "/open" && answered.status == 400;
            assert!(is_refused, "{request}: {}", answered.head);
            checks += 1;
        }
    }
    println!("{checks} requests without access, all refused");
    assert!(explorer.lives());
}

#[test]
fn every_answer_says_what_the_page_may_do() {
    let work = WorkDir::new();
    let explorer = explorer(&work);
    for address in ["/", "/page/page.js", "/api/file", "/nothing", "/open?token=x"] {
        let answered = explorer.get(address);
        let policy = answered.header("content-security-policy").expect("a policy");
        assert!(policy.starts_with("default-src 'none'; script-src 'self';"), "{policy}");
        assert!(!policy.contains("unsafe") && !policy.contains("http"), "{policy}");
        assert_eq!(answered.header("x-content-type-options"), Some("nosniff"), "{address}");
        assert_eq!(answered.header("referrer-policy"), Some("no-referrer"), "{address}");
        assert_eq!(answered.header("cross-origin-resource-policy"), Some("same-origin"));
        assert_eq!(answered.header("access-control-allow-origin"), None, "{address}");
    }
}

#[test]
fn a_token_opens_the_page_once() {
    let work = WorkDir::new();
    let first = explorer(&work);
    let second = Explorer::unopened(&work, &["s.h5"]);
    assert_ne!(first.token, second.token);
    // The token and the cookie of one server open no other.
    assert_eq!(second.get(&format!("/open?token={}", first.token)).status, 403);
    let opened = second.get(&format!("/open?token={}", second.token));
    assert_eq!((opened.status, opened.header("location")), (303, Some("/")));
    let cookie = opened.header("set-cookie").expect("a cookie");
    assert!(cookie.contains("HttpOnly") && cookie.contains("SameSite=Strict"), "{cookie}");
    assert_eq!(second.get(&format!("/open?token={}", second.token)).status, 403);
    // The browser that has the cookie is sent on to the page, and another is told why it is not.
    let again = first.get(&format!("/open?token={}", first.token));
    assert_eq!((again.status, again.header("location")), (303, Some("/")));
    let refused = second.get("/");
    assert!(refused.status == 403 && refused.text().contains("<p>Not shown: open the address"));
}

#[cfg(unix)]
#[test]
fn a_signal_ends_it_and_leaves_nothing_behind() {
    use std::os::unix::process::ExitStatusExt;
    use std::time::Instant;

    let work = WorkDir::new();
    // Of the blocks of a run that was shared among two tasks one half is there: partial results lie in a file of the server.
    let many = STUDY
        .replace(
            "values = [\"60 rad/s\", \"70 rad/s\"]",
            "from = \"60 rad/s\"\nto = \"70 rad/s\"\npoints = 400",
        )
        .replace("values = [\"3 N\", \"4 N\"]", "from = \"3 N\"\nto = \"4 N\"\npoints = 4");
    work.put("many.toml", many);
    work.run(&["sweep", "many.toml", "--task", "1/2", "--no-figures"]).done();
    std::fs::create_dir(work.path("temporary")).expect("a folder");
    let mut command = work.command(&["explore", "many.toml", "--no-browser"]);
    command.env("TMPDIR", work.path("temporary"));
    let mut explorer = Explorer::begun(command);
    let there = || std::fs::read_dir(work.path("temporary")).expect("a folder").count();
    assert_eq!(there(), 1);
    // That of Ctrl-C is ignored where the tests run in the background of a shell; both have one handler.
    work.shell(&format!("kill -TERM {}", explorer.child.id())).done();
    let asked = Instant::now();
    while explorer.lives() && asked.elapsed() < Duration::from_secs(10) {
        std::thread::sleep(Duration::from_millis(20));
    }
    let status = explorer.child.try_wait().expect("its state");
    assert_eq!((status.and_then(|it| it.signal()), there()), (Some(15), 0));
}
