//! How long blocks are packed and joined, by a trial with a sample of the cases.

use std::ops::ControlFlow;
use std::time::Instant;

use super::join::Blocks;
use super::schema::numbers_of_case;
use super::{BlockFolder, Company, StoreError};
use crate::run::Record;
use crate::study::{Axis, CaseSet, Grid, Study};

/// Numbers of the sample, at most.
const NUMBERS: usize = 2_000_000;
/// Records are taken in runs of so many neighbours, as equal numbers beside each other are compressed.
pub const RUN: usize = 128;
/// Cases of the smallest trial, which takes the time that goes with no case.
const FEW: usize = 16;
/// Each trial is made so many times, of which the shortest counts.
const TRIES: usize = 2;

/// Seconds that a study takes beside its cases and its attractors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Storing {
    /// To pack all blocks, on one thread [s].
    pub packing: f64,
    /// To join them, and to write and check the file [s].
    pub joining: f64,
}

/// The time that storing `study` takes [s], of which the share `computed` of all cases is computed, by a trial with some
/// of its `records`, in the order of their indices; NaN if there are none.
///
/// Method: the records become the cases of a study with one axis, whose blocks are kept and joined in a folder for temporary
/// files as those of any study are, with cases that are missing for those that are not computed; once with a few records, too,
/// as what goes with the number of cases is the difference.
///
/// Fails if the folder cannot be written.
pub fn storing(study: &Study, records: &[Record], computed: f64) -> Result<Storing, StoreError> {
    if records.is_empty() {
        return Ok(Storing { packing: f64::NAN, joining: f64::NAN });
    }
    let of_case = numbers_of_case(study).values().sum::<usize>().max(1);
    let every = (records.len() * of_case).div_ceil(NUMBERS).max(1);
    let sample: Vec<Record> = records.chunks(RUN).step_by(every).flatten().cloned().collect();
    let few = &sample[..sample.len().min(FEW)];
    let [(some, cases), (least, fewest)] = [&sample, few].map(|it| shortest(study, it, computed));
    let [some, least] = [some?, least?];
    let all = study.cases() as f64;
    let more = match cases > fewest {
        true => (some.joining - least.joining).max(0.0) / (cases - fewest) as f64,
        false => 0.0,
    };
    Ok(Storing {
        packing: computed * all * some.packing / sample.len() as f64,
        joining: least.joining + more * (all - fewest as f64),
    })
}

/// The shortest times of a few trials, and the cases of each.
fn shortest(
    study: &Study,
    records: &[Record],
    computed: f64,
) -> (Result<Storing, StoreError>, usize) {
    let sample = sample(study, records.len(), computed);
    let mut least = Storing { packing: f64::INFINITY, joining: f64::INFINITY };
    for _ in 0..TRIES {
        match trial(&sample, records) {
            Ok(Storing { packing, joining }) => {
                least.packing = least.packing.min(packing);
                least.joining = least.joining.min(joining);
            }
            Err(refused) => return (Err(refused), sample.cases()),
        }
    }
    (Ok(least), sample.cases())
}

/// A study with so many cases, and those that are missing, which are stored as those of `study`.
fn sample(study: &Study, records: usize, computed: f64) -> Study {
    let alone = along_one_axis(study, records);
    // A block that is not whole is missing.
    if alone.blocks() == 1 {
        return alone;
    }
    let cases = (records as f64 / computed.clamp(f64::MIN_POSITIVE, 1.0)).round() as usize;
    along_one_axis(study, cases.min(study.cases()).max(records))
}

/// A study with so many cases along one axis.
fn along_one_axis(study: &Study, cases: usize) -> Study {
    let values = (0..cases).map(|case| case as f64).collect();
    let coordinate = study.case_set.varied().into_iter().next();
    let axes = coordinate.map(|coordinate| Axis::of(coordinate, values)).into_iter().collect();
    Study {
        case_set: CaseSet::Grid(Grid { axes, inherit: None }),
        refine: None,
        branches: Vec::new(),
        ..study.clone()
    }
}

/// The time that blocks with some records take to be packed and joined, beside those of a study that are missing.
fn trial(study: &Study, records: &[Record]) -> Result<Storing, StoreError> {
    let folder = tempfile::tempdir()
        .map_err(StoreError::system(&std::env::temp_dir(), "making a folder"))?;
    let blocks = BlockFolder::enter(&folder.path().join("blocks"), study, Company::Alone, false)?;
    let begun = Instant::now();
    let mut kept = 0;
    for number in 0..study.blocks() {
        let own = kept..kept + study.cases_of_block(number);
        let Some(own) = records.get(own) else { break };
        blocks.keep(study, number, own)?;
        kept += own.len();
    }
    let packing = begun.elapsed().as_secs_f64();
    let begun = Instant::now();
    let blocks = Blocks::open(&blocks, study, 0..study.blocks());
    let file = folder.path().join("trial.h5");
    // Nobody asks to stop.
    let _ = blocks.join(&blocks.frame(), &file, |_| (), || ControlFlow::Continue(()))?;
    let packing = packing * records.len() as f64 / kept as f64;
    Ok(Storing { packing, joining: begun.elapsed().as_secs_f64() })
}
