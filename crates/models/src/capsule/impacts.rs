//! The impacts of a motion, side by side.

use capsulemap_engine::lane::{Lane, Mask, SideBySide, side_by_side};

/// A point of the impact section: where contact closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact<L> {
    /// Phase of the drive since the section, 0 to 2 pi [rad].
    pub phase: L,
    /// Velocity of the mass [m/s].
    pub y1: L,
    /// Velocity of the capsule [m/s].
    pub y2: L,
}

side_by_side!(Impact { phase, y1, y2 });

/// Impacts in the order in which they were met, each with the lanes that it was in, as bits.
#[derive(Debug, Clone, PartialEq)]
pub struct Impacts<L>(pub Vec<(u64, Impact<L>)>);

impl<L: Lane> SideBySide for Impacts<L> {
    type One = Impacts<f64>;

    #[inline(always)]
    fn splat(one: &Impacts<f64>) -> Self {
        let all = L::Mask::splat(true).bits();
        Impacts(one.0.iter().map(|(_, it)| (all, Impact::splat(it))).collect())
    }

    #[inline(always)]
    fn lane(&self, index: usize) -> Impacts<f64> {
        let here = self.0.iter().filter(|(lanes, _)| lanes >> index & 1 != 0);
        Impacts(here.map(|(_, it)| (1, it.lane(index))).collect())
    }

    #[inline(always)]
    fn put(&mut self, index: usize, one: &Impacts<f64>) {
        self.0.retain_mut(|(lanes, _)| {
            *lanes &= !(1 << index);
            *lanes != 0
        });
        self.0.extend(one.0.iter().map(|(_, it)| (1 << index, Impact::splat(it))));
    }

    #[inline(always)]
    fn take_lane(&mut self, index: usize, other: &Self) {
        self.put(index, &other.lane(index));
    }
}

impl Impacts<f64> {
    /// A number of each impact, in their order.
    pub fn column(&self, of: impl Fn(&Impact<f64>) -> f64) -> Vec<f64> {
        self.0.iter().map(|(_, impact)| of(impact)).collect()
    }
}
