//! The branches of a study, each followed on a thread of its own, to the same results on any number of them.

use std::fmt;

use super::cases::{RunError, on_all_threads};
use crate::branch::NotFollowed;
use crate::description::Section;
use crate::flow::Reason;
use crate::motion::Case;
use crate::motion::branch::Found;
use crate::of::{model_of, settle_case};
use crate::orbit::{Outcome, Protocol};
use crate::study::{Continuation, FirstOrbit, Study};

/// What came of one branch of a study.
pub type Continued = Result<Found, NotContinued>;

/// Why a branch of a study has no points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NotContinued {
    /// The motion from the start settles to no periodic orbit, but to this.
    Unsettled(Outcome),
    /// No periodic orbit was found near the start.
    NoOrbit,
    /// The motion could not be followed.
    Failed(Reason),
    /// The first orbit belongs to a family of orbits.
    Neutral,
}

impl fmt::Display for NotContinued {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NotContinued::Unsettled(outcome) => write!(
                f,
                "the motion from the start is {}, not periodic; move the start, give it more \
                 `max_cycles`, or look for the orbit with `orbit = \"newton\"`",
                outcome.name()
            ),
            NotContinued::NoOrbit => {
                f.write_str("no periodic orbit was found near the start; give one closer to it")
            }
            NotContinued::Failed(reason) => {
                let name = Reason::NAMES.iter().find(|(known, _)| known == reason);
                let name = name.map_or("", |(_, name)| name);
                write!(f, "the motion could not be followed there ({name})")
            }
            NotContinued::Neutral => f.write_str(
                "the first orbit has a multiplier that cannot be told from one: it belongs to a family of \
                 orbits, as without friction of sliding, or lies in a fold; give it friction or another start",
            ),
        }
    }
}

/// Follows every branch of `study` on so many threads, all cores for none; `done` is told of each, from
/// any thread.
///
/// The results stand in the order of the study and do not depend on the threads.
pub fn continue_branches(
    study: &Study,
    threads: Option<usize>,
    done: impl Fn() + Sync,
) -> Result<Vec<Continued>, RunError> {
    on_all_threads(threads, study.branches.len(), |number| {
        let followed = continue_one(&study.branches[number], &study.protocol);
        done();
        followed
    })
}

fn continue_one(continuation: &Continuation, protocol: &Protocol) -> Continued {
    let (section, period) = match continuation.first {
        FirstOrbit::Settle => settled(continuation, protocol)?,
        FirstOrbit::Newton { period } => (continuation.start.section(), period),
    };
    let request = continuation.request(section, period, protocol.tolerance);
    model_of(&continuation.parameters).follow(&request).map_err(|why| match why {
        // A study has seen to it that the range holds the value, and names parameters of the capsule alone.
        NotFollowed::NoOrbit | NotFollowed::OutOfRange | NotFollowed::NoParameter => {
            NotContinued::NoOrbit
        }
        NotFollowed::Failed(reason) => NotContinued::Failed(reason),
        NotFollowed::Neutral => NotContinued::Neutral,
    })
}

/// A section point and the period of the orbit that the motion settles to.
fn settled(
    continuation: &Continuation,
    protocol: &Protocol,
) -> Result<(Section, u64), NotContinued> {
    let protocol = Protocol { points: 1, impact_points: 0, history: None, ..*protocol };
    let Continuation { start_phase, section_phase, .. } = *continuation;
    let start = continuation.start.clone();
    let parameters = continuation.parameters.clone();
    let case = Case { parameters, start, start_phase, section_phase };
    let orbit = settle_case(&case, &protocol);
    match (orbit.outcome, orbit.section.first(), orbit.failure) {
        (Outcome::Periodic, Some(&section), _) => Ok((section, orbit.period)),
        (_, _, Some(failure)) => Err(NotContinued::Failed(failure.reason)),
        (outcome, _, None) => Err(NotContinued::Unsettled(outcome)),
    }
}
