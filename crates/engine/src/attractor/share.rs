//! Which part of the starts leads to each attractor, and how well that is known.

/// What the start with some number leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Label {
    /// It has not been computed.
    Missing,
    /// No attractor is known that it leads to.
    Undecided,
    /// The attractor of this number.
    Attractor(u32),
}

/// The part of the starts that lead to an attractor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// So many starts.
    pub starts: usize,
    /// Their share of those that have been computed; starts whose attractor is not known count among these.
    pub value: f64,
    /// The standard error of the share; NaN of a grid of which starts are missing.
    pub error: f64,
    /// Wilson's interval at 95 percent, where the starts are drawn.
    pub interval: Option<[f64; 2]>,
}

/// The normal deviate of 95 percent.
const DEVIATE: f64 = 1.959_963_984_540_054;

/// The shares of `attractors` of so many starts that are drawn.
///
/// Error: that of a binomial. Of draws of low discrepancy it is an upper estimate where the boundary is smooth, as they
/// are spread more evenly than independent ones. Source of the interval: Wilson (1927).
pub fn shares_of_draws(
    starts: usize,
    label: impl Fn(usize) -> Label,
    attractors: usize,
) -> Vec<Share> {
    let (counts, all) = counted(starts, label, attractors);
    counts.into_iter().map(|starts| Share::of_draws(starts, all)).collect()
}

impl Share {
    /// That of so many of all draws.
    fn of_draws(starts: usize, all: usize) -> Share {
        let (n, p) = (all as f64, starts as f64 / all as f64);
        let square = DEVIATE * DEVIATE;
        let middle = (p + square / (2.0 * n)) / (1.0 + square / n);
        let spread = (p * (1.0 - p) / n + square / (4.0 * n * n)).sqrt();
        let half = DEVIATE * spread / (1.0 + square / n);
        let interval = Some([(middle - half).max(0.0), (middle + half).min(1.0)]);
        Share { starts, value: p, error: (p * (1.0 - p) / n).sqrt(), interval }
    }

    /// That of so many starts of a grid by their weight and the variance of it, where all have the weight `all`.
    fn of_grid(starts: usize, weight: f64, variance: f64, all: f64) -> Share {
        Share { starts, value: weight / all, error: variance.sqrt() / all, interval: None }
    }
}

/// The shares of `attractors` of the starts of a grid of this `shape`, the last axis fastest.
///
/// Error: each start stands for its cell, and counts as a draw from the labels of its neighbours along the axes and its
/// own. So only cells beside a boundary have an error, and that of a share falls with the cells along the boundary. Where starts are
/// missing there is none: those that have been computed lie together, and may lead elsewhere than the others.
pub fn shares_of_grid(
    shape: &[usize],
    label: impl Fn(usize) -> Label,
    attractors: usize,
) -> Vec<Share> {
    weighted_shares_of_grid(shape, label, attractors, |_| 1.0)
}

/// The same where each start has a `weight`, zero or above: the probability that a start which is drawn from a distribution lies in its
/// cell, or a multiple of it. All shares are NaN where no start that has been computed has any.
///
/// Error: that of [`shares_of_grid`], in which each start counts with the square of its weight.
/// Breaks: the error is too small where a few cells beside a boundary have most of the weight.
pub fn weighted_shares_of_grid(
    shape: &[usize],
    label: impl Fn(usize) -> Label,
    attractors: usize,
    weight: impl Fn(usize) -> f64,
) -> Vec<Share> {
    let starts = shape.iter().product();
    let (mut weights, mut variances) = (vec![0.0; attractors], vec![0.0; attractors]);
    let (mut all, mut is_missing) = (0.0, false);
    let mut near: Vec<Label> = Vec::new();
    for start in 0..starts {
        let own = match label(start) {
            Label::Missing => {
                is_missing = true;
                continue;
            }
            own => own,
        };
        let weight = weight(start);
        all += weight;
        if let Label::Attractor(number) = own {
            weights[number as usize] += weight;
        }
        see_neighbours(shape, start, &label, &mut near);
        if near.iter().all(|it| *it == near[0]) {
            continue;
        }
        let known = near.len() as f64;
        for (place, it) in near.iter().enumerate() {
            if let Label::Attractor(number) = it
                && !near[..place].contains(it)
            {
                let q = near.iter().filter(|other| *other == it).count() as f64 / known;
                variances[*number as usize] += weight * weight * q * (1.0 - q);
            }
        }
    }
    let (counts, _) = counted(starts, &label, attractors);
    let each = counts.into_iter().zip(weights).zip(variances);
    each.map(|((starts, weight), variance)| {
        let variance = if is_missing { f64::NAN } else { variance };
        Share::of_grid(starts, weight, variance, all)
    })
    .collect()
}

