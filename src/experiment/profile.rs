//! The interval of a fitted parameter by its profile likelihood, and what the data say of it.

use std::cell::RefCell;
use std::fmt;

use super::estimate::student;
use super::least_squares::{Bounds, Fit, Model, Residuals, Search, Termination, fit_once};

/// What the data say of a parameter within the bounds that it was given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// They limit it on both sides.
    Determined,
    /// They set only a lower limit.
    LimitedBelow,
    /// They set only an upper limit.
    LimitedAbove,
    /// Every value within the bounds describes them as well.
    NotDetermined,
    /// Separate ranges of values describe them as well.
    Several,
}

impl Verdict {
    /// What is said of one range, by whether the data limit it below and above.
    pub fn of_limits(is_limited: [bool; 2]) -> Verdict {
        match is_limited {
            [true, true] => Verdict::Determined,
            [true, false] => Verdict::LimitedBelow,
            [false, true] => Verdict::LimitedAbove,
            [false, false] => Verdict::NotDetermined,
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::Determined => "determined",
            Verdict::LimitedBelow => "one-sided: the data set a lower limit only",
            Verdict::LimitedAbove => "one-sided: the data set an upper limit only",
            Verdict::NotDetermined => "not determined by these data",
            Verdict::Several => "not determined by these data: separate ranges agree with them",
        })
    }
}

/// The interval of a parameter by its profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile {
    /// Where the profile leaves what 95 of 100 experiments stay within; a bound where it does not.
    pub interval: [f64; 2],
    /// Whether the profile ends the interval on each side, rather than a bound.
    pub is_limited: [bool; 2],
}

impl Profile {
    /// What it says of the parameter.
    pub fn verdict(&self) -> Verdict {
        Verdict::of_limits(self.is_limited)
    }
}

/// Steps outward and halvings by which an end of the interval is found.
const STEPS: usize = 60;
/// The end is found to this share of its distance from the best value.
const NEAR: f64 = 1e-3;

/// The interval of the parameter `which` of a `best` fit within its bounds, which must be finite.
///
/// # Method
///
/// The parameter is held at other values and the others are fitted again, each time from where they were last. The interval
/// ends where the sum of squares S has grown by `t^2 S/n`, with Student's t for the n degrees of freedom of the fit; where outliers
/// count little, by `t^2` times the ratio of the variance of the parameter to the inverse of half the curvature of S. The end is bracketed by steps of growing length and found by interpolation of the root of what S has grown by, which is nearly
/// straight, to a thousandth of its distance.
///
/// # Source
///
/// Bates and Watts, Nonlinear Regression Analysis and Its Applications (1988), chapter 6; Raue and others,
/// Bioinformatics 25 (2009), for what is determined.
///
/// # Breaks
///
/// Where the profile has several minima within the bounds, the interval is that around the best fit.
pub fn profile(model: &impl Model, best: &Fit, search: &Search, which: usize) -> Profile {
    profile_points(model, best, search, which).0
}

/// The same with the points of the profile that were computed, rising: values of the parameter, and what the sum of squares has grown
/// by, in units of what ends the interval.
pub fn profile_points(
    model: &impl Model,
    best: &Fit,
    search: &Search,
    which: usize,
) -> (Profile, Vec<[f64; 2]>) {
    let bounds = search.bounds[which];
    let points = RefCell::new(vec![[best.parameters[which], 0.0]]);
    let limits = [bounds.least, bounds.greatest];
    let ends = [-1.0, 1.0].map(|sign| {
        let mut others = best.parameters.clone();
        others.remove(which);
        Walk { model, best, search, which, sign, others, points: &points }.end()
    });
    let profile = Profile {
        interval: [0, 1].map(|side| ends[side].unwrap_or(limits[side])),
        is_limited: ends.map(|end| end.is_some()),
    };
    let mut points = points.into_inner();
    points.retain(|it| it[1].is_finite());
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    (profile, points)
}

/// The search for an end of the interval.
struct Walk<'a, M> {
    model: &'a M,
    best: &'a Fit,
    search: &'a Search,
    which: usize,
    /// Whether it is the lower (-1) or the upper (1) end.
    sign: f64,
    /// The other parameters as they were fitted last.
    others: Vec<f64>,
    /// Points of the profile, as they are computed.
    points: &'a RefCell<Vec<[f64; 2]>>,
}

