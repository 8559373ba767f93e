//! The smallest disturbance of an attractor after which the motion leads to another one.

use crate::flow::Metric;
use crate::orbit::matrix::norm;

/// A disturbance of a motion at its section, after which it leads to another attractor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shock<const D: usize> {
    /// The section point of the attractor that is disturbed.
    pub from: [f64; D],
    /// The point to which it is moved.
    pub to: [f64; D],
    /// How far apart the two are, by the root of the sum of squares of the coordinates in the units of the metric.
    pub size: f64,
}

/// Points of a ball, or of a cone, that are followed side by side.
const SAMPLE: usize = 128;
/// Rounds of points of the ball at most.
const ROUNDS: usize = 12;
/// Points of a ray that are followed side by side, and how often the part of it that the boundary crosses is divided so.
const RAY: (usize, usize) = (16, 3);
/// Widths of the cones around the direction of the shock, as tangents: the widest, and what follows is half as wide.
const WIDEST: f64 = 0.5;
const CONES: usize = 6;
/// Rounds of points of one cone at most.
const CONE_ROUNDS: usize = 8;
/// A smaller shock counts if it is smaller by this share.
const SMALLER: f64 = 1e-3;
/// What the random numbers begin with.
const SEED: u64 = 20_181;

/// The minimal critical shock of an attractor with these section `points`: the smallest disturbance that is found of one of
/// them after which the motion leads to another attractor; none where `first`, a point that leads to another one, is not given.
///
/// `elsewhere` tells of each of some points whether it leads to another attractor. Method: random points of a ball whose radius
/// is the smallest shock so far, until no point of a round leads elsewhere; along the ray to each that does, the nearest
/// crossing that division finds; then narrower and narrower cones around the direction (after the search of Halekotte and
/// Feudel 2020, without derivatives). Error: it is an upper bound, to a thousandth if the boundary is smooth where it is
/// nearest; a narrow tongue of another basin may come nearer. The random numbers are the same in every run.
pub fn minimal_critical_shock<const D: usize>(
    points: &[[f64; D]],
    first: [f64; D],
    metric: &Metric<D>,
    elsewhere: &dyn Fn(&[[f64; D]]) -> Vec<bool>,
) -> Option<Shock<D>> {
    let shocks = points.iter().map(|&from| {
        let random = fastrand::Rng::with_seed(SEED);
        Search { from, metric, elsewhere, random }.smallest(first)
    });
    shocks.min_by(|a, b| a.size.total_cmp(&b.size))
}

/// The search around one section point.
struct Search<'a, const D: usize> {
    from: [f64; D],
    metric: &'a Metric<D>,
    elsewhere: &'a dyn Fn(&[[f64; D]]) -> Vec<bool>,
    random: fastrand::Rng,
}

