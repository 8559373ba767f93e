//! Turns the cases of a study into records, in parallel, in any order.

pub mod attractor;
pub mod attractor_table;
pub mod block;
pub mod cases;
pub mod final_motion;
pub mod continuation;
pub mod edge;
pub mod forecast;
mod infer;
mod inferred_sample;
mod jump;
pub mod map_point;
pub mod ramp;
mod refined;
mod room;
mod settling;
mod shock;
pub mod shares_along;
mod tipping;

pub use crate::orbit::Machine;
pub use attractor::{AttractorEvent, Attractors, attractors, has_attractors, links};
pub use attractor_table::{AttractorRow, AttractorTable, attractor_table};
pub use block::run_blocks;
pub use cases::{Choice, Record, RunError, on_all_threads, run, run_sample};
pub use continuation::{Continued, NotContinued, continue_branches};
pub use edge::{Edge, edges, has_edges};
pub use final_motion::{FinalMotion, FinalMotions, final_motion, final_motions};
pub use forecast::{Estimate, Forecast};
pub use inferred_sample::{InferredSample, SAMPLE as CHECKED, check_cases, check_starts};
pub use jump::Jump;
pub use map_point::{InferredCases, MapPoint, infer_cases, within};
pub use ramp::{RampPoint, Ramped, follow_ramps};
pub use refined::{TILES_TOGETHER, complete_basin, complete_map, run_tiles};
pub use settling::{QUANTILES, SettledWithin, Settling, SettlingTimes};
pub use shares_along::{SharesAt, shares_along};
pub use tipping::{Step, Steps, Tipping, TippingRow, tipping};
