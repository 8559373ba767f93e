//! Points of codimension 2 on a curve in two parameters: test functions that change their sign there.

use crate::flow::System;
use crate::orbit::matrix::{Complex, Matrix, determinant, dot, eigenvalues, solve};

use super::Codim2Kind::{self, *};
use super::SpecialKind;
use super::arc::Arc;
use super::arclength::{Plane, between, corrected, unit};
use super::bialternate::{others_less, pair_sum, torus, turns};
use super::family::counterpart;
use super::locus::{Locus, LocusPoint};
use super::orbits::shifted;

/// A test function that stays below this is zero to rounding, whatever its sign.
const ROUNDING: f64 = 1e-10;
/// The vector of the multiplier one is found with the inverse of J - (1 - e) I, e being this.
const BESIDE: f64 = 1e-8;
/// A touch is looked for at this distance before it and at twice that, relative to the first coordinate: next to it on the side of
/// more impacts the derivatives of their times are rounding.
const MARGIN: f64 = 1e-7;
/// How often that inverse is applied; each time the other directions shrink about as much.
const ITERATIONS: usize = 4;

/// A point of codimension 2.
#[derive(Debug, Clone)]
pub struct Met<const W: usize> {
    /// What happens there.
    pub kind: Codim2Kind,
    /// The unknowns there; of one that is unresolved those of the point where the step begins.
    pub at: [f64; W],
    /// The multipliers, the largest magnitude first.
    pub multipliers: Vec<Complex>,
    /// The solution of the equations of the curve there.
    pub point: LocusPoint<W>,
}

/// Those between two neighbouring points of a curve, in order; `jumps` where an event passes the instant of the section between them.
///
/// Method: a test function that has other signs at the two is brought to zero along the curve by the secant, to rounding. Where an
/// extremum touches, two orbits are found before it does, and the line through both leads to the surface, with an error of second order
/// in the margin.
/// Guarantees: a sign that changes is told, as `Unresolved` where the test jumps or no zero is found.
/// Breaks: two zeros of one test function within a step hide each other.
pub fn met<M: System<D>, const D: usize, const W: usize>(
    locus: &Locus<M, D, W>,
    ends: [&LocusPoint<W>; 2],
    jumps: bool,
) -> Vec<Met<W>> {
    let [from, to] = ends;
    let mut found: Vec<Met<W>> = Vec::new();
    for test in Test::all(locus, from, jumps) {
        let [before, beyond] = [from, to].map(|point| test.value(point, 0.0));
        let changes = before * beyond < 0.0 && before.abs().max(beyond.abs()) > ROUNDING;
        if !changes {
            continue;
        }
        match test.located(ends) {
            Some(met) if test.holds(&met.multipliers) => found.push(met),
            Some(_) => {}
            None => found.push(Met {
                kind: Unresolved,
                at: from.at,
                multipliers: multipliers(&Locus::<M, D, W>::jacobian(from)),
                point: from.clone(),
            }),
        }
    }
    let along = |met: &Met<W>| dot(&from.tangent, &between(&from.at, &met.point.at));
    found.sort_by(|a, b| along(a).total_cmp(&along(b)));
    found
}

/// The sum of the pair of multipliers with the product one, at a Neimark-Sacker point: twice the cosine of their angle.
pub fn sum_of_pair<M: System<D>, const D: usize, const W: usize>(point: &LocusPoint<W>) -> f64 {
    pair_sum(&Locus::<M, D, W>::jacobian(point))
}

fn multipliers<const D: usize>(jacobian: &Matrix<D>) -> Vec<Complex> {
    eigenvalues(jacobian).to_vec()
}

/// The kinds on a curve that the multipliers tell.
fn told_by_multipliers(on: SpecialKind) -> &'static [Codim2Kind] {
    match on {
        SpecialKind::Fold => &[Resonance1, FoldFlip, FoldNeimarkSacker],
        SpecialKind::PeriodDoubling => &[Resonance2, FoldFlip, FlipNeimarkSacker],
        SpecialKind::NeimarkSacker => {
            &[Resonance1, Resonance2, Resonance3, Resonance4, FoldNeimarkSacker, FlipNeimarkSacker]
        }
        _ => &[FoldGrazing, DoublingGrazing, NeimarkSackerGrazing],
    }
}

