//! How the modes of the family follow each other.

use capsulemap_engine::flow::{Event, Zeros};
use capsulemap_engine::lane::Lane;

use super::equations::{FORWARD, FRONT, GeneralCapsule};
use super::state::GeneralMode;
use crate::capsule::locomotion::direction;
use crate::capsule::state::{EventKind, State};

impl<L: Lane> GeneralCapsule<L> {
    /// The mode of a state at a time, which is moved onto rest where it rests.
    pub(super) fn mode_at(&self, time: L, state: &mut State<L>) -> GeneralMode<L> {
        let zero = L::splat(0.0);
        let (front, rear) = (self.springs.front.at, self.springs.rear.at);
        let mut mode = GeneralMode {
            front: front.lt(state.r),
            rear: state.r.lt(rear) & self.springs.has_rear(),
            slip: zero,
            passed: self.drive.passed_at(time),
            thrown: zero,
        };
        let push = self.push(&mode, time, state);
        let breaks_away = self.beyond_rest(push);
        let from_rest = L::select(breaks_away, direction(push), zero);
        mode.slip = L::select(state.y2.abs().le(zero), from_rest, direction(state.y2));
        state.y2 = L::select(mode.slides(), state.y2, zero);
        mode
    }

    /// Where a push exceeds what holds the capsule at rest.
    #[inline(always)]
    fn beyond_rest(&self, push: L) -> L::Mask {
        let (forward, backward) = (self.ground.forward.break_away, self.ground.backward.break_away);
        forward.lt(push) | push.lt(-backward)
    }

    /// Notes whether the force on a capsule at rest has jumped beyond what holds it.
    #[inline(always)]
    fn note_jump(&self, due: L::Mask, mode: &mut GeneralMode<L>, state: &State<L>, time: L) {
        let push = self.push(mode, time, state);
        let thrown = L::select(self.beyond_rest(push), direction(push), L::splat(0.0));
        mode.thrown = L::select(due & !mode.slides(), thrown, mode.thrown);
    }

    /// Passes the next edge of the drive where `due`; returns the event there.
    #[inline(always)]
    pub(super) fn pass_edge(
        &self,
        due: L::Mask,
        mode: &mut GeneralMode<L>,
        state: &State<L>,
        time: L,
    ) -> L {
        mode.passed = mode.passed + L::select(due, L::splat(1.0), L::splat(0.0));
        if self.reacts {
            self.note_jump(due, mode, state, time);
        }
        L::select(due, EventKind::DriveEdge.code(), L::splat(0.0))
    }

    /// Meets or leaves a stop where `due`; returns the event there.
    #[inline(always)]
    pub(super) fn meet_stop(
        &self,
        which: usize,
        due: L::Mask,
        mode: &mut GeneralMode<L>,
        (state, zeros): (&mut State<L>, &mut Zeros<L>),
        time: L,
    ) -> L {
        let (touched, stop, events) = match which {
            FRONT => (
                &mut mode.front,
                &self.springs.front,
                [EventKind::ContactOpened, EventKind::ContactClosed],
            ),
            _ => (
                &mut mode.rear,
                &self.springs.rear,
                [EventKind::RearContactOpened, EventKind::RearContactClosed],
            ),
        };
        let code = L::select(*touched, events[0].code(), events[1].code());
        *touched = (*touched & !due) | (!*touched & due);
        state.r = L::select(due, stop.at, state.r);
        zeros[which] = L::select(due, L::splat(1.0), zeros[which]);
        if self.springs.has_damped_stops {
            self.note_jump(due, mode, state, time);
        }
        L::select(due, code, L::splat(0.0))
    }

    /// Leaves rest, comes to rest or turns round where `due`; returns the event there.
    #[inline(always)]
    pub(super) fn obey_ground(
        &self,
        which: usize,
        due: L::Mask,
        mode: &mut GeneralMode<L>,
        (state, zeros): (&mut State<L>, &mut Zeros<L>),
        time: L,
    ) -> L {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let side = if which == FORWARD { one } else { -one };
        let slides = mode.slides();
        let (leaves, stops) = (due & !slides, due & slides);
        state.y2 = L::select(stops, zero, state.y2);
        // One stored force decides between rest and reversal; friction cannot push the capsule on in
        // the direction it was brought to rest from.
        let against = -(mode.slip * self.push(mode, time, state));
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
