//! A second method that shares no code with the series: extrapolation of Gragg's rule, events by bracketing.

use capsulemap_models::capsule::{
    CapsuleParameters as _, Parameter, Parameters, Resistance, State,
};

/// r, y1, x2, y2.
type Vector = [f64; 4];

/// Columns of the extrapolation.
const COLUMNS: usize = 9;
/// Difference of the last two columns, relative to the largest values met.
const ACCURACY: f64 = 1e-14;
/// What is asked of the last column, where rounding is more than that.
const ROUNDING: f64 = 1e-11;
/// Values below which a displacement [m] and a velocity [m/s] count as nothing.
const LEAST: Vector = [1e-5, 1e-3, 1e-5, 1e-3];

/// The capsule in Filippov's reading, one mode at a time.
struct Second<'a> {
    p: &'a Parameters,
    phase: f64,
    closed: bool,
    /// Direction of sliding, 0 at rest.
    slip: f64,
    /// Largest values met, by which accuracy is judged.
    scale: Vector,
}

/// What ends a step.
#[derive(Clone, Copy, PartialEq)]
enum Guard {
    Contact,
    Speed,
    BreakAway(f64),
}

/// The states at the ends of the first `cycles` drive cycles, as (r, y1, x2, y2).
pub fn follow(p: &Parameters, phase: f64, start: State<f64>, cycles: u64) -> Vec<Vector> {
    let state = [start.r, start.y1, start.x2, start.y2];
    let mut second =
        Second { p, phase, closed: start.r > p[Parameter::Delta], slip: 0.0, scale: LEAST };
    let force = second.force(&state);
    second.slip = match start.y2 {
        0.0 if force.abs() <= second.break_away() => 0.0,
        0.0 => force.signum(),
        speed => speed.signum(),
    };
    let mut sections = vec![state];
    for _ in 0..cycles {
        let before = *sections.last().expect("the start");
        sections.push(second.cycle(before));
    }
    sections
}

