//! Writes to the terminal: what was asked for to standard output, all else to standard error.

use std::io::Write;

use super::failure::Failure;

/// Prints to standard output; a reader that has gone away is no fault.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::machine(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Tells the person a line; a long run does not stop because nobody listens any more.
pub fn tell(line: &str) {
    // There is nowhere left to report that the line could not be written.
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}
