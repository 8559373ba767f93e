//! The best of some motions, where speed has its price: the Pareto front, its knee, and the best within limits.

use super::front::{front, speed_at_rest};

/// Prices that differ by no more than this share differ by rounding.
const SAME_PRICE: f64 = 1e-12;

/// A motion that takes part in a trade-off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Its case.
    pub case: usize,
    /// Progression speed, negative backward [m/s].
    pub speed: f64,
    /// What the speed costs: an energy, a power or another output that should be small [SI].
    pub price: f64,
    /// Energy per metre of progression [J/m]; infinite where there is none, NaN where it is not known.
    pub energy_per_metre: f64,
}

/// Which motions a trade-off is between.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Those with positive speed.
    Forward,
    /// Those with negative speed.
    Backward,
    /// All, by the magnitude of their speed.
    Either,
}

impl Candidate {
    /// Whether its speed and its price are known.
    fn is_known(&self) -> bool {
        self.speed.is_finite() && self.price.is_finite()
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

    /// The speed in this direction [m/s]; negative against it.
    pub fn of(self, speed: f64) -> f64 {
        match self {
            Direction::Forward => speed,
            Direction::Backward => -speed,
            Direction::Either => speed.abs(),
        }
    }
}

/// The best motions in a direction, each by its place among the candidates.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Optima {
    /// Speed up to which a motion counts as at rest [m/s].
    pub at_rest: f64,
    /// The Pareto front, by rising price.
    pub front: Vec<usize>,
    /// The knee of the front; none of fewer than three motions.
    pub knee: Option<usize>,
    /// The fastest.
    pub fastest: Option<usize>,
    /// That with the least energy per metre.
    pub lowest_cost_of_transport: Option<usize>,
}

impl Optima {
    /// The front as prices and speeds in a direction, both rising.
    pub fn points(&self, candidates: &[Candidate], direction: Direction) -> Vec<(f64, f64)> {
        let front = self.front.iter().map(|&at| &candidates[at]);
        front.map(|it| (it.price, direction.of(it.speed))).collect()
    }

    /// The fastest for no more than a price.
    pub fn fastest_within(&self, candidates: &[Candidate], most: f64) -> Option<usize> {
        let last = self.front.partition_point(|&at| candidates[at].price <= most);
        last.checked_sub(1).map(|place| self.front[place])
    }

    /// The cheapest that is no slower than a speed in a direction [m/s].
    pub fn least_for(
        &self,
        candidates: &[Candidate],
        direction: Direction,
        least: f64,
    ) -> Option<usize> {
        let mut front = self.front.iter().copied();
        front.find(|&at| direction.of(candidates[at].speed) >= least)
    }
}

/// The motions that are not at rest, the fastest in a direction first.
pub fn fastest_first(candidates: &[Candidate], direction: Direction, at_rest: f64) -> Vec<usize> {
    let speeds: Vec<f64> = candidates.iter().map(|it| direction.of(it.speed)).collect();
    let mut moving: Vec<usize> = (0..speeds.len()).filter(|&at| speeds[at] > at_rest).collect();
    moving.sort_by(|&a, &b| speeds[b].total_cmp(&speeds[a]));
    moving
}

/// The best of some motions in a direction; those slower than `at_rest` [m/s] are not among them, or than
/// [`speed_at_rest`] if none is given.
///
/// # Method
///
/// The front is that of [`front`] without motions whose price is another's but for rounding, 1e-12, and that are slower. Its knee is the motion farthest from the straight line between the ends of the front, on the
/// side of more speed, with price and speed as shares of their ranges on the front (Das 1999); of several the cheapest.
///
/// # Breaks
///
/// The knee depends on the ends of the front, and so on what the study covers.
pub fn optima(candidates: &[Candidate], direction: Direction, at_rest: Option<f64>) -> Optima {
    let at_rest = at_rest.unwrap_or_else(|| speed_at_rest(candidates.iter().map(|it| it.speed)));
    let moving: Vec<usize> = (0..candidates.len())
        .filter(|&at| candidates[at].is_known() && direction.of(candidates[at].speed) > at_rest)
        .collect();
    let (prices, speeds): (Vec<f64>, Vec<f64>) =
        moving.iter().map(|&at| (candidates[at].price, direction.of(candidates[at].speed))).unzip();
    let front = without_rounding(front(&prices, &speeds), &prices);
    let points: Vec<(f64, f64)> = front.iter().map(|&at| (prices[at], speeds[at])).collect();
    let costs: Vec<f64> = candidates.iter().map(|it| it.energy_per_metre).collect();
    let with_cost = moving.iter().copied().filter(|&at| costs[at].is_finite());
    Optima {
        at_rest,
        knee: knee(&points).map(|at| moving[front[at]]),
        fastest: front.last().map(|&at| moving[at]),
        lowest_cost_of_transport: with_cost.min_by(|&a, &b| costs[a].total_cmp(&costs[b])),
        front: front.into_iter().map(|at| moving[at]).collect(),
    }
}

/// A front by rising price without motions that another is faster than and no dearer but for rounding.
fn without_rounding(front: Vec<usize>, prices: &[f64]) -> Vec<usize> {
    let counting = (0..front.len()).filter(|&place| {
        let next = front.get(place + 1).map(|&at| prices[at]);
        next.is_none_or(|next| next > prices[front[place]] * (1.0 + SAME_PRICE))
    });
    counting.map(|place| front[place]).collect()
}

/// The place of the knee of a front of prices and speeds, both rising.
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

/// The area of prices and speeds that a front dominates up to a dearest price, above a least speed.
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