/// A distance from the best value, and how high the profile is there above the end of the interval.
#[derive(Clone, Copy)]
struct Place {
    distance: f64,
    height: f64,
}

impl<M: Model> Walk<'_, M> {
    /// Where the profile ends; none where a bound comes first.
    fn end(mut self) -> Option<f64> {
        let Bounds { least, greatest } = self.search.bounds[self.which];
        let bound = if self.sign < 0.0 { least } else { greatest };
        let centre = self.best.parameters[self.which];
        let room = (bound - centre) * self.sign;
        if room <= 0.0 {
            return None;
        }
        let [inside, outside] = self.bracket(room)?;
        Some(centre + self.sign * self.crossing(inside, outside))
    }

    /// The profile so far from the best value.
    fn at(&mut self, distance: f64) -> Place {
        let value = self.best.parameters[self.which] + self.sign * distance;
        Place { distance, height: self.excess(value).max(0.0).sqrt() - 1.0 }
    }

    /// Places within the interval and beyond its end, which is no further than `room`.
    fn bracket(&mut self, room: f64) -> Option<[Place; 2]> {
        let error = self.best.standard_error(self.which);
        let expected = student(self.best.degrees_of_freedom) * error;
        let first = if expected.is_finite() && expected > 0.0 { expected } else { 0.05 * room };
        let (mut inside, mut step) = (Place { distance: 0.0, height: -1.0 }, first.min(room));
        for _ in 0..STEPS {
            let here = self.at((inside.distance + step).min(room));
            if here.height > 0.0 {
                return Some([inside, here]);
            }
            if here.distance >= room {
                return None;
            }
            step = if here.height > -0.2 { 0.2 * here.distance } else { 1.6 * step };
            inside = here;
        }
        None
    }

    /// How far the end is from the best value, which lies between these places.
    fn crossing(&mut self, mut inside: Place, mut outside: Place) -> f64 {
        for turn in 0..STEPS {
            if outside.distance - inside.distance <= NEAR * outside.distance {
                break;
            }
            let share = if outside.height.is_finite() && turn % 3 < 2 {
                // Towards the far side by a little, so that both close in.
                let straight = inside.height / (inside.height - outside.height);
                (straight + if turn % 2 == 0 { NEAR } else { -NEAR }).clamp(0.0005, 0.9995)
            } else {
                0.5
            };
            let here = self.at(inside.distance + share * (outside.distance - inside.distance));
            if here.height > 0.0 { outside = here } else { inside = here }
        }
        let share = match outside.height.is_finite() {
            true => inside.height / (inside.height - outside.height),
            false => 0.5,
        };
        inside.distance + share * (outside.distance - inside.distance)
    }

    /// How far the sum of squares has grown with the parameter held at `value`, in units of what ends the interval. The
    /// others are fitted from where they were last.
    fn excess(&mut self, value: f64) -> f64 {
        let model = Held { model: self.model, which: self.which, value };
        let sum = match self.others.is_empty() {
            true => model.residuals(&[]).map(|it| it.values.iter().map(|it| it * it).sum::<f64>()),
            false => {
                let mut search = self.search.clone();
                search.bounds.remove(self.which);
                let fitted = fit_once(&model, &self.others, &search, 1.0);
                let usable = fitted.filter(|it| it.termination != Termination::NoValue);
                usable.map(|fit| {
                    self.others = fit.parameters;
                    fit.sum_of_squares
                })
            }
        };
        let allowed = student(self.best.degrees_of_freedom).powi(2)
            * self.best.covariance.growth_of(self.which);
        let grown = sum.map_or(f64::INFINITY, |sum| (sum - self.best.sum_of_squares) / allowed);
        self.points.borrow_mut().push([value, grown]);
        grown
    }
}

/// A model with one of its parameters held at a value.
struct Held<'m, M> {
    model: &'m M,
    which: usize,
    value: f64,
}

impl<M: Model> Model for Held<'_, M> {
    fn residuals(&self, others: &[f64]) -> Option<Residuals> {
        let mut all = others.to_vec();
        all.insert(self.which, self.value);
        let mut residuals = self.model.residuals(&all)?;
        for row in &mut residuals.slopes {
            row.remove(self.which);
        }
        Some(residuals)
    }
}

