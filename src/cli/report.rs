//! `capsulemap report`: a file of results as one page for a browser.

use std::path::{Path, PathBuf};

use clap::Args;

use super::arguments::{cost, gain, held};
use super::failure::Failure;
use super::target::Target;
use crate::explore::{GENERATOR, Request, report};
use crate::quantity::printable::printable;
use crate::store::{self, Archive};
use crate::tradeoff::GainAndCost;

const EXAMPLES: &str = "\
Examples:
  capsulemap report results/overview/overview.h5
  capsulemap report FILE.h5 --of work_positive --output for-a-colleague.html
  capsulemap report FILE.h5 --of work --for amplitude

The page is in the order of a paper's supplement: abstract, contents, what was computed, outcomes, figures of the study, optima with \
their motions, how to compute all of it again, provenance and citation. Its tables sort and can be copied, and it prints on A4. \
It needs no network and no other file. Motions between the cases are those that `capsulemap tradeoff \
--refine` has found.";

/// Write what a file of results says as one HTML page.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Report {
    /// The file of results.
    file: PathBuf,
    /// The output that should be small: an energy per cycle, one over a distance or another; of the capsule the power by default.
    #[arg(long, value_name = "OUTPUT")]
    of: Option<String>,
    /// The output that should be large, in either direction; of the capsule the progression speed by default.
    #[arg(long = "for", value_name = "OUTPUT")]
    gain: Option<String>,
    /// The page; beside the file of results, with its name, by default.
    #[arg(long, value_name = "FILE.html")]
    output: Option<PathBuf>,
    /// Replace a file in the place of the page that is no page of this program.
    #[arg(long)]
    overwrite: bool,
}

impl Report {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let archive = store::open(&self.file).map_err(Failure::request)?;
        let of = self.outputs(&archive)?;
        let page = self.output.clone().unwrap_or_else(|| self.file.with_extension("html"));
        let target = Target::of(&page, |page| self.check(page))?;
        target.put(&report(&Request { archive: &archive, file: &self.file, of })?, &[])
    }

    /// The gain and the cost.
    fn outputs(&self, archive: &Archive) -> Result<GainAndCost, Failure> {
        let found = (gain(archive, self.gain.as_deref()), cost(archive, self.of.as_deref()));
        match found {
            (Ok(gain), Ok(cost)) => held(gain, cost).map_err(Failure::request),
            (gain, cost) => {
                let faults: Vec<String> = cost.err().into_iter().chain(gain.err()).collect();
                Err(Failure::requests(&faults))
            }
        }
    }

    /// Refuses to replace what this program has not written.
    fn check(&self, page: &Path) -> Result<(), Failure> {
        let page = &store::place(page).map_err(Failure::request)?;
        match std::fs::read(page) {
            Err(said) if said.kind() == std::io::ErrorKind::NotFound => Ok(()),
            Ok(_) if self.overwrite => Ok(()),
            Ok(bytes) if String::from_utf8_lossy(&bytes).contains(GENERATOR) => Ok(()),
            _ => Err(Failure::request(format!(
                "{}: exists and is no report of this program; name another --output, or replace it with --overwrite",
                printable(page)
            ))),
        }
    }
}
