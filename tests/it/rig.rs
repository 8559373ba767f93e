//! A rig that the model does not describe: the capsule of Fig 6 with a stop that is softer and stiffens, and with less friction, by a
//! method of its own.

use capsulemap::capsule::{CapsuleParameters as _, Parameter, Parameters};

/// Steps of the method per second; its errors, of the order of a step where the friction switches, are far below the sensors' noise.
const RATE: f64 = 2e5;

/// A rig whose stop has the force `k2 x + k3 x^3`.
pub struct Rig {
    /// Its parameters.
    pub parameters: Parameters,
    /// The cubic stiffness of the stop [N/m^3].
    pub k3: f64,
}

/// A sample of the rig's motion.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Time [s].
    pub t: f64,
    /// Relative displacement [m].
    pub r: f64,
    /// Displacement of the capsule [m].
    pub x2: f64,
    /// Acceleration of the mass [m/s^2].
    pub a1: f64,
    /// Force of the drive [N].
    pub drive: f64,
}

impl Rig {
    fn force(&self, r: f64, relative: f64) -> f64 {
        let p = &self.parameters;
        let depth = (r - p[Parameter::Delta]).max(0.0);
        p[Parameter::K1] * r
            + p[Parameter::C] * relative
            + p[Parameter::K2] * depth
            + self.k3 * depth.powi(3)
    }

    /// Rates of (r, y1, x2, y2) while the capsule moves in this direction, or rests for 0.
    fn rates(&self, t: f64, [r, y1, _, y2]: [f64; 4], direction: f64) -> [f64; 4] {
        let p = &self.parameters;
        let drive = p[Parameter::Pd] * (p[Parameter::Omega] * t).cos();
        let force = self.force(r, y1 - y2);
        let friction =
            p[Parameter::MuD] * (1.0 + (-y2.abs() / p[Parameter::Vs]).exp()) * p.normal_load();
        let a2 =
            if direction == 0.0 { 0.0 } else { (force - direction * friction) / p[Parameter::M2] };
        [y1 - y2, (drive - force) / p[Parameter::M1], y2, a2]
    }

    /// Samples at `rate` of so many cycles, after as many as make it settle. Runge and Kutta's rule of fourth order with a fixed step; a
    /// capsule whose velocity changes its sign within a step comes to rest, and leaves it where the force is above the
    /// break-away force.
    pub fn samples(&self, rate: f64, settle: u32, cycles: u32) -> Vec<Sample> {
        let period = self.parameters.drive_period();
        let every = (RATE / rate).round() as u64;
        let from = (f64::from(settle) * period * RATE).ceil() as u64;
        let to = (f64::from(settle + cycles) * period * RATE) as u64;
        let (mut state, mut direction) = ([0.0; 4], 0.0);
        let mut samples = Vec::new();
        for step in 0..=to {
            let t = step as f64 / RATE;
            if direction == 0.0 {
                let force = self.force(state[0], state[1]);
                if force.abs() > self.parameters.break_away() {
                    direction = force.signum();
                }
            }
            if step >= from && (step - from).is_multiple_of(every) {
                let a1 = self.rates(t, state, direction)[1];
                let drive =
                    self.parameters[Parameter::Pd] * (self.parameters[Parameter::Omega] * t).cos();
                samples.push(Sample {
                    t: (step - from) as f64 / RATE,
                    r: state[0],
                    x2: state[2],
                    a1,
                    drive,
                });
            }
            state = self.step(t, state, direction);
            if state[3] * direction < 0.0 {
                (state[3], direction) = (0.0, 0.0);
            }
        }
        samples
    }

    fn step(&self, t: f64, state: [f64; 4], direction: f64) -> [f64; 4] {
        let h = 1.0 / RATE;
        let moved =
            |by: [f64; 4], h: f64| -> [f64; 4] { std::array::from_fn(|i| state[i] + h * by[i]) };
        let a = self.rates(t, state, direction);
        let b = self.rates(t + 0.5 * h, moved(a, 0.5 * h), direction);
        let c = self.rates(t + 0.5 * h, moved(b, 0.5 * h), direction);
        let d = self.rates(t + h, moved(c, h), direction);
        moved(std::array::from_fn(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0), h)
    }
}
