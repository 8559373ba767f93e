//! `capsulemap explore` as a browser meets it: the server in a process of its own, and plain HTTP requests to it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use serde_json::Value;

use super::program::WorkDir;

/// The study of a coarse map of the overview's capsule, with periodic and chaotic cases, of so many forces and frequencies.
pub fn coarse_overview([forces, frequencies]: [usize; 2]) -> String {
    format!(
        r#"
title = "Coarse overview"
[parameters]
c = "0.44 N s/m"
mu_s = 0.437
mu_d = 0.2185
k2 = "86.8 kN/m"
delta = "2.45 mm"
[[axes]]
name = "p_d"
from = "1 N"
to = "5 N"
points = {forces}
[[axes]]
name = "omega"
from = "30 rad/s"
to = "100 rad/s"
points = {frequencies}
[start]
inherit = "omega"
[protocol]
max_cycles = 1000
"#
    )
}

/// A server that is stopped with the test.
pub struct Explorer {
    /// Its process.
    pub child: Child,
    /// Its port.
    pub port: u16,
    /// The one-time token that it has printed.
    pub token: String,
    /// The cookie of the browser that used the token.
    pub cookie: String,
}

/// An answer.
pub struct Answered {
    /// Its status.
    pub status: u16,
    /// Its head, as it came.
    pub head: String,
    /// Its body.
    pub body: Vec<u8>,
}

/// A map or another answer in binary: its head, and what follows.
pub struct Packed {
    /// The head.
    pub head: Value,
    /// The bytes after it.
    pub rest: Vec<u8>,
}

impl Explorer {
    /// The server of `arguments`, whose page no browser has opened.
    pub fn unopened(work: &WorkDir, arguments: &[&str]) -> Explorer {
        Explorer::begun(work.command(&[&["explore", "--no-browser"], arguments].concat()))
    }

    /// The server that a command starts, whose page no browser has opened.
    pub fn begun(mut command: Command) -> Explorer {
        let mut child = command.stdout(Stdio::piped()).spawn().expect("starts");
        let mut address = String::new();
        let out = child.stdout.take().expect("standard output");
        BufReader::new(out).read_line(&mut address).expect("an address");
        let (_, place) = address.trim().split_once("127.0.0.1:").expect("on the loopback address");
        let (port, token) = place.split_once("/open?token=").expect("a token");
        let (port, token) = (port.parse().expect("a port"), token.to_owned());
        Explorer { child, port, token, cookie: String::new() }
    }

    /// The server of `arguments`, opened.
    pub fn new(work: &WorkDir, arguments: &[&str]) -> Explorer {
        Explorer::unopened(work, arguments).opened()
    }

    /// The same, opened.
    pub fn opened(self) -> Explorer {
        let mut explorer = self;
        let opened = explorer.get(&format!("/open?token={}", explorer.token));
        assert_eq!(opened.status, 303, "{}", opened.head);
        let cookie = opened.header("set-cookie").expect("a cookie");
        explorer.cookie = cookie.split(';').next().expect("a pair").to_owned();
        explorer
    }

    /// The answer to a request as a browser makes it.
    pub fn get(&self, address: &str) -> Answered {
        let port = self.port;
        let mut request =
            format!("GET {address} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n");
        if !self.cookie.is_empty() {
            request += &format!("Cookie: {}\r\n", self.cookie);
        }
        self.raw((request + "\r\n").as_bytes()).expect("an answer")
    }

    /// The JSON object at an address.
    pub fn object(&self, address: &str) -> Value {
        let answered = self.get(address);
        assert_eq!(answered.status, 200, "{address}: {}", answered.text());
        serde_json::from_slice(&answered.body).expect("JSON")
    }

    /// The objects that come line by line.
    pub fn lines(&self, address: &str) -> Vec<Value> {
        let answered = self.get(address);
        assert_eq!(answered.status, 200, "{address}: {}", answered.text());
        answered.text().lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
    }

    /// The map or the trade-off at an address.
    pub fn packed(&self, address: &str) -> Packed {
        let Answered { status, body, .. } = self.get(address);
        assert_eq!(status, 200, "{address}: {}", String::from_utf8_lossy(&body));
        let length = u32::from_le_bytes(body[..4].try_into().expect("four bytes")) as usize;
        let head = serde_json::from_slice(&body[4..4 + length]).expect("JSON");
        Packed { head, rest: body[4 + length..].to_vec() }
    }

    /// What comes back for these bytes; none where the connection was closed without an answer.
    pub fn raw(&self, request: &[u8]) -> Option<Answered> {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
        stream.set_read_timeout(Some(Duration::from_secs(60))).expect("a limit");
        // The server may close before all is written.
        let _ = stream.write_all(request);
        let mut all = Vec::new();
        let _ = stream.read_to_end(&mut all);
        let end = all.windows(4).position(|it| it == b"\r\n\r\n")?;
        let head = String::from_utf8_lossy(&all[..end]).into_owned();
        let status = head.split(' ').nth(1)?.parse().ok()?;
        let body = all[end + 4..].to_vec();
        let is_chunked = head.to_ascii_lowercase().contains("transfer-encoding: chunked");
        let body = if is_chunked { unchunked(&body) } else { body };
        Some(Answered { status, head, body })
    }

    /// Whether the server still runs.
    pub fn lives(&mut self) -> bool {
        self.child.try_wait().expect("its state").is_none()
    }
}

impl Drop for Explorer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Answered {
    /// The value of a header.
    pub fn header(&self, name: &str) -> Option<&str> {
        let pairs = self.head.lines().filter_map(|line| line.split_once(": "));
        pairs.into_iter().find(|pair| pair.0.eq_ignore_ascii_case(name)).map(|pair| pair.1)
    }

    /// Its body as text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }
}

impl Packed {
    /// Its numbers from the byte `from` on, so many.
    pub fn numbers(&self, from: usize, count: usize) -> Vec<f32> {
        let bytes = self.rest[from..from + 4 * count].chunks_exact(4);
        bytes.map(|it| f32::from_le_bytes(it.try_into().expect("four bytes"))).collect()
    }
}

/// A body that came in chunks.
fn unchunked(mut rest: &[u8]) -> Vec<u8> {
    let mut body = Vec::new();
    while let Some(end) = rest.windows(2).position(|it| it == b"\r\n") {
        let length = std::str::from_utf8(&rest[..end]).expect("a length");
        let length = usize::from_str_radix(length, 16).expect("a length");
        let begin = end + 2;
        body.extend(&rest[begin..(begin + length).min(rest.len())]);
        rest = rest.get(begin + length + 2..).unwrap_or_default();
    }
    body
}
