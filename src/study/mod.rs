//! Asked: what to compute, from a study's file or from code, as cases by index.

pub mod appearance;
pub mod axis;
mod axis_file;
pub mod block;
mod branch_file;
pub mod case_set;
mod compared;
mod conflicts;
pub mod continuation;
mod direction_numbers;
pub mod document;
pub mod drawing;
mod drawing_file;
mod drawing_text;
pub mod draws;
pub mod grid;
mod held_file;
pub mod include;
pub(crate) mod layout;
mod named_model;
pub mod named_system;
mod normal;
pub mod own_outputs;
mod parameter_table;
mod path_file;
mod path_text;
mod protocol_file;
pub mod ramp;
mod ramp_file;
mod refine_file;
pub mod refinement;
pub mod saltelli;
pub mod sobol_points;
mod start_file;
pub mod definition;
mod study_file;
mod study_text;
mod toml_text;
mod unknown_name;
pub(crate) mod without_effect;

pub use appearance::{ColourMap, Colouring, QuantitySettings, ScaleChoice, Setting, Settings};
pub use axis::{Axis, Coordinate, Spacing, Varying};
pub use block::spread;
pub use case_set::CaseSet;
pub use continuation::{Continuation, FirstOrbit};
pub use definition::Study;
pub use document::{Fault, Faults};
pub use drawing::{
    COLOURED_BY, Drawing, DrawingKind, Held, Size, Sweep, Texts, check_panels, free_name,
};
pub use draws::{DrawKind, Draws, Range};
pub use grid::{Direction, Grid, Inherit};
pub use normal::Normal;
pub use ramp::{Beginning, Ramp};
pub use refinement::{Refine, Refinement, Refining};
pub use saltelli::{Member, Saltelli};
