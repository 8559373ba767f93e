//! `capsulemap verify`: a random sample of a file's cases computed again, and compared bit for bit.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::Args;

use super::progress::Progress;
use super::words::{count, counted};
use super::{Failure, machine, named, print, tell};
use crate::lane::Instructions;
use crate::run::{Machine, Record, run_sample};
use crate::store::catalogue::{OUTCOME, STUDY_TEXT};
use crate::store::{self, Archive, provenance};
use crate::study::Study;

const EXAMPLES: &str = "\
Examples:
  capsulemap verify results/night/night.h5
  capsulemap verify results/night/night.h5 --cases 5000 --seed 7 --instructions scalar

What a case has settled to is compared in every number; attractors are numbered by all cases together, and
are not looked at. Where cases are followed along an axis, whole lines of them are computed.";

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
        let archive = store::open(&self.file).map_err(Failure::request)?;
        let shown = self.file.display();
        if !archive.has_cases() {
            return Err(Failure::request(format!("{shown}: holds no cases of a sweep")));
        }
        let text = archive.frame().texts.get(STUDY_TEXT).map_or("", String::as_str);
        let study =
            Study::parse(&format!("the study in {shown}"), text).map_err(Failure::request)?;
        let notice = versions(&archive);
        notice.iter().for_each(|notice| tell(&format!("{shown}: {notice}")));
        let seed = self.seed.unwrap_or_else(|| fastrand::u64(..));
        let chains = sample(&study, self.cases as usize, seed);
        let compared = compare(&study, machine, &archive, &chains)?;
        let cases = counted(compared.cases, "case");
        if compared.cases == 0 {
            let message = format!("{shown}: none of the cases drawn with --seed {seed} is done");
            return Err(Failure::request(message));
        }
        if compared.differences.is_empty() {
            let numbers = count(compared.numbers);
            return print(&format!(
                "{shown}: {cases} drawn with --seed {seed} came out the same in all {numbers} numbers\n"
            ));
        }
        let differences: Vec<String> =
            compared.differences.iter().take(SHOWN).map(|it| format!("  {it}")).collect();
        Err(Failure::machine(format!(
            "{shown}: {} of {cases} drawn with --seed {seed} came out otherwise:\n{}\n{}",
            counted(compared.differences.len(), "number"),
            differences.join("\n"),
            notice.unwrap_or_else(|| {
                "the file or a machine is faulty: compute the study again".to_owned()
            })
        )))
    }
}

/// A word on a file that another version has made.
fn versions(archive: &Archive) -> Option<String> {
    let (made, now) = (&archive.frame().attributes, provenance::attributes());
    let [by, this] = [made, &now].map(provenance::program);
    (!provenance::is_ours(made)).then(|| format!("was made by {by}, this is {this}"))
}

/// Chains drawn at random that have at least so many cases, or all.
fn sample(study: &Study, cases: usize, seed: u64) -> Vec<usize> {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut chains = BTreeSet::new();
    let mut drawn = 0;
    while drawn < cases && chains.len() < study.chains() {
        let chain = random.usize(..study.chains());
        if chains.insert(chain) {
            drawn += study.chain(chain).count();
        }
    }
    chains.into_iter().collect()
}

/// What came of a comparison.
#[derive(Default)]
struct Compared {
    cases: usize,
    numbers: usize,
    differences: Vec<String>,
}

/// Computes the cases of some chains and compares them with those of the file that are not missing.
fn compare(
    study: &Study,
    machine: Machine,
    archive: &Archive,
    chains: &[usize],
) -> Result<Compared, Failure> {
    let all: usize = chains.iter().map(|&chain| study.chain(chain).count()).sum();
    let progress = Progress::new(all, "cases");
    let mut records =
        run_sample(study, machine, chains, || progress.step()).map_err(Failure::machine)?;
    progress.finish();
    let positions = |records: &[Record]| -> Vec<Vec<usize>> {
        records.iter().map(|record| study.position(record.index)).collect()
    };
    let read = |name: &str, at: &[Vec<usize>]| archive.rows(name, at).map_err(Failure::machine);
    let outcomes = read(OUTCOME.name, &positions(&records))?.into_iter();
    let mut is_there = outcomes.map(|row| row.to_real().iter().all(|&code| code >= 0.0));
    records.retain(|_| is_there.next().unwrap_or(false));
    let at = positions(&records);
    let mut compared = Compared { cases: records.len(), ..Compared::default() };
    for (name, column) in store::schema::columns(study, &records).variables {
        let now = column.values.to_real();
        let kept = read(&name, &at)?;
        if kept.len() != records.len() {
            compared.differences.push(format!("the variable {name} is not there"));
        }
        for ((record, now), kept) in records.iter().zip(now.outer_iter()).zip(kept) {
            let kept = kept.to_real();
            compared.numbers += now.len();
            if kept.len() != now.len() {
                let (index, found) = (record.index, kept.len());
                let difference =
                    format!("case {index}: {found} numbers of {name}, not {}", now.len());
                compared.differences.push(difference);
            }
            let differs =
                |(a, b): &(&f64, &f64)| a.to_bits() != b.to_bits() && !(a.is_nan() && b.is_nan());
            let differences = now.iter().zip(&kept).filter(differs);
            let index = record.index;
            let word = |(now, kept)| format!("case {index}: {name} is {kept:e}, and {now:e} now");
            compared.differences.extend(differences.map(word));
        }
    }
    Ok(compared)
}
