//! Manifolds of saddles of maps that are known in closed form: lines and planes, bent by a change of coordinates.

use capsulemap_engine::attractor::{
    BranchEnd, CurveEnd, ManifoldSearch, Manifolds, Met, Plane, Saddle, SectionMap,
};
use capsulemap_engine::flow::Metric;
use capsulemap_engine::orbit::matrix::{eigenvalues, solve};
use capsulemap_engine::orbit::return_map::Image;

/// A map in straight coordinates, of which the first leads to 1 or to -1 by its sign, and its points seen in bent coordinates.
#[derive(Clone, Copy)]
struct Bent<const D: usize> {
    /// Whether the second coordinate changes its sign, so that the saddle and the attractors have period 2.
    alternates: bool,
    /// Whether the boundary has a corner.
    corner: bool,
    /// Whether the map jumps at the boundary, so that no saddle is on it.
    jumps: bool,
}

const PLAIN: Bent<2> = Bent { alternates: false, corner: false, jumps: false };

/// A number with its derivative: x + 0.3 x (1 - x^2), of which 0 repels and 1 and -1 attract.
fn apart(x: f64) -> [f64; 2] {
    [x + 0.3 * x * (1.0 - x * x), 1.3 - 0.9 * x * x]
}

impl<const D: usize> Bent<D> {
    /// The bend: what is added to the first coordinate where the second is `eta`, with its derivative.
    fn bend(&self, eta: f64) -> [f64; 2] {
        if self.corner {
            return [0.3 * (eta - 0.35).abs(), 0.3 * (eta - 0.35).signum()];
        }
        [0.3 * (2.0 * eta).sin(), 0.6 * (2.0 * eta).cos()]
    }

    /// The straight coordinates of a point, with derivatives: y is bent by x, x by y and by z.
    fn straight(&self, point: &[f64; D]) -> ([f64; D], [[f64; D]; D]) {
        let mut straight = *point;
        let mut derivative: [[f64; D]; D] =
            std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
        straight[1] -= 0.2 * point[0] * point[0];
        derivative[1][0] = -0.4 * point[0];
        let [bend, slope] = self.bend(straight[1]);
        straight[0] -= bend;
        derivative[0][0] -= slope * derivative[1][0];
        derivative[0][1] = -slope;
        if D > 2 {
            straight[0] -= 0.2 * point[2].sin();
            derivative[0][2] = -0.2 * point[2].cos();
        }
        (straight, derivative)
    }

    /// The point with these straight coordinates.
    fn point(&self, straight: &[f64; D]) -> [f64; D] {
        let mut point = *straight;
        point[0] += self.bend(straight[1])[0];
        if D > 2 {
            point[0] += 0.2 * straight[2].sin();
        }
        point[1] += 0.2 * point[0] * point[0];
        point
    }

    fn image(&self, point: &[f64; D]) -> Image<D> {
        let (straight, into) = self.straight(point);
        let (mut next, mut rates) = (straight, [0.0; D]);
        [next[0], rates[0]] = apart(straight[0]);
        if self.jumps {
            let to = if straight[0] < 0.0 { -1.0 } else { 1.0 };
            (next[0], rates[0]) = (to + 0.4 * (straight[0] - to), 0.4);
        }
        (next[1], rates[1]) = (0.4 * straight[1], 0.4);
        if self.alternates {
            let [to, rate] = apart(straight[1]);
            (next[1], rates[1]) = (-to, -rate);
        }
        if D > 2 {
            (next[2], rates[2]) = (-0.3 * straight[2], -0.3);
        }
        let end = self.point(&next);
        let (_, back) = self.straight(&end);
        let mut jacobian = [[0.0; D]; D];
        for column in 0..D {
            let image = std::array::from_fn(|i| rates[i] * into[i][column]);
            let image = solve(back, image).expect("regular");
            (0..D).for_each(|row| jacobian[row][column] = image[row]);
        }
        Image { end, jacobian }
    }

