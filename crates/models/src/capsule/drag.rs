//! What resists the capsule: dry friction by two laws, or a resistive medium.

use capsulemap_engine::lane::{
    Lane, Mask, ORDER, Series, elementary::exp_decay, series, side_by_side,
};

use super::parameter::Parameter;
use super::resistance::Resistance;
use super::state::Jet;

/// Far from rest a step may at least change |y2|/v_s by this much.
const NARROWEST: f64 = 2.0;
/// Chords by which the length of a step is approached at which |y2| has fallen by what is allowed.
const CHORDS: usize = 4;

/// A law of resistance with its constants.
#[derive(Debug, Clone, Copy)]
pub struct Drag<L> {
    /// The law.
    pub law: Resistance,
    /// `mu_d N`; a medium has no use for it [N].
    pub(super) dynamic: L,
    /// Force needed to leave rest, `f_b` [N].
    pub break_away: L,
    /// `f_s = mu_s N`, zero in a medium [N].
    pub static_limit: L,
    /// Resistance at vanishing speed, `f_d(0+)` [N].
    pub at_onset: L,
    /// `1/v_s` [s/m].
    pub(super) inverse_stribeck: L,
    /// Linear drag [N s/m].
    pub(super) linear: L,
    /// Quadratic drag [N s^2/m^2].
    pub(super) quadratic: L,
}

// Lanes share one law: the constants differ.
side_by_side!(Drag {
    dynamic, break_away, static_limit, at_onset, inverse_stribeck, linear, quadratic
} alike { law });

/// The coefficients of friction and drag, as those of one direction of sliding.
pub const COEFFICIENTS: [Parameter; 4] =
    [Parameter::MuS, Parameter::MuD, Parameter::C1, Parameter::C2];

impl<L: Lane> Drag<L> {
    /// The law with the constants of these parameters.
    ///
    /// Friction at vanishing speed is 2 mu_d N by the Coulomb-Stribeck law and mu_d N by Coulomb's, and rest ends at
    /// f_b = max(f_s, f_d(0+)): a capsule that left at less would be pushed straight back.
    pub fn new(of: impl Fn(Parameter) -> L, law: Resistance) -> Self {
        let load = (of(Parameter::M1) + of(Parameter::M2)) * of(Parameter::G);
        let onset = L::splat(law.onset_factor());
        Drag::with(COEFFICIENTS.map(&of), of(Parameter::Vs), law, (load, onset))
    }

    /// The law with these [`COEFFICIENTS`], this Stribeck velocity and normal load, whose friction at the onset of sliding is so many
    /// times mu_d N.
    pub fn with(
        [mu_s, mu_d, linear, quadratic]: [L; 4],
        v_s: L,
        law: Resistance,
        (load, onset): (L, L),
    ) -> Self {
        let of_rest = if law == Resistance::Medium { 0.0 } else { 1.0 };
        let static_limit = L::splat(of_rest) * mu_s * load;
        let at_onset = onset * mu_d * load;
        Drag {
            law,
            dynamic: mu_d * load,
            static_limit,
            at_onset,
            break_away: static_limit.max(at_onset),
            inverse_stribeck: L::splat(1.0) / v_s,
            linear,
            quadratic,
        }
    }

    /// That of either of two, in each lane; both of one law.
    #[inline(always)]
    pub fn select(mask: L::Mask, yes: &Self, no: &Self) -> Self {
        let of = |number: fn(&Self) -> L| L::select(mask, number(yes), number(no));
        Drag {
            law: yes.law,
            dynamic: of(|it| it.dynamic),
            static_limit: of(|it| it.static_limit),
            at_onset: of(|it| it.at_onset),
            break_away: of(|it| it.break_away),
            inverse_stribeck: of(|it| it.inverse_stribeck),
            linear: of(|it| it.linear),
            quadratic: of(|it| it.quadratic),
        }
    }

    /// The same law whose resistance is so many times as large.
    #[inline(always)]
    pub fn times(&self, factor: L) -> Self {
        Drag {
            law: self.law,
            dynamic: self.dynamic * factor,
            static_limit: self.static_limit * factor,
            at_onset: self.at_onset * factor,
            break_away: self.break_away * factor,
            inverse_stribeck: self.inverse_stribeck,
            linear: self.linear * factor,
            quadratic: self.quadratic * factor,
        }
    }

    /// How many leading coefficients of |y2| vanish when the capsule leaves rest at `f_b`.
    ///
    /// With a static limit above the dynamic friction the acceleration jumps (one); with none above
    /// it, it starts from zero and y2 leaves zero with a double root (two).
    #[inline(always)]
    pub fn onset_zeros(&self) -> L {
        L::select(self.at_onset.lt(self.break_away), L::splat(1.0), L::splat(2.0))
    }

    /// `exp(-|y2|/v_s)` at the start of a step in the direction `slip`; zero where the law has no such term.
    ///
    /// Where y2 is zero, as at a start, |y2| changes as y2 does to the side to which the motion slips: the derivatives of |y2| there are
    /// those of -y2 while it slips backward.
    #[inline(always)]
    pub fn decay_start(&self, slip: L, y2: L) -> L {
        let zero = L::splat(0.0);
        match self.law {
            Resistance::CoulombStribeck => {
                let backward = y2.lt(zero) | (y2.le(zero) & slip.lt(zero));
                exp_decay(-(L::select(backward, -y2, y2) * self.inverse_stribeck))
            }
            Resistance::Coulomb | Resistance::Medium => zero,
        }
    }

