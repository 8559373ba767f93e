//! How far two points of a section are apart: the one norm of the house.

/// The largest of the coordinates, each multiplied with its scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metric<const D: usize> {
    /// What each coordinate is multiplied with to be compared.
    pub scales: [f64; D],
}

impl<const D: usize> Metric<D> {
    /// The size of a point or of a difference; NaN where a coordinate is.
    #[inline]
    pub fn size(&self, point: &[f64; D]) -> f64 {
        let scaled = point.iter().zip(&self.scales).map(|(x, scale)| (scale * x).abs());
        scaled.fold(0.0, greater)
    }

    /// The size of the largest of some points; zero of none.
    pub fn largest(&self, points: &[[f64; D]]) -> f64 {
        points.iter().map(|point| self.size(point)).fold(0.0, f64::max)
    }

    /// How far two points are apart.
    #[inline]
    pub fn distance(&self, a: &[f64; D], b: &[f64; D]) -> f64 {
        self.size(&std::array::from_fn(|i| a[i] - b[i]))
    }

    /// The coordinates as whole numbers of this `step` in the units of the metric; zeros where the step is zero.
    pub fn rounded(&self, point: &[f64; D], step: f64) -> [i64; D] {
        let whole = |i: usize| (self.scales[i] * point[i] / step).round() as i64;
        if step > 0.0 { std::array::from_fn(whole) } else { [0; D] }
    }

    /// The size of a difference in units of `size`; zero for no difference, also of a motion at rest.
    #[inline]
    pub fn relative(&self, difference: &[f64; D], size: f64) -> f64 {
        let largest = self.size(difference);
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
        let metric = Metric { scales: [20.0, 1.0, 0.5] };
        let (a, b) = ([0.1, -3.0, 1.0], [-0.2, 0.5, 4.0]);
        assert_eq!((metric.size(&a), metric.size(&b)), (3.0, 4.0));
        assert_eq!(metric.distance(&a, &b), metric.distance(&b, &a));
        assert!(metric.distance(&a, &b) <= metric.size(&a) + metric.size(&b));
        assert_eq!(metric.size(&a.map(|x| -2.0 * x)), 6.0);
        assert_eq!((metric.relative(&[0.0; 3], 0.0), metric.relative(&a, 6.0)), (0.0, 0.5));
        assert!(metric.size(&[0.0, f64::NAN, 1.0]).is_nan());
    }
}
