//! The capsule as a system for the engine: its parameters, under either reading of the switching.

use std::fmt::Debug;
use std::marker::PhantomData;

use capsulemap_engine::flow::{Field, Metric, Stroboscopic, Switched, System};
use capsulemap_engine::lane::{Lane, SideBySide};

use super::account::Account;
use super::description::CAPSULE;
use super::description::CAPSULE_OVER_FOLDS;
use super::filippov::{self, Capsule};
use super::general::{GeneralCapsule, GeneralMode};
use super::locomotion::Locomotion;
use super::output::Outputs;
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::printed::PrintedCapsule;
use super::regime::PrintedMode;
use super::shape::{DriveKind, Shape};
use super::state::{EventKind, State};
use crate::description::{self, Description, Parameters, Presence};

/// A form of the equations, with a reading of the switching between stick and slip, seen at `D` coordinates of its section.
pub trait Reading<const D: usize = 3>: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// Which field acts.
    type Mode<L: Lane>: Copy + Default + Send + SideBySide<One = Self::Mode<f64>>;
    /// The capsule in `f64`.
    type Single: Locomotion<f64, Mode = Self::Mode<f64>> + Field + Stroboscopic<f64, D> + Send;
    /// The capsule in numbers of any kind.
    type In<L: Lane>: Stroboscopic<
            L,
            D,
            State = State<L>,
            Mode = Self::Mode<L>,
            Jet: SideBySide<One = <Self::Single as Switched<f64>>::Jet>,
            Event = EventKind,
        > + Locomotion<L>
        + SideBySide<One = Self::Single>;

    /// What such a capsule says of itself; the usual one but for other ground.
    fn description() -> &'static Description {
        &CAPSULE
    }
    /// Outputs as it tells of them.
    fn told(outputs: &Outputs) -> description::Outputs {
        let model = Self::description();
        description::Outputs::new(model, &outputs.values()[..model.outputs.len()])
    }
    /// How far two section points are apart.
    fn metric(parameters: &Parameters) -> Metric<D>;
    /// Whether capsules of these shapes may be followed side by side; those of the paper where they have one law of resistance, and
    /// their frequency told in one way.
    fn are_alike(one: Shape, other: Shape) -> bool {
        let period = Parameter::Period;
        one.law == other.law && one.has(period) == other.has(period)
    }
    /// The capsule with these parameters, whose drive is at `phase` at the section [rad].
    fn single(parameters: &Parameters, phase: f64) -> Self::Single;
    /// The capsule with these parameters and of this shape, whose drive is at `phase` at the section [rad].
    fn capsule<L: Lane>(of: impl Fn(Parameter) -> L, shape: Shape, phase: f64) -> Self::In<L>;
}

/// Friction is set-valued at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Filippov;

/// The family of capsules; friction is set-valued at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct General;

/// The same over folds, whose place between two folds is a coordinate of its section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OverFolds;

/// Eq. (1) of the paper to the letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AsPrinted;

impl Reading for Filippov {
    type Mode<L: Lane> = filippov::Mode<L>;
    type Single = Capsule<f64>;
    type In<L: Lane> = Capsule<L>;

    fn metric(parameters: &Parameters) -> Metric<3> {
        parameters.metric()
    }

    fn single(parameters: &Parameters, phase: f64) -> Capsule<f64> {
        Capsule::single(parameters, phase)
    }

    fn capsule<L: Lane>(of: impl Fn(Parameter) -> L, shape: Shape, phase: f64) -> Capsule<L> {
        Capsule::new(of, shape, phase)
    }
}

impl Reading for General {
    type Mode<L: Lane> = GeneralMode<L>;
    type Single = GeneralCapsule<f64, false>;
    type In<L: Lane> = GeneralCapsule<L, false>;

    fn are_alike(one: Shape, other: Shape) -> bool {
        one == other
    }

    fn metric(parameters: &Parameters) -> Metric<3> {
        parameters.metric()
    }

    fn single(parameters: &Parameters, phase: f64) -> GeneralCapsule<f64, false> {
        GeneralCapsule::new(|parameter| parameters[parameter], parameters.shape(), phase)
    }

    fn capsule<L: Lane>(
        of: impl Fn(Parameter) -> L,
        shape: Shape,
        phase: f64,
    ) -> GeneralCapsule<L, false> {
        GeneralCapsule::new(of, shape, phase)
    }
}

impl Reading<4> for OverFolds {
    type Mode<L: Lane> = GeneralMode<L>;
    type Single = GeneralCapsule<f64, true>;
    type In<L: Lane> = GeneralCapsule<L, true>;

