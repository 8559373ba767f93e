//! What is integrated or counted along a motion.

use crate::lane::Lane;

use super::step::Step;
use super::switched::Switched;

/// What is integrated or counted along a motion, step by step.
pub trait Observer<L: Lane, S: Switched<L>> {
    /// Takes note of a step.
    fn see(&mut self, system: &S, step: &Step<L, S>);

    /// The least distance that a local extremum has had from a surface that it would graze, in each lane, in
    /// the unit of the first coordinate of the section; infinite where there was none.
    fn touching_margin(&self) -> L {
        L::splat(f64::INFINITY)
    }
}

impl<L: Lane, S: Switched<L>> Observer<L, S> for () {
    #[inline(always)]
    fn see(&mut self, _system: &S, _step: &Step<L, S>) {}
}
