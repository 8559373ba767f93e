//! Failures of a command, and their exit codes.

use std::fmt;
use std::path::Path;

use super::readable::blocks_kept;
use crate::campaign::{CampaignError, Cause};
use crate::quantity::printable::printable;
use crate::store::StoreError;

/// A command that was not carried out.
#[derive(Debug, Clone)]
pub struct Failure {
    message: String,
    code: u8,
}

impl Failure {
    /// A mistake in what was asked: exit code 2.
    pub fn request(message: impl fmt::Display) -> Self {
        Failure { message: message.to_string(), code: 2 }
    }

    /// A mistake in a file that was given.
    pub fn of_file(path: &Path, fault: impl fmt::Display) -> Self {
        Failure::request(format!("{}: {fault}", printable(path)))
    }

    /// Several mistakes in one message.
    pub fn requests(messages: &[String]) -> Self {
        Failure::request(messages.join("\ncapsulemap: "))
    }

    /// A fault of the machine: exit code 3.
    pub fn machine(message: impl fmt::Display) -> Self {
        Failure { message: message.to_string(), code: 3 }
    }

    /// Several failures in one message; none if there are none. A fault of the machine outweighs.
    pub fn all(failures: Vec<Failure>) -> Option<Self> {
        let code = failures.iter().map(|failure| failure.code).max()?;
        let messages: Vec<String> = failures.into_iter().map(|failure| failure.message).collect();
        Some(Failure { code, ..Failure::requests(&messages) })
    }

    /// The same, with the file that it concerns.
    pub fn within(self, file: &str) -> Self {
        Failure { message: format!("{file}: {}", self.message), ..self }
    }

    /// The program's exit code.
    pub fn exit_code(&self) -> u8 {
        self.code
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl From<CampaignError> for Failure {
    fn from(error: CampaignError) -> Self {
        if let CampaignError::TradeOff { path, faults } = error {
            let path = printable(&path);
            let faults: Vec<String> = faults.iter().map(|it| format!("{path}: {it}")).collect();
            return Failure::requests(&faults);
        }
        let message = format!("{error}{}", advice(&error));
        match error.cause() {
            Cause::Request => Failure::request(message),
            Cause::Machine | Cause::Listener => Failure::machine(message),
        }
    }
}

/// What to do about an error, by the options of the commands.
fn advice(error: &CampaignError) -> String {
    let advice = match error {
        CampaignError::Unreadable { .. } => {
            ": name another --output, or replace it with --overwrite"
        }
        CampaignError::OtherResults { .. } => {
            "; name another --output, or replace it with --overwrite"
        }
        CampaignError::OtherBranches { .. } => {
            "; name another --output, or delete them with --overwrite"
        }
        CampaignError::Store(StoreError::Changed { .. }) => {
            " (name another --output, or delete them with --overwrite)"
        }
        CampaignError::Store(StoreError::Occupied { .. }) => " by --output",
        CampaignError::NoSearches { .. } => "; it stays as it is: move it away",
        CampaignError::OtherSearches { .. } => "; remove it, or begin anew with --overwrite",
        CampaignError::NoFolder { .. } => "; name another --output",
        CampaignError::Refused { .. } => "; choose a place that you may use with --output",
        CampaignError::Missing { .. } => {
            "\nrun `capsulemap sweep` again, or those tasks that failed; --partial joins what \
             there is"
        }
        CampaignError::NotKept { blocks, folder, .. } => {
            return format!(
                "\ncapsulemap: {}",
                blocks_kept(*blocks, &printable(folder).to_string())
            );
        }
        _ => "",
    };
    advice.to_owned()
}
