//! The equations of the family of capsules in numbers of any kind: their series, their guards, and what is told of their motion.

use capsulemap_engine::flow::{Stroboscopic, Switched, Zeros};
use capsulemap_engine::lane::elementary::not_finite;
use capsulemap_engine::lane::{Lane, Mask, ORDER, Series, series, side_by_side};

use super::balance::Balance;
use super::drive::PiecewiseDrive;
use super::folds::Folds;
use super::ground::Ground;
use super::springs::Springs;
use super::state::{
    BACKWARD, Due, EDGE, FRONT, FRONT_FORCE, GeneralJet, GeneralMode, REAR, REAR_FORCE,
};
use crate::capsule::drag::Drag;
use crate::capsule::parameter::Parameter;
use crate::capsule::shape::Shape;
use crate::capsule::state::{EventKind, State};

/// A capsule of the family with one set of parameters per lane.
///
/// Equations: m1 y1' = P - F - m1 g sin(alpha), m2 y2' = F - rho P - f - m2 g sin(alpha) + F_ext, the friction f set-valued at rest;
/// with `FOLDS` the way has folds, and their force is beside f.
#[derive(Debug, Clone, Copy)]
pub struct GeneralCapsule<L: Lane, const FOLDS: bool> {
    pub(super) m1: L,
    pub(super) inverse_m1: L,
    pub(super) inverse_m2: L,
    /// m1 / (m1 + m2) and m2 / (m1 + m2).
    pub(super) share_of_mass: L,
    pub(super) share_of_capsule: L,
    pub(super) drive: PiecewiseDrive<L>,
    pub(super) springs: Springs<L>,
    pub(super) ground: Ground<L>,
    pub(super) folds: Folds<L>,
    /// Whether the capsule takes up the reaction of the drive: rho = 1.
    pub(super) reacts: bool,
    /// What the largest force of the drive makes of the velocity of the mass within a radian of its phase [m/s].
    pub(super) usual_speed: L,
    /// The mean force along the ground, forward positive [N].
    pub(super) mean_force: L,
    /// The speed at which the capsule has run away in its direction; infinite where that force is held [m/s].
    pub(super) runaway_speed: L,
}

side_by_side!(GeneralCapsule<const FOLDS: bool> {
    m1, inverse_m1, inverse_m2, share_of_mass, share_of_capsule, usual_speed, mean_force, runaway_speed
} with { drive, springs, ground, folds } alike { reacts });

impl<L: Lane, const FOLDS: bool> GeneralCapsule<L, FOLDS> {
    /// The capsule with these parameters, whose drive is at `phase` at the section [rad].
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape, phase: f64) -> Self {
        let balance = Balance::new(&of, shape);
        let [m1, m2] = [of(Parameter::M1), of(Parameter::M2)];
        GeneralCapsule {
            m1,
            inverse_m1: L::splat(1.0) / m1,
            inverse_m2: L::splat(1.0) / m2,
            share_of_mass: m1 / (m1 + m2),
            share_of_capsule: m2 / (m1 + m2),
            drive: PiecewiseDrive::new(&of, shape, phase),
            springs: Springs::new(&of, shape),
            ground: Ground::new(&of, shape),
            folds: Folds::new(&of, shape),
            reacts: shape.reacts(),
            usual_speed: balance.largest_drive / (m1 * shape.frequency(&of)),
            mean_force: balance.mean,
            runaway_speed: balance.runaway_speed(&of, shape),
        }
    }

    /// What moves the capsule but for the friction, in a state at a time [N].
    #[inline(always)]
    pub(super) fn push(&self, mode: &GeneralMode<L>, time: L, state: &State<L>) -> L {
        if self.drive.is_prescribed() {
            return self.push_of_prescribed(mode, time);
        }
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
            if mode.slides().any() { drag.decay_start(mode.slip, state.y2) } else { L::splat(0.0) };
        drag.write_exponent_term(mode.slip, motion, 0);
        self.springs.begin_squares(state.r, &mut jet.squares);
        self.begin_folds(state, jet);
    }

    /// Writes the terms of the motion of the capsule that follow from term `k` of what moves it and of its speed.
    #[inline(always)]
    pub(super) fn write_capsule_term(
        &self,
        mode: &GeneralMode<L>,
        any_slides: bool,
        drag: &Drag<L>,
        inverse_mass: L,
        jet: &mut GeneralJet<L>,
        k: usize,
    ) {
        let (zero, per) = (L::splat(0.0), L::Plain::splat(series::INVERSE[k + 1]));
        let motion = &mut jet.motion;
        if !any_slides {
            motion.acceleration[k] = zero;
            (motion.y2[k + 1], motion.x2[k + 1], motion.decay[k + 1]) = (zero, zero, zero);
            if FOLDS {
                jet.folds.rest(k + 1);
            }
            return;
        }
        let of_speed = [&motion.decay, &motion.y2];
        let mut friction = self.ground.force_term(drag, mode.slip, of_speed, k);
        if FOLDS {
            friction = self.folds.resistance_term(friction, &mut jet.folds, k);
        }
        let moves = (jet.push[k] - friction) * inverse_mass;
        motion.acceleration[k] = L::select(mode.slides(), moves, zero);
        motion.y2[k + 1] = motion.acceleration[k].scaled(per);
        motion.x2[k + 1] = motion.y2[k].scaled(per);
        drag.write_exponent_term(mode.slip, motion, k + 1);
        motion.decay[k + 1] = drag.decay_term(mode.slip, motion, k);
        self.move_on(jet, k + 1);
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
        let mut relative = motion.y1[k] - motion.y2[k];
        if k == 1 && self.springs.is_rigid {
            let state = motion.beginning();
            relative = L::select(self.leaves_now(mode, &state), L::splat(0.0), relative);
        }
        jet.relative[k] = relative;
        if k > 0 {
            let linear = slopes.0 * motion.r[k] + slopes.1 * relative;
            let touched = mode.touched();
            motion.force[k] =
                linear + self.springs.cubic_term(&touched, &motion.r, &mut jet.squares, k);
        }
        let pushed = self.pushed_term(jet, k);
        let push = jet.motion.force[k] + pushed;
        jet.push[k] = if self.reacts { push - jet.drive[k] } else { push };
        if self.springs.is_rigid {
            let along = pushed + if k == 0 { self.ground.pull } else { L::splat(0.0) };
            let common = if self.reacts { along } else { jet.drive[k] + along };
            jet.push[k] = L::select(mode.front, common, jet.push[k]);
        }
    }
}

