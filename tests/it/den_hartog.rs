//! Den Hartog's oscillator with dry friction as a switched system of its own, against his closed form.

use std::f64::consts::PI;

use capsulemap::capsule::{Field, Stroboscopic, Switched, Zeros};
use capsulemap::lane::elementary::{not_finite, sin_cos};
use capsulemap::lane::{Dual, Lane, ORDER, Series, series};

use super::differences::followed;
use super::oscillators::{Point, PointJet, repeated};

/// x'' + x + f sign(x') = cos(wt): a mass on a spring under a force, with Coulomb friction.
#[derive(Debug, Clone, Copy)]
pub struct DryFriction<L> {
    /// Frequency of the drive, w.
    pub omega: L,
    /// Coulomb friction, f.
    pub friction: L,
}

/// The series of a step, and of what the spring leaves of the drive, which friction holds at rest.
pub struct DryJet<L> {
    motion: PointJet<L>,
    push: Series<L>,
}

impl<L: Lane> Default for DryJet<L> {
    fn default() -> Self {
        DryJet { motion: PointJet::default(), push: series::zero() }
    }
}

impl<L: Lane<Mask = bool>> DryFriction<L> {
    fn push(&self, time: L, state: &Point<L>) -> L {
        sin_cos(self.omega * time).1 - state.x
    }

    /// The direction in which the mass leaves a moment of rest, zero where friction holds it.
    fn direction(&self, time: L, state: &Point<L>) -> i8 {
        let push = self.push(time, state);
        match self.friction.lt(push.abs()) {
            true if push.lt(L::splat(0.0)) => -1,
            true => 1,
            false => 0,
        }
    }
}

impl<L: Lane<Mask = bool>> Switched<L> for DryFriction<L> {
    type State = Point<L>;
    /// The direction of sliding, zero at rest. Guards while sliding: the speed; at rest: f - push, f + push.
    type Mode = i8;
    type Jet = DryJet<L>;
    const GUARDS: usize = 2;

    fn start(&self, time: L, state: &mut Point<L>) -> i8 {
        let v = state.v.lane(0);
        if v == 0.0 { self.direction(time, state) } else { v.signum() as i8 }
    }

    fn expand(&self, mode: &i8, time: L, state: &Point<L>, jet: &mut DryJet<L>) {
        let DryJet { motion: PointJet { x, v }, push } = jet;
        (*x, *v) = (series::zero(), series::zero());
        let (mut s, mut c) = sin_cos(self.omega * time);
        (x[0], v[0]) = (state.x, state.v);
        for k in 0..ORDER {
            let per = L::splat(1.0 / (k + 1) as f64);
            push[k] = c - x[k];
            if *mode != 0 {
                let friction = if k == 0 { self.friction } else { L::splat(0.0) };
                x[k + 1] = v[k] * per;
                v[k + 1] = (push[k] - L::splat(f64::from(*mode)) * friction) * per;
            }
            (c, s) = (-(self.omega * s * per), self.omega * c * per);
        }
        push[ORDER] = c - x[ORDER];
    }

    /// At rest the drive alone moves, and so sets the pace.
    fn pace<'a>(&self, jet: &'a DryJet<L>) -> [&'a Series<L>; 2] {
        [&jet.push, &jet.motion.v]
    }

    fn step_bound(&self, _mode: &i8, _jet: &DryJet<L>, length: L::Plain, _: f64) -> L::Plain {
        length
    }

    fn watched(&self, which: usize, mode: &i8) -> bool {
        which == 0 || *mode == 0
    }

    fn guard(&self, which: usize, mode: &i8, jet: &DryJet<L>, guard: &mut Series<L>) {
        if *mode != 0 {
            *guard = jet.motion.v.map(|term| L::splat(f64::from(*mode)) * term);
            return;
        }
        let side = L::splat(if which == 0 { -1.0 } else { 1.0 });
        *guard = jet.push.map(|term| side * term);
        guard[0] = guard[0] + self.friction;
    }

    fn at(&self, jet: &DryJet<L>, h: L) -> Point<L> {
        Point { x: series::value(&jet.motion.x, h), v: series::value(&jet.motion.v, h) }
    }

    fn switch(
        &self,
        which: usize,
        due: bool,
        mode: &mut i8,
        state: &mut Point<L>,
        zeros: &mut Zeros<L>,
        time: L,
    ) -> L {
        if !due {
            return L::splat(0.0);
        }
        state.v = L::splat(0.0);
        if *mode == 0 {
            // Friction is the same at rest and in motion, so the acceleration starts from zero.
            (*mode, zeros[0]) = (if which == 0 { 1 } else { -1 }, L::splat(2.0));
            return L::splat(1.0);
        }
        *mode = self.direction(time, state);
        zeros[0] = L::splat(if *mode == 0 { 0.0 } else { 1.0 });
        L::splat(2.0)
    }

    fn lost(&self, state: &Point<L>) -> bool {
        not_finite(state.x + state.v)
    }
}

