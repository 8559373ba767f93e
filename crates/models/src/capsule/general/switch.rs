//! How the modes of the family follow each other.

use capsulemap_engine::flow::Event;
use capsulemap_engine::lane::{Lane, Mask};

use super::equations::GeneralCapsule;
use super::state::{Due, EDGE, FORWARD, FRONT, FRONT_FORCE, GeneralMode, REAR, REAR_FORCE};
use crate::capsule::locomotion::direction;
use crate::capsule::state::{EventKind, State};

impl<L: Lane, const FOLDS: bool> GeneralCapsule<L, FOLDS> {
    /// The mode of a state at a time, which is moved onto rest where it rests.
    pub(super) fn mode_at(&self, time: L, state: &mut State<L>) -> GeneralMode<L> {
        let zero = L::splat(0.0);
        let (front, rear) = (self.springs.front.at, self.springs.rear.at);
        let mut mode = GeneralMode {
            front: front.lt(state.r),
            rear: state.r.lt(rear) & self.springs.has_rear(),
            passed: self.drive.passed_at(time),
            ..GeneralMode::default()
        };
        if self.drive.is_prescribed() {
            (mode.front, mode.rear) = (L::Mask::splat(false), L::Mask::splat(false));
        }
        if self.springs.is_rigid {
            mode.front = L::Mask::splat(false);
            mode.slip = direction(state.y2);
            mode.front = self.start_at_stop(&mode, time, state);
        }
        if self.springs.release_by_force {
            self.let_go_of_pulled(&mut mode, state);
        }
        let push = self.push_at_stop(&mode, time, state);
        let breaks_away = self.beyond_rest(push);
        let from_rest = L::select(breaks_away, direction(push), zero);
        mode.slip = L::select(state.y2.abs().le(zero), from_rest, direction(state.y2));
        state.y2 = L::select(mode.slides(), state.y2, zero);
        state.y1 = L::select(self.lasts(&mode), state.y2, state.y1);
        if self.drive.is_prescribed() {
            self.place_mass(L::Mask::splat(true), &mode, time, state);
        }
        mode
    }

    /// Obeys guard `which`; returns the event there.
    #[inline(always)]
    pub(super) fn obey(&self, which: usize, mut due: Due<'_, L>) -> L {
        let due = &mut due;
        let event = match which {
            EDGE => self.pass_edge(due),
            FRONT if self.springs.is_rigid => self.meet_rigid_stop(due),
            FRONT | REAR => self.meet_stop(which, due),
            FRONT_FORCE | REAR_FORCE => turn_force(which, due),
            _ => self.obey_ground(which, due),
        };
        self.note_jumps(which, due);
        event
    }

    /// Where a push exceeds what holds the capsule at rest.
    #[inline(always)]
    pub(super) fn beyond_rest(&self, push: L) -> L::Mask {
        let (forward, backward) = (self.ground.forward.break_away, self.ground.backward.break_away);
        forward.lt(push) | push.lt(-backward)
    }

    /// Notes what a force that has jumped at the event of guard `which` does at once.
    #[inline(always)]
    fn note_jumps(&self, which: usize, due: &mut Due<'_, L>) {
        let may_jump = match which {
            // At a rigid stop the capsule feels every drive.
            EDGE => self.reacts || self.springs.is_rigid,
            FRONT | REAR => self.springs.has_damped_stops || self.springs.is_rigid,
            _ => false,
        };
        if may_jump {
            self.note_jump(due);
        }
        if self.springs.is_rigid {
            self.note_let_go(due);
            if which != FRONT {
                // The force on a mass that has just been let go may have jumped.
                let Due { here, mode, zeros, .. } = due;
                let least = zeros[FRONT].min(L::splat(2.0));
                zeros[FRONT] = L::select(*here, least, zeros[FRONT]);
                mode.left = mode.left & !*here;
            }
        }
    }

    /// Notes whether the force on a capsule at rest has jumped beyond what holds it.
    #[inline(always)]
    fn note_jump(&self, due: &mut Due<'_, L>) {
        let Due { here, mode, state, time, .. } = due;
        let push = self.push_at_stop(mode, *time, state);
        let thrown = L::select(self.beyond_rest(push), direction(push), L::splat(0.0));
        mode.thrown = L::select(*here & !mode.slides(), thrown, mode.thrown);
    }