impl<L: Lane, const FOLDS: bool> Switched<L> for GeneralCapsule<L, FOLDS> {
    type State = State<L>;
    type Mode = GeneralMode<L>;
    type Jet = GeneralJet<L>;
    type Event = EventKind;

    const GUARDS: usize = 7;
    const MOST_ZEROS: usize = 3;

    #[inline(always)]
    fn period(&self) -> L {
        self.drive.period()
    }

    fn start(&self, time: L, state: &mut State<L>) -> GeneralMode<L> {
        if FOLDS { self.at_place(state).mode_at(time, state) } else { self.mode_at(time, state) }
    }

    #[inline(always)]
    fn begin_cycle(&self, mask: L::Mask, mode: &mut GeneralMode<L>, state: &mut State<L>) {
        mode.passed = L::select(mask, L::splat(0.0), mode.passed);
        if FOLDS {
            state.place = L::select(mask, self.folds.within(state.place), state.place);
        }
    }

    #[inline(always)]
    fn expand(&self, mode: &GeneralMode<L>, time: L, state: &State<L>, jet: &mut GeneralJet<L>) {
        if self.drive.has_edges() {
            jet.until_edge = self.drive.until_next(mode.passed, time);
        }
        if self.drive.is_prescribed() {
            self.expand_prescribed(mode, time, state, jet);
            return;
        }
        let slopes = self.springs.slopes(&mode.touched());
        let (any_slides, drag) = (mode.slides().any(), self.ground.towards(mode.slip));
        self.drive.force(mode.passed, time, &mut jet.drive);
        let inverse_mass = match self.springs.is_rigid {
            true => L::select(mode.front, self.share_of_mass * self.inverse_m1, self.inverse_m2),
            false => self.inverse_m2,
        };
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
            self.write_capsule_term(mode, any_slides, &drag, inverse_mass, jet, k);
            let motion = &mut jet.motion;
            let own = (on_mass * self.inverse_m1).scaled(per);
            motion.y1[k + 1] = match self.springs.is_rigid {
                true => L::select(mode.front, motion.y2[k + 1], own),
                false => own,
            };
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
            FRONT => L::Mask::splat(!self.drive.is_prescribed()),
            FRONT_FORCE | REAR_FORCE if !self.springs.release_by_force => L::Mask::splat(false),
            FRONT_FORCE => mode.front | mode.beyond_front,
            REAR_FORCE => mode.rear | mode.beyond_rear,
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
        let state = jet.motion.state(h);
        if FOLDS { State { place: self.place(jet, h), ..state } } else { state }
    }

    #[inline(always)]
    fn motion(&self, jet: &GeneralJet<L>, h: L) -> (State<L>, State<L>) {
        let (mut state, mut slope) = jet.motion.motion(h);
        if FOLDS {
            state.place = self.place(jet, h);
            slope.place = slope.x2 * self.folds.per_length;
        }
        (state, slope)
    }

    #[inline(always)]
    fn beginning(&self, jet: &GeneralJet<L>) -> State<L> {
        let state = jet.motion.beginning();
        if FOLDS { State { place: jet.place, ..state } } else { state }
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
        let due = Due { here: due, mode, state, zeros, time };
        if FOLDS { self.at_place(due.state).obey(which, due) } else { self.obey(which, due) }
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
        if self.drive.is_prescribed() {
            return None;
        }
        let front = self.springs.front.at;
        let rear = L::select(self.springs.has_rear(), self.springs.rear.at, front);
        Some((&jet.motion.r, [front, rear]))
    }
}

impl<L: Lane> Stroboscopic<L, 3> for GeneralCapsule<L, false> {
    #[inline(always)]
    fn point(state: &State<L>) -> [L; 3] {
        [state.r, state.y1, state.y2]
    }

    #[inline(always)]
    fn state([r, y1, y2]: [L; 3]) -> State<L> {
        let zero = L::splat(0.0);
        State { r, y1, x2: zero, y2, place: zero }
    }

    #[inline(always)]
    fn moved_to(from: State<L>, [r, y1, y2]: [L; 3]) -> State<L> {
        State { r, y1, y2, ..from }
    }
}
