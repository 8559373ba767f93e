//! Quantities as models describe them: names, dimensions and units, what they are, and how figures show them.

pub mod allowed;
pub mod dimension;
pub mod printable;
pub mod shown;
pub mod units;

pub use allowed::{Allowed, Bounds};
pub use dimension::Dimension;
pub use shown::{Quantity, Shown};
pub use units::parse_quantity;
