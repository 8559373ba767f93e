//! A mass whose motion relative to the capsule is prescribed: only the capsule is left to move.

use capsulemap_engine::lane::{Lane, Mask, ORDER};

use super::equations::GeneralCapsule;
use super::state::{Due, FORWARD, GeneralJet, GeneralMode};
use crate::capsule::locomotion::{Jump, direction};
use crate::capsule::state::{EventKind, State, is_event};

impl<L: Lane, const FOLDS: bool> GeneralCapsule<L, FOLDS> {
    /// What moves the capsule but for the friction: the inertia of the mass, and what acts along the ground [N].
    #[inline(always)]
    pub(super) fn push_of_prescribed(&self, mode: &GeneralMode<L>, time: L) -> L {
        let [_, _, acceleration] = self.drive.prescribed_at(mode.passed, time);
        self.ground.push + self.ground.pull - self.m1 * acceleration
    }

    /// Puts a mass where its motion is prescribed to be at a time, where `here`.
    #[inline(always)]
    pub(super) fn place_mass(
        &self,
        here: L::Mask,
        mode: &GeneralMode<L>,
        time: L,
        state: &mut State<L>,
    ) {
        let [place, speed, _] = self.drive.prescribed_at(mode.passed, time);
        state.r = L::select(here, place, state.r);
        state.y1 = L::select(here, state.y2 + speed, state.y1);
    }

    /// Writes the series of the motion (m1 + m2) y2' = -m1 xi'' - f + what acts along the ground, where r = xi; the drive is then the
    /// force between mass and capsule.
    #[inline(always)]
    pub(super) fn expand_prescribed(
        &self,
        mode: &GeneralMode<L>,
        time: L,
        state: &State<L>,
        jet: &mut GeneralJet<L>,
    ) {
        let zero = L::splat(0.0);
        let prescribed = self.drive.prescribed(mode.passed, time);
        let (any_slides, drag) = (mode.slides().any(), self.ground.towards(mode.slip));
        let motion = &mut jet.motion;
        (motion.x2[0], motion.y2[0]) = (state.x2, state.y2);
        motion.decay[0] = if any_slides { drag.decay_start(mode.slip, state.y2) } else { zero };
        drag.write_exponent_term(mode.slip, motion, 0);
        self.begin_folds(state, jet);
        let inverse_mass = self.share_of_mass * self.inverse_m1;
        for k in 0..ORDER + 1 {
            let of_mass = if k == 0 { self.ground.pull } else { zero };
            let constant = self.pushed_term(jet, k) + of_mass;
            jet.push[k] = constant - self.m1 * prescribed.acceleration[k];
            if k < ORDER {
                self.write_capsule_term(mode, any_slides, &drag, inverse_mass, jet, k);
            } else {
                jet.motion.acceleration[k] = zero;
            }
        }
        jet.relative = prescribed.speed;
        jet.motion.r = prescribed.place;
        for k in 0..ORDER + 1 {
            let constant = if k == 0 { self.ground.pull } else { zero };
            let motion = &mut jet.motion;
            motion.y1[k] = motion.y2[k] + prescribed.speed[k];
            motion.force[k] = zero;
            let acceleration = prescribed.acceleration[k] + motion.acceleration[k];
            jet.drive[k] = self.m1 * acceleration - constant;
        }
    }

    /// Passes an edge at which the prescribed velocity jumps, `before` edges after the start of the cycle: momentum along the ground stays.
    #[inline(always)]
    pub(super) fn jump_with_edge(&self, before: L, due: &mut Due<'_, L>) {
        let Due { here, mode, state, zeros, .. } = due;
        let (here, zero) = (*here, L::splat(0.0));
        let speed = self.drive.speed_after(mode.passed);
        let change = speed - self.drive.speed_after(before);
        state.y2 = L::select(here, state.y2 - self.share_of_mass * change, state.y2);
        state.y1 = L::select(here, state.y2 + speed, state.y1);
        mode.slip = L::select(here, direction(state.y2), mode.slip);
        mode.thrown = L::select(here, zero, mode.thrown);
        zeros[FORWARD] = L::select(here, zero, zeros[FORWARD]);
    }

    /// What an edge at the end of a step changes of the velocities, in a mode and a state before it.
    #[inline(always)]
    pub(super) fn jump_at_edge(
        &self,
        event: L,
        mode: &GeneralMode<L>,
        state: &State<L>,
    ) -> Jump<L> {
        let before = self.drive.speed_after(mode.passed);
        let after = self.drive.speed_after(mode.passed + L::splat(1.0));
        let half = L::splat(0.5) * self.m1 * self.share_of_capsule;
        Jump {
            here: is_event(event, EventKind::DriveEdge),
            y2: state.y2 - self.share_of_mass * (after - before),
            lost: L::splat(0.0),
            driven: [half * (before * before), half * (after * after)],
        }
    }
}
