//! Writes to the terminal: results to standard output, messages to standard error.

use std::io::Write;

use super::failure::Failure;

/// Prints to standard output; a closed pipe is no fault.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::machine(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a line to standard error; a long run does not stop if it cannot be written.
pub fn notify(line: &str) {
    // A failure to write to standard error cannot be reported.
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}
