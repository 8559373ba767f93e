//! The equations of the family as they are written, and what is told of a motion beside its coordinates.

use capsulemap_engine::flow::{Field, Step, Switched};
use capsulemap_engine::lane::{Lane, Mask, Series, series};

use super::equations::GeneralCapsule;
use super::state::{GeneralJet, GeneralMode};
use crate::capsule::locomotion::{DriveSeries, Jump, Locomotion, Parts};
use crate::capsule::state::{Jet, State};

impl Field for GeneralCapsule<f64> {
    type Coordinates = [f64; 4];

    fn coordinates(state: &State<f64>) -> [f64; 4] {
        state.coordinates()
    }

    fn rates(&self, mode: &GeneralMode<f64>, time: f64, state: &State<f64>) -> State<f64> {
        let State { y1, y2, .. } = *state;
        if self.drive.is_prescribed() {
            return self.prescribed_rates(mode, time, y2);
        }
        let force = self.springs.force(&mode.touched(), state);
        let drive = self.drive.exact_force(mode.passed, time);
        let acceleration = (drive - force + self.ground.pull) * self.inverse_m1;
        if self.lasts(mode) {
            return self.rates_at_stop(mode.slip, y2, drive);
        }
        if mode.slip == 0.0 {
            return State { r: y1, y1: acceleration, x2: 0.0, y2: 0.0 };
        }
        let reaction = if self.reacts { drive } else { 0.0 };
        let push = force - reaction + self.ground.push - self.ground.force(mode.slip, y2);
        State { r: y1 - y2, y1: acceleration, x2: y2, y2: push * self.inverse_m2 }
    }

    /// A displacement r or x2 counts as the velocity omega r.
    fn weights(&self) -> [f64; 4] {
        [self.drive.omega, 1.0, self.drive.omega, 1.0]
    }
}

impl GeneralCapsule<f64> {
    /// The rates where the motion of the mass relative to the capsule is prescribed.
    fn prescribed_rates(&self, mode: &GeneralMode<f64>, time: f64, y2: f64) -> State<f64> {
        let [speed, acceleration] = self.drive.exact_motion(mode.passed, time);
        if mode.slip == 0.0 {
            return State { r: speed, y1: acceleration, x2: 0.0, y2: 0.0 };
        }
        let along = self.ground.push + self.ground.pull;
        let push = along - self.m1 * acceleration - self.ground.force(mode.slip, y2);
        let own = push * self.share_of_mass * self.inverse_m1;
        State { r: speed, y1: own + acceleration, x2: y2, y2: own }
    }

    /// The rates of a mass that stays at its rigid stop, and so moves with the capsule.
    fn rates_at_stop(&self, slip: f64, y2: f64, drive: f64) -> State<f64> {
        if slip == 0.0 {
            return State::default();
        }
        let external = if self.reacts { 0.0 } else { drive };
        let push = external + self.ground.push + self.ground.pull - self.ground.force(slip, y2);
        let acceleration = push * self.inverse_m1 * self.share_of_mass;
        State { r: 0.0, y1: acceleration, x2: y2, y2: acceleration }
    }
}

impl<L: Lane> Locomotion<L> for GeneralCapsule<L> {
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
            for (k, term) in friction.iter_mut().enumerate() {
                let sliding = self.ground.force_term(&drag, mode.slip, of_speed, k);
                *term = L::select(slides, sliding, *term);
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
        }
        let mut stops = self.springs.stop_forces(&touched, [&jet.motion.r, &jet.relative]);
        self.add_bearing(mode, jet, &mut stops[0]);
        Some(Parts {
            stops,
            rear: L::select(self.springs.has_rear(), self.springs.rear.at, far),
            is_rigid: self.springs.is_rigid,
            damping: self.springs.contact_damping(&touched),
            drag,
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
