//! Other switched systems through the same integrator: a bouncing ball and a rigid impact oscillator.

use std::f64::consts::PI;

use capsulemap::capsule::{Field, Stroboscopic, Switched, Zeros};
use capsulemap::flow::{Breakdown, Motion, Step};
use capsulemap::lane::elementary::{not_finite, sin_cos};
use capsulemap::lane::{Dual, Lane, ORDER, Series, series};
use capsulemap::orbit::matrix::{Matrix, solve};
use capsulemap::orbit::return_map::{Cycles, jacobian, returned, seeded, values};

/// A mass on a spring, thrown back by a rigid stop: x'' + c x' + k x = p cos(wt) + g, x' -> -e x' at x = s.
#[derive(Debug, Clone, Copy)]
pub struct Impact<L> {
    /// Stiffness k.
    pub k: L,
    /// Damping c.
    pub c: L,
    /// Amplitude of the drive, p.
    pub drive: L,
    /// Frequency of the drive, w.
    pub omega: L,
    /// Constant force g towards the stop.
    pub gravity: L,
    /// Place of the stop, s.
    pub stop: L,
    /// Coefficient of restitution, e.
    pub restitution: L,
}

impl Impact<f64> {
    /// The same over numbers with derivatives, none of its constants being a direction.
    pub fn carried<const N: usize>(&self) -> Impact<Dual<f64, N>> {
        Impact {
            k: Dual::constant(self.k),
            c: Dual::constant(self.c),
            drive: Dual::constant(self.drive),
            omega: Dual::constant(self.omega),
            gravity: Dual::constant(self.gravity),
            stop: Dual::constant(self.stop),
            restitution: Dual::constant(self.restitution),
        }
    }
}

/// Place and velocity of a mass point.
#[derive(Clone, Copy, Debug)]
pub struct Point<L> {
    /// Place.
    pub x: L,
    /// Velocity.
    pub v: L,
}

/// Their series over a step.
pub struct PointJet<L> {
    /// Place.
    pub x: Series<L>,
    /// Velocity.
    pub v: Series<L>,
}

impl<L: Lane> Default for PointJet<L> {
    fn default() -> Self {
        PointJet { x: series::zero(), v: series::zero() }
    }
}

impl<L: Lane<Mask = bool>> Switched<L> for Impact<L> {
    type State = Point<L>;
    type Mode = ();
    type Jet = PointJet<L>;
    const GUARDS: usize = 1;

    fn start(&self, _time: L, _state: &mut Point<L>) {}

    fn expand(&self, _mode: &(), time: L, state: &Point<L>, jet: &mut PointJet<L>) {
        let (mut s, mut c) = sin_cos(self.omega * time);
        (jet.x[0], jet.v[0]) = (state.x, state.v);
        for k in 0..ORDER {
            let per = L::splat(1.0 / (k + 1) as f64);
            let weight = if k == 0 { self.gravity } else { L::splat(0.0) };
            let push = self.drive * c + weight - self.k * jet.x[k] - self.c * jet.v[k];
            jet.x[k + 1] = jet.v[k] * per;
            jet.v[k + 1] = push * per;
            (c, s) = (-(self.omega * s * per), self.omega * c * per);
        }
    }

    fn pace<'a>(&self, jet: &'a PointJet<L>) -> [&'a Series<L>; 2] {
        [&jet.x, &jet.v]
    }

    fn step_bound(&self, _mode: &(), _jet: &PointJet<L>, length: L::Plain, _: f64) -> L::Plain {
        length
    }

    fn watched(&self, _which: usize, _mode: &()) -> bool {
        true
    }

    fn guard(&self, _which: usize, _mode: &(), jet: &PointJet<L>, gap: &mut Series<L>) {
        *gap = jet.x.map(|a| -a);
        gap[0] = self.stop - jet.x[0];
    }

    fn at(&self, jet: &PointJet<L>, h: L) -> Point<L> {
        Point { x: series::value(&jet.x, h), v: series::value(&jet.v, h) }
    }

    fn switch(
        &self,
        _which: usize,
        due: bool,
        _mode: &mut (),
        state: &mut Point<L>,
        zeros: &mut Zeros<L>,
        _time: L,
    ) -> L {
        if due {
            *state = Point { x: self.stop, v: -(self.restitution * state.v) };
            zeros[0] = L::splat(1.0);
        }
        L::splat(f64::from(u8::from(due)))
    }

    fn lost(&self, state: &Point<L>) -> bool {
        not_finite(state.x + state.v)
    }
}