    /// Coefficient `k` of the resisting force while slipping in direction `slip` (+1 or -1).
    ///
    /// `decay` is the series of exp(-|y2|/v_s), known up to `k` like that of `y2`.
    #[inline(always)]
    pub fn force_term(&self, slip: L, decay: &Series<L>, y2: &Series<L>, k: usize) -> L {
        match self.law {
            Resistance::CoulombStribeck | Resistance::Coulomb => {
                let unit = if k == 0 { decay[0] + L::splat(1.0) } else { decay[k] };
                self.dynamic.scaled(slip.plain()) * unit
            }
            Resistance::Medium => {
                let square = series::product_term(y2, y2, k).scaled(slip.plain());
                self.linear * y2[k] + self.quadratic * square
            }
        }
    }

    /// The longest step within `length` over which the series of exp(-|y2|/v_s) has its value, for a motion
    /// with the direction `slip` and the velocity `y2`.
    ///
    /// With u = |y2|/v_s, u0 its value where the step begins, and U = -ln tolerance:
    ///
    /// Method: from u0 > U the step may last until u falls to U, or by `NARROWEST`, whichever is farther.
    /// |y2| falls by no more than D(h), the sum of those of its terms that are negative. D is convex, so that
    /// false position approaches the root of D(h) = allowed from the side of shorter steps.
    /// Guarantees: as long as u > U, exp(-u) is below the tolerance, and the error of the friction below
    /// mu_d N times the tolerance. A truncated series that is larger than that is so by its last terms; these
    /// are terms of y2, and the pace bounds them. From u0 <= U the terms of y2 show the exponential: for a
    /// change x of u those of order p are exp(-u0) x^p/(u0 p!) of |y2|, and where the last two are below the
    /// tolerance, so is the sum of all that follow, up to a factor of ten.
    /// Breaks: nothing is known of a law with another layer than the one around rest.
    #[inline(always)]
    pub fn step_bound(
        &self,
        slip: L,
        decay: &Series<L>,
        y2: &Series<L>,
        length: L::Plain,
        tolerance: f64,
    ) -> L::Plain {
        if self.law != Resistance::CoulombStribeck {
            return length;
        }
        let zero = L::Plain::splat(0.0);
        let (slip, dynamic) = (slip.plain(), self.dynamic.plain());
        let slides = zero.lt(slip * slip) & zero.lt(dynamic);
        let far = slides & decay[0].plain().lt(L::Plain::splat(tolerance));
        if !far.any() {
            return length;
        }
        // -ln 2 times the logarithm to base 2, which is known within 0.09.
        let edge = std::f64::consts::LN_2 * (0.09 - tolerance.rough_log());
        let speed = y2[0].plain().abs() * self.inverse_stribeck.plain();
        let fall = (speed - L::Plain::splat(edge)).max(L::Plain::splat(NARROWEST));
        let allowed = fall / self.inverse_stribeck.plain();
        let mut terms = [zero; ORDER + 1];
        for (term, y2) in terms.iter_mut().zip(y2).skip(1) {
            *term = zero.max(-(slip * y2.plain()));
        }
        let at_end = series::value(&terms, length);
        let cuts = far & allowed.lt(at_end);
        if !cuts.any() {
            return length;
        }
        let (mut low, mut at_low) = (zero, zero);
        for _ in 0..CHORDS {
            let share = (allowed - at_low) / (at_end - at_low);
            low = low + (length - low) * share;
            at_low = series::value(&terms, low);
        }
        L::Plain::select(cuts, low, length)
    }

    /// Writes coefficient `k` of -|y2|/v_s from that of y2; numbers without derivatives have no use for it.
    #[inline(always)]
    pub fn write_exponent_term(&self, slip: L, jet: &mut Jet<L>, k: usize) {
        if const { L::PARTS > 1 } {
            jet.exponent[k] = -(jet.y2[k].scaled(slip.plain()) * self.inverse_stribeck);
        }
    }

    /// Coefficient `k + 1` of exp(-|y2|/v_s), from `e' = -(slip/v_s) e y2'`.
    #[inline(always)]
    pub fn decay_term(&self, slip: L, jet: &Jet<L>, k: usize) -> L {
        match self.law {
            Resistance::CoulombStribeck => {
                let factor = -(self.inverse_stribeck.scaled(slip.plain()));
                L::exp_next(&jet.decay, &jet.acceleration, factor, &jet.exponent, k)
            }
            Resistance::Coulomb | Resistance::Medium => L::splat(0.0),
        }
    }

    /// Where there is a layer around rest, in which the resistance changes with the speed; none where the law has none.
    #[inline(always)]
    pub fn layer(&self) -> Option<L::Mask> {
        match self.law {
            Resistance::CoulombStribeck => Some(L::splat(0.0).lt(self.dynamic)),
            Resistance::Coulomb | Resistance::Medium => None,
        }
    }
}

impl Drag<f64> {
    /// The resistance to a motion with the direction `slip`, as the law is written [N].
    pub fn force(&self, slip: f64, y2: f64) -> f64 {
        match self.law {
            Resistance::CoulombStribeck => {
                slip * self.dynamic * (1.0 + libm::exp(-y2.abs() * self.inverse_stribeck))
            }
            Resistance::Coulomb => slip * self.dynamic,
            Resistance::Medium => self.linear * y2 + self.quadratic * slip * y2 * y2,
        }
    }
}
