//! A variable of a whole study, put together from what blocks of its cases have of it.

use ndarray::{ArrayD, IxDyn};

use crate::sweep::Study;

use super::{Values, Variable};

/// The category of a case that has not been computed.
const MISSING: (i64, &str) = (-1, "missing");

/// A variable over the axes of a study, of which cases may still be missing.
pub struct Whole {
    /// All but the numbers.
    variable: Variable,
    shape: Vec<usize>,
    numbers: Numbers,
    /// Cases that have not been put.
    missing: usize,
}

enum Numbers {
    Real(Vec<f64>),
    Integer(Vec<i64>),
}

impl Whole {
    /// The variable `name` of `study` without any case, after the model of what a block has of it.
    pub fn new(study: &Study, name: &str, block: &Variable) -> Whole {
        let axes = study.axes.iter().map(|axis| axis.coordinate.name().to_owned());
        let directions = study.direction_axis().map(|_| "direction".to_owned());
        let dimensions = axes.chain(directions).chain(block.dimensions[1..].iter().cloned());
        let shape: Vec<usize> =
            study.shape().into_iter().chain(block.values.shape()[1..].iter().copied()).collect();
        let length = shape.iter().product();
        let numbers = match &block.values {
            Values::Real(_) => Numbers::Real(vec![f64::NAN; length]),
            // Zero stands for no period, no failure, no proof; an outcome has no such number.
            Values::Integer(_) => {
                let nothing = if name == "outcome" { MISSING.0 } else { 0 };
                Numbers::Integer(vec![nothing; length])
            }
        };
        let variable = Variable {
            dimensions: dimensions.collect(),
            unit: block.unit.clone(),
            long_name: block.long_name.clone(),
            values: Values::Real(ArrayD::zeros(IxDyn(&[0]))),
            flags: block.flags.clone(),
        };
        Whole { variable, shape, numbers, missing: study.cases() }
    }

    /// Puts what a block has of the variable in the place of its `cases`, each of which is put once.
    pub fn put(&mut self, cases: &[usize], block: &Values) {
        self.missing -= cases.len();
        match (&mut self.numbers, block) {
            (Numbers::Real(all), Values::Real(own)) => put_rows(all, cases, own),
            (Numbers::Integer(all), Values::Integer(own)) => put_rows(all, cases, own),
            _ => unreachable!("every block has the same kind of numbers"),
        }
    }

    /// The variable with all that has been put.
    pub fn finish(self) -> Variable {
        let Whole { mut variable, shape, numbers, missing } = self;
        let fits = "as many numbers as the shape has";
        variable.values = match numbers {
            Numbers::Real(all) => {
                Values::Real(ArrayD::from_shape_vec(IxDyn(&shape), all).expect(fits))
            }
            Numbers::Integer(all) => {
                if missing > 0 && all.contains(&MISSING.0) && !variable.flags.is_empty() {
                    variable.flags.insert(0, (MISSING.0, MISSING.1.to_owned()));
                }
                Values::Integer(ArrayD::from_shape_vec(IxDyn(&shape), all).expect(fits))
            }
        };
        variable
    }
}

fn put_rows<T: Copy>(all: &mut [T], cases: &[usize], own: &ArrayD<T>) {
    let width: usize = own.shape()[1..].iter().product();
    for (&case, row) in cases.iter().zip(own.outer_iter()) {
        for (to, from) in all[case * width..(case + 1) * width].iter_mut().zip(row) {
            *to = *from;
        }
    }
}
