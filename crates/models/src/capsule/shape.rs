//! What the equations of a capsule are made of: its member of the family, apart from the values of its parameters.

use std::f64::consts::PI;

use capsulemap_engine::lane::Lane;

use super::parameter::Parameter;
use super::resistance::{Resistance, Switching};
use crate::description::Parameters;

/// What moves the mass, by the phase of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DriveKind {
    /// `p_d cos(phase)`.
    #[default]
    Harmonic,
    /// `p_0 + p_d` for a share `duty` of the period from phase 0 on, then `p_0 + p_low`.
    Square,
    /// The same with edges that last a share `rise` of the period.
    Trapezoid,
    /// `p_0 + p_d cos(phase) + p_2 cos(2 phase + phase_2)`.
    TwoHarmonics,
    /// In place of a force, the relative displacement `r = xi_1 cos(phase) + xi_2 cos(2 phase + phase_2)`.
    Prescribed,
    /// The relative displacement goes from `-stroke / 2` to `stroke / 2` at one velocity for a share `duty` of the period, and back at
    /// another.
    TwoPhase,
    /// The same with three relative accelerations in turn, each for its share of the period: up from relative rest, down, up to it.
    ThreePhase,
}

impl DriveKind {
    /// Every kind by its name in studies and files, in the order of declaration.
    pub const NAMES: [(&str, DriveKind); 7] = [
        ("harmonic", DriveKind::Harmonic),
        ("square", DriveKind::Square),
        ("trapezoid", DriveKind::Trapezoid),
        ("two-harmonics", DriveKind::TwoHarmonics),
        ("prescribed", DriveKind::Prescribed),
        ("two-phase", DriveKind::TwoPhase),
        ("three-phase", DriveKind::ThreePhase),
    ];

    /// Their names.
    pub const OPTIONS: [&'static str; 7] = [
        DriveKind::NAMES[0].0,
        DriveKind::NAMES[1].0,
        DriveKind::NAMES[2].0,
        DriveKind::NAMES[3].0,
        DriveKind::NAMES[4].0,
        DriveKind::NAMES[5].0,
        DriveKind::NAMES[6].0,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        DriveKind::NAMES[self as usize].0
    }

    /// At how many phases of a cycle the force has an edge.
    pub const fn edges(self) -> usize {
        match self {
            DriveKind::Harmonic | DriveKind::TwoHarmonics | DriveKind::Prescribed => 0,
            DriveKind::Square | DriveKind::TwoPhase => 2,
            DriveKind::ThreePhase => 3,
            DriveKind::Trapezoid => 4,
        }
    }

    /// Why a parameter has no effect beside it.
    fn no_effect(self, parameter: Parameter) -> Option<String> {
        let kinds: &[DriveKind] = match parameter {
            Parameter::Pd => &DriveKind::FORCES,
            Parameter::P0 => &DriveKind::FORCES[1..],
            Parameter::PLow => &[DriveKind::Square, DriveKind::Trapezoid],
            Parameter::Duty => &[DriveKind::Square, DriveKind::Trapezoid, DriveKind::TwoPhase],
            Parameter::Rise => &[DriveKind::Trapezoid],
            Parameter::P2 => &[DriveKind::TwoHarmonics],
            Parameter::Phase2 => &[DriveKind::TwoHarmonics, DriveKind::Prescribed],
            Parameter::Xi1 | Parameter::Xi2 => &[DriveKind::Prescribed],
            Parameter::Stroke => &[DriveKind::TwoPhase, DriveKind::ThreePhase],
            Parameter::Share1 | Parameter::Share2 => &[DriveKind::ThreePhase],
            Parameter::K1
            | Parameter::C
            | Parameter::K2
            | Parameter::Delta
            | Parameter::PreloadGap
            | Parameter::Restitution
            | Parameter::K3
            | Parameter::Delta3
            | Parameter::K2Damping
            | Parameter::K3Damping
            | Parameter::K1Cubic
            | Parameter::K2Cubic => {
                let why = "the motion of the mass relative to the capsule is given";
                return self.is_prescribed().then(|| why.to_owned());
            }
            _ => return None,
        };
        let names: Vec<String> = kinds.iter().map(|it| format!("`{}`", it.name())).collect();
        let all = match &names[..] {
            [one] => one.clone(),
            [first @ .., last] => format!("{} and {last}", first.join(", ")),
            [] => String::new(),
        };
        (!kinds.contains(&self)).then(|| format!("it belongs to {all}"))
    }

    /// The kinds that give a force.
    const FORCES: [DriveKind; 4] =
        [DriveKind::Harmonic, DriveKind::Square, DriveKind::Trapezoid, DriveKind::TwoHarmonics];

