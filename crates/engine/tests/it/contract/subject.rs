//! What the contract needs of a system: random cases over its box, and what may act on its map.

use capsulemap_engine::flow::System;
use capsulemap_engine::orbit::Case;

/// A system that the contract is checked on.
pub trait Subject<const D: usize>: System<D> {
    /// The parameters along which its map is differentiated.
    fn directions() -> Vec<Self::Parameter>;

    /// Random cases over the whole box that makes sense for it, all of them alike.
    fn draws(count: usize, seed: u64) -> Vec<Case<Self, D>>;

    /// Random cases over the part of the box where its motions are not so stiff that differences fail.
    fn rich_draws(count: usize, seed: u64) -> Vec<Case<Self, D>> {
        Self::draws(count, seed)
    }

    /// Whether a motion may start at a point of the section.
    fn may_start(&self, _point: &[f64; D]) -> bool {
        true
    }

    /// Of a hundred certified orbits, how many may lie where the map has a corner, so that small pushes are not answered as the
    /// multipliers say.
    const CORNERS: usize = 0;

    /// The size of the numbers that guard `which` is a small difference of, in the unit of the guard.
    fn terms(&self, which: usize, mode: &Self::Mode<f64>, state: &Self::State<f64>) -> f64;
}

/// The number of draws: `usual`, or the value of CASES.
pub fn count(usual: usize) -> usize {
    std::env::var("CASES").map_or(usual, |text| text.parse().expect("CASES is a number"))
}

/// The bits of points.
pub fn bits<const D: usize>(points: &[[f64; D]]) -> Vec<[u64; D]> {
    points.iter().map(|point| point.map(f64::to_bits)).collect()
}
