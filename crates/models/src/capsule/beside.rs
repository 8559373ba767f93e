//! What a motion of a member of the family costs beside friction and damper, and how it meets its rear stop.

use capsulemap_engine::flow::guard::Crossings;
use capsulemap_engine::lane::quadrature::{integral_of_product, values};
use capsulemap_engine::lane::{Lane, Mask, Series, series, side_by_side};

use super::locomotion::Parts;
use super::state::Jet;

/// Sums and extremes since a start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside<L> {
    /// Energy lost in the damping of the stops [J].
    pub contact_loss: L,
    /// What of the energy lost to the ground is lost to drag [J].
    pub drag_loss: L,
    /// How often the mass met the rear stop.
    pub rear_impacts: L,
    /// Largest force of the rear stop [N].
    pub rear_peak_force: L,
    /// Least distance between a local minimum of r and the rear stop [m]; infinite while there is none.
    pub rear_margin: L,
    /// Integral of the force of the folds over time, forward positive [N s].
    pub fold_impulse: L,
}

side_by_side!(Beside {
    contact_loss,
    drag_loss,
    fold_impulse,
    rear_impacts,
    rear_peak_force,
    rear_margin
});

impl<L: Lane> Beside<L> {
    /// Nothing seen yet.
    pub fn none() -> Self {
        let zero = L::splat(0.0);
        Beside {
            contact_loss: zero,
            drag_loss: zero,
            rear_impacts: zero,
            rear_peak_force: zero,
            rear_margin: L::splat(f64::INFINITY),
            fold_impulse: zero,
        }
    }

    /// Takes note of a local minimum of r where `is_minimum`; returns the distance to the rear stop everywhere [m].
    #[inline(always)]
    pub(super) fn meet_extremum(&mut self, is_minimum: L::Mask, r: L, parts: &Parts<L>) -> L {
        let margin = (r - parts.rear).abs();
        let nearest = self.rear_margin.min(margin);
        self.rear_margin = L::select(is_minimum, nearest, self.rear_margin);
        margin
    }

    /// Adds the losses of a step of this length [s]; returns the largest force of the front stop in it [N].
    #[inline(always)]
    pub(super) fn see(&mut self, jet: &Jet<L>, parts: &Parts<L>, length: L) -> L {
        let (y1, y2) = (values(&jet.y1, length), values(&jet.y2, length));
        let mut relative = y1;
        for (relative, y2) in relative.iter_mut().zip(&y2) {
            *relative = *relative - *y2;
        }
        let damped = parts.damping * integral_of_product(&relative, &relative, length);
        self.contact_loss = self.contact_loss + damped;
        let dragged = integral_of_product(&values(&parts.drag, length), &y2, length);
        self.drag_loss = self.drag_loss + dragged;
        self.fold_impulse = self.fold_impulse + series::integral(&parts.folds, length);
        self.rear_peak_force = self.rear_peak_force.max(peak(&parts.stops[1], length));
        peak(&parts.stops[0], length)
    }
}

/// The largest value of a force from the start of a step on, at the start or where it turns within the step.
#[inline(always)]
fn peak<L: Lane>(force: &Series<L>, length: L) -> L {
    let zero = L::splat(0.0);
    let all = L::Mask::splat(true);
    let passes = zero.lt(length);
    let mut peak = L::select(passes, force[0], zero);
    let rate = series::plain(&series::derivative(force));
    let mut turns = Crossings::new(&rate, length.plain(), passes);
    loop {
        let turn = turns.next(all);
        if !turn.found.any() {
            return peak;
        }
        let there = series::value(force, L::from_plain(turn.time));
        peak = L::select(turn.found & turn.falls, peak.max(there), peak);
    }
}
