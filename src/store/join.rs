//! Joins the blocks of a study into one file of results, slab by slab.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

use super::block_file::{BlockFile, Summary, Unusable};
use super::block_folder::BlockFolder;
use super::catalogue::{
    BLOCK, BLOCK_CASES, BLOCK_FIRST_CASE, BLOCK_MAKER, CASE, CYCLES, FAILURE_REASON, FAILURE_TIME,
    MULTIPLIER_IMAG, MULTIPLIER_REAL, OUTCOME, PERIOD, RESIDUAL, end, starts,
};
use super::decode::Archive;
use super::joined::{self, Column};
use super::schema;
use super::slab::{Filling, INFERRED, MISSING, Slab};
use super::{Dataset, StoreError, Values, Variable, provenance};
use crate::description::{Description, Output, State};
use crate::motion::reasons;
use crate::orbit::Outcome;
use crate::orbit::matrix::Complex;
use crate::run::{
    FinalMotion, FinalMotions, InferredCases, MapPoint, Record, final_motion, within,
};
use crate::study::Study;

/// The name of the outcome of cases that failed.
const FAILED: &str = Outcome::Failed.name();

/// The blocks of a study, of which some may be missing.
pub struct Blocks<'a> {
    pub(super) study: &'a Study,
    pub(super) files: Vec<BlockFile>,
    /// The numbers of those that are not there, and why.
    pub missing: Vec<(usize, Unusable)>,
    /// Cases of a refined study that were computed once all tiles were there, in the order of their indices.
    pub(super) between: Vec<Record>,
    /// Cases of a refined map that are inferred.
    pub(super) inferred: InferredCases,
}