    /// Whether it gives the motion of the mass relative to the capsule, not a force.
    pub const fn is_prescribed(self) -> bool {
        matches!(self, DriveKind::Prescribed | DriveKind::TwoPhase | DriveKind::ThreePhase)
    }
}

/// What takes up the reaction of the force on the mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Reaction {
    /// An external field: the capsule does not feel the drive.
    #[default]
    None,
    /// The capsule, as the drive acts between it and the mass.
    Capsule,
}

impl Reaction {
    /// Every one by its name in studies and files, in the order of declaration.
    pub const NAMES: [(&str, Reaction); 2] =
        [("none", Reaction::None), ("capsule", Reaction::Capsule)];

    /// Their names.
    pub const OPTIONS: [&'static str; 2] = [Reaction::NAMES[0].0, Reaction::NAMES[1].0];

    /// Its name.
    pub fn name(self) -> &'static str {
        Reaction::NAMES[self as usize].0
    }
}

/// When the mass leaves a stop that damps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Release {
    /// Where it passes the place at which it met the stop, whose force may pull it before.
    #[default]
    Geometry,
    /// Where the force of the stop falls to zero.
    Force,
}

impl Release {
    /// Every one by its name in studies and files, in the order of declaration.
    pub const NAMES: [(&str, Release); 2] =
        [("geometry", Release::Geometry), ("force", Release::Force)];

    /// Their names.
    pub const OPTIONS: [&'static str; 2] = [Release::NAMES[0].0, Release::NAMES[1].0];
}

/// By which equations a capsule moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Those of the paper, friction set-valued at rest.
    Filippov,
    /// Eq. (1) of the paper to the letter.
    AsPrinted,
    /// Those of the family, friction set-valued at rest.
    General,
    /// The same over folds.
    OverFolds,
}

impl Form {
    /// Whether it is that of a member of the family, on any ground.
    pub fn is_of_family(self) -> bool {
        matches!(self, Form::General | Form::OverFolds)
    }
}

/// What of a capsule's equations is the same whatever the values of its parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// The law of resistance.
    pub law: Resistance,
    /// The drive.
    pub drive: DriveKind,
    /// What takes up its reaction.
    pub reaction: Reaction,
    /// When the mass leaves a stop that damps.
    pub release: Release,
    /// Whether there are folds across the way.
    pub over_folds: bool,
    /// The parameters that are given, of those that the equations have only then, as bits by their order.
    given: u64,
}

impl Shape {
    /// That of a capsule with these parameters.
    pub fn of(parameters: &Parameters) -> Shape {
        let [law, _, drive, reaction, release] =
            [0, 1, 2, 3, 4].map(|choice| parameters.chosen(choice));
        Shape {
            law: Resistance::NAMES[law].1,
            drive: DriveKind::NAMES[drive].1,
            reaction: Reaction::NAMES[reaction].1,
            release: Release::NAMES[release].1,
            over_folds: parameters.model().parameters.len() == Parameter::OVER_FOLDS.len(),
            given: parameters.given_places(),
        }
    }

    /// Whether the capsule takes up the reaction of what moves the mass, as it does of a prescribed relative motion.
    pub fn reacts(self) -> bool {
        self.reaction == Reaction::Capsule || self.drive.is_prescribed()
    }

    /// The frequency of the drive [rad/s].
    pub fn frequency<L: Lane>(self, of: impl Fn(Parameter) -> L) -> L {
        match self.has(Parameter::Period) {
            true => L::splat(2.0 * PI) / of(Parameter::Period),
            false => of(Parameter::Omega),
        }
    }

    /// Whether a parameter that the equations have only where it is given is.
    pub const fn has(self, parameter: Parameter) -> bool {
        self.given >> parameter as u64 & 1 != 0
    }

    /// Whether any of these is.
    pub fn has_any(self, parameters: &[Parameter]) -> bool {
        parameters.iter().any(|it| self.has(*it))
    }

    /// The parameter whose value counts for one: that of both directions for that of one which is not given.
    pub fn source(self, parameter: Parameter) -> Parameter {
        if self.has(parameter) { parameter } else { parameter.leader() }
    }

    /// Whether there may be a rear stop.
    pub fn has_rear_stop(self) -> bool {
        !self.drive.is_prescribed() && self.has_any(&[Parameter::K3, Parameter::K3Damping])
    }

    /// Whether a spring or a stop may have a cubic term.
    pub fn has_cubic_terms(self) -> bool {
        let of_stop = self.has(Parameter::K2Cubic) && !self.has(Parameter::Restitution);
        !self.drive.is_prescribed() && (self.has(Parameter::K1Cubic) || of_stop)
    }

