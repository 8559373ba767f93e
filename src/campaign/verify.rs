//! Computes a random sample of a file's cases again and compares them with the file, bit for bit.

use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;

use crate::run::{Machine, Record, run_sample};
use crate::store::catalogue::OUTCOME;
use crate::store::{self, Archive, provenance};
use crate::study::Study;

use super::error::CampaignError;
use super::report::{Event, Report, Reports, Stage};
use super::study_source::study_of;

/// About so many cases are computed and held at a time.
const AT_A_TIME: usize = 4096;

/// Which cases are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sample {
    /// So many at least, or all; where cases inherit their start along an axis, whole lines of them.
    pub cases: usize,
    /// What the random numbers begin with.
    pub seed: u64,
}

/// What came of a comparison.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Verified {
    /// Cases that were compared: those of the sample that are not missing in the file.
    pub cases: usize,
    /// Numbers that were compared.
    pub numbers: usize,
    /// Where the file differs, by variable, then by case.
    pub differences: Vec<Difference>,
    /// The program that wrote the file and this one, where they differ.
    pub other_program: Option<[String; 2]>,
}

/// Where a file differs from what is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The variable.
    pub variable: String,
    /// How it differs.
    pub differs: Differs,
}

/// How a variable in a file differs from what is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Differs {
    /// It is not there.
    Missing,
    /// A case has another count of numbers.
    Count {
        /// The case.
        case: usize,
        /// Numbers in the file.
        kept: usize,
        /// Numbers that were computed.
        computed: usize,
    },
    /// A number of a case is another.
    Number {
        /// The case.
        case: usize,
        /// The number in the file.
        kept: f64,
        /// The number that was computed.
        computed: f64,
    },
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.variable;
        match self.differs {
            Differs::Missing => write!(f, "the variable {name} is not there"),
            Differs::Count { case, kept, computed } => {
                write!(f, "case {case}: {kept} numbers of {name}, not {computed}")
            }
            Differs::Number { case, kept, computed } => {
                write!(f, "case {case}: {name} is {kept:e}, and {computed:e} now")
            }
        }
    }
}

/// Computes a random sample of the cases in the file of results at `path` again and compares them.
///
/// What a case has settled to is compared in every number; attractors are numbered by all cases together, and
/// are not looked at. Fails if the file cannot be read or holds no cases.
pub fn verify(
    path: &Path,
    sample: Sample,
    machine: Machine,
    report: &Report<'_>,
) -> Result<Verified, CampaignError> {
    let reports = Reports::new(report);
    let archive = store::open(path).map_err(CampaignError::NoResults)?;
    if !archive.has_cases() {
        return Err(CampaignError::of_path(path, "holds no cases of a sweep"));
    }
    let study = study_of(&archive, path)?;
    let other_program = other_program(&archive);
    if let Some([theirs, ours]) = &other_program {
        reports.send(Event::OtherProgram { theirs, ours })?;
    }
    let is_kept = computed(&study, &archive)?;
    let chains = draw(&study, sample, |case| is_kept.is_empty() || is_kept[case]);
    let all = chains.iter().map(|&chain| study.chain(chain).count()).sum();
    reports.send(Event::Begun(Stage::Repeating, all))?;
    let mut verified = Verified { other_program, ..Verified::default() };
    for part in parts(&study, &chains) {
        let records = run_sample(&study, machine, part, || reports.step(Stage::Repeating))?;
        reports.check()?;
        compare(&study, &archive, records, &mut verified)?;
    }
    reports.send(Event::Ended(Stage::Repeating))?;
    verified.sort();
    Ok(verified)
}

/// The program that wrote a file and this one, unless they are the same.
fn other_program(archive: &Archive) -> Option<[String; 2]> {
    let (theirs, ours) = (&archive.frame().attributes, provenance::attributes());
    (!provenance::is_ours(theirs)).then(|| [theirs, &ours].map(provenance::program))
}

