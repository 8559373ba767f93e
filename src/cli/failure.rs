//! What the program could not do, and whose fault it was.

use std::fmt;
use std::process::ExitCode;

/// A command that was not carried out.
#[derive(Debug)]
pub struct Failure {
    message: String,
    code: u8,
}

impl Failure {
    /// A mistake in what was asked: exit code 2.
    pub fn request(message: impl fmt::Display) -> Self {
        Failure { message: message.to_string(), code: 2 }
    }

    /// Several mistakes, told together.
    pub fn requests(messages: &[String]) -> Self {
        Failure::request(messages.join("\ncapsulemap: "))
    }

    /// A fault of the machine: exit code 3.
    pub fn machine(message: impl fmt::Display) -> Self {
        Failure { message: message.to_string(), code: 3 }
    }

    /// Several failures told together; none if there are none. A fault of the machine outweighs.
    pub fn all(failures: Vec<Failure>) -> Option<Self> {
        let code = failures.iter().map(|failure| failure.code).max()?;
        let messages: Vec<String> = failures.into_iter().map(|failure| failure.message).collect();
        Some(Failure { code, ..Failure::requests(&messages) })
    }

    /// The same, told of the file it concerns.
    pub fn within(self, file: &str) -> Self {
        Failure { message: format!("{file}: {}", self.message), ..self }
    }

    /// The program's exit code.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(self.code)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}
