//! Who may ask: the browser that opened the page by its token, and no other page or user of the machine.

use std::io;
use std::sync::Mutex;

use axum::extract::Request;
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::response::{IntoResponse, Redirect, Response};

use super::answer::Refusal;

/// The longest address of a request [bytes].
const LONGEST_ADDRESS: usize = 8 << 10;
/// Random bytes of a token and of a cookie.
const RANDOM: usize = 32;

/// What the page may load and do: only what comes from this server.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// What is said with every answer.
const SAID: [(&str, &str); 6] = [
    ("content-security-policy", POLICY),
    ("x-content-type-options", "nosniff"),
    ("referrer-policy", "no-referrer"),
    ("cross-origin-opener-policy", "same-origin"),
    ("cross-origin-resource-policy", "same-origin"),
    ("cache-control", "no-store"),
];

/// Knows the token that opens the page, and the cookie of the browser that used it.
pub struct Access {
    token: String,
    /// Whether the token was used.
    is_used: Mutex<bool>,
    cookie: String,
    secret: String,
}

impl Access {
    /// The access to the server on this port. Fails if the system has no randomness.
    pub fn new(port: u16) -> io::Result<Access> {
        let cookie = format!("capsulemap-{port}");
        Ok(Access { token: random()?, is_used: Mutex::new(false), cookie, secret: random()? })
    }

    /// The token that opens the page once.
    pub fn token(&self) -> &str {
        &self.token
    }

    /// Refuses a request that is not one of the page in the browser that opened it.
    pub fn check(&self, request: &Request) -> Result<(), Refusal> {
        let headers = request.headers();
        if request.uri().to_string().len() > LONGEST_ADDRESS {
            return Err(Refusal::with(StatusCode::URI_TOO_LONG, "the address is too long"));
        }
        if request.method() != Method::GET && request.method() != Method::HEAD {
            let status = StatusCode::METHOD_NOT_ALLOWED;
            return Err(Refusal::with(status, "only GET and HEAD are answered"));
        }
        let length = headers.get(header::CONTENT_LENGTH);
        let has_length = length.is_some_and(|it| it.as_bytes() != b"0");
        if has_length || headers.contains_key(header::TRANSFER_ENCODING) {
            let status = StatusCode::PAYLOAD_TOO_LARGE;
            return Err(Refusal::with(status, "a request has no body here"));
        }
        let host = one(headers, "host")?.ok_or_else(|| Refusal::forbidden("no Host is named"))?;
        if !is_here(host) {
            return Err(Refusal::forbidden("the Host is not this machine"));
        }
        if one(headers, "origin")?.is_some_and(|origin| origin != format!("http://{host}")) {
            return Err(Refusal::forbidden("the request comes from another page"));
        }
        let site = one(headers, "sec-fetch-site")?;
        if site.is_some_and(|site| site != "same-origin" && site != "none") {
            return Err(Refusal::forbidden("the request comes from another page"));
        }
        if request.uri().path() != "/open" && !self.knows(headers) {
            return Err(Refusal::forbidden(
                "open the address that `capsulemap explore` has printed; each run of it has another",
            ));
        }
        Ok(())
    }

    /// Whether the browser has the cookie.
    pub fn knows(&self, headers: &HeaderMap) -> bool {
        let cookies = headers.get_all(header::COOKIE).iter();
        let pairs = cookies.filter_map(|it| it.to_str().ok()).flat_map(|it| it.split(';'));
        let own = pairs.filter_map(|pair| pair.trim().split_once('='));
        own.filter(|(name, _)| *name == self.cookie).any(|(_, it)| is_same(it, &self.secret))
    }

    /// Takes the token, once, and gives the browser its cookie.
    pub fn open(&self, pairs: &[(String, String)]) -> Result<Response, Refusal> {
        let given = pairs.iter().find(|(key, _)| key == "token").map_or("", |it| it.1.as_str());
        if !is_same(given, &self.token) {
            return Err(Refusal::forbidden("the token is not that of this server"));
        }
        let mut is_used = self.is_used.lock().unwrap_or_else(|it| it.into_inner());
        if std::mem::replace(&mut *is_used, true) {
            return Err(Refusal::forbidden(
                "the token was used; stop `capsulemap explore` and start it again for another",
            ));
        }
        let cookie = format!("{}={}; Path=/; HttpOnly; SameSite=Strict", self.cookie, self.secret);
        let cookie = HeaderValue::from_str(&cookie).map_err(Refusal::failed)?;
        let mut answer = Redirect::to("/").into_response();
        answer.headers_mut().insert(header::SET_COOKIE, cookie);
        Ok(answer)
    }
}

/// The answer with what browsers are told of the page.
pub fn with_policy(mut answer: Response) -> Response {
    for (name, value) in SAID {
        answer.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    answer
}

/// The only value of a header, if it is there.
fn one<'h>(headers: &'h HeaderMap, name: &str) -> Result<Option<&'h str>, Refusal> {
    let mut all = headers.get_all(name).iter();
    let Some(first) = all.next() else { return Ok(None) };
    match (first.to_str(), all.next()) {
        (Ok(text), None) => Ok(Some(text)),
        _ => Err(Refusal::unfit(format!("the header {name} cannot be read"))),
    }
}

/// Whether a host is the loopback address, at any port: that of a tunnel may be another.
fn is_here(host: &str) -> bool {
    let (name, port) = match host.rsplit_once(':') {
        Some((name, port)) if !name.is_empty() && !port.ends_with(']') => (name, port),
        _ => (host, "0"),
    };
    ["127.0.0.1", "localhost", "[::1]"].contains(&name) && port.parse::<u16>().is_ok()
}

/// Whether two texts are the same, in a time that does not depend on where they differ.
fn is_same(given: &str, known: &str) -> bool {
    let differ = given.bytes().zip(known.bytes()).fold(0, |differ, (a, b)| differ | (a ^ b));
    given.len() == known.len() && differ == 0
}

/// Random hexadecimal digits.
fn random() -> io::Result<String> {
    let mut bytes = [0; RANDOM];
    getrandom::fill(&mut bytes).map_err(|said| io::Error::other(said.to_string()))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hosts_are_those_of_this_machine() {
        for host in ["127.0.0.1", "127.0.0.1:80", "localhost:40123", "[::1]:9", "[::1]"] {
            assert!(is_here(host), "{host}");
        }
        for host in [
            "",
            "example.org",
            "127.0.0.1.example.org",
            "localhost:x",
            "::1",
            "127.0.0.2",
            ":80",
            "[::1",
        ] {
            assert!(!is_here(host), "{host}");
        }
    }

    #[test]
    fn texts_are_the_same_in_whole_alone() {
        assert!(is_same("abc", "abc"));
        assert!(!is_same("ab", "abc") && !is_same("abd", "abc") && !is_same("", "abc"));
    }
}
