//! The equations of the family of capsules as they are written, one mode at a time.

use std::f64::consts::PI;

use capsulemap_models::capsule::{
    CapsuleParameters as _, DriveKind, Parameter, Parameters, Reaction, Resistance,
};

use super::Vector;

/// A capsule of the family, friction set-valued at rest, one mode at a time.
pub(super) struct Second<'a> {
    pub(super) p: &'a Parameters,
    pub(super) phase: f64,
    /// Whether the front stop and the rear stop are touched.
    pub(super) touched: [bool; 2],
    /// Direction of sliding, 0 at rest.
    pub(super) slip: f64,
    /// The force of the drive between two of its edges.
    pub(super) line: Line,
    /// Largest values met, by which accuracy is judged.
    pub(super) scale: Vector,
}

/// A force that is a straight line in time from when it begins.
#[derive(Clone, Copy, Default)]
pub(super) struct Line {
    begins: f64,
    from: f64,
    rate: f64,
}

impl Second<'_> {
    pub(super) fn of(&self, parameter: Parameter) -> f64 {
        self.p[parameter]
    }

    /// The value of a parameter that the equations have where it is given; zero elsewhere.
    pub(super) fn part(&self, parameter: Parameter) -> f64 {
        if self.p.is_given(parameter.into()) { self.p[parameter] } else { 0.0 }
    }

    /// The coefficient of forward or of backward sliding: its own, or that of both.
    pub(super) fn coefficient(&self, side: f64, [forward, backward, both]: [Parameter; 3]) -> f64 {
        let own = if side < 0.0 { backward } else { forward };
        if self.p.is_given(own.into()) { self.p[own] } else { self.p[both] }
    }

    pub(super) fn mu_s(&self, side: f64) -> f64 {
        let all = [Parameter::MuSForward, Parameter::MuSBackward, Parameter::MuS];
        self.coefficient(side, all)
    }

    pub(super) fn mu_d(&self, side: f64) -> f64 {
        let all = [Parameter::MuDForward, Parameter::MuDBackward, Parameter::MuD];
        self.coefficient(side, all)
    }

    /// The rise of friction towards rest.
    pub(super) fn stribeck(&self) -> f64 {
        if self.p.is_given(Parameter::Stribeck.into()) { self.p[Parameter::Stribeck] } else { 1.0 }
    }

    pub(super) fn load(&self) -> f64 {
        let slope = libm::cos(self.part(Parameter::Incline));
        (self.of(Parameter::M1) + self.of(Parameter::M2)) * self.of(Parameter::G) * slope
    }

    /// What gravity and load do to the capsule, and gravity to the mass.
    pub(super) fn along(&self) -> [f64; 2] {
        let sin = libm::sin(self.part(Parameter::Incline));
        let weights = [Parameter::M2, Parameter::M1].map(|it| self.of(it) * self.of(Parameter::G));
        [self.part(Parameter::Load) - weights[0] * sin, -weights[1] * sin]
    }

    pub(super) fn break_away(&self, side: f64) -> f64 {
        let (mu_s, mu_d) = (self.mu_s(side), self.mu_d(side));
        match self.p.resistance() {
            Resistance::CoulombStribeck => mu_s.max((1.0 + self.stribeck()) * mu_d) * self.load(),
            Resistance::Coulomb => mu_s.max(mu_d) * self.load(),
            Resistance::Medium => 0.0,
        }
    }

    pub(super) fn omega(&self) -> f64 {
        match self.p.is_given(Parameter::Period.into()) {
            true => 2.0 * PI / self.of(Parameter::Period),
            false => self.of(Parameter::Omega),
        }
    }

    /// The edges of the drive as shares of its period, and the line of the force after each by its value and its rate over a period.
    pub(super) fn edges(&self) -> Vec<(f64, [f64; 2])> {
        let high = self.of(Parameter::P0) + self.of(Parameter::Pd);
        let low = self.of(Parameter::P0) + self.of(Parameter::PLow);
        let (duty, rise) = (self.of(Parameter::Duty), self.of(Parameter::Rise));
        let steep = (high - low) / rise;
        match self.p.shape().drive {
            DriveKind::Harmonic | DriveKind::TwoHarmonics => Vec::new(),
            DriveKind::Square => vec![(0.0, [high, 0.0]), (duty, [low, 0.0])],
            DriveKind::Trapezoid => vec![
                (0.0, [low, steep]),
                (rise, [high, 0.0]),
                (duty, [high, -steep]),
                (duty + rise, [low, 0.0]),
            ],
        }
    }

    /// The times of the edges within a cycle, and its end.
    pub(super) fn cuts(&self) -> Vec<f64> {
        let (period, section) = (2.0 * PI / self.omega(), self.phase / (2.0 * PI));
        let mut cuts: Vec<f64> =
            self.edges().iter().map(|(at, _)| (at - section).rem_euclid(1.0) * period).collect();
        cuts.push(period);
        cuts.sort_by(f64::total_cmp);
        cuts
    }

    /// The line of the force between two times without an edge between them.
    pub(super) fn line_at(&self, from: f64, to: f64) -> Line {
        let (period, middle) = (2.0 * PI / self.omega(), 0.5 * (from + to));
        let turns = self.phase / (2.0 * PI) + middle / period;
        let within = turns - turns.floor();
        let edges = self.edges();
        let Some(&(at, [value, rate])) = edges.iter().rev().find(|(at, _)| *at <= within) else {
            return Line::default();
        };
        Line { begins: middle - (within - at) * period, from: value, rate: rate / period }
    }

    pub(super) fn drive(&self, t: f64) -> f64 {
        let angle = self.omega() * t + self.phase;
        let first = self.of(Parameter::Pd) * libm::cos(angle);
        match self.p.shape().drive {
            DriveKind::Harmonic => first,
            DriveKind::TwoHarmonics => {
                let second = libm::cos(2.0 * angle + self.of(Parameter::Phase2));
                self.of(Parameter::P0) + first + self.of(Parameter::P2) * second
            }
            DriveKind::Square | DriveKind::Trapezoid => {
                self.line.from + self.line.rate * (t - self.line.begins)
            }
        }
    }

    /// How deep the mass is in the front stop (0) or in the rear stop (1).
    pub(super) fn depth(&self, stop: usize, state: &Vector) -> f64 {
        let has_rear = [Parameter::K3, Parameter::K3Damping].map(|it| self.p.is_given(it.into()));
        match stop {
            0 => state[0] - self.of(Parameter::Delta),
            _ if has_rear.contains(&true) => -state[0] - self.part(Parameter::Delta3),
            _ => -1.0,
        }
    }

    pub(super) fn force(&self, state: &Vector) -> f64 {
        let [r, y1, _, y2] = *state;
        let relative = y1 - y2;
        let mut force = self.of(Parameter::K1) * (r + self.part(Parameter::PreloadGap))
            + self.part(Parameter::K1Cubic) * r * r * r
            + self.of(Parameter::C) * relative;
        if self.touched[0] {
            let depth = self.depth(0, state);
            force += self.of(Parameter::K2) * depth
                + self.part(Parameter::K2Cubic) * depth * depth * depth
                + self.part(Parameter::K2Damping) * relative;
        }
        if self.touched[1] {
            force += -self.part(Parameter::K3) * self.depth(1, state)
                + self.part(Parameter::K3Damping) * relative;
        }
        force
    }

    /// What moves the capsule but for the friction.
    pub(super) fn push(&self, t: f64, state: &Vector) -> f64 {
        let reacts = self.p.shape().reaction == Reaction::Capsule;
        let reaction = if reacts { self.drive(t) } else { 0.0 };
        self.force(state) - reaction + self.along()[0]
    }

    /// The direction in which a capsule at rest starts to slide, 0 where it rests on.
    pub(super) fn start_of_sliding(&self, t: f64, state: &Vector) -> f64 {
        let push = self.push(t, state);
        let holds = -self.break_away(-1.0) <= push && push <= self.break_away(1.0);
        if holds { 0.0 } else { push.signum() }
    }

    pub(super) fn resistance(&self, y2: f64) -> f64 {
        let side = self.slip;
        let c1 =
            self.coefficient(side, [Parameter::C1Forward, Parameter::C1Backward, Parameter::C1]);
        let c2 =
            self.coefficient(side, [Parameter::C2Forward, Parameter::C2Backward, Parameter::C2]);
        let dry = side * self.mu_d(side) * self.load();
        // Written for the direction of the mode, so that it is smooth where y2 passes zero within a step.
        let drag = c1 * y2 + c2 * side * y2 * y2;
        match self.p.resistance() {
            Resistance::CoulombStribeck => {
                let rise = libm::exp(-(side * y2) / self.of(Parameter::Vs));
                dry * (1.0 + self.stribeck() * rise) + drag
            }
            Resistance::Coulomb => dry + drag,
            Resistance::Medium => drag,
        }
    }

    pub(super) fn rates(&self, t: f64, state: &Vector) -> Vector {
        let [_, y1, _, y2] = *state;
        let on_mass = self.drive(t) - self.force(state) + self.along()[1];
        let acceleration = on_mass / self.of(Parameter::M1);
        if self.slip == 0.0 {
            return [y1, acceleration, 0.0, 0.0];
        }
        let moves = self.push(t, state) - self.resistance(y2);
        [y1 - y2, acceleration, y2, moves / self.of(Parameter::M2)]
    }
}
