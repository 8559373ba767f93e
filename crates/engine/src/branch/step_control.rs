//! Steps along a curve of solutions: as long as its bends allow, and no farther than its bounds.

use super::arclength::{
    CurvePoint, Equations, FARTHEST, Guess, Plane, between, corrected_within, dot, moved, norm,
};

/// Usually a shorter step, relative to the longest, is none.
const SHORTEST: f64 = 1e-8;
/// Below this share of the longest step the curve may turn by anything short of a right angle.
const CORNER: f64 = 1e-3;
/// Cosine of the largest turn in a longer step.
const LEAST_COSINE: f64 = 0.95;
/// The correction may be so large, relative to the step: a long one, and one round a corner.
const CORRECTIONS: [f64; 2] = [0.35, 3.0];
/// Newton's method that moves an unknown farther than so many times that does not come back.
const ASTRAY: f64 = 10.0;
/// Newton's steps up to which the next step is lengthened, and from which it is shortened.
const EASY_AND_HARD: [usize; 2] = [4, 7];
const LENGTHEN: f64 = 1.6;
const SHORTEN: f64 = 0.5;

/// The range of each unknown.
#[derive(Debug, Clone, Copy)]
pub struct Bounds<const U: usize> {
    /// Least values.
    pub low: [f64; U],
    /// Greatest values.
    pub high: [f64; U],
}

impl<const U: usize> Bounds<U> {
    /// No bounds.
    pub fn none() -> Self {
        Bounds { low: [f64::NEG_INFINITY; U], high: [f64::INFINITY; U] }
    }

    /// The same with bounds on one unknown.
    pub fn with(mut self, unknown: usize, [low, high]: [f64; 2]) -> Self {
        (self.low[unknown], self.high[unknown]) = (low, high);
        self
    }

    /// The first bound that a move from `from` passes: the unknown, its value, and the share of the move.
    fn passed(&self, from: &[f64; U], to: &[f64; U]) -> Option<(usize, f64, f64)> {
        let passed = (0..U).filter_map(|i| {
            let bound = if to[i] < from[i] { self.low[i] } else { self.high[i] };
            let beyond = if to[i] < from[i] { to[i] <= bound } else { to[i] >= bound };
            let share = (bound - from[i]) / (to[i] - from[i]);
            (beyond && bound.is_finite() && to[i] != from[i]).then_some((i, bound, share))
        });
        passed.min_by(|a, b| a.2.total_cmp(&b.2))
    }
}

/// Where a step leads.
#[derive(Debug, Clone)]
pub enum Advance<S> {
    /// To a solution within the bounds.
    Inside(S),
    /// To the solution at a bound.
    AtBound(S),
    /// Nowhere: even the shortest step fails.
    Nowhere,
}

/// The length of steps along a curve.
#[derive(Debug, Clone, Copy)]
pub struct StepControl<const U: usize> {
    /// Where it ends.
    pub bounds: Bounds<U>,
    /// The longest step.
    pub longest: f64,
    /// The next step.
    pub next: f64,
    /// The last step.
    pub last: f64,
    /// A shorter step, relative to the longest, is none.
    pub shortest: f64,
    /// An easy step is followed by one longer by this factor.
    pub lengthen: f64,
}

type Met<const U: usize, E> = CurvePoint<U, <E as Equations<U>>::Seen>;

impl<const U: usize> StepControl<U> {
    /// A walk that begins with small steps.
    pub fn new(bounds: Bounds<U>, longest: f64) -> Self {
        StepControl {
            bounds,
            longest,
            next: 0.1 * longest,
            last: 0.0,
            shortest: SHORTEST,
            lengthen: LENGTHEN,
        }
    }

    /// The next solution along the tangent.
    ///
    /// A step that fails, or turns too sharply, is halved until it is shorter than the shortest. A curve with a corner is followed round it where the turn is below a right angle.
    pub fn advance<E: Equations<U>>(
        &mut self,
        equations: &E,
        from: &Met<U, E>,
    ) -> Advance<Met<U, E>> {
        while self.next >= self.shortest * self.longest {
            match self.attempt(equations, from, self.next) {
                Some((advance, taken)) => {
                    self.last = self.next;
                    if taken <= EASY_AND_HARD[0] {
                        self.next = (self.next * self.lengthen).min(self.longest);
                    } else if taken >= EASY_AND_HARD[1] {
                        self.next *= SHORTEN;
                    }
                    return advance;
                }
                None => self.next *= SHORTEN,
            }
        }
        self.next = CORNER * self.longest;
        Advance::Nowhere
    }

    /// Halves the last step, which is to be taken again; none where it is shorter than this share of the longest.
    pub fn halve(&mut self, least: f64) -> Option<()> {
        (self.last > least * self.longest).then(|| self.next = SHORTEN * self.last)
    }

    /// The solution one step of this length along the tangent, and the steps of Newton that it took.
    pub fn attempt<E: Equations<U>>(
        &self,
        equations: &E,
        from: &Met<U, E>,
        length: f64,
    ) -> Option<(Advance<Met<U, E>>, usize)> {
        let predicted = moved(&from.at, length, &from.tangent);
        let farthest = FARTHEST.min(ASTRAY * self.correction(length));
        if self.bounds.passed(&from.at, &predicted).is_none() {
            let plane = Plane::through(&predicted, from.tangent);
            let guess = Guess { at: &predicted, farthest };
            let (met, taken) = corrected_within(equations, &plane, guess, &from.tangent)?;
            if !self.is_near(from, &predicted, &met, length) || !equations.belongs(from, &met) {
                return None;
            }
            if self.bounds.passed(&from.at, &met.at).is_none() {
                return Some((Advance::Inside(met), taken));
            }
        }
        let (unknown, bound, share) = self.bounds.passed(&from.at, &predicted)?;
        let guess = moved(&from.at, share * length, &from.tangent);
        let plane = Plane::fixing(unknown, bound);
        let begins = Guess { at: &guess, farthest };
        let reached = corrected_within(equations, &plane, begins, &from.tangent);
        let (mut met, taken) = reached?;
        met.at[unknown] = bound;
        let near = self.is_near(from, &guess, &met, length) && equations.belongs(from, &met);
        near.then_some((Advance::AtBound(met), taken))
    }

    /// The correction may be so large for a step of this length.
    fn correction(&self, length: f64) -> f64 {
        let [long, round_a_corner] = CORRECTIONS;
        let allowed = if length > CORNER * self.longest { long } else { round_a_corner };
        allowed * length
    }

    /// Whether a solution is the one that was predicted rather than another.
    fn is_near<T>(
        &self,
        from: &CurvePoint<U, T>,
        predicted: &[f64; U],
        met: &CurvePoint<U, T>,
        length: f64,
    ) -> bool {
        let tight = length > CORNER * self.longest;
        let correction = norm(&between(predicted, &met.at));
        let straight = dot(&from.tangent, &met.tangent) > if tight { LEAST_COSINE } else { 0.0 };
        let ahead = dot(&from.tangent, &between(&from.at, &met.at)) >= 0.0;
        straight && ahead && correction <= self.correction(length)
    }
}