    /// Passes the next edge of the drive; returns the event there.
    #[inline(always)]
    fn pass_edge(&self, due: &mut Due<'_, L>) -> L {
        let (here, before) = (due.here, due.mode.passed);
        due.mode.passed = before + L::select(here, L::splat(1.0), L::splat(0.0));
        if self.drive.velocity_jumps() {
            self.jump_with_edge(before, due);
        }
        L::select(here, EventKind::DriveEdge.code(), L::splat(0.0))
    }

    /// Meets or leaves a stop; returns the event there.
    #[inline(always)]
    fn meet_stop(&self, which: usize, due: &mut Due<'_, L>) -> L {
        let Due { here, mode, state, zeros, .. } = due;
        let here = *here;
        let stop = if which == FRONT { &self.springs.front } else { &self.springs.rear };
        let (touched, beyond, events) = mode.contact(which == FRONT);
        let code = L::select(*touched, events[0].code(), events[1].code());
        // A mass that its stop has let go of before passes its place without an event.
        let code = L::select(*beyond, L::splat(0.0), code);
        *touched = (*touched & !here) | (!*touched & !*beyond & here);
        *beyond = *beyond & !here;
        state.r = L::select(here, stop.at, state.r);
        zeros[which] = L::select(here, L::splat(1.0), zeros[which]);
        L::select(here, code, L::splat(0.0))
    }

    /// Lets go of a mass at the start that its stop would pull.
    fn let_go_of_pulled(&self, mode: &mut GeneralMode<L>, state: &State<L>) {
        let (zero, touched) = (L::splat(0.0), mode.touched());
        mode.beyond_front = mode.front & self.springs.of_front(&touched, state).lt(zero);
        mode.beyond_rear = mode.rear & zero.lt(self.springs.of_rear(&touched, state));
        mode.front = mode.front & !mode.beyond_front;
        mode.rear = mode.rear & !mode.beyond_rear;
    }

    /// Leaves rest, comes to rest or turns round; returns the event there.
    #[inline(always)]
    fn obey_ground(&self, which: usize, due: &mut Due<'_, L>) -> L {
        let Due { here, mode, state, zeros, time } = due;
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let side = if which == FORWARD { one } else { -one };
        let slides = mode.slides();
        let (leaves, stops) = (*here & !slides, *here & slides);
        state.y2 = L::select(stops, zero, state.y2);
        state.y1 = L::select(stops & self.lasts(mode), zero, state.y1);
        if self.drive.is_prescribed() {
            self.place_mass(stops, mode, *time, state);
        }
        // One stored force decides between rest and reversal; friction cannot push the capsule on in
        // the direction it was brought to rest from.
        let against = -(mode.slip * self.push_at_stop(mode, *time, state));
        let reverses = stops & self.ground.towards(-mode.slip).break_away.lt(against);
        let sticks = stops & !reverses;
        let onset = if which == FORWARD { EventKind::SlipForward } else { EventKind::SlipBackward };
        let is_thrown = leaves & L::splat(0.5).lt(mode.thrown * side);
        let smooth = self.ground.towards(side).onset_zeros();
        mode.thrown = L::select(leaves, zero, mode.thrown);
        mode.slip = L::select(leaves, side, mode.slip);
        mode.slip = L::select(reverses, -mode.slip, L::select(sticks, zero, mode.slip));
        let of_leaving = L::select(is_thrown, one, smooth);
        let of_stopping = L::select(reverses, one, L::select(sticks, zero, zeros[FORWARD]));
        zeros[FORWARD] = L::select(leaves, of_leaving, of_stopping);
        let code = L::select(leaves, onset.code(), zero);
        let code = L::select(reverses, EventKind::Reversal.code(), code);
        L::select(sticks, EventKind::Stick.code(), code)
    }
}

/// Lets go of a mass that its stop would pull, or touches one that it would push; returns the event there.
#[inline(always)]
fn turn_force<L: Lane>(which: usize, due: &mut Due<'_, L>) -> L {
    let Due { here, mode, zeros, .. } = due;
    let here = *here;
    let (touched, beyond, events) = mode.contact(which == FRONT_FORCE);
    let code = L::select(*touched, events[0].code(), events[1].code());
    let (lets_go, touches) = (here & *touched, here & *beyond);
    *touched = (*touched & !lets_go) | touches;
    *beyond = (*beyond & !touches) | lets_go;
    zeros[which] = L::select(here, L::splat(1.0), zeros[which]);
    L::select(here, code, L::splat(0.0))
}
