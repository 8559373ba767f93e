//! A second method that shares no code with the series: extrapolation of Gragg's rule, events by bracketing.

mod equations;

use capsulemap_models::capsule::{
    CapsuleParameters as _, DriveKind, Parameter, Parameters, Resistance, State,
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
    /// The force of the stop of this number.
    Force(usize),
    Speed,
    BreakAway(f64),
}

/// The states at the ends of the first `cycles` drive cycles, as (r, y1, x2, y2).
pub fn follow(p: &Parameters, phase: f64, start: State<f64>, cycles: u64) -> Vec<Vector> {
    let state = [start.r, start.y1, start.x2, start.y2];
    let line = Line::default();
    let begins = start.place;
    let (touched, let_go) = ([false; 2], [false; 2]);
    let mut second = Second { p, phase, begins, touched, let_go, slip: 0.0, line, scale: LEAST };
    let beyond = [0, 1].map(|stop| second.depth(stop, &state) > 0.0);
    assert!(!(beyond[0] && second.is_rigid()), "no motion starts behind a rigid stop");
    second.let_go =
        [0, 1].map(|stop| second.releases_by_force() && second.pressing(stop, &state) < 0.0);
    for stop in [0, 1] {
        second.touched[stop] = beyond[stop] && !second.let_go[stop];
        second.let_go[stop] &= beyond[stop];
    }
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
            let is_beyond = self.touched[stop] || self.let_go[stop];
            (Guard::Contact(stop), if is_beyond { depth } else { -depth })
        };
        let mut guards = vec![contact(0), contact(1)];
        if self.is_at_stop() {
            guards[0].1 = self.bearing(t, state);
        }
        for stop in [0, 1] {
            let pressing = self.pressing(stop, state);
            if self.releases_by_force() && (self.touched[stop] || self.let_go[stop]) {
                let sign = if self.touched[stop] { 1.0 } else { -1.0 };
                guards.push((Guard::Force(stop), sign * pressing));
            }
        }
        if self.slip != 0.0 {
            guards.push((Guard::Speed, self.slip * state[3]));
            return guards;
        }
        let push = self.push(t, state);
        guards.push((Guard::BreakAway(1.0), self.break_away(1.0, state) - push));
        guards.push((Guard::BreakAway(-1.0), self.break_away(-1.0, state) + push));
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
            let before = self.line;
            self.line = self.line_at(from, to);
            if from > 0.0 {
                self.jump_at_edge(before, from, &mut state);
            }
            // The force on a capsule at rest may have jumped.
            let leaves = if self.slip == 0.0 { self.start_of_sliding(from, &state) } else { 0.0 };
            let mut fired = None;
            if leaves != 0.0 {
                (self.slip, fired) = (leaves, Some(Guard::Speed));
            }
            fired = self.let_go_at_once(from, &state).or(fired);
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
        let located = negative.into_iter().map(|guard| (self.located(t, state, h, guard), guard));
        let first = located.min_by(|a, b| a.0.0.total_cmp(&b.0.0));
        // Another guard may have dipped before the first that stays below zero.
        let (until, there, passes) = match first {
            Some(((root, there), guard)) => (root, there, Some(guard)),
            None => (h, *end, None),
        };
        let falling = self.rates_of_guards(t, state);
        let rising = self.rates_of_guards(t + until, &there);
        let turns = self.guards(t, state).into_iter().zip(falling.iter().zip(&rising)).any(
            |((guard, value), (before, after))| {
                let is_known = fired == Some(guard) || passes == Some(guard);
                !is_known && *before < 0.0 && *after > 0.0 && value + before * until < 0.0
            },
        );
        if turns && h > 1e-9 / self.omega() { None } else { Some(passes) }
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
            Guard::Contact(0) if self.is_rigid() => {
                state[0] = self.of(Parameter::Delta);
                if self.touched[0] {
                    self.touched[0] = false;
                } else {
                    self.bounce(t, state);
                }
                if self.slip == 0.0 {
                    self.slip = self.start_of_sliding(t, state);
                }
                Some(guard)
            }
            Guard::Force(stop) => {
                let lets_go = self.touched[stop];
                (self.touched[stop], self.let_go[stop]) = (!lets_go, lets_go);
                Some(guard)
            }
            Guard::Contact(stop) if self.let_go[stop] => {
                self.let_go[stop] = false;
                Some(guard)
            }
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
                self.let_go_at_once(t, state).or(Some(Guard::Speed))
            }
            Guard::Speed => {
                state[3] = 0.0;
                if self.is_at_stop() {
                    state[1] = 0.0;
                }
                self.slip = self.start_of_sliding(t, state);
                let own = (self.slip != 0.0).then_some(Guard::Speed);
                self.let_go_at_once(t, state).or(own)
            }
        }
    }

    /// Opens a contact that lasts where its force has jumped below zero.
    fn let_go_at_once(&mut self, t: f64, state: &Vector) -> Option<Guard> {
        if !self.is_at_stop() || self.bearing(t, state) >= 0.0 {
            return None;
        }
        self.touched[0] = false;
        if self.slip == 0.0 {
            self.slip = self.start_of_sliding(t, state);
        }
        Some(Guard::Contact(0))
    }

    /// Where a prescribed velocity jumps, momentum stays.
    fn jump_at_edge(&mut self, before: Line, t: f64, state: &mut Vector) {
        if self.p.shape().drive != DriveKind::TwoPhase {
            return;
        }
        let [m1, m2] = [Parameter::M1, Parameter::M2].map(|it| self.of(it));
        let after = self.line;
        self.line = before;
        let old = self.prescribed(t)[0];
        self.line = after;
        let new = self.prescribed(t)[0];
        state[3] -= m1 * (new - old) / (m1 + m2);
        state[1] = state[3] + new;
        self.slip = sign(state[3]);
    }

    /// An impact on the rigid stop: momentum stays, the relative velocity turns round; where what follows is over within 1e-7 of the
    /// period, the mass stays at the stop, as shorter flights are rounding here.
    fn bounce(&mut self, t: f64, state: &mut Vector) {
        let [m1, m2, e] =
            [Parameter::M1, Parameter::M2, Parameter::Restitution].map(|it| self.of(it));
        let momentum = m1 * state[1] + m2 * state[3];
        let back = e * (state[1] - state[3]);
        let with = |relative: f64| {
            let y2 = (momentum + m1 * relative) / (m1 + m2);
            (y2 - relative, y2)
        };
        (state[1], state[3]) = with(back);
        self.slip = sign(state[3]);
        let rates = self.rates(t, state);
        let pressed = rates[1] - rates[3];
        let lasting = 1e-7 * 2.0 * std::f64::consts::PI / self.omega();
        if pressed > 0.0 && 2.0 * back <= pressed * (1.0 - e) * lasting {
            (state[1], state[3]) = with(0.0);
            self.slip = sign(state[3]);
            self.touched[0] = true;
        }
    }
}

fn moved(state: &Vector, h: f64, rates: &Vector) -> Vector {
    std::array::from_fn(|i| state[i] + h * rates[i])
}

/// The sign of a number, zero of zero.
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}
