//! Where a command writes the one text that it is for: a file, or standard output.

use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::files;
use super::terminal::{notify, print};
use crate::quantity::printable::printable;

/// A file, or standard output.
pub enum Target {
    /// What `-` and `/dev/stdout` ask for.
    StandardOutput,
    /// A file, whose place has been looked at.
    File(PathBuf),
}

impl Target {
    /// The target that a path asks for.
    ///
    /// Fails where `check` refuses the file.
    pub fn of(
        path: &Path,
        check: impl FnOnce(&Path) -> Result<(), Failure>,
    ) -> Result<Target, Failure> {
        if files::is_standard_output(path) {
            return Ok(Target::StandardOutput);
        }
        check(path)?;
        Ok(Target::File(path.to_owned()))
    }

    /// Writes the text, and shows what is `told` of it: before the name of the file, or beside standard output on standard error.
    pub fn put(&self, text: &str, told: &[String]) -> Result<(), Failure> {
        match self {
            Target::StandardOutput => {
                told.iter().for_each(|line| notify(line));
                print(text)
            }
            Target::File(path) => {
                files::put(path, text)?;
                let told: String = told.iter().map(|line| line.clone() + "\n").collect();
                print(&format!("{told}{}\n", printable(path)))
            }
        }
    }
}
