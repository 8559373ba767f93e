//! The equations of the family as they are written, and what is told of a motion beside its coordinates.

use capsulemap_engine::flow::{Field, Step, Switched};
use capsulemap_engine::lane::{Lane, Mask, Series, series};

use super::equations::GeneralCapsule;
use super::state::{GeneralJet, GeneralMode};
use crate::capsule::locomotion::{DriveSeries, Jump, Locomotion, Parts};
use crate::capsule::state::{Jet, State};

impl<const FOLDS: bool> Field for GeneralCapsule<f64, FOLDS> {
    type Coordinates = [f64; 5];

    fn coordinates(state: &State<f64>) -> [f64; 5] {
        let [r, y1, x2, y2] = state.coordinates();
        [r, y1, x2, y2, state.place]
    }

    fn rates(&self, mode: &GeneralMode<f64>, time: f64, state: &State<f64>) -> State<f64> {
        let State { y1, y2, .. } = *state;
        if self.drive.is_prescribed() {
            let relative = self.drive.exact_motion(mode.passed, time);
            return self.rates_of_both(mode.slip, relative, 0.0, state);
        }
        let force = self.springs.force(&mode.touched(), state);
        let drive = self.drive.exact_force(mode.passed, time);
        let acceleration = (drive - force + self.ground.pull) * self.inverse_m1;
        if self.lasts(mode) {
            let external = if self.reacts { 0.0 } else { drive };
            return self.rates_of_both(mode.slip, [0.0; 2], external, state);
        }
        if mode.slip == 0.0 {
            return State { r: y1, y1: acceleration, ..State::default() };
        }
        let reaction = if self.reacts { drive } else { 0.0 };
        let push = force - reaction + self.exact_ground(mode.slip, state);
        let place = y2 * self.folds.per_length;
        State { r: y1 - y2, y1: acceleration, x2: y2, y2: push * self.inverse_m2, place }
    }

    /// A displacement r or x2 counts as the velocity omega r.
    fn weights(&self) -> [f64; 5] {
        let omega = self.drive.omega;
        [omega, 1.0, omega, 1.0, if FOLDS { omega / self.folds.per_length } else { 0.0 }]
    }
}

impl<const FOLDS: bool> GeneralCapsule<f64, FOLDS> {
    /// The force of the ground on a capsule that slides in the direction `slip`, as the laws are written [N].
    fn exact_ground(&self, slip: f64, state: &State<f64>) -> f64 {
        let resistance = self.ground.force(slip, state.y2);
        if !FOLDS {
            return self.ground.push - resistance;
        }
        let folds = self.folds.exactly_at(state.place);
        self.ground.push + folds.pushes - folds.resists * resistance
    }

    /// The rates where mass and capsule move by what acts on both, their relative velocity and acceleration known: under a force on the
    /// mass from outside, and what acts along the ground.
    fn rates_of_both(
        &self,
        slip: f64,
        [speed, acceleration]: [f64; 2],
        external: f64,
        state: &State<f64>,
    ) -> State<f64> {
        if slip == 0.0 {
            return State { r: speed, y1: acceleration, ..State::default() };
        }
        let along = external + self.ground.pull + self.exact_ground(slip, state);
        let own = (along - self.m1 * acceleration) * self.inverse_m1 * self.share_of_mass;
        let (x2, place) = (state.y2, state.y2 * self.folds.per_length);
        State { r: speed, y1: own + acceleration, x2, y2: own, place }
    }
}

impl<L: Lane, const FOLDS: bool> Locomotion<L> for GeneralCapsule<L, FOLDS> {
    const HAS_PARTS: bool = true;

    #[inline(always)]
    fn jet<'a>(&self, jet: &'a GeneralJet<L>) -> &'a Jet<L> {
        &jet.motion
    }

    #[inline(always)]
    fn drive<'a>(&self, jet: &'a GeneralJet<L>) -> DriveSeries<'a, L> {
        let rate = if self.reacts { &jet.relative } else { &jet.motion.y1 };
        DriveSeries { force: &jet.drive, unit: L::splat(1.0), rate, reacts: self.reacts }
    }

    #[inline(always)]
    fn friction(&self, mode: &GeneralMode<L>, jet: &GeneralJet<L>) -> Series<L> {
        let slides = mode.slides();
        let mut friction = jet.push;
        if slides.any() {
            let drag = self.ground.towards(mode.slip);
            let of_speed = [&jet.motion.decay, &jet.motion.y2];
            let mut sliding = series::zero();
            for (k, term) in sliding.iter_mut().enumerate() {
                *term = self.ground.force_term(&drag, mode.slip, of_speed, k);
            }
            if FOLDS {
                sliding = self.folds.raised(&sliding, &jet.folds);
            }
            for (term, sliding) in friction.iter_mut().zip(&sliding) {
                *term = L::select(slides, *sliding, *term);
            }
        }
        friction
    }

    #[inline(always)]
    fn slip_rate(&self, _mode: &GeneralMode<L>, jet: &GeneralJet<L>) -> Series<L> {
        jet.motion.y2
    }

    #[inline(always)]
    fn closed(&self, mode: &GeneralMode<L>) -> L::Mask {
        mode.front
    }

    #[inline(always)]
    fn direction(&self, mode: &GeneralMode<L>) -> L {
        mode.slip
    }

    #[inline(always)]
    fn parts(&self, step: &Step<L, Self>) -> Option<Parts<L>> {
        let (mode, jet) = (&step.mode, &step.jet);
        let touched = mode.touched();
        let far = L::splat(f64::NEG_INFINITY);
        let mut drag = series::zero();
        if mode.slides().any() {
            drag = self.ground.drag(mode.slip, &jet.motion.y2);
            if FOLDS {
                drag = self.folds.raised(&drag, &jet.folds);
            }
        }
        let mut folds = series::zero();
        if FOLDS {
            for (k, term) in folds.iter_mut().enumerate() {
                *term = self.folds.push_term(&jet.folds, k);
            }
        }
        let mut stops = self.springs.stop_forces(&touched, [&jet.motion.r, &jet.relative]);
        self.add_bearing(mode, jet, &mut stops[0]);
        Some(Parts {
            stops,
            rear: L::select(self.springs.has_rear(), self.springs.rear.at, far),
            is_rigid: self.springs.is_rigid,
            damping: self.springs.contact_damping(&touched),
            drag,
            folds,
        })
    }

    #[inline(always)]
    fn jump(&self, step: &Step<L, Self>) -> Option<Jump<L>> {
        let state = self.at(&step.jet, step.length);
        if self.springs.is_rigid || self.springs.release_by_force {
            let left = self.springs.left_in_stops(step.event, &state);
            let own = Jump::of_energy(left, state.y2);
            return Some(match self.springs.is_rigid {
                true => self.jump_at_stop(step.event, &state).or(own),
                false => own,
            });
        }
        self.drive.velocity_jumps().then(|| self.jump_at_edge(step.event, &step.mode, &state))
    }
}
