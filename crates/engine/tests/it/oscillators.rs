//! Other switched systems through the same integrator: a bouncing ball and a rigid impact oscillator.

use std::f64::consts::PI;

use capsulemap_engine::flow::{
    Breakdown, Event, Field, Metric, Motion, Step, Stroboscopic, Switched, System, Taylor, Zeros,
};
use capsulemap_engine::lane::elementary::{not_finite, sin_cos};
use capsulemap_engine::lane::{Dual, Lane, Mask, ORDER, Series, side_by_side};
use capsulemap_engine::orbit::matrix::{Matrix, solve};
use capsulemap_engine::orbit::return_map::{Cycles, jacobian, returned, seeded, values};

/// A mass on a spring, thrown back by a rigid stop: x'' + c x' + k x = p cos(wt) + g, x' -> -e x' at x = s.
#[derive(Debug, Clone, Copy, PartialEq)]
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

side_by_side!(Impact { k, c, drive, omega, gravity, stop, restitution });

/// The mass meets the stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Bounce {
    /// It is thrown back.
    Impact = 1,
}

impl Event for Bounce {
    const ALL: &'static [Bounce] = &[Bounce::Impact];
    fn number(self) -> u8 {
        self as u8
    }
    fn is_impact(self) -> bool {
        true
    }
}

impl<L: Lane> Switched<L> for Impact<L> {
    /// Place and velocity.
    type State = [L; 2];
    type Mode = ();
    type Jet = Taylor<L, 2>;
    type Event = Bounce;
    const GUARDS: usize = 1;

    #[inline(always)]
    fn period(&self) -> L {
        L::splat(2.0 * PI) / self.omega
    }

    #[inline(always)]
    fn start(&self, _time: L, _state: &mut [L; 2]) {}

    #[inline(always)]
    fn expand(&self, _mode: &(), time: L, state: &[L; 2], jet: &mut Taylor<L, 2>) {
        let (mut s, mut c) = sin_cos(self.omega * time);
        jet.begin(state);
        for k in 0..ORDER {
            let per = L::splat(1.0 / (k + 1) as f64);
            let weight = if k == 0 { self.gravity } else { L::splat(0.0) };
            let push = self.drive * c + weight - self.k * jet[0][k] - self.c * jet[1][k];
            jet[0][k + 1] = jet[1][k] * per;
            jet[1][k + 1] = push * per;
            (c, s) = (-(self.omega * s * per), self.omega * c * per);
        }
    }

    #[inline(always)]
    fn pace<'a>(&self, jet: &'a Taylor<L, 2>) -> [&'a Series<L>; 2] {
        [&jet[0], &jet[1]]
    }

    #[inline(always)]
    fn watched(&self, _which: usize, _mode: &()) -> L::Mask {
        L::Mask::splat(true)
    }

    #[inline(always)]
    fn guard(&self, _which: usize, _mode: &(), jet: &Taylor<L, 2>, gap: &mut Series<L>) {
        *gap = jet[0].map(|a| -a);
        gap[0] = self.stop - jet[0][0];
    }

    #[inline(always)]
    fn at(&self, jet: &Taylor<L, 2>, h: L) -> [L; 2] {
        jet.at(h)
    }

    #[inline(always)]
    fn motion(&self, jet: &Taylor<L, 2>, h: L) -> ([L; 2], [L; 2]) {
        jet.motion(h)
    }

    #[inline(always)]
    fn switch(
        &self,
        _which: usize,
        due: L::Mask,
        _mode: &mut (),
        [x, v]: &mut [L; 2],
        zeros: &mut Zeros<L>,
        _time: L,
    ) -> L {
        *x = L::select(due, self.stop, *x);
        *v = L::select(due, -(self.restitution * *v), *v);
        zeros[0] = L::select(due, L::splat(1.0), zeros[0]);
        L::select(due, Bounce::Impact.code(), L::splat(0.0))
    }

    #[inline(always)]
    fn lost(&self, [x, v]: &[L; 2]) -> L::Mask {
        not_finite(*x + *v)
    }

    #[inline(always)]
    fn touching<'a>(&self, jet: &'a Taylor<L, 2>) -> Option<(&'a Series<L>, [L; 2])> {
        Some((&jet[0], [self.stop; 2]))
    }
}

impl<L: Lane> Stroboscopic<L, 2> for Impact<L> {
    #[inline(always)]
    fn point(state: &[L; 2]) -> [L; 2] {
        *state
    }

    #[inline(always)]
    fn state(point: [L; 2]) -> [L; 2] {
        point
    }
}

impl Field for Impact<f64> {
    type Coordinates = [f64; 2];