/// Sees the label of a start of a grid, and those of its neighbours along the axes.
fn see_neighbours(
    shape: &[usize],
    start: usize,
    label: impl Fn(usize) -> Label,
    near: &mut Vec<Label>,
) {
    near.clear();
    near.push(label(start));
    let mut spacing: usize = shape.iter().product();
    for &length in shape {
        spacing /= length;
        let at = start / spacing % length;
        near.extend((at > 0).then(|| label(start - spacing)));
        near.extend((at + 1 < length).then(|| label(start + spacing)));
    }
}

/// The starts of each attractor, and all that have been computed.
fn counted(
    starts: usize,
    label: impl Fn(usize) -> Label,
    attractors: usize,
) -> (Vec<usize>, usize) {
    let (mut counts, mut all) = (vec![0; attractors], 0);
    for start in 0..starts {
        match label(start) {
            Label::Missing => {}
            Label::Undecided => all += 1,
            Label::Attractor(number) => {
                all += 1;
                counts[number as usize] += 1;
            }
        }
    }
    (counts, all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_starts_do_not_count_and_undecided_ones_do() {
        let labels = [Label::Attractor(0), Label::Undecided, Label::Missing, Label::Attractor(1)];
        let shares = shares_of_draws(4, |start| labels[start], 2);
        assert_eq!(shares.iter().map(|it| it.starts).collect::<Vec<_>>(), [1, 1]);
        assert!(shares.iter().all(|it| (it.value - 1.0 / 3.0).abs() < 1e-15));
    }

    #[test]
    fn a_grid_of_which_starts_are_missing_has_no_errors() {
        // Of a grid of two halves three quarters are computed.
        let label = |start| match start {
            0..8 => Label::Attractor(0),
            8..12 => Label::Attractor(1),
            _ => Label::Missing,
        };
        let shares = shares_of_grid(&[4, 4], label, 2);
        assert_eq!(shares.iter().map(|it| it.starts).collect::<Vec<_>>(), [8, 4]);
        assert!(shares.iter().all(|it| it.error.is_nan()), "{shares:?}");
    }

    #[test]
    fn the_interval_is_wilsons() {
        // 10 of 100: the interval of the textbook.
        let label = |start| Label::Attractor(u32::from(start >= 10));
        let [low, high] = shares_of_draws(100, label, 2)[0].interval.expect("an interval");
        assert!((low - 0.05523).abs() < 1e-5 && (high - 0.17437).abs() < 1e-5, "{low} {high}");
    }

    #[test]
    fn the_error_of_a_grid_is_that_of_its_boundary() {
        // A disc: the area that cells count, against pi/4.
        for side in [50, 200, 800] {
            let label = |start: usize| {
                let at = |index: usize| (index as f64 + 0.5) / side as f64 * 2.0 - 1.0;
                let (x, y) = (at(start / side), at(start % side));
                Label::Attractor(u32::from(x * x + y * y < 1.0))
            };
            let share = shares_of_grid(&[side, side], label, 2)[1];
            let off = (share.value - std::f64::consts::FRAC_PI_4).abs();
            assert!(off < 3.0 * share.error, "{side}: {off:e} {share:?}");
            // So many cells of about 8 per unit of the side lie beside it.
            let expected = (0.4 * 4.0 * side as f64).sqrt() / (side * side) as f64;
            assert!(share.error > 0.5 * expected && share.error < 2.0 * expected, "{share:?}");
        }
    }
}