    /// Whether the ground may resist by a drag.
    pub fn has_drag(self) -> bool {
        let own = [Parameter::C1, Parameter::C2];
        let of_sides = [
            Parameter::C1Forward,
            Parameter::C1Backward,
            Parameter::C2Forward,
            Parameter::C2Backward,
        ];
        self.law == Resistance::Medium || self.has_any(&own) || self.has_any(&of_sides)
    }

    /// Whether the resistance may differ by direction.
    pub fn has_friction_by_direction(self) -> bool {
        Parameter::ALL.iter().any(|it| it.leader() != *it && self.has(*it))
    }

    /// Whether a parameter is given for both directions, each by its own.
    fn has_both_directions(self, parameter: Parameter) -> bool {
        parameter.directions().all(|it| self.has(it))
    }

    /// Whether there is no dry friction.
    pub fn is_medium(self) -> bool {
        self.law == Resistance::Medium
    }

    /// Whether a stop may damp.
    pub fn has_damped_stops(self) -> bool {
        let of_front = self.has(Parameter::K2Damping) && !self.has(Parameter::Restitution);
        !self.drive.is_prescribed() && (self.has(Parameter::K3Damping) || of_front)
    }

    /// Whether the front stop is rigid.
    pub const fn is_rigid(self) -> bool {
        self.has(Parameter::Restitution) && !self.drive.is_prescribed()
    }

    /// Whether the mass leaves a stop where its force falls to zero, which without damping is where it met it.
    pub fn releases_by_force(self) -> bool {
        self.release == Release::Force && self.has_damped_stops()
    }

    /// Why a parameter has no effect, as what follows "has no effect"; none where it has one.
    pub fn no_effect(self, parameter: Parameter) -> Option<String> {
        let of_friction = |why: &str| Some(format!("under the law `{}`: {why}", self.law.name()));
        if let Some(why) = self.drive.no_effect(parameter) {
            return Some(format!("with the drive `{}`: {why}", self.drive.name()));
        }
        match (parameter, self.law, self.drive) {
            (
                Parameter::MuS
                | Parameter::MuD
                | Parameter::Vs
                | Parameter::MuSForward
                | Parameter::MuSBackward
                | Parameter::MuDForward
                | Parameter::MuDBackward
                | Parameter::Stribeck,
                Resistance::Medium,
                _,
            ) => of_friction("a medium has no dry friction"),
            (Parameter::Vs | Parameter::Stribeck, Resistance::Coulomb, _) => {
                of_friction("friction under this law does not depend on speed")
            }
            (Parameter::C1 | Parameter::C2, law, _)
                if law != Resistance::Medium && !self.has(parameter) =>
            {
                of_friction("it is not given, and there is no drag beside friction")
            }
            (Parameter::MuS | Parameter::MuD | Parameter::C1 | Parameter::C2, _, _)
                if self.has_both_directions(parameter) =>
            {
                let name = parameter.symbol();
                Some(format!("beside `{name}_forward` and `{name}_backward`"))
            }
            (Parameter::K2 | Parameter::K2Damping | Parameter::K2Cubic, _, _)
                if self.is_rigid() =>
            {
                Some("beside `restitution`, which makes the stop rigid".to_owned())
            }
            (Parameter::Delta3, _, _) if !self.has_rear_stop() => {
                Some("without `k3` or `k3_damping`: there is no rear stop".to_owned())
            }
            (Parameter::Omega, _, _) if self.has(Parameter::Period) => {
                Some("beside `drive_period`, which tells the frequency".to_owned())
            }
            _ => None,
        }
    }

    /// It without the keys that were there before the family.
    fn without_drag(self) -> Shape {
        let places = 1 << Parameter::C1 as u64 | 1 << Parameter::C2 as u64;
        Shape { given: self.given & !places, ..self }
    }

    /// Whether the equations have anything that the paper's have not, in any reading of its switching.
    pub fn is_member(self) -> bool {
        self.without_drag().form(Switching::Filippov) != Form::Filippov
    }

    /// By which equations the capsule moves, its friction read so.
    ///
    /// A member of the family is given by its drive, its reaction, or a parameter beside those of the paper that has an effect.
    pub fn form(self, switching: Switching) -> Form {
        let is_part = |it: &Parameter| {
            let in_paper =
                self.law == Resistance::Medium && matches!(it, Parameter::C1 | Parameter::C2);
            self.has(*it) && *it != Parameter::Period && !in_paper && self.no_effect(*it).is_none()
        };
        let is_general = self.drive != DriveKind::Harmonic
            || self.reaction != Reaction::None
            || Parameter::ALL.iter().any(is_part);
        match switching {
            _ if self.over_folds => Form::OverFolds,
            Switching::AsPrinted => Form::AsPrinted,
            Switching::Filippov if is_general => Form::General,
            Switching::Filippov => Form::Filippov,
        }
    }
}
