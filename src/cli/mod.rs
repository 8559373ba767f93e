//! The command line: one file per command, messages and progress.

mod appearance;
mod arguments;
mod asked_case;
mod attractor_list;
mod basin_list;
mod asked_density;
mod block_progress;
mod book;
mod boundary_summary;
mod branch_summary;
mod check;
mod claim_text;
mod compare;
mod compare_report;
mod continuation;
mod drawing;
mod dry_run;
mod experiment_figures;
mod explore;
mod failure;
mod figure;
mod files;
mod fit;
mod fit_report;
mod help;
mod identify;
mod identify_report;
mod inspect;
mod join;
mod manifold_list;
mod new;
mod optima_csv;
mod optima_json;
mod optima_notes;
mod optima_text;
mod phases;
mod progress;
mod ramp_summary;
mod readable;
mod rehearsal;
mod recording_form;
mod report;
mod scheduler;
mod sensitivity;
mod sensitivity_text;
mod simulate;
mod simulation_text;
mod smooth;
mod status;
mod stop;
mod summary;
mod synthesize;
mod sweep;
mod target;
mod terminal;
mod text_compare;
mod tipping;
mod tradeoff;
mod varied;
mod verify;
mod watch;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use clap_complete::Shell;

use failure::Failure;
use terminal::{flush, notify, print};

use crate::store::provenance;

const EXAMPLES: &str = "\
Examples:
  capsulemap simulate --omega \"77.91 rad/s\" --p-d \"4 N\" --delta \"3.5 mm\"
  capsulemap sweep studies/overview.toml
  capsulemap status studies/overview.toml
  capsulemap continue branches.toml
  capsulemap inspect results/overview/overview.h5
  capsulemap figure FILE.h5 --kind map --of work_positive

Exit codes: 0 done; 2 a mistake in what was asked; 3 a fault of the machine (disk, memory); 130 stopped by \
Ctrl-C, 143 by a scheduler or `kill`: what is done is kept, and the same command resumes.";

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  capsulemap completions bash \\
    > ~/.local/share/bash-completion/completions/capsulemap
  capsulemap completions zsh > ~/.zfunc/_capsulemap
  capsulemap completions fish > ~/.config/fish/completions/capsulemap.fish";

/// Bifurcation and basin mapper for the vibro-impact capsule.
#[derive(Debug, Parser)]
#[command(version, about, after_help = EXAMPLES, max_term_width = 100, disable_help_subcommand = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Write a study to begin with, of the capsule or of an oscillator of your own.
    New(new::New),
    /// Say what is wrong in a study or a system, or what follows from it.
    Check(check::Check),
    /// Compute one case in full: section, events, and what it settles to.
    Simulate(Box<simulate::Simulate>),
    /// Compute a study: its cases over all cores, one HDF5 file, and its figures.
    Sweep(sweep::Sweep),
    /// Join the blocks that the tasks of a sweep have computed into one file.
    Join(join::Join),
    /// Say how far a sweep is, from another terminal.
    Status(status::Status),
    /// Compute a random sample of a file's cases again and compare every bit.
    Verify(verify::Verify),
    /// Continue periodic orbits, stable or not, in parameters, and find where they change.
    #[command(visible_alias = "follow")]
    Continue(continuation::Continue),
    /// Draw figures from a file of results.
    Figure(Box<figure::Figure>),
    /// Find the fastest motions for the least energy in a file of results, or the most of one output for the least of another.
    Tradeoff(tradeoff::Tradeoff),
    /// Find the attractors that orbits left behind by a step of the parameter lead to.
    Tipping(tipping::TippingOptions),
    /// Find which of the quantities that are drawn the variance of outputs comes from: Sobol indices of a file of results.
    Sensitivity(sensitivity::Sensitivity),
    /// Write what a file of results says as one page for a browser.
    Report(report::Report),
    /// Look at a file of results in the browser: click a cell of a map, see its motion.
    Explore(explore::Explore),
    /// Say what is in a file of results.
    Inspect(inspect::Inspect),
    /// Find constants of a rig from recordings of simple tests.
    Identify(identify::Identify),
    /// Smooth and differentiate the signals of a recording.
    Smooth(smooth::Smooth),
    /// Fit parameters to recorded histories of the motion.
    Fit(fit::Fit),
    /// Compare a recording with the simulation of the same case.
    Compare(compare::Compare),
    /// Make recordings of a rig from a simulation, with noise and sampling as stated.
    Synthesize(synthesize::Synthesize),
    /// Print the help of a command, or what the book says of keys of a study, outputs and units.
    Help(help::Help),
    /// Print the completions of a shell.
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// The shell.
        shell: Shell,
    },
}

/// Runs the program, built from this commit, on the command line it was started with.
pub fn main(commit: &'static str) -> ExitCode {
    ExitCode::from(run(commit, std::env::args_os()))
}

/// Runs the program, built from this commit, on these words, of which the first names the program; returns the exit code.
pub fn run(commit: &'static str, words: impl IntoIterator<Item = OsString>) -> u8 {
    provenance::built_from(commit);
    let command = Arguments::parse_from(words).command;
    let done = provenance::given_time().map_err(|text| {
        let expected = "expected a whole number of seconds since 1970";
        Failure::request(format!("SOURCE_DATE_EPOCH = \"{text}\" in the environment: {expected}"))
    });
    let done = done.and_then(|_| match command {
        Command::New(new) => new.run(),
        Command::Check(check) => check.run(),
        Command::Simulate(simulate) => simulate.run(),
        Command::Sweep(sweep) => sweep.run(),
        Command::Join(join) => join.run(),
        Command::Status(status) => status.run(),
        Command::Verify(verify) => verify.run(),
        Command::Continue(continuation) => continuation.run(),
        Command::Figure(figure) => figure.run(),
        Command::Tradeoff(tradeoff) => tradeoff.run(),
        Command::Tipping(tipping) => tipping.run(),
        Command::Sensitivity(sensitivity) => sensitivity.run(),
        Command::Report(report) => report.run(),
        Command::Explore(explore) => explore.run(),
        Command::Inspect(inspect) => inspect.run(),
        Command::Identify(identify) => identify.run(),
        Command::Smooth(smooth) => smooth.run(),
        Command::Fit(fit) => fit.run(),
        Command::Compare(compare) => compare.run(),
        Command::Synthesize(synthesize) => synthesize.run(),
        Command::Help(help) => help.run(Arguments::command()),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "capsulemap", &mut script);
            print(&String::from_utf8_lossy(&script))
        }
    });
    let code = match done {
        Ok(()) => 0,
        Err(failure) => {
            notify(&format!("capsulemap: {failure}"));
            failure.exit_code()
        }
    };
    flush();
    code
}
