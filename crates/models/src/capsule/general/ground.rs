//! What the ground does to the capsule: friction and drag that differ by direction, a slope, and a load.

use capsulemap_engine::lane::elementary::sin_cos;
use capsulemap_engine::lane::{Lane, Series, series, side_by_side};

use super::folds::AtPlace;
use crate::capsule::drag::Drag;
use crate::capsule::parameter::Parameter;
use crate::capsule::resistance::Resistance;
use crate::capsule::shape::Shape;

/// The [`COEFFICIENTS`](crate::capsule::drag::COEFFICIENTS) of forward and of backward motion.
const FORWARD: [Parameter; 4] =
    [Parameter::MuSForward, Parameter::MuDForward, Parameter::C1Forward, Parameter::C2Forward];
const BACKWARD: [Parameter; 4] =
    [Parameter::MuSBackward, Parameter::MuDBackward, Parameter::C1Backward, Parameter::C2Backward];

/// Friction and drag of each direction, and the forces along the ground that do not change.
#[derive(Debug, Clone, Copy)]
pub struct Ground<L> {
    /// The resistance to forward motion.
    pub forward: Drag<L>,
    /// The resistance to backward motion.
    pub backward: Drag<L>,
    /// The rise of friction towards rest, nu.
    stribeck: L,
    /// Gravity along the ground and load on the capsule, forward positive [N].
    pub push: L,
    /// Gravity along the ground on the mass, forward positive [N].
    pub pull: L,
    has_drag: bool,
    has_sides: bool,
}

side_by_side!(Ground { stribeck, push, pull } with { forward, backward } alike { has_drag, has_sides });

impl<L: Lane> Ground<L> {
    /// That of these parameters.
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape) -> Self {
        let zero = L::splat(0.0);
        let given = |it| if shape.has(it) { of(it) } else { zero };
        let (sin, cos) = match shape.has(Parameter::Incline) {
            true => sin_cos(of(Parameter::Incline)),
            false => (zero, L::splat(1.0)),
        };
        let [m1, m2, g] = [Parameter::M1, Parameter::M2, Parameter::G].map(&of);
        let load = (m1 + m2) * g * cos;
        let stribeck = match shape.law {
            Resistance::CoulombStribeck if shape.has(Parameter::Stribeck) => {
                of(Parameter::Stribeck)
            }
            Resistance::CoulombStribeck => L::splat(1.0),
            Resistance::Coulomb | Resistance::Medium => zero,
        };
        let onset = if shape.law == Resistance::Medium { zero } else { stribeck + L::splat(1.0) };
        let towards = |coefficients: [Parameter; 4]| {
            let [mut mu_s, mut mu_d, c1, c2] = coefficients.map(|it| of(shape.source(it)));
            if shape.law == Resistance::Medium {
                (mu_s, mu_d) = (zero, zero);
            }
            Drag::with([mu_s, mu_d, c1, c2], of(Parameter::Vs), shape.law, (load, onset))
        };
        Ground {
            forward: towards(FORWARD),
            backward: towards(BACKWARD),
            stribeck,
            push: given(Parameter::Load) - m2 * g * sin,
            pull: -(m1 * g * sin),
            has_drag: shape.has_drag(),
            has_sides: shape.has_any(&FORWARD) || shape.has_any(&BACKWARD),
        }
    }

    /// The even ground that a way with folds is like at one place.
    #[inline(always)]
    pub fn at(&self, place: &AtPlace<L>) -> Self {
        Ground {
            forward: self.forward.times(place.resists),
            backward: self.backward.times(place.resists),
            push: self.push + place.pushes,
            ..*self
        }
    }

    /// The resistance to sliding in a direction, forward where it is none.
    #[inline(always)]
    pub fn towards(&self, slip: L) -> Drag<L> {
        match self.has_sides {
            true => Drag::select(slip.lt(L::splat(0.0)), &self.backward, &self.forward),
            false => self.forward,
        }
    }

    /// The resistance to a speed in the direction `slip`; zero where that is none [N].
    #[inline(always)]
    pub fn resistance(&self, slip: L, y2: L) -> L {
        let (one, drag) = (L::splat(1.0), self.towards(slip));
        let dry = match drag.law {
            Resistance::CoulombStribeck => {
                slip * drag.dynamic * (one + self.stribeck * drag.decay_start(slip, y2))
            }
            Resistance::Coulomb => slip * drag.dynamic,
            Resistance::Medium => L::splat(0.0),
        };
        match self.has_drag {
            true => dry + drag.linear * y2 + drag.quadratic * slip * y2 * y2,
            false => dry,
        }
    }

    /// Coefficient `k` of the resistance to sliding in the direction `slip`, whose constants are those of `drag`.
    #[inline(always)]
    pub fn force_term(&self, drag: &Drag<L>, slip: L, [decay, y2]: [&Series<L>; 2], k: usize) -> L {
        let dry = self.dry_term(drag, slip, decay, k);
        match self.has_drag {
            true => dry + drag_term(drag, slip, y2, k),
            false => dry,
        }
    }

    /// The part of it that is dry friction.
    #[inline(always)]
    fn dry_term(&self, drag: &Drag<L>, slip: L, decay: &Series<L>, k: usize) -> L {
        let start = if k == 0 { L::splat(1.0) } else { L::splat(0.0) };
        let unit = match drag.law {
            Resistance::CoulombStribeck => start + self.stribeck * decay[k],
            Resistance::Coulomb => start,
            Resistance::Medium => L::splat(0.0),
        };
        drag.dynamic.scaled(slip.plain()) * unit
    }

    /// The part of the resistance that is drag, while the capsule slides in the direction `slip`.
    #[inline(always)]
    pub fn drag(&self, slip: L, y2: &Series<L>) -> Series<L> {
        let mut drag = series::zero();
        if self.has_drag {
            let constants = self.towards(slip);
            for (k, term) in drag.iter_mut().enumerate() {
                *term = drag_term(&constants, slip, y2, k);
            }
        }
        drag
    }
}

/// Coefficient `k` of a drag.
#[inline(always)]
fn drag_term<L: Lane>(drag: &Drag<L>, slip: L, y2: &Series<L>, k: usize) -> L {
    let square = series::product_term(y2, y2, k).scaled(slip.plain());
    drag.linear * y2[k] + drag.quadratic * square
}

impl Ground<f64> {
    /// The resistance to a motion with the direction `slip`, as the law is written [N].
    pub fn force(&self, slip: f64, y2: f64) -> f64 {
        let drag = if slip < 0.0 { &self.backward } else { &self.forward };
        let dry = match drag.law {
            Resistance::CoulombStribeck => {
                let decay = libm::exp(-y2.abs() * drag.inverse_stribeck);
                drag.dynamic * (1.0 + self.stribeck * decay)
            }
            Resistance::Coulomb => drag.dynamic,
            Resistance::Medium => 0.0,
        };
        slip * dry + drag.linear * y2 + drag.quadratic * slip * y2 * y2
    }
}
