//! `capsulemap verify`: a random sample of a file's cases computed again, and compared bit for bit.

use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;

use super::arguments::{machine, named};
use super::failure::Failure;
use super::readable::{count, counted};
use super::terminal::{notify, print};
use super::watch::Stages;
use crate::campaign::{Event, Sample, Verified, verify};
use crate::lane::Instructions;
use crate::quantity::printable::printable;

const EXAMPLES: &str = "\
Examples:
  capsulemap verify results/NAME/NAME.h5
  capsulemap verify FILE.h5 --cases 5000 --seed 7 --instructions scalar

What a case has settled to is compared in every number; attractors are numbered by all cases together, and \
are not looked at. Where cases inherit their start along an axis, whole lines of them are computed.";

/// So many differences are shown.
const SHOWN: usize = 10;

/// Compute a random sample of cases again.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Verify {
    /// The file of results.
    file: PathBuf,
    /// Cases to compute, at least; no more than there are.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..))]
    cases: u32,
    /// Which sample to draw; another one each time by default.
    #[arg(long)]
    seed: Option<u64>,
    /// Worker threads; one per core by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Instructions to compute by; the widest that the processor has, or that the sample fills, by default.
    #[arg(long, value_parser = named(&Instructions::NAMES))]
    instructions: Option<Instructions>,
}

impl Verify {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = machine(self.threads, self.instructions)?;
        let seed = self.seed.unwrap_or_else(|| fastrand::u64(..));
        let sample = Sample { cases: self.cases as usize, seed };
        let (shown, stages) = (printable(&self.file), Stages::default());
        let verified = verify(&self.file, sample, machine, &|event| {
            match event {
                Event::OtherProgram { theirs, ours } => {
                    notify(&format!("{shown}: {}", notice(theirs, ours)));
                }
                other => stages.show(other),
            }
            ControlFlow::Continue(())
        })?;
        let cases = counted(verified.cases, "case");
        if verified.cases == 0 {
            let message = format!("{shown}: none of the cases drawn with --seed {seed} is done");
            return Err(Failure::request(message));
        }
        if verified.differences.is_empty() {
            let numbers = count(verified.numbers);
            return print(&format!(
                "{shown}: {cases} drawn with --seed {seed} came out the same in all {numbers} numbers\n"
            ));
        }
        Err(Failure::machine(format!(
            "{shown}: {} of {cases} drawn with --seed {seed} came out otherwise:\n{}",
            counted(verified.differences.len(), "number"),
            differences(&verified)
        )))
    }
}

/// The first differences, and what they may come from.
fn differences(verified: &Verified) -> String {
    let shown = verified.differences.iter().take(SHOWN).map(|it| format!("  {it}\n"));
    let cause = match &verified.other_program {
        Some([theirs, ours]) => notice(theirs, ours),
        None => "the file or a machine is faulty: compute the study again".to_owned(),
    };
    shown.collect::<String>() + &cause
}

/// The remark on a file that another version has written.
fn notice(theirs: &str, ours: &str) -> String {
    format!("was made by {theirs}, this is {ours}")
}
