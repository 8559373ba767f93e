//! The equations of the family over folds: what folds add to them, which is nothing without.

use capsulemap_engine::flow::Stroboscopic;
use capsulemap_engine::lane::{Lane, series};

use super::equations::GeneralCapsule;
use super::state::GeneralJet;
use crate::capsule::state::State;

impl<L: Lane, const FOLDS: bool> GeneralCapsule<L, FOLDS> {
    /// The capsule on even ground as the way is at a place: what happens at an instant knows no other.
    #[inline(always)]
    pub(super) fn at_place(&self, state: &State<L>) -> Self {
        GeneralCapsule { ground: self.ground.at(&self.folds.at(state.place)), ..*self }
    }

    /// Begins the series of the folds, where there are any.
    #[inline(always)]
    pub(super) fn begin_folds(&self, state: &State<L>, jet: &mut GeneralJet<L>) {
        if FOLDS {
            jet.place = state.place;
            self.folds.begin(state.place, &mut jet.folds);
        }
    }

    /// Writes term `k` of the folds from those of x2, where there are any.
    #[inline(always)]
    pub(super) fn move_on(&self, jet: &mut GeneralJet<L>, k: usize) {
        if FOLDS {
            self.folds.move_on(&jet.motion.x2, &mut jet.folds, k);
        }
    }

    /// The place between two folds `h` after the start of a step, in spacings.
    #[inline(always)]
    pub(super) fn place(&self, jet: &GeneralJet<L>, h: L) -> L {
        jet.place + series::change(&jet.motion.x2, h) * self.folds.per_length
    }

    /// Term `k` of the force of the ground on the capsule but for what resists its motion [N].
    #[inline(always)]
    pub(super) fn pushed_term(&self, jet: &GeneralJet<L>, k: usize) -> L {
        let even = if k == 0 { self.ground.push } else { L::splat(0.0) };
        if FOLDS { even + self.folds.push_term(&jet.folds, k) } else { even }
    }
}

impl<L: Lane> Stroboscopic<L, 4> for GeneralCapsule<L, true> {
    #[inline(always)]
    fn point(state: &State<L>) -> [L; 4] {
        [state.r, state.y1, state.y2, state.place]
    }

    #[inline(always)]
    fn state([r, y1, y2, place]: [L; 4]) -> State<L> {
        State { r, y1, x2: L::splat(0.0), y2, place }
    }

    #[inline(always)]
    fn moved_to(from: State<L>, [r, y1, y2, place]: [L; 4]) -> State<L> {
        State { r, y1, y2, place, ..from }
    }
}
