//! Why a motion cannot go on.

use std::fmt;

/// Why a motion cannot go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breakdown {
    /// Events follow each other without time passing.
    NoProgress,
    /// The same, and the last of them is an impact: impacts accumulate.
    Chatter,
    /// The state, or a guard that is watched, is no longer a finite number.
    NotFinite,
    /// An autonomous system does not come back to its section in time.
    NoReturn,
    /// The motion leaves every bound ([`Switched::runs_away`](super::Switched::runs_away)).
    RunsAway,
    /// The computation is to end.
    Stopped,
}

impl fmt::Display for Breakdown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Breakdown::NoProgress => "events follow each other without time passing",
            Breakdown::Chatter => "impacts accumulate, and no contact lasts after them",
            Breakdown::NotFinite => "the state or a guard is no longer a finite number",
            Breakdown::NoReturn => "the motion does not come back to its section",
            Breakdown::RunsAway => "nothing holds the mean force: the motion accelerates for ever",
            Breakdown::Stopped => "the computation was ended early",
        })
    }
}
