//! Straight lines through measured points, with standard errors, and whether the points lie on one.

use std::fmt;

use super::estimate::{Estimate, chance_of_ratio};
use super::recording::median;

/// A curvature that chance alone would give with a lower probability than this is told.
const CURVED: f64 = 0.01;
/// Residuals of this share of the values are those of rounding.
const ROUNDING: f64 = 1e-13;
/// A residual beyond this many robust standard deviations is told.
const FAR: f64 = 4.0;
/// Fewer points do not tell how far residuals scatter.
const LEAST_POINTS: usize = 6;
/// Loading and unloading differ where chance alone gives their difference with a lower probability.
const HYSTERESIS: f64 = 0.001;

/// The line `y = intercept + slope x` with the least squares of the residuals in y.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its slope.
    pub slope: Estimate,
    /// Its value at x = 0.
    pub intercept: Estimate,
    /// What is left of each point, y less the line.
    pub residuals: Vec<f64>,
    /// The standard deviation of the residuals.
    pub scatter: f64,
    /// A parabola that describes the points better, if one does.
    pub curvature: Option<Curvature>,
}

/// A parabola through points that do not lie on a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curvature {
    /// The probability that points on a line scatter so.
    pub chance: f64,
    /// The slopes of the lines through the points with the lesser half of x and through those with the greater.
    pub slopes: [f64; 2],
}

/// The line through at least three points that differ in x; none where they do not.
///
/// # Method
///
/// Least squares of the residuals in y, which are taken to be independent and of equal scatter, x as exact. The curvature
/// is tested by the F test of a quadratic term.
///
/// # Guarantees
///
/// Residuals that are no more than rounding are zero: points on a line have no scatter and no curvature.
pub fn line(x: &[f64], y: &[f64]) -> Option<Line> {
    let count = x.len();
    if count < 3 {
        return None;
    }
    let [x_mean, y_mean] = [x, y].map(|it| it.iter().sum::<f64>() / count as f64);
    let u: Vec<f64> = x.iter().map(|it| it - x_mean).collect();
    let square: f64 = u.iter().map(|it| it * it).sum();
    let extent = x.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    if square <= (1e-12 * extent).powi(2) {
        return None;
    }
    let slope = u.iter().zip(y).map(|(u, y)| u * (y - y_mean)).sum::<f64>() / square;
    let height = y.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    let residuals = u.iter().zip(y).map(|(u, y)| y - y_mean - slope * u);
    let residuals = residuals.map(|it| if it.abs() <= ROUNDING * height { 0.0 } else { it });
    let residuals: Vec<f64> = residuals.collect();
    let left: f64 = residuals.iter().map(|it| it * it).sum();
    let freedom = count - 2;
    let scatter = (left / freedom as f64).sqrt();
    let intercept_error = scatter * (1.0 / count as f64 + x_mean * x_mean / square).sqrt();
    Some(Line {
        slope: Estimate::of_student(slope, scatter / square.sqrt(), freedom),
        intercept: Estimate::of_student(y_mean - slope * x_mean, intercept_error, freedom),
        curvature: curvature(&u, &residuals, square)
            .map(|chance| Curvature { chance, slopes: halves(x, y, slope) }),
        residuals,
        scatter,
    })
}

/// The chance of such residuals of points on a line, where it is low; `u` is x less its mean.
fn curvature(u: &[f64], residuals: &[f64], square: f64) -> Option<f64> {
    let freedom = u.len().checked_sub(3).filter(|&it| it > 0)?;
    let explained = explained_by_parabola(u, residuals, square)?;
    let left = residuals.iter().map(|it| it * it).sum::<f64>() - explained;
    let chance = chance_of_ratio(explained / (left.max(0.0) / freedom as f64), [1, freedom]);
    (chance < CURVED).then_some(chance)
}

/// The sum of squares of residuals that the parabola explains that is orthogonal to the lines; none where there is none.
fn explained_by_parabola(u: &[f64], residuals: &[f64], square: f64) -> Option<f64> {
    let skew = u.iter().map(|it| it * it * it).sum::<f64>() / square;
    let mean = square / u.len() as f64;
    let parabola: Vec<f64> = u.iter().map(|it| it * it - skew * it - mean).collect();
    let its_square: f64 = parabola.iter().map(|it| it * it).sum();
    if its_square <= (1e-12 * square).powi(2) {
        return None;
    }
    let product = parabola.iter().zip(residuals).map(|(p, r)| p * r).sum::<f64>();
    Some(product * product / its_square)
}

