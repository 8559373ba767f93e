//! The seam between physics and integration: a system whose field switches where a guard falls
//! through zero.

use crate::lane::{Lane, Series};

use super::{Contact, EventKind, Jet, Parameter, Resistance, State, StickSlip};

/// The most guards a system may have.
pub const MAX_GUARDS: usize = 4;

/// How many leading coefficients of each guard are known to vanish.
///
/// A guard that has just fired starts at zero; dividing out the known power of time leaves a
/// polynomial with the later roots only, and nothing needs to be offset.
pub type Zeros<L> = [L; MAX_GUARDS];

/// A system of ordinary differential equations with modes, guards and resets.
///
/// In each mode the field has a Taylor series of any order, and each guard is a series too, positive
/// while the mode lasts. The integrator knows a system only through this trait.
pub trait Switched<L: Lane> {
    /// What the field acts on.
    type State: Copy;
    /// Which field acts.
    type Mode: Copy + Default;
    /// The Taylor series of a step.
    type Jet: Default;

    /// How many guards there are, at most [`MAX_GUARDS`].
    const GUARDS: usize;

    /// The mode a motion starts in, with the state moved onto the surface that the mode lives on; a guard
    /// that is due at once is then obeyed without an event.
    fn start(&self, time: L, state: &mut Self::State) -> Self::Mode;

    /// Writes the series of the motion in `mode` from `state` at `time` into `jet`, all of it.
    fn expand(&self, mode: &Self::Mode, time: L, state: &Self::State, jet: &mut Self::Jet);

    /// The series whose decay sets the length of a step.
    ///
    /// They must contain every coordinate whose rate depends on the state in another way than by a constant
    /// factor; a coordinate that is the integral of one of them may be left out.
    fn pace<'a>(&self, jet: &'a Self::Jet) -> [&'a Series<L>; 2];

    /// The longest step within `length` that the series of `pace` describe to `tolerance`.
    ///
    /// A pace sees a term of the field by its coefficients. A term that is far below the rounding of the
    /// others where the step begins and grows to their size within the step (friction near rest, seen from
    /// far above the Stribeck velocity) has coefficients too small to be seen, however many are computed. A
    /// system with such a term bounds the step here, from the law of the term; any other returns `length`.
    /// The contract of systems checks both: the defect of the steps ([`Field`]) is of the order of the
    /// tolerance.
    fn step_bound(
        &self,
        mode: &Self::Mode,
        jet: &Self::Jet,
        length: L::Plain,
        tolerance: f64,
    ) -> L::Plain;

    /// Whether guard `which` can end `mode`.
    fn watched(&self, which: usize, mode: &Self::Mode) -> L::Mask;

    /// Writes guard `which` into `guard`: positive while `mode` lasts, ends it where it falls through zero.
    fn guard(&self, which: usize, mode: &Self::Mode, jet: &Self::Jet, guard: &mut Series<L>);

    /// The state `h` after the start of the step.
    fn at(&self, jet: &Self::Jet, h: L) -> Self::State;

    /// Obeys guard `which` where `due`: sets the next mode, moves the state onto the surface (or
    /// resets it), says which guards of the next mode start at zero, and returns the kind of event
    /// as a number, zero where none is due.
    fn switch(
        &self,
        which: usize,
        due: L::Mask,
        mode: &mut Self::Mode,
        state: &mut Self::State,
        zeros: &mut Zeros<L>,
        time: L,
    ) -> L;

    /// Where the state is not a finite number.
    fn lost(&self, state: &Self::State) -> L::Mask;
}

/// A switched system under a periodic drive, seen once a cycle at `D` coordinates of its section.
///
/// What the coordinates leave out, like the place of a capsule on even ground, does not act on them.
pub trait Stroboscopic<L: Lane, const D: usize>: Switched<L> {
    /// The point of the section that a state is at.
    fn point(state: &Self::State) -> [L; D];
    /// A state at this point.
    fn state(point: [L; D]) -> Self::State;
    /// What the coordinates are multiplied with to be compared.
    fn scales(&self) -> [f64; D];
}

/// A switched system whose equations can be evaluated at a point, so that its steps can be checked by them.
pub trait Field<const D: usize>: Switched<f64> {
    /// The series of the `D` coordinates during a step.
    fn coordinates<'a>(&self, jet: &'a Self::Jet) -> [&'a Series<f64>; D];

    /// The rates of the coordinates in `mode` at `time` since the start of the cycle [s].
    ///
    /// They are written as the equations are, with the elementary functions of a library: what the series
    /// and the functions of the lanes get wrong shows against them.
    fn rates(&self, mode: &Self::Mode, time: f64, coordinates: &[f64; D]) -> [f64; D];

    /// What the coordinates are multiplied with to be compared.
    fn weights(&self) -> [f64; D];

    /// The coordinate near whose turning points a term of the field may rise and vanish again within a step,
    /// if `mode` has such a term.
    fn layered<'a>(&self, _mode: &Self::Mode, _jet: &'a Self::Jet) -> Option<&'a Series<f64>> {
        None
    }
}

/// A switched system that is a capsule, so that speed and energies can be told from its motion.
///
/// The coordinates of its field are r, y1, x2 and y2.
pub trait Locomotion: Field<4, State = State<f64>> {
    /// The same capsule in numbers of another kind.
    type With<L: Lane<Mask = bool>>: Stroboscopic<L, 3, State = State<L>>;
    /// The capsule with these parameters under one law, whose drive starts at `phase` [rad].
    fn with<L: Lane<Mask = bool>>(
        of: impl Fn(Parameter) -> L,
        law: Resistance,
        phase: f64,
    ) -> Self::With<L>;
    /// The motion in the series of a step.
    fn motion<'a>(&self, jet: &'a Self::Jet) -> &'a Jet<f64>;
    /// The friction force on the capsule, opposing its motion while it slides and F at rest [N].
    fn friction(&self, mode: &Self::Mode, jet: &Self::Jet) -> Series<f64>;
    /// The rate of x2, which the equation as printed lets differ from y2 [m/s].
    fn slip_rate(&self, mode: &Self::Mode, jet: &Self::Jet) -> Series<f64>;
    /// Whether the mass touches the stop.
    fn contact(&self, mode: &Self::Mode) -> Contact;
    /// Whether and where the capsule slides.
    fn stick_slip(&self, mode: &Self::Mode) -> StickSlip;
    /// The kind of an event that `switch` reported; none for zero.
    fn event(&self, code: f64) -> Option<EventKind> {
        EventKind::from_code(code)
    }
}
