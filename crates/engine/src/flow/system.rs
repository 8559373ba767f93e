//! A system by its parameters, from which the engine makes it in numbers of any kind.

use std::fmt::Debug;

use crate::lane::{Lane, SideBySide};

use super::metric::Metric;
use super::observer::Observer;
use super::switched::{Event, Field, Stroboscopic, Switched};

/// A system by its parameters: what one case of a study is about, apart from where it starts.
///
/// The engine makes of it the system in numbers of any kind: one `f64`, several cases side by side, or numbers
/// with derivatives along the section point and along parameters.
pub trait System<const D: usize>: Clone + PartialEq + Debug + Send + Sync + 'static {
    /// Whether its expansion is interpreted, so that cases are followed by more vectors side by side.
    const IS_INTERPRETED: bool = false;

    /// Names a parameter.
    type Parameter: Copy + PartialEq + Debug + Send + Sync;
    /// What happens where a mode ends.
    type Event: Event;
    /// What the field acts on.
    type State<L: Lane>: Copy + Send + Sync + SideBySide<One = Self::State<f64>>;
    /// Which field acts.
    type Mode<L: Lane>: Copy + Default + Send + SideBySide<One = Self::Mode<f64>>;
    /// The system in `f64`: the same type as `In<f64>`.
    type Single: Field<State = Self::State<f64>, Mode = Self::Mode<f64>, Event = Self::Event>
        + Stroboscopic<f64, D>
        + Send;
    /// The system in numbers of any kind.
    type In<L: Lane>: Stroboscopic<
            L,
            D,
            State = Self::State<L>,
            Mode = Self::Mode<L>,
            Jet: SideBySide<One = <Self::Single as Switched<f64>>::Jet>,
            Event = Self::Event,
        > + SideBySide<One = Self::Single>;
    /// What is integrated or counted along its motion: the same type as `Observers<f64>`.
    type Observer: Observer<f64, Self::Single> + Clone + Send + Sync;
    /// The same along motions side by side.
    type Observers<L: Lane>: Observer<L, Self::In<L>> + SideBySide<One = Self::Observer>;

    /// The system with its own parameters.
    fn single(&self) -> Self::Single;
    /// The system with the value of each parameter as `of` gives it.
    fn system<L: Lane>(&self, of: impl Fn(Self::Parameter) -> L) -> Self::In<L>;
    /// Whether it has a parameter of this name; each is had where names are an enum.
    fn has(&self, _parameter: Self::Parameter) -> bool {
        true
    }
    /// The value of a parameter.
    fn value(&self, parameter: Self::Parameter) -> f64;
    /// The same with another value of a parameter.
    fn with(&self, parameter: Self::Parameter, value: f64) -> Self;
    /// How far two points of its section are apart.
    fn metric(&self) -> Metric<D>;
    /// An observer that has seen nothing, and keeps up to so many points of whatever it notes.
    fn observer(&self, points: usize) -> Self::Observer;

    /// What a motion has gained so far, a sum whose mean tells how long a motion is measured that does not repeat
    /// (`Protocol::mean_error`); none of systems that gain nothing.
    fn gained(_observed: &Self::Observer) -> Option<f64> {
        None
    }

    /// Whether a parameter may have this value.
    fn admits(&self, _parameter: Self::Parameter, value: f64) -> bool {
        value.is_finite()
    }
    /// Whether it may be followed side by side with another.
    fn is_alike(&self, _other: &Self) -> bool {
        true
    }
    /// Whether it differs from another in the values of its parameters alone, so that [`System::system`] of one with
    /// the values of the other is the other.
    fn shares_all_but_parameters(&self, other: &Self) -> bool {
        self == other
    }
    /// The size of the motion to be expected, in the units of the metric; zero where it is not known.
    fn expected_size(&self) -> f64 {
        0.0
    }
    /// The system with its own parameters, as constants in numbers of one kind.
    fn constant<L: Lane>(&self) -> Self::In<L> {
        self.system(|parameter| L::splat(self.value(parameter)))
    }
}
