//! Pages to look at in a browser: the report of a file of results.

mod html;
mod numbers;
mod optima;
mod optimum;
mod report;
mod request;

pub use html::GENERATOR;
pub use report::report;
pub use request::Request;
