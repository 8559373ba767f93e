//! The branches of a study one after another, as they lie in a file: what referred within one refers to all.

use super::branch_columns::Row;
use crate::branch::{Codim2, Curve, End, SpecialKind};
use crate::description::Parameter;
use crate::motion::branch::Branch;
use crate::run::Continued;
use crate::study::Continuation;

/// A branch among all.
pub struct FlatBranch {
    /// The branch of the study that led to it.
    pub request: usize,
    /// The parameter in which it is continued.
    pub along: Parameter,
    /// Period of its orbits [cycles].
    pub period: u64,
    /// The branch that it left, and the special point at which it did.
    pub parent: Option<(i64, i64)>,
    /// Why it ends at its first orbit and at its last.
    pub ends: [End; 2],
}

/// A curve among all, without its points.
pub struct FlatCurve {
    /// What happens on it.
    pub kind: SpecialKind,
    /// Period of the orbits on it [cycles].
    pub period: u64,
    /// The special point that it was continued from.
    pub through: usize,
    /// The first and the second parameter.
    pub varied: [Option<Parameter>; 2],
    /// Why it ends at its first point and at its last.
    pub ends: [End; 2],
}

impl FlatCurve {
    /// The value of a parameter where the two of the curve have these values; NaN where it is neither.
    pub fn value(&self, parameter: Parameter, parameters: [f64; 2]) -> f64 {
        let place = self.varied.iter().position(|&varied| varied == Some(parameter));
        place.map_or(f64::NAN, |place| parameters[place])
    }
}

/// A point of a curve among all.
pub struct FlatCurvePoint {
    /// Number of the curve.
    pub curve: usize,
    /// The first and the second parameter there.
    pub parameters: [f64; 2],
}

/// A point of codimension 2 among all.
pub struct FlatCodim2<'a> {
    /// Number of the curve.
    pub curve: usize,
    /// The point of the curve that it comes after.
    pub after: usize,
    /// What it is.
    pub point: &'a Codim2,
}

/// What a special point is, beside its orbit.
pub struct FlatSpecial {
    /// What happens there.
    pub kind: SpecialKind,
    /// The point of the branch that it comes after.
    pub after: usize,
    /// The curve that goes through it.
    pub curve: Option<usize>,
}

/// Everything that was found, in the order of the study.
#[derive(Default)]
pub struct Flat<'a> {
    /// The branches.
    pub branches: Vec<FlatBranch>,
    /// Their points.
    pub points: Vec<Row<'a>>,
    /// Their special points.
    pub specials: Vec<Row<'a>>,
    /// What each special point is.
    pub special_kinds: Vec<FlatSpecial>,
    /// The curves.
    pub curves: Vec<FlatCurve>,
    /// Their points.
    pub curve_points: Vec<FlatCurvePoint>,
    /// Their points of codimension 2.
    pub codim2: Vec<FlatCodim2<'a>>,
}

impl<'a> Flat<'a> {
    /// What came of `continuations`.
    pub fn new(continuations: &[Continuation], continued: &'a [Continued]) -> Self {
        let mut flat = Flat::default();
        for (request, (continuation, outcome)) in continuations.iter().zip(continued).enumerate() {
            let Ok(found) = outcome else { continue };
            let first_branch = flat.branches.len();
            // Where the special points of each branch of this request begin.
            let mut begins = Vec::new();
            for branch in &found.branches {
                begins.push(flat.specials.len());
                let parent = branch.parent.map(|(parent, special)| {
                    ((first_branch + parent) as i64, (begins[parent] + special) as i64)
                });
                let (along, period, ends) = (continuation.along, branch.period, branch.ends);
                flat.branches.push(FlatBranch { request, along, period, parent, ends });
                flat.add_points(along, branch);
            }
            for curve in &found.curves {
                flat.add_curve(continuation, curve, begins[curve.through.0] + curve.through.1);
            }
        }
        flat
    }

    fn add_points(&mut self, along: Parameter, branch: &'a Branch) {
        let (number, first) = (self.branches.len() - 1, self.points.len());
        for point in &branch.points {
            self.points.push(Row { branch: number, along, period: branch.period, point });
        }
        for special in &branch.special {
            let point = &special.point;
            self.specials.push(Row { branch: number, along, period: branch.period, point });
        }
        // The curves of a request follow its branches.
        let curves = self.curves.len();
        self.special_kinds.extend(branch.special.iter().map(|special| FlatSpecial {
            kind: special.kind,
            after: first + special.after,
            curve: special.curve.map(|curve| curves + curve),
        }));
    }

    fn add_curve(&mut self, continuation: &Continuation, curve: &'a Curve, through: usize) {
        let (number, first) = (self.curves.len(), self.curve_points.len());
        let second = continuation.second.map(|(parameter, _)| parameter);
        let varied = [Some(continuation.along), second];
        let Curve { kind, period, ends, .. } = *curve;
        self.curves.push(FlatCurve { kind, period, through, varied, ends });
        self.codim2.extend(curve.codim2.iter().map(|point| FlatCodim2 {
            curve: number,
            after: first + point.after,
            point,
        }));
        let points = curve.points.iter();
        self.curve_points
            .extend(points.map(|&parameters| FlatCurvePoint { curve: number, parameters }));
    }
}
