//! The tolerances of all judgements, from that of a step and from rounding, each with its reason.

/// A residual this small, relative to the motion, cannot be told from rounding.
pub const ROUNDING: f64 = 1e-14;

/// The longest correction by Newton's method, relative to the motion: what is farther away is another orbit.
pub const NEARBY: f64 = 1e-3;

/// How much farther an orbit may be than a residual and multipliers say, as they do not tell how oblique
/// the directions are that the multipliers belong to.
pub const OBLIQUE: f64 = 100.0;

/// A multiplier this near to one may be one: neither the rounding of a long period nor the time that a motion
/// is followed for could tell.
pub const ONE: f64 = 1e-7;

/// An extremum this near to a surface, relative to the motion, is taken for one that touches it.
pub const GRAZES: f64 = 1e-9;

/// An autonomous motion that gets no farther than this within a cycle, relative to its size, is at an
/// equilibrium as far as derivatives of its section can tell.
pub const STANDS_STILL: f64 = 1e-7;

/// How closely the section must repeat, relative to the motion, where steps have this tolerance and no more
/// than `usual` is asked for: it cannot repeat more closely than the steps are.
pub fn recurrence(usual: f64, tolerance: f64) -> f64 {
    usual.max(10.0 * tolerance)
}

/// The residual up to which an orbit closes, from how closely sections must repeat: that of a cycle of hundreds
/// of events is rounding of ten times that.
pub fn closes(recurrence: f64) -> f64 {
    10.0 * recurrence
}

/// The distance up to which points of an orbit are taken for one, from how closely sections must repeat: the
/// rounding of a step, carried through weakly damped cycles, makes orbits of its own of that size.
pub fn resolution(recurrence: f64) -> f64 {
    100.0 * recurrence
}

/// How far two integrations of one orbit may differ at this tolerance, relative to the motion; where they
/// differ by more, one of them is wrong.
///
/// Steps with derivatives are shorter than those without. Of 13 000 random orbits at 1e-12 one differed by
/// 1.5e-8, after some sixty events a cycle, and all others by less than 4e-9.
pub fn same(tolerance: f64) -> f64 {
    let usual = 1e5 * tolerance.max(ROUNDING);
    usual.min((1e2 * tolerance).max(1e-3))
}

/// The defect of a step, times its length and relative to the motion, which the end of its series explains
/// at this tolerance; a larger one is that of a term which the step control has not seen.
pub fn sound(tolerance: f64) -> f64 {
    1e4 * tolerance.max(ROUNDING)
}