impl<'a> Blocks<'a> {
    /// Opens and checks the blocks of `study` with these numbers in its folder.
    pub fn open(
        folder: &BlockFolder,
        study: &'a Study,
        numbers: impl IntoIterator<Item = usize>,
    ) -> Blocks<'a> {
        let (mut files, mut missing) = (Vec::new(), Vec::new());
        for number in numbers {
            match folder.open(number) {
                // The checksum is valid, but the number of cases is wrong.
                Ok(file) if !has_cases_of(&file, study, number) => {
                    missing.push((number, Unusable::Torn));
                }
                Ok(file) => files.push(file),
                Err(why) => missing.push((number, why)),
            }
        }
        Blocks { study, files, missing, between: Vec::new(), inferred: InferredCases::default() }
    }

    /// Adds cases of a refined study that were computed once all tiles were there, in the order of their indices.
    pub fn add(&mut self, records: Vec<Record>) {
        self.between = records;
    }

    /// Adds what is inferred of the cases of a refined map.
    pub fn infer(&mut self, inferred: InferredCases) {
        self.inferred = inferred;
    }

    /// The cases of a block file, in rising order, as its columns have them.
    fn cases_of(&self, file: &BlockFile) -> Result<Vec<usize>, StoreError> {
        match self.study.refine.is_some() {
            false => Ok(self.study.block_cases(file.head.block.number)),
            true => file.cases(CASE, self.study.cases()),
        }
    }

    /// The summary of each block, in their order.
    pub fn summaries(&self) -> Vec<Summary> {
        self.files.iter().map(|file| file.head.block.clone()).collect()
    }

    /// The first cases that failed, so many at most, with where they started.
    pub fn failures(&self, most: usize) -> Result<Vec<FailedCase>, StoreError> {
        let mut found = Vec::new();
        for file in &self.files {
            if found.len() < most && file.head.block.outcomes.contains_key(FAILED) {
                found.extend(failures(file, &self.cases_of(file)?, self.study.base.model())?);
            }
        }
        found.truncate(most);
        Ok(found)
    }

    /// What the cases have settled to, as far as they have been computed.
    pub fn final_motions(&self) -> Result<FinalMotions, StoreError> {
        let mut failed = None;
        // Block by block, so that no second list of all cases is held.
        let known = self
            .files
            .iter()
            .map_while(|file| self.final_motions_of(file).map_err(|said| failed = Some(said)).ok());
        let between = self.between.iter().map(|it| (it.index, final_motion(&it.orbit)));
        let motions = FinalMotions::of(self.study, known.flatten().chain(between));
        failed.map_or(Ok(motions), Err)
    }

    /// What the cases of a block file have settled to, with their indices.
    fn final_motions_of(&self, file: &BlockFile) -> Result<Vec<(usize, FinalMotion)>, StoreError> {
        let cases = self.cases_of(file)?.into_iter();
        Ok(cases.zip(final_states(file, self.study.base.model())?).collect())
    }

    /// The cases that have been computed, each once, with their outcomes, by their numbers in files, and the cycles for which they
    /// have been followed.
    pub fn verdicts(&self) -> Result<Vec<(usize, i64, u64)>, StoreError> {
        let mut known = Vec::new();
        for file in &self.files {
            let outcomes = file.integers(OUTCOME.name, 1)?.into_iter();
            let both = outcomes.zip(file.integers(CYCLES.name, 1)?);
            let cases = self.cases_of(file)?.into_iter().zip(both);
            known.extend(cases.map(|(case, (outcome, cycles))| (case, outcome, cycles as u64)));
        }
        let between = self.between.iter();
        known.extend(between.map(|it| (it.index, it.orbit.outcome as i64, it.orbit.cycles)));
        if self.study.refine.is_some() {
            // Neighbouring tiles both have the cases between them.
            known.sort_unstable();
            known.dedup_by_key(|(case, ..)| *case);
        }
        Ok(known)
    }

    /// What tells the cases of a refined map apart that have been computed, each once, in the order of their indices.
    pub fn map_points(&self) -> Result<Vec<(usize, MapPoint)>, StoreError> {
        // Blocks have the share of rest even where the results leave it out.
        let refined = within(self.study).iter().map(|(output, _)| *output);
        let of: Vec<Output> = refined.chain(self.study.base.model().rest_share()).collect();
        let mut known = Vec::new();
        for file in &self.files {
            let columns: Result<Vec<Vec<f64>>, StoreError> =
                of.iter().map(|output| file.reals(output.name(), 1)).collect();
            let (columns, motions) = (columns?, final_states(file, self.study.base.model())?);
            for (place, (case, motion)) in self.cases_of(file)?.into_iter().zip(motions).enumerate()
            {
                let verdict = (motion.outcome, motion.period);
                let point = MapPoint::of(self.study, verdict, |output| {
                    let column = of.iter().position(|other| *other == output);
                    column.map_or(f64::NAN, |column| columns[column][place])
                });
                known.push((case, point));
            }
        }
        let between = self.between.iter();
        known.extend(between.map(|it| (it.index, MapPoint::of_record(self.study, it))));
        known.sort_by_key(|(case, _)| *case);
        // Neighbouring tiles both have the cases between them.
        known.dedup_by_key(|(case, _)| *case);
        Ok(known)
    }

    /// The study with all that belongs to no case: axes, constants, and the program that wrote each block.
    pub fn frame(&self) -> Dataset {
        let mut frame = schema::frame(self.study);
        frame.coordinates.extend(schema::columns(self.study, &[]).coordinates);
        self.add_makers(&mut frame);
        frame
    }

    /// Puts all blocks into the file at `path` beside what `frame` holds, which is that of the blocks and may
    /// have more; calls `begun` with the number of steps, and `done` after each. If that breaks off, nothing is
    /// left behind, and an older file is as it was.
    pub fn join(
        &self,
        frame: &Dataset,
        path: &Path,
        begun: impl FnOnce(usize),
        done: impl Fn() -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, StoreError> {
        // Of no case but those between tiles.
        let models = schema::columns(self.study, &self.between);
        let columns: Vec<Column> =
            models.variables.iter().map(|(name, it)| self.column(name, it, &models)).collect();
        begun(joined::count_slabs(&columns));
        joined::write(frame, &columns, path, |it, slab| self.fill(it, &models, slab), done)
    }

    pub(super) fn column(&self, name: &str, model: &Variable, between: &Dataset) -> Column {
        let label = schema::over_axes(self.study, name, model.clone(), !self.missing.is_empty());
        let between = between.variables.get(name).and_then(|it| it.values.range());
        let ranges = self.files.iter().filter_map(|file| file.range(name)).chain(between).flatten();
        // The numbers for missing and inferred cases occur too.
        let missing = (!self.missing.is_empty()).then_some([MISSING.0, 0]);
        let inferred = self.study.refine.is_some().then_some([INFERRED.0, 0]);
        let absent = missing.into_iter().chain(inferred).flatten();
        let all: Vec<i64> = ranges.chain(absent).collect();
        let range = all.iter().min().zip(all.iter().max()).map(|(&low, &high)| [low, high]);
        let inner = &model.values.shape()[1..];
        let axes = self.study.shape();
        let shape = axes.iter().chain(inner).copied().collect();
        Column { name: name.to_owned(), label, shape, axes: axes.len(), range }
    }

    /// The numbers of a column at the cases of a slab.
    pub(super) fn fill(
        &self,
        column: &Column,
        models: &Dataset,
        slab: &Slab,
    ) -> Result<Values, StoreError> {
        let name = column.name.as_str();
        let model = &models.variables[name].values;
        let shape = self.study.shape();
        let [first, last] = slab.bounds(&shape);
        let width: usize = model.shape()[1..].iter().product();
        let mut filling = Filling::new(slab, name, model);
        for file in &self.files {
            let own = self.study.block_cases(file.head.block.number);
            if own[own.len() - 1] < first || own[0] > last {
                continue;
            }
            if self.study.refine.is_some() && name == OUTCOME.name {
                filling.put_each(own.iter().map(|&case| slab.place(&shape, case)), INFERRED.0);
            }
        }
        for file in &self.files {
            let cases = self.cases_of(file)?;
            if cases[cases.len() - 1] < first || cases[0] > last {
                continue;
            }
            let places = cases.iter().map(|&case| slab.place(&shape, case));
            match model {
                Values::Real(_) => filling.put_reals(places, &file.reals(name, width)?),
                Values::Integer(_) => filling.put_integers(places, &file.integers(name, width)?),
            }
        }
        let places = self.between.iter().map(|it| slab.place(&shape, it.index));
        match model {
            Values::Real(own) => filling.put_reals(places, own.as_slice().expect("a table")),
            Values::Integer(own) => filling.put_integers(places, own.as_slice().expect("a table")),
        }
        self.fill_inferred(name, slab, &mut filling);
        Ok(filling.finish())
    }

    /// Puts the numbers of a variable that are inferred in their places.
    fn fill_inferred(&self, name: &str, slab: &Slab, filling: &mut Filling) {
        let InferredCases { cases, periods, rests, values } = &self.inferred;
        let shape = self.study.shape();
        let places = cases.iter().map(|&case| slab.place(&shape, case));
        let refined = within(self.study).iter().position(|(output, _)| output.name() == name);
        if name == PERIOD.name {
            let periods: Vec<i64> = periods.iter().map(|period| i64::from(*period)).collect();
            filling.put_integers(places, &periods);
        } else if let Some(values) = refined.and_then(|of| values.get(of)) {
            filling.put_reals(places, values);
        } else if self.study.base.model().rest_share().is_some_and(|it| it.name() == name) {
            let shares: Vec<f64> =
                rests.iter().map(|rests| if *rests { 1.0 } else { f64::NAN }).collect();
            filling.put_reals(places, &shares);
        }
    }

    /// Adds the program that wrote each block, and its number of cases.
    fn add_makers(&self, frame: &mut Dataset) {
        let length = self.study.blocks();
        frame.put_coordinate(BLOCK, Values::count(length));
        let mut makers: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for file in &self.files {
            let maker = provenance::maker(&file.head.provenance);
            makers.entry(maker).or_default().push(file.head.block.number);
        }
        let mut codes = vec![MISSING.0; length];
        for (code, blocks) in makers.values().enumerate() {
            blocks.iter().for_each(|&block| codes[block] = code as i64);
        }
        let missing = (!self.missing.is_empty()).then(|| (MISSING.0, MISSING.1.to_owned()));
        let makers = makers.into_keys().enumerate().map(|(code, maker)| (code as i64, maker));
        let flags = missing.into_iter().chain(makers).collect();
        frame.put_column(BLOCK_MAKER, Values::integers(codes)).flags = flags;
        let firsts = (0..length).map(|block| self.study.block_cases(block)[0] as i64).collect();
        frame.put_column(BLOCK_FIRST_CASE, Values::integers(firsts));
        let cases = (0..length).map(|block| self.study.cases_of_block(block) as i64).collect();
        frame.put_column(BLOCK_CASES, Values::integers(cases));
    }
}

