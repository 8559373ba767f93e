//! Den Hartog's oscillator with dry friction as a switched system of its own, against his closed form.

use std::f64::consts::PI;

use capsulemap_engine::flow::{
    Event, Field, Metric, Stroboscopic, Switched, System, Taylor, Zeros,
};
use capsulemap_engine::lane::elementary::{not_finite, sin_cos};
use capsulemap_engine::lane::{Dual, Lane, Mask, ORDER, Series, SideBySide, side_by_side};

use super::differences::followed;
use super::oscillators::repeated;

/// x'' + x + f sign(x') = cos(wt): a mass on a spring under a force, with Coulomb friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DryFriction<L> {
    /// Frequency of the drive, w.
    pub omega: L,
    /// Coulomb friction, f.
    pub friction: L,
}

side_by_side!(DryFriction { omega, friction });

/// What ends a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Turn {
    /// The mass begins to slide from rest.
    Slip = 1,
    /// Its velocity comes to zero, where it rests or turns.
    Stop,
}

impl Event for Turn {
    const ALL: &'static [Turn] = &[Turn::Slip, Turn::Stop];
    fn number(self) -> u8 {
        self as u8
    }
}

/// Direction of sliding, +1 or -1; zero at rest.
#[derive(Debug, Clone, Copy)]
pub struct Slip<L>(L);

impl<L: Lane> Default for Slip<L> {
    fn default() -> Self {
        Slip(L::splat(0.0))
    }
}

impl<L: Lane> SideBySide for Slip<L> {
    type One = Slip<f64>;
    #[inline(always)]
    fn splat(one: &Slip<f64>) -> Self {
        Slip(L::splat(one.0))
    }
    #[inline(always)]
    fn lane(&self, index: usize) -> Slip<f64> {
        Slip(self.0.lane(index))
    }
    #[inline(always)]
    fn put(&mut self, index: usize, one: &Slip<f64>) {
        self.0 = self.0.with_lane(index, one.0);
    }
    #[inline(always)]
    fn take_lane(&mut self, index: usize, other: &Self) {
        self.0 = self.0.with_lane_of(index, other.0);
    }
}

impl<L: Lane> Slip<L> {
    #[inline(always)]
    fn rests(&self) -> L::Mask {
        (self.0 * self.0).lt(L::splat(0.5))
    }
}

/// Place of the series of what the spring leaves of the drive, which friction holds at rest.
const PUSH: usize = 2;

impl<L: Lane> DryFriction<L> {
    /// The direction in which the mass leaves a moment of rest, zero where friction holds it.
    #[inline(always)]
    fn direction(&self, time: L, [x, _]: &[L; 2]) -> L {
        let zero = L::splat(0.0);
        let push = sin_cos(self.omega * time).1 - *x;
        let side = L::select(push.lt(zero), L::splat(-1.0), L::splat(1.0));
        L::select(self.friction.lt(push.abs()), side, zero)
    }
}

impl<L: Lane> Switched<L> for DryFriction<L> {
    /// Place and velocity.
    type State = [L; 2];
    /// Guards while sliding: the speed; at rest: f - push, f + push.
    type Mode = Slip<L>;
    type Jet = Taylor<L, 3>;
    type Event = Turn;
    const GUARDS: usize = 2;

    #[inline(always)]
    fn period(&self) -> L {
        L::splat(2.0 * PI) / self.omega
    }

    #[inline(always)]
    fn start(&self, time: L, state: &mut [L; 2]) -> Slip<L> {
        let (zero, v) = (L::splat(0.0), state[1]);
        let moving = L::select(v.lt(zero), L::splat(-1.0), L::splat(1.0));
        Slip(L::select(v.abs().le(zero), self.direction(time, state), moving))
    }

    #[inline(always)]
    fn expand(&self, slip: &Slip<L>, time: L, state: &[L; 2], jet: &mut Taylor<L, 3>) {
        let zero = L::splat(0.0);
        let (mut s, mut c) = sin_cos(self.omega * time);
        jet.begin(state);
        let rests = slip.rests();
        for k in 0..ORDER {
            let per = L::splat(1.0 / (k + 1) as f64);
            let push = c - jet[0][k];
            let friction = if k == 0 { self.friction } else { zero };
            let force = (push - slip.0 * friction) * per;
            jet[PUSH][k] = push;
            jet[0][k + 1] = L::select(rests, zero, jet[1][k] * per);
            jet[1][k + 1] = L::select(rests, zero, force);
            (c, s) = (-(self.omega * s * per), self.omega * c * per);
        }
        jet[PUSH][ORDER] = c - jet[0][ORDER];
    }

