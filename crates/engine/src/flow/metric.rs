//! How far two points of a section are apart: the one norm of the house.

/// The largest of the coordinates, each multiplied with its scale.
///
/// A coordinate may repeat after 1, as an angle counted in turns does: points that differ by a whole number in it are one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metric<const D: usize> {
    /// What each coordinate is multiplied with to be compared.
    pub scales: [f64; D],
    /// Which coordinates repeat after 1.
    pub repeats: [bool; D],
}

impl<const D: usize> Metric<D> {
    /// That of coordinates none of which repeats.
    pub const fn new(scales: [f64; D]) -> Self {
        Metric { scales, repeats: [false; D] }
    }

    /// The size of a point; NaN where a coordinate is. A coordinate that repeats has no part in it, as its zero is arbitrary.
    #[inline]
    pub fn size(&self, point: &[f64; D]) -> f64 {
        self.length(&std::array::from_fn(|i| if self.repeats[i] { 0.0 } else { point[i] }))
    }

    /// The size of a difference; NaN where a coordinate is.
    #[inline]
    pub fn length(&self, difference: &[f64; D]) -> f64 {
        let scaled = difference.iter().zip(&self.scales).map(|(x, scale)| (scale * x).abs());
        scaled.fold(0.0, greater)
    }

    /// The difference of two points; where coordinates repeat, the least one.
    #[inline]
    pub fn difference(&self, a: &[f64; D], b: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|i| {
            let difference = a[i] - b[i];
            if self.repeats[i] { difference - difference.round_ties_even() } else { difference }
        })
    }

    /// The size of the largest of some points; zero of none.
    pub fn largest(&self, points: &[[f64; D]]) -> f64 {
        points.iter().map(|point| self.size(point)).fold(0.0, f64::max)
    }

    /// How far two points are apart.
    #[inline]
    pub fn distance(&self, a: &[f64; D], b: &[f64; D]) -> f64 {
        self.length(&self.difference(a, b))
    }

    /// A difference in the units of the metric.
    #[inline]
    pub fn scaled(&self, difference: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|i| self.scales[i] * difference[i])
    }

    /// A point as it is told nearest to another: in a coordinate that repeats, a whole number may differ.
    #[inline]
    pub fn beside(&self, point: &[f64; D], other: &[f64; D]) -> [f64; D] {
        let difference = self.difference(point, other);
        std::array::from_fn(|i| if self.repeats[i] { other[i] + difference[i] } else { point[i] })
    }

    /// The coordinates as whole numbers of this `step` in the units of the metric; zeros where the step is zero. Of a coordinate that
    /// repeats, what is beyond a whole number.
    pub fn rounded(&self, point: &[f64; D], step: f64) -> [i64; D] {
        let within =
            |i: usize| if self.repeats[i] { point[i] - point[i].floor() } else { point[i] };
        let whole = |i: usize| (self.scales[i] * within(i) / step).round() as i64;
        if step > 0.0 { std::array::from_fn(whole) } else { [0; D] }
    }

    /// The size of a difference in units of `size`; zero for no difference, also of a motion at rest.
    #[inline]
    pub fn relative(&self, difference: &[f64; D], size: f64) -> f64 {
        let largest = self.length(difference);
        if largest == 0.0 { 0.0 } else { largest / size }
    }
}

/// The greater of two numbers; NaN where either is.
#[inline]
pub fn greater(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_size_is_a_norm_and_unknown_coordinates_make_it_unknown() {
        let metric = Metric::new([20.0, 1.0, 0.5]);
        let (a, b) = ([0.1, -3.0, 1.0], [-0.2, 0.5, 4.0]);
        assert_eq!((metric.size(&a), metric.size(&b)), (3.0, 4.0));
        assert_eq!(metric.distance(&a, &b), metric.distance(&b, &a));
        assert!(metric.distance(&a, &b) <= metric.size(&a) + metric.size(&b));
        assert_eq!(metric.size(&a.map(|x| -2.0 * x)), 6.0);
        assert_eq!((metric.relative(&[0.0; 3], 0.0), metric.relative(&a, 6.0)), (0.0, 0.5));
        assert!(metric.size(&[0.0, f64::NAN, 1.0]).is_nan());
    }

    #[test]
    fn points_that_differ_by_a_whole_number_in_what_repeats_are_one() {
        let metric = Metric { scales: [2.0, 8.0], repeats: [false, true] };
        let (a, b) = ([3.0, 0.875], [3.0, -2.125]);
        assert_eq!(metric.distance(&a, &b), 0.0);
        assert_eq!(metric.rounded(&a, 0.5), metric.rounded(&b, 0.5));
        assert_eq!(metric.difference(&a, &[1.0, 0.0]), [2.0, -0.125]);
        assert_eq!((metric.size(&a), metric.distance(&a, &[3.0, 0.0])), (6.0, 1.0));
        assert!(metric.distance(&a, &[3.0, f64::NAN]).is_nan());
    }
}
