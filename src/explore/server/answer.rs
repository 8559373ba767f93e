//! Answers: JSON, pages, bytes, and refusals with their reason.

use std::path::Path;
use std::time::Duration;

use axum::body::Body;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use serde_json::json as object;

use crate::figure::FigureError;
use crate::quantity::printable::printable;
use crate::store::StoreError;

/// The status of what takes too long: a gateway to a computation has waited for it.
const LATE: StatusCode = StatusCode::GATEWAY_TIMEOUT;
/// What browsers call a page.
const HTML: &str = "text/html; charset=utf-8";

/// Why a request is not answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    status: StatusCode,
    why: String,
}

impl Refusal {
    /// A request that does not come from the page.
    pub fn forbidden(why: &str) -> Refusal {
        Refusal { status: StatusCode::FORBIDDEN, why: why.to_owned() }
    }

    /// A request with another status.
    pub fn with(status: StatusCode, why: &str) -> Refusal {
        Refusal { status, why: why.to_owned() }
    }

    /// A request that asks for what cannot be had.
    pub fn unfit(why: impl Into<String>) -> Refusal {
        Refusal { status: StatusCode::BAD_REQUEST, why: why.into() }
    }

    /// An address at which there is nothing.
    pub fn missing() -> Refusal {
        Refusal::with(StatusCode::NOT_FOUND, "there is nothing at this address")
    }

    /// What cannot be drawn.
    pub fn undrawn(why: FigureError) -> Refusal {
        Refusal::unfit(why.to_string())
    }

    /// A computation for which there is no place.
    pub fn busy() -> Refusal {
        let why = "the program is busy with other computations; ask again when they are done";
        Refusal::with(StatusCode::SERVICE_UNAVAILABLE, why)
    }

    /// A computation that takes longer than its budget, with what to do `instead`.
    pub fn late(budget: Duration, instead: &str) -> Refusal {
        let seconds = budget.as_secs();
        let why =
            format!("it takes longer than the {seconds} s that an answer may take; {instead}");
        Refusal { status: LATE, why }
    }

    /// Whether a computation took too long.
    pub fn is_late(&self) -> bool {
        self.status == LATE
    }

    /// Results that cannot be read, most likely because another program has changed them.
    pub fn unread(error: &StoreError) -> Refusal {
        match error {
            StoreError::ChangedSince { path } => Refusal::changed(path),
            error => Refusal::failed(error),
        }
    }

    /// Results whose file another program has changed since it was opened.
    pub fn changed(file: &Path) -> Refusal {
        let why = format!(
            "{} has changed since it was opened, so its numbers are not shown; open it anew here, or stop `capsulemap explore` \
             and start it again",
            printable(file)
        );
        Refusal { status: StatusCode::CONFLICT, why }
    }

    /// A fault of the machine or of the file.
    pub fn failed(why: impl ToString) -> Refusal {
        Refusal { status: StatusCode::INTERNAL_SERVER_ERROR, why: why.to_string() }
    }
}

impl Refusal {
    /// The refusal as the last line of an answer that comes line by line.
    pub fn line(self) -> String {
        object!({ "error": self.why }).to_string()
    }

    /// The refusal as a page, for a person who has typed the address.
    pub fn page(self) -> Response {
        let why = self.why;
        let text = format!(
            "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>capsulemap explore</title>\n\
             <h1>capsulemap explore</h1>\n<p>Not shown: {why}.</p></html>\n"
        );
        let mut answer = bytes(text.into_bytes(), HTML);
        *answer.status_mut() = self.status;
        answer
    }
}

/// A page that sends a browser on to another address.
pub fn redirect(address: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>capsulemap explore</title>\n\
         <meta http-equiv=\"refresh\" content=\"0; url={address}\">\n\
         <p><a href=\"{address}\">capsulemap explore</a></p></html>\n"
    )
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        let mut answer = json(&object!({ "error": self.why }));
        *answer.status_mut() = self.status;
        answer
    }
}

/// An object.
pub fn json(value: &impl Serialize) -> Response {
    // Names of fields and numbers can always be written.
    let text = serde_json::to_vec(value).unwrap_or_default();
    bytes(text, "application/json")
}

/// A page.
pub fn html(text: &'static str) -> Response {
    bytes(text.as_bytes().to_vec(), HTML)
}

/// Bytes of a type.
pub fn bytes(bytes: Vec<u8>, kind: &'static str) -> Response {
    of(Body::from(bytes), kind)
}

/// A body of a type.
pub fn of(body: Body, kind: &'static str) -> Response {
    let mut answer = Response::new(body);
    answer.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
    answer
}
