//! Files of results: writes records with their provenance and reads them back.

mod attribute;
mod attractors;
pub mod block_folder;
mod block_column;
mod block_content;
mod block_source;
mod boundary;
mod branch_columns;
pub mod boundaries;
pub mod branches;
mod ramps;
pub mod catalogue;
pub mod dataset;
mod decode;
mod difference;
mod drawn;
mod element;
mod encode;
mod error;
mod faults;
mod file;
mod flat;
mod gathered;
mod input;
mod join;
mod joined;
mod line_file;
mod lock;
mod manifolds;
mod names;
mod one_case;
mod own_layout;
mod path;
mod plain;
mod slab;
mod superblock;
mod trial;
mod unusable;
pub mod provenance;
mod scale;
pub mod schema;
mod size;
mod candidates;
mod case_table;
mod checksum;
mod claim;
mod columns;
mod watched;
mod words;
mod constraint;
pub mod block_file;

pub use attractors::{add_attractors, add_sample};
pub use attribute::{
    Attribute, TEXT_MEANING, attributes_of, attributes_of_set, constants, constants_beside_cases,
    has_missing, is_of_format,
};
pub use block_content::{block_image, packed_bytes};
pub use block_file::{Summary, Unusable, Written};
pub use block_folder::{BlockFolder, Company, by_outcome};
pub use boundaries::add_boundaries;
pub use branches::{add_branches, drop_branches, has_branches, has_cases, keep_branches};
pub use candidates::{Candidates, candidates, outcome_name, takes_part};
pub use case_table::{CaseTable, Column};
pub use claim::{Claim, HeldClaim, Owner};
pub use constraint::{Comparison, Condition, conditions, fulfils, quantity};
pub use dataset::{Dataset, Values, Variable};
pub use decode::Archive;
pub use difference::difference;
pub use drawn::Design;
pub use element::Element;
pub use error::{StoreError, Unread};
pub use file::{
    create_folder, discard_abandoned, discard_unfinished, folder, hold, open, open_changed, put,
    read, try_to_begin, write,
};
pub use gathered::CaseVariable;
pub use input::{Pipes, open_input, read_input};
pub use join::{Blocks, FailedCase, write_beside_cases};
pub use line_file::{LineFile, Lines, read_lines, sealed, unsealed};
pub use path::{Path, auxiliary, paths, paths_of};
pub use plain::{LONGEST_NAME, NO_TEXT, place};
pub use ramps::add_ramps;
pub use schema::{dataset, frame, numbers_of_case};
pub use size::{file_bytes, refined_file_bytes};
pub use slab::MOST_NUMBERS;
pub use trial::{RUN, Storing, storing};