impl Field<2> for DryFriction<f64> {
    fn coordinates<'a>(&self, jet: &'a DryJet<f64>) -> [&'a Series<f64>; 2] {
        [&jet.motion.x, &jet.motion.v]
    }

    fn rates(&self, mode: &i8, time: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
        let friction = f64::from(*mode) * self.friction;
        let acceleration = libm::cos(self.omega * time) - x - friction;
        if *mode == 0 { [0.0, 0.0] } else { [v, acceleration] }
    }

    fn weights(&self) -> [f64; 2] {
        [self.omega, 1.0]
    }
}

impl<L: Lane<Mask = bool>> Stroboscopic<L, 2> for DryFriction<L> {
    fn point(state: &Point<L>) -> [L; 2] {
        [state.x, state.v]
    }

    fn state([x, v]: [L; 2]) -> Point<L> {
        Point { x, v }
    }

    /// A displacement x counts as the velocity w x.
    fn scales(&self) -> [f64; 2] {
        [self.omega.lane(0), 1.0]
    }
}

/// The places at which the mass turns, over `count` cycles from a point of the section, and the end.
fn turns(omega: f64, friction: f64, from: [f64; 2], count: u64) -> (Vec<f64>, [f64; 2]) {
    let system = DryFriction { omega, friction };
    let mut turns = Vec::new();
    let end = followed(&system, from, 2.0 * PI / omega, count, |step| {
        if step.event == 2.0 {
            turns.push(system.at(&step.jet, step.length).x);
        }
    });
    (turns, end)
}

#[test]
fn den_hartogs_amplitude_is_met_exactly() {
    for (omega, friction) in
        [(0.6, 0.2), (0.8, 0.3), (1.2, 0.5), (1.5, 0.2), (2.0, 0.15), (2.5, 0.1)]
    {
        let system =
            DryFriction { omega: Dual::constant(omega), friction: Dual::constant(friction) };
        let (_, near) = turns(omega, friction, [1.0 / (1.0 - omega * omega), 0.0], 60);
        let (point, jacobian) = repeated(&system, near, omega, 1);
        let (turns, end) = turns(omega, friction, point, 1);
        assert!((end[0] - point[0]).abs().max((end[1] - point[1]).abs()) < 1e-13, "{end:?}");
        let v = 1.0 / (1.0 - omega * omega);
        let u = libm::sin(PI / omega) / (omega * (1.0 + libm::cos(PI / omega)));
        let exact = (v * v - friction * friction * u * u).sqrt();
        assert_eq!(turns.len(), 2, "w {omega}: it turns without rest");
        for turn in turns {
            assert!((turn.abs() - exact).abs() < 1e-10 * exact, "w {omega}: {turn} {exact}");
        }
        // At the turn the drive's phase has the cosine X/V, and friction changes sides: volumes jump twice
        // alike.
        let push = exact * (1.0 / v - 1.0);
        let jump = (push + friction) / (push - friction);
        let [[a, b], [c, d]] = jacobian;
        assert!((a * d - b * c - jump * jump).abs() < 1e-10, "w {omega}: {jacobian:?} {jump}");
    }
}
