//! The refined front as a curve: from one of its motions to the next, price by price.

use serde_json::{Value, json};

use super::error::CampaignError;
use super::refined_front::Refinement;
use super::refined_motion::{Led, RefinedMotion};
use crate::model::Setting;
use crate::tradeoff::best;

/// Neighbours on the front differ in price by no more than the range of prices over this.
const PARTS: f64 = 64.0;
/// From so many motions other prices are sought, at most.
const LADDERS: usize = 24;
/// Prices over the whole range of the front.
const RUNGS: usize = 6;
/// Prices below the cheapest, each this share of the one before; a motion is followed until there is none for the price.
const BELOW: f64 = 0.85;
const LOWER: i32 = 12;
/// So many motions on either side of the budget are followed to it.
const BESIDE: usize = 8;
/// A price is kept to this share.
const KEEPS: f64 = 1e-8;

/// Prices between a motion of the front and one beside it, in order from it.
#[derive(Debug, Clone, PartialEq)]
pub struct Gap<'a> {
    from: &'a RefinedMotion,
    prices: Vec<f64>,
}

impl Refinement<'_> {
    /// The gaps of a front of prices, each with its motion if that is a refined one, by rising price: from the motion
    /// before a gap to the one behind it, and back.
    pub fn gaps<'m>(&self, front: &[(f64, Option<&'m RefinedMotion>)]) -> Vec<Gap<'m>> {
        let [(first, _), .., (last, _)] = front else { return Vec::new() };
        let widest = (last - first) / PARTS;
        let all = front.windows(2).flat_map(|pair| {
            let rising = prices_between(pair[0].0, pair[1].0, widest);
            let falling = rising.iter().rev().copied().collect();
            [(pair[0].1, rising), (pair[1].1, falling)]
        });
        all.filter(|(_, prices)| !prices.is_empty())
            .filter_map(|(from, prices)| Some(Gap { from: from?, prices }))
            .collect()
    }

    /// From motions found, beside or behind the front, to prices over the whole range of it: a family that is behind the front at one price
    /// may be the best at another.
    ///
    /// The motions are those nearest to the front by the gain at their price, at most `LADDERS`; the prices are `RUNGS` from the
    /// cheapest to the dearest of all, each as many times dearer than the one before, and lower ones down to a seventh of the cheapest.
    pub fn ladders<'m>(&self, front: &[(f64, f64)], found: &'m [RefinedMotion]) -> Vec<Gap<'m>> {
        let known = front.iter().map(|it| it.0);
        let known = known.chain(found.iter().map(|it| it.outputs[self.of.cost]));
        let known = known.filter(|it| it.is_finite() && *it > 0.0);
        let [low, high] =
            known.fold([f64::INFINITY, 0.0_f64], |[low, high], it| [low.min(it), high.max(it)]);
        let mut nearest: Vec<&RefinedMotion> = found.iter().collect();
        nearest.sort_by(|a, b| {
            self.share_of_front(b, front).total_cmp(&self.share_of_front(a, front))
        });
        nearest.truncate(LADDERS);
        let rungs = rungs(low, high);
        let ladders = nearest.into_iter().flat_map(|from| {
            let (below, above): (Vec<f64>, Vec<f64>) =
                rungs.iter().partition(|rung| **rung < from.outputs[self.of.cost]);
            [below.into_iter().rev().collect(), above].map(|prices| Gap { from, prices })
        });
        ladders.filter(|gap| !gap.prices.is_empty()).collect()
    }

    /// From the motions found whose prices are nearest to the budget, some below it and some above, to the budget itself: the most that
    /// may be had for it lies between two motions of the front, as a rule. None without a budget.
    pub fn at_budget<'m>(&self, found: &'m [RefinedMotion]) -> Vec<Gap<'m>> {
        // A motion that is found may be dearer than its price by what a price is kept to.
        let Some(price) = self.budget.map(|most| most * (1.0 - 2.0 * KEEPS)) else {
            return Vec::new();
        };
        let apart = |it: &RefinedMotion| (it.outputs[self.of.cost] - price).abs();
        let (mut below, mut above): (Vec<&RefinedMotion>, Vec<&RefinedMotion>) =
            found.iter().partition(|it| it.outputs[self.of.cost] <= price);
        let nearest = [&mut below, &mut above].into_iter().flat_map(|side| {
            side.sort_by(|a, b| apart(a).total_cmp(&apart(b)));
            side.truncate(BESIDE);
            side.drain(..)
        });
        nearest.map(|from| Gap { from, prices: vec![price] }).collect()
    }

    /// The gain of a motion as a share of that of the front of prices and gains at its price; infinite where the front has none for it.
    fn share_of_front(&self, motion: &RefinedMotion, front: &[(f64, f64)]) -> f64 {
        let price = motion.outputs[self.of.cost];
        let last = front.partition_point(|of_front| of_front.0 <= price);
        let gain = self.direction.of(motion.outputs[self.of.gain]);
        last.checked_sub(1).map_or(f64::INFINITY, |last| gain / front[last].1)
    }

    /// The motions that are followed into gaps of the front, in their order; calls `done` after each gap.
    ///
    /// # Method
    ///
    /// At each price the motion with the most gain is sought as in [`best`], from the one before. Each gap is by itself: neither threads
    /// nor order matter. Where the front is of several families, each is followed beyond where it is the best.
    ///
    /// Fails if the threads cannot be started.
    pub fn followed(
        &self,
        gaps: &[Gap<'_>],
        threads: Option<usize>,
        done: impl Fn() + Sync,
    ) -> Result<Led, CampaignError> {
        self.each(threads, gaps.len(), done, |number| {
            let gap = &gaps[number];
            self.kept.kept_or_found(&self.described_gap(gap), || Ok(self.follow(gap)))
        })
    }

    /// What is found in a gap depends on this, beside the results.
    fn described_gap(&self, Gap { from, prices }: &Gap<'_>) -> Value {
        let values: Vec<f64> = from.parameters.each().map(|(_, value)| value).collect();
        self.keyed(json!({
            "from": from.from,
            "moving": self.direction.name(),
            "of": self.of.cost.name(),
            "parameters": values,
            "at": from.phase,
            "begins_at": from.section,
            "cycles_of_period": from.period,
            "prices": prices,
        }))
    }

    fn follow(&self, gap: &Gap<'_>) -> Led {
        let from = gap.from;
        let setting = Setting { parameters: from.parameters.clone(), phase: from.phase };
        let family = self.family_of(setting, from.period);
        let mut last = family.orbit(&family.shares(), &from.section);
        let mut led = Led::default();
        for price in &gap.prices {
            let Some(at) = last else { break };
            let found = best(&family, at, self.most(Some(*price)));
            let kept = found.filter(|it| it.at.outputs[self.of.cost] <= price * (1.0 + KEEPS));
            kept.iter().for_each(|it| led.add(self.settled(&family, it, from.from)));
            last = kept.map(|it| it.at);
        }
        led
    }
}

/// Prices between two, evenly spaced by no more than the widest gap that is allowed.
fn prices_between(low: f64, high: f64, widest: f64) -> Vec<f64> {
    let parts = ((high - low) / widest).ceil() as usize;
    (1..parts).map(|part| low + (high - low) * part as f64 / parts as f64).collect()
}

/// Prices below a range and over it, in rising order; none of an empty range.
fn rungs(low: f64, high: f64) -> Vec<f64> {
    let below = (1..=LOWER).rev().map(|number| low * BELOW.powi(number));
    let within =
        (0..RUNGS).map(|number| low * (high / low).powf(number as f64 / (RUNGS - 1) as f64));
    if high > low { below.chain(within).collect() } else { Vec::new() }
}
