//! A piece of work on lanes, and how many vectors it fills.

use super::Lane;

/// Vectors side by side, so that one fills the waits of another; measured in `benches/README.md`.
pub(super) const BASELINE: usize = 2;
/// The same for AVX2.
pub(super) const AVX2: usize = 2;
/// The same for AVX-512.
pub(super) const AVX512: usize = 2;

/// So many times as many where what is followed is interpreted.
pub(super) const INTERPRETED: usize = 2;

/// A piece of work that is written once for lanes of any kind.
///
/// `run` and everything that it calls on lanes in every step must be `#[inline(always)]`: what is not inlined
/// gives the same bits, but is compiled without the instructions at hand and slow (by a factor of up to
/// thirty). [`in_lanes!`](crate::in_lanes) puts the attribute on all functions of an `impl` block.
pub trait Work {
    /// Whether the expansion of what it follows is interpreted: then more vectors share the cost of reading an instruction.
    const IS_INTERPRETED: bool = false;

    /// What it yields.
    type Output;
    /// Does it on lanes of the kind `L`.
    fn run<L: Lane>(self) -> Self::Output;
}