/// The probability that chance gives residuals that a line and a parabola in x explain so well; none for fewer than six points,
/// or where x does not vary.
///
/// Method: the F test of both terms together, of residuals with zero mean.
pub fn chance_of_parabola(x: &[f64], residuals: &[f64]) -> Option<f64> {
    let count = x.len();
    let freedom = count.checked_sub(4).filter(|_| count >= LEAST_POINTS)?;
    let mean = x.iter().sum::<f64>() / count as f64;
    let u: Vec<f64> = x.iter().map(|it| it - mean).collect();
    let square: f64 = u.iter().map(|it| it * it).sum();
    if square <= 0.0 {
        return None;
    }
    let product: f64 = u.iter().zip(residuals).map(|(u, r)| u * r).sum();
    let straight = product * product / square;
    let explained = straight + explained_by_parabola(&u, residuals, square)?;
    let all: f64 = residuals.iter().map(|it| it * it).sum();
    let left = (all - explained).max(0.0) / freedom as f64;
    Some(chance_of_ratio(0.5 * explained / left, [2, freedom]))
}

/// A point whose residual is far beyond those of the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outlier {
    /// Its row, counted from 1.
    pub row: usize,
    /// Its residual in robust standard deviations of all residuals.
    pub deviations: f64,
}

impl fmt::Display for Outlier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "row {} of the numbers lies {:.1} robust standard deviations off the fit: is it an outlier?",
            self.row,
            self.deviations.abs()
        )
    }
}

/// The points whose residuals exceed four robust standard deviations, of a fit of so many parameters.
///
/// # Method
///
/// The robust standard deviation is 1.4826 times the median of the absolute residuals, times `sqrt(n/(n - p))` for p parameters
/// of n points, or `rounding`, that of values which are rounded to their resolution, where that is more.
///
/// # Breaks
///
/// Fewer than six points, or residuals of which most are zero, have no outliers.
pub fn outliers(residuals: &[f64], parameters: usize, rounding: f64) -> Vec<Outlier> {
    let count = residuals.len();
    if count < LEAST_POINTS.max(parameters + 1) {
        return Vec::new();
    }
    let sizes: Vec<f64> = residuals.iter().map(|it| it.abs()).collect();
    let freedom = (count - parameters) as f64;
    let robust = 1.4826 * median(&sizes) * (count as f64 / freedom).sqrt();
    if robust <= 0.0 {
        return Vec::new();
    }
    let deviation = robust.max(rounding);
    let mut outliers = Vec::new();
    for (i, residual) in residuals.iter().enumerate() {
        let deviations = residual / deviation;
        if deviations.abs() > FAR {
            outliers.push(Outlier { row: i + 1, deviations });
        }
    }
    outliers
}

/// How much higher y lies on rows where x falls than on rows where it rises, where both are many and the difference is no chance.
///
/// # Method
///
/// A row belongs to the direction in which x came to it, the first to the direction in which x leaves. The difference of the mean
/// residuals of both about the line is judged by Student's test; none where a direction has fewer than three rows.
pub fn hysteresis(x: &[f64], residuals: &[f64]) -> Option<f64> {
    let steps: Vec<f64> = x.windows(2).map(|it| it[1] - it[0]).collect();
    let directions = steps.iter().take(1).chain(&steps);
    let (mut rising, mut falling) = (Vec::new(), Vec::new());
    for (residual, step) in residuals.iter().zip(directions) {
        match step {
            _ if *step > 0.0 => rising.push(*residual),
            _ if *step < 0.0 => falling.push(*residual),
            _ => {}
        }
    }
    let both = [rising, falling];
    if both.iter().any(|it| it.len() < 3) {
        return None;
    }
    let means = both.each_ref().map(|it| it.iter().sum::<f64>() / it.len() as f64);
    let squares = [0, 1].map(|i| both[i].iter().map(|it| (it - means[i]).powi(2)).sum::<f64>());
    let freedom = both[0].len() + both[1].len() - 3;
    let variance = (squares[0] + squares[1]) / freedom as f64;
    let difference = means[1] - means[0];
    let share = 1.0 / both[0].len() as f64 + 1.0 / both[1].len() as f64;
    let chance = chance_of_ratio(difference * difference / (variance * share), [1, freedom]);
    (chance < HYSTERESIS).then_some(difference)
}

