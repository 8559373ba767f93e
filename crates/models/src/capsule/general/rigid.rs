//! A front stop that is rigid: impacts with a coefficient of restitution, and contact that lasts.

use capsulemap_engine::flow::Event;
use capsulemap_engine::lane::{Lane, Mask, Series};

use super::equations::GeneralCapsule;
use super::state::{BACKWARD, Due, FORWARD, FRONT, GeneralJet, GeneralMode, REAR};
use crate::capsule::locomotion::{Jump, direction};
use crate::capsule::state::{EventKind, State, is_event};

/// Flights that are all over within this share of the period are left out.
const OVER: f64 = 1e-9;
/// A mass that starts this close to a rigid stop, relative to the motion, starts at it.
const AT_STOP: f64 = 1e-10;

/// What an impact on the rigid stop leaves.
struct AfterImpact<L: Lane> {
    y1: L,
    y2: L,
    /// Where the mass stays at the stop.
    lasts: L::Mask,
}

impl<L: Lane, const FOLDS: bool> GeneralCapsule<L, FOLDS> {
    /// Where the mass stays at the rigid stop.
    #[inline(always)]
    pub(super) fn lasts(&self, mode: &GeneralMode<L>) -> L::Mask {
        match self.springs.is_rigid {
            true => mode.front,
            false => L::Mask::splat(false),
        }
    }

    /// What moves mass and capsule together but for the friction [N].
    #[inline(always)]
    fn common_push(&self, mode: &GeneralMode<L>, time: L) -> L {
        let along = self.ground.push + self.ground.pull;
        match self.reacts {
            true => along,
            false => self.drive.force_at(mode.passed, time) + along,
        }
    }

    /// What moves the capsule but for the friction, what the rigid stop transmits included [N].
    #[inline(always)]
    pub(super) fn push_at_stop(&self, mode: &GeneralMode<L>, time: L, state: &State<L>) -> L {
        let push = self.push(mode, time, state);
        match self.springs.is_rigid {
            true => L::select(mode.front, self.common_push(mode, time), push),
            false => push,
        }
    }

    /// The direction of sliding of a capsule whose mass stays at the rigid stop: of one at rest that in which the forces on both would
    /// break it away, if they do.
    #[inline(always)]
    fn slip_at_stop(&self, mode: &GeneralMode<L>, time: L) -> L {
        let push = self.common_push(mode, time);
        let thrown = L::select(self.beyond_rest(push), direction(push), L::splat(0.0));
        L::select(mode.slides(), mode.slip, thrown)
    }

    /// The acceleration of the mass, relative to the capsule, that the forces between both would give it at a rigid stop: of the force
    /// in a contact that lasts, its sign [m/s^2].
    #[inline(always)]
    fn towards_stop(&self, mode: &GeneralMode<L>, time: L, state: &State<L>) -> L {
        let drive = self.drive.force_at(mode.passed, time);
        let force = self.springs.force(&mode.touched(), state);
        let of_mass = (drive - force + self.ground.pull) * self.inverse_m1;
        let slip = self.slip_at_stop(mode, time);
        let moves = self.push(mode, time, state) - self.ground.resistance(slip, state.y2);
        let slides = L::splat(0.5).lt(slip * slip);
        of_mass - L::select(slides, moves * self.inverse_m2, L::splat(0.0))
    }

