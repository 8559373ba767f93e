//! Blocks: a study is divided into blocks of cases, each of which is computed, kept and repeated as a whole.
//!
//! The blocks of a refined study are the tiles of its grid.

use std::ops::Range;

use super::Study;

/// A block has this many cases, or those of one group of chains if they are more.
const CASES: usize = 512;
/// A large study has larger blocks, so that there are about so many at most: folders of many more files are
/// slow to list, and clusters count them.
const MOST_BLOCKS: usize = 8192;

impl Study {
    /// Number of blocks. How a study is cut depends on the study alone, never on the machine, so that every
    /// machine and every later run means the same by a block's number.
    pub fn blocks(&self) -> usize {
        match self.refinement() {
            Some(refinement) => refinement.tiles(),
            None => self.chains().div_ceil(self.chains_per_block()),
        }
    }

    /// The chains of block `number` of a study that is not refined.
    pub fn block(&self, number: usize) -> Range<usize> {
        let size = self.chains_per_block();
        number * size..((number + 1) * size).min(self.chains())
    }

    /// The cases of block `number`, in the order of their indices.
    pub fn block_cases(&self, number: usize) -> Vec<usize> {
        if let Some(refinement) = self.refinement() {
            return refinement.cases(number);
        }
        let mut cases: Vec<usize> =
            self.block(number).flat_map(|chain| self.chain(chain)).collect();
        cases.sort_unstable();
        cases
    }

    /// Number of cases of block `number`.
    pub fn cases_of_block(&self, number: usize) -> usize {
        match self.refinement() {
            Some(refinement) => refinement.count(number),
            None => self.block(number).len() / self.chains_of_group() * self.cases_of_group(),
        }
    }

    /// Chains of every block but the last, which may have fewer.
    fn chains_per_block(&self) -> usize {
        let cases = CASES.max(self.cases().div_ceil(MOST_BLOCKS));
        self.chains_of_group() * (cases / self.cases_of_group()).max(1)
    }
}

/// All blocks in an order in which any number of the first are spread evenly over the study, so that they
/// foretell how long the rest takes, and show a map of it before the end.
///
/// Method: steps of the golden section, or of the next number that has no divisor in common with the number
/// of blocks.
pub fn spread(blocks: usize) -> Vec<usize> {
    let golden = (0.618_033_988_749_894_9 * blocks as f64) as usize;
    let step = (golden.max(1)..).find(|step| greatest_divisor(*step, blocks) == 1).unwrap_or(1);
    (0..blocks).map(|place| place * step % blocks).collect()
}

fn greatest_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}
