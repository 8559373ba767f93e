//! A guard that is due.

use capsulemap_engine::flow::Zeros;
use capsulemap_engine::lane::Lane;

use crate::text::mode::TextMode;

/// A guard that is due, with what its event changes.
pub(crate) struct Due<'a, L: Lane, const N: usize> {
    /// Which guard.
    pub(crate) which: usize,
    /// In which lanes.
    pub(crate) here: L::Mask,
    pub(crate) mode: &'a mut TextMode<L>,
    pub(crate) state: &'a mut [L; N],
    pub(crate) zeros: &'a mut Zeros<L>,
    /// When, since the start of the cycle.
    pub(crate) time: L,
    /// Where a contact that has lasted opens, so that nothing is reset.
    pub(crate) opens: L::Mask,
    /// With which velocity a contact that may last is met.
    pub(crate) came: L,
}