impl Second<'_> {
    fn of(&self, parameter: Parameter) -> f64 {
        self.p[parameter]
    }

    fn load(&self) -> f64 {
        (self.of(Parameter::M1) + self.of(Parameter::M2)) * self.of(Parameter::G)
    }

    fn break_away(&self) -> f64 {
        let (mu_s, mu_d) = (self.of(Parameter::MuS), self.of(Parameter::MuD));
        match self.p.resistance() {
            Resistance::CoulombStribeck => mu_s.max(2.0 * mu_d) * self.load(),
            Resistance::Coulomb => mu_s.max(mu_d) * self.load(),
            Resistance::Medium => 0.0,
        }
    }

    fn force(&self, &[r, y1, _, y2]: &Vector) -> f64 {
        let contact = if self.closed {
            self.of(Parameter::K2) * (r - self.of(Parameter::Delta))
        } else {
            0.0
        };
        self.of(Parameter::K1) * r + self.of(Parameter::C) * (y1 - y2) + contact
    }

    fn resistance(&self, y2: f64) -> f64 {
        let dry = self.slip * self.of(Parameter::MuD) * self.load();
        match self.p.resistance() {
            Resistance::CoulombStribeck => {
                dry * (1.0 + libm::exp(-(self.slip * y2) / self.of(Parameter::Vs)))
            }
            Resistance::Coulomb => dry,
            Resistance::Medium => {
                self.of(Parameter::C1) * y2 + self.of(Parameter::C2) * self.slip * y2 * y2
            }
        }
    }

    fn rates(&self, t: f64, state: &Vector) -> Vector {
        let [_, y1, _, y2] = *state;
        let force = self.force(state);
        let drive = self.of(Parameter::Pd) * libm::cos(self.of(Parameter::Omega) * t + self.phase);
        let acceleration = (drive - force) / self.of(Parameter::M1);
        if self.slip == 0.0 {
            return [y1, acceleration, 0.0, 0.0];
        }
        [y1 - y2, acceleration, y2, (force - self.resistance(y2)) / self.of(Parameter::M2)]
    }

    /// The state after `h`, by Gragg's modified midpoint rule with 2, 4, 6, ... steps, extrapolated in the
    /// square of the step (Bulirsch and Stoer 1966); none where it does not converge.
    fn advanced(&self, t: f64, state: &Vector, h: f64) -> Option<Vector> {
        let mut before: Vec<Vector> = Vec::new();
        let first = self.rates(t, state);
        for column in 0..COLUMNS {
            let n = 2 * (column + 1);
            let step = h / n as f64;
            let (mut old, mut new) = (*state, moved(state, step, &first));
            for k in 1..n {
                let next = moved(&old, 2.0 * step, &self.rates(t + k as f64 * step, &new));
                (old, new) = (new, next);
            }
            let last = moved(&new, step, &self.rates(t + h, &new));
            let mut row = vec![std::array::from_fn(|i| 0.5 * (old[i] + last[i]))];
            for (k, coarse) in before.iter().enumerate() {
                let ratio = n as f64 / (2 * (column - k)) as f64;
                let fine: Vector = row[k];
                row.push(std::array::from_fn(|i| {
                    fine[i] + (fine[i] - coarse[i]) / (ratio * ratio - 1.0)
                }));
            }
            let apart = before.last().map_or(f64::INFINITY, |coarse| {
                let apart = (0..4).map(|i| (row[column][i] - coarse[i]).abs() / self.scale[i]);
                apart.fold(0.0, f64::max)
            });
            let is_last = column + 1 == COLUMNS;
            if column > 2 && apart <= if is_last { ROUNDING } else { ACCURACY } {
                return Some(row[column]);
            }
            before = row;
        }
        None
    }

    /// The guards of the mode, and their values: positive while it lasts.
    fn guards(&self, state: &Vector) -> Vec<(Guard, f64)> {
        let gap = state[0] - self.of(Parameter::Delta);
        let contact = (Guard::Contact, if self.closed { gap } else { -gap });
        if self.slip != 0.0 {
            return vec![contact, (Guard::Speed, self.slip * state[3])];
        }
        let (limit, force) = (self.break_away(), self.force(state));
        vec![
            contact,
            (Guard::BreakAway(1.0), limit - force),
            (Guard::BreakAway(-1.0), limit + force),
        ]
    }

    fn rates_of_guards(&self, t: f64, state: &Vector) -> Vec<f64> {
        let h = 1e-9 / self.of(Parameter::Omega);
        let ahead = moved(state, h, &self.rates(t, state));
        let pairs = self.guards(&ahead).into_iter().zip(self.guards(state));
        pairs.map(|((_, later), (_, now))| (later - now) / h).collect()
    }

    /// A step that resolves the springs, the drive and the layer of the friction.
    fn usual_step(&self, t: f64, state: &Vector) -> f64 {
        let [_, _, _, y2] = *state;
        let stiffness =
            self.of(Parameter::K1) + if self.closed { self.of(Parameter::K2) } else { 0.0 };
        let inverse_mass = 1.0 / self.of(Parameter::M1) + 1.0 / self.of(Parameter::M2);
        let fastest = (stiffness * inverse_mass).sqrt()
            + self.of(Parameter::C) * inverse_mass
            + self.of(Parameter::Omega);
        let h = 0.2 / fastest;
        if self.slip == 0.0 || self.p.resistance() != Resistance::CoulombStribeck {
            return h;
        }
        let width = self.of(Parameter::Vs).max(0.2 * (y2.abs() - 40.0 * self.of(Parameter::Vs)));
        let steepest = self.of(Parameter::MuD) * self.load() / self.of(Parameter::Vs);
        let growth =
            steepest * libm::exp(-y2.abs() / self.of(Parameter::Vs)) / self.of(Parameter::M2);
        let acceleration = self.rates(t, state)[3].abs() + 1e-3 * growth * self.of(Parameter::Vs);
        h.min(width / acceleration).min(0.5 / growth.max(fastest))
    }

    /// The state a drive cycle later.
    fn cycle(&mut self, mut state: Vector) -> Vector {
        let period = self.p.drive_period();
        let mut t = 0.0;
        // The guard that has just ended a mode starts at zero.
        let mut fired: Option<Guard> = None;
        while t < period {
            for (scale, value) in self.scale.iter_mut().zip(state) {
                *scale = scale.max(value.abs());
            }
            let mut h = self.usual_step(t, &state).min(period - t);
            let (end, ends) = loop {
                let Some(end) = self.advanced(t, &state, h) else {
                    h *= 0.5;
                    continue;
                };
                match self.crossed(t, &state, h, &end, fired) {
                    // A guard may have dipped below zero and risen again.
                    None => h *= 0.5,
                    Some(ends) => break (end, ends),
                }
            };
            let Some(guard) = ends else {
                (state, t, fired) = (end, if h >= period - t { period } else { t + h }, None);
                continue;
            };
            let (root, at_root) = self.located(t, &state, h, guard);
            (state, t) = (at_root, t + root);
            fired = self.switched(guard, &mut state);
        }
        state
    }

    /// Whether and which guard is below zero at the end of a step; nothing is known where one that stays
    /// positive at both ends turns between.
    fn crossed(
        &self,
        t: f64,
        state: &Vector,
        h: f64,
        end: &Vector,
        fired: Option<Guard>,
    ) -> Option<Option<Guard>> {
        let negative: Vec<Guard> = self
            .guards(end)
            .into_iter()
            .filter(|(_, value)| *value < 0.0)
            .map(|(guard, _)| guard)
            .collect();
        let first = negative.into_iter().map(|guard| (self.located(t, state, h, guard).0, guard));
        if let Some((_, guard)) = first.min_by(|a, b| a.0.total_cmp(&b.0)) {
            return Some(Some(guard));
        }
        let falling = self.rates_of_guards(t, state);
        let rising = self.rates_of_guards(t + h, end);
        let turns = self.guards(state).into_iter().zip(falling.iter().zip(&rising)).any(
            |((guard, value), (before, after))| {
                fired != Some(guard) && *before < 0.0 && *after > 0.0 && value + before * h < 0.0
            },
        );
        if turns && h > 1e-9 / self.of(Parameter::Omega) { None } else { Some(None) }
    }

    /// When a guard that is below zero at the end of a step passes zero, and the state then.
    fn located(&self, t: f64, state: &Vector, h: f64, guard: Guard) -> (f64, Vector) {
        let value = |h: f64| {
            let state = self.advanced(t, state, h).expect("a shorter step converges");
            let found = self.guards(&state).into_iter().find(|(known, _)| *known == guard);
            (found.expect("the mode lasts").1, state)
        };
        let (mut low, mut high) = (0.0, h);
        let (mut below, mut above) = (value(high).0, None::<f64>);
        for round in 0..100 {
            // The Illinois form of false position, with a bisection now and then.
            let middle = match above {
                Some(above) if round % 3 != 2 => low + (high - low) * above / (above - below),
                _ => 0.5 * (low + high),
            };
            if middle <= low || middle >= high || high - low <= 1e-17 {
                break;
            }
            let (at, _) = value(middle);
            if at < 0.0 {
                (high, below) = (middle, at);
                above = above.map(|above| 0.5 * above);
            } else {
                (low, above) = (middle, Some(at));
                below *= 0.5;
            }
        }
        (high, value(high).1)
    }

    /// Changes the mode, and puts the state on the surface that it begins on.
    fn switched(&mut self, guard: Guard, state: &mut Vector) -> Option<Guard> {
        match guard {
            Guard::Contact => {
                self.closed = !self.closed;
                state[0] = self.of(Parameter::Delta);
                Some(Guard::Contact)
            }
            Guard::BreakAway(side) => {
                self.slip = side;
                Some(Guard::Speed)
            }
            Guard::Speed => {
                state[3] = 0.0;
                let force = self.force(state);
                let rests = force.abs() <= self.break_away();
                self.slip = if rests { 0.0 } else { force.signum() };
                (!rests).then_some(Guard::Speed)
            }
        }
    }
}

fn moved(state: &Vector, h: f64, rates: &Vector) -> Vector {
    std::array::from_fn(|i| state[i] + h * rates[i])
}