impl<L: Lane<Mask = bool>> Stroboscopic<L, 2> for Impact<L> {
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

impl Field<2> for Impact<f64> {
    fn coordinates<'a>(&self, jet: &'a PointJet<f64>) -> [&'a Series<f64>; 2] {
        [&jet.x, &jet.v]
    }

    fn rates(&self, _mode: &(), time: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
        let drive = self.drive * libm::cos(self.omega * time);
        [v, drive + self.gravity - self.k * x - self.c * v]
    }

    fn weights(&self) -> [f64; 2] {
        [self.omega, 1.0]
    }
}

/// The point of the section after `count` cycles of the drive, and the Jacobian.
pub fn mapped<S>(system: &S, point: [f64; 2], omega: f64, count: u64) -> ([f64; 2], Matrix<2>)
where
    S: Stroboscopic<Dual<f64, 2>, 2>,
{
    let drive_period = Dual::constant(2.0 * PI / omega);
    let cycles = Cycles { drive_period, count, tolerance: 1e-15 };
    let end = returned(system, seeded(&point), &cycles, |_| ()).expect("it goes on");
    (values(&end), jacobian(&end))
}

/// The point near `guess` that repeats after `count` cycles, by Newton's method, and the Jacobian there.
pub fn repeated<S>(system: &S, guess: [f64; 2], omega: f64, count: u64) -> ([f64; 2], Matrix<2>)
where
    S: Stroboscopic<Dual<f64, 2>, 2>,
{
    let mut point = guess;
    for _ in 0..20 {
        let (image, jacobian) = mapped(system, point, omega, count);
        let [[a, b], [c, d]] = jacobian;
        let miss = [image[0] - point[0], image[1] - point[1]];
        let [x, v] = solve([[1.0 - a, -b], [-c, 1.0 - d]], miss).expect("no multiplier is one");
        point = [point[0] + x, point[1] + v];
        if x.abs().max(v.abs()) < 1e-14 {
            break;
        }
    }
    (point, mapped(system, point, omega, count).1)
}

#[test]
fn a_bouncing_ball_never_falls_through_the_floor() {
    // Drop from 1 m under 10 m/s^2 onto x = 0 (the guard is the height -x): the speed halves each time.
    let ball = Impact {
        k: 0.0,
        c: 0.0,
        drive: 0.0,
        omega: 0.0,
        gravity: 10.0,
        stop: 0.0,
        restitution: 0.5,
    };
    let mut motion = Motion::new(&ball, 0.0, Point { x: -1.0, v: 0.0 });
    let mut step = Step::default();
    let fall = (2.0_f64 / 10.0).sqrt();
    let (mut bounces, mut breakdown) = (Vec::new(), None);
    while motion.time < 10.0 && breakdown.is_none() {
        motion.step(&ball, 10.0, 1e-12, &mut step);
        for i in 0..=8 {
            let height = -ball.at(&step.jet, step.length * f64::from(i) / 8.0).x;
            assert!(height >= -1e-15, "{height:e} at {}", step.start);
        }
        if step.event != 0.0 {
            bounces.push(motion.time);
        }
        breakdown = motion.breakdown(&ball, 0);
    }
    // The n-th bounce is at fall (1 + 2 (1/2 + 1/4 + ...)): infinitely many before 3 fall.
    for (n, bounce) in bounces.iter().enumerate().take(20) {
        let exact = fall * (3.0 - 2.0 * 0.5_f64.powi(n as i32));
        assert!((bounce - exact).abs() < 1e-12, "bounce {n}: {bounce} {exact}");
    }
    assert_eq!(breakdown, Some(Breakdown::NoProgress), "an endless series of bounces is told");
    assert!((motion.time - 3.0 * fall).abs() < 1e-9, "{}", motion.time);
}
