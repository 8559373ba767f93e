//! What keeps an orbit from being better.

use crate::orbit::matrix::Complex;

/// A multiplier this near to where an orbit ceases to be stable says why a family ends.
const CRITICAL: f64 = 1e-3;

/// What keeps an orbit from being better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// Nothing: it is stationary.
    Interior,
    /// The lower or the upper bound of a free parameter, by its place.
    Bound(usize, Side),
    /// The limit of an output, by its place among those of the family.
    Limit(usize),
    /// A multiplier of one: beyond it there is no such orbit.
    Fold,
    /// A multiplier of minus one: beyond it the orbit is not stable.
    PeriodDoubling,
    /// A pair of complex multipliers on the unit circle.
    NeimarkSacker,
    /// An extremum touches the surface of an impact: beyond it the outputs change otherwise.
    Grazing,
    /// The sequence of events changes in another way: beyond it the outputs change otherwise.
    EventSequence,
    /// Nothing that is known: steps or rounding ended the search before the slope was small enough.
    Steps,
}

/// A side of a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Its lower end.
    Lower,
    /// Its upper end.
    Upper,
}

impl Hold {
    /// Why a family ends beside an orbit with these multipliers.
    pub fn edge(multipliers: &[Complex]) -> Hold {
        let critical = multipliers.iter().find(|it| it.abs() > 1.0 - CRITICAL);
        match critical {
            Some(it) if it.im != 0.0 => Hold::NeimarkSacker,
            Some(it) if it.re > 0.0 => Hold::Fold,
            Some(_) => Hold::PeriodDoubling,
            None => Hold::Steps,
        }
    }
}
