//! What the integrator knows of a system: a field that switches where a guard falls through zero, seen at a
//! section.

use std::fmt::Debug;

use crate::lane::{Lane, Mask, Series, series};

use super::pace::longest_step;

/// The most guards a system may have, the section of an autonomous one included.
pub const MAX_GUARDS: usize = 8;

/// For each guard, how many leading coefficients of its series are known to vanish where a mode begins.
///
/// `switch` is given zeros that hold 0 for every guard whose state is not known, and writes a number for
/// each guard that the event has placed on its own surface, as that guard reads *in the next mode*: 1 where
/// its value is zero and its rate is not (a mass that leaves a stop with a velocity), 2 where its rate
/// is zero too (a guard that is left from a state of rest), 3 where its second derivative is zero as well (a mass that is let go by
/// a stop whose force has fallen to zero). The engine divides the series by that power of
/// time, so that only later roots are looked for and nothing has to be offset by a tolerance. A zero that is
/// not told is found as an event again, at once or after a time of the order of rounding; a zero told of a
/// guard that does not vanish hides its next root. Values last until the next step of positive length.
pub type Zeros<L> = [L; MAX_GUARDS];

/// What happens where a mode ends, as an enum of the system's own.
pub trait Event: Copy + Ord + Debug + Send + Sync + 'static {
    /// Every event.
    const ALL: &'static [Self];

    /// The number of the event, not zero, which stands for none.
    fn number(self) -> u8;

    /// The number as a lane holds it.
    #[inline(always)]
    fn code<L: Lane>(self) -> L {
        L::splat(f64::from(self.number()))
    }

    /// The event with this number; none for zero.
    fn from_code(code: f64) -> Option<Self> {
        Self::ALL.iter().copied().find(|event| f64::from(event.number()) == code)
    }

    /// Whether it is what a grazing becomes where it goes deeper ([`Switched::touching`]).
    fn is_impact(self) -> bool {
        false
    }

    /// Whether it happens at a time of the drive, whatever the motion is: motions whose events differ in such alone have the same.
    fn is_timed(self) -> bool {
        false
    }
}

/// The events of a system that has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoEvent {}

impl Event for NoEvent {
    const ALL: &'static [Self] = &[];

    fn number(self) -> u8 {
        match self {}
    }
}

/// A system of ordinary differential equations with modes, guards and resets, in numbers of one kind.
///
/// In each mode the field has a Taylor series of any order, and each guard is a series too, positive
/// while the mode lasts. A system without guards leaves out what is said of them. The integrator knows a system only through this trait. Every method that is called
/// in a step must be `#[inline(always)]`, see [`crate::lane::Work`].
pub trait Switched<L: Lane> {
    /// What the field acts on.
    type State: Copy;
    /// Which field acts.
    type Mode: Copy + Default;
    /// The Taylor series of a step.
    type Jet: Default;
    /// What happens where a mode ends.
    type Event: Event;

    /// How many guards there are, at most [`MAX_GUARDS`], or one less where the system is autonomous.
    const GUARDS: usize;
    /// The most leading coefficients of a guard that [`Zeros`] may tell to vanish.
    const MOST_ZEROS: usize = 2;
    /// Whether the section is where [`Switched::section`] falls through zero, not once a drive cycle.
    const AUTONOMOUS: bool = false;

    /// The duration of a cycle: the period of the drive; of an autonomous system the longest time within
    /// which it must come back to its section [s].
    fn period(&self) -> L;

    /// The mode a motion starts in, by default the first of all, with the state moved onto the surface that the mode lives on; a guard
    /// that is due at once is then obeyed without an event.
    #[inline(always)]
    fn start(&self, _time: L, _state: &mut Self::State) -> Self::Mode {
        Self::Mode::default()
    }

    /// Begins the next cycle of the drive where `mask`: what a mode counts within a cycle, as the edges that have passed, starts again,
    /// and a coordinate that repeats comes back to the range in which it is told.
    #[inline(always)]
    fn begin_cycle(&self, _mask: L::Mask, _mode: &mut Self::Mode, _state: &mut Self::State) {}

    /// Writes the series of the motion in `mode` from `state` at `time` into `jet`, all of it.
    fn expand(&self, mode: &Self::Mode, time: L, state: &Self::State, jet: &mut Self::Jet);