impl<const D: usize> Search<'_, D> {
    fn smallest(&mut self, first: [f64; D]) -> Shock<D> {
        let mut best = self.nearest_on_ray(first);
        for _ in 0..ROUNDS {
            let sample: Vec<[f64; D]> = (0..SAMPLE)
                .map(|_| {
                    let direction = self.in_ball();
                    self.at(direction.map(|it| it * best.size))
                })
                .collect();
            let Some(nearer) = self.nearest(&sample) else { break };
            best = self.nearest_on_ray(nearer);
        }
        for cone in 0..CONES {
            let width = WIDEST / f64::from(1 << cone);
            for _ in 0..CONE_ROUNDS {
                let radius = best.size * (1.0 - SMALLER);
                let along = self.shift(&best.to).map(|it| it / best.size);
                let sample: Vec<[f64; D]> = (0..SAMPLE / 4)
                    .map(|_| {
                        let aside = self.in_ball();
                        let direction: [f64; D] =
                            std::array::from_fn(|i| along[i] + width * aside[i]);
                        let length = norm(&direction);
                        self.at(direction.map(|it| it / length * radius))
                    })
                    .collect();
                let Some(nearer) = self.nearest(&sample) else { break };
                best = self.nearest_on_ray(nearer);
            }
        }
        best
    }

    /// Of those that lead elsewhere the nearest.
    fn nearest(&self, sample: &[[f64; D]]) -> Option<[f64; D]> {
        let leads = (self.elsewhere)(sample);
        let away = sample.iter().zip(leads).filter(|(_, leads)| *leads).map(|(point, _)| *point);
        away.min_by(|a, b| norm(&self.shift(a)).total_cmp(&norm(&self.shift(b))))
    }

    /// The nearest point on the ray to one that leads elsewhere that is found to do so, too.
    fn nearest_on_ray(&self, to: [f64; D]) -> Shock<D> {
        let shift = self.shift(&to);
        let (mut low, mut high) = (0.0, 1.0);
        let (parts, times) = RAY;
        for _ in 0..times {
            let shares: Vec<f64> =
                (0..=parts).map(|part| low + (high - low) * part as f64 / parts as f64).collect();
            let inner = shares[1..parts].iter();
            let inner: Vec<[f64; D]> =
                inner.map(|share| self.at(shift.map(|it| it * share))).collect();
            let leads = (self.elsewhere)(&inner);
            let first = leads.iter().position(|leads| *leads).map_or(parts, |place| place + 1);
            (low, high) = (shares[first - 1], shares[first]);
        }
        let shift = shift.map(|it| it * high);
        Shock { from: self.from, to: self.at(shift), size: norm(&shift) }
    }

    /// How far a point is from the section point, in the units of the metric.
    fn shift(&self, point: &[f64; D]) -> [f64; D] {
        self.metric.scaled(&self.metric.difference(point, &self.from))
    }

    /// The point so far from the section point.
    fn at(&self, shift: [f64; D]) -> [f64; D] {
        std::array::from_fn(|i| self.from[i] + shift[i] / self.metric.scales[i])
    }

    /// A random point of the unit ball.
    fn in_ball(&mut self) -> [f64; D] {
        loop {
            let point: [f64; D] = std::array::from_fn(|_| 2.0 * self.random.f64() - 1.0);
            if norm(&point) <= 1.0 {
                return point;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const METRIC: Metric<3> = Metric::new([20.0, 1.0, 0.5]);

    fn scaled(point: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| point[i] * METRIC.scales[i])
    }

    #[test]
    fn the_distance_to_a_plane_is_found() {
        // A plane at a distance of 0.3 from the origin, in the units of the metric.
        let normal = [0.36, 0.48, 0.8];
        let elsewhere = |points: &[[f64; 3]]| {
            let height = |point: &[f64; 3]| {
                scaled(point).iter().zip(&normal).map(|(a, b)| a * b).sum::<f64>()
            };
            points.iter().map(|point| height(point) > 0.3).collect::<Vec<bool>>()
        };
        let first = [0.05, 2.0, 4.0];
        let shock =
            minimal_critical_shock(&[[0.0; 3]], first, &METRIC, &elsewhere).expect("a shock");
        assert!((0.3..0.302).contains(&shock.size), "{shock:?}");
    }

    #[test]
    fn the_nearer_of_two_section_points_to_a_ball_is_told() {
        let centre = [1.0, 1.0, 1.0];
        let elsewhere = |points: &[[f64; 3]]| {
            let away = |point: &[f64; 3]| {
                let at = scaled(point);
                norm(&std::array::from_fn::<f64, 3, _>(|i| at[i] - centre[i])) < 0.4
            };
            points.iter().map(away).collect::<Vec<bool>>()
        };
        let first = [0.05, 1.0, 2.0];
        let points = [[0.0; 3], [0.0, 0.0, 2.0]];
        let shock = minimal_critical_shock(&points, first, &METRIC, &elsewhere).expect("a shock");
        let expected = 2.0_f64.sqrt() - 0.4;
        assert_eq!(shock.from, points[1]);
        assert!((expected..expected * 1.002).contains(&shock.size), "{shock:?} {expected}");
    }
}
