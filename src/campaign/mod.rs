//! Runs of a study to one file of results: computed block by block, resumed, shared among tasks and joined.
//!
//! A [`Campaign`] names a study, the file of its results and what to compute on. `run` computes the blocks that
//! are missing and joins them, `run_with_claims` does so among others at the same time, `join` joins those that tasks have computed, `continue_branches` adds the branches, and
//! `status` reads what is there. [`verify()`] and [`Replay`] compute cases again. Each reports
//! [`Event`]s to a listener, stops when the listener asks for it, and prints nothing.

pub mod answer;
pub mod basin_shares;
pub mod bounding;
pub mod claims;
mod clear;
mod collect;
mod compute;
pub mod conditions;
pub mod conditions_of_draws;
mod beside;
mod continuation;
pub mod count;
pub mod error;
pub mod front_curve;
pub mod in_memory;
mod join;
mod joining;
pub mod kept;
pub mod kept_fronts;
pub mod kept_searches;
mod map_cases;
pub mod margins;
pub mod mean_errors;
pub mod memory;
pub mod motion_row;
pub mod on_disk;
pub mod probe;
pub mod replay;
pub mod refined_front;
pub mod refined_motion;
pub mod refinement_starts;
pub mod report;
pub mod request;
pub mod result_file;
pub mod robustness;
mod search_time;
pub mod sensitivity;
pub mod sobol_indices;
pub mod share;
mod sharing;
mod sought;
pub mod spread;
mod start;
pub mod status;
pub mod study_source;
pub mod tipping;
pub mod tolerance_draws;
pub mod trade_off;
mod until_stopped;
pub mod verify;

pub use answer::{Answer, Named, Refined, Searched};
pub use basin_shares::{WeightedShares, settling_times, weighted_shares};
pub use beside::Beside;
pub use claims::{Abandoned, ClaimStatus, Claims};
pub use error::{CampaignError, Cause};
pub use in_memory::{InMemory, Moment, Snapshot, Wanted, results_in_memory};
pub use kept::Kept;
pub use kept_fronts::KeptFront;
pub use kept_searches::{KeptSearches, searches_path};
pub use margins::{Change, Margin, MarginEnd, Margins};
pub use mean_errors::MeanErrors;
pub use memory::{Memory, memory};
pub use motion_row::{Row, command, quoted};
pub use on_disk::OnDisk;
pub use probe::{Probe, probe};
pub use refined_front::{Refinement, Search};
pub use refined_motion::{DrawnMotion, Led, RefinedMotion, Slopes, Start};
pub use replay::Replay;
pub use report::{Event, Report, Stage, Survey, silent};
pub use request::{BranchesDone, Campaign, Complete, Done};
pub use result_file::{block_path, output_path};
pub use robustness::{Robustness, Tolerances};
pub use sensitivity::{
    NO_DESIGN, OutputSensitivity, Sensitivity, SensitivityAnswer, output_sensitivity,
};
pub use share::Task;
pub use sobol_indices::{NoIndices, Resampling, SobolIndex, SobolIndices, sobol_indices};
pub use status::{BlockStatus, Pace, Status};
pub use study_source::{
    check_names, check_paths, is_system_alone, read_study, read_study_or_results, read_system,
    study_of,
};
pub use tipping::{BasinsAlong, Stepping};
pub use trade_off::{Between, TradeOff};
pub use verify::{Difference, Differs, Sample, Verified, verify};