/// What happens where an extremum touches its surface on a curve, and another already does on a curve of grazings.
fn touch_on(on: SpecialKind) -> Codim2Kind {
    match on {
        SpecialKind::Fold => FoldGrazing,
        SpecialKind::PeriodDoubling => DoublingGrazing,
        SpecialKind::NeimarkSacker => NeimarkSackerGrazing,
        _ => DoubleGrazing,
    }
}

/// A function of an orbit on a curve that vanishes at a point of codimension 2.
struct Test<'p, M: System<D>, const D: usize, const W: usize> {
    locus: &'p Locus<M, D, W>,
    kind: Codim2Kind,
    of: Function<'p, D>,
}

/// What a test is a function of.
enum Function<'p, const D: usize> {
    /// The derivative of det(J - I) along the vector of the multiplier one, which is on the side of this one.
    AlongNull([f64; D]),
    /// The multipliers.
    Multipliers,
    /// The distance of this extremum among those of the point at which the step begins.
    Margin((f64, f64), &'p [(f64, f64)]),
}

impl<'p, M: System<D>, const D: usize, const W: usize> Test<'p, M, D, W> {
    /// All of a step.
    fn all(locus: &'p Locus<M, D, W>, from: &'p LocusPoint<W>, jumps: bool) -> Vec<Self> {
        let mut tests = Vec::new();
        // Across a jump of the section point the sides of the vectors cannot be compared.
        if locus.kind == SpecialKind::Fold && !jumps {
            let null = null_vector(&Locus::<M, D, W>::jacobian(from));
            tests.extend(null.map(|it| Test { locus, kind: Cusp, of: Function::AlongNull(it) }));
        }
        // One multiplier or a pair is that of the curve, and a pair more needs three.
        let told = told_by_multipliers(locus.kind)
            .iter()
            .filter(|kind| D > 2 || !matches!(kind, FoldNeimarkSacker | FlipNeimarkSacker));
        tests.extend(told.map(|&kind| Test { locus, kind, of: Function::Multipliers }));
        let own = from.seen.touch.map(|touch| touch.time);
        let others = from.seen.margins.iter().filter(|it| Some(it.0) != own);
        tests.extend(others.map(|&extremum| Test {
            locus,
            kind: touch_on(locus.kind),
            of: Function::Margin(extremum, &from.seen.margins),
        }));
        tests
    }

    /// The value, of a distance less `margin`; not a number where it is not defined.
    fn value(&self, point: &LocusPoint<W>, margin: f64) -> f64 {
        match &self.of {
            Function::AlongNull(ahead) => {
                let null = null_vector(&Locus::<M, D, W>::jacobian(point));
                null.map_or(f64::NAN, |null| {
                    let slope: f64 = null.iter().zip(&point.rows[D]).map(|(v, by)| v * by).sum();
                    slope * dot(&null, ahead).signum()
                })
            }
            Function::Multipliers => self.of_multipliers(&Locus::<M, D, W>::jacobian(point)),
            Function::Margin(extremum, margins) => {
                let sides = [*margins, &point.seen.margins[..]];
                let other = counterpart(extremum, sides, self.locus.family.period);
                other.map_or(f64::NAN, |it| it.1 - margin)
            }
        }
    }

    /// A product of the multipliers that are not those of the curve, or the angle of its pair.
    ///
    /// A product over pairs is divided by what those with a multiplier of the curve give, so that it keeps its sign there.
    fn of_multipliers(&self, j: &Matrix<D>) -> f64 {
        let [at_one, at_minus_one] = [-1.0, 1.0].map(|by| determinant(shifted(j, by)));
        match (self.locus.kind, self.kind) {
            (SpecialKind::Fold, Resonance1) => others_less(j, 1.0),
            (SpecialKind::Fold, FoldNeimarkSacker) => torus(j) / others_less(j, 1.0),
            (SpecialKind::PeriodDoubling, Resonance2) => others_less(j, -1.0),
            (SpecialKind::PeriodDoubling, FlipNeimarkSacker) => torus(j) / others_less(j, -1.0),
            (SpecialKind::NeimarkSacker, Resonance1) => pair_sum(j) - 2.0,
            (SpecialKind::NeimarkSacker, Resonance2) => pair_sum(j) + 2.0,
            (SpecialKind::NeimarkSacker, Resonance3) => pair_sum(j) + 1.0,
            (SpecialKind::NeimarkSacker, Resonance4) => pair_sum(j),
            (SpecialKind::NeimarkSacker, FoldNeimarkSacker) => at_one / (2.0 - pair_sum(j)),
            (SpecialKind::NeimarkSacker, FlipNeimarkSacker) => at_minus_one / (2.0 + pair_sum(j)),
            (SpecialKind::Fold, FoldFlip) | (_, DoublingGrazing) => at_minus_one,
            (_, NeimarkSackerGrazing) => torus(j),
            _ => at_one,
        }
    }

