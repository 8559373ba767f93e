//! The equations of the family of capsules in numbers of any kind: their series, their guards, and what is told of their motion.

use capsulemap_engine::flow::{Stroboscopic, Switched, Zeros};
use capsulemap_engine::lane::elementary::not_finite;
use capsulemap_engine::lane::{Lane, Mask, ORDER, Series, series, side_by_side};

use super::balance::Balance;
use super::drive::PiecewiseDrive;
use super::ground::Ground;
use super::springs::Springs;
use super::state::{GeneralJet, GeneralMode};
use crate::capsule::drag::Drag;
use crate::capsule::parameter::Parameter;
use crate::capsule::shape::{Reaction, Shape};
use crate::capsule::state::{EventKind, State};

/// Guard of the drive, the time until its next edge.
pub(super) const EDGE: usize = 0;
/// Guard of the front stop, `r - delta` while it is touched and `delta - r` apart from it.
pub(super) const FRONT: usize = 1;
/// Guard of the rear stop, `-delta_3 - r` while it is touched and `r + delta_3` apart from it.
pub(super) const REAR: usize = 2;
/// Guard of sliding, the speed; at rest, how far the push is below the break-away force.
pub(super) const FORWARD: usize = 3;
/// At rest, how far the push is above minus the break-away force of backward motion.
pub(super) const BACKWARD: usize = 4;

/// A capsule of the family with one set of parameters per lane.
///
/// Equations: m1 y1' = P - F - m1 g sin(alpha), m2 y2' = F - rho P - f - m2 g sin(alpha) + F_ext, the friction f set-valued at rest.
#[derive(Debug, Clone, Copy)]
pub struct GeneralCapsule<L: Lane> {
    pub(super) inverse_m1: L,
    pub(super) inverse_m2: L,
    pub(super) drive: PiecewiseDrive<L>,
    pub(super) springs: Springs<L>,
    pub(super) ground: Ground<L>,
    /// Whether the capsule takes up the reaction of the drive: rho = 1.
    pub(super) reacts: bool,
    /// The mean force along the ground, forward positive [N].
    mean_force: L,
    /// The speed at which the capsule has run away in its direction; infinite where that force is held [m/s].
    runaway_speed: L,
}

side_by_side!(GeneralCapsule { inverse_m1, inverse_m2, mean_force, runaway_speed } with { drive, springs, ground } alike { reacts });

impl<L: Lane> GeneralCapsule<L> {
    /// The capsule with these parameters, whose drive is at `phase` at the section [rad].
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape, phase: f64) -> Self {
        let balance = Balance::new(&of, shape);
        GeneralCapsule {
            inverse_m1: L::splat(1.0) / of(Parameter::M1),
            inverse_m2: L::splat(1.0) / of(Parameter::M2),
            drive: PiecewiseDrive::new(&of, shape, phase),
            springs: Springs::new(&of, shape),
            ground: Ground::new(&of, shape),
            reacts: shape.reaction == Reaction::Capsule,
            mean_force: balance.mean,
            runaway_speed: balance.runaway_speed(&of, shape),
        }
    }

    /// What moves the capsule but for the friction, in a state at a time [N].
    #[inline(always)]
    pub(super) fn push(&self, mode: &GeneralMode<L>, time: L, state: &State<L>) -> L {
        let push = self.springs.force(&mode.touched(), state) + self.ground.push;
        match self.reacts {
            true => push - self.drive.force_at(mode.passed, time),
            false => push,
        }
    }

    /// Writes the terms that a step begins with.
    #[inline(always)]
    fn begin(
        &self,
        mode: &GeneralMode<L>,
        state: &State<L>,
        jet: &mut GeneralJet<L>,
        drag: &Drag<L>,
    ) {
        let motion = &mut jet.motion;
        (motion.r[0], motion.y1[0], motion.x2[0], motion.y2[0]) =
            (state.r, state.y1, state.x2, state.y2);
        motion.force[0] = self.springs.force(&mode.touched(), state);
        motion.decay[0] =
            if mode.slides().any() { drag.decay_start(state.y2) } else { L::splat(0.0) };
        drag.write_exponent_term(mode.slip, motion, 0);
        self.springs.begin_squares(state.r, &mut jet.squares);
    }

    /// Writes term `k` of the forces between mass and capsule, and of what moves the capsule.
    #[inline(always)]
    fn write_forces(
        &self,
        mode: &GeneralMode<L>,
        slopes: (L, L),
        jet: &mut GeneralJet<L>,
        k: usize,
    ) {
        let motion = &mut jet.motion;
        let relative = motion.y1[k] - motion.y2[k];
        jet.relative[k] = relative;
        if k > 0 {
            let linear = slopes.0 * motion.r[k] + slopes.1 * relative;
            let touched = mode.touched();
            motion.force[k] =
                linear + self.springs.cubic_term(&touched, &motion.r, &mut jet.squares, k);
        }
        let constant = if k == 0 { self.ground.push } else { L::splat(0.0) };
        let push = motion.force[k] + constant;
        jet.push[k] = if self.reacts { push - jet.drive[k] } else { push };
    }

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
            FRONT => write_stop(mode.front, of(self.springs.front.at), 1.0, jet, of, guard),
            REAR => write_stop(mode.rear, of(self.springs.rear.at), -1.0, jet, of, guard),
            _ => self.write_slip(which, mode, jet, of, guard),
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
        let (side, limit) = match which {
            FORWARD => (-one, self.ground.forward.break_away),
            _ => (one, self.ground.backward.break_away),
        };
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

