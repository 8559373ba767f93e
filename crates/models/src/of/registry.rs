//! The models that studies can name.

use std::fmt::{self, Display, Formatter};
use std::sync::{PoisonError, RwLock};

use capsulemap_engine::orbit::Protocol;

use super::own::with_own;
use super::{AS_PRINTED, FILIPPOV, GENERAL, OVER_FOLDS};
use crate::capsule::description::{CAPSULE, CAPSULE_OVER_FOLDS};
use crate::capsule::{CapsuleParameters as _, Form};
use crate::description::{Description, Parameters};
use crate::model::Model;
use crate::motion::{Case, Orbit};

/// The capsule, by which studies that name no model go, and what it is on other ground.
const OWN: [&Description; 2] = [&CAPSULE, &CAPSULE_OVER_FOLDS];

/// Those beside the capsule, in the order in which they were registered.
static OTHERS: RwLock<Vec<&'static dyn Model>> = RwLock::new(Vec::new());

/// Those that studies do not name.
static UNNAMED: RwLock<Vec<&'static dyn Model>> = RwLock::new(Vec::new());

/// Why a model is not made known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NotRegistered {
    /// A model of this name is there already.
    NameTaken(&'static str),
    /// Its description does not fit together, or not with the system: its name, and all faults.
    Unfit(&'static str, Vec<String>),
}

impl Display for NotRegistered {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            NotRegistered::NameTaken(name) => {
                write!(f, "a model called {name} is registered already")
            }
            NotRegistered::Unfit(name, faults) => {
                write!(f, "the description of the model {name}: {}", faults.join("; "))
            }
        }
    }
}

impl std::error::Error for NotRegistered {}

/// Makes a model known to studies, which name it by `model = "..."`.
///
/// # Errors
/// Where another has its name, or its description does not fit together or not with the system ([`Model::faults`]).
pub fn register(model: &'static dyn Model) -> Result<(), NotRegistered> {
    let description = model.description();
    let faults = model.faults();
    if !faults.is_empty() {
        return Err(NotRegistered::Unfit(description.name, faults));
    }
    let mut others = OTHERS.write().unwrap_or_else(PoisonError::into_inner);
    let mut names = others.iter().map(|it| it.description().name).chain(OWN.map(|it| it.name));
    if names.any(|name| name == description.name) {
        return Err(NotRegistered::NameTaken(description.name));
    }
    others.push(model);
    Ok(())
}

/// Makes a model known that studies do not name, as they have what it is made of; one that is known already stays.
///
/// # Errors
/// Where its description does not fit together, or not with the system.
pub fn make_known(model: &'static dyn Model) -> Result<(), NotRegistered> {
    let faults = model.faults();
    if !faults.is_empty() {
        return Err(NotRegistered::Unfit(model.description().name, faults));
    }
    let mut unnamed = UNNAMED.write().unwrap_or_else(PoisonError::into_inner);
    if unnamed.iter().all(|it| it.description() != model.description()) {
        unnamed.push(model);
    }
    Ok(())
}

/// The models that studies can name, that of studies which name none first.
pub fn all_models() -> Vec<&'static Description> {
    let others = OTHERS.read().unwrap_or_else(PoisonError::into_inner);
    OWN.into_iter().chain(others.iter().map(|it| it.description())).collect()
}

/// The model of this name, if there is one.
pub fn model_called(name: &str) -> Option<&'static Description> {
    all_models().into_iter().find(|it| it.name == name)
}

/// The model of studies that name none.
pub fn default_model() -> &'static Description {
    &CAPSULE
}

/// The model that has these parameters; of a capsule by the form of its equations. With the outputs that a study defines, if
/// the description has such.
///
/// # Panics
/// Where it is not registered.
// Inlined into another crate, it would have the tables of all implementations, and so the lanes, compiled there once more.
#[inline(never)]
pub fn model_of(parameters: &Parameters) -> &'static dyn Model {
    let description = parameters.model();
    if description.own.is_some() {
        return with_own(description, model_of(&parameters.without_own()));
    }
    if OWN.contains(&description) {
        return match parameters.form() {
            Form::Filippov => &FILIPPOV,
            Form::AsPrinted => &AS_PRINTED,
            Form::General => &GENERAL,
            Form::OverFolds => &OVER_FOLDS,
        };
    }
    let found = [&OTHERS, &UNNAMED].into_iter().find_map(|known| {
        let known = known.read().unwrap_or_else(PoisonError::into_inner);
        known.iter().find(|it| it.description() == description).copied()
    });
    found.unwrap_or_else(|| panic!("the model {} is not registered", description.name))
}

/// What a case settles to, see [`Model::settle`].
pub fn settle_case(case: &Case, protocol: &Protocol) -> Orbit {
    model_of(&case.parameters).settle(case, protocol, None)
}