    /// Whether the point is what it is called: a pair of multipliers with the product one is complex.
    fn holds(&self, multipliers: &[Complex]) -> bool {
        let is_of_pair =
            matches!(self.kind, FoldNeimarkSacker | FlipNeimarkSacker | NeimarkSackerGrazing);
        !is_of_pair || turns(multipliers)
    }

    /// The point of codimension 2 between two points of the curve.
    fn located(&self, ends: [&LocusPoint<W>; 2]) -> Option<Met<W>> {
        let kind = self.kind;
        let margin = self.margin(ends);
        if self.locus.margin == 0.0 && margin == 0.0 {
            let point = self.zero(self.locus, ends, 0.0)?;
            let multipliers = multipliers(&Locus::<M, D, W>::jacobian(&point));
            return Some(Met { kind, at: point.at, multipliers, point });
        }
        // Where another extremum touches, too, only its time tells the one that the curve is of.
        let touches_near = ends[0].seen.touch.map(|touch| touch.time);
        let once = Locus { touches_near, ..self.locus.clone() };
        let twice = Locus { margin: 2.0 * once.margin, ..once.clone() };
        let point = self.zero(&once, beside(&once, ends)?.each_ref(), margin)?;
        let farther = self.zero(&twice, beside(&twice, ends)?.each_ref(), 2.0 * margin)?;
        let at = std::array::from_fn(|i| 2.0 * point.at[i] - farther.at[i]);
        let [near, far] = [&point, &farther].map(Locus::<M, D, W>::jacobian);
        let jacobian: Matrix<D> =
            std::array::from_fn(|i| std::array::from_fn(|k| 2.0 * near[i][k] - far[i][k]));
        Some(Met { kind, at, multipliers: multipliers(&jacobian), point })
    }

    /// The distance of an extremum that is about to touch, on the side of fewer impacts; zero of what is no touch.
    fn margin(&self, ends: [&LocusPoint<W>; 2]) -> f64 {
        let Function::Margin(..) = self.of else { return 0.0 };
        let [from, to] = ends;
        let smooth = if to.seen.impacts < from.seen.impacts { to } else { from };
        let equal = to.seen.impacts == from.seen.impacts;
        if equal { MARGIN } else { MARGIN.copysign(self.value(smooth, 0.0)) }
    }

    /// Where the test vanishes between two points of a curve.
    fn zero(
        &self,
        locus: &Locus<M, D, W>,
        ends: [&LocusPoint<W>; 2],
        margin: f64,
    ) -> Option<LocusPoint<W>> {
        let arc = Arc::from(locus, ends[0]);
        let [from, to] = ends.map(|it| arc.place(it));
        let ((_, point), _) = arc.zero([&from, &to], |it| self.value(it, margin))?;
        Some(point)
    }
}

/// Two points of a curve as points of another next to it.
fn beside<M: System<D>, const D: usize, const W: usize>(
    locus: &Locus<M, D, W>,
    ends: [&LocusPoint<W>; 2],
) -> Option<[LocusPoint<W>; 2]> {
    let [from, to] = ends.map(|it| {
        let plane = Plane::through(&it.at, it.tangent);
        corrected(locus, &plane, &it.at, &it.tangent).map(|(point, _)| point)
    });
    Some([from?, to?])
}

/// The unit vector of the multiplier one of an orbit that has it.
///
/// Method: inverse iteration. Guarantees: an error of the order of rounding over the distance of the other multipliers from one.
fn null_vector<const D: usize>(jacobian: &Matrix<D>) -> Option<[f64; D]> {
    let beside = shifted(jacobian, BESIDE - 1.0);
    let mut vector = std::array::from_fn(|i| 1.0 + i as f64);
    for _ in 0..ITERATIONS {
        vector = unit(&solve(beside, vector)?);
    }
    Some(vector)
}
