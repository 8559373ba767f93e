//! Reads the files of an experiment and writes new ones, of which none replaces a file that is there.

use std::path::Path;

use super::failure::Failure;
use crate::experiment::{Column, FileForm, Recording, decoded};
use crate::quantity::printable::printable;
use crate::quantity::{Dimension, parse_quantity};
use crate::store::{self, Pipes};

/// What standard output is called where a file is named.
const STANDARD_OUTPUT: [&str; 4] = ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];

/// The text of a file, or of a pipe that the shell has opened.
pub fn text(path: &Path) -> Result<String, Failure> {
    let shown = printable(path);
    let bytes = store::read_input(path, Pipes::OfShell)
        .map_err(|error| Failure::request(format!("{shown}: cannot be read: {error}")))?;
    decoded(bytes).map_err(|line| {
        let why = "is not text in UTF-8, UTF-16 or Latin-1";
        Failure::request(format!("{shown}: line {line}: {why}"))
    })
}

/// The recording in a file, with the columns that are known.
pub fn recording(path: &Path, known: &[Column], least: usize) -> Result<Recording, Failure> {
    let name = path.to_string_lossy();
    Recording::read(&name, &text(path)?, known, least).map_err(Failure::request)
}

/// The same where options say what form the file has.
pub fn recording_as(
    path: &Path,
    known: &[Column],
    least: usize,
    form: &FileForm,
) -> Result<Recording, Failure> {
    let name = path.to_string_lossy();
    Recording::read_as(&name, &text(path)?, known, least, Some(form)).map_err(Failure::request)
}

/// Whether standard output is asked for in place of a file.
pub fn is_standard_output(path: &Path) -> bool {
    STANDARD_OUTPUT.iter().any(|name| path == Path::new(name))
}

/// Checks that nothing is in the place of a file to be written, or a plain file that may be replaced.
pub fn check_free(path: &Path, overwrite: bool) -> Result<(), Failure> {
    let shown = printable(path);
    if is_standard_output(path) {
        let why = "what the command prints goes to standard output; name a file";
        return Err(Failure::request(format!("{shown}: {why}")));
    }
    store::place(path).map_err(Failure::request)?;
    if overwrite || !path.exists() {
        return Ok(());
    }
    Err(Failure::request(format!(
        "{shown}: exists; name another --output, or replace it with --overwrite"
    )))
}

/// Writes a file, complete or not at all; its folder is made.
pub fn put(path: &Path, text: &str) -> Result<(), Failure> {
    store::create_folder(store::folder(path))
        .and_then(|()| store::put(path, text.as_bytes()))
        .map_err(Failure::machine)
}

/// A quantity that an option was given, with its unit; a plain number where it has none.
pub fn quantity(option: &str, text: &str, dimension: Dimension) -> Result<f64, String> {
    let value = parse_quantity(text, dimension).map_err(|fault| format!("{option}: {fault}"))?;
    match value.is_finite() {
        true => Ok(value),
        false => Err(format!("{option}: {text} is not a finite number")),
    }
}
