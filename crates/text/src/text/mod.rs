//! From the characters of a text to a system of the engine.

pub mod content;
mod dependence;
mod entries;
mod events;
mod exact;
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
mod names;
pub mod oscillator;
mod parts;
pub mod program;
mod read;
mod switched;
pub mod system;
mod values;
mod written;

pub use content::Text;
pub use fault::Fault;
pub use read::read;
