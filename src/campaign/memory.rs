//! How much memory a campaign takes, estimated from what it holds.

use super::probe::Probe;
use crate::run::{FinalMotions, MapPoint, Record, TILES_TOGETHER, has_attractors};
use crate::store::{MOST_NUMBERS, numbers_of_case};
use crate::study::{CaseSet, Refine, Study};

/// What the program itself takes, with its libraries and tables [bytes]; measured by `scripts/memory.sh`.
const PROGRAM: f64 = 3e7;
/// Numbers of a block are held twice more while they are packed, and labels twice.
const COPIES: f64 = 2.0;
/// What is held of a block that is joined: of where it was computed, and of each of its variables [bytes].
const MAKER: f64 = 1.5e3;
const PLACE: f64 = 1e2;
/// Bytes of a number.
const NUMBER: f64 = 8.0;

/// The most memory that a campaign holds [bytes], to within a factor of 1.5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Memory {
    /// While cases are computed.
    pub computing: f64,
    /// While their blocks are joined.
    pub joining: f64,
}

/// The memory that a campaign of `study` takes on so many threads, by the cases that a `probe` has found to be held.
///
/// Method: the records of these cases, the numbers of the blocks that are packed, of the final motions among which attractors
/// are searched, of what was drawn, and of the slab that is written are counted.
pub fn memory(study: &Study, threads: usize, probe: &Probe) -> Memory {
    Memory { computing: computing(study, threads, probe), joining: joining(study) }
}

/// The memory held while cases are computed [bytes].
fn computing(study: &Study, threads: usize, probe: &Probe) -> f64 {
    let &Probe { most, unfinished, .. } = probe;
    let cases = study.cases() as f64;
    let all = numbers_of_case(study).values().sum::<usize>() as f64;
    // Tiles are refined together, and packed one after the other.
    let (computed, packed) = match study.refine {
        Some(_) => (most * TILES_TOGETHER.min(study.blocks()), most),
        None => (unfinished.max(most), most * threads),
    };
    let [computed, packed] = [computed, packed].map(|it| (it as f64).min(cases));
    // Beside the record itself lie its outputs and the states of its start and its end.
    let model = study.base.model();
    let beside = (model.outputs.len() + 2 * model.coordinates.len()) as f64 * NUMBER;
    let records = computed * (size_of::<Record>() as f64 + beside + all * NUMBER);
    let packing = packed * all * NUMBER * COPIES;
    PROGRAM + records + packing
}

/// The memory held while blocks are joined [bytes].
fn joining(study: &Study) -> f64 {
    let cases = study.cases() as f64;
    let numbers = numbers_of_case(study);
    let widest = numbers.values().copied().max().unwrap_or(0) as f64;
    let heads = study.blocks() as f64 * (MAKER + PLACE * numbers.len() as f64);
    let drawn = match &study.case_set {
        // Of each draw its number, too.
        CaseSet::Draws(draws) => cases * (draws.ranges.len() + 1) as f64 * NUMBER,
        CaseSet::Grid(_) => 0.0,
    };
    // The labels as they are found, and as they are written.
    let labels = if has_attractors(study) { cases * NUMBER * COPIES } else { 0.0 };
    let inferring = match &study.refine {
        // Labels, and what is inferred, of nearly all cases.
        Some(Refine::Outputs(within)) => {
            let one = size_of::<Option<MapPoint>>() + (2 * within.len() + 4) * size_of::<f64>();
            cases * one as f64
        }
        _ => 0.0,
    };
    let linking = match has_attractors(study) {
        // Labels of the cases in turn by tile, by attractor and as they are written.
        true if study.refine.is_some() => 3.0 * cases * size_of::<Option<u32>>() as f64,
        true => cases * (FinalMotions::bytes_of_case(study) + 2 * size_of::<Option<u32>>()) as f64,
        false => 0.0,
    };
    let slab = (cases * widest).min(MOST_NUMBERS as f64) * NUMBER;
    PROGRAM + heads + drawn + inferring + linking.max(slab + labels)
}