/// Whether a block file has as many cases as its study says; a tile has those that it has needed.
fn has_cases_of(file: &BlockFile, study: &Study, number: usize) -> bool {
    let block = &file.head.block;
    block.cases == study.cases_of_block(number)
        && (study.refine.is_some() || block.computed == block.cases)
}

/// Keeps the cases of an older file of the results of `study` in the file at `path`, beside what `frame` holds, which is
/// all else: the same bytes as if the blocks of the cases were joined beside it.
pub fn write_beside_cases(
    older: &Archive,
    study: &Study,
    frame: &Dataset,
    path: &Path,
) -> Result<(), StoreError> {
    let axes = study.shape().len();
    let mut columns = Vec::new();
    for name in schema::numbers_of_case(study).into_keys() {
        let (label, shape) = (older.label(&name).cloned(), older.shape(&name)?);
        let Some((label, shape)) = label.zip(shape) else { continue };
        let mut column = Column { name, label, shape, axes, range: None };
        for slab in column.slabs_of_integers() {
            let own = kept(older, &column, &slab)?.range();
            let ends = column.range.into_iter().chain(own).flatten();
            column.range = ends.clone().min().zip(ends.max()).map(|(low, high)| [low, high]);
        }
        columns.push(column);
    }
    // Nobody asks to stop.
    let written = joined::write(
        frame,
        &columns,
        path,
        |column, slab| kept(older, column, slab),
        || ControlFlow::Continue(()),
    );
    written.map(drop)
}