    /// The attractor of a point: its first straight coordinate after many cycles.
    fn leads(&self, point: &[f64; D]) -> Option<u32> {
        let mut point = *point;
        for _ in 0..400 {
            let first = self.straight(&point).0[0];
            if (first.abs() - 1.0).abs() < 0.2 {
                return Some(u32::from(first > 0.0));
            }
            point = self.image(&point).end;
        }
        None
    }

    /// The points of the orbit whose first straight coordinate is this.
    fn orbit(&self, first: f64) -> Vec<[f64; D]> {
        let seconds: &[f64] = if self.alternates { &[1.0, -1.0] } else { &[0.0] };
        let straight = |second: &f64| {
            let mut straight = [0.0; D];
            (straight[0], straight[1]) = (first, *second);
            self.point(&straight)
        };
        seconds.iter().map(straight).collect()
    }

    fn saddle(&self) -> Saddle<[f64; D]> {
        let points = self.orbit(0.0);
        let multipliers = eigenvalues(&self.image(&points[0]).jacobian).to_vec();
        Saddle { points, multipliers, residual: 0.0 }
    }

    /// The manifolds in a plane of the first two coordinates, of a grid of starts.
    fn manifolds(&self, origin: [f64; D], most: f64) -> Manifolds<[f64; D]> {
        let values: Vec<f64> =
            (0..41).map(|place| most * (f64::from(place) / 20.0 - 1.0)).collect();
        let plane = Plane { origin, places: [0, 1], values: [values.clone(), values.clone()] };
        let starts = values.iter().flat_map(|x| values.iter().map(move |y| (*x, *y)));
        let lead = |(x, y): (f64, f64)| {
            let mut point = origin;
            (point[0], point[1]) = (x, y);
            self.leads(&point)
        };
        let attractors: Vec<Option<u32>> = starts.map(lead).collect();
        let (image, next) = (
            |point: &[f64; D]| Some(self.image(point)),
            |point: &[f64; D]| Some(self.image(point).end),
        );
        let leads = |points: &[[f64; D]]| points.iter().map(|point| self.leads(point)).collect();
        let saddle =
            |_: [[f64; D]; 2]| (!self.jumps).then(|| Met { sides: [0, 1], saddle: self.saddle() });
        let search = ManifoldSearch {
            map: SectionMap {
                metric: Metric::new([1.0; D]),
                image: &image,
                next: &next,
                leads: &leads,
            },
            saddle: &saddle,
            plane: &plane,
            attractors: &attractors,
            points: &[self.orbit(-1.0), self.orbit(1.0)],
        };
        search.manifolds(&[])
    }

    /// How far a point is from the plane in which the first straight coordinate is zero.
    fn distance(&self, point: &[f64; D]) -> f64 {
        let (straight, derivative) = self.straight(point);
        let slope = derivative[0].iter().map(|it| it * it).sum::<f64>().sqrt();
        straight[0].abs() / slope
    }

    /// The largest distance of the points of the stable curves, and of points between them.
    fn farthest(&self, found: &Manifolds<[f64; D]>, origin: [f64; D]) -> [f64; 2] {
        let mut farthest = [0.0, 0.0];
        let point = |at: [f64; 2]| {
            let mut point = origin;
            (point[0], point[1]) = (at[0], at[1]);
            point
        };
        for curve in &found.stable {
            for pair in curve.points.windows(2) {
                let [a, b] = [pair[0], pair[1]];
                let middle = [0, 1].map(|i| 0.5 * (a[i] + b[i]));
                farthest[0] = f64::max(farthest[0], self.distance(&point(a)));
                farthest[1] = f64::max(farthest[1], self.distance(&point(middle)));
            }
        }
        farthest
    }
}

#[test]
fn the_stable_manifold_is_the_bent_line() {
    let found = PLAIN.manifolds([0.0, 0.0], 1.5);
    assert_eq!((found.saddles.len(), found.stable.len()), (1, 1), "{:?}", found.coverage);
    let curve = &found.stable[0];
    assert_eq!(curve.ends, [CurveEnd::Border; 2]);
    assert_eq!((found.coverage.uncovered, found.coverage.failed), (0, 0));
    assert!(found.coverage.crossings > 40 && curve.error < 1e-9);
    let [at, between] = PLAIN.farthest(&found, [0.0, 0.0]);
    assert!(at < 4e-9 && between < 2e-3, "{at:e} {between:e}");
    assert!(curve.points.iter().all(|it| it.iter().all(|x| x.abs() <= 1.5)));
    // On the left lies the attractor that is told first: a turn of the chord to the left.
    let [a, b] = [curve.points[10], curve.points[11]];
    let left = [a[0] - 1e-3 * (b[1] - a[1]), a[1] + 1e-3 * (b[0] - a[0])];
    assert_eq!(PLAIN.leads(&left), Some(curve.sides[0]));
}

