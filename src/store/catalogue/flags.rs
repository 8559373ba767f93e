//! The names of the categories, and the numbers that stand for them.

use super::entry::Flags;
use crate::attractor::{BranchEnd, CurveEnd};
use crate::branch::{Codim2Kind, End, SpecialKind};
use crate::description::Description;
use crate::flow::Reason;
use crate::motion;
use crate::orbit::{Outcome, Proof};
use crate::run::{Continued, NotContinued, PairState};
use crate::study::Direction;

/// The number of a branch whose motion does not come back to its section.
const NO_RETURN: i64 = 20;

/// What a case turned out to be.
pub fn outcomes() -> Flags {
    Outcome::ALL.iter().map(|&outcome| (outcome as i64, outcome.name().to_owned())).collect()
}

/// What a motion is with which a ramp begins: one that has settled, or that from the start.
pub fn beginnings() -> Flags {
    std::iter::once((-1, "start".to_owned())).chain(outcomes()).collect()
}

/// Why the integration of a case failed; 0 where it did not.
pub fn reasons(model: &Description) -> Flags {
    let names = motion::reasons(model).into_iter();
    let names = names.map(|(reason, name)| (reason as i64, name.to_owned()));
    std::iter::once((0, "none".to_owned())).chain(names).collect()
}

/// How a period was proven.
pub fn proofs() -> Flags {
    Proof::NAMES.map(|(name, proof)| (proof as i64, name.to_owned())).to_vec()
}

/// The directions in which a start can be inherited.
pub fn directions() -> Flags {
    Direction::ALL.iter().map(|&it| (it as i64, it.name().to_owned())).collect()
}

/// Why a curve on which two basins meet ends.
pub fn curve_ends() -> Flags {
    CurveEnd::ALL.map(|end| (end as i64, end.name().to_owned())).to_vec()
}

/// Why a half of an unstable manifold ends.
pub fn branch_ends() -> Flags {
    BranchEnd::ALL.map(|end| (end as i64, end.name().to_owned())).to_vec()
}

/// What happens at a special point.
pub fn specials() -> Flags {
    SpecialKind::NAMES.map(|(name, kind)| (kind as i64, name.to_owned())).to_vec()
}

/// What happens at a point of codimension 2.
pub fn codim2_kinds() -> Flags {
    Codim2Kind::NAMES.map(|(name, kind)| (kind as i64, name.to_owned())).to_vec()
}

/// The parameters of a model by their symbols.
pub fn parameters(model: &'static Description) -> Flags {
    model.parameters().map(|it| (it.index() as i64, it.symbol().to_owned())).collect()
}

/// Why a branch or a curve ends.
pub fn ends() -> Flags {
    End::NAMES.map(|(name, end)| (end as i64, name.to_owned())).to_vec()
}

/// What asks for a branch.
pub fn request_kinds() -> Flags {
    vec![(0, "branch".to_owned()), (1, "boundary".to_owned())]
}

/// What is known of two neighbours on a map.
pub fn pair_states() -> Flags {
    PairState::NAMES.map(|(name, state)| (state as i64, name.to_owned())).to_vec()
}

/// Whether an orbit is stable.
pub fn stabilities() -> Flags {
    vec![(0, "unstable".to_owned()), (1, "stable".to_owned())]
}

/// The number of what came of a branch.
pub fn result(continued: &Continued) -> i64 {
    match continued {
        Ok(_) => 0,
        // The number of this reason is that of `no-orbit`, which was there before it.
        Err(NotContinued::Failed(Reason::NoReturn)) => NO_RETURN,
        Err(NotContinued::Failed(reason)) => *reason as i64,
        Err(NotContinued::NoOrbit) => 4,
        Err(NotContinued::Neutral) => 6,
        // No outcome in this list has the number zero.
        Err(NotContinued::Unsettled(outcome)) => 6 + *outcome as i64,
    }
}

/// Everything that may come of a branch.
pub fn results(model: &Description) -> Flags {
    let reasons = motion::reasons(model).into_iter();
    let reasons =
        reasons.map(|(reason, name)| (Err(NotContinued::Failed(reason)), name.to_owned()));
    let no_orbit = (Err(NotContinued::NoOrbit), "no-orbit".to_owned());
    let neutral = (Err(NotContinued::Neutral), "neutral".to_owned());
    let unsettled = Outcome::ALL
        .into_iter()
        .filter(|outcome| !matches!(outcome, Outcome::Periodic | Outcome::Failed))
        .map(|outcome| (Err(NotContinued::Unsettled(outcome)), outcome.name().to_owned()));
    let failures = reasons.chain([no_orbit, neutral]).chain(unsettled);
    let followed = std::iter::once((0, "followed".to_owned()));
    followed.chain(failures.map(|(why, name)| (result(&why), name))).collect()
}
