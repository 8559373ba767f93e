//! The local extrema of the coordinate that may touch a surface.

use crate::flow::Event;
use crate::flow::guard::crossings;
use crate::lane::{Lane, ORDER, Series, series};

/// Newton's steps to an extremum at most, and how close the last two are, relative to the time.
const NEWTONS: usize = 12;
const ROUNDING: f64 = 1e-13;
/// A series describes a motion where its last term is below this, relative to the first ones.
const DESCRIBED: f64 = 1e-9;

/// A local maximum or minimum of the coordinate that may touch a surface: on the surface it is a grazing.
#[derive(Debug, Clone, Copy)]
pub struct Extremum<L> {
    /// How far it is below the surface; negative above it.
    pub margin: L,
    /// When it is met after the section [cycles].
    pub time: f64,
}

/// The extremum that is nearest to the surface.
pub fn nearest<L: Lane>(extrema: &[Extremum<L>]) -> Option<&Extremum<L>> {
    let away = |extremum: &Extremum<L>| extremum.margin.lane(0).abs();
    extrema.iter().min_by(|a, b| away(a).total_cmp(&away(b)))
}

/// The local extrema of a coordinate, step by step.
#[derive(Debug, Clone)]
pub struct Turns<L> {
    /// Whether the coordinate rose at the end of the last step; none where an event may have changed its rate.
    rose: Option<bool>,
    /// After an impact whether the coordinate rose before it, and the extremum that it would have gone on to.
    unhindered: Option<(bool, L)>,
}

impl<L: Lane> Default for Turns<L> {
    fn default() -> Self {
        Turns { rose: None, unhindered: None }
    }
}

impl<L: Lane> Turns<L> {
    /// Shows the extrema during a step, each with its time.
    ///
    /// A step may end just at an extremum, where rounding leaves the zero of the rate to neither step: then the rate
    /// has other signs in the two. An impact that reverses the rate hides an extremum: the one that the motion
    /// would have reached behind the surface counts, so that the margin is smooth where impacts begin.
    pub fn during<E: Event>(
        &mut self,
        coordinate: &Series<L>,
        (length, event): (f64, Option<E>),
        mut found: impl FnMut(f64, L),
    ) {
        let rate = series::derivative(&std::array::from_fn(|k| coordinate[k].lane(0)));
        let mut times = Vec::new();
        crossings(&rate, length, |time, falls| times.push((time, falls)));
        let within = series::value(&rate, 0.5 * length) > 0.0;
        let begins_rising = times.first().map_or(within, |(_, falls)| *falls);
        if self.rose.is_some_and(|rose| rose != begins_rising) {
            found(0.0, coordinate[0]);
        }
        if let Some((_, extremum)) = self.unhindered.filter(|(rose, _)| *rose != begins_rising) {
            found(0.0, extremum);
        }
        for (time, _) in &times {
            found(*time, series::value(coordinate, L::splat(*time)));
        }
        let ends_rising = times.last().map_or(within, |(_, falls)| !falls);
        self.rose = event.is_none().then_some(ends_rising);
        let impact = event.filter(|event| event.is_impact());
        self.unhindered = impact.and_then(|_| {
            let time = turning_point(&rate, length)?;
            Some((ends_rising, series::value(coordinate, L::splat(time))))
        });
    }
}

/// Where a rate vanishes next after a time, if its series still describes it there.
///
/// Method: Newton's, which is asked for small distances only, as far ones do not matter.
fn turning_point(rate: &Series<f64>, after: f64) -> Option<f64> {
    let mut time = after;
    for _ in 0..NEWTONS {
        let (value, slope) = series::value_and_slope(rate, time);
        let next = time - value / slope;
        if (next - time).abs() <= ROUNDING * next.abs() {
            let last = rate[ORDER - 1] * next.powi(ORDER as i32 - 1);
            let is_described = last.abs() <= DESCRIBED * rate[0].abs().max((rate[1] * next).abs());
            return (next >= after && is_described).then_some(next);
        }
        time = next;
    }
    None
}