#[test]
fn in_three_dimensions_it_is_the_cut_of_a_bent_surface() {
    let bent: Bent<3> = Bent { alternates: false, corner: false, jumps: false };
    for height in [0.0, 0.7] {
        let origin = [0.0, 0.0, height];
        let found = bent.manifolds(origin, 1.5);
        assert_eq!((found.stable.len(), found.coverage.uncovered), (1, 0));
        let [at, between] = bent.farthest(&found, origin);
        assert!(at < 4e-9 && between < 2e-3, "{at:e} {between:e}");
    }
}

#[test]
fn a_saddle_of_period_2_has_one_curve_through_a_source() {
    let bent: Bent<2> = Bent { alternates: true, ..PLAIN };
    let found = bent.manifolds([0.0, 0.0], 1.5);
    assert_eq!((found.saddles.len(), found.coverage.uncovered), (1, 0), "{:?}", found.coverage);
    assert_eq!(found.saddles[0].saddle.points.len(), 2);
    let [at, between] = bent.farthest(&found, [0.0, 0.0]);
    assert!(at < 4e-9 && between < 2e-3, "{at:e} {between:e}");
    assert_eq!(found.unstable.len(), 4);
}

#[test]
fn a_corner_is_passed_and_a_jump_is_followed_by_division() {
    let bent: Bent<2> = Bent { corner: true, ..PLAIN };
    let found = bent.manifolds([0.0, 0.0], 1.2);
    assert_eq!((found.stable.len(), found.coverage.uncovered), (1, 0), "{:?}", found.coverage);
    assert_eq!(found.stable[0].ends, [CurveEnd::Border; 2]);
    let [at, between] = bent.farthest(&found, [0.0, 0.0]);
    assert!(at < 4e-9 && between < 2e-3, "{at:e} {between:e}");
    let jumping: Bent<2> = Bent { jumps: true, ..PLAIN };
    let found = jumping.manifolds([0.0, 0.0], 1.5);
    assert_eq!((found.saddles.len(), found.stable.len()), (0, 1));
    let curve = &found.stable[0];
    assert_eq!((curve.saddle, curve.ends), (None, [CurveEnd::Border; 2]));
    assert!(curve.divided.iter().all(|it| *it) && found.coverage.uncovered == 0);
    let [at, between] = jumping.farthest(&found, [0.0, 0.0]);
    assert!(at < 1e-9 && between < 2e-3, "{at:e} {between:e}");
}

#[test]
fn the_unstable_manifold_is_the_bent_segment_to_both_attractors() {
    for bent in [PLAIN, Bent { alternates: true, ..PLAIN }] {
        let found = bent.manifolds([0.0, 0.0], 1.5);
        for branch in &found.unstable {
            assert_eq!((branch.end, branch.tears), (BranchEnd::Attractor, 0));
            let second = bent.straight(&branch.points[0]).0[1];
            for point in &branch.points {
                let straight = bent.straight(point).0;
                assert!((straight[1] - second).abs() < 1e-9, "{straight:?}");
                assert!(
                    straight[0].abs() <= 1.0 && straight[0] * (f64::from(branch.side) - 0.5) >= 0.0
                );
            }
            let reached = bent.straight(&branch.points[branch.points.len() - 1]).0[0];
            assert!((reached.abs() - 1.0).abs() < 0.01, "{reached}");
            let near = branch
                .points
                .windows(2)
                .all(|pair| (0..2).all(|i| (pair[0][i] - pair[1][i]).abs() < 0.1));
            assert!(near);
        }
    }
}
