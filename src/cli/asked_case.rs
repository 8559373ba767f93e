//! The case that a recording is of: one of a study or of a file of its results.

use std::path::Path;

use super::failure::Failure;
use crate::campaign::{CampaignError, Replay, read_study_or_results};
use crate::capsule::description::CAPSULE;
use crate::description::Description;
use crate::motion::Case;
use crate::orbit::Protocol;
use crate::quantity::printable::printable;

/// Which models a command takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    /// The capsule on even ground.
    Capsule,
    /// That, and oscillators given as text.
    CapsuleAndTexts,
}

/// A case of a study or of a file of its results, and the protocol of the study.
pub fn asked_case(path: &Path, index: usize, takes: Takes) -> Result<(Case, Protocol), Failure> {
    let study = read_study_or_results(path)?;
    let model = study.base.model();
    let is_text = model.equations.is_some();
    if *model.without_own() != CAPSULE && !(is_text && takes == Takes::CapsuleAndTexts) {
        return Err(refused(path, model, takes));
    }
    let replay = Replay::new(&study, index).map_err(|error| match error {
        CampaignError::NoCase { index, cases } => {
            Failure::request(format!("--case {index}: {} has {cases} cases", printable(path)))
        }
        other => other.into(),
    })?;
    Ok((replay.as_asked(), study.protocol))
}

/// Why a study of another model is not taken.
fn refused(path: &Path, model: &Description, takes: Takes) -> Failure {
    let why = match takes {
        Takes::Capsule => {
            "recordings are compared with motions of the capsule alone, on even ground"
        }
        Takes::CapsuleAndTexts => {
            "of the models that the program has, recordings are compared with motions of the capsule alone, on even ground; \
             an oscillator that is given as text has them, too"
        }
    };
    Failure::request(format!("{}: it is about the model {}; {why}", printable(path), model.name))
}