/// The slopes of the lines through the halves of the points by x; that of all where a half has no line.
fn halves(x: &[f64], y: &[f64], slope: f64) -> [f64; 2] {
    let mut points: Vec<(f64, f64)> = x.iter().copied().zip(y.iter().copied()).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (low, high) = points.split_at(points.len() / 2);
    [low, high].map(|half| {
        let count = half.len() as f64;
        let x_mean = half.iter().map(|it| it.0).sum::<f64>() / count;
        let y_mean = half.iter().map(|it| it.1).sum::<f64>() / count;
        let square: f64 = half.iter().map(|it| (it.0 - x_mean).powi(2)).sum();
        let product: f64 = half.iter().map(|it| (it.0 - x_mean) * (it.1 - y_mean)).sum();
        if square > 0.0 { product / square } else { slope }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norris_is_that_of_nist() {
        // NIST StRD, linear regression, data set Norris.
        let data = [
            (0.1, 0.2),
            (338.8, 337.4),
            (118.1, 118.2),
            (888.0, 884.6),
            (9.2, 10.1),
            (228.1, 226.5),
            (668.5, 666.3),
            (998.5, 996.3),
            (449.1, 448.6),
            (778.9, 777.0),
            (559.2, 558.2),
            (0.3, 0.4),
            (0.1, 0.6),
            (778.1, 775.5),
            (668.8, 666.9),
            (339.3, 338.0),
            (448.9, 447.5),
            (10.8, 11.6),
            (557.7, 556.0),
            (228.3, 228.1),
            (998.0, 995.8),
            (888.8, 887.6),
            (119.6, 120.2),
            (0.3, 0.3),
            (0.6, 0.3),
            (557.6, 556.8),
            (339.3, 339.1),
            (888.0, 887.2),
            (998.5, 999.0),
            (778.9, 779.0),
            (10.2, 11.1),
            (117.6, 118.3),
            (228.9, 229.2),
            (668.4, 669.1),
            (449.2, 448.9),
            (0.2, 0.5),
        ];
        let (y, x): (Vec<f64>, Vec<f64>) = data.into_iter().unzip();
        let line = line(&x, &y).expect("a line");
        let near = |found: f64, certified: f64| (found / certified - 1.0).abs() < 1e-10;
        assert!(near(line.slope.value, 1.002_116_818_020_45));
        assert!(near(line.slope.standard_error, 0.429_796_848_199_937e-3));
        assert!(near(line.intercept.value, -0.262_323_073_774_029));
        assert!(near(line.intercept.standard_error, 0.232_818_234_301_152));
        assert!(near(line.scatter, 0.884_796_396_144_373));
        assert_eq!(line.curvature, None);
    }

    #[test]
    fn a_parabola_is_told_with_its_slopes() {
        let x: Vec<f64> = (0..20).map(|i| 0.1 * f64::from(i)).collect();
        let noise = |i: usize| 1e-3 * ((7 * i) as f64).sin();
        let y: Vec<f64> =
            x.iter().enumerate().map(|(i, x)| 1.0 + 2.0 * x + 0.1 * x * x + noise(i)).collect();
        let curvature = line(&x, &y).and_then(|it| it.curvature).expect("curved");
        assert!(curvature.chance < 1e-6);
        assert!((curvature.slopes[0] - 2.09).abs() < 5e-3);
        assert!((curvature.slopes[1] - 2.29).abs() < 5e-3);
        assert_eq!(line(&[1.0, 1.0, 1.0], &[1.0, 2.0, 3.0]), None);
    }

    #[test]
    fn points_without_scatter_have_a_line_and_no_curvature() {
        let x: Vec<f64> = (0..8).map(f64::from).collect();
        for (offset, slope) in [(2.0, 0.0), (0.1, 0.0), (0.0, 0.0), (0.3, 1.7)] {
            let y: Vec<f64> = x.iter().map(|x| offset + slope * x).collect();
            let line = line(&x, &y).expect("a line");
            assert!((line.slope.value - slope).abs() < 1e-14, "{line:?}");
            assert_eq!((line.scatter, line.curvature), (0.0, None));
            assert!(outliers(&line.residuals, 2, 0.0).is_empty());
            assert_eq!(hysteresis(&x, &line.residuals), None);
            assert!(chance_of_parabola(&x, &line.residuals).is_none_or(|it| it == 1.0));
        }
    }
}