    /// The series whose decay sets the length of a step, where [`Switched::longest_step`] is not the system's own.
    ///
    /// They must contain every coordinate whose rate depends on the state in another way than by a constant
    /// factor; a coordinate that is the integral of one of them may be left out.
    fn pace<'a>(&self, jet: &'a Self::Jet) -> [&'a Series<L>; 2];

    /// The longest step that the series describe to `tolerance`; unless a system has more of them, those of its pace.
    #[inline(always)]
    fn longest_step(&self, jet: &Self::Jet, tolerance: f64) -> L::Plain {
        let [first, second] = self.pace(jet);
        longest_step(first, tolerance).min(longest_step(second, tolerance))
    }

    /// The longest step within `length` that the series describe to `tolerance`.
    ///
    /// A pace sees a term of the field by its coefficients. A term that is far below the rounding of the
    /// others where the step begins and grows to their size within the step (friction near rest, seen from
    /// far above the Stribeck velocity) has coefficients too small to be seen, however many are computed. A
    /// system with such a term bounds the step here, from the law of the term; any other keeps `length`.
    /// The contract of systems checks both: the defect of the steps ([`Field`]) is of the order of the
    /// tolerance.
    #[inline(always)]
    fn step_bound(
        &self,
        _mode: &Self::Mode,
        _jet: &Self::Jet,
        length: L::Plain,
        _tolerance: f64,
    ) -> L::Plain {
        length
    }

    /// Whether guard `which` can end `mode`; every guard can where nothing else is said.
    #[inline(always)]
    fn watched(&self, _which: usize, _mode: &Self::Mode) -> L::Mask {
        L::Mask::splat(true)
    }

    /// Writes guard `which` into `guard`: positive while `mode` lasts, ends it where it falls through zero.
    ///
    /// A coefficient that is no finite number ends the case, with the reason `not finite`
    /// ([`Breakdown::NotFinite`](super::Breakdown::NotFinite)): where the guard falls is then unknown.
    #[inline(always)]
    fn guard(&self, _which: usize, _mode: &Self::Mode, _jet: &Self::Jet, _guard: &mut Series<L>) {}

    /// The same without derivatives, of numbers that have some; `room` may be written over.
    ///
    /// Where a guard falls is decided by its value alone. A system may write it in fewer operations than the guard with its
    /// derivatives takes, with the same bits.
    #[inline(always)]
    fn plain_guard(
        &self,
        which: usize,
        mode: &Self::Mode,
        jet: &Self::Jet,
        room: &mut Series<L>,
        guard: &mut Series<L::Plain>,
    ) {
        self.guard(which, mode, jet, room);
        *guard = series::plain(room);
    }

    /// The state `h` after the start of the step.
    fn at(&self, jet: &Self::Jet, h: L) -> Self::State;

    /// The same with the slopes of the series there.
    fn motion(&self, jet: &Self::Jet, h: L) -> (Self::State, Self::State);

    /// The state at the start of the step.
    #[inline(always)]
    fn beginning(&self, jet: &Self::Jet) -> Self::State {
        self.at(jet, L::splat(0.0))
    }

    /// The coordinate near whose turning points a term of the field may rise and vanish again within a step, and where
    /// `mode` has such a term; none where no mode has.
    #[inline(always)]
    fn layered<'a>(
        &self,
        _mode: &Self::Mode,
        _jet: &'a Self::Jet,
    ) -> Option<(&'a Series<L>, L::Mask)> {
        None
    }

    /// Obeys guard `which` where `due`: sets the next mode, moves the state onto the surface (or
    /// resets it), says which guards of the next mode start at zero, and returns the event
    /// as a number, zero where none is due.
    #[inline(always)]
    fn switch(
        &self,
        _which: usize,
        _due: L::Mask,
        _mode: &mut Self::Mode,
        _state: &mut Self::State,
        _zeros: &mut Zeros<L>,
        _time: L,
    ) -> L {
        L::splat(0.0)
    }

    /// Where the state is not a finite number.
    fn lost(&self, state: &Self::State) -> L::Mask;

    /// Where the motion leaves every bound, as where nothing holds a mean force; told of as
    /// [`Breakdown::RunsAway`](super::Breakdown::RunsAway).
    #[inline(always)]
    fn runs_away(&self, _state: &Self::State) -> L::Mask {
        L::Mask::splat(false)
    }

    /// Writes the function whose fall through zero is the section of an autonomous system; where an event takes it
    /// across zero, there is none.
    #[inline(always)]
    fn section(&self, _jet: &Self::Jet, _section: &mut Series<L>) {}

    /// The coordinate whose local extrema may graze a surface, and its values on the two surfaces, which may be one; none where
    /// nothing does.
    #[inline(always)]
    fn touching<'a>(&self, _jet: &'a Self::Jet) -> Option<(&'a Series<L>, [L; 2])> {
        None
    }
}

/// A switched system seen once a cycle at `D` coordinates of its section.
///
/// What the coordinates leave out, like the place of a capsule on even ground, does not act on them. Under a
/// periodic drive a cycle is one of the drive; an autonomous system has its section where a function of its
/// state falls through zero.
pub trait Stroboscopic<L: Lane, const D: usize>: Switched<L> {
    /// The point of the section that a state is at.
    fn point(state: &Self::State) -> [L; D];
    /// A state at this point.
    fn state(point: [L; D]) -> Self::State;
    /// A state at this point that agrees with another in what the coordinates leave out.
    fn moved_to(_from: Self::State, point: [L; D]) -> Self::State {
        Self::state(point)
    }
}

/// A switched system whose equations can be evaluated at a point, so that its steps can be checked by them.
pub trait Field: Switched<f64> {
    /// The coordinates of a state, in an order of its own.
    type Coordinates: AsRef<[f64]>;
    /// All coordinates of a state, or of its rates.
    fn coordinates(state: &Self::State) -> Self::Coordinates;

    /// The rates of the coordinates in `mode` at `time` since the start of the cycle [s].
    ///
    /// They are written as the equations are, with the elementary functions of a library: what the series
    /// and the functions of the lanes get wrong shows against them.
    fn rates(&self, mode: &Self::Mode, time: f64, state: &Self::State) -> Self::State;

    /// What the coordinates are multiplied with to be compared.
    fn weights(&self) -> Self::Coordinates;
}
