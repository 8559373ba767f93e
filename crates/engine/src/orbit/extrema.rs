//! The local extrema of the coordinate that may touch a surface.

use crate::flow::Event;
use crate::flow::guard::{Crossing, Crossings};
use crate::lane::{Lane, Mask, ORDER, Series, series};

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

/// How the rate of a coordinate changes its sign during a step, in each lane.
#[derive(Debug, Clone)]
pub struct SignChanges<L: Lane, V> {
    rate: Series<L>,
    /// In each lane the times, whether the rate falls there, and the coordinate.
    times: Vec<Vec<(f64, bool, V)>>,
    /// Where the coordinate rises in the middle of the step.
    rises: L::Mask,
}

impl<L: Lane, V: Copy> SignChanges<L, V> {
    /// None yet.
    pub fn none() -> Self {
        let times = (0..L::WIDTH).map(|_| Vec::new()).collect();
        SignChanges { rate: series::zero(), times, rises: L::Mask::splat(false) }
    }

    /// Those of a step of this length, in the lanes that take part; `one` tells what a lane holds.
    #[inline(always)]
    pub fn of<C: Lane<Plain = L>>(
        &mut self,
        coordinate: &Series<C>,
        length: L,
        taking_part: L::Mask,
        one: impl Fn(&C, usize) -> V,
    ) {
        for times in &mut self.times {
            times.clear();
        }
        self.rate = series::derivative(&series::plain(coordinate));
        self.rises = L::splat(0.0).lt(series::value(&self.rate, L::splat(0.5) * length));
        let mut crossings = Crossings::new(&self.rate, length, taking_part);
        loop {
            let Crossing { found, falls, time } = crossings.next(taking_part);
            if !found.any() {
                return;
            }
            let value = series::value(coordinate, C::from_plain(time));
            for (lane, times) in self.times.iter_mut().enumerate() {
                if found.lane(lane) {
                    times.push((time.lane(lane), falls.lane(lane), one(&value, lane)));
                }
            }
        }
    }
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
    /// Shows the extrema during a step in a lane, each with its time; `at` tells the coordinate at a time.
    ///
    /// A step may end just at an extremum, where rounding leaves the zero of the rate to neither step: then the rate
    /// has other signs in the two. An impact that reverses the rate hides an extremum: the one that the motion
    /// would have reached behind the surface counts, so that the margin is smooth where impacts begin.
    pub fn during<P: Lane, E: Event>(
        &mut self,
        (changes, lane): (&SignChanges<P, L>, usize),
        (length, event): (f64, Option<E>),
        at: impl Fn(f64) -> L,
        mut found: impl FnMut(f64, L),
    ) {
        let (times, within) = (&changes.times[lane], changes.rises.lane(lane));
        let begins_rising = times.first().map_or(within, |(_, falls, _)| *falls);
        if self.rose.is_some_and(|rose| rose != begins_rising) {
            found(0.0, at(0.0));
        }
        if let Some((_, extremum)) = self.unhindered.filter(|(rose, _)| *rose != begins_rising) {
            found(0.0, extremum);
        }
        for (time, _, value) in times {
            found(*time, *value);
        }
        let ends_rising = times.last().map_or(within, |(_, falls, _)| !falls);
        self.rose = event.is_none().then_some(ends_rising);
        let impact = event.filter(|event| event.is_impact());
        self.unhindered = impact.and_then(|_| {
            let rate = std::array::from_fn(|k| changes.rate[k].lane(lane));
            Some((ends_rising, at(turning_point(&rate, length)?)))
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
