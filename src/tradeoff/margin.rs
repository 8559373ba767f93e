//! How far a periodic orbit is along a parameter from where it ceases to be, to be stable, or to have the same events.

use crate::capsule::{Parameter, Reading};

use super::hold::{Hold, Side};
use super::operating_point::{Family, OperatingPoint};

/// The first step along the parameter and the longest, as shares of its range.
const STEPS: [f64; 2] = [1e-4, 0.02];
/// Where it changes is located to this share of the range.
const LOCATED: f64 = 1e-9;

/// The end of a stretch of a parameter over which an orbit changes smoothly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// The value of the parameter there (SI): the last at which the orbit is as it was.
    pub value: f64,
    /// What happens there; none where the range of the search ends first.
    pub what: Option<Hold>,
}

/// How far a parameter may change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margins {
    /// The parameter.
    pub parameter: Parameter,
    /// Where it ends when it falls.
    pub down: Margin,
    /// Where it ends when it rises.
    pub up: Margin,
}

/// Where the orbit at `at` ends or changes its events along the one free parameter of a family, towards a bound.
///
/// # Method
///
/// The orbit is followed by steps that double, each with Newton's method from the tangent; where it is lost or has another
/// sequence of events, the step is halved until the place is known to 1e-9 of the range.
///
/// # Breaks
///
/// A change that is undone within a step is passed.
pub fn margin<R: Reading>(family: &Family<R>, at: &OperatingPoint, side: Side) -> Margin {
    let (sign, end) = match side {
        Side::Lower => (-1.0, 0.0),
        Side::Upper => (1.0, 1.0),
    };
    let [mut step, longest] = STEPS;
    let mut last = at.clone();
    loop {
        let share = last.shares[0] + sign * step;
        let is_beyond = sign * (share - end) >= 0.0;
        let share = if is_beyond { end } else { share };
        match same(family, &last, share) {
            Some(there) if is_beyond => {
                return Margin { value: family.value(0, there.shares[0]), what: None };
            }
            Some(there) => {
                last = there;
                step = (2.0 * step).min(longest);
            }
            None => return located(family, last, share),
        }
    }
}

/// The orbit at another share, if it has the same events.
fn same<R: Reading>(
    family: &Family<R>,
    last: &OperatingPoint,
    share: f64,
) -> Option<OperatingPoint> {
    moved(family, last, share).filter(|it| it.events == last.events)
}

fn moved<R: Reading>(
    family: &Family<R>,
    last: &OperatingPoint,
    share: f64,
) -> Option<OperatingPoint> {
    let mut shares = last.shares;
    shares[0] = share;
    family.moved(last, &shares)
}

/// Where between an orbit and a share at which it is another or none the change is, and what it is.
fn located<R: Reading>(family: &Family<R>, mut last: OperatingPoint, mut lost: f64) -> Margin {
    while (lost - last.shares[0]).abs() > LOCATED {
        let middle = 0.5 * (last.shares[0] + lost);
        match same(family, &last, middle) {
            Some(there) => last = there,
            None => lost = middle,
        }
    }
    let what = match moved(family, &last, lost) {
        Some(beyond) if beyond.impacts() != last.impacts() => Hold::Grazing,
        Some(beyond) if beyond.events != last.events => Hold::EventSequence,
        _ => Hold::edge(&last.multipliers),
    };
    Margin { value: family.value(0, last.shares[0]), what: Some(what) }
}