/// Whether each case of a refined study has been computed; nothing where all have.
fn computed(study: &Study, archive: &Archive) -> Result<Vec<bool>, CampaignError> {
    if study.refine.is_none() {
        return Ok(Vec::new());
    }
    let outcomes = archive.variable(OUTCOME.name)?.map(|it| it.values.to_real());
    Ok(outcomes.iter().flatten().map(|code| *code >= 0.0).collect())
}

/// Chains drawn at random that have as many cases as the sample, or all of which cases are kept.
fn draw(study: &Study, sample: Sample, is_kept: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut random = fastrand::Rng::with_seed(sample.seed);
    let (mut chains, mut tried) = (Vec::new(), BTreeSet::new());
    let mut drawn = 0;
    while drawn < sample.cases && tried.len() < study.chains() {
        let chain = random.usize(..study.chains());
        if tried.insert(chain) {
            let cases = study.chain(chain).filter(|case| is_kept(*case)).count();
            drawn += cases;
            chains.extend((cases > 0).then_some(chain));
        }
    }
    chains.sort_unstable();
    chains
}

/// Chains that are computed at a time.
fn parts<'c>(study: &Study, chains: &'c [usize]) -> impl Iterator<Item = &'c [usize]> {
    let longest = chains.iter().map(|&chain| study.chain(chain).count()).max().unwrap_or(1);
    chains.chunks((AT_A_TIME / longest).max(1))
}

/// Compares records with the cases of the file that are not missing.
fn compare(
    study: &Study,
    archive: &Archive,
    mut records: Vec<Record>,
    verified: &mut Verified,
) -> Result<(), CampaignError> {
    let outcomes = archive.rows(OUTCOME.name, &positions(study, &records))?.into_iter();
    let mut is_there = outcomes.map(|row| row.to_real().iter().all(|&code| code >= 0.0));
    records.retain(|_| is_there.next().unwrap_or(false));
    verified.cases += records.len();
    let at = positions(study, &records);
    for (name, column) in store::schema::columns(study, &records).variables {
        let computed = column.values.to_real();
        let kept = archive.rows(&name, &at)?;
        if kept.len() != records.len() {
            verified.add(&name, Differs::Missing);
        }
        for ((record, computed), kept) in records.iter().zip(computed.outer_iter()).zip(kept) {
            let (computed, kept) = (computed.iter().copied(), kept.to_real());
            let kept: Vec<f64> = kept.iter().copied().collect();
            verified.add_case(&name, record.index, &kept, &computed.collect::<Vec<f64>>());
        }
    }
    Ok(())
}

/// Where the cases of records lie along the dimensions of the results.
fn positions(study: &Study, records: &[Record]) -> Vec<Vec<usize>> {
    records.iter().map(|record| study.position(record.index)).collect()
}

impl Verified {
    fn add(&mut self, variable: &str, differs: Differs) {
        self.differences.push(Difference { variable: variable.to_owned(), differs });
    }

    /// Compares what a case has of a variable; what is not a number is equal to itself.
    fn add_case(&mut self, variable: &str, case: usize, kept: &[f64], computed: &[f64]) {
        self.numbers += computed.len();
        if kept.len() != computed.len() {
            let (kept, computed) = (kept.len(), computed.len());
            self.add(variable, Differs::Count { case, kept, computed });
        }
        for (&computed, &kept) in computed.iter().zip(kept) {
            if computed.to_bits() != kept.to_bits() && !(computed.is_nan() && kept.is_nan()) {
                self.add(variable, Differs::Number { case, kept, computed });
            }
        }
    }

    /// Brings the differences of all parts into order; a variable that is not there is listed once.
    fn sort(&mut self) {
        let differences = &mut self.differences;
        differences.sort_by(|a, b| a.variable.cmp(&b.variable));
        differences.dedup_by(|b, a| {
            [&a, &b].iter().all(|it| it.differs == Differs::Missing) && a.variable == b.variable
        });
    }
}
