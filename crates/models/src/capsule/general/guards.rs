//! The guards of the family: each is positive while a mode lasts.

use capsulemap_engine::lane::{Lane, Mask, Series, series};

use super::equations::GeneralCapsule;
use super::springs::Touched;
use super::state::{EDGE, FORWARD, FRONT, FRONT_FORCE, GeneralJet, GeneralMode, REAR, REAR_FORCE};

impl<L: Lane, const FOLDS: bool> GeneralCapsule<L, FOLDS> {
    /// Writes a guard in numbers of another kind, `of` those here.
    #[inline(always)]
    pub(super) fn write_guard<G: Lane<Mask = L::Mask, Plain = L::Plain>>(
        &self,
        which: usize,
        mode: &GeneralMode<L>,
        jet: &GeneralJet<L>,
        of: impl Fn(L) -> G,
        guard: &mut Series<G>,
    ) {
        match which {
            EDGE => {
                *guard = series::zero();
                (guard[0], guard[1]) = (of(jet.until_edge), G::splat(-1.0));
            }
            FRONT if self.springs.is_rigid => self.write_rigid_stop(mode, jet, of, guard),
            FRONT => write_stop(mode.is_in_front(), of(self.springs.front.at), 1.0, jet, of, guard),
            REAR => write_stop(mode.is_in_rear(), of(self.springs.rear.at), -1.0, jet, of, guard),
            FRONT_FORCE | REAR_FORCE => self.write_stop_force(which, mode, jet, of, guard),
            _ => self.write_slip(which, mode, jet, of, guard),
        }
    }

    /// Writes a guard of the force of a stop.
    #[inline(always)]
    fn write_stop_force<G: Lane<Mask = L::Mask, Plain = L::Plain>>(
        &self,
        which: usize,
        mode: &GeneralMode<L>,
        jet: &GeneralJet<L>,
        of: impl Fn(L) -> G,
        guard: &mut Series<G>,
    ) {
        let as_touched = Touched { front: mode.is_in_front(), rear: mode.is_in_rear() };
        let [front, rear] = self.springs.stop_forces(&as_touched, [&jet.motion.r, &jet.relative]);
        let one = L::Plain::splat(1.0);
        let (force, touched, side) = match which {
            FRONT_FORCE => (&front, mode.front, one),
            _ => (&rear, mode.rear, one),
        };
        let side = L::Plain::select(touched, side, -side);
        for (term, force) in guard.iter_mut().zip(force) {
            *term = of(*force).scaled(side);
        }
    }

    /// Writes one of the guards of the ground.
    #[inline(always)]
    fn write_slip<G: Lane<Mask = L::Mask, Plain = L::Plain>>(
        &self,
        which: usize,
        mode: &GeneralMode<L>,
        jet: &GeneralJet<L>,
        of: impl Fn(L) -> G,
        guard: &mut Series<G>,
    ) {
        let (zero, one) = (L::Plain::splat(0.0), L::Plain::splat(1.0));
        let (side, mut limit) = match which {
            FORWARD => (-one, self.ground.forward.break_away),
            _ => (one, self.ground.backward.break_away),
        };
        if FOLDS {
            limit = self.folds.raised_by_start(limit, &jet.folds);
        }
        let slides = mode.slides();
        let factor = L::Plain::select(slides, mode.slip.plain(), side);
        for (term, (push, y2)) in guard.iter_mut().zip(jet.push.iter().zip(&jet.motion.y2)) {
            *term = G::select(slides, of(*y2), of(*push)).scaled(factor);
        }
        guard[0] = guard[0] + G::select(slides, G::from_plain(zero), of(limit));
        // A capsule that is thrown leaves at once, at the time of the jump.
        let thrown = (mode.thrown.plain() + side).abs().lt(L::Plain::splat(0.5));
        if thrown.any() {
            for (k, term) in guard.iter_mut().enumerate() {
                let falls = G::splat(if k == 1 { -1.0 } else { 0.0 });
                *term = G::select(thrown, falls, *term);
            }
        }
    }
}

/// Writes the guard of a stop at `at`, which the mass meets in the direction `side` of r.
#[inline(always)]
fn write_stop<L: Lane, G: Lane<Mask = L::Mask, Plain = L::Plain>>(
    touched: L::Mask,
    at: G,
    side: f64,
    jet: &GeneralJet<L>,
    of: impl Fn(L) -> G,
    guard: &mut Series<G>,
) {
    let side = L::Plain::splat(side);
    let side = L::Plain::select(touched, side, -side);
    for (term, r) in guard.iter_mut().zip(&jet.motion.r) {
        *term = of(*r).scaled(side);
    }
    guard[0] = (of(jet.motion.r[0]) - at).scaled(side);
}