    fn description() -> &'static Description {
        &CAPSULE_OVER_FOLDS
    }

    /// The place between two folds counts as the displacement from one fold to the next.
    fn metric(parameters: &Parameters) -> Metric<4> {
        let omega = parameters.frequency();
        let of_place = omega * parameters[Parameter::FoldSpacing];
        Metric { scales: [omega, 1.0, 1.0, of_place], repeats: [false, false, false, true] }
    }

    fn are_alike(one: Shape, other: Shape) -> bool {
        one == other
    }

    fn single(parameters: &Parameters, phase: f64) -> GeneralCapsule<f64, true> {
        GeneralCapsule::new(|parameter| parameters[parameter], parameters.shape(), phase)
    }

    fn capsule<L: Lane>(
        of: impl Fn(Parameter) -> L,
        shape: Shape,
        phase: f64,
    ) -> GeneralCapsule<L, true> {
        GeneralCapsule::new(of, shape, phase)
    }
}

impl Reading for AsPrinted {
    type Mode<L: Lane> = PrintedMode<L>;
    type Single = PrintedCapsule<f64>;
    type In<L: Lane> = PrintedCapsule<L>;

    fn metric(parameters: &Parameters) -> Metric<3> {
        parameters.metric()
    }

    fn single(parameters: &Parameters, phase: f64) -> PrintedCapsule<f64> {
        PrintedCapsule::single(parameters, phase)
    }

    fn capsule<L: Lane>(
        of: impl Fn(Parameter) -> L,
        shape: Shape,
        phase: f64,
    ) -> PrintedCapsule<L> {
        PrintedCapsule::new(of, shape, phase)
    }
}

/// A capsule by its parameters, its friction read as `R` says; the reading that they name does not matter.
#[derive(Debug, Clone, PartialEq)]
pub struct CapsuleSystem<R> {
    /// Its parameters and the law of resistance.
    pub parameters: Parameters,
    /// Phase of the drive at the section [rad].
    pub phase: f64,
    reading: PhantomData<R>,
}

impl<R> CapsuleSystem<R> {
    /// The capsule with these parameters, whose drive is at `phase` at the section [rad].
    pub fn new(parameters: Parameters, phase: f64) -> Self {
        CapsuleSystem { parameters, phase, reading: PhantomData }
    }
}

impl<R: Reading<D>, const D: usize> System<D> for CapsuleSystem<R> {
    type Parameter = Parameter;
    type Event = EventKind;
    type State<L: Lane> = State<L>;
    type Mode<L: Lane> = R::Mode<L>;
    type Single = R::Single;
    type In<L: Lane> = R::In<L>;
    type Observer = Account<f64>;
    type Observers<L: Lane> = Account<L>;

    fn single(&self) -> R::Single {
        R::single(&self.parameters, self.phase)
    }

    fn system<L: Lane>(&self, of: impl Fn(Parameter) -> L) -> R::In<L> {
        R::capsule(of, self.parameters.shape(), self.phase)
    }

    /// Those of the paper, and those of the family that are given.
    fn has(&self, parameter: Parameter) -> bool {
        let shape = self.parameters.shape();
        parameter.presence() == Presence::Always
            || shape.has(parameter)
            || (shape.is_medium() && parameter.presence() == Presence::Told)
    }

    fn value(&self, parameter: Parameter) -> f64 {
        self.parameters[parameter]
    }

    fn with(&self, parameter: Parameter, value: f64) -> Self {
        let mut other = self.clone();
        other.parameters[parameter] = value;
        other
    }

    fn metric(&self) -> Metric<D> {
        R::metric(&self.parameters)
    }

    fn gained(observed: &Account<f64>) -> Option<f64> {
        Some(observed.advance)
    }

    fn observer(&self, points: usize) -> Account<f64> {
        Account::single(&self.parameters, points)
    }

    fn admits(&self, parameter: Parameter, value: f64) -> bool {
        parameter.allowed().admits(value)
    }

    /// Lanes share one shape, as far as their equations know of it.
    fn is_alike(&self, other: &Self) -> bool {
        R::are_alike(self.parameters.shape(), other.parameters.shape())
    }

    fn shares_all_but_parameters(&self, other: &Self) -> bool {
        self.is_alike(other) && self.phase.to_bits() == other.phase.to_bits()
    }

    /// Amplitude of the velocity of the mass while nothing slips or touches [m/s].
    fn expected_size(&self) -> f64 {
        let (p_d, omega) = (self.parameters[Parameter::Pd], self.parameters.frequency());
        let [stroke, first, second] =
            [Parameter::Stroke, Parameter::Xi1, Parameter::Xi2].map(|it| self.parameters[it].abs());
        match self.parameters.shape().drive {
            DriveKind::Prescribed => return omega * (first + second),
            DriveKind::TwoPhase | DriveKind::ThreePhase => return omega * stroke,
            _ => {}
        }
        let [k1, m1, c] =
            [Parameter::K1, Parameter::M1, Parameter::C].map(|it| self.parameters[it]);
        let spring = k1 - m1 * omega * omega;
        p_d * omega / libm::hypot(spring, c * omega)
    }
}