impl<L: Lane> Switched<L> for GeneralCapsule<L> {
    type State = State<L>;
    type Mode = GeneralMode<L>;
    type Jet = GeneralJet<L>;
    type Event = EventKind;

    const GUARDS: usize = 5;

    #[inline(always)]
    fn period(&self) -> L {
        self.drive.period()
    }

    fn start(&self, time: L, state: &mut State<L>) -> GeneralMode<L> {
        self.mode_at(time, state)
    }

    #[inline(always)]
    fn begin_cycle(&self, mask: L::Mask, mode: &mut GeneralMode<L>) {
        mode.passed = L::select(mask, L::splat(0.0), mode.passed);
    }

    #[inline(always)]
    fn expand(&self, mode: &GeneralMode<L>, time: L, state: &State<L>, jet: &mut GeneralJet<L>) {
        let zero = L::splat(0.0);
        let (slides, slopes) = (mode.slides(), self.springs.slopes(&mode.touched()));
        let (any_slides, drag) = (slides.any(), self.ground.towards(mode.slip));
        self.drive.force(mode.passed, time, &mut jet.drive);
        if self.drive.has_edges() {
            jet.until_edge = self.drive.until_next(mode.passed, time);
        }
        self.begin(mode, state, jet, &drag);
        for k in 0..ORDER {
            let per = L::Plain::splat(series::INVERSE[k + 1]);
            self.write_forces(mode, slopes, jet, k);
            let mut on_mass = jet.drive[k] - jet.motion.force[k];
            if k == 0 {
                on_mass = on_mass + self.ground.pull;
            }
            let motion = &mut jet.motion;
            motion.r[k + 1] = jet.relative[k].scaled(per);
            motion.y1[k + 1] = (on_mass * self.inverse_m1).scaled(per);
            if any_slides {
                let of_speed = [&motion.decay, &motion.y2];
                let friction = self.ground.force_term(&drag, mode.slip, of_speed, k);
                let moves = (jet.push[k] - friction) * self.inverse_m2;
                motion.acceleration[k] = L::select(slides, moves, zero);
                motion.y2[k + 1] = motion.acceleration[k].scaled(per);
                motion.x2[k + 1] = motion.y2[k].scaled(per);
                drag.write_exponent_term(mode.slip, motion, k + 1);
                motion.decay[k + 1] = drag.decay_term(mode.slip, motion, k);
            } else {
                motion.acceleration[k] = zero;
                (motion.y2[k + 1], motion.x2[k + 1], motion.decay[k + 1]) = (zero, zero, zero);
            }
        }
        self.write_forces(mode, slopes, jet, ORDER);
    }