    /// What an impact on the rigid stop leaves.
    ///
    /// # Method
    ///
    /// The relative velocity is turned round and multiplied with the restitution e; the friction, which is finite, has no part in it.
    /// A mass that the forces between both press on to the stop with a relative acceleration a flies 2 v/a after an impact that it
    /// leaves with the relative velocity v, and after the next ones e, e^2, ... times as long. Where under the acceleration right after the
    /// impact all these flights are over within [`OVER`] periods, they are left out: the mass stays at the stop at once. What this
    /// changes is of the second order in that time.
    #[inline(always)]
    fn impact(&self, mode: &GeneralMode<L>, time: L, state: &State<L>) -> AfterImpact<L> {
        let one = L::splat(1.0);
        let (together, back) = self.thrown_back(state);
        let y1 = together - self.share_of_capsule * back;
        let y2 = together + self.share_of_mass * back;
        let flies = GeneralMode { slip: direction(y2), ..*mode };
        let pressed = self.towards_stop(&flies, time, &State { y1, y2, ..*state });
        let least =
            pressed * (one - self.springs.restitution) * L::splat(OVER) * self.drive.period();
        let lasts = L::splat(0.0).lt(pressed) & (back + back).le(least);
        AfterImpact {
            y1: L::select(lasts, together, y1),
            y2: L::select(lasts, together, y2),
            lasts,
        }
    }

    /// What the event at the end of a step changes of the velocities, in a state before it; flights that are left out are not, as what
    /// they would lose is of the second order in their time.
    #[inline(always)]
    pub(super) fn jump_at_stop(&self, event: L, state: &State<L>) -> Jump<L> {
        let (zero, half, speed) = (L::splat(0.0), L::splat(0.5), state.y1 - state.y2);
        let (together, back) = self.thrown_back(state);
        Jump {
            here: is_event(event, EventKind::ContactClosed),
            y2: together + self.share_of_mass * back,
            lost: half * self.m1 * self.share_of_capsule * (speed * speed - back * back),
            driven: [zero; 2],
        }
    }

    /// The velocity of mass and capsule together, which an impact does not change, and that with which it throws the mass back from
    /// the capsule.
    #[inline(always)]
    fn thrown_back(&self, state: &State<L>) -> (L, L) {
        let speed = state.y1 - state.y2;
        (state.y2 + self.share_of_mass * speed, self.springs.restitution * speed)
    }

    /// Meets the rigid stop or is let go by it; returns the event there.
    #[inline(always)]
    pub(super) fn meet_rigid_stop(&self, due: &mut Due<'_, L>) -> L {
        let Due { here, mode, state, zeros, time } = due;
        let (here, zero) = (*here, L::splat(0.0));
        let (opens, meets) = (here & mode.front, here & !mode.front);
        // What is let go by a force that falls to zero leaves with its third derivative, by one that jumps with its second.
        let of_opening = L::select(mode.let_go, L::splat(2.0), L::splat(3.0));
        zeros[FRONT] = L::select(opens, of_opening, zeros[FRONT]);
        state.r = L::select(here, self.springs.front.at, state.r);
        mode.front = mode.front & !opens;
        mode.left = (mode.left & !here) | (opens & !mode.let_go);
        mode.let_go = mode.let_go & !here;
        if meets.any() {
            let after = self.impact(mode, *time, state);
            state.y1 = L::select(meets, after.y1, state.y1);
            state.y2 = L::select(meets, after.y2, state.y2);
            mode.slip = L::select(meets, direction(state.y2), mode.slip);
            mode.thrown = L::select(meets, zero, mode.thrown);
            mode.front = mode.front | (meets & after.lasts);
            let leaves = state.y1.lt(state.y2);
            let of_leaving = L::select(leaves, L::splat(1.0), L::splat(2.0));
            let of_meeting = L::select(after.lasts, zero, of_leaving);
            zeros[FRONT] = L::select(meets, of_meeting, zeros[FRONT]);
            // The velocities jump: what another guard has left it may meet again at once.
            for other in [REAR, FORWARD, BACKWARD] {
                zeros[other] = L::select(meets, zero, zeros[other]);
            }
        }
        let closed = L::select(meets, EventKind::ContactClosed.code(), zero);
        L::select(opens, EventKind::ContactOpened.code(), closed)
    }

