//! A second method that shares no code with the series: extrapolation of Gragg's rule, events by bracketing.

mod equations;

use capsulemap_models::capsule::{
    CapsuleParameters as _, Parameter, Parameters, Resistance, State,
};

use equations::{Line, Second};

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

/// What ends a step.
#[derive(Clone, Copy, PartialEq)]
enum Guard {
    /// The stop of this number.
    Contact(usize),
    Speed,
    BreakAway(f64),
}

/// The states at the ends of the first `cycles` drive cycles, as (r, y1, x2, y2).
pub fn follow(p: &Parameters, phase: f64, start: State<f64>, cycles: u64) -> Vec<Vector> {
    let state = [start.r, start.y1, start.x2, start.y2];
    let line = Line::default();
    let mut second = Second { p, phase, touched: [false; 2], slip: 0.0, line, scale: LEAST };
    second.touched = [0, 1].map(|stop| second.depth(stop, &state) > 0.0);
    second.line = second.line_at(0.0, 0.0);
    second.slip = match start.y2 {
        0.0 => second.start_of_sliding(0.0, &state),
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
    fn guards(&self, t: f64, state: &Vector) -> Vec<(Guard, f64)> {
        let contact = |stop: usize| {
            let depth = self.depth(stop, state);
            (Guard::Contact(stop), if self.touched[stop] { depth } else { -depth })
        };
        let mut guards = vec![contact(0), contact(1)];
        if self.slip != 0.0 {
            guards.push((Guard::Speed, self.slip * state[3]));
            return guards;
        }
        let push = self.push(t, state);
        guards.push((Guard::BreakAway(1.0), self.break_away(1.0) - push));
        guards.push((Guard::BreakAway(-1.0), self.break_away(-1.0) + push));
        guards
    }

    fn rates_of_guards(&self, t: f64, state: &Vector) -> Vec<f64> {
        let h = 1e-9 / self.omega();
        let ahead = moved(state, h, &self.rates(t, state));
        let pairs = self.guards(t + h, &ahead).into_iter().zip(self.guards(t, state));
        pairs.map(|((_, later), (_, now))| (later - now) / h).collect()
    }

    /// A step that resolves the springs, the drive and the layer of the friction.
    fn usual_step(&self, t: f64, state: &Vector) -> f64 {
        let [_, _, _, y2] = *state;
        let far = 1e-2 + state[0].abs();
        let cubic = self.part(Parameter::K1Cubic).abs() + self.part(Parameter::K2Cubic).abs();
        let stiffness = self.of(Parameter::K1)
            + if self.touched[0] { self.of(Parameter::K2) } else { 0.0 }
            + if self.touched[1] { self.part(Parameter::K3) } else { 0.0 }
            + 3.0 * cubic * far * far;
        let damping = self.of(Parameter::C)
            + self.part(Parameter::K2Damping)
            + self.part(Parameter::K3Damping);
        let inverse_mass = 1.0 / self.of(Parameter::M1) + 1.0 / self.of(Parameter::M2);
        let fastest = (stiffness * inverse_mass).sqrt() + damping * inverse_mass + self.omega();
        let h = 0.2 / fastest;
        if self.slip == 0.0 || self.p.resistance() != Resistance::CoulombStribeck {
            return h;
        }
        let width = self.of(Parameter::Vs).max(0.2 * (y2.abs() - 40.0 * self.of(Parameter::Vs)));
        let mu_d = self.mu_d(self.slip) * self.stribeck();
        let steepest = mu_d * self.load() / self.of(Parameter::Vs);
        let growth =
            steepest * libm::exp(-y2.abs() / self.of(Parameter::Vs)) / self.of(Parameter::M2);
        let acceleration = self.rates(t, state)[3].abs() + 1e-3 * growth * self.of(Parameter::Vs);
        h.min(width / acceleration).min(0.5 / growth.max(fastest))
    }

    /// The state a drive cycle later.
    fn cycle(&mut self, mut state: Vector) -> Vector {
        let mut from = 0.0;
        for to in self.cuts() {
            self.line = self.line_at(from, to);
            // The force on a capsule at rest may have jumped.
            let leaves = if self.slip == 0.0 { self.start_of_sliding(from, &state) } else { 0.0 };
            let mut fired = None;
            if leaves != 0.0 {
                (self.slip, fired) = (leaves, Some(Guard::Speed));
            }
            state = self.between_edges(from, to, state, fired);
            from = to;
        }
        state
    }

    /// The state at the end of a part of a cycle without an edge of the drive; the guard that has `fired` starts at zero.
    fn between_edges(
        &mut self,
        mut t: f64,
        to: f64,
        mut state: Vector,
        mut fired: Option<Guard>,
    ) -> Vector {
        while t < to {
            for (scale, value) in self.scale.iter_mut().zip(state) {
                *scale = scale.max(value.abs());
            }
            let mut h = self.usual_step(t, &state).min(to - t);
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
                (state, t, fired) = (end, if h >= to - t { to } else { t + h }, None);
                continue;
            };
            let (root, at_root) = self.located(t, &state, h, guard);
            (state, t) = (at_root, t + root);
            fired = self.switched(guard, t, &mut state);
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
            .guards(t + h, end)
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
        let turns = self.guards(t, state).into_iter().zip(falling.iter().zip(&rising)).any(
            |((guard, value), (before, after))| {
                fired != Some(guard) && *before < 0.0 && *after > 0.0 && value + before * h < 0.0
            },
        );
        if turns && h > 1e-9 / self.omega() { None } else { Some(None) }
    }

    /// When a guard that is below zero at the end of a step passes zero, and the state then.
    fn located(&self, t: f64, state: &Vector, h: f64, guard: Guard) -> (f64, Vector) {
        let value = |h: f64| {
            let state = self.advanced(t, state, h).unwrap_or_else(|| {
                panic!("a shorter step converges: {h:e} at {t} of {state:?}, slip {}, touched {:?}, {:?}", self.slip, self.touched, self.p)
            });
            let found = self.guards(t + h, &state).into_iter().find(|(known, _)| *known == guard);
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
    fn switched(&mut self, guard: Guard, t: f64, state: &mut Vector) -> Option<Guard> {
        match guard {
            Guard::Contact(stop) => {
                self.touched[stop] = !self.touched[stop];
                let surfaces = [self.of(Parameter::Delta), -self.part(Parameter::Delta3)];
                state[0] = surfaces[stop];
                // The force of a stop that damps jumps.
                let leaves = if self.slip == 0.0 { self.start_of_sliding(t, state) } else { 0.0 };
                if leaves != 0.0 {
                    self.slip = leaves;
                }
                Some(guard)
            }
            Guard::BreakAway(side) => {
                self.slip = side;
                Some(Guard::Speed)
            }
            Guard::Speed => {
                state[3] = 0.0;
                self.slip = self.start_of_sliding(t, state);
                (self.slip != 0.0).then_some(Guard::Speed)
            }
        }
    }
}

fn moved(state: &Vector, h: f64, rates: &Vector) -> Vector {
    std::array::from_fn(|i| state[i] + h * rates[i])
}
