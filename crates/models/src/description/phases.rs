//! The phases of a drive, which every model with a drive has.

use crate::quantity::shown::shown;
use crate::quantity::{Dimension, Quantity};

/// The phase of the drive at the start.
pub const START_PHASE: Quantity = Quantity {
    name: "start_phase",
    dimension: Dimension::Angle,
    meaning: "phase of the drive at the start",
    shown: shown("Initial phase", "*φ*", "rad", 1.0),
};

/// The phase of the drive at the stroboscopic section.
pub const SECTION_PHASE: Quantity = Quantity {
    name: "section_phase",
    dimension: Dimension::Angle,
    meaning: "phase of the drive at the stroboscopic section",
    shown: shown("Section phase", "*φ*_{s}", "rad", 1.0),
};