    #[inline(always)]
    fn pace<'a>(&self, jet: &'a GeneralJet<L>) -> [&'a Series<L>; 2] {
        [&jet.motion.y1, &jet.motion.y2]
    }

    #[inline(always)]
    fn step_bound(
        &self,
        mode: &GeneralMode<L>,
        jet: &GeneralJet<L>,
        length: L::Plain,
        tolerance: f64,
    ) -> L::Plain {
        let (drag, motion) = (self.ground.towards(mode.slip), &jet.motion);
        drag.step_bound(mode.slip, &motion.decay, &motion.y2, length, tolerance)
    }

    #[inline(always)]
    fn watched(&self, which: usize, mode: &GeneralMode<L>) -> L::Mask {
        match which {
            EDGE => self.drive.has_next(mode.passed),
            REAR => self.springs.has_rear(),
            BACKWARD => !mode.slides(),
            _ => L::Mask::splat(true),
        }
    }

    #[inline(always)]
    fn guard(
        &self,
        which: usize,
        mode: &GeneralMode<L>,
        jet: &GeneralJet<L>,
        guard: &mut Series<L>,
    ) {
        self.write_guard(which, mode, jet, |term| term, guard);
    }

    #[inline(always)]
    fn plain_guard(
        &self,
        which: usize,
        mode: &GeneralMode<L>,
        jet: &GeneralJet<L>,
        _room: &mut Series<L>,
        guard: &mut Series<L::Plain>,
    ) {
        self.write_guard(which, mode, jet, L::plain, guard);
    }

    #[inline(always)]
    fn at(&self, jet: &GeneralJet<L>, h: L) -> State<L> {
        jet.motion.state(h)
    }

    #[inline(always)]
    fn motion(&self, jet: &GeneralJet<L>, h: L) -> (State<L>, State<L>) {
        jet.motion.motion(h)
    }

    #[inline(always)]
    fn beginning(&self, jet: &GeneralJet<L>) -> State<L> {
        jet.motion.beginning()
    }

    #[inline(always)]
    fn layered<'a>(
        &self,
        mode: &GeneralMode<L>,
        jet: &'a GeneralJet<L>,
    ) -> Option<(&'a Series<L>, L::Mask)> {
        let layer = self.ground.towards(mode.slip).layer()?;
        Some((&jet.motion.y2, mode.slides() & layer))
    }

    #[inline(always)]
    fn switch(
        &self,
        which: usize,
        due: L::Mask,
        mode: &mut GeneralMode<L>,
        state: &mut State<L>,
        zeros: &mut Zeros<L>,
        time: L,
    ) -> L {
        match which {
            EDGE => self.pass_edge(due, mode, state, time),
            FRONT | REAR => self.meet_stop(which, due, mode, (state, zeros), time),
            _ => self.obey_ground(which, due, mode, (state, zeros), time),
        }
    }

    #[inline(always)]
    fn lost(&self, state: &State<L>) -> L::Mask {
        // Whatever goes wrong reaches the velocities through the forces.
        not_finite(state.y1 + state.y2)
    }

    #[inline(always)]
    fn runs_away(&self, state: &State<L>) -> L::Mask {
        let backward = self.mean_force.lt(L::splat(0.0));
        self.runaway_speed.lt(L::select(backward, -state.y2, state.y2))
    }

    #[inline(always)]
    fn touching<'a>(&self, jet: &'a GeneralJet<L>) -> Option<(&'a Series<L>, [L; 2])> {
        let front = self.springs.front.at;
        let rear = L::select(self.springs.has_rear(), self.springs.rear.at, front);
        Some((&jet.motion.r, [front, rear]))
    }
}

impl<L: Lane> Stroboscopic<L, 3> for GeneralCapsule<L> {
    #[inline(always)]
    fn point(state: &State<L>) -> [L; 3] {
        [state.r, state.y1, state.y2]
    }

    #[inline(always)]
    fn state([r, y1, y2]: [L; 3]) -> State<L> {
        State { r, y1, x2: L::splat(0.0), y2 }
    }

    #[inline(always)]
    fn moved_to(from: State<L>, [r, y1, y2]: [L; 3]) -> State<L> {
        State { r, y1, y2, ..from }
    }
}
