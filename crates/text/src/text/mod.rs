//! From the characters of a text to a system of the engine.

pub mod content;
mod dependence;
pub mod derived;
pub mod described;
mod entries;
mod event_names;
mod events;
mod exact;
mod face;
pub mod expression;
pub mod fault;
pub mod function;
pub mod graph;
pub mod instructions;
pub mod interpreter;
pub mod jet;
mod line;
pub mod linear;
mod lowering;
pub mod mode;
pub mod model;
mod names;
pub mod oscillator;
mod parts;
pub mod program;
mod read;
pub mod sums;
mod switched;
mod symbol;
mod tables;
pub mod system;
mod values;
mod written;

pub use content::Text;
pub use fault::Fault;
pub use read::{read, read_in};
