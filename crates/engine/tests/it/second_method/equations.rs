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
    /// Where the capsule is between two folds while x2 is zero, in spacings.
    pub(super) begins: f64,
    /// Whether the front stop and the rear stop are touched.
    pub(super) touched: [bool; 2],
    /// Whether the mass is beyond the place of a stop that has let go of it.
    pub(super) let_go: [bool; 2],
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

    pub(super) fn break_away(&self, side: f64, state: &Vector) -> f64 {
        let (mu_s, mu_d) = (self.mu_s(side), self.mu_d(side));
        let load = self.raise(state) * self.load();
        match self.p.resistance() {
            Resistance::CoulombStribeck => mu_s.max((1.0 + self.stribeck()) * mu_d) * load,
            Resistance::Coulomb => mu_s.max(mu_d) * load,
            Resistance::Medium => 0.0,
        }
    }

    /// Where the capsule is on a fold, as an angle, and how high that is; none on even ground.
    fn on_fold(&self, state: &Vector) -> Option<(f64, f64)> {
        if !self.p.shape().over_folds {
            return None;
        }
        let angle = 2.0 * PI * (self.begins + state[2] / self.of(Parameter::FoldSpacing));
        let fall = libm::cos(angle) - 1.0;
        Some((angle, libm::exp(self.of(Parameter::FoldSharpness) * fall)))
    }

    /// What folds multiply the resistance of even ground with.
    fn raise(&self, state: &Vector) -> f64 {
        self.on_fold(state)
            .map_or(1.0, |(_, height)| 1.0 + self.of(Parameter::FoldFriction) * height)
    }

    /// The force of the folds, forward positive; its largest value is sought where its slope is zero, by bisection.
    fn fold_force(&self, state: &Vector) -> f64 {
        let Some((angle, height)) = self.on_fold(state) else { return 0.0 };
        let sharpness = self.of(Parameter::FoldSharpness);
        let (mut low, mut high) = (0.0, 0.5 * PI);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let rises = libm::cos(middle) > sharpness * libm::sin(middle).powi(2);
            (low, high) = if rises { (middle, high) } else { (low, middle) };
        }
        let largest = libm::sin(low) * libm::exp(sharpness * (libm::cos(low) - 1.0));
        self.of(Parameter::FoldForce) * libm::sin(angle) * height / largest
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
            DriveKind::Harmonic | DriveKind::TwoHarmonics | DriveKind::Prescribed => Vec::new(),
            DriveKind::TwoPhase => {
                let stroke = self.of(Parameter::Stroke);
                vec![(0.0, [stroke / duty, 0.0]), (duty, [-stroke / (1.0 - duty), 0.0])]
            }
            DriveKind::ThreePhase => self.three_phases(),
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
            _ => unreachable!("the drive gives no force"),
        }
    }

    /// Whether the motion of the mass relative to the capsule is prescribed.
    pub(super) fn is_prescribed(&self) -> bool {
        self.p.shape().drive.is_prescribed()
    }

    /// The velocity of a prescribed motion and its rate; in phases, those of the line.
    pub(super) fn prescribed(&self, t: f64) -> [f64; 2] {
        let period = 2.0 * PI / self.omega();
        if self.p.shape().drive != DriveKind::Prescribed {
            let speed = self.line.from + self.line.rate * (t - self.line.begins);
            return [speed / period, self.line.rate / period];
        }
        let (omega, angle) = (self.omega(), self.omega() * t + self.phase);
        let second = 2.0 * angle + self.of(Parameter::Phase2);
        let [xi_1, xi_2] = [Parameter::Xi1, Parameter::Xi2].map(|it| self.of(it));
        [
            -omega * (xi_1 * libm::sin(angle) + 2.0 * xi_2 * libm::sin(second)),
            -omega * omega * (xi_1 * libm::cos(angle) + 4.0 * xi_2 * libm::cos(second)),
        ]
    }

    /// Three phases over a turn: accelerations w_i over shares s_i about the times m_i with sum w_i s_i = sum w_i s_i m_i = 0 are in the
    /// ratios of (m_3 - m_2)/s_1, (m_1 - m_3)/s_2 and (m_2 - m_1)/s_3, and their size is that of the stroke.
    fn three_phases(&self) -> Vec<(f64, [f64; 2])> {
        let (first, second) = (self.of(Parameter::Share1), self.of(Parameter::Share2));
        let third = 1.0 - first - second;
        let middles = [0.5 * first, first + 0.5 * second, 1.0 - 0.5 * third];
        let up = (middles[2] - middles[1]) / first;
        let down = (middles[0] - middles[2]) / second;
        let end = (middles[1] - middles[0]) / third;
        let speed = up * first;
        let stroke = 0.5 * up * first * first - 0.5 * speed * speed / down;
        let size = self.of(Parameter::Stroke) / stroke;
        vec![
            (0.0, [0.0, size * up]),
            (first, [size * speed, size * down]),
            (first + second, [-size * end * third, size * end]),
        ]
    }

    /// How deep the mass is in the front stop (0) or in the rear stop (1).
    pub(super) fn depth(&self, stop: usize, state: &Vector) -> f64 {
        let has_rear = [Parameter::K3, Parameter::K3Damping].map(|it| self.p.is_given(it.into()));
        match stop {
            _ if self.is_prescribed() => -1.0,
            0 => state[0] - self.of(Parameter::Delta),
            _ if has_rear.contains(&true) => -state[0] - self.part(Parameter::Delta3),
            _ => -1.0,
        }
    }

    pub(super) fn force(&self, state: &Vector) -> f64 {
        if self.is_prescribed() {
            return 0.0;
        }
        let [r, y1, _, y2] = *state;
        let relative = y1 - y2;
        let mut force = self.of(Parameter::K1) * (r + self.part(Parameter::PreloadGap))
            + self.part(Parameter::K1Cubic) * r * r * r
            + self.of(Parameter::C) * relative;
        if self.touched[0] && !self.is_rigid() {
            force += self.pressing(0, state);
        }
        if self.touched[1] {
            force -= self.pressing(1, state);
        }
        force
    }

    /// How hard a stop that is touched pushes the mass away; a damped one may pull.
    pub(super) fn pressing(&self, stop: usize, state: &Vector) -> f64 {
        let depth = self.depth(stop, state);
        let deeper = state[1] - state[3];
        match stop {
            0 => {
                self.of(Parameter::K2) * depth
                    + self.part(Parameter::K2Cubic) * depth * depth * depth
                    + self.part(Parameter::K2Damping) * deeper
            }
            _ => self.part(Parameter::K3) * depth - self.part(Parameter::K3Damping) * deeper,
        }
    }

    /// Whether the front stop is rigid.
    pub(super) fn is_rigid(&self) -> bool {
        self.p.shape().is_rigid()
    }

    /// Whether the mass stays at the rigid stop.
    pub(super) fn is_at_stop(&self) -> bool {
        self.is_rigid() && self.touched[0]
    }

    /// Whether stops are left where their force falls to zero.
    pub(super) fn releases_by_force(&self) -> bool {
        self.p.shape().releases_by_force()
    }

    /// What moves mass and capsule together but for the friction.
    fn common(&self, t: f64, state: &Vector) -> f64 {
        let reacts = self.p.shape().reaction == Reaction::Capsule;
        let drive = if reacts { 0.0 } else { self.drive(t) };
        drive + self.along().iter().sum::<f64>() + self.fold_force(state)
    }

    /// The force of a rigid stop on a mass that stays at it, against the mass.
    pub(super) fn bearing(&self, t: f64, state: &Vector) -> f64 {
        let acceleration = self.rates(t, state)[3];
        let on_mass = self.drive(t) - self.force(state) + self.along()[1];
        on_mass - self.of(Parameter::M1) * acceleration
    }

    /// What moves the capsule but for the friction.
    pub(super) fn push(&self, t: f64, state: &Vector) -> f64 {
        if self.is_prescribed() {
            let [_, acceleration] = self.prescribed(t);
            let along = self.along().iter().sum::<f64>() + self.fold_force(state);
            return along - self.of(Parameter::M1) * acceleration;
        }
        if self.is_at_stop() {
            return self.common(t, state);
        }
        let reacts = self.p.shape().reaction == Reaction::Capsule;
        let reaction = if reacts { self.drive(t) } else { 0.0 };
        self.force(state) - reaction + self.along()[0] + self.fold_force(state)
    }

    /// The direction in which a capsule at rest starts to slide, 0 where it rests on.
    pub(super) fn start_of_sliding(&self, t: f64, state: &Vector) -> f64 {
        let push = self.push(t, state);
        let holds = -self.break_away(-1.0, state) <= push && push <= self.break_away(1.0, state);
        if holds { 0.0 } else { push.signum() }
    }

    pub(super) fn resistance(&self, state: &Vector) -> f64 {
        let (side, y2) = (self.slip, state[3]);
        let c1 =
            self.coefficient(side, [Parameter::C1Forward, Parameter::C1Backward, Parameter::C1]);
        let c2 =
            self.coefficient(side, [Parameter::C2Forward, Parameter::C2Backward, Parameter::C2]);
        let dry = side * self.mu_d(side) * self.load();
        // Written for the direction of the mode, so that it is smooth where y2 passes zero within a step.
        let drag = c1 * y2 + c2 * side * y2 * y2;
        let on_even_ground = match self.p.resistance() {
            Resistance::CoulombStribeck => {
                let rise = libm::exp(-(side * y2) / self.of(Parameter::Vs));
                dry * (1.0 + self.stribeck() * rise) + drag
            }
            Resistance::Coulomb => dry + drag,
            Resistance::Medium => drag,
        };
        self.raise(state) * on_even_ground
    }

    pub(super) fn rates(&self, t: f64, state: &Vector) -> Vector {
        let [_, y1, _, y2] = *state;
        if self.is_prescribed() {
            let [speed, acceleration] = self.prescribed(t);
            let moves = self.push(t, state) - self.resistance(state);
            let total = self.of(Parameter::M1) + self.of(Parameter::M2);
            let own = if self.slip == 0.0 { 0.0 } else { moves / total };
            return [speed, own + acceleration, if self.slip == 0.0 { 0.0 } else { y2 }, own];
        }
        let on_mass = self.drive(t) - self.force(state) + self.along()[1];
        let acceleration = on_mass / self.of(Parameter::M1);
        if self.slip == 0.0 && self.is_at_stop() {
            return [0.0; 4];
        }
        if self.slip == 0.0 {
            return [y1, acceleration, 0.0, 0.0];
        }
        let moves = self.push(t, state) - self.resistance(state);
        if self.is_at_stop() {
            let acceleration = moves / (self.of(Parameter::M1) + self.of(Parameter::M2));
            return [0.0, acceleration, y2, acceleration];
        }
        [y1 - y2, acceleration, y2, moves / self.of(Parameter::M2)]
    }
}
