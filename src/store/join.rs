//! Joins the blocks of a study into one file of results, a piece of a variable at a time.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

use crate::capsule::{REASONS, State};
use crate::orbit::Outcome;
use crate::orbit::matrix::Complex;
use crate::run::Ending;
use crate::study::Study;

use super::block_folder::BlockFolder;
use super::catalogue::{
    BLOCK, BLOCK_CASES, BLOCK_FIRST_CASE, BLOCK_MAKER, END, Entry, FAILURE_REASON, FAILURE_TIME,
    MULTIPLIER_IMAG, MULTIPLIER_REAL, OUTCOME, PERIOD, RESIDUAL, starts,
};
use super::joined::{self, Column};
use super::piece::{Filling, MISSING, Piece};
use super::schema;
use super::shard::{Shard, Summary, Unusable};
use super::{Dataset, StoreError, Values, Variable, provenance};

/// The name of the outcome of cases that failed.
const FAILED: &str = Outcome::Failed.name();

/// The blocks of a study, of which some may be missing.
pub struct Blocks<'a> {
    study: &'a Study,
    shards: Vec<Shard>,
    /// The numbers of those that are not there, and why.
    pub missing: Vec<(usize, Unusable)>,
}

impl<'a> Blocks<'a> {
    /// Opens and checks the blocks of `study` with these numbers in its folder.
    pub fn open(
        folder: &BlockFolder,
        study: &'a Study,
        numbers: impl IntoIterator<Item = usize>,
    ) -> Blocks<'a> {
        let (mut shards, mut missing) = (Vec::new(), Vec::new());
        for number in numbers {
            match folder.open(number) {
                // The seal fits what nobody of ours has written.
                Ok(shard) if shard.head.block.cases != study.cases_of_block(number) => {
                    missing.push((number, Unusable::Torn));
                }
                Ok(shard) => shards.push(shard),
                Err(why) => missing.push((number, why)),
            }
        }
        Blocks { study, shards, missing }
    }

    /// The blocks in a few numbers each, in their order.
    pub fn summaries(&self) -> Vec<Summary> {
        self.shards.iter().map(|shard| shard.head.block.clone()).collect()
    }

    /// The first cases that failed, so many at most, with where they started.
    pub fn failures(&self, most: usize) -> Result<Vec<FailedCase>, StoreError> {
        let mut found = Vec::new();
        for shard in &self.shards {
            if found.len() < most && shard.head.block.outcomes.contains_key(FAILED) {
                let cases = self.study.block_cases(shard.head.block.number);
                found.extend(failures(shard, &cases)?);
            }
        }
        found.truncate(most);
        Ok(found)
    }

    /// How every case of the study has ended, by index; none for those that are missing.
    pub fn endings(&self) -> Result<Vec<Option<Ending>>, StoreError> {
        let mut endings = vec![None; self.study.cases()];
        for shard in &self.shards {
            let cases = self.study.block_cases(shard.head.block.number);
            for (case, ending) in cases.into_iter().zip(shard_endings(shard)?) {
                endings[case] = Some(ending);
            }
        }
        Ok(endings)
    }

    /// The study with all that belongs to no case: axes, constants, and who made each block.
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
        let models = schema::columns(self.study, &[]);
        let labels: Vec<Column> =
            models.variables.iter().map(|(name, model)| self.column(name, model)).collect();
        let axes = self.study.shape().len();
        begun(joined::count_pieces(&labels, axes));
        let numbers = |column: &Column, piece: &Piece| {
            let model = &models.variables[&column.name].values;
            self.fill(&column.name, model, piece)
        };
        joined::write(frame, (&labels, axes), path, numbers, done)
    }

    fn column(&self, name: &str, model: &Variable) -> Column {
        let label = schema::over_axes(self.study, name, model.clone(), !self.missing.is_empty());
        let ranges = self.shards.iter().filter_map(|shard| shard.range(name)).flatten();
        // What stands for missing cases is among the numbers too.
        let missing = if self.missing.is_empty() { None } else { Some([MISSING.0, 0]) };
        let all: Vec<i64> = ranges.chain(missing.into_iter().flatten()).collect();
        let range = all.iter().min().zip(all.iter().max()).map(|(&low, &high)| [low, high]);
        let inner = &model.values.shape()[1..];
        let shape = self.study.shape().iter().chain(inner).copied().collect();
        Column { name: name.to_owned(), label, shape, range }
    }

    /// What the cases of a piece have of a variable.
    fn fill(&self, name: &str, model: &Values, piece: &Piece) -> Result<Values, StoreError> {
        let shape = self.study.shape();
        let [first, last] = piece.bounds(&shape);
        let width: usize = model.shape()[1..].iter().product();
        let mut filling = Filling::new(piece, name, model);
        for shard in &self.shards {
            let cases = self.study.block_cases(shard.head.block.number);
            if cases[cases.len() - 1] < first || cases[0] > last {
                continue;
            }
            let places = cases.iter().map(|&case| piece.place(&shape, case));
            match model {
                Values::Real(_) => filling.put_reals(places, &shard.reals(name, width)?),
                Values::Integer(_) => filling.put_integers(places, &shard.integers(name, width)?),
            }
        }
        Ok(filling.finish())
    }

    /// Says who made each block, and how many cases it has.
    fn add_makers(&self, frame: &mut Dataset) {
        let length = self.study.blocks();
        frame.put_coordinate(BLOCK, Values::count(length));
        let mut makers: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for shard in &self.shards {
            let made = provenance::maker(&shard.head.made);
            makers.entry(made).or_default().push(shard.head.block.number);
        }
        let mut codes = vec![MISSING.0; length];
        for (code, blocks) in makers.values().enumerate() {
            blocks.iter().for_each(|&block| codes[block] = code as i64);
        }
        let missing = (!self.missing.is_empty()).then(|| (MISSING.0, MISSING.1.to_owned()));
        let makers = makers.into_keys().enumerate().map(|(code, made)| (code as i64, made));
        let flags = missing.into_iter().chain(makers).collect();
        frame.put_column(BLOCK_MAKER, Values::integers(codes)).flags = flags;
        let firsts = (0..length).map(|block| self.study.block_cases(block)[0] as i64).collect();
        frame.put_column(BLOCK_FIRST_CASE, Values::integers(firsts));
        let cases = (0..length).map(|block| self.study.cases_of_block(block) as i64).collect();
        frame.put_column(BLOCK_CASES, Values::integers(cases));
    }
}

