//! Other switched systems through the same integrator: a bouncing ball and a rigid impact oscillator.

use std::f64::consts::PI;

use capsulemap::flow::{Breakdown, Motion, Step};
use capsulemap::lane::{ORDER, Series, elementary::sin_cos, series};
use capsulemap::model::{Switched, Zeros};

/// A mass on a spring under cos(wt), thrown back by a rigid stop: x'' + k x = cos(wt), x' -> -e x' at x = s.
struct Impact {
    k: f64,
    omega: f64,
    gravity: f64,
    stop: f64,
    restitution: f64,
}

#[derive(Clone, Copy, Debug)]
struct Point {
    x: f64,
    v: f64,
}

#[derive(Default)]
struct PointJet {
    x: Series<f64>,
    v: Series<f64>,
}

impl Switched<f64> for Impact {
    type State = Point;
    type Mode = ();
    type Jet = PointJet;
    const GUARDS: usize = 1;

    fn start(&self, _time: f64, _state: &mut Point) {}

    fn expand(&self, _mode: &(), time: f64, state: &Point, jet: &mut PointJet) {
        let turn = 2.0 * PI;
        let (mut s, mut c) = sin_cos((self.omega * time).rem_euclid(turn));
        if self.omega == 0.0 {
            c = 0.0;
        }
        (jet.x[0], jet.v[0]) = (state.x, state.v);
        for k in 0..ORDER {
            let per = 1.0 / (k + 1) as f64;
            let weight = if k == 0 { self.gravity } else { 0.0 };
            jet.x[k + 1] = jet.v[k] * per;
            jet.v[k + 1] = (c + weight - self.k * jet.x[k]) * per;
            (c, s) = (-self.omega * s * per, self.omega * c * per);
        }
    }

    fn pace<'a>(&self, jet: &'a PointJet) -> [&'a Series<f64>; 2] {
        [&jet.x, &jet.v]
    }

    fn watched(&self, _which: usize, _mode: &()) -> bool {
        true
    }

    fn guard(&self, _which: usize, _mode: &(), jet: &PointJet, gap: &mut Series<f64>) {
        *gap = jet.x.map(|a| -a);
        gap[0] = self.stop - jet.x[0];
    }

    fn at(&self, jet: &PointJet, h: f64) -> Point {
        Point { x: series::value(&jet.x, h), v: series::value(&jet.v, h) }
    }

    fn switch(
        &self,
        _which: usize,
        due: bool,
        _mode: &mut (),
        state: &mut Point,
        zeros: &mut Zeros<f64>,
        _time: f64,
    ) -> f64 {
        if due {
            *state = Point { x: self.stop, v: -self.restitution * state.v };
            zeros[0] = 1.0;
        }
        f64::from(u8::from(due))
    }

    fn lost(&self, state: &Point) -> bool {
        !(state.x + state.v).is_finite()
    }
}

#[test]
fn a_bouncing_ball_never_falls_through_the_floor() {
    // Drop from 1 m under 10 m/s^2 onto x = 0 (the guard is the height -x): the speed halves each time.
    let ball = Impact { k: 0.0, omega: 0.0, gravity: 10.0, stop: 0.0, restitution: 0.5 };
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

#[test]
fn a_rigid_impact_oscillator_repeats_its_closed_form() {
    // One impact per n = 2 drive periods: x = A cos wt + B sin(t - ...) between impacts, solved for x and v
    // at the impact from periodicity; restitution 0.8, k = 1, stop at s.
    let (omega, restitution, n) = (2.6, 0.8, 2.0);
    let amplitude = 1.0 / (1.0 - omega * omega);
    let period = n * 2.0 * PI / omega;
    // Between impacts x = amplitude cos(w t + phi) + a cos t + b sin t with x(0) = x(period) = s,
    // x'(0) = v, x'(period) = -v / e. The drive's part repeats, so a and b satisfy
    // a (cos P - 1) + b sin P = 0, -a sin P + b (cos P - 1) = -v (1 + 1/e).
    let (sin, cos) = period.sin_cos();
    let (phi, v): (f64, f64) = (0.7, -0.5);
    // Choose the speed after the impact freely and find the stop that makes it an orbit.
    let jump = -v * (1.0 + 1.0 / restitution);
    let determinant = (cos - 1.0).powi(2) + sin * sin;
    let (a, b) = (-sin * jump / determinant, (cos - 1.0) * jump / determinant);
    // The velocity at 0 must be v: -amplitude w sin phi + b = v, which fixes phi.
    let sin_phi = (b - v) / (amplitude * omega);
    assert!(sin_phi.abs() < 1.0, "{sin_phi} {phi}");
    let phi = sin_phi.asin();
    let stop = amplitude * phi.cos() + a;
    let oscillator = Impact { k: 1.0, omega, gravity: 0.0, stop, restitution };
    let mut motion = Motion::new(&oscillator, phi / omega, Point { x: stop, v });
    let mut step = Step::default();
    while step.event == 0.0 {
        motion.step(&oscillator, 100.0, 1e-13, &mut step);
    }
    let elapsed = step.start + step.length - phi / omega;
    assert!((elapsed - period).abs() < 1e-11, "{elapsed} {period}");
    assert!((motion.state.v - v).abs() < 1e-11 && motion.state.x == stop, "{:?}", motion.state);
}
