//! `capsulemap new`: a study to begin with.

use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::files;
use super::terminal::print;
use crate::campaign::quoted;
use crate::quantity::printable::printable;

/// A study of the capsule.
const CAPSULE: &str = include_str!("templates/capsule.toml");
/// A study of another oscillator.
const SYSTEM: &str = include_str!("templates/system.toml");

const EXAMPLES: &str = "\
Examples:
  capsulemap new gap.toml
  capsulemap new --system wall.toml";

/// Write a study to begin with, whose comments say what may be changed.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct New {
    /// The study to write, a TOML file that is not there yet.
    study: PathBuf,
    /// Of an oscillator of your own, whose equations stand in the study, in place of the capsule.
    #[arg(long)]
    system: bool,
}

impl New {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        files::check_free(&self.study, false)?;
        files::put(&self.study, if self.system { SYSTEM } else { CAPSULE })?;
        let file = quoted(&self.study.to_string_lossy());
        print(&format!("{}: written; next: capsulemap check {file}\n", printable(&self.study)))
    }
}