/// A case that failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailedCase {
    /// Its index.
    pub index: usize,
    /// Where it started.
    pub start: State<f64>,
    /// Why the integration failed, by its name in files.
    pub reason: &'static str,
    /// When, since its start [s].
    pub time: f64,
}

/// The failed among the `cases` of a shard.
fn failures(shard: &Shard, cases: &[usize]) -> Result<Vec<FailedCase>, StoreError> {
    let [r, y1, y2] = starts().map(|entry| shard.reals(entry.name, 1));
    let (r, y1, y2, times) = (r?, y1?, y2?, shard.reals(FAILURE_TIME.name, 1)?);
    let reasons = shard.integers(FAILURE_REASON.name, 1)?;
    let failed = |(place, code): (usize, &i64)| {
        let (_, reason) = REASONS.iter().find(|(reason, _)| *reason as i64 == *code)?;
        let start = State { r: r[place], y1: y1[place], y2: y2[place], ..State::default() };
        Some(FailedCase { index: cases[place], start, reason, time: times[place] })
    };
    Ok(reasons.iter().enumerate().filter_map(failed).collect())
}

/// How the cases of a shard have ended.
fn shard_endings(shard: &Shard) -> Result<Vec<Ending>, StoreError> {
    let whole = |entry: Entry| shard.integers(entry.name, 1);
    let (outcomes, periods) = (whole(OUTCOME)?, whole(PERIOD)?);
    let [r, y1, y2] = END.map(|entry| shard.reals(entry.name, 1));
    let (r, y1, y2, residual) = (r?, y1?, y2?, shard.reals(RESIDUAL.name, 1)?);
    let [real, imag] = [MULTIPLIER_REAL, MULTIPLIER_IMAG].map(|entry| shard.reals(entry.name, 3));
    let (real, imag) = (real?, imag?);
    let multipliers = |case: usize| {
        std::array::from_fn(|i| Complex { re: real[3 * case + i], im: imag[3 * case + i] })
    };
    let outcome = |code: i64| Outcome::ALL.iter().copied().find(|it| *it as i64 == code);
    let ending = |case: usize| {
        let section = [r[case], y1[case], y2[case]];
        let period = periods[case] as u32;
        let outcome = outcome(outcomes[case]).unwrap_or(Outcome::Failed);
        Ending::new(outcome, period, section, residual[case], &multipliers(case))
    };
    Ok((0..outcomes.len()).map(ending).collect())
}