    /// At rest the drive alone moves, and so sets the pace.
    #[inline(always)]
    fn pace<'a>(&self, jet: &'a Taylor<L, 3>) -> [&'a Series<L>; 2] {
        [&jet[PUSH], &jet[1]]
    }

    #[inline(always)]
    fn watched(&self, which: usize, slip: &Slip<L>) -> L::Mask {
        if which == 0 { L::Mask::splat(true) } else { slip.rests() }
    }

    #[inline(always)]
    fn guard(&self, which: usize, slip: &Slip<L>, jet: &Taylor<L, 3>, guard: &mut Series<L>) {
        let side = L::splat(if which == 0 { -1.0 } else { 1.0 });
        let rests = slip.rests();
        for (k, term) in guard.iter_mut().enumerate() {
            *term = L::select(rests, side * jet[PUSH][k], slip.0 * jet[1][k]);
        }
        guard[0] = guard[0] + L::select(rests, self.friction, L::splat(0.0));
    }

    #[inline(always)]
    fn at(&self, jet: &Taylor<L, 3>, h: L) -> [L; 2] {
        jet.at(h)
    }

    #[inline(always)]
    fn motion(&self, jet: &Taylor<L, 3>, h: L) -> ([L; 2], [L; 2]) {
        jet.motion(h)
    }

    #[inline(always)]
    fn switch(
        &self,
        which: usize,
        due: L::Mask,
        slip: &mut Slip<L>,
        state: &mut [L; 2],
        zeros: &mut Zeros<L>,
        time: L,
    ) -> L {
        let zero = L::splat(0.0);
        let (leaves, stops) = (due & slip.rests(), due & !slip.rests());
        state[1] = L::select(due, zero, state[1]);
        let next = self.direction(time, state);
        let away = L::splat(if which == 0 { 1.0 } else { -1.0 });
        slip.0 = L::select(leaves, away, L::select(stops, next, slip.0));
        // Friction is the same at rest and in motion, so the acceleration starts from zero.
        let turned = L::select(slip.rests(), zero, L::splat(1.0));
        zeros[0] = L::select(leaves, L::splat(2.0), L::select(stops, turned, zeros[0]));
        L::select(leaves, Turn::Slip.code(), L::select(stops, Turn::Stop.code(), zero))
    }

    #[inline(always)]
    fn lost(&self, [x, v]: &[L; 2]) -> L::Mask {
        not_finite(*x + *v)
    }
}

impl Field for DryFriction<f64> {
    type Coordinates = [f64; 2];

    fn coordinates(state: &[f64; 2]) -> [f64; 2] {
        *state
    }

    fn rates(&self, slip: &Slip<f64>, time: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
        let acceleration = libm::cos(self.omega * time) - x - slip.0 * self.friction;
        if slip.0 == 0.0 { [0.0, 0.0] } else { [v, acceleration] }
    }

    fn weights(&self) -> [f64; 2] {
        [self.omega, 1.0]
    }
}

impl<L: Lane> Stroboscopic<L, 2> for DryFriction<L> {
    #[inline(always)]
    fn point(state: &[L; 2]) -> [L; 2] {
        *state
    }

    #[inline(always)]
    fn state(point: [L; 2]) -> [L; 2] {
        point
    }
}

impl System<2> for DryFriction<f64> {
    /// Zero for the frequency, one for the friction.
    type Parameter = usize;
    type Event = Turn;
    type State<L: Lane> = [L; 2];
    type Mode<L: Lane> = Slip<L>;
    type Single = DryFriction<f64>;
    type In<L: Lane> = DryFriction<L>;
    type Observer = ();
    type Observers<L: Lane> = ();

    fn single(&self) -> DryFriction<f64> {
        *self
    }

    fn system<L: Lane>(&self, of: impl Fn(usize) -> L) -> DryFriction<L> {
        DryFriction { omega: of(0), friction: of(1) }
    }

    fn value(&self, parameter: usize) -> f64 {
        [self.omega, self.friction][parameter]
    }

    fn with(&self, parameter: usize, value: f64) -> Self {
        self.system(|other| if other == parameter { value } else { self.value(other) })
    }

    /// A displacement x counts as the velocity w x.
    fn metric(&self) -> Metric<2> {
        Metric::new([self.omega, 1.0])
    }

    fn observer(&self, _points: usize) {}
}

/// The places at which the mass turns, over `count` cycles from a point of the section, and the end.
fn turns(omega: f64, friction: f64, from: [f64; 2], count: u64) -> (Vec<f64>, [f64; 2]) {
    let system = DryFriction { omega, friction };
    let mut turns = Vec::new();
    let end = followed(&system, from, count, |step| {
        if step.event == 2.0 {
            turns.push(system.at(&step.jet, step.length)[0]);
        }
    });
    (turns, end)
}

#[test]
fn den_hartogs_amplitude_is_met_exactly() {
    for (omega, friction) in
        [(0.6, 0.2), (0.8, 0.3), (1.2, 0.5), (1.5, 0.2), (2.0, 0.15), (2.5, 0.1)]
    {
        let system = DryFriction { omega, friction }.constant::<Dual<f64, 2>>();
        let (_, near) = turns(omega, friction, [1.0 / (1.0 - omega * omega), 0.0], 60);
        let (point, jacobian) = repeated(&system, near, 1);
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
