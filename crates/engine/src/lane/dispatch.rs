//! Which vectors a piece of work runs on: chosen when the program runs, from what the processor has.

use super::work::{AVX2, AVX512, BASELINE, INTERPRETED, Work};
#[cfg(target_arch = "x86_64")]
use super::x86;
use super::{Lane, Wide, pair::Pair};

/// The instructions that lanes are moved by. The bits of a result do not depend on them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Instructions {
    /// One case at a time.
    Scalar,
    /// What every processor of this architecture has: SSE2 or NEON, two numbers an instruction.
    Baseline,
    /// Four numbers an instruction, on x86-64.
    Avx2,
    /// Eight numbers an instruction, on x86-64.
    Avx512,
}

impl Instructions {
    /// All by their names on the command line, in the order of declaration.
    pub const NAMES: [(&str, Instructions); 4] = [
        ("scalar", Instructions::Scalar),
        (if cfg!(target_arch = "aarch64") { "neon" } else { "sse2" }, Instructions::Baseline),
        ("avx2", Instructions::Avx2),
        ("avx512", Instructions::Avx512),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Instructions::NAMES[self as usize].0
    }

    /// Those that this processor has, the narrowest first.
    pub fn available() -> impl DoubleEndedIterator<Item = Instructions> {
        Instructions::NAMES.into_iter().map(|(_, it)| it).filter(|it| it.is_available())
    }

    /// The widest that this processor has.
    pub fn widest() -> Instructions {
        Instructions::available().next_back().unwrap_or(Instructions::Scalar)
    }

    /// The narrowest that hold `count` cases at a time, or the widest: lanes that stay empty cost as much as
    /// others.
    pub fn suited_to(count: usize) -> Instructions {
        Instructions::available()
            .find(|it| it.lanes() >= count)
            .unwrap_or_else(Instructions::widest)
    }

    /// Cases that they move at a time.
    fn lanes(self) -> usize {
        match self {
            Instructions::Scalar => 1,
            Instructions::Baseline => BASELINE * Pair::WIDTH,
            Instructions::Avx2 => AVX2 * self.lanes_of_a_vector(),
            Instructions::Avx512 => AVX512 * self.lanes_of_a_vector(),
        }
    }

    /// Whether this processor has them.
    pub fn is_available(self) -> bool {
        match self {
            Instructions::Scalar | Instructions::Baseline => true,
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => x86::has_avx2(),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => x86::has_avx512(),
            #[cfg(not(target_arch = "x86_64"))]
            Instructions::Avx2 | Instructions::Avx512 => false,
        }
    }

    /// Cases that one vector holds.
    pub fn lanes_of_a_vector(self) -> usize {
        match self {
            Instructions::Scalar | Instructions::Baseline => 1,
            Instructions::Avx2 => 4,
            Instructions::Avx512 => 8,
        }
    }

    /// Does `work` by these instructions, on one vector at a time, for numbers with derivatives: their parts fill each
    /// other's waits, and one vector of them fills the caches. Where a vector is short, one case at a time.
    ///
    /// # Panics
    /// Where the processor does not have them.
    pub fn run_on_a_vector<W: Work>(self, work: W) -> W::Output {
        self.run_as::<f64, 1, 1, W>(work)
    }

    /// Does `work` by these instructions.
    ///
    /// # Panics
    /// Where the processor does not have them.
    pub fn run<W: Work>(self, work: W) -> W::Output {
        match const { W::IS_INTERPRETED } {
            true => self.run_as::<
                Wide<Pair, { INTERPRETED * BASELINE }>,
                { INTERPRETED * AVX2 },
                { INTERPRETED * AVX512 },
                W,
            >(work),
            false => self.run_as::<Wide<Pair, BASELINE>, AVX2, AVX512, W>(work),
        }
    }

    /// Does `work` on lanes of the baseline's kind, or on so many vectors of AVX2 or AVX-512.
    fn run_as<B: Lane, const OF_AVX2: usize, const OF_AVX512: usize, W: Work>(
        self,
        work: W,
    ) -> W::Output {
        match self {
            Instructions::Scalar => work.run::<f64>(),
            Instructions::Baseline => work.run::<B>(),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => {
                x86::with_avx2::<OF_AVX2, W>(work).expect("the processor has AVX2")
            }
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => {
                x86::with_avx512::<OF_AVX512, W>(work).expect("the processor has AVX-512")
            }
            #[cfg(not(target_arch = "x86_64"))]
            Instructions::Avx2 | Instructions::Avx512 => panic!("the processor has no {self:?}"),
        }
    }
}
