//! A plane of starts whose sides are one, and the value in it that is zero on the stable manifold of a saddle.

use std::cell::Cell;

use super::manifold::{Plane, SectionMap};
use super::saddle_frame::{SaddleFrame, applied, product_of};

/// A motion is compared with the linear map of a saddle where it is this near to it, relative to the motion.
const NEAR: f64 = 0.05;
/// It has left where it is this many times as far.
const LEFT: f64 = 4.0;
/// Cycles that a motion is followed until it is near the saddle.
const MOST_CYCLES: usize = 500;
/// Cycles that a start is followed until it is known where it leads, about, and that one with derivatives is worth.
const PER_START: u64 = 30;
const PER_IMAGE: u64 = 5;
/// Differences grow by this factor at most: beyond, nothing but rounding is left of them.
const GROWTH: f64 = 1e13;
/// A motion has settled where they have become smaller by this factor: it comes to no saddle any more.
const SETTLED: f64 = 1e-7;

/// A plane of starts in coordinates along which its sides are one.
pub(super) struct StartPlane<'a, const D: usize> {
    /// The return map.
    pub map: &'a SectionMap<'a, D>,
    /// The plane.
    pub plane: &'a Plane<[f64; D]>,
    /// Cycles that have been followed so far, about: those with derivatives count as several.
    pub cycles: Cell<u64>,
    /// Cycles that may be followed.
    pub most: u64,
}

/// How a motion comes near a saddle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Approach {
    /// How far it is along the unstable direction where it is near; zero on the stable manifold, to second order.
    pub value: f64,
    /// Its derivatives along the sides of the plane.
    pub gradient: [f64; 2],
    /// How far the second order puts the start from the manifold, the sides of the plane being one.
    pub error: f64,
    /// Cycles until then.
    pub cycles: usize,
}

/// Why there is no approach.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoApproach {
    /// It does not come near within the cycles that are followed.
    Far,
    /// It cannot be followed.
    Broken,
}

impl<const D: usize> StartPlane<'_, D> {
    /// The section point of a start.
    pub fn point(&self, at: &[f64; 2]) -> [f64; D] {
        let mut point = self.plane.origin;
        for (side, place) in self.plane.places.into_iter().enumerate() {
            point[place] = self.plane.along(side, at[side]);
        }
        point
    }

    /// What starts lead to.
    pub fn leads(&self, starts: &[[f64; 2]]) -> Vec<Option<u32>> {
        let points: Vec<[f64; D]> = starts.iter().map(|at| self.point(at)).collect();
        self.count(PER_START * starts.len() as u64);
        (self.map.leads)(&points)
    }

    /// Whether as many cycles have been followed as may be.
    pub fn is_spent(&self) -> bool {
        self.cycles.get() >= self.most
    }

    fn count(&self, cycles: u64) {
        self.cycles.set(self.cycles.get() + cycles);
    }

    /// The size of the plane [units of the metric].
    pub fn size(&self) -> f64 {
        let mut sides = [0.0; D];
        for (side, place) in self.plane.places.into_iter().enumerate() {
            sides[place] = self.plane.side(side);
        }
        self.map.metric.length(&sides)
    }

    /// How the motion from a start comes near a saddle; the first time, and later ones within these cycles, that is best.
    ///
    /// Method: from cycle to cycle the motion and its derivatives along the sides of the plane; the value is the product of the
    /// left direction with the distance to the nearest section point of the saddle. Where that distance is d, the manifold
    /// departs from its tangent by d squared, which is d squared over the gradient in the plane: where this is least counts.
    pub fn approach(
        &self,
        saddle: &SaddleFrame<D>,
        at: &[f64; 2],
        within: usize,
    ) -> Result<Approach, NoApproach> {
        let (map, mut point) = (self.map, self.point(at));
        let mut along = [0, 1].map(|side| {
            let mut direction = [0.0; D];
            direction[self.plane.places[side]] = self.plane.side(side);
            direction
        });
        let first = along.iter().map(|it| map.metric.length(it)).fold(0.0, f64::max);
        let mut best: Option<Approach> = None;
        for cycles in 0..=MOST_CYCLES {
            let (place, distance) = saddle.nearest(map, &point);
            let own = &saddle.points[place];
            let gradient = along.map(|it| product_of(&own.left, &it));
            let slope = libm::hypot(gradient[0], gradient[1]);
            let relative = distance / saddle.size;
            if relative <= NEAR && slope > 0.0 {
                let error = relative * distance / slope;
                if best.is_none_or(|best| error < best.error) {
                    let away = map.metric.difference(&point, &own.point);
                    let value = product_of(&own.left, &away);
                    best = Some(Approach { value, gradient, error, cycles });
                }
            }
            let largest = along.iter().map(|it| map.metric.length(it)).fold(0.0, f64::max);
            let is_settled = largest < SETTLED * first;
            let has_left = best.is_some() && relative > LEFT * NEAR;
            if (has_left && cycles >= within) || is_settled || largest > GROWTH * first {
                break;
            }
            self.count(PER_IMAGE);
            let Some(image) = (map.image)(&point) else {
                return best.ok_or(NoApproach::Broken);
            };
            along = along.map(|it| applied(&image.jacobian, &it));
            point = image.end;
        }
        best.ok_or(NoApproach::Far)
    }
}

impl<P> Plane<P> {
    /// The first value along a side.
    fn first(&self, side: usize) -> f64 {
        self.values[side][0]
    }

    /// The last value along a side less the first.
    pub(super) fn side(&self, side: usize) -> f64 {
        self.values[side][self.values[side].len() - 1] - self.first(side)
    }

    /// The value at a share of a side.
    pub(super) fn along(&self, side: usize, share: f64) -> f64 {
        self.first(side) + share * self.side(side)
    }

    /// The values at a place of the plane.
    pub(super) fn told(&self, at: &[f64; 2]) -> [f64; 2] {
        [0, 1].map(|side| self.along(side, at[side]))
    }

    /// The share of a side at which a start of the grid lies.
    pub(super) fn share(&self, side: usize, place: usize) -> f64 {
        (self.values[side][place] - self.first(side)) / self.side(side)
    }
}
