//! A part of a step that is compiled as a function of its own.

/// A part of a step that is compiled as a function of its own, with the instructions of its lanes (`Lane::apart`).
///
/// What a step inlines is one function, and the time that compilers take grows with the square of its size: with a few parts apart
/// the models build in a quarter of the time. `run` and everything that it calls on lanes must be `#[inline(always)]`, as for
/// [`Work`](crate::lane::Work).
pub trait Part {
    /// What it yields.
    type Output;
    /// Does it.
    fn run(self) -> Self::Output;
}
