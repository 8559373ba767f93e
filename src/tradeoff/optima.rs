//! The best of some motions, where a gain has its price: the Pareto front, its knee, and the best within limits.

use super::front::{front, speed_at_rest};

/// Prices that differ by no more than this share differ by rounding.
const SAME_PRICE: f64 = 1e-12;

/// A motion that takes part in a trade-off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Its case.
    pub case: usize,
    /// What it gains, as the progression speed, negative backward [SI].
    pub gain: f64,
    /// What the gain costs: an energy, a power or another output that should be small [SI].
    pub price: f64,
    /// The cost per gain, as the energy per metre of progression [SI]; infinite where there is no gain, NaN where it is not known.
    pub per_gain: f64,
}

/// Which motions a trade-off is between.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Those with a positive gain.
    Forward,
    /// Those with a negative gain.
    Backward,
    /// All, by the magnitude of their gain.
    Either,
}

impl Candidate {
    /// Whether its gain and its price are known.
    fn is_known(&self) -> bool {
        self.gain.is_finite() && self.price.is_finite()
    }
}

impl Direction {
    /// Each by its name.
    pub const NAMES: [(&'static str, Direction); 3] = [
        ("forward", Direction::Forward),
        ("backward", Direction::Backward),
        ("either", Direction::Either),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Direction::NAMES[self as usize].0
    }

    /// How motions in it move.
    pub fn adverb(self) -> &'static str {
        match self {
            Direction::Forward => "forward",
            Direction::Backward => "backward",
            Direction::Either => "either way",
        }
    }

    /// The gain in this direction (SI); negative against it.
    pub fn of(self, gain: f64) -> f64 {
        match self {
            Direction::Forward => gain,
            Direction::Backward => -gain,
            Direction::Either => gain.abs(),
        }
    }
}

/// The best motions in a direction, each by its place among the candidates.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Optima {
    /// Gain up to which a motion counts as one without gain, as at rest (SI).
    pub at_rest: f64,
    /// The Pareto front, by rising price.
    pub front: Vec<usize>,
    /// The knee of the front; none of fewer than three motions.
    pub knee: Option<usize>,
    /// That with the most gain.
    pub most_gain: Option<usize>,
    /// That with the least cost per gain.
    pub least_per_gain: Option<usize>,
}

impl Optima {
    /// The front as prices and gains in a direction, both rising.
    pub fn points(&self, candidates: &[Candidate], direction: Direction) -> Vec<(f64, f64)> {
        let front = self.front.iter().map(|&at| &candidates[at]);
        front.map(|it| (it.price, direction.of(it.gain))).collect()
    }

    /// The most gain for no more than a price.
    pub fn most_within(&self, candidates: &[Candidate], most: f64) -> Option<usize> {
        let last = self.front.partition_point(|&at| candidates[at].price <= most);
        last.checked_sub(1).map(|place| self.front[place])
    }

    /// The cheapest that gains no less than so much in a direction (SI).
    pub fn least_for(
        &self,
        candidates: &[Candidate],
        direction: Direction,
        least: f64,
    ) -> Option<usize> {
        let mut front = self.front.iter().copied();
        front.find(|&at| direction.of(candidates[at].gain) >= least)
    }
}

/// The motions that are not at rest, that with the most gain in a direction first.
pub fn most_first(candidates: &[Candidate], direction: Direction, at_rest: f64) -> Vec<usize> {
    let gains: Vec<f64> = candidates.iter().map(|it| direction.of(it.gain)).collect();
    let mut moving: Vec<usize> = (0..gains.len()).filter(|&at| gains[at] > at_rest).collect();
    moving.sort_by(|&a, &b| gains[b].total_cmp(&gains[a]));
    moving
}

/// The best of some motions in a direction; those that gain no more than `at_rest` (SI) are not among them, or than
/// [`speed_at_rest`] of their gains if none is given.
///
/// # Method
///
/// The front is that of [`front`] without motions whose price is another's but for rounding, 1e-12, and that gain less. Its knee is the motion farthest from the straight line between the ends of the front, on the
/// side of more gain, with price and gain as shares of their ranges on the front (Das 1999); of several the cheapest.
///
/// # Breaks
///
/// The knee depends on the ends of the front, and so on what the study covers.
pub fn optima(candidates: &[Candidate], direction: Direction, at_rest: Option<f64>) -> Optima {
    let at_rest = at_rest.unwrap_or_else(|| speed_at_rest(candidates.iter().map(|it| it.gain)));
    let moving: Vec<usize> = (0..candidates.len())
        .filter(|&at| candidates[at].is_known() && direction.of(candidates[at].gain) > at_rest)
        .collect();
    let (prices, gains): (Vec<f64>, Vec<f64>) =
        moving.iter().map(|&at| (candidates[at].price, direction.of(candidates[at].gain))).unzip();
    let front = without_rounding(front(&prices, &gains), &prices);
    let points: Vec<(f64, f64)> = front.iter().map(|&at| (prices[at], gains[at])).collect();
    let costs: Vec<f64> = candidates.iter().map(|it| it.per_gain).collect();
    let with_cost = moving.iter().copied().filter(|&at| costs[at].is_finite());
    Optima {
        at_rest,
        knee: knee(&points).map(|at| moving[front[at]]),
        most_gain: front.last().map(|&at| moving[at]),
        least_per_gain: with_cost.min_by(|&a, &b| costs[a].total_cmp(&costs[b])),
        front: front.into_iter().map(|at| moving[at]).collect(),
    }
}

/// A front by rising price without motions that another gains more than and is no dearer but for rounding.
fn without_rounding(front: Vec<usize>, prices: &[f64]) -> Vec<usize> {
    let counting = (0..front.len()).filter(|&place| {
        let next = front.get(place + 1).map(|&at| prices[at]);
        next.is_none_or(|next| next > prices[front[place]] * (1.0 + SAME_PRICE))
    });
    counting.map(|place| front[place]).collect()
}

/// The place of the knee of a front of prices and gains, both rising.
fn knee(front: &[(f64, f64)]) -> Option<usize> {
    let [(cheapest, slowest), .., (dearest, fastest)] = front else { return None };
    let heights = front.iter().map(|(price, speed)| {
        (speed - slowest) / (fastest - slowest) - (price - cheapest) / (dearest - cheapest)
    });
    let heights: Vec<f64> = heights.collect();
    let inner = 1..front.len() - 1;
    // Of those equally far the cheapest, which the last of equal ones is in reverse.
    inner.rev().max_by(|&a, &b| heights[a].total_cmp(&heights[b]))
}

/// The area of prices and gains that a front dominates up to a dearest price, above a least gain.
///
/// # Method
///
/// The sum of the rectangles below the stairs of the front; motions dearer than `dearest` or slower than `slowest` have none.
pub fn hypervolume(front: &[(f64, f64)], dearest: f64, slowest: f64) -> f64 {
    let inside: Vec<(f64, f64)> =
        front.iter().copied().filter(|it| it.0 < dearest && it.1 > slowest).collect();
    let ends = inside.iter().skip(1).map(|it| it.0).chain([dearest]);
    inside.iter().zip(ends).map(|((price, speed), end)| (end - price) * (speed - slowest)).sum()
}
