//! The interval of a fitted parameter by its profile likelihood, and what the data say of it.

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
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::Determined => "determined",
            Verdict::LimitedBelow => "one-sided: the data set a lower limit only",
            Verdict::LimitedAbove => "one-sided: the data set an upper limit only",
            Verdict::NotDetermined => "not determined by these data",
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
        match self.is_limited {
            [true, true] => Verdict::Determined,
            [true, false] => Verdict::LimitedBelow,
            [false, true] => Verdict::LimitedAbove,
            [false, false] => Verdict::NotDetermined,
        }
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
/// ends where the sum of squares S has grown by `t^2 S/n`, with Student's t for the n degrees of freedom of the fit. The
/// end is bracketed by steps of growing length and found by interpolation of the root of what S has grown by, which is nearly
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
    let bounds = search.bounds[which];
    let walk = |side: usize| Walk { model, best, search, which }.end(side);
    let ends = [0, 1].map(walk);
    let limits = [bounds.least, bounds.greatest];
    Profile {
        interval: [0, 1].map(|side| ends[side].unwrap_or(limits[side])),
        is_limited: ends.map(|end| end.is_some()),
    }
}

struct Walk<'a, M> {
    model: &'a M,
    best: &'a Fit,
    search: &'a Search,
    which: usize,
}

impl<M: Model> Walk<'_, M> {
    /// Where the profile ends on the lower (0) or upper (1) side; none where a bound comes first.
    fn end(&self, side: usize) -> Option<f64> {
        let Bounds { least, greatest } = self.search.bounds[self.which];
        let (bound, sign) = if side == 0 { (least, -1.0) } else { (greatest, 1.0) };
        let centre = self.best.parameters[self.which];
        let room = (bound - centre) * sign;
        if room <= 0.0 {
            return None;
        }
        let error = self.best.standard_error(self.which);
        let expected = student(self.best.degrees_of_freedom) * error;
        let first = if expected.is_finite() && expected > 0.0 { expected } else { 0.05 * room };
        let mut others = self.others(&self.best.parameters);
        let mut height =
            |at: f64| self.excess(centre + sign * at, &mut others).max(0.0).sqrt() - 1.0;
        // Distances from the best value within the interval and beyond its end, with the heights of the profile there.
        let (mut inside, mut outside, mut step) = ((0.0, -1.0), None, first.min(room));
        for _ in 0..STEPS {
            let at = (inside.0 + step).min(room);
            let here = height(at);
            if here > 0.0 {
                outside = Some((at, here));
                break;
            }
            if at >= room {
                return None;
            }
            (inside, step) = ((at, here), if here > -0.2 { 0.2 * at } else { 1.6 * step });
        }
        let mut outside = outside?;
        for turn in 0..STEPS {
            if outside.0 - inside.0 <= NEAR * outside.0 {
                break;
            }
            let share = if outside.1.is_finite() && turn % 3 < 2 {
                // Towards the far side by a little, so that both close in.
                (inside.1 / (inside.1 - outside.1) + if turn % 2 == 0 { NEAR } else { -NEAR })
                    .clamp(0.0005, 0.9995)
            } else {
                0.5
            };
            let at = inside.0 + share * (outside.0 - inside.0);
            let here = height(at);
            if here > 0.0 { outside = (at, here) } else { inside = (at, here) }
        }
        let share = if outside.1.is_finite() { inside.1 / (inside.1 - outside.1) } else { 0.5 };
        Some(centre + sign * (inside.0 + share * (outside.0 - inside.0)))
    }

    /// How far the sum of squares has grown with the parameter held at `value`, in units of what ends the interval. The
    /// others are fitted, from `others`, which become the fitted ones.
    fn excess(&self, value: f64, others: &mut Vec<f64>) -> f64 {
        let model = |free: &[f64]| {
            let mut all = free.to_vec();
            all.insert(self.which, value);
            let mut residuals = self.model.residuals(&all)?;
            residuals.slopes.iter_mut().for_each(|row| {
                row.remove(self.which);
            });
            Some(residuals)
        };
        let sum = match others.is_empty() {
            true => model(&[]).map(|it: Residuals| it.values.iter().map(|it| it * it).sum::<f64>()),
            false => {
                let mut search = self.search.clone();
                search.bounds.remove(self.which);
                let fitted = fit_once(&model, others, &search, 1.0);
                let usable = fitted.filter(|it| it.termination != Termination::NoValue);
                usable.map(|fit| {
                    *others = fit.parameters;
                    fit.sum_of_squares
                })
            }
        };
        let allowed = student(self.best.degrees_of_freedom).powi(2) * self.best.sum_of_squares
            / self.best.degrees_of_freedom as f64;
        sum.map_or(f64::INFINITY, |sum| (sum - self.best.sum_of_squares) / allowed)
    }

    fn others(&self, parameters: &[f64]) -> Vec<f64> {
        let mut others = parameters.to_vec();
        others.remove(self.which);
        others
    }
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
            let profile = profile(&model, &best, &search, which);
            let reach = student(18) * best.standard_error(which);
            let [least, greatest] = profile.interval.map(|it| it - best.parameters[which]);
            assert!((least / -reach - 1.0).abs() < 2e-3, "{least} {reach}");
            assert!((greatest / reach - 1.0).abs() < 2e-3, "{greatest} {reach}");
            assert_eq!(profile.verdict(), Verdict::Determined);
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