    fn coordinates(state: &[f64; 2]) -> [f64; 2] {
        *state
    }

    fn rates(&self, _mode: &(), time: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
        let drive = self.drive * libm::cos(self.omega * time);
        [v, drive + self.gravity - self.k * x - self.c * v]
    }

    fn weights(&self) -> [f64; 2] {
        [self.omega, 1.0]
    }
}

/// The parameters of the oscillator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    K,
    C,
    Drive,
    Omega,
    Gravity,
    Stop,
    Restitution,
}

impl System<2> for Impact<f64> {
    type Parameter = Of;
    type Event = Bounce;
    type State<L: Lane> = [L; 2];
    type Mode<L: Lane> = ();
    type Single = Impact<f64>;
    type In<L: Lane> = Impact<L>;
    type Observer = ();
    type Observers<L: Lane> = ();

    fn single(&self) -> Impact<f64> {
        *self
    }

    fn system<L: Lane>(&self, of: impl Fn(Of) -> L) -> Impact<L> {
        Impact {
            k: of(Of::K),
            c: of(Of::C),
            drive: of(Of::Drive),
            omega: of(Of::Omega),
            gravity: of(Of::Gravity),
            stop: of(Of::Stop),
            restitution: of(Of::Restitution),
        }
    }

    fn value(&self, parameter: Of) -> f64 {
        match parameter {
            Of::K => self.k,
            Of::C => self.c,
            Of::Drive => self.drive,
            Of::Omega => self.omega,
            Of::Gravity => self.gravity,
            Of::Stop => self.stop,
            Of::Restitution => self.restitution,
        }
    }

    fn with(&self, parameter: Of, value: f64) -> Self {
        self.system(|other| if other == parameter { value } else { self.value(other) })
    }

    /// A displacement x counts as the velocity w x.
    fn metric(&self) -> Metric<2> {
        Metric::new([self.omega, 1.0])
    }

    fn observer(&self, _points: usize) {}
}

/// The point of the section after `count` cycles of the drive, and the Jacobian.
pub fn mapped<S>(system: &S, point: [f64; 2], count: u64) -> ([f64; 2], Matrix<2>)
where
    S: Stroboscopic<Dual<f64, 2>, 2>,
{
    let cycles = Cycles { count, tolerance: 1e-15 };
    let end = returned(system, seeded(&point), &cycles, |_| ()).expect("the integration continues");
    (values(&end), jacobian(&end))
}

/// The point near `guess` that repeats after `count` cycles, by Newton's method, and the Jacobian there.
pub fn repeated<S>(system: &S, guess: [f64; 2], count: u64) -> ([f64; 2], Matrix<2>)
where
    S: Stroboscopic<Dual<f64, 2>, 2>,
{
    let mut point = guess;
    for _ in 0..20 {
        let (image, jacobian) = mapped(system, point, count);
        let [[a, b], [c, d]] = jacobian;
        let miss = [image[0] - point[0], image[1] - point[1]];
        let [x, v] = solve([[1.0 - a, -b], [-c, 1.0 - d]], miss).expect("no multiplier is one");
        point = [point[0] + x, point[1] + v];
        if x.abs().max(v.abs()) < 1e-14 {
            break;
        }
    }
    (point, mapped(system, point, count).1)
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
    let mut motion = Motion::new(&ball, 0.0, [-1.0, 0.0]);
    let mut step = Step::default();
    let fall = (2.0_f64 / 10.0).sqrt();
    let (mut bounces, mut breakdown) = (Vec::new(), None);
    while motion.time < 10.0 && breakdown.is_none() {
        motion.step(&ball, 10.0, 1e-12, &mut step);
        for i in 0..=8 {
            let height = -ball.at(&step.jet, step.length * f64::from(i) / 8.0)[0];
            assert!(height >= -1e-15, "{height:e} at {}", step.start);
        }
        if step.event != 0.0 {
            bounces.push(motion.time);
        }
        breakdown = motion.breakdown(&ball, &step, 0);
    }
    // The n-th bounce is at fall (1 + 2 (1/2 + 1/4 + ...)): infinitely many before 3 fall.
    for (n, bounce) in bounces.iter().enumerate().take(20) {
        let exact = fall * (3.0 - 2.0 * 0.5_f64.powi(n as i32));
        assert!((bounce - exact).abs() < 1e-12, "bounce {n}: {bounce} {exact}");
    }
    assert_eq!(breakdown, Some(Breakdown::Chatter), "an endless series of bounces is ran");
    assert!((motion.time - 3.0 * fall).abs() < 1e-9, "{}", motion.time);
}