/// The numbers of a column that an older file has at the cases of a slab.
fn kept(older: &Archive, column: &Column, slab: &Slab) -> Result<Values, StoreError> {
    match older.slab(&column.name, slab)? {
        Some(variable) => Ok(variable.values),
        None => Err(StoreError::Damaged { path: older.path().to_owned() }),
    }
}

/// A case that failed.
#[derive(Debug, Clone, PartialEq)]
pub struct FailedCase {
    /// Its index.
    pub index: usize,
    /// Where it started.
    pub start: State,
    /// Why the integration failed, by its name in files.
    pub reason: &'static str,
    /// When, since its start [s].
    pub time: f64,
}

/// The failed among the `cases` of a block file.
fn failures(
    file: &BlockFile,
    cases: &[usize],
    model: &'static Description,
) -> Result<Vec<FailedCase>, StoreError> {
    let starts: Vec<Vec<f64>> =
        starts(model).iter().map(|entry| file.reals(entry.name, 1)).collect::<Result<_, _>>()?;
    let times = file.reals(FAILURE_TIME.name, 1)?;
    let codes = file.integers(FAILURE_REASON.name, 1)?;
    let names = reasons(model);
    let mut failures = Vec::new();
    for (place, code) in codes.into_iter().enumerate() {
        let Some((_, reason)) = names.iter().find(|(reason, _)| *reason as i64 == code) else {
            continue;
        };
        let mut start = State::origin(model);
        for (coordinate, values) in model.start_coordinates().zip(&starts) {
            start[coordinate] = values[place];
        }
        failures.push(FailedCase { index: cases[place], start, reason, time: times[place] });
    }
    Ok(failures)
}

/// The final states of the cases of a block file.
fn final_states(
    file: &BlockFile,
    model: &'static Description,
) -> Result<Vec<FinalMotion>, StoreError> {
    let (outcomes, periods) = (file.integers(OUTCOME.name, 1)?, file.integers(PERIOD.name, 1)?);
    let end: Vec<Vec<f64>> =
        end(model).iter().map(|entry| file.reals(entry.name, 1)).collect::<Result<_, _>>()?;
    let residual = file.reals(RESIDUAL.name, 1)?;
    let count = end.len();
    let real = file.reals(MULTIPLIER_REAL.name, count)?;
    let imag = file.reals(MULTIPLIER_IMAG.name, count)?;
    let mut states = Vec::with_capacity(outcomes.len());
    for (case, &code) in outcomes.iter().enumerate() {
        let outcome = Outcome::ALL.into_iter().find(|it| *it as i64 == code);
        let outcome = outcome.unwrap_or(Outcome::Failed);
        let section = end.iter().map(|column| column[case]).collect();
        let parts = (count * case..count * (case + 1)).map(|at| (real[at], imag[at]));
        let multipliers: Vec<Complex> = parts.map(|(re, im)| Complex { re, im }).collect();
        let period = periods[case] as u32;
        states.push(FinalMotion::new(outcome, period, section, residual[case], &multipliers));
    }
    Ok(states)
}
