//! Asked for: connects the floors and talks to the person.

mod block_progress;
mod blocks;
mod branch_summary;
mod dry_run;
mod failure;
mod figure;
mod follow;
mod inspect;
mod join;
mod phases;
mod progress;
mod result_file;
mod simulate;
mod status;
mod stop;
mod summary;
mod sweep;
mod task;
mod verify;
mod words;

use std::io::Write;
use std::process::ExitCode;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{CommandFactory, Parser, Subcommand};
use clap_complete::Shell;

use crate::capsule::Dimension;
use crate::lane::Instructions;
use crate::run::Machine;
use crate::study::parse_quantity;
use failure::Failure;

const EXAMPLES: &str = "\
Examples:
  capsulemap simulate --omega \"77.91 rad/s\" --p-d \"4 N\" --k2 \"2.42 kN/m\" --delta \"3.5 mm\"
  capsulemap sweep studies/overview.toml
  capsulemap status studies/overview.toml
  capsulemap follow branches.toml
  capsulemap inspect results/overview/overview.h5
  capsulemap figure results/overview/overview.h5 --kind map --of work_positive

Exit codes: 0 done; 2 a mistake in what was asked; 3 a fault of the machine (disk, memory); 130 stopped by
Ctrl-C, 143 by a scheduler or `kill`: what is done is kept, and the same command goes on.";

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  capsulemap completions bash > ~/.local/share/bash-completion/completions/capsulemap
  capsulemap completions zsh > ~/.zfunc/_capsulemap
  capsulemap completions fish > ~/.config/fish/completions/capsulemap.fish";

/// Bifurcation and basin mapper for the vibro-impact capsule.
#[derive(Debug, Parser)]
#[command(version, about, after_help = EXAMPLES, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Follow one case in full: section, events, and what it settles to.
    Simulate(Box<simulate::Simulate>),
    /// Compute a study: its cases over all cores, one HDF5 file, and its figures.
    Sweep(sweep::Sweep),
    /// Join the blocks that the tasks of a sweep have computed into one file.
    Join(join::Join),
    /// Say how far a sweep is, from another terminal.
    Status(status::Status),
    /// Compute a random sample of a file's cases again and compare every bit.
    Verify(verify::Verify),
    /// Follow periodic orbits, stable or not, through parameters, and find where they change.
    Follow(follow::Follow),
    /// Draw figures from a file of results.
    Figure(figure::Figure),
    /// Say what is in a file of results.
    Inspect(inspect::Inspect),
    /// Print the completions of a shell.
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// The shell.
        shell: Shell,
    },
}

/// Runs the program on the command line it was started with.
pub fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Simulate(simulate) => simulate.run(),
        Command::Sweep(sweep) => sweep.run(),
        Command::Join(join) => join.run(),
        Command::Status(status) => status.run(),
        Command::Verify(verify) => verify.run(),
        Command::Follow(follow) => follow.run(),
        Command::Figure(figure) => figure.run(),
        Command::Inspect(inspect) => inspect.run(),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "capsulemap", &mut script);
            print(&String::from_utf8_lossy(&script))
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            tell(&format!("capsulemap: {failure}"));
            failure.exit_code()
        }
    }
}

/// Tells the person a line; a night's work does not stop because nobody listens any more.
fn tell(line: &str) {
    // There is nowhere left to report that the line could not be written.
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// What to run on, as far as this machine has it.
fn machine(threads: Option<u16>, instructions: Option<Instructions>) -> Result<Machine, Failure> {
    let granted = || std::env::var("SLURM_CPUS_PER_TASK").ok()?.trim().parse().ok();
    let threads = threads.map(usize::from).or_else(|| granted().filter(|&count: &usize| count > 0));
    let Some(missing) = instructions.filter(|it| !it.is_available()) else {
        return Ok(Machine { threads, instructions });
    };
    let available: Vec<_> = Instructions::available().map(Instructions::name).collect();
    Err(Failure::request(format!(
        "--instructions: this processor has no {} (allowed here: {})",
        missing.name(),
        available.join(", ")
    )))
}

/// Reads one of a few names, which the help then lists.
fn named<T: Copy + Send + Sync + 'static>(
    names: &'static [(&'static str, T)],
) -> impl TypedValueParser<Value = T> {
    let find = |given: &str| names.iter().find(|(name, _)| *name == given).map(|&(_, value)| value);
    PossibleValuesParser::new(names.iter().map(|&(name, _)| name))
        .map(move |given| find(&given).expect("only known names get here"))
}

/// Prints to standard output; a reader that has gone away is no fault.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::machine(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// A quantity on the command line, in SI; a plain number is in SI already, and none is infinite.
fn plain_or_quantity(text: &str, dimension: Dimension) -> Result<f64, String> {
    let plain = text.trim().parse::<f64>();
    let value = plain.or_else(|_| parse_quantity(text, dimension))?;
    if value.is_finite() { Ok(value) } else { Err(format!("{value} is not a finite number")) }
}
