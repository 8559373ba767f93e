//! What one number varies: a parameter whose value it is, or several parameters that change in step.

use std::sync::Arc;

use crate::flow::System;
use crate::lane::Lane;

/// What one number varies.
#[derive(Debug, Clone, PartialEq)]
pub enum Varied<P> {
    /// A parameter, whose value it is.
    One(P),
    /// Several parameters that change in step.
    Several(Arc<InStep<P>>),
}

/// Parameters that change in step: each goes evenly from one value to another.
#[derive(Debug, Clone, PartialEq)]
pub struct InStep<P> {
    /// The number where they begin, and that where they end.
    pub numbers: [f64; 2],
    /// Each parameter with its values there.
    pub each: Vec<(P, [f64; 2])>,
}

impl<P: Copy + PartialEq> Varied<P> {
    /// Parameters that go evenly from some values at one number to others at another; those with one value do not vary.
    pub fn in_step(numbers: [f64; 2], each: impl Iterator<Item = (P, [f64; 2])>) -> Varied<P> {
        let each = each.filter(|(_, [from, to])| from != to).collect();
        Varied::Several(Arc::new(InStep { numbers, each }))
    }

    /// The same of parameters that are named in another way.
    pub fn map<Q>(&self, named: impl Fn(P) -> Q) -> Varied<Q> {
        match self {
            Varied::One(parameter) => Varied::One(named(*parameter)),
            Varied::Several(several) => {
                let each = several.each.iter().map(|(it, values)| (named(*it), *values)).collect();
                Varied::Several(Arc::new(InStep { numbers: several.numbers, each }))
            }
        }
    }

    /// The parameters with their values at a number.
    pub fn at<L: Lane>(&self, number: L) -> Vec<(P, L)> {
        match self {
            Varied::One(parameter) => vec![(*parameter, number)],
            Varied::Several(several) => several.at(number),
        }
    }

    /// The value of a parameter at a number; none of one that does not vary.
    pub fn value(&self, parameter: P, number: f64) -> Option<f64> {
        match self {
            Varied::One(own) => (*own == parameter).then_some(number),
            Varied::Several(several) => several.value(parameter, number),
        }
    }

    /// How fast a parameter changes with the number; none of one that does not vary.
    pub fn slope(&self, parameter: P) -> Option<f64> {
        match self {
            Varied::One(own) => (*own == parameter).then_some(1.0),
            Varied::Several(several) => several.slope(parameter),
        }
    }

    /// The system with the values of these parameters at a number.
    pub fn of<M: System<D, Parameter = P>, const D: usize>(&self, system: &M, number: f64) -> M {
        match self {
            Varied::One(parameter) => system.with(*parameter, number),
            Varied::Several(several) => {
                let values = several.at(number).into_iter();
                values.fold(system.clone(), |system, (it, value)| system.with(it, value))
            }
        }
    }

    /// Whether a system has these parameters.
    pub fn is_had<M: System<D, Parameter = P>, const D: usize>(&self, system: &M) -> bool {
        match self {
            Varied::One(parameter) => system.has(*parameter),
            Varied::Several(several) => several.each.iter().all(|(it, _)| system.has(*it)),
        }
    }

    /// Whether the parameters may have their values at a number.
    pub fn admits<M: System<D, Parameter = P>, const D: usize>(
        &self,
        system: &M,
        number: f64,
    ) -> bool {
        match self {
            Varied::One(parameter) => system.admits(*parameter, number),
            Varied::Several(several) => {
                several.at(number).into_iter().all(|(it, value)| system.admits(it, value))
            }
        }
    }
}

impl<P: Copy + PartialEq> InStep<P> {
    /// Where a number lies between both ends, from 0 to 1.
    fn share<L: Lane>(&self, number: L) -> L {
        let [from, to] = self.numbers;
        (number - L::splat(from)) / L::splat(to - from)
    }

    fn at<L: Lane>(&self, number: L) -> Vec<(P, L)> {
        let share = self.share(number);
        self.each.iter().map(|(it, ends)| (*it, between(*ends, share))).collect()
    }

    fn value(&self, parameter: P, number: f64) -> Option<f64> {
        let (_, ends) = self.each.iter().find(|(it, _)| *it == parameter)?;
        Some(between(*ends, self.share(number)))
    }

    fn slope(&self, parameter: P) -> Option<f64> {
        let (_, [from, to]) = self.each.iter().find(|(it, _)| *it == parameter)?;
        Some((to - from) / (self.numbers[1] - self.numbers[0]))
    }
}

/// A value at a share of the distance between two, both of which it meets exactly.
fn between<L: Lane>([from, to]: [f64; 2], share: L) -> L {
    L::splat(from) * (L::splat(1.0) - share) + L::splat(to) * share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lane::Dual;

    #[test]
    fn parameters_in_step_meet_both_ends_and_have_the_slope_between() {
        let each = [("a", [0.1, 0.7]), ("b", [3.0, -5.3]), ("c", [2.0, 2.0])];
        let varied = Varied::in_step([4.0, 5.0], each.into_iter());
        assert_eq!(varied.at(4.0), [("a", 0.1), ("b", 3.0)]);
        assert_eq!(varied.at(5.0), [("a", 0.7), ("b", -5.3)]);
        assert_eq!([varied.value("c", 4.5), varied.slope("c")], [None, None]);
        let halfway = varied.at(Dual::<f64, 1> { value: 4.5, gradient: [1.0] });
        for (name, it) in halfway {
            assert_eq!(Some(it.value), varied.value(name, 4.5));
            let slope = varied.slope(name).unwrap();
            assert!((it.gradient[0] / slope - 1.0).abs() < 1e-14, "{name} {slope}");
        }
        assert_eq!(Varied::One("a").at(0.3), [("a", 0.3)]);
    }
}