    /// Notes where the force of a contact that lasts has jumped below zero, so that the rigid stop lets go at once.
    #[inline(always)]
    pub(super) fn note_let_go(&self, due: &mut Due<'_, L>) {
        let Due { here, mode, state, time, .. } = due;
        let pulls = self.towards_stop(mode, *time, state).lt(L::splat(0.0));
        mode.let_go = mode.let_go | (*here & mode.front & pulls);
    }

    /// Puts a mass that starts at the rigid stop there, and tells where it stays; a start behind the stop is no number.
    pub(super) fn start_at_stop(
        &self,
        mode: &GeneralMode<L>,
        time: L,
        state: &mut State<L>,
    ) -> L::Mask {
        let (at, speed) = (self.springs.front.at, state.y1 - state.y2);
        let fast = L::splat(AT_STOP) * (state.y1.abs() + state.y2.abs() + self.usual_speed);
        let far = L::splat(AT_STOP) * (state.r.abs() + at.abs()) + fast / self.drive.omega;
        let distance = state.r - at;
        let is_near = distance.abs().le(far);
        let at_stop = State { r: at, ..*state };
        let pressed = L::splat(0.0).lt(self.towards_stop(mode, time, &at_stop));
        let stays = is_near & speed.abs().le(fast) & pressed;
        // Rounding does not put a mass behind the stop.
        let is_behind = L::splat(0.0).lt(distance);
        state.r = L::select(stays | (is_near & is_behind), at, state.r);
        state.r = L::select(is_behind & !is_near, L::splat(f64::NAN), state.r);
        let together = state.y2 + self.share_of_mass * speed;
        state.y1 = L::select(stays, together, state.y1);
        state.y2 = L::select(stays, together, state.y2);
        stays
    }

    /// Where a mass is just let go by a force that has fallen to zero, so that its relative acceleration is zero, not rounding.
    #[inline(always)]
    pub(super) fn leaves_now(&self, mode: &GeneralMode<L>, state: &State<L>) -> L::Mask {
        let distance = (state.r - self.springs.front.at).abs() + (state.y1 - state.y2).abs();
        mode.left & distance.le(L::splat(0.0))
    }

    /// Coefficient `k` of the force of a contact that lasts [N]; known to one order less than the motion.
    #[inline(always)]
    pub(super) fn bearing_term(&self, jet: &GeneralJet<L>, k: usize) -> L {
        let start = if k == 0 { self.ground.pull } else { L::splat(0.0) };
        let on_mass = jet.drive[k] - jet.motion.force[k] + start;
        on_mass - self.m1 * jet.motion.acceleration[k]
    }

    /// The force of a contact that lasts, where it does [N].
    #[inline(always)]
    pub(super) fn add_bearing(
        &self,
        mode: &GeneralMode<L>,
        jet: &GeneralJet<L>,
        front: &mut Series<L>,
    ) {
        if self.springs.is_rigid {
            for k in 0..front.len() - 1 {
                front[k] = L::select(mode.front, self.bearing_term(jet, k), front[k]);
            }
        }
    }

    /// Writes the guard of the rigid stop: the force of a contact that lasts, else the distance to it.
    #[inline(always)]
    pub(super) fn write_rigid_stop<G: Lane<Mask = L::Mask, Plain = L::Plain>>(
        &self,
        mode: &GeneralMode<L>,
        jet: &GeneralJet<L>,
        of: impl Fn(L) -> G,
        guard: &mut Series<G>,
    ) {
        let (zero, at) = (L::splat(0.0), self.springs.front.at);
        let last = guard.len() - 1;
        for (k, term) in guard.iter_mut().enumerate() {
            let start = if k == 0 { at } else { zero };
            let bearing = if k < last { self.bearing_term(jet, k) } else { zero };
            let falls = if k == 1 { L::splat(-1.0) } else { zero };
            let bearing = L::select(mode.let_go, falls, bearing);
            *term = of(L::select(mode.front, bearing, start - jet.motion.r[k]));
        }
    }
}
