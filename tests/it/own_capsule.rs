//! The capsule by a method of its own, sampled densely: Runge and Kutta's rule with a fixed step, in plain numbers.

/// Steps per second. A capsule whose velocity changes its sign within a step comes to rest at its end, which leaves errors far below
/// the noise of any sensor.
const RATE: f64 = 2e5;

/// A capsule in Filippov's reading under the Coulomb-Stribeck law (SI).
#[derive(Debug, Clone, Copy)]
pub struct OwnCapsule {
    pub m1: f64,
    pub m2: f64,
    pub k1: f64,
    pub c: f64,
    pub k2: f64,
    pub delta: f64,
    pub p_d: f64,
    pub omega: f64,
    pub mu_s: f64,
    pub mu_d: f64,
    pub v_s: f64,
    pub g: f64,
}

/// A state of it, with what sensors see of it.
#[derive(Debug, Clone, Copy)]
pub struct OwnState {
    pub t: f64,
    pub r: f64,
    pub x2: f64,
    pub a1: f64,
}

impl OwnCapsule {
    /// Table 1 of the paper with what its Fig 5 was drawn for.
    pub const FIG5: OwnCapsule = OwnCapsule {
        m1: 0.11,
        m2: 0.53,
        k1: 1420.0,
        c: 3.89,
        k2: 2420.0,
        delta: 3.5e-3,
        p_d: 4.0,
        omega: 77.91,
        mu_s: 0.66,
        mu_d: 0.33,
        v_s: 0.3,
        g: 9.81,
    };
    /// That of Fig 6, which rests for most of the time.
    pub const FIG6: OwnCapsule =
        OwnCapsule { k2: 18960.0, delta: 1.5e-3, omega: 20.73, ..OwnCapsule::FIG5 };

    fn load(&self) -> f64 {
        (self.m1 + self.m2) * self.g
    }

    fn force(&self, r: f64, relative: f64) -> f64 {
        self.k1 * r + self.c * relative + self.k2 * (r - self.delta).max(0.0)
    }

    /// Rates of (r, y1, x2, y2) while the capsule moves in this direction, or rests for 0.
    fn rates(&self, t: f64, [r, y1, _, y2]: [f64; 4], direction: f64) -> [f64; 4] {
        let force = self.force(r, y1 - y2);
        let friction = self.mu_d * (1.0 + (-y2.abs() / self.v_s).exp()) * self.load();
        let a2 = if direction == 0.0 { 0.0 } else { (force - direction * friction) / self.m2 };
        [y1 - y2, (self.p_d * (self.omega * t).cos() - force) / self.m1, y2, a2]
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

    /// Every step of so many cycles, after as many as make it settle from rest; the drive has no phase at t = 0.
    pub fn settled(&self, settle: u32, cycles: u32) -> Vec<OwnState> {
        let steps = |cycles: u32| {
            (f64::from(cycles) * std::f64::consts::TAU / self.omega * RATE).ceil() as u64
        };
        let break_away = self.mu_s.max(2.0 * self.mu_d) * self.load();
        let (mut state, mut direction) = ([0.0; 4], 0.0);
        let mut all = Vec::new();
        for step in 0..steps(settle + cycles) {
            let t = step as f64 / RATE;
            let force = self.force(state[0], state[1] - state[3]);
            if direction == 0.0 && force.abs() > break_away {
                direction = force.signum();
            }
            if step >= steps(settle) {
                let a1 = self.rates(t, state, direction)[1];
                let [r, _, x2, _] = state;
                all.push(OwnState { t, r, x2, a1 });
            }
            state = self.step(t, state, direction);
            if state[3] * direction < 0.0 {
                (state[3], direction) = (0.0, 0.0);
            }
        }
        all
    }

    /// How many steps a sample of this rate [Hz] takes.
    pub fn steps_per_sample(rate: f64) -> usize {
        (RATE / rate).round() as usize
    }
}