/// The narrowing of golden section, and its steps: to 1e-12.
const GOLDEN: (f64, usize) = (0.618_033_988_749_894_9, 60);

/// Ranges, of which those that overlap are one, rising.
pub(super) fn merged(mut ranges: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    ranges.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all: Vec<[f64; 2]> = Vec::new();
    for range in ranges {
        match all.last_mut() {
            Some(last) if range[0] <= last[1] => last[1] = last[1].max(range[1]),
            _ => all.push(range),
        }
    }
    all
}

/// The least value of a function with one minimum in a range, with where it is, by golden section.
pub(super) fn least(function: &dyn Fn(f64) -> f64, [mut a, mut b]: [f64; 2]) -> (f64, f64) {
    let (mut low, mut high) = (inner(function, a, b), inner(function, b, a));
    for _ in 0..GOLDEN.1 {
        if low.1 <= high.1 {
            (b, high) = (high.0, low);
            low = inner(function, a, b);
        } else {
            (a, low) = (low.0, high);
            high = inner(function, b, a);
        }
    }
    if low.1 <= high.1 { low } else { high }
}

/// The point that divides a range by the golden section, nearer to its first end, with the value there.
fn inner(function: &dyn Fn(f64) -> f64, from: f64, to: f64) -> (f64, f64) {
    let at = to - GOLDEN.0 * (to - from);
    (at, function(at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::least_squares::fit;

    /// y = a x + b on points with a known scatter.
    fn model(parameters: &[f64]) -> Option<Residuals> {
        let rows = (0..20).map(|i| {
            let x = 0.1 * f64::from(i);
            let y = 2.0 * x + 1.0 + 0.01 * f64::from(i * i * 7 % 11 - 5);
            (parameters[0] * x + parameters[1] - y, vec![x, 1.0])
        });
        let (values, slopes) = rows.unzip();
        Some(Residuals { values, slopes })
    }

    #[test]
    fn of_a_linear_model_it_is_the_interval_of_student() {
        let bounds = Bounds { least: -10.0, greatest: 10.0 };
        let search = Search { bounds: vec![bounds; 2], ..Search::free(2) };
        let best = fit(&model, &[0.0, 0.0], &search).expect("a fit");
        for which in [0, 1] {
            let (profile, points) = profile_points(&model, &best, &search, which);
            let reach = student(18) * best.standard_error(which);
            let [least, greatest] = profile.interval.map(|it| it - best.parameters[which]);
            assert!((least / -reach - 1.0).abs() < 2e-3, "{least} {reach}");
            assert!((greatest / reach - 1.0).abs() < 2e-3, "{greatest} {reach}");
            assert_eq!(profile.verdict(), Verdict::Determined);
            // The profile of a linear model is a parabola that is one at the ends of the interval.
            assert!(points.len() >= 5 && points.is_sorted_by(|a, b| a[0] <= b[0]), "{points:?}");
            for [value, grown] in points {
                let parabola = ((value - best.parameters[which]) / reach).powi(2);
                assert!((grown - parabola).abs() < 1e-6 * (1.0 + parabola), "{grown} {parabola}");
            }
        }
    }

    #[test]
    fn what_the_data_do_not_limit_is_said() {
        // The second parameter acts through its square root below one alone, the third not at all.
        let model = |p: &[f64]| {
            let residuals = model(&[p[0], 1.0])?;
            let slopes = residuals.slopes.iter().map(|row| vec![row[0], 0.0, 0.0]).collect();
            let mut it = Residuals { values: residuals.values, slopes };
            let below = (1.0 - p[1]).max(0.0);
            it.values.push(100.0 * below * below);
            it.slopes.push(vec![0.0, -200.0 * below, 0.0]);
            Some(it)
        };
        let bounds = Bounds { least: 0.0, greatest: 5.0 };
        let search = Search { bounds: vec![bounds; 3], ..Search::free(3) };
        let best = fit(&model, &[1.0, 2.0, 3.0], &search).expect("a fit");
        let verdicts = [0, 1, 2].map(|which| profile(&model, &best, &search, which).verdict());
        let expected = [Verdict::Determined, Verdict::LimitedBelow, Verdict::NotDetermined];
        assert_eq!(verdicts, expected);
    }
}
