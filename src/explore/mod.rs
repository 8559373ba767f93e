//! Pages to look at in a browser: the report of a file of results.

mod case_json;
mod computation;
mod escaped;
mod figure_captions;
mod html;
mod numbers;
mod optima;
mod optima_tables;
mod optimum;
mod outcomes;
mod report;
mod request;
mod server;
mod table;

pub use case_json::{case_json, remarks, told};
pub use html::GENERATOR;
pub use report::report;
pub use request::Request;
pub use server::{PrivateFolder, Server, Source};
