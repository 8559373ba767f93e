//! The results of a study in memory, without a file: the same dataset as its file holds.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, MutexGuard};

use super::beside::Beside;
use super::error::CampaignError;
use super::joining::Joining;
use super::map_cases::Results;
use super::report::{Event, Report, Reports};
use super::until_stopped::until_stopped;
use crate::flow::Stop;
use crate::run::{self, Machine, Record, has_attractors, run_blocks};
use crate::store::{self, Blocks, CaseVariable, Dataset, Variable, add_attractors};
use crate::study::{Study, spread};

/// The results of `study` as its file would hold them, from the records of all of its cases, in the order of their indices.
///
/// Fails if the threads cannot be started.
pub fn results_in_memory(
    study: &Study,
    records: &[Record],
    machine: Machine,
) -> Result<Dataset, CampaignError> {
    let mut results = store::dataset(study, records);
    if has_attractors(study) {
        let motions = run::final_motions(study, records);
        let attractors = run::attractors(study, &motions, machine, || ())?;
        let table = run::attractor_table(study, &attractors, &motions, machine, |_| ())?;
        add_attractors(&mut results, study, &attractors, &table);
    }
    Ok(results)
}

/// A study that is computed in memory, by one thread, while others may look at what is done.
#[derive(Debug)]
pub struct InMemory {
    study: Study,
    machine: Machine,
    /// What ends the computation.
    stop: Stop,
    done: Mutex<DoneSoFar>,
}

/// The cases that are done.
#[derive(Debug, Clone, Default)]
struct DoneSoFar {
    /// The blocks of which all cases are done, as their files would hold them.
    blocks: BTreeMap<usize, Arc<[u8]>>,
    /// The records of the other blocks.
    records: BTreeMap<usize, Vec<Record>>,
    /// How many cases are done.
    cases: usize,
}

impl InMemory {
    /// The study, of which nothing is done yet.
    pub fn new(study: Study, machine: Machine) -> InMemory {
        InMemory { study, machine, stop: Stop::default(), done: Mutex::default() }
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// How many cases are done, and how many the study has; a refined study needs fewer.
    pub fn progress(&self) -> [usize; 2] {
        [self.locked().cases, self.study.cases()]
    }

    /// Ends the computation within a few steps of its motions, from any thread; what is done stays.
    pub fn stop(&self) {
        self.stop.ask();
    }

    /// Computes the cases, and then the branches and ramps if they are wanted: the dataset that the file of the study would hold.
    ///
    /// Guarantees: the same numbers, labels and attributes as in the file, to the bit, but for the time in `created`.
    ///
    /// Fails if the study is not the one that its text says, if it has no branches that are wanted, if the threads cannot be
    /// started, or, with [`CampaignError::Stopped`], if it was stopped or the listener asks for it.
    pub fn run(&self, wanted: Wanted, report: &Report<'_>) -> Result<Dataset, CampaignError> {
        self.study.check_text("the study")?;
        until_stopped(&self.stop, || self.compute(wanted, &Reports::new(report)))
    }

    fn compute(&self, wanted: Wanted, reports: &Reports<'_>) -> Result<Dataset, CampaignError> {
        let study = &self.study;
        if wanted.branches && !study.has_more_than_cases() {
            return Err(CampaignError::NoBranches);
        }
        let mut dataset = if wanted.cases { self.cases(reports)? } else { store::frame(study) };
        if wanted.branches {
            let results = wanted.cases.then_some(Results::Memory(&dataset));
            let found = Beside::of(study, results, self.machine.threads, reports)?;
            found.put_into(&mut dataset, study);
        }
        Ok(dataset)
    }

    /// Computes the cases.
    fn cases(&self, reports: &Reports<'_>) -> Result<Dataset, CampaignError> {
        let study = &self.study;
        let fingerprint = study.fingerprint();
        let unpacked = Mutex::new(None);
        run_blocks(
            study,
            self.machine,
            &spread(study.blocks()),
            None,
            |block, record| self.note(block, record, reports),
            |block, records| match store::block_image(study, &fingerprint, block, &records) {
                Ok(image) => self.keep(block, image),
                Err(error) => {
                    *unpacked.lock().unwrap_or_else(|it| it.into_inner()) = Some(error);
                    ControlFlow::Break(())
                }
            },
        )?;
        if let Some(error) = unpacked.into_inner().unwrap_or_else(|it| it.into_inner()) {
            return Err(CampaignError::Packing(error));
        }
        reports.check()?;
        if self.stop.is_asked() {
            return Err(CampaignError::Stopped);
        }
        let images = self.locked().blocks.clone();
        let mut blocks = Blocks::of_images(study, &images, Vec::new());
        let joining = Joining { study, machine: self.machine, reports };
        let frame = joining.frame(&mut blocks, false)?;
        Ok(blocks.gather(frame)?)
    }

    /// Keeps a record that is done before the computation is stopped: a later one has no meaning.
    fn note(&self, block: usize, record: &Record, reports: &Reports<'_>) -> ControlFlow<()> {
        if self.stop.is_asked() {
            return ControlFlow::Break(());
        }
        let cases = self.study.cases_of_block(block);
        {
            let mut done = self.locked();
            done.records.entry(block).or_default().push(record.clone());
            done.cases += 1;
        }
        reports.note(Event::Case { block, cases, record })
    }

    /// Keeps a block in the place of its records.
    fn keep(&self, block: usize, image: Vec<u8>) -> ControlFlow<()> {
        let mut done = self.locked();
        done.records.remove(&block);
        done.blocks.insert(block, image.into());
        ControlFlow::Continue(())
    }

    /// What is done by now.
    pub fn moment(&self) -> Moment {
        Moment(self.locked().clone())
    }

    /// The results as they were at a moment of this computation.
    pub fn at(&self, moment: &Moment) -> Snapshot<'_> {
        let DoneSoFar { blocks, records, .. } = &moment.0;
        let mut records: Vec<Record> = records.values().flatten().cloned().collect();
        records.sort_by_key(|record| record.index);
        // Two tiles may share a case.
        records.dedup_by_key(|record| record.index);
        Snapshot { blocks: Blocks::of_images(&self.study, blocks, records) }
    }

    fn locked(&self) -> MutexGuard<'_, DoneSoFar> {
        self.done.lock().unwrap_or_else(|it| it.into_inner())
    }
}

/// What was done of a study at a moment.
#[derive(Debug, Clone)]
pub struct Moment(DoneSoFar);

/// What of a study is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted {
    /// Its cases, with their attractors.
    pub cases: bool,
    /// Its branches.
    pub branches: bool,
}

/// The cases of a study that were done at a moment, without attractors and without what is inferred of others.
pub struct Snapshot<'a> {
    blocks: Blocks<'a>,
}

impl Snapshot<'_> {
    /// All but the variables over the cases.
    pub fn frame(&self) -> Dataset {
        self.blocks.frame()
    }

    /// The variables over the cases without their numbers.
    pub fn labels(&self) -> Vec<CaseVariable> {
        self.blocks.labels()
    }

    /// A variable over the cases with its numbers: cases that are not done have NaN, 0, and the outcome `missing`. None if there is
    /// none of this name.
    ///
    /// Fails if a block cannot be read.
    pub fn variable(&self, name: &str) -> Result<Option<Variable>, CampaignError> {
        Ok(self.blocks.variable(name)?)
    }
}
